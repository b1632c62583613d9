// Which words of a block go together.
#include <algorithm>

#include "program/siemens/block.h"
#include "program/siemens/flow.h"

namespace swarf::program::nc::siemens {
namespace {

/// The first word that a frame cannot use; npos when there is none.
size_t stray_offset(const BlockWords& words) {
  size_t first = std::string_view::npos;
  const auto look = [&](const auto& word) {
    if (word.given) first = std::min(first, word.offset);
  };
  for (const auto* three : {&words.centre, &words.between}) {
    for (const Coordinate& word : *three) look(word);
  }
  for (const auto* three : {&words.angles, &words.vector}) {
    for (const Amount& word : *three) look(word);
  }
  look(words.polar_angle);
  look(words.polar_radius);
  for (const Amount* word : {&words.radius, &words.opening, &words.turns, &words.round, &words.chamfer,
                             &words.chamfer_leg, &words.angle})
    look(*word);
  for (const CycleCall& call : words.calls) first = std::min(first, call.offset);
  return first;
}

}  // namespace

void check_block(const BlockWords& words, const Coordinate* machine_axis, const LineRef& line) {
  const auto fail = [&](const char* code, size_t offset, const char* text, const char* fix) {
    refuse(line, offset, code, text, fix);
  };
  const std::optional<int> point = words.code(Group::kNoMotion);
  if (machine_axis != nullptr && point != kG74 && point != kG75) {
    fail("unexpected-word", machine_axis->offset, "machine axes (X1=) belong to G74 and G75",
         "write X, Y, Z, A, B or C");
  }
  const bool cycle = std::any_of(words.calls.begin(), words.calls.end(), [](const CycleCall& call) {
    return find_word(call.name)->meaning == Meaning::kCycle;
  });
  if (words.frame) {
    const size_t stray = stray_offset(words);
    if (stray != std::string_view::npos) {
      fail("words-conflict", stray, "this word does not belong beside a frame",
           "a frame stands in a block of its own: TRANS X10 Y20");
    }
  }
  if ((words.frame || words.transform || cycle) && words.motion) {
    fail("words-conflict", words.motion_offset, "a motion stands beside a frame, a transformation or a cycle",
         "write it in a block of its own");
  }
  const Coefficients* polynomial = words.divisor ? &words.divisor : nullptr;
  for (const Coefficients& one : words.polynomials) polynomial = one ? &one : polynomial;
  if (polynomial != nullptr && (words.frame || words.transform || !words.calls.empty() || point)) {
    fail("words-conflict", polynomial->offset,
         "a polynomial stands in a block that is no motion along a path",
         "write POLY PO[X]=(10,2) in a block of its own");
  }
  if (words.calls.size() > 1) {
    fail("words-conflict", words.calls[1].offset, "two cycles stand in one block", "write one per block");
  }
  if (words.functions.size() > 5) {
    fail("words-conflict", words.functions[5].offset, "a block has at most five M functions",
         "spread them over two blocks");
  }
}

void BlockWords::clear() {
  static const BlockNumbers none;
  static_cast<BlockNumbers&>(*this) = none;
  tool.given = false;
  functions.clear();
  codes.clear();
  motion.reset();
  frame.reset();
  transform.reset();
  calls.clear();
  noted.clear();
  ends_program = false;
}

bool BlockWords::any_axis() const {
  return std::any_of(axes.begin(), axes.end(), [](const Coordinate& c) { return c.given; });
}

bool BlockWords::moves() const {
  const auto given = [](const auto& x) { return x.given; };
  return any_axis() || polar_angle || polar_radius || std::any_of(centre.begin(), centre.end(), given) ||
         std::any_of(angles.begin(), angles.end(), given) || std::any_of(vector.begin(), vector.end(), given);
}

}  // namespace swarf::program::nc::siemens

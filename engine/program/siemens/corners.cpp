// RND RNDM CHF CHR with FRC FRCM, and the straight line by ANG.
#include <cmath>

#include "base/units.h"
#include "program/control/corner.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {
namespace {

using Kind = nc::CornerWords::Kind;

struct CornerWord {
  const Amount* amount;
  Kind kind;
};

/// RND, CHF or CHR of the block; no amount: it has none of them.
CornerWord corner_word(const BlockPlace& place, const BlockWords& words) {
  CornerWord found{nullptr, Kind::kRound};
  for (const CornerWord& one :
       {CornerWord{&words.round, Kind::kRound}, CornerWord{&words.chamfer, Kind::kChord},
        CornerWord{&words.chamfer_leg, Kind::kLegs}}) {
    if (!*one.amount) continue;
    if (found.amount != nullptr)
      fail(place, "words-conflict", one.amount->offset, "a block has one corner", "write RND, CHF or CHR");
    found = one;
  }
  return found;
}

void check_size(const BlockPlace& place, const Amount& amount, bool zero_too) {
  if (amount && !(amount.value > 0.0 || (zero_too && amount.value == 0.0)))
    fail(place, "out-of-range", amount.offset, "the size or feed of a corner is not above zero",
         "RND=2, CHF=1.5, CHR=1, FRC=200; RNDM=0 and FRCM=0 end theirs");
}

}  // namespace

void corner_modes(nc::Control& control, BlockPlace& place, Modes& modes, const BlockWords& words) {
  check_size(place, words.round_all, true);
  check_size(place, words.corner_feed_all, true);
  check_size(place, words.corner_feed, false);
  if (words.round_all) modes.round_all_mm = control.modal.mm(words.round_all.value);
  if (words.corner_feed_all) modes.corner_feed = words.corner_feed_all.value;
  const CornerWord word = corner_word(place, words);
  if (word.amount == nullptr) return;
  check_size(place, *word.amount, false);
  if (!words.moves() || words.code(Group::kNoMotion) || words.code(Group::kSuppress) || modes.motion == kG0 ||
      modes.motion == kPoly)
    fail(place, "bad-corner", word.amount->offset, "a corner stands in a block without a feed move",
         "write it in the G1, G2 or G3 block that leads to the corner");
}

/// The technology of a corner is that of the block behind it, as the control is delivered (MD20201).
void ask_for_corner(nc::Control& control, const BlockPlace& place, const Modes& modes, const Frames& frames,
                    const BlockWords& words) {
  const CornerWord word = corner_word(place, words);
  const bool modal = word.amount == nullptr;
  if (modal && (!(modes.round_all_mm > 0.0) || modes.motion == kPoly)) return;
  const size_t offset = modal ? 0 : word.amount->offset;
  nc::CornerWords asked;
  asked.kind = word.kind;
  asked.size_mm = (modal ? modes.round_all_mm : control.modal.mm(word.amount->value)) *
                  arc_scale(control, place, frames, offset);
  asked.feed = words.corner_feed ? words.corner_feed.value : modes.corner_feed;
  asked.feed_of_next = true;
  asked.modal = modal;
  asked.place = control.report.place;
  asked.place.column = column(place, offset);
  nc::ask_corner(control, asked);
}

/// ANG= is counted from the plane's first axis towards its second one; one of both is given.
void angle_end(Executor& executor, const BlockWords& words, Target& target) {
  if (!words.angle) return;
  const nc::PlaneAxes plane = nc::axes_of(executor.control.modal.plane);
  const bool straight = executor.modes.motion == kG0 || executor.modes.motion == kG1;
  if (!straight || target.has(plane.first) == target.has(plane.second))
    fail(executor.place, straight ? "unsupported-word" : "words-conflict", words.angle.offset,
         "ANG= is read in straight moves with one coordinate of the plane, which is then their end",
         "write G1 X40 ANG=30, or the end with both coordinates");
  const double angle = rad_from_deg(words.angle.value);
  const Vec3& factor = executor.frames.stretch.factor;
  const double first = std::cos(angle) * factor[plane.first], second = std::sin(angle) * factor[plane.second];
  const bool by_first = target.has(plane.first);
  const int given = by_first ? plane.first : plane.second, other = by_first ? plane.second : plane.first;
  const Vec3 from = nc::position_xyz(executor.control), end = end_of(target, from);
  const double way = (end[given] - from[given]) / (by_first ? first : second);
  if (!(std::abs(by_first ? first : second) > 1e-9) || !(way > 0.0))
    fail(executor.place, "out-of-range", words.angle.offset,
         "the line at this angle never comes to the coordinate that is given",
         "correct the angle or the end");
  target.set(other, from[other] + way * (by_first ? second : first), false);
}

}  // namespace swarf::program::nc::siemens

#include "program/letters/letter_block.h"

#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/letters/codes.h"

namespace swarf::program::nc {
namespace {

void skip_parentheses(const LetterSyntax& syntax, FormulaReader& reader, Control& control,
                      std::string_view& message) {
  const size_t from = reader.at();
  const size_t close = reader.line().find_first_of("()", from + 1);
  if (close == std::string_view::npos || reader.line()[close] == '(') {
    control.report.fail("unclosed-comment", reader.column_of(from),
                        close == std::string_view::npos
                            ? "this comment is not closed on its line"
                            : "a comment opens inside this comment; controls disagree on its end",
                        "close it with ')'");
  }
  reader.skip();
  reader.skip_space();
  if (reader.take("MSG,") || reader.take("DEBUG,") || reader.take("PRINT,"))
    message = reader.line().substr(reader.at(), close - reader.at());
  if (syntax.active_comments && reader.take("ABORT,"))
    control.report.fail("program-error", reader.column_of(from),
                        fmt::format("the program stops itself here: {}",
                                    reader.line().substr(reader.at(), close - reader.at())),
                        "see what the program checks before this block");
  reader.move_to(close + 1);
}

constexpr const char* kBuildersRemedy =
    "correct the code; an M of the machine's builder that moves nothing is named in builder_words "
    "(swarf check --builder-word)";

/// True for an M that ControlSetup::builder_words names.
bool is_builders(int tenths, const Code* code, int column, Control& control) {
  if (control.setup.builder_words.empty() || tenths % 10 != 0) return false;
  const std::string word = code_name('M', tenths);
  const bool own = code != nullptr && code->use != Code::Use::kUnsupported;
  if (own && control.setup.builder_words.count(word) != 0)
    control.report.fail("reserved-word", column,
                        fmt::format("{} has its meaning in this dialect, and builder_words names it", word),
                        "take it out of builder_words");
  return !own && control.report.take_builder_word(word);
}

/// G80 and one of G0 to G3, in either order.
bool ends_cycle_beside_motion(int first, int second) {
  const auto moves = [](int tenths) {
    return tenths >= IsoG::kRapid && tenths <= IsoG::kArcCounterClockwise && tenths % 10 == 0;
  };
  return (first == IsoG::kCycleOff && moves(second)) || (second == IsoG::kCycleOff && moves(first));
}

void add_code(char letter, const CodeTable& table, double number, size_t place, FormulaReader& reader,
              Control& control, LetterBlock& block) {
  const double tenths_number = number * 10.0;
  const long tenths = std::lround(std::min(std::max(tenths_number, -1.0), 99999.0));
  const Code* code = std::abs(tenths_number - static_cast<double>(tenths)) < 1e-6
                         ? table.find(static_cast<int>(tenths))
                         : nullptr;
  if (letter == 'M' && is_builders(static_cast<int>(tenths), code, reader.column_of(place), control)) return;
  if (code == nullptr) {
    control.report.fail("unknown-word", reader.column_of(place),
                        fmt::format("{}{:g} is no code of this dialect", letter, number),
                        letter == 'M'
                            ? kBuildersRemedy
                            : "correct the code, or choose the dialect that the program is written in");
  }
  check_use(*code, letter, reader.column_of(place), control);
  block.arguments = block.arguments || code->use == Code::Use::kArguments;
  const int acts = code->acts_as >= 0 ? code->acts_as : code->tenths;
  if (letter == 'M') {
    if (block.m_count == kMCodesMax)
      control.report.fail("modal-conflict", reader.column_of(place), "too many M codes in one block",
                          "split the block");
    if (code->group != kFree && (block.m_groups >> code->group & 1u) != 0)
      control.report.fail(
          "modal-conflict", reader.column_of(place),
          fmt::format("{} contradicts another M code of this block", code_name('M', code->tenths)),
          "write them in two blocks");
    if (code->group != kFree) block.m_groups |= 1u << code->group;
    block.listed_m += code->use == Code::Use::kNoEffect;
    block.m[static_cast<size_t>(block.m_count)] = acts;
    block.m_places[static_cast<size_t>(block.m_count++)] = static_cast<uint16_t>(place);
    return;
  }
  if (code->group == kFree) {
    ++block.free_g;
    return;
  }
  const auto group = static_cast<size_t>(static_cast<unsigned char>(code->group));
  if (block.has_g(code->group)) {
    const bool motion = code->group == 1;
    if (motion && ends_cycle_beside_motion(block.g[group], code->tenths)) {
      control.report.warn_once(
          "cycle-end-beside-motion", reader.column_of(place),
          "G80 stands beside a motion: the cycle ends and the motion holds, as most controls "
          "have it; LinuxCNC itself refuses two codes of one modal group",
          "write G80 in a block before it");
      if (code->tenths == IsoG::kCycleOff) return;
      block.g[group] = block.g_written[group] = code->tenths;
      block.g_places[group] = static_cast<uint16_t>(place);
      return;
    }
    control.report.fail(motion ? "two-motion-words" : "modal-conflict", reader.column_of(place),
                        fmt::format("{} and {} contradict each other in one block",
                                    code_name('G', block.g_written[group]), code_name('G', code->tenths)),
                        "write them in two blocks");
  }
  block.g_given |= 1u << group;
  block.g[group] = acts;
  block.g_written[group] = code->tenths;
  block.g_places[group] = static_cast<uint16_t>(place);
}

/// "@2.5" and "^90".
void read_polar(LetterBlock::Polar& word, FormulaReader& reader, Control& control) {
  const size_t place = reader.at();
  if (word.given)
    control.report.fail("word-twice", reader.column_of(place),
                        fmt::format("{} stands twice in this block", reader.peek()), "write it once");
  reader.skip();
  word = {true, reader.value(), place};
}

/// ",R2." and ",C1.".
void read_corner(FormulaReader& reader, Control& control, LetterBlock& block) {
  const size_t place = reader.at();
  reader.skip();
  reader.skip_space();
  const char letter = reader.peek_upper();
  if (letter == 'A')
    control.report.fail(
        "unsupported-word", reader.column_of(place),
        ",A (a line by its angle) is published for turning alone: from which axis a mill counts "
        "it is not",
        "write the end with both coordinates");
  if (letter != 'R' && letter != 'C')
    control.report.fail("unexpected-character", reader.column_of(place), "no corner stands behind this comma",
                        "write ,R2. or ,C1.");
  if (block.corner.letter != 0)
    control.report.fail("word-twice", reader.column_of(place), "a block has one corner", "write ,R or ,C");
  reader.skip();
  block.corner = {letter, reader.value(), place};
}

}  // namespace

std::string code_name(char letter, int tenths) {
  return tenths % 10 == 0 ? fmt::format("{}{}", letter, tenths / 10)
                          : fmt::format("{}{}.{}", letter, tenths / 10, tenths % 10);
}

void CodeTable::add(std::span<const Code> codes) {
  for (const Code& code : codes)
    codes_[static_cast<size_t>(code.tenths)] = code.use == Code::Use::kAbsent ? nullptr : &code;
}

bool LetterBlock::has_m(int tenths) const {
  for (int i = 0; i < m_count; ++i) {
    if (m[static_cast<size_t>(i)] == tenths) return true;
  }
  return false;
}

void check_use(const Code& code, char letter, int column, Control& control) {
  if (code.use == Code::Use::kRead || code.use == Code::Use::kArguments) return;
  const std::string name = code_name(letter, code.tenths);
  if (code.use == Code::Use::kUnsupported) {
    control.report.fail("unsupported-word", column,
                        fmt::format("{} ({}) is not supported", name, code.meaning),
                        letter == 'M' ? kBuildersRemedy : "post the program without it");
  }
  control.report.without_effect(fmt::format("{} ({})", name, code.meaning));
}

void skip_comments(const LetterSyntax& syntax, FormulaReader& reader, Control& control,
                   std::string_view& message) {
  for (reader.skip_space(); !reader.done(); reader.skip_space()) {
    const char c = reader.peek();
    if (c == '(') {
      skip_parentheses(syntax, reader, control, message);
    } else if (c == ';') {
      if (syntax.semicolon_comment ||
          reader.line().find_first_not_of("; \t\r", reader.at()) == std::string_view::npos)
        reader.move_to(reader.line().size());
      else
        control.report.fail("unexpected-character", reader.column(), "words follow the end of the block",
                            "write one block per line");
    } else {
      return;
    }
  }
}

void read_words(const LetterSyntax& syntax, FormulaReader& reader, Control& control, LetterBlock& block,
                char stop) {
  bool any = false;
  for (skip_comments(syntax, reader, control, block.message); !reader.done();
       skip_comments(syntax, reader, control, block.message)) {
    if (stop != 0 && reader.peek() == stop) return;
    const size_t place = reader.at();
    const char letter = reader.peek_upper();
    if ((letter == '@' || letter == '^') && syntax.polar) {
      if (!any) block.first = place;
      read_polar(letter == '@' ? block.distance : block.angle, reader, control);
      any = true;
      continue;
    }
    if (letter == ',' && syntax.corners) {
      if (!any) block.first = place;
      read_corner(reader, control, block);
      any = true;
      continue;
    }
    if (letter < 'A' || letter > 'Z') {
      if (letter == '/' && !any) {
        block.skip_mark = true;
        reader.skip();
        if (reader.peek() >= '1' && reader.peek() <= '9') reader.skip();
        continue;
      }
      const bool number = letter >= '0' && letter <= '9';
      control.report.fail(
          number || letter == '.' || letter == '-' || letter == '+' ? "bad-number" : "unexpected-character",
          reader.column(),
          number ? "this number has no letter before it" : "this character does not belong here",
          letter == '<' ? "programs are called by number, not by name: M98 P1234"
                        : "a block has words (a letter and a number) and comments");
    }
    if (syntax.letters.find(letter) == std::string_view::npos) {
      control.report.fail("unknown-word", reader.column(),
                          fmt::format("{} is no word of this dialect", letter),
                          "take it out, or choose the dialect that the program is written in");
    }
    if (letter == 'N' && any && syntax.number_first)
      control.report.fail("unexpected-word", reader.column(), "N stands behind other words",
                          "write the block number first");
    if (!any) block.first = place;
    any = true;
    reader.skip();
    const double value = reader.value();
    if (letter == 'N' && value < 0.0)
      control.report.fail("out-of-range", reader.column_of(place),
                          fmt::format("the block number {:g}", value), "number blocks from 0");
    if (letter == 'N') continue;
    if (std::isnan(value)) {
      control.report.warn_once("vacant-word", reader.column_of(place),
                               fmt::format("{} is left out: its variable is vacant", letter),
                               "assign the variable where the word is meant");
      continue;
    }
    if (letter == 'G' || (letter == 'M' && !block.arguments)) {
      add_code(letter, letter == 'G' ? *syntax.g_codes : *syntax.m_codes, value, place, reader, control,
               block);
      continue;
    }
    const bool repeats = block.arguments && letter >= 'I' && letter <= 'K';
    if (repeats && block.has(letter) && block.repeat_count < kRepeatsMax) {
      block.repeats[static_cast<size_t>(block.repeat_count++)] = {letter, value,
                                                                  static_cast<uint16_t>(place)};
      continue;
    }
    if (block.has(letter)) {
      control.report.fail("word-twice", reader.column_of(place),
                          fmt::format("{} stands twice in this block", letter), "write it once");
    }
    block.set(letter, value, place);
  }
}

Target target_of(const LetterBlock& block, bool incremental, const FormulaReader& reader,
                 const Control& control) {
  constexpr std::string_view kLetters = kAxisLetters;
  constexpr uint32_t kLinear = 7u << ('X' - 'A'), kRotary = 7u;
  Target target;
  if ((block.given & (kLinear | kRotary)) == 0) return target;
  size_t first = reader.line().size();
  for (int word = 0; word < kAxisWords; ++word) {
    const char letter = kLetters[static_cast<size_t>(word)];
    if (!block.has(letter)) continue;
    const double value = block.get(letter);
    target.set(word, word < 3 ? control.modal.mm(value) : rad_from_deg(value), incremental);
    first = std::min(first, block.place(letter));
  }
  target.column = static_cast<int>(first) + 1;
  return target;
}

std::optional<ArcWords> arc_words(const LetterBlock& block, const Target& target, bool absolute,
                                  const FormulaReader& reader, Control& control) {
  const PlaneAxes axes = axes_of(control.modal.plane);
  const auto column = [&](char letter) { return reader.column_of(block.place(letter)); };
  ArcWords words;
  words.column = reader.column_of(block.first);
  const bool radius = block.has('R');
  const bool centre = block.has('I') || block.has('J') || block.has('K');
  if (!target.any() && !centre && !radius) return std::nullopt;  // only the mode
  if (radius && centre)
    control.report.fail("bad-arc", column('R'), "the arc has a radius and a centre",
                        "write either R or I J K");
  if (!radius && !centre)
    control.report.fail("bad-arc", words.column, "the arc has neither a centre nor a radius",
                        "add I J K, or R");
  const char normal_letter = "IJK"[axes.normal];
  if (block.has(normal_letter))
    control.report.fail("bad-arc", column(normal_letter),
                        fmt::format("{} lies across the plane of this arc", normal_letter),
                        "take it out, or select the plane with G17 to G19");
  if (radius) {
    words.radius = control.modal.mm(block.get('R'));
    if (!target.has(axes.first) && !target.has(axes.second))
      control.report.fail("bad-arc", column('R'), "an arc by radius needs an end in its plane",
                          "add the end, or I J K");
    return words;
  }
  const Vec3 here = nc::position_xyz(control);
  Vec3 point = here;
  for (const int i : {axes.first, axes.second}) {
    const char letter = "IJK"[i];
    if (absolute && !block.has(letter))
      control.report.fail("missing-word", words.column,
                          fmt::format("an absolute centre wants {} in each arc", letter),
                          fmt::format("add {}", letter));
    const double value = control.modal.mm(block.get(letter, 0.0));
    point[i] = absolute ? value : here[i] + value;
  }
  words.centre = point;
  return words;
}

int whole(const LetterBlock& block, char letter, int low, int high, const FormulaReader& reader,
          Control& control) {
  const double value = block.get(letter);
  const int column = reader.column_of(block.place(letter));
  if (std::abs(value - std::round(value)) > 1e-6) {
    control.report.fail("not-whole-number", column,
                        fmt::format("{} {:g} is not a whole number", letter, value), "write a whole number");
  }
  if (!(value >= low - 0.5 && value <= high + 0.5)) {
    control.report.fail("out-of-range", column,
                        fmt::format("{} {:g} lies outside {} to {}", letter, value, low, high),
                        fmt::format("write a number from {} to {}", low, high));
  }
  return static_cast<int>(std::lround(value));
}

}  // namespace swarf::program::nc

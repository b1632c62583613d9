#include "program/heidenhain/flow.h"

#include <fmt/format.h>

#include <algorithm>

namespace swarf::program::nc::heidenhain {

using nc::LineSource;

void Flow::open(const std::string& path) {
  auto level = std::make_unique<Level>();
  level->source = std::make_unique<LineSource>(path, control_);
  levels_.enter(std::move(level));
}

bool Flow::fetch(Level& level) {
  if (level.ahead_valid) return true;
  comments_.clear();
  level.ahead_valid = read_block(*level.source, control_, level.ahead, comments_);
  return level.ahead_valid;
}

const BlockText* Flow::next() {
  if (ended_) return nullptr;
  Level& level = *levels_.top();
  if (!fetch(level)) {
    control_.report.at(level.source->file(), static_cast<int>(level.source->line_number()), 1);
    control_.report.fail("missing-end", 0, "the program ends without END PGM",
                         "the file is cut off: transfer it again, or write END PGM");
  }
  std::swap(now_, level.ahead);
  level.ahead_valid = false;
  for (const auto& [line, text] : comments_) {
    control_.report.at(now_.file, line, 1);
    control_.report.note(";", text);
  }
  comments_.clear();
  control_.report.at(now_.file, now_.line(), 1);
  if (!now_.comment.empty()) control_.report.note(";", now_.comment);
  ++control_.report.summary.blocks;
  control_.report.summary.lines += static_cast<long>(now_.pieces.size()) + now_.skipped;
  return &now_;
}

const BlockText* Flow::following() {
  return fetch(*levels_.top()) ? &levels_.top()->ahead : nullptr;
}

/// A number without leading zeros, or "name" with its quotes.
std::string Flow::label(BlockReader& reader) {
  reader.done();
  if (reader.peek() == '"') return fmt::format("\"{}\"", reader.quoted());
  if (reader.letters() == "QS") return fmt::format("\"{}\"", reader.text_value());
  if (reader.peek() == 'Q') return std::to_string(reader.whole_value(0, 65535));
  return std::to_string(reader.whole_number(65535));
}

/// All labels of the file, each once.
void Flow::read_labels(Level& level) {
  if (level.labels_read) return;
  level.labels_read = true;
  LineSource source(level.source->path(), control_);
  BlockText block;
  std::vector<std::pair<int, std::string>> comments;
  while (read_block(source, control_, block, comments)) {
    comments.clear();
    if (!block.text.starts_with("LBL")) continue;
    BlockReader reader(block, control_, parameters_);
    if (!reader.take("LBL")) continue;
    reader.done();
    const size_t offset = reader.offset();
    const std::string name = label(reader);
    if (name == "0") continue;
    if (!level.labels.emplace(name, source.mark()).second) {
      reader.fail("duplicate-label", offset, fmt::format("LBL {} stands twice in this program", name),
                  "give each label once; only LBL 0 may repeat");
    }
  }
}

void Flow::go(Level& level, const LineSource::Mark& mark) {
  level.source->seek(mark);
  level.ahead_valid = false;
}

void Flow::go(BlockReader& reader, const std::string& name, size_t offset) {
  Level& level = *levels_.top();
  read_labels(level);
  const auto found = level.labels.find(name);
  if (found == level.labels.end()) {
    std::vector<std::string> names;
    for (const auto& [known, mark] : level.labels) names.push_back(known);
    const std::string near = nearest_name(name, names);
    reader.fail(
        "unknown-label", offset, fmt::format("there is no LBL {} in this program", name),
        near.empty() ? "write the label, or correct the call" : fmt::format("did you mean LBL {}?", near));
  }
  const nc::Place place = reader.place_of(offset);
  control_.report.at(place.file, place.line, place.column);
  nc::jump(control_);
  go(level, found->second);
}

void Flow::set_label(BlockReader& reader) {
  const std::string name = label(reader);
  reader.expect_end();
  Level& level = *levels_.top();
  if (name != "0") {
    read_labels(level);
    return;
  }
  if (level.returns.empty()) return;
  const LineSource::Mark back = level.returns.leave();
  go(level, back);
}

void Flow::call_label(BlockReader& reader) {
  reader.done();
  const size_t offset = reader.offset();
  const std::string name = label(reader);
  if (name == "0") {
    reader.fail("unknown-label", offset, "LBL 0 ends subprograms and cannot be called", "call another label");
  }
  Level& level = *levels_.top();
  const int line = reader.block().line();
  if (reader.take("REP")) {
    const long times = reader.whole_value(0, 65534);
    // Older controls write REP 2/2: how often, and how often still.
    if (reader.take_char('/')) reader.whole_value(0, 65534);
    reader.expect_end();
    const auto left = level.repeats.try_emplace(line, times).first;
    if (left->second == 0) {
      level.repeats.erase(left);
      return;
    }
    --left->second;
    go(reader, name, offset);
    return;
  }
  reader.expect_end();
  if (level.returns.size() >= kLevelsMax) {
    reader.fail(kRecursionLimit, offset, fmt::format("more than {} subprograms call each other", kLevelsMax),
                "end them with LBL 0, or take the recursion out");
  }
  fetch(level);
  const LineSource::Mark back = level.ahead_valid ? level.ahead.mark : level.source->mark();
  go(reader, name, offset);
  level.returns.enter(back);
}

/// The name of a program, in quotes or not.
std::string Flow::program_name(BlockReader& reader) {
  std::string name = !reader.done() && (reader.peek() == '"' || reader.letters() == "QS")
                         ? reader.text_value()
                         : std::string(reader.rest());
  reader.expect_end();
  return name;
}

void Flow::call_program(BlockReader& reader, std::string name, size_t offset) {
  std::replace(name.begin(), name.end(), '\\', '/');
  if (name.starts_with("TNC:/")) name = name.substr(5);
  const std::string path =
      nc::find_subprogram(levels_.top()->source->path(), control_.setup, name, {"", ".h", ".H"});
  if (path.empty() || name.empty()) {
    reader.fail("unknown-subprogram", offset, fmt::format("the program '{}' is not found", name),
                "put it next to this program, or name its folder in the scene");
  }
  if (levels_.full(kLevelsMax)) {
    reader.fail(kRecursionLimit, offset, fmt::format("more than {} programs call each other", kLevelsMax),
                "take the recursion out");
  }
  nc::jump(control_);
  open(path);
  levels_.top()->outer_local = parameters_.swap_local({});
}

bool Flow::statement(BlockReader& reader) {
  if (reader.take("LBL")) {
    set_label(reader);
    return true;
  }
  const size_t start = reader.offset();
  if (reader.take("SEL")) {
    if (!reader.take("PGM"))
      reader.fail("unsupported-word", start, "of SEL, only SEL PGM is supported", "SEL PGM \"NAME.H\"");
    selected_ = program_name(reader);
    return true;
  }
  if (!reader.take("CALL")) return false;
  if (reader.take("LBL")) {
    call_label(reader);
  } else if (reader.take("PGM")) {
    reader.done();
    const size_t offset = reader.offset();
    call_program(reader, program_name(reader), offset);
  } else if (reader.take("SELECTED")) {
    if (!reader.take("PGM"))
      reader.fail("missing-word", start, "CALL SELECTED without PGM", "CALL SELECTED PGM");
    reader.expect_end();
    if (selected_.empty())
      reader.fail("unknown-subprogram", start, "no SEL PGM stands before this call", "SEL PGM \"NAME.H\"");
    call_program(reader, selected_, start);
  } else {
    reader.fail("unsupported-word", start, "this kind of CALL is not supported",
                "CALL LBL, CALL PGM and CALL SELECTED PGM are");
  }
  return true;
}

void Flow::conditional(BlockReader& reader, int number) {
  reader.done();
  if (!reader.take("IF"))
    reader.fail("missing-word", reader.offset(), fmt::format("FN {} wants IF here", number),
                "FN 9: IF +Q1 EQU +10 GOTO LBL 5");
  const double a = reader.value();
  static constexpr std::string_view kCompared[] = {"EQU", "NE", "GT", "LT"};
  const std::string_view word = kCompared[number - 9];
  reader.done();
  if (!reader.take(word))
    reader.fail("missing-word", reader.offset(), fmt::format("FN {} wants {} here", number, word),
                "FN 9: EQU, FN 10: NE, FN 11: GT, FN 12: LT");
  const double b = reader.value();
  reader.done();
  if (!reader.take("GOTO") || !reader.take("LBL"))
    reader.fail("missing-word", reader.offset(), "GOTO LBL is missing here", "GOTO LBL 5");
  reader.done();
  const size_t offset = reader.offset();
  const std::string name = label(reader);
  reader.expect_end();
  const bool jumps = number == 9 ? a == b : number == 10 ? a != b : number == 11 ? a > b : a < b;
  if (jumps) go(reader, name, offset);
}

void Flow::end_of_program(BlockReader& reader) {
  if (!levels_.top()->returns.empty()) {
    reader.fail("missing-end", 0, "the program ends inside a subprogram: LBL 0 is missing",
                "end the subprogram with LBL 0");
  }
  if (!levels_.called()) {
    ended_ = true;
    return;
  }
  parameters_.swap_local(std::move(levels_.top()->outer_local));
  levels_.leave();
}

void Flow::stop(BlockReader& reader, size_t offset) {
  if (levels_.called()) {
    reader.fail("end-in-called-program", offset, "a called program ends with M2 or M30",
                "called programs end with END PGM alone");
  }
  ended_ = true;
}

}  // namespace swarf::program::nc::heidenhain

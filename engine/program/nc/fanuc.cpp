#include "program/nc/fanuc.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/units.h"
#include "program/nc/dialect.h"

namespace swarf::program::nc {
namespace {

constexpr long kLocals = 33;
constexpr long kFirstCommon = 100, kLastCommon = 999;

}  // namespace

Fanuc::Fanuc(const std::string& path, Control& control)
    : LetterDialect(path, control, kFanucFormula),
      commons_(kLastCommon + 1, 0.0),
      common_set_(kLastCommon + 1, false) {
  Call main;
  main.source = &open(path);
  main.own_locals = true;
  calls_.push_back(std::move(main));
  control_.set_feed_rule(FeedRule::kAllAxes);
}

void Fanuc::run() {
  std::string_view line;
  while (!ended_) {
    if (!source().next(line)) {
      if (calls_.size() > 1)
        control_.fail("unclosed-subprogram", 0, "the subprogram does not end in its file", "end it with M99");
      if (!calls_.back().loops.empty())
        control_.fail("unclosed-loop", 0,
                      fmt::format("DO{} has no END{}", calls_.back().loops.back().first,
                                  calls_.back().loops.back().first),
                      "add the END of the loop");
      break;
    }
    at_line(source());
    if (!percent(line)) ended_ = !execute();
  }
  if (nurbs_) {
    const Place where = nurbs_->where;
    control_.at(where.file, where.line, where.column);
    control_.fail("bad-nurbs", 0,
                  "this NURBS does not end: it needs as many knots after the points as its order",
                  "add blocks with K alone");
  }
  control_.finish();
}

bool Fanuc::execute() {
  if (statement()) {
    ++control_.summary().blocks;
    return true;
  }
  block_.clear();
  read_words(kFanucSyntax, reader_, control_, block_, 0);
  if (!block_.message.empty()) control_.note("MSG", block_.message);
  if (block_.skip_mark) control_.without_effect("/ (block delete is off: such blocks are executed)");
  if (block_.empty()) return true;
  ++control_.summary().blocks;
  control_.at(source().file(), static_cast<int>(source().line_number()), reader_.column_of(block_.first));
  if (nurbs_ && add_to_nurbs()) return true;
  check_words();
  apply();
  return apply_calls();
}

/// A macro statement or an assignment; the reader stands behind it then.
bool Fanuc::statement() {
  const size_t from = reader_.at();
  if (reader_.peek_upper() == 'N' && reader_.at() + 1 < reader_.line().size()) {
    reader_.skip();
    while (reader_.peek() >= '0' && reader_.peek() <= '9') reader_.skip();
    reader_.skip_space();
  }
  if (reader_.peek() == '#') {
    assignment();
  } else if (!macro_word()) {
    reader_.move_to(from);
    return false;
  }
  std::string_view message;
  skip_comments(kFanucSyntax, reader_, control_, message);
  if (!reader_.done())
    control_.fail("unexpected-character", reader_.column(), "words follow a macro statement",
                  "write one statement per block");
  return true;
}

void Fanuc::assignment() {
  const size_t place = reader_.at();
  std::string name;
  const long number = reader_.parameter_number(name);
  reader_.skip_space();
  if (reader_.peek() != '=')
    control_.fail("bad-parameter", reader_.column(), "'=' is missing after the variable", "write #1=2.5");
  reader_.skip();
  assign(number, reader_.open_formula(), place);
}

/// The call whose #1 to #33 hold here.
size_t Fanuc::locals() const {
  size_t level = calls_.size() - 1;
  while (level > 0 && !calls_[level].own_locals) --level;
  return level;
}

void Fanuc::assign(long number, double value, size_t place) {
  const int at = reader_.column_of(place);
  if (number >= 1 && number <= kLocals) {
    Call& here = calls_[locals()];
    here.locals[static_cast<size_t>(number)] = value;
    here.assigned |= uint64_t{1} << number;
  } else if (number >= kFirstCommon && number <= kLastCommon) {
    commons_[static_cast<size_t>(number)] = value;
    common_set_[static_cast<size_t>(number)] = true;
  } else if (number == 3000) {
    control_.fail("program-alarm", at, fmt::format("the program raises its alarm {:g} here", value),
                  "find out why the program stops itself");
  } else if (number == 3006) {
    control_.note("#3006", fmt::format("stop {:g}", value));
  } else {
    control_.fail("bad-parameter", at, fmt::format("#{} cannot be assigned", number),
                  "programs may set #1 to #33 and #100 to #999; offsets with G10 L2");
  }
}

double Fanuc::read(long number, size_t place) {
  if (number >= 1 && number <= kLocals) {
    const Call& here = calls_[locals()];
    if ((here.assigned >> number & 1u) != 0) return here.locals[static_cast<size_t>(number)];
  } else if (number >= kFirstCommon && number <= kLastCommon && common_set_[static_cast<size_t>(number)]) {
    return commons_[static_cast<size_t>(number)];
  } else if (number > kLastCommon) {
    return system_variable(number, place);
  }
  control_.fail("undefined-parameter", reader_.column_of(place),
                fmt::format("#{} is vacant: nothing assigned it", number), "assign it before it is read");
}

double Fanuc::system_variable(long number, size_t place) {
  const auto in_words = [&](double value, long word) {
    return word < 3 ? value / control_.mm(1.0) : deg_from_rad(value);
  };
  const auto programmed = [&](long word) {
    const double value = control_.position()[static_cast<size_t>(word)];
    if (!std::isfinite(value))
      control_.fail("start-unknown", reader_.column_of(place),
                    fmt::format("#{} asks for a position that is not known yet", number),
                    "give the start position in the scene");
    return in_words(value, word);
  };
  if (number >= 5001 && number <= 5006) return programmed(number - 5001);
  if (number >= 5041 && number <= 5046) return programmed(number - 5041);
  if (number >= 5021 && number <= 5026) {
    const long word = number - 5021;
    const int axis = control_.axis_of(static_cast<AxisWord>(word));
    return axis < 0 ? 0.0 : in_words(control_.axis_values()[axis], word);
  }
  if (number >= 5221 && number <= 5326 && (number - 5221) % 20 < kAxisWords) {
    const long word = (number - 5221) % 20;
    const int axis = control_.axis_of(static_cast<AxisWord>(word));
    return axis < 0
               ? 0.0
               : in_words(control_.offset_origin(static_cast<int>((number - 5221) / 20 + 1))[axis], word);
  }
  if (number == 4120) return control_.tool_number();
  if (number == 4119) return control_.speed_rpm();
  if (number == 4109) return control_.feed();
  control_.fail("undefined-parameter", reader_.column_of(place),
                fmt::format("#{} is no variable that can be read here", number),
                "read #5001 to #5046 (positions) or #5221 to #5326 (offsets)");
}

double Fanuc::read_named(std::string_view name, size_t place) {
  control_.fail("bad-parameter", reader_.column_of(place),
                fmt::format("#<{}>: this dialect has no named variables", name), "write #100");
}

bool Fanuc::exists(std::string_view /*name*/) {
  return false;
}

bool Fanuc::vacant(long number) const {
  if (number >= 1 && number <= kLocals) return (calls_[locals()].assigned >> number & 1u) == 0;
  if (number >= kFirstCommon && number <= kLastCommon) return !common_set_[static_cast<size_t>(number)];
  return number == 0;
}

namespace {

Evidence recognise(std::string_view head, std::string_view extension) {
  (void)extension;
  Evidence evidence;
  long number = 0;
  const auto add = [&](int score, std::string_view what) {
    if (evidence.score == 0) evidence.reason = fmt::format("{} in line {}", what, number);
    evidence.score += score;
  };
  while (!head.empty()) {
    ++number;
    const size_t end = std::min(head.find('\n'), head.size());
    std::string line(head.substr(0, end));
    head.remove_prefix(std::min(end + 1, head.size()));
    std::transform(line.begin(), line.end(), line.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const std::string code = line.substr(0, line.find_first_of("(;"));
    for (const char* word :
         {"G43.4", "G43.5", "G53.1", "G68.2", "G06.2", "G6.2", "G05.1", "G5.1", "G65", "G54.1", "G05 P"}) {
      if (code.find(word) != std::string::npos) add(2, word);
    }
    if (code.find("GOTO") != std::string::npos || code.find("WHILE [") == 0 || code.find("WHILE[") == 0 ||
        code.find("IF[") == 0 || code.find("IF [") == 0)
      add(2, "a macro statement");
    const size_t o = code.find_first_not_of(" \t");
    const bool program_number =
        o != std::string::npos && (code[o] == 'O' || code[o] == ':') && code.size() >= o + 5 &&
        std::all_of(code.begin() + static_cast<long>(o) + 1, code.begin() + static_cast<long>(o) + 5,
                    [](unsigned char c) { return std::isdigit(c) != 0; }) &&
        code.find_first_not_of(" \t\r", o + 5) == std::string::npos;
    if (program_number) add(2, code.substr(o, 5));
  }
  return evidence;
}

void run(const std::string& path, Control& control) {
  Fanuc(path, control).run();
}

}  // namespace

const DialectReader kFanucReader{Dialect::kFanuc, "fanuc", recognise, run};

}  // namespace swarf::program::nc

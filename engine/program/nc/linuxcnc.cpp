#include "program/nc/linuxcnc.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/nc/dialect.h"

namespace swarf::program::nc {
namespace {

constexpr long kNumbers = 5400;
constexpr long kArguments = 30;
constexpr std::string_view kPositionNames[] = {"_x", "_y", "_z", "_a", "_b", "_c"};

}  // namespace

LinuxCnc::LinuxCnc(const std::string& path, Control& control)
    : LetterDialect(path, control, kLinuxCncFormula), numbers_(kNumbers, 0.0), number_set_(kNumbers, false) {
  Call main;
  main.source = &open(path);
  calls_.push_back(std::move(main));
  control_.set_feed_rule(FeedRule::kLinearFirst);
  control_.set_compensation_entry(CompensationEntry::kAlongEntry);
}

void LinuxCnc::run() {
  std::string_view line;
  while (!ended_) {
    if (!source().next(line)) {
      end_of_flow();
      continue;
    }
    at_line(source());
    if (!percent(line)) ended_ = !execute();
  }
  control_.finish();
}

bool LinuxCnc::execute() {
  if (at_o_word()) {
    ++control_.summary().blocks;
    flow();
    return true;
  }
  block_.clear();
  new_numbers_.clear();
  new_names_.clear();
  read_words(kLinuxCncSyntax, reader_, control_, block_, '#');
  while (reader_.peek() == '#') {
    read_assignment();
    read_words(kLinuxCncSyntax, reader_, control_, block_, '#');
  }
  if (!block_.message.empty()) control_.note("MSG", block_.message);
  if (block_.skip_mark) control_.without_effect("/ (block delete is off: such blocks are executed)");
  if (!block_.empty()) {
    ++control_.summary().blocks;
    control_.at(source().file(), static_cast<int>(source().line_number()), reader_.column_of(block_.first));
    check_words();
  }
  assign();
  if (block_.empty()) return true;
  apply();
  return apply_end();
}

void LinuxCnc::read_assignment() {
  const size_t from = reader_.at();
  std::string name;
  const long number = reader_.parameter_number(name);
  reader_.skip_space();
  if (reader_.peek() != '=')
    control_.fail("bad-parameter", reader_.column(), "'=' is missing after the parameter", "write #1=2.5");
  reader_.skip();
  const double value = reader_.value();
  if (!name.empty()) {
    new_names_.emplace_back(std::move(name), value);
    return;
  }
  if (number < 1 || number >= kNumbers)
    control_.fail("bad-parameter", reader_.column_of(from), fmt::format("#{} cannot be assigned", number),
                  "parameters that programs may set have numbers from 1 to 5399");
  if (number >= 5161)
    control_.fail("unsupported-word", reader_.column_of(from),
                  fmt::format("#{} belongs to the control (reference positions, offsets)", number),
                  "set offsets with G10, G52 or G92");
  new_numbers_.emplace_back(number, value);
}

void LinuxCnc::assign() {
  for (const auto& [number, value] : new_numbers_) {
    if (number <= kArguments) {
      frame().arguments[static_cast<size_t>(number)] = value;
      frame().assigned |= uint64_t{1} << number;
    } else {
      numbers_[static_cast<size_t>(number)] = value;
      number_set_[static_cast<size_t>(number)] = true;
    }
  }
  for (auto& [name, value] : new_names_) {
    auto& list = name[0] == '_' ? globals_ : frame().named;
    const auto found =
        std::find_if(list.begin(), list.end(), [&n = name](const Named& one) { return one.name == n; });
    if (found != list.end())
      found->value = value;
    else
      list.push_back({name, value});
  }
}

double LinuxCnc::read(long number, size_t place) {
  if (number >= 1 && number <= kArguments) {
    // Arguments that a call does not give are zero; the main program has none.
    if ((frame().assigned >> number & 1u) != 0 || calls_.size() > 1)
      return frame().arguments[static_cast<size_t>(number)];
  } else if (number > kArguments && number < kNumbers && number_set_[static_cast<size_t>(number)]) {
    return numbers_[static_cast<size_t>(number)];
  } else if (number >= 5161) {
    return system_parameter(number, place);
  }
  control_.fail("undefined-parameter", reader_.column_of(place),
                fmt::format("#{} has no value: nothing assigned it", number), "assign it before it is read");
}

double LinuxCnc::system_parameter(long number, size_t place) {
  const double unit = control_.mm(1.0);
  const auto by_word = [&](const kinematics::AxisValues& q, long word) {
    const int axis = word < kAxisWords ? control_.axis_of(static_cast<AxisWord>(word)) : -1;
    return axis < 0 ? 0.0 : word < 3 ? q[axis] / unit : deg_from_rad(q[axis]);
  };
  for (const long first : {5161L, 5181L}) {
    const bool second = first == 5181;
    if (number >= first && number < first + 9 && reference_position(second))
      return by_word(*reference_position(second), number - first);
  }
  if (number >= 5211 && number <= 5219) return by_word(shift_, number - 5211);
  if (number == 5220) return control_.work_offset();
  if (number >= 5221 && number <= 5389) {
    const long offset = (number - 5221) / 20 + 1, word = (number - 5221) % 20;
    if (word == 9) return deg_from_rad(offset_turn_[static_cast<size_t>(offset)]);
    return by_word(control_.offset_origin(static_cast<int>(offset)), word);
  }
  if (number == 5400) return control_.tool_number();
  if (number == 5403) return control_.length_compensation() / unit;
  if (number == 5410)
    return control_.active_tool() == nullptr ? 0.0 : control_.active_tool()->diameter_mm / unit;
  if (number >= 5420 && number <= 5428) {
    const long word = number - 5420;
    if (word >= kAxisWords) return 0.0;
    const double value = control_.position()[static_cast<size_t>(word)];
    if (!std::isfinite(value))
      control_.fail("start-unknown", reader_.column_of(place),
                    fmt::format("#{} asks for a position that is not known yet", number),
                    "give the start position in the scene");
    return word < 3 ? value / unit : deg_from_rad(value);
  }
  control_.fail("undefined-parameter", reader_.column_of(place),
                fmt::format("#{} is no parameter that can be read here", number),
                "read #5211 to #5389 (offsets), #5400 to #5410 (tool), #5420 to #5425 (position)");
}

double LinuxCnc::read_named(std::string_view name, size_t place) {
  const auto& list = name[0] == '_' ? globals_ : frame().named;
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& one) { return one.name == name; });
  if (found != list.end()) return found->value;
  for (long word = 0; word < kAxisWords; ++word) {
    if (name == kPositionNames[word]) return system_parameter(5420 + word, place);
  }
  if (const std::optional<double> value = predefined(name)) return *value;
  control_.fail("undefined-parameter", reader_.column_of(place),
                fmt::format("#<{}> has no value: nothing assigned it", name),
                "assign it before it is read, or ask EXISTS first");
}

std::optional<double> LinuxCnc::predefined(std::string_view name) const {
  const FeedMode feed = control_.feed_mode();
  const Compensation side = control_.compensation();
  const std::pair<std::string_view, double> values[] = {
      {"_feed", control_.feed()},
      {"_rpm", control_.speed_rpm()},
      {"_current_tool", control_.tool_number()},
      {"_selected_tool", control_.selected_number()},
      {"_tool_offset", control_.length_compensation() / control_.mm(1.0)},
      {"_metric", control_.inches() ? 0.0 : 1.0},
      {"_imperial", control_.inches() ? 1.0 : 0.0},
      {"_absolute", incremental_ ? 0.0 : 1.0},
      {"_incremental", incremental_ ? 1.0 : 0.0},
      {"_inverse_time", feed == FeedMode::kInverseTime ? 1.0 : 0.0},
      {"_units_per_minute", feed == FeedMode::kPerMinute ? 1.0 : 0.0},
      {"_units_per_rev", feed == FeedMode::kPerRevolution ? 1.0 : 0.0},
      {"_ijk_absolute_mode", arc_absolute_ ? 1.0 : 0.0},
      {"_ijk_incremental_mode", arc_absolute_ ? 0.0 : 1.0},
      {"_retract_r_plane", retract_to_r_ ? 1.0 : 0.0},
      {"_retract_old_z", retract_to_r_ ? 0.0 : 1.0},
      {"_plane", 170.0 + 10.0 * static_cast<int>(control_.plane())},
      {"_ccomp", side == Compensation::kOff    ? 400.0
                 : side == Compensation::kLeft ? 410.0
                                               : 420.0},
      {"_line", static_cast<double>(calls_.back().source->line_number())},
      {"_motion_mode", motion_},
      {"_call_level", static_cast<double>(calls_.size() - 1)},
      {"_value", returned_},
      {"_value_returned", value_returned_ ? 1.0 : 0.0},
      {"_spindle_on", control_.spindle() != 0 ? 1.0 : 0.0},
      {"_spindle_cw", control_.spindle() > 0 ? 1.0 : 0.0},
      {"_coord_system",
       control_.work_offset() <= 6 ? 530 + 10 * control_.work_offset() : 584 + control_.work_offset()},
  };
  for (const auto& [word, value] : values) {
    if (word == name) return value;
  }
  return std::nullopt;
}

bool LinuxCnc::exists(std::string_view name) {
  const auto& list = name[0] == '_' ? globals_ : frame().named;
  return std::any_of(list.begin(), list.end(), [&](const Named& one) { return one.name == name; }) ||
         std::find(std::begin(kPositionNames), std::end(kPositionNames), name) != std::end(kPositionNames) ||
         predefined(name).has_value();
}

namespace {

/// Words that no other dialect here has: O-words with keywords, named parameters, G10 L2 P, kinematics
/// switches.
Evidence recognise(std::string_view head, std::string_view extension) {
  Evidence evidence;
  const auto add = [&](int score, std::string reason) {
    if (evidence.score == 0) evidence.reason = std::move(reason);
    evidence.score += score;
  };
  long number = 0;
  while (!head.empty()) {
    ++number;
    const size_t end = std::min(head.find('\n'), head.size());
    std::string line(head.substr(0, end));
    head.remove_prefix(std::min(end + 1, head.size()));
    std::transform(line.begin(), line.end(), line.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const std::string code = line.substr(0, line.find_first_of("(;"));
    const size_t o = code.find_first_not_of(" \t");
    const bool o_word = o != std::string::npos && code[o] == 'O';
    for (const char* keyword : {" SUB", " CALL", " WHILE", " IF", " REPEAT", " DO", " ENDSUB"}) {
      if (o_word && code.find(keyword) != std::string::npos)
        add(3, fmt::format("an O word in line {}", number));
    }
    if (code.find("#<") != std::string::npos) add(3, fmt::format("a named parameter in line {}", number));
    for (const char* word : {"G64 P", "G43.1", "G59.1", "G90.1", "G91.1", "M428", "M429", "G92.1"}) {
      if (code.find(word) != std::string::npos) add(2, fmt::format("{} in line {}", word, number));
    }
  }
  if (extension == ".ngc") add(2, "the file's ending .ngc");
  return evidence;
}

void run(const std::string& path, Control& control) {
  LinuxCnc(path, control).run();
}

}  // namespace

const DialectReader kLinuxCncReader{Dialect::kLinuxCnc, "linuxcnc", recognise, run};

}  // namespace swarf::program::nc

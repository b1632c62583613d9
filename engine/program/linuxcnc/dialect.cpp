#include "program/linuxcnc/reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "program/linuxcnc/dialect.h"

namespace swarf::program::nc::linuxcnc {
namespace {

/// Corners up to 0.05 rad are none to LinuxCNC: no arc and no intersection joins the pieces, and the cutter
/// may cut radius (1 - cos 0.05 rad) too deep there (measured on LinuxCNC 2.9).
constexpr double kSmoothCornerRad = 0.05;

}  // namespace

LinuxCnc::LinuxCnc(const std::string& path, Control& control)
    : LetterDialect(path, control, kLinuxCncFormula), numbers_(kNumbers, 0.0), number_set_(kNumbers, false) {
  Call main;
  main.source = &open(path);
  calls_.push_back(std::move(main));
  control_.modal.feed_rule = FeedRule::kLinearFirst;
  control_.contour.set_entry(CompensationEntry::kAlongEntry);
  control_.contour.set_smooth(kSmoothCornerRad);
  if (control.setup.kinematics_switch.start == Kinematics::kTcp) nc::set_tcp(control_, Tcp::kAxes);
}

void LinuxCnc::run() {
  std::string_view line;
  while (!ended_) {
    if (!source().next(line)) {
      end_of_flow();
      continue;
    }
    at_line(source());
    if (!percent(line, true)) ended_ = !execute();
  }
  if (nurbs_) fail_open_nurbs();
  nc::finish(control_);
}

bool LinuxCnc::execute() {
  if (at_o_word()) {
    ++control_.report.summary.blocks;
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
  if (!block_.message.empty()) control_.report.note("MSG", message_text());
  if (block_.skip_mark) control_.report.without_effect("/ (block delete is off: such blocks are executed)");
  if (!block_.empty()) {
    ++control_.report.summary.blocks;
    control_.report.at(source().file(), static_cast<int>(source().line_number()),
                       reader_.column_of(block_.first));
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
    control_.report.fail("bad-parameter", reader_.column(), "'=' is missing after the parameter",
                         "write #1=2.5");
  reader_.skip();
  const double value = reader_.value();
  if (!name.empty()) {
    if (is_read_only(name))
      control_.report.fail("read-only-parameter", reader_.column_of(from),
                           fmt::format("#<{}> belongs to the control and cannot be assigned", name),
                           "take another name");
    new_names_.emplace_back(std::move(name), value);
    return;
  }
  if (number < 1 || number >= kNumbers)
    control_.report.fail("bad-parameter", reader_.column_of(from),
                         fmt::format("#{} cannot be assigned", number),
                         "parameters that programs may set have numbers from 1 to 5399");
  if (number >= 5161)
    control_.report.fail("unsupported-word", reader_.column_of(from),
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

/// Words that no other dialect here has: O-words with keywords, named parameters, G10 L2 P, kinematics
/// switches.
Evidence evidence(std::string_view head, std::string_view extension) {
  Evidence found;
  const auto add = [&](int score, std::string reason) {
    if (found.score == 0) found.reason = std::move(reason);
    found.score += score;
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
    for (const char* word : {"G64 P", "G43.1", "G59.1", "G90.1", "G91.1", "M428", "M429", "M430", "G92.1"}) {
      if (code.find(word) != std::string::npos) add(2, fmt::format("{} in line {}", word, number));
    }
  }
  if (extension == ".ngc") add(2, "the file's ending .ngc");
  return found;
}

void run(const std::string& path, Control& control) {
  LinuxCnc(path, control).run();
}

}  // namespace swarf::program::nc::linuxcnc

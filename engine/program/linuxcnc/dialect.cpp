#include "program/linuxcnc/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "program/control/presets.h"
#include "program/linuxcnc/dialect.h"

namespace swarf::program::nc::linuxcnc {
namespace {

/// Corners up to 0.05 rad are none to LinuxCNC: no arc and no intersection joins the pieces, and the cutter
/// may cut radius (1 - cos 0.05 rad) too deep there (measured on LinuxCNC 2.9).
constexpr double kSmoothCornerRad = 0.05;

void read_assignment(LinuxCnc& linuxcnc) {
  const size_t from = linuxcnc.reader.at();
  std::string name;
  const long number = linuxcnc.reader.parameter_number(name);
  linuxcnc.reader.skip_space();
  if (linuxcnc.reader.peek() != '=')
    linuxcnc.control.report.fail("bad-parameter", linuxcnc.reader.column(),
                                 "'=' is missing after the parameter", "write #1=2.5");
  linuxcnc.reader.skip();
  const double value = linuxcnc.reader.value();
  if (!name.empty()) {
    if (is_read_only(linuxcnc, name))
      linuxcnc.control.report.fail("read-only-parameter", linuxcnc.reader.column_of(from),
                                   fmt::format("#<{}> belongs to the control and cannot be assigned", name),
                                   "take another name");
    linuxcnc.parameters.new_names.emplace_back(std::move(name), value);
    return;
  }
  if (number == kDebugOutput) {
    linuxcnc.control.report.without_effect("#5599 (output of DEBUG comments)");
    linuxcnc.parameters.debug_output = value;
    return;
  }
  if (number < 1 || number >= kNumbers)
    linuxcnc.control.report.fail("bad-parameter", linuxcnc.reader.column_of(from),
                                 fmt::format("#{} cannot be assigned", number),
                                 "parameters that programs may set have numbers from 1 to 5399");
  if (number >= kControlNumbers)
    linuxcnc.control.report.fail(
        "unsupported-word", linuxcnc.reader.column_of(from),
        fmt::format("#{} belongs to the control (reference positions, offsets)", number),
        "set offsets with G10, G52 or G92");
  linuxcnc.parameters.new_numbers.emplace_back(number, value);
}

void assign(Calls& calls, NumbersAndNames& parameters) {
  for (const auto& [number, value] : parameters.new_numbers) {
    if (number <= kArguments) {
      frame(calls).arguments[static_cast<size_t>(number)] = value;
      frame(calls).assigned |= uint64_t{1} << number;
    } else {
      parameters.numbers[static_cast<size_t>(number)] = value;
      parameters.number_set[static_cast<size_t>(number)] = true;
    }
  }
  for (auto& [name, value] : parameters.new_names) {
    auto& list = name[0] == '_' ? parameters.globals : frame(calls).named;
    const auto found =
        std::find_if(list.begin(), list.end(), [&n = name](const Named& one) { return one.name == n; });
    if (found != list.end())
      found->value = value;
    else
      list.push_back({name, value});
  }
}

/// #1 to #5160, and the global names that a program may set.
void set_presets(LinuxCnc& linuxcnc) {
  for (const auto& [name, preset] : linuxcnc.control.setup.presets) {
    const long number = preset_number(name, "").value_or(0);
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (number >= 1 && number < kControlNumbers)
      linuxcnc.parameters.new_numbers.emplace_back(number, preset.value);
    else if (name.starts_with('_') && !is_read_only(linuxcnc, lower))
      linuxcnc.parameters.new_names.emplace_back(lower, preset.value);
    else
      refuse_preset(name, preset, "programs may set #1 to #5160 and names such as #<_depth>: 500 = 3.5");
  }
  assign(linuxcnc.calls, linuxcnc.parameters);
}

bool execute(LinuxCnc& linuxcnc) {
  if (at_o_word(linuxcnc)) {
    ++linuxcnc.control.report.summary.blocks;
    flow(linuxcnc);
    return true;
  }
  linuxcnc.block.clear();
  linuxcnc.parameters.new_numbers.clear();
  linuxcnc.parameters.new_names.clear();
  read_words(kLinuxCncSyntax, linuxcnc.reader, linuxcnc.control, linuxcnc.block, '#');
  while (linuxcnc.reader.peek() == '#') {
    read_assignment(linuxcnc);
    read_words(kLinuxCncSyntax, linuxcnc.reader, linuxcnc.control, linuxcnc.block, '#');
  }
  if (!linuxcnc.block.message.empty()) {
    linuxcnc.parameters.in_message = true;
    const std::string text = message_text(linuxcnc);
    linuxcnc.parameters.in_message = false;
    linuxcnc.control.report.note("MSG", text);
  }
  if (linuxcnc.block.skip_mark)
    linuxcnc.control.report.without_effect("/ (block delete is off: such blocks are executed)");
  if (!linuxcnc.block.empty()) {
    ++linuxcnc.control.report.summary.blocks;
    linuxcnc.control.report.at(source(linuxcnc.calls).file(),
                               static_cast<int>(source(linuxcnc.calls).line_number()),
                               linuxcnc.reader.column_of(linuxcnc.block.first));
    polar_words(linuxcnc);
    check_words(linuxcnc.modes, linuxcnc.curves, linuxcnc);
  }
  assign(linuxcnc.calls, linuxcnc.parameters);
  if (linuxcnc.block.empty()) return true;
  apply(linuxcnc);
  return apply_end(linuxcnc);
}

void run(LinuxCnc& linuxcnc) {
  std::string_view line;
  while (!linuxcnc.ended) {
    if (!source(linuxcnc.calls).next(line)) {
      end_of_flow(linuxcnc.calls, linuxcnc);
      continue;
    }
    linuxcnc.at_line(source(linuxcnc.calls));
    if (!linuxcnc.percent(line, true)) linuxcnc.ended = !execute(linuxcnc);
  }
  if (linuxcnc.curves.nurbs) fail_open_nurbs(linuxcnc.curves, linuxcnc);
  nc::finish(linuxcnc.control);
}

}  // namespace

LinuxCnc::LinuxCnc(const std::string& file, Control& machine)
    : LetterDialect(file, machine, kLinuxCncFormula) {
  parameters.numbers.assign(kNumbers, 0.0);
  parameters.number_set.assign(kNumbers, false);
  Call main;
  main.source = &open(file);
  calls.stack.enter(std::move(main));
  control.modal.feed_rule = FeedRule::kLinearFirst;
  control.contour.set_entry(CompensationEntry::kAlongEntry);
  control.contour.set_smooth(kSmoothCornerRad);
  set_presets(*this);
  if (control.setup.kinematics_switch.start == Kinematics::kTcp) nc::set_tcp(control, Tcp::kAxes);
}

/// Words that no other dialect here has: O-words with keywords, named parameters, G10 L2 P, kinematics
/// switches.
Evidence evidence(const ProgramHead& head) {
  Evidence found;
  for (const HeadLine& line : head.lines) {
    for (const char* keyword : {" SUB", " CALL", " WHILE", " IF", " REPEAT", " DO", " ENDSUB"}) {
      if (line.code.starts_with('O') && line.code.find(keyword) != std::string::npos)
        found.add(3, "an O word", line.number);
    }
    if (line.code.find("#<") != std::string::npos) found.add(3, "a named parameter", line.number);
    if (line.code.find("G64 P") != std::string::npos) found.add(2, "G64 P", line.number);
    for (const char* word : {"G43.1", "G59.1", "G90.1", "G91.1", "M428", "M429", "M430", "G92.1"}) {
      if (has_word(line.code, word)) found.add(2, word, line.number);
    }
  }
  if (head.extension == ".ngc") {
    if (found.score == 0) found.reason = "the file's ending .ngc";
    found.score += 2;
  }
  return found;
}

void run(const std::string& path, Control& control) {
  LinuxCnc linuxcnc(path, control);
  run(linuxcnc);
}

}  // namespace swarf::program::nc::linuxcnc

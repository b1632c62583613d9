// What the machine and its configuration decide: the kinematics behind M428, M429 and M430, inputs, outputs.
#include <fmt/format.h>

#include <algorithm>

#include "program/linuxcnc/steps.h"

namespace swarf::program::nc::linuxcnc {
namespace {

/// A reading that the configuration could contradict is told, once for each code.
void assume_kinematics(Modes& modes, LetterDialect& letters, int number, Kinematics kinematics, int column) {
  const auto index = static_cast<size_t>(number - 428);
  if (modes.kinematics_told[index]) return;
  modes.kinematics_told[index] = true;
  const Place place = letters.control.report.place;
  letters.control.report.diagnostics.note(
      "kinematics-assumed",
      {letters.control.report.summary.files[static_cast<size_t>(place.file)], place.line, column},
      fmt::format(
          "M{} is taken as {}, as on the machines that come with LinuxCNC; if this machine's INI file "
          "means something else, say so in the scene: kinematics_switch = {{ m{} = \"{}\" }}",
          number, kinematics == Kinematics::kTcp ? "TCP" : "identity (axis by axis)", number,
          kinematics == Kinematics::kTcp ? "identity" : "tcp"));
}

}  // namespace

/// "Switchable kinematics" of the LinuxCNC documentation: M428, M429, M430 are remaps of the configuration.
/// Those that come with LinuxCNC select the machine's own kinematics, identity, and userk, whose template is
/// identity until somebody fills it in.
void switch_kinematics(Modes& modes, LetterDialect& letters, int tenths, int column) {
  const KinematicsSwitch& told = letters.control.setup.kinematics_switch;
  const int number = tenths / 10;
  std::optional<Kinematics> kinematics = tenths == M::kFirstKinematics    ? told.m428
                                         : tenths == M::kSecondKinematics ? told.m429
                                                                          : told.m430;
  if (!kinematics) {
    if (tenths == M::kThirdKinematics) {
      letters.control.report.fail(
          "unknown-kinematics", column, "M430 selects the user's kinematics, and nothing says what they are",
          "add kinematics_switch = { m430 = \"identity\" } (or \"tcp\") to the scene; on the command "
          "line: --kinematics m430=identity");
    }
    kinematics = tenths == M::kFirstKinematics ? Kinematics::kTcp : Kinematics::kIdentity;
    assume_kinematics(modes, letters, number, *kinematics, column);
  }
  nc::set_tcp(letters.control, kinematics == Kinematics::kTcp ? Tcp::kAxes : Tcp::kOff);
}

/// M66: what it reads and how long it waits is not in the program. Its path is: the program goes on behind it
/// in any case, and only a program that reads #5399 is stopped there.
void read_input(Modes& modes, LetterDialect& letters) {
  const bool digital = letters.block.has('P'), analog = letters.block.has('E');
  const int mode =
      letters.block.has('L') ? whole(letters.block, 'L', 0, 4, letters.reader, letters.control) : 0;
  if (digital == analog)
    letters.control.report.fail(
        digital ? "modal-conflict" : "missing-word", letters.reader.column_of(letters.block.first),
        digital ? "M66 reads a digital input P or an analog one E, and both stand here"
                : "M66 does not say which input it reads",
        digital ? "write P or E" : "add P for a digital input, E for an analog one");
  if (analog && mode != 0)
    letters.control.report.fail("out-of-range", letters.column('L'), "M66 cannot wait for an analog input",
                                "write L0");
  if (mode != 0 && letters.block.has('Q') && !(letters.block.get('Q') > 0.0))
    letters.control.report.fail(
        "out-of-range", letters.column('Q'),
        fmt::format("M66 L{} with a time limit of {:g} s", mode, letters.block.get('Q')),
        "write Q above zero, in seconds");
  modes.input_read = true;
  letters.control.report.without_effect(mode == 0 ? "M66 (an input is read; its value is not known here)"
                                                  : "M66 (waits for an input; how long is not known here)");
}

/// The remaps of LinuxCNC's own machines select their kinematics by analog output 3.
void warn_of_output(LetterDialect& letters) {
  constexpr double kSwitchingOutput = 3.0;
  const kinematics::MachineModel& machine = letters.control.setup.machine;
  const bool turns = std::any_of(machine.axes.begin(), machine.axes.end(), [](const kinematics::Axis& axis) {
    return axis.kind == kinematics::AxisKind::kRotary;
  });
  if (!turns || letters.block.get('E', 0.0) != kSwitchingOutput) return;
  letters.control.report.warn_once(
      "output-may-switch-kinematics", letters.column('E'),
      "analog output 3 selects the kinematics on LinuxCNC's own five-axis machines; outputs have no "
      "effect here, the kinematics stay what they are",
      "write M428, M429 or M430 where the kinematics change");
}

}  // namespace swarf::program::nc::linuxcnc

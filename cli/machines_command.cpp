#include <fmt/format.h>

#include <algorithm>

#include "base/units.h"
#include "cli/commands.h"
#include "machine/machine_scene.h"
#include "machine/shipped.h"

namespace swarf::cli {
namespace {

using kinematics::Axis;
using kinematics::AxisKind;

int rotaries(const kinematics::MachineModel& model, const std::vector<int>& chain) {
  return static_cast<int>(std::count_if(chain.begin(), chain.end(), [&](int axis) {
    return model.axes[static_cast<size_t>(axis)].kind == AxisKind::kRotary;
  }));
}

/// Which side turns.
std::string kind_of(const kinematics::MachineModel& model) {
  const int table = rotaries(model, model.table_chain), head = rotaries(model, model.head_chain);
  if (table + head == 0) return "3 axes";
  const std::string sides = table == 2          ? "table turns and tilts"
                            : head == 2         ? "head turns and tilts"
                            : table + head == 2 ? "head tilts, table turns"
                            : table == 1        ? "table turns"
                                                : "head tilts";
  return fmt::format("{} axes, {}", model.axes.size(), sides);
}

std::string travel_of(const Axis& axis) {
  const bool rotary = axis.kind == AxisKind::kRotary;
  const double scale = rotary ? deg_from_rad(1.0) : 1.0;
  return fmt::format("{} {:g} to {:g} {}", axis.name, scale * axis.min, scale * axis.max,
                     rotary ? "deg" : "mm");
}

int list_machines() {
  const std::vector<machine::ShippedMachine> machines = machine::shipped_machines();
  if (machines.empty())
    throw InputError(
        "no-machines", {"swarf machines"}, "no folder of machines lies above the program",
        "keep assets/machines (or share/swarf/assets/machines) above it, or name a machine.toml");
  for (const machine::ShippedMachine& one : machines) {
    const machine::MachineScene scene = machine::load_machine(one.file);
    fmt::print("{:<16} {} ({})\n", one.name, scene.model.name, kind_of(scene.model));
    std::string travel;
    for (const Axis& axis : scene.model.axes) travel += (travel.empty() ? "" : ", ") + travel_of(axis);
    fmt::print("{:<16} {}\n{:<16} {}\n", "", travel, "", one.file);
  }
  return kPass;
}

}  // namespace

void add_machines(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("machines", "List the machines that come with swarf: axes, travel, kind, file");
  command->footer(
      R"(Their names stand for their files: swarf run part.nc --tool 6 --machine spinner_u5_620, in a scene
machine = "spinner_u5_620". 'swarf show FILE -o machine.png' draws one, 'swarf init --machine NAME' copies one.)");
  command->callback([&exit_code] { exit_code = list_machines(); });
}

}  // namespace swarf::cli

#include "cli/check_nc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "base/units.h"
#include "cli/terminal.h"
#include "machine/machine_scene.h"
#include "program/nc_program.h"

namespace swarf::cli {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;

constexpr std::array kDialects{program::Dialect::kLinuxCnc, program::Dialect::kFanuc,
                               program::Dialect::kSiemens, program::Dialect::kHeidenhain};

/// Three axes that go anywhere, for programs without rotary words.
kinematics::MachineModel plain_machine() {
  kinematics::MachineModel machine;
  machine.name = "XYZ without limits";
  const std::array<Vec3, 3> directions{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (size_t i = 0; i < 3; ++i) {
    kinematics::Axis axis;
    axis.name = std::string(1, "XYZ"[i]);
    axis.side = kinematics::Side::kHead;
    axis.direction_M = directions[i];
    axis.min = -std::numeric_limits<double>::infinity();
    axis.max = std::numeric_limits<double>::infinity();
    machine.axes.push_back(axis);
    machine.head_chain.push_back(static_cast<int>(i));
  }
  return machine;
}

/// Adds up the moves; keeps none.
class Totals final : public program::NcSink {
 public:
  explicit Totals(const kinematics::MachineModel& machine) : machine_(machine) {}
  bool move(const program::NcMove& move) override {
    (move.rapid ? rapids : feeds) += 1;
    feed_s += move.duration_s;
    dwell_s += move.dwell_s;
    if (feeds + rapids == 1) low = high = move.q_from;
    low = low.cwiseMin(move.q_to);
    high = high.cwiseMax(move.q_to);
    if (move.arc) ++arcs;
    for (size_t i = 0; i < machine_.axes.size() && out_of_travel.empty(); ++i) {
      const kinematics::Axis& axis = machine_.axes[i];
      const double q = move.q_to[static_cast<long>(i)];
      if (q < axis.min - 1e-9 || q > axis.max + 1e-9)
        out_of_travel = fmt::format("{} leaves its travel first in line {}", axis.name, move.line);
    }
    return true;
  }
  long rapids = 0, feeds = 0, arcs = 0;
  double feed_s = 0.0, dwell_s = 0.0;
  AxisValues low = AxisValues::Zero(), high = AxisValues::Zero();
  std::string out_of_travel;

 private:
  const kinematics::MachineModel& machine_;
};

std::string travel(const kinematics::MachineModel& machine, const Totals& totals) {
  std::string text;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const bool linear = machine.axes[i].kind == AxisKind::kLinear;
    const auto shown = [&](double q) { return linear ? q : deg_from_rad(q); };
    const auto index = static_cast<long>(i);
    text += fmt::format("\n  {} {:.3f} to {:.3f} {}", machine.axes[i].name, shown(totals.low[index]),
                        shown(totals.high[index]), linear ? "mm" : "deg");
  }
  return text;
}

std::optional<program::Dialect> chosen(const std::string& file, const std::string& name) {
  if (name.empty()) return std::nullopt;
  for (const program::Dialect dialect : kDialects) {
    if (name == program::dialect_name(dialect)) return dialect;
  }
  throw InputError("unknown-dialect", {file, 0, 0}, fmt::format("'{}' is no dialect", name),
                   "choose linuxcnc, fanuc, siemens or heidenhain");
}

/// G10 L70 opens a surface: that is a program of surface blocks.
bool has_surface_blocks(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(size_t{1} << 16, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(stream.gcount()));
  std::erase_if(head, [](unsigned char c) { return std::isspace(c) != 0; });
  return head.find("G10L7") != std::string::npos || head.find("G06.3") != std::string::npos;
}

std::string extension_of(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

bool is_nc_program(const std::string& file, const NcCheckOptions& options) {
  const std::string extension = extension_of(file);
  constexpr std::array kOwn{".ngc", ".mpf", ".spf", ".h", ".tap", ".eia"};
  if (std::find(kOwn.begin(), kOwn.end(), extension) != kOwn.end()) return true;
  if (extension == ".toml" || extension.starts_with(".cl") || extension == ".apt") return false;
  return !options.machine.empty() || !options.dialect.empty() || !has_surface_blocks(file);
}

std::string check_nc(const std::string& file, const NcCheckOptions& options) {
  program::ControlSetup setup;
  setup.machine = options.machine.empty() ? plain_machine() : machine::load_machine(options.machine).model;
  if (options.at_home) {
    AxisValues home = AxisValues::Zero();
    for (size_t i = 0; i < setup.machine.axes.size(); ++i)
      home[static_cast<long>(i)] = setup.machine.axes[i].home;
    setup.start = home;
  }
  Totals totals(setup.machine);
  Diagnostics diagnostics;
  const program::NcSummary summary =
      program::run_nc(file, chosen(file, options.dialect), setup, totals, diagnostics);
  diagnostics.throw_if_errors();
  print_diagnostics(diagnostics.list());
  std::string text = fmt::format(
      "NC program is right: {} ({}), {} lines, {} blocks, {} feed moves ({} arcs), {} rapids\n"
      "  feed moves {:.3f} s at the programmed feed, dwells {:.3f} s; rapids are timed by a run\n"
      "  machine: {}\n  start: {}",
      program::dialect_name(summary.dialect), summary.dialect_reason, summary.lines, summary.blocks,
      totals.feeds, totals.arcs, totals.rapids, totals.feed_s, totals.dwell_s, setup.machine.name,
      summary.start.empty() ? "no motion" : summary.start);
  if (totals.feeds + totals.rapids > 0) text += travel(setup.machine, totals);
  if (!totals.out_of_travel.empty()) text += "\n  finding: " + totals.out_of_travel;
  text += "\n  tools: not looked up (no tool table given), lengths are taken as 0 mm";
  if (!summary.functions.empty()) {
    text += "\n  read, without effect on the geometry:";
    for (const std::string& word : summary.functions) text += " " + word + ";";
  }
  return text;
}

}  // namespace swarf::cli

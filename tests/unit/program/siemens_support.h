// Runs programs of Siemens 840D for the tests and keeps everything that they give.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "base/units.h"
#include "program/control/control.h"
#include "program/siemens/dialect.h"
#include "support/scratch.h"
#include "unit/program/support.h"

namespace swarf::program::nc::siemens {

/// The machine of the shop's programs: X Y Z in the head, B and C under the work (the numbers of
/// assets/machines/spinner_u5_620/machine.toml).
inline kinematics::MachineModel spinner() {
  kinematics::MachineModel machine;
  machine.name = "Spinner U5-620";
  const auto axis = [&](const char* name, bool rotary, const Vec3& direction, double low, double high) {
    kinematics::Axis one;
    one.name = name;
    one.kind = rotary ? kinematics::AxisKind::kRotary : kinematics::AxisKind::kLinear;
    one.side = rotary ? kinematics::Side::kTable : kinematics::Side::kHead;
    one.direction_M = direction;
    one.min = rotary ? rad_from_deg(low) : low;
    one.max = rotary ? rad_from_deg(high) : high;
    one.speed_max = rotary ? rad_from_deg(90.0) : mm_s_from_mm_min(20000.0);
    one.acceleration_max = rotary ? rad_from_deg(400.0) : 4000.0;
    one.jerk_max = rotary ? rad_from_deg(8000.0) : 60000.0;
    machine.axes.push_back(one);
  };
  axis("X", false, Vec3::UnitX(), -365.0, 255.0);
  axis("Y", false, Vec3::UnitY(), -296.0, 224.0);
  axis("Z", false, Vec3::UnitZ(), 150.0, 610.0);
  axis("B", true, Vec3::UnitY(), -100.0, 100.0);
  axis("C", true, Vec3::UnitZ(), -36000.0, 36000.0);
  machine.axes[3].origin_M = Vec3(0.0, 0.0, 45.0);
  machine.axes[0].home = -365.0;
  machine.axes[1].home = 224.0;
  machine.axes[2].home = 610.0;
  machine.table_chain = {3, 4};
  machine.head_chain = {1, 0, 2};
  machine.gauge_M = Vec3::Zero();
  kinematics::AxisValues change = kinematics::AxisValues::Zero();
  change << -365.0, 224.0, 610.0, 0.0, 0.0;
  machine.tool_change = change;
  return machine;
}

inline ControlSetup setup_of(kinematics::MachineModel machine) {
  ControlSetup setup;
  setup.machine = std::move(machine);
  setup.tools = {{1, "MILL10", 120.0, 10.0, 0.0}, {2, "DRILL5", 100.0, 5.0, 0.0}};
  kinematics::AxisValues start = kinematics::AxisValues::Zero();
  start << 0.0, 0.0, 400.0, 0.0, 0.0;
  setup.start = start;
  setup.unit_mm = 1.0;
  return setup;
}

struct Ran : NcSink {
  std::vector<NcMove> moves;
  std::vector<NcNote> notes;
  Diagnostics diagnostics;
  NcSummary summary;
  bool move(const NcMove& one) override {
    moves.push_back(one);
    return true;
  }
  void note(const NcNote& one) override { notes.push_back(one); }
};

/// Runs a file; problems are in `ran.diagnostics`.
inline void run_file(const std::string& path, const ControlSetup& setup, Ran& ran) {
  try {
    nc::Control control(setup, ran, ran.diagnostics, ran.summary);
    nc::siemens::run(path, control);
  } catch (const InputError& error) {
    ran.diagnostics.append(error.diagnostics);
  }
}

inline std::string written(const std::string& text, const std::string& name = "siemens_test.mpf") {
  const std::string path = test::scratch_text() + "/" + std::to_string(getpid()) + "_" + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// Runs a text on the Spinner with the tip standing above the work's origin.
inline Ran run_text(const std::string& text, const ControlSetup& setup) {
  Ran ran;
  const std::string path = written(text);
  run_file(path, setup, ran);
  std::remove(path.c_str());
  return ran;
}
inline Ran run_text(const std::string& text) {
  return run_text(text, setup_of(spinner()));
}

/// The same, with the diagnostics in the failure when there are errors.
inline Ran run_clean(const std::string& text) {
  Ran ran = run_text(text);
  EXPECT_FALSE(ran.diagnostics.has_errors()) << all_text(ran.diagnostics) << "--- of the program\n" << text;
  return ran;
}

/// "code line:column" of each error.
inline std::vector<std::string> errors_of(const Diagnostics& diagnostics) {
  std::vector<std::string> found;
  for (const Diagnostic& d : diagnostics.list()) {
    if (d.severity != Severity::kError) continue;
    found.push_back(d.code + " " + std::to_string(d.where.line) + ":" + std::to_string(d.where.column));
  }
  return found;
}

}  // namespace swarf::program::nc::siemens

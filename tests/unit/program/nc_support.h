// What the tests of NC programs share: machines, a sink that keeps everything, programs from a string.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/units.h"
#include "program/nc_program.h"
#include "support/scratch.h"
#include "unit/kinematics/test_machines.h"

namespace swarf::program {

using kinematics::AxisValues;

/// X Y Z with the tip at the machine's origin for a tool of length 0; W is M.
inline kinematics::MachineModel three_axis_machine() {
  using kinematics::make_axis;
  using kinematics::Side;
  kinematics::MachineModel machine = kinematics::make_machine(
      "three axes", {make_axis("X", Side::kTable, Vec3::UnitX()), make_axis("Y", Side::kTable, Vec3::UnitY()),
                     make_axis("Z", Side::kHead, Vec3::UnitZ())});
  machine.gauge_M = Vec3::Zero();
  return machine;
}

/// Trunnion A with table C (theory 2), with a gauge line.
inline kinematics::MachineModel five_axis_machine() {
  kinematics::MachineModel machine = kinematics::table_table_ac();
  machine.gauge_M = Vec3(0.0, 0.0, 150.0);
  for (kinematics::Axis& axis : machine.axes) {
    if (axis.name == "A") axis.min = -kPi * 2.0 / 3.0, axis.max = kPi * 2.0 / 3.0;
  }
  return machine;
}

class Recorder final : public NcSink {
 public:
  bool move(const NcMove& one) override {
    moves.push_back(one);
    return moves.size() < stop_after;
  }
  void note(const NcNote& one) override { notes.push_back(one); }
  std::vector<NcMove> moves;
  std::vector<NcNote> notes;
  size_t stop_after = SIZE_MAX;
};

struct NcRun {
  Recorder sink;
  Diagnostics diagnostics;
  NcSummary summary;
  const std::vector<NcMove>& moves() const { return sink.moves; }
  std::string text() const {
    std::string all;
    for (const Diagnostic& one : diagnostics.list()) all += format(one) + "\n";
    return all;
  }
  /// "code line:column" of the first error; "" without one.
  std::string first_error() const {
    for (const Diagnostic& one : diagnostics.list()) {
      if (one.severity == Severity::kError)
        return one.code + " " + std::to_string(one.where.line) + ":" + std::to_string(one.where.column);
    }
    return "";
  }
};

inline ControlSetup three_axis_setup() {
  ControlSetup setup;
  setup.machine = three_axis_machine();
  setup.tools = {{1, "END8", 0.0, 8.0, 0.0}, {2, "END10", 50.0, 10.0, 0.0}, {7, "DRILL6", 80.0, 6.0, 0.0}};
  setup.start = AxisValues::Zero();
  setup.unit_mm = 1.0;
  return setup;
}

inline ControlSetup five_axis_setup() {
  ControlSetup setup = three_axis_setup();
  setup.machine = five_axis_machine();
  return setup;
}

inline NcRun run_file(const std::string& path, std::optional<Dialect> dialect, const ControlSetup& setup) {
  NcRun run;
  run.summary = run_nc(path, dialect, setup, run.sink, run.diagnostics);
  return run;
}

/// Writes `text` to a file of the running test's own and runs it.
inline NcRun run_text(const std::string& text, Dialect dialect, const ControlSetup& setup) {
  const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(info->test_suite_name()) + "_" + info->name();
  std::replace(name.begin(), name.end(), '/', '_');
  const auto path = test::scratch_folder() / ("swarf_nc_" + name + ".ngc");
  std::filesystem::remove(path);  // a new file: file systems flush one that is overwritten
  std::ofstream(path, std::ios::binary) << text;
  return run_file(path.string(), dialect, setup);
}

inline NcRun linuxcnc(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kLinuxCnc, setup);
}

inline void expect_tip(const NcMove& move, double x, double y, double z, double tolerance = 1e-9) {
  EXPECT_NEAR(move.to.tip_W.x(), x, tolerance) << "line " << move.line;
  EXPECT_NEAR(move.to.tip_W.y(), y, tolerance) << "line " << move.line;
  EXPECT_NEAR(move.to.tip_W.z(), z, tolerance) << "line " << move.line;
}

}  // namespace swarf::program

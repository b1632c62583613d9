// What the tests of posts share: CL data from a string, the program it becomes, and that program read back.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/units.h"
#include "kinematics/machine_model.h"
#include "kinematics/singularity.h"
#include "machine/machine_scene.h"
#include "post/post.h"
#include "post/shipped.h"
#include "program/nc_program.h"
#include "support/scratch.h"

namespace swarf::post {

inline std::string assets(const std::string& file) {
  return std::string(SWARF_SOURCE_DIR) + "/assets/" + file;
}
inline kinematics::MachineModel shipped_machine(const std::string& name) {
  return machine::load_machine(assets("machines/" + name + "/machine.toml")).model;
}
/// With the work high enough for a tool of 80 mm.
inline kinematics::MachineModel placed_machine(const std::string& name) {
  kinematics::MachineModel machine = shipped_machine(name);
  if (machine.gauge_M) machine.X_MW.translation().z() += 100.0;
  return machine;
}
inline PostFormat shipped_post(const std::string& name) {
  return load_post(assets("posts/" + name + ".toml"));
}

class NcMoves final : public program::NcSink {
 public:
  bool move(const program::NcMove& one) override {
    moves.push_back(one);
    return true;
  }
  std::vector<program::NcMove> moves;
};

/// The moves of the CL data as they have to be found: of a hole, however it is pecked, arrival, bottom and
/// end.
class ExpectedMoves final : public program::ClSink {
 public:
  void move(const program::Move& one) override {
    if (inner_ == 0) moves.push_back(one);
    if (inner_ > 0 && --inner_ == 0) end_hole(one);
  }
  void note(program::ClNote /*note*/) override {}
  void hole(const program::ClHole& hole) override {
    hole_ = hole;
    const auto steps = static_cast<int>(program::cycle_steps(hole.cycle).size());
    arrives_ = hole.moves > steps;
    inner_ = steps + (arrives_ ? 1 : 0);
  }
  std::vector<program::Move> moves;

 private:
  void end_hole(const program::Move& last) {
    const auto at = [&](double height) {
      return ToolPose{hole_.at.tip_W + height * hole_.at.axis_W, hole_.at.axis_W};
    };
    program::Move part = last;
    part.rapid = true;
    part.to = at(hole_.cycle.arrive_mm);
    if (arrives_) moves.push_back(part);
    part.rapid = false;
    part.from = at(std::max(hole_.cycle.arrive_mm, hole_.cycle.retract_mm));
    part.to = at(-hole_.cycle.depth_mm);
    moves.push_back(part);
    part.rapid = true;
    part.to = last.to;
    moves.push_back(part);
  }
  program::ClHole hole_;
  int inner_ = 0;
  bool arrives_ = false;
};

/// A program written and read back.
struct Posted {
  std::string text, faults, cl_file, nc_file;
  PostResult result;
  program::ClProgram cl;
  std::vector<program::Move> expected;  ///< positions of the CL data
  std::vector<program::NcMove> moves;   ///< as our interpreter reads them
  std::vector<Diagnostic> read;         ///< what it said
  kinematics::MachineModel machine;     ///< with the first tool

  /// The line of the program that has the words, without its number; "" when none.
  std::string line_with(const std::string& words) const {
    for (size_t at = 0; at < text.size();) {
      const size_t end = text.find('\n', at);
      const std::string line = text.substr(at, end - at);
      if (line.find(words) != std::string::npos) return line;
      at = end + 1;
    }
    return "";
  }
  size_t count(const std::string& words) const {
    size_t found = 0;
    for (size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++found;
    return found;
  }
};

inline std::string scratch_file(const std::string& ending) {
  static int number = 0;
  return (test::scratch_folder() / fmt::format("swarf_post_{}_{}{}", getpid(), ++number, ending)).string();
}

inline std::vector<PostTool> two_tools() {
  return {{1, "MILL10", 80.0}, {2, "DRILL5", 95.5}};
}

/// Writes the CL data for the machine, and reads the program where it came to one.
inline Posted run_post(const std::string& cl, const kinematics::MachineModel& machine,
                       const PostFormat& format, PostOptions options = {}) {
  Posted posted;
  posted.cl_file = scratch_file(".cls");
  std::ofstream(posted.cl_file, std::ios::binary) << cl;
  if (options.tools.empty()) options.tools = two_tools();
  posted.machine = kinematics::with_tool(machine, options.tools.front().length_mm);
  Diagnostics diagnostics;
  Progress silent;
  try {
    posted.result = post(
        posted.cl_file, machine, format, options, [&](std::string_view text) { posted.text += text; }, silent,
        diagnostics);
  } catch (const InputError& error) {
    for (const Diagnostic& one : error.diagnostics.list()) posted.faults += swarf::format(one) + "\n";
    std::filesystem::remove(posted.cl_file);
    return posted;
  }
  ExpectedMoves expected;
  posted.cl = program::stream_cl(posted.cl_file, expected, diagnostics, options.cl);
  posted.expected = std::move(expected.moves);
  posted.nc_file = scratch_file(".nc");
  std::ofstream(posted.nc_file, std::ios::binary) << posted.text;
  program::ControlSetup setup;
  setup.machine = machine;
  setup.unit_mm = 1.0;
  for (const PostTool& tool : options.tools)
    setup.tools.push_back({tool.number, tool.name, tool.length_mm, 10.0, 0.0});
  NcMoves sink;
  Diagnostics read;
  program::run_nc(posted.nc_file, format.dialect, setup, sink, read);
  posted.read = read.list();
  posted.moves = std::move(sink.moves);
  std::filesystem::remove(posted.cl_file);
  std::filesystem::remove(posted.nc_file);
  return posted;
}

/// What the interpreter found wrong; "" when it read everything.
inline std::string reading_faults(const Posted& posted) {
  std::string text;
  for (const Diagnostic& one : posted.read) {
    if (one.severity == Severity::kError) text += swarf::format(one) + "\n";
  }
  return text;
}

}  // namespace swarf::post

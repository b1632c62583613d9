// Blocks of one tool, or more, cut into a box as a run cuts them, and judged.
#pragma once

#include <utility>
#include <vector>

#include "../motion/dome.h"
#include "motion/interpolator.h"
#include "sim/simulation.h"

namespace swarf::sim {

struct ContactRun {
  Job job;
  CutOptions options;
  Result result;

  ContactRun(std::vector<cutter::Cutter> tools, const Box& box, double voxel_mm) {
    job.scene.kind = ProgramKind::kCl;
    job.scene.tools = std::move(tools);
    job.scene.stock.box_W = box;
    job.scene.stock.voxel_mm = voxel_mm;
    job.machine.model = motion::paper_machine();
  }
  toolpath::BlockMove& turn(const ToolPose& to, double feed_mm_s = 20.0) {
    toolpath::BlockMove block;
    block.from = end_;
    block.to = end_ = to;
    block.feed_mm_s = feed_mm_s;
    block.spindle_rpm = 5000.0;
    elements_.push_back({block, 0, {"test.nc", static_cast<int>(elements_.size()) + 1}});
    return std::get<toolpath::BlockMove>(elements_.back().what);
  }
  toolpath::BlockMove& move(const Vec3& to, double feed_mm_s = 20.0) {
    return turn({to, end_.axis_W}, feed_mm_s);
  }
  void start(const ToolPose& pose) { end_ = pose; }
  const ToolClearance& cut() {
    Progress silent;
    result.main.path.elements = toolpath::Elements(elements_);
    const std::vector<kinematics::MachineModel> machines = machines_by_tool(job);
    result.main.cycles = std::make_unique<motion::Cycles>(result.main.path.elements, machines,
                                                          job.scene.tools.front(), job.scene.motion);
    result.main.motion = motion::interpolate(*result.main.cycles, silent);
    cut_stock(job, options, silent, result);
    return result.clearance;
  }
  const std::vector<BadCut>& bad_cuts() const { return result.cut.state.bad_cuts; }

 private:
  std::vector<toolpath::Element> elements_;
  ToolPose end_{{0, 0, 60}, Vec3::UnitZ()};
};

/// A flat end mill with a holder of 40 mm.
inline cutter::Cutter flat_tool(double diameter, double flutes, double length) {
  cutter::Cutter c;
  c.number = 1;
  c.diameter_mm = c.shank_diameter_mm = diameter;
  c.flute_length_mm = flutes;
  c.length_mm = length;
  return c;
}

}  // namespace swarf::sim

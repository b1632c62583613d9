#include "toolpath/cl_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "toolpath/pass_counter.h"

namespace swarf::toolpath {
namespace {

using program::Move;

/// Ends of an arc nearer than this are the same point: the arc is a whole circle, mm.
constexpr double kWholeCircle = 1e-6;
/// Cosine below which two axes count as opposite: within 0.008 degrees.
constexpr double kReversed = -1.0 + 1e-8;

bool stands_still(const Move& move) {
  return !move.arc && move.from.tip_W == move.to.tip_W && move.from.axis_W == move.to.axis_W;
}

/// Many CL files leave the spindle to the post-processor: only one that starts it says when it stands.
bool tells_spindle(const program::ClProgram& program) {
  return std::any_of(program.moves.begin(), program.moves.end(),
                     [](const Move& move) { return move.spindle_rpm != 0.0; });
}

/// At its feed, where that is not simply the way of the tip in the arc's plane; 0: it is no helix.
double helix_time(const BlockMove& block) {
  if (!block.arc || block.feed_mm_s == 0.0) return 0.0;
  const double rise = (block.to.tip_W - block.from.tip_W).dot(block.arc->normal_W);
  if (std::abs(rise) <= program::kArcTolerance) return 0.0;
  return std::hypot(tip_way(block), rise) / block.feed_mm_s;
}

}  // namespace

bool holds_blocks(const ToolPath& path) {
  return path.elements.hold_blocks();
}

double arc_angle(const BlockMove& block) {
  const Vec3 from = block.from.tip_W - block.arc->centre_W;
  const Vec3 to = block.to.tip_W - block.arc->centre_W;
  const Vec3& n = block.arc->normal_W;
  // In the plane: the ends of a helix of one turn lie above each other.
  if (n.cross(to - from).norm() < kWholeCircle) return 2.0 * kPi;
  const double angle = std::atan2(n.dot(from.cross(to)), from.dot(to) - n.dot(from) * n.dot(to));
  return angle > 0.0 ? angle : angle + 2.0 * kPi;
}

double tip_way(const BlockMove& block) {
  if (block.curve) return block.curve->to - block.curve->from;
  if (!block.arc) return (block.to.tip_W - block.from.tip_W).norm();
  const Vec3 arm = block.from.tip_W - block.arc->centre_W;
  return arc_angle(block) * block.arc->normal_W.cross(arm).norm();
}

ToolPath cl_path(const program::ClProgram& program, BlockLaw law, Diagnostics& diagnostics,
                 std::span<const int> tools) {
  ToolPath path;
  path.planner = "cl";
  PassCounter passes;
  const bool spindle_told = tells_spindle(program);
  for (const Move& move : program.moves) {
    if (stands_still(move)) continue;
    const SourceLocation where{program.file, move.line, move.column};
    if (move.arc && law != BlockLaw::kTcp) {
      diagnostics.error(
          "arc-needs-tcp", where,
          fmt::format("an arc of the tip contradicts interpolator.mode = \"{}\"", law_name(law)),
          "write interpolator.mode = \"tcp\", or give the arc as short GOTO moves");
      return {};
    }
    if (law != BlockLaw::kJoint && move.from.axis_W.dot(move.to.axis_W) < kReversed) {
      diagnostics.error("axis-reversed", where,
                        "the tool axis is reversed in one move: it could turn any way",
                        "give a position between them");
      return {};
    }
    const bool rapid = move.rapid;
    const BlockLaw own = rapid && law == BlockLaw::kEnds ? BlockLaw::kTcp : law;
    BlockMove block;
    block.from = move.from;
    block.to = move.to;
    block.arc = move.arc;
    block.law = own;
    block.feed_mm_s = move.feed_mm_s;
    block.dwell_s = move.dwell_s;
    block.duration_s = helix_time(block);
    if (spindle_told) block.spindle_rpm = move.spindle_rpm;
    block.tool = move.tool < 0 || tools.empty() ? 0 : tools[static_cast<size_t>(move.tool)];
    block.pass = passes.next(block);
    (rapid ? path.link_length_mm : path.pass_length_mm) += tip_way(block);
    path.elements.push_back({std::move(block), 0, where});
  }
  path.passes = passes.count();
  return path;
}

}  // namespace swarf::toolpath

// One control cycle: where the tool is, where it touches, how fast it goes, and the axis positions.
#pragma once

#include <cstdint>
#include <vector>

#include "base/frames.h"
#include "kinematics/machine_model.h"

namespace swarf::motion {

enum class SampleKind : uint8_t { kCutting, kApproach, kRetract, kRapid };

struct ToolSample {
  double t_s = 0.0;
  ToolPose pose;                  ///< work frame
  Vec3 contact_W = Vec3::Zero();  ///< equals the tip while nothing is touched
  double u = 0.0, v = 0.0;        ///< surface parameters of the contact; 0 on free moves. CL blocks: u is the
                                  ///< share of the block that is done, 0 to 1; driven passes: the parameter
                                  ///< of the guide
  double feed_mm_s = 0.0;         ///< commanded speed of the contact point over the cycle that ends here
  int element = 0;                ///< index into ToolPath::elements
  SampleKind kind = SampleKind::kRapid;
  int16_t tool = 0;      ///< in the spindle: index into the job's tools
  bool rounded = false;  ///< in the rounded corner between two blocks: the pose leaves their path a little
};

/// One cycle of a program.
struct Cycle {
  uint64_t number = 0;  ///< from 0
  ToolSample sample;
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  bool reached = true;    ///< false: out of reach, the axes stand still
  float cost_ns = -1.0F;  ///< of its interpolation and inverse, real-time modes only; else below 0
};

/// Samples and axis positions of a whole program, same length.
struct Trajectory {
  double period_s = 1e-3;
  std::vector<ToolSample> samples;
  std::vector<kinematics::AxisValues> axes;
};

}  // namespace swarf::motion

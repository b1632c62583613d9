// What the passes of a flank job leave over the measuring rays, in closed form for each motion of the tool.
#pragma once

#include <optional>
#include <vector>

#include "flank/envelope.h"
#include "motion/cycles/cycles.h"
#include "sim/job/scene.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::sim {

/// The pass that a block of the path belongs to; -1: none.
int pass_of(const toolpath::Elements& elements, size_t element);

/// Poses of one pass in their order, and the element of the path that each belongs to (-1: none).
struct PosedPass {
  std::vector<ToolPose> poses;
  std::vector<int> elements;
};

/// On the axis surface itself: what blocks and cycles are to follow.
std::vector<PosedPass> exact_poses(const Job& job);
/// As the blocks ask for them.
std::vector<PosedPass> block_poses(const Job& job, const motion::Cycles& cycles);
/// At the control's cycles; between two of them every axis of the machine goes evenly.
std::vector<PosedPass> cycle_poses(const Job& job, const motion::Cycles& cycles);

/// The envelope of all passes over one surface.
class SurfaceEnvelope {
 public:
  SurfaceEnvelope(const Job& job, const std::vector<PosedPass>& passes, size_t surface);
  std::optional<double> height(const Vec3& point, const Vec3& normal) const;
  /// Element of the path whose motion comes nearest to the point; -1: none.
  int element_at(const Vec3& point) const;

 private:
  struct Track {
    flank::PoseTrack track;
    const std::vector<int>* elements;
  };
  std::vector<Track> tracks_;
};

/// mm over every ray of a surface; none where no flank is near.
using Heights = std::vector<std::optional<double>>;
Heights heights_of(const SurfaceEnvelope& envelope, const stock::SurfaceDexels& dexels);

}  // namespace swarf::sim

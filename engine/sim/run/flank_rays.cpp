#include "sim/run/flank_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "flank/feed.h"
#include "motion/blocks/block_motion.h"

namespace swarf::sim {
namespace {

/// Between the poses that a track takes of a block nothing strays farther than this, mm.
constexpr double kTrackTolerance = 1e-5;
/// Poses of an axis surface: at a corner of radius 4 mm chords of 6 um lie 1e-6 mm beside it.
constexpr int kExactPoses = 16384;

}  // namespace

int pass_of(const toolpath::Elements& elements, size_t element) {
  return elements.block(element).pass;
}

std::vector<PosedPass> exact_poses(const Job& job) {
  std::vector<PosedPass> passes;
  for (const flank::FlankPass& pass : job.flank) {
    const flank::AxisFamily family(pass.task);
    const double step = (pass.task.u_high - pass.task.u_low) / kExactPoses;
    PosedPass own;
    for (int i = 0; i <= kExactPoses; ++i) own.poses.push_back(family.pose(pass.task.u_low + i * step));
    own.elements.assign(own.poses.size(), -1);
    passes.push_back(std::move(own));
  }
  return passes;
}

std::vector<PosedPass> block_poses(const Job& job, const motion::Cycles& cycles) {
  std::vector<PosedPass> passes(job.flank.size());
  const double lever = job.flank.front().task.profile.high;
  for (size_t i = 0; i < cycles.elements().size(); ++i) {
    const int pass = pass_of(cycles.elements(), i);
    if (pass < 0) continue;
    PosedPass& own = passes[static_cast<size_t>(pass)];
    const std::vector<ToolPose> steps = motion::subdivide(cycles.motions()[i], lever, kTrackTolerance);
    own.poses.insert(own.poses.end(), steps.begin() + (own.poses.empty() ? 0 : 1), steps.end());
    own.elements.resize(own.poses.size(), static_cast<int>(i));
  }
  return passes;
}

namespace {

/// Appends the way from one cycle to the next, on which the axes go evenly.
void add_way(const kinematics::MachineModel& machine, const motion::Cycle& from, const motion::Cycle& to,
             double lever, PosedPass& pass) {
  const auto at = [&](double share) {
    return kinematics::forward(machine, from.q + share * (to.q - from.q));
  };
  const ToolPose middle = at(0.5), straight = flank::between(from.sample.pose, to.sample.pose);
  const double stray =
      (middle.tip_W - straight.tip_W).norm() + lever * (middle.axis_W - straight.axis_W).norm();
  // What it strays from straight pieces falls with the square of their number.
  constexpr double kMostPieces = 64.0;
  const bool reached = from.reached && to.reached;
  const double pieces =
      reached ? std::clamp(std::ceil(std::sqrt(stray / kTrackTolerance)), 1.0, kMostPieces) : 1.0;
  for (double i = 1.0; i < pieces; i += 1.0) {
    pass.poses.push_back(at(i / pieces));
    pass.elements.push_back(to.sample.element);
  }
  pass.poses.push_back(to.sample.pose);
  pass.elements.push_back(to.sample.element);
}

}  // namespace

std::vector<PosedPass> cycle_poses(const Job& job, const motion::Cycles& cycles) {
  std::vector<PosedPass> passes(job.flank.size());
  const double lever = job.flank.front().task.profile.high;
  motion::CycleReader reader(cycles);
  motion::Cycle before;
  int pass_before = -1;
  for (size_t k = 0; k < cycles.size(); ++k) {
    const motion::Cycle cycle = reader.at(k);
    const int pass = pass_of(cycles.elements(), static_cast<size_t>(cycle.sample.element));
    if (pass >= 0) {
      PosedPass& own = passes[static_cast<size_t>(pass)];
      if (pass == pass_before) {
        add_way(cycles.machines().front(), before, cycle, lever, own);
      } else {
        own.poses.push_back(cycle.sample.pose);
        own.elements.push_back(cycle.sample.element);
      }
    }
    before = cycle;
    pass_before = pass;
  }
  return passes;
}

SurfaceEnvelope::SurfaceEnvelope(const Job& job, const std::vector<PosedPass>& passes, size_t surface) {
  for (size_t k = 0; k < job.flank.size(); ++k)
    if (job.flank[k].surface == surface)
      tracks_.push_back({{passes[k].poses, job.flank[k].task.profile}, &passes[k].elements});
}

std::optional<double> SurfaceEnvelope::height(const Vec3& point, const Vec3& normal) const {
  std::optional<double> least;
  for (const Track& track : tracks_) {
    const std::optional<double> own = track.track.height(point, normal);
    if (own && (!least || *own < *least)) least = own;
  }
  return least;
}

int SurfaceEnvelope::element_at(const Vec3& point) const {
  int element = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const Track& track : tracks_) {
    const flank::PoseTrack::Nearest near = track.track.nearest(point);
    if (near.distance_mm >= least) continue;
    least = near.distance_mm;
    element = (*track.elements)[near.step + 1];
  }
  return element;
}

Heights heights_of(const SurfaceEnvelope& envelope, const stock::SurfaceDexels& dexels) {
  Heights heights(dexels.points().size());
  parallel_chunks(heights.size(), 16, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      heights[i] = envelope.height(dexels.points()[i], dexels.normals()[i]);
  });
  return heights;
}

}  // namespace swarf::sim

// What a flank leaves that has moved through a row of poses, in closed form for each instant.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "flank/flank_profile.h"

namespace swarf::flank {

/// Poses in their order; between two of them tip and axis move linearly.
class PoseTrack {
 public:
  PoseTrack(std::vector<ToolPose> poses, const FlankProfile& profile);

  struct Nearest {
    double distance_mm = 0.0;  ///< from the envelope; below 0: inside
    size_t step = 0;           ///< between which poses
    double share = 0.0;
    bool on_flank = true;  ///< false: the end of the flank is nearest, the cutter's end is not known here
    Vec3 outward = Vec3::Zero();  ///< unit, from the axis to the point
  };
  /// The least over the whole track: no place of it can be nearer, for between two poses nothing moves
  /// farther than the ends of the axis do.
  Nearest nearest(const Vec3& point) const;

  /// Height over `point` along `normal` where the envelope begins: material stays below it, and below 0 the
  /// cut is too deep. None: the flank is farther than 1 mm from there, or only an end of it is near.
  std::optional<double> height(const Vec3& point, const Vec3& normal) const;

  size_t size() const { return poses_.size(); }

 private:
  double distance(const ToolPose& pose, const Vec3& point) const;
  void search(const Vec3& point, size_t first, size_t last, double at_first, double at_last,
              Nearest& best) const;
  void search_step(const Vec3& point, size_t step, Nearest& best) const;

  std::vector<ToolPose> poses_;
  std::vector<double> way_;  ///< up to a pose, of the end of the axis that moves more
  FlankProfile profile_;
};

}  // namespace swarf::flank

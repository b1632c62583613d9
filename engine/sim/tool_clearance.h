// Neck, shank and holder against the stock as it stands at that moment of the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cutter/cutter.h"
#include "stock/stock.h"
#include "stock/sweep.h"

namespace swarf::sim {

struct ToolClearance {
  size_t checked_poses = 0;
  size_t contacts = 0;       ///< poses at which a part above the flutes stands in material
  double deepest_mm = 0.0;   ///< penetration of the worst of them (saturates at the level set's band)
  std::string part;          ///< "neck", "shank" or "holder", of the first contact
  uint32_t first_block = 0;  ///< Sweep::block of the first contact
  double nearest_mm = 0.0;   ///< closest approach seen; saturates at band_mm
  double band_mm = 0.0;      ///< distances are known up to here
};

/// Samples points on neck, shank and holder as they are shaped (rings on walls and shoulders, at most 2 mm
/// apart) against the level set. Material less than one voxel deep is not counted: the flank of the cutter
/// leaves it there.
class ToolClearanceCheck {
 public:
  ToolClearanceCheck(std::span<const cutter::Cutter> tools, double voxel_mm);
  /// Sweeps of one tool, by its index.
  void check(const stock::Stock& stock, std::span<const stock::Sweep> sweeps, size_t tool);
  const ToolClearance& result() const { return result_; }
  /// Goes on from an earlier result of the same tools and voxel size.
  void resume(const ToolClearance& earlier) { result_ = earlier; }

 private:
  struct Point {
    double radius, height, cosine, sine;
    const char* part;
  };
  using Points = std::vector<Point>;
  static Points points_of(const cutter::Cutter& cutter);
  double depth_at(const stock::Stock& stock, const ToolPose& pose, const Points& points,
                  const char** part) const;

  std::vector<Points> points_;  ///< by tool
  double tolerance_mm_;
  ToolClearance result_;
};

}  // namespace swarf::sim

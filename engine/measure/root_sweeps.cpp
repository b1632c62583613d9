#include "measure/root_sweeps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "measure/column_range.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::measure {
namespace {

/// The sweep's lowest plane keeps above the root's columns up to a height: at both ends, and what lies
/// between is linear in time.
bool passes_above(const stock::Sweep& sweep, const stock::CutterSolid& cutter, const RootCell& root,
                  double height) {
  if (height == kNever) return false;
  const double low = lowest_z(cutter);
  for (const ToolPose* pose : {&sweep.start, &sweep.end}) {
    for (const CellCorner& corner : root.cell.corners) {
      const double z = pose->axis_W.dot(corner.point - pose->tip_W) + root.cell.flatness_mm;
      const double rise = pose->axis_W.dot(corner.normal) + std::min(2.0, root.cell.turn);
      if (z + std::max(-stock::kSkin * rise, height * rise) + 1e-6 >= low) return false;
    }
  }
  return true;
}

NearSweep near_sweep(const CertificateInput& input, uint32_t number) {
  const stock::Sweep& sweep = input.sweeps[number];
  return {stock::sweep_map(sweep), &input.cutters[number], number, sweep.start.axis_W != sweep.end.axis_W};
}

}  // namespace

std::vector<uint32_t> numbers_up_to(double reach, const RootCell& root, const CertificateInput& input,
                                    const SweepIndex& index) {
  Box box{Vec3::Constant(kNever), Vec3::Constant(-kNever)};
  const double margin = root.cell.flatness_mm + root.cell.radius() * 1e-3;
  for (const CellCorner& corner : root.cell.corners) {
    const double top =
        std::min(reach, std::max(0.0, leaves_box(input.stock.box(), corner.point, corner.normal)));
    for (const double s : {-stock::kSkin, top}) {
      const double turn = std::min(2.0, root.cell.turn) * std::abs(s) + margin;
      box.lower = box.lower.cwiseMin(corner.point + s * corner.normal - Vec3::Constant(turn));
      box.upper = box.upper.cwiseMax(corner.point + s * corner.normal + Vec3::Constant(turn));
    }
  }
  std::vector<uint32_t> found;
  index.find(box, found);
  const Vec3 centre = 0.5 * (box.lower + box.upper);
  const double around = 0.5 * (box.upper - box.lower).norm();
  std::erase_if(found, [&](uint32_t n) {
    const stock::Sweep& sweep = input.sweeps[n];
    const stock::CutterSolid& cutter = input.cutters[n];
    return passes_above(sweep, cutter, root, reach) || passes_aside(sweep, cutter, centre, around);
  });
  return found;
}

std::vector<NearSweep> sweeps_up_to(double reach, const RootCell& root, const CertificateInput& input,
                                    const SweepIndex& index) {
  std::vector<NearSweep> near;
  for (const uint32_t n : numbers_up_to(reach, root, input, index)) near.push_back(near_sweep(input, n));
  return near;
}

RootSweeps::RootSweeps(const CertificateInput& input, std::vector<uint32_t> numbers)
    : input_(&input), numbers_(std::move(numbers)), places_(numbers_.size(), kNotMade) {
  made_.reserve(numbers_.size());
}

void RootSweeps::make(size_t n) const {
  places_[n] = static_cast<uint32_t>(made_.size());
  made_.push_back(near_sweep(*input_, numbers_[n]));
}

}  // namespace swarf::measure

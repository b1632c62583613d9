// The highest material over a design, refined between the measuring rays. Internal to this folder.
//
//   1. Rays that no neighbour exceeds, the worst of each region, and those beside the highest ridges.
//   2. Around each: a square of rays on the design, cut by the same sweeps; of each as much as is its foot's
//      own. The best is the middle of the next square: half as wide, or as wide again where it lay at the
//      border.
//   3. The highest of these places go on, down to a square in which heights differ by less than .02 um.
// Each height is that of an exact ray, so none is too high; that no place between the rays is higher is
// proven by certificate.h alone. A square of rays, unlike a step in four directions, does not stall on the
// sharp crest of a cusp.
#pragma once

#include <span>
#include <vector>

#include "measure/measure.h"
#include "measure/sweep_index.h"

namespace swarf::measure {

/// What rays begin with and are cut by. Borrowed.
struct PeakInput {
  const RayMaterial& material;
  std::span<const stock::Sweep> sweeps;
  const SweepCutters& cutters;
  const SweepIndex& index;  ///< of the sweeps
};

/// The place of the design under the highest material near a ray, where that ends, and the last block there.
struct Peak {
  double height_mm = 0.0;
  Vec3 place = Vec3::Zero(), top = Vec3::Zero();  ///< W, mm
  uint32_t block = stock::kUncut;
};

/// By rays around each of `rays` of the field, no farther than 2 pitches away; in their order. Of height
/// 0 where nothing stands.
std::vector<Peak> find_peaks(const stock::RayField& field, std::span<const uint32_t> rays,
                             const PeakInput& input);

/// Rays as high as `tops_mm` says that no neighbour of theirs exceeds, the highest first, `most` at most.
std::vector<uint32_t> highest_rays(const stock::RayField& field, std::span<const double> tops_mm,
                                   size_t most);

}  // namespace swarf::measure

#include "stock/level_set/leaf_cut.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stock/level_set/convex_leaf.h"
#include "stock/level_set/piece_window.h"

namespace swarf::stock {
namespace {

/// The time in which the piece can change a value of the leaf; all of it when it cannot.
Window window_of(const LevelSet& set, const SweptPiece& swept, const Vec3& centre) {
  const Vec3 P = swept.map.start(centre), D = swept.map.end(centre) - P;
  const double reach = set.leaf_radius() + kReachSlack + set.band();
  // Neighbouring leaves that see the whole sweep round alike: facets stay as flat as they were. Only a sweep
  // that goes far beyond the cutter is shortened.
  const double across = kFarFactor * (swept.piece->radius + reach);
  const double along = kFarFactor * (swept.piece->high + reach);
  const auto far = [&](const Vec3& X) { return X.head<2>().norm() > across || std::abs(X.z()) > along; };
  if (!far(P) && !far(P + D)) return {};
  const Window window = time_in_reach(*swept.piece, P, D, reach);
  return window.empty() ? Window{} : window;
}

/// Below (height - band) the top end could only change values that the clamp makes equal anyway.
bool is_capped(const LevelSet& set, const SweptPiece& swept, const Vec3& centre) {
  const double highest = std::max(swept.map.start(centre).z(), swept.map.end(centre).z()) + set.leaf_radius();
  return highest > swept.piece->high - set.band();
}

/// `start`, `end`: the first voxel in the tool frame. Without asking for the leaf's centre: the whole sweep
/// lies near the leaf, and the cutter's top end does not.
bool surely_whole(const LevelSet& set, const SweptPiece& swept, const Vec3& start, const Vec3& end) {
  constexpr double kMoreThanRounding = 1e-6;
  const double side = 2.0 * set.leaf_radius() + kMoreThanRounding;
  const double across = std::sqrt(std::max(start.head<2>().squaredNorm(), end.head<2>().squaredNorm()));
  const double low = std::min(start.z(), end.z()), high = std::max(start.z(), end.z());
  const cutter::ConvexPiece& piece = *swept.piece;
  return across + side <= kFarFactor * (piece.radius + set.band()) && low - side >= -piece.high &&
         high + side <= piece.high - set.band();
}

LeafMotion leaf_motion(const LevelSet& set, const SweptPiece& swept, const Vec3& first, const Vec3& centre) {
  const SweepMap& map = swept.map;
  const Vec3 start = map.start(first), end = map.end(first);
  const bool whole = surely_whole(set, swept, start, end);
  const Window window = whole ? Window{} : window_of(set, swept, centre);
  // As start + t (end - start), so that what does not change stays equal to the last bit (LevelPlane).
  const auto at = [](double t, double a, double b) { return static_cast<float>(a + t * (b - a)); };
  LeafMotion motion;
  for (int c = 0; c < 3; ++c) {
    motion.start[c] = at(window.low, start[c], end[c]);
    motion.end[c] = at(window.high, start[c], end[c]);
    for (int a = 0; a < 3; ++a) {
      const double from = map.R0t(c, a) * set.voxel, to = map.R1t(c, a) * set.voxel;
      motion.start_step[a][c] = at(window.low, from, to);
      motion.end_step[a][c] = at(window.high, from, to);
    }
  }
  motion.radius = static_cast<float>(swept.piece->radius);
  motion.height = static_cast<float>(swept.piece->high);
  motion.background = set.band();
  motion.capped = !whole && is_capped(set, swept, centre);
  return motion;
}

/// Slices of 64 voxels that the patches touch.
uint32_t slices_of(uint32_t patches) {
  constexpr uint32_t kOfTwoSlices = (1U << kPatchSide) - 1U, kTwoSlices = 3U;
  uint32_t slices = 0;
  for (int n = 0; n < kPatchSide; ++n) {
    if ((patches >> (n * kPatchSide) & kOfTwoSlices) != 0) slices |= kTwoSlices << (2 * n);
  }
  return slices;
}

Vec3 first_voxel(const LevelSet& set, size_t leaf) {
  const openvdb::Coord origin = set.map.origin(leaf);
  return Vec3(origin.x(), origin.y(), origin.z()) * set.voxel;
}

bool is_level(const LeafMotion& m) {
  return m.start[2] == m.end[2] && m.start_step[0][2] == m.end_step[0][2] &&
         m.start_step[1][2] == m.end_step[1][2] && m.start_step[2][2] == m.end_step[2][2];
}

}  // namespace

bool LevelPlane::repeats(const LeafMotion& motion) const {
  return known_ && is_level(motion) && motion_.start[2] == motion.start[2] &&
         motion_.start_step[0][2] == motion.start_step[0][2] &&
         motion_.start_step[1][2] == motion.start_step[1][2] &&
         motion_.start_step[2][2] == motion.start_step[2][2];
}

void LevelPlane::remember(const LeafMotion& motion, const SweptPiece& swept, const Vec3& centre,
                          double leaf_radius) {
  if (known_ || !swept.piece->is_cylinder() || !is_level(motion)) return;
  const Vec2 P = swept.map.start(centre).head<2>(), D = swept.map.end(centre).head<2>() - P;
  const double t = D.squaredNorm() > 0.0 ? std::clamp(-P.dot(D) / D.squaredNorm(), 0.0, 1.0) : 0.0;
  known_ = (P + t * D).norm() + leaf_radius < motion.radius - motion.background && !motion.capped;
  motion_ = motion;
}

LeafCut::LeafCut(const LevelSet& set, size_t leaf, float* values)
    : set_(set), values_(values), first_(first_voxel(set, leaf)), centre_(set.leaf_centre(leaf)) {
  floors_.band = set.band();
}

void LeafCut::apply(const SweptPiece& swept, const LeafBound& bound) {
  static const LeafKernelVariant& kernels = leaf_kernel_variants().front();
  const uint32_t patches = visits_ == 0 ? kAllPatches : kernels.patch_test(floors_, bound);
  if (patches == 0) return;
  uint32_t risen = 0;
  if (swept.piece->is_cylinder()) {
    const LeafMotion motion = leaf_motion(set_, swept, first_, centre_);
    if (plane_.repeats(motion)) return;
    risen = kernels.kernel(values_, motion, patches);
    plane_.remember(motion, swept, centre_, set_.leaf_radius());
  } else {
    risen = cut_by_search(swept, patches);
  }
  changed_ = changed_ || risen != 0;
  if (visits_ == 0) {
    set_slope(bound);
    risen = kAllPatches;
  }
  kernels.patch_fit(values_, risen, floors_);
  if (risen != 0) set_lowest();
  ++visits_;
  patches_ += static_cast<uint64_t>(__builtin_popcount(patches));
}

/// Floors as steep as the face that cut deepest.
void LeafCut::set_slope(const LeafBound& deepest) {
  const LeafBound::Linear& face = deepest.of_face[0];
  for (int a = 0; a < 3; ++a) floors_.slope[a] = 0.5F * (face.start_step[a] + face.end_step[a]);
}

/// Every piece but the plain cylinder, which has a closed form.
uint32_t LeafCut::cut_by_search(const SweptPiece& swept, uint32_t patches) {
  std::array<float, kLeafVoxels> before;
  std::copy_n(values_, before.size(), before.begin());
  const LeafPlace place{first_, set_.voxel, set_.band()};
  cut_leaf_by_piece(values_, place, swept.map, *swept.piece, slices_of(patches));
  return std::equal(before.begin(), before.end(), values_) ? 0 : patches;
}

/// The lowest of the patches' floors.
void LeafCut::set_lowest() {
  const auto& of_patch = floors_.of_patch[kLevels - 1];
  const float* step = floors_.slope;
  float lowest = of_patch[0];
  for (const float floor : of_patch) lowest = floor < lowest ? floor : lowest;
  lowest_ = lowest + 0.5F * (kLeafSide - 1) * (step[0] + step[1] + step[2]);
}

LeafFloor LeafCut::floor() const {
  const float* step = floors_.slope;
  const auto per_mm = static_cast<float>(1.0 / set_.voxel);
  return {lowest_, {step[0] * per_mm, step[1] * per_mm, step[2] * per_mm}};
}

}  // namespace swarf::stock

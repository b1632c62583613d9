#include "position/patch_joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace swarf::position {
namespace {

/// One of the four borders of a patch: the parameter `fixed` (0: u, 1: v) is `value`, 0 or 1.
struct Side {
  int patch = 0, fixed = 0;
  double value = 0.0;

  Vec2 uv(double share) const { return fixed == 0 ? Vec2(value, share) : Vec2(share, value); }
};

struct NearPlace {
  double distance = std::numeric_limits<double>::infinity();
  Vec3 place = Vec3::Zero();
  int patch = -1;
};

/// The smallest |S + Su du + Sv dv - q| with uv + (du, dv) in the cell: the free step, or along the one side
/// that it would leave.
Vec2 nearest_in(const surface::Derivatives& d, const Vec3& to, const Vec2& uv, const PatchCell& cell) {
  const double uu = d.Su.squaredNorm(), vv = d.Sv.squaredNorm(), cross = d.Su.dot(d.Sv);
  const double ru = d.Su.dot(to), rv = d.Sv.dot(to), det = uu * vv - cross * cross;
  const auto kept = [&](const Vec2& at) -> Vec2 { return at.cwiseMax(cell.low()).cwiseMin(cell.high()); };
  const Vec2 free = det > 0.0 ? Vec2(uv + Vec2(vv * ru - cross * rv, uu * rv - cross * ru) / det) : uv;
  const Vec2 at = kept(free);
  if (at == free) return at;
  // One is held at its end; what is best for the other follows.
  const Vec2 step = at - uv;
  const bool holds_u = at.x() != free.x();
  const double other = holds_u ? (vv > 0.0 ? (rv - cross * step.x()) / vv : 0.0)
                               : (uu > 0.0 ? (ru - cross * step.y()) / uu : 0.0);
  return kept(holds_u ? Vec2(at.x(), uv.y() + other) : Vec2(uv.x() + other, at.y()));
}

/// Distances from places to the patches' cells.
class NearestPatch {
 public:
  explicit NearestPatch(const std::vector<Patch>& patches)
      : patches_(patches), cells_(cell_tree(patches, {})) {}

  /// Nearer than `reach`; nothing else of the border's own patch than what lies beyond its middle.
  NearPlace to(const Vec3& q, const Side& from, double reach) {
    NearPlace best;
    best.distance = reach;
    open_.assign(1, static_cast<int>(cells_.size()) - 1);
    while (!open_.empty()) {
      const PatchCell& cell = cells_[static_cast<size_t>(open_.back())];
      open_.pop_back();
      if (least(cell, q) >= best.distance) continue;
      if (cell.child < 0) {
        if (counts(cell, from)) look_into(cell, q, best);
        continue;
      }
      // The nearer half is looked at first.
      const bool second = least(cells_[static_cast<size_t>(cell.child) + 1], q) <
                          least(cells_[static_cast<size_t>(cell.child)], q);
      open_.push_back(cell.child + (second ? 0 : 1));
      open_.push_back(cell.child + (second ? 1 : 0));
    }
    return best;
  }

 private:
  static double least(const PatchCell& cell, const Vec3& q) { return (cell.p - q).norm() - cell.radius; }

  static bool counts(const PatchCell& cell, const Side& from) {
    constexpr double kMiddle = 0.5;
    if (cell.patch != from.patch) return true;
    return from.value == 0.0 ? cell.low()[from.fixed] >= kMiddle : cell.high()[from.fixed] <= kMiddle;
  }

  /// A leaf all but lies in its tangent plane, so that Newton's steps find its nearest place.
  void look_into(const PatchCell& cell, const Vec3& q, NearPlace& best) const {
    constexpr int kSteps = 12;
    constexpr double kStill = 1e-12;
    const surface::Surface& surface = *patches_[static_cast<size_t>(cell.patch)].surface;
    Vec2 uv = cell.centre;
    for (int i = 0; i < kSteps; ++i) {
      const surface::Derivatives d = surface.derivatives(uv.x(), uv.y());
      const double distance = (d.S - q).norm();
      if (distance < best.distance) best = {distance, d.S, cell.patch};
      const Vec2 next = nearest_in(d, q - d.S, uv, cell);
      if ((next - uv).norm() < kStill) return;
      uv = next;
    }
  }

  const std::vector<Patch>& patches_;
  std::vector<PatchCell> cells_;
  std::vector<int> open_;
};

double length_of(const surface::Surface& surface, const Side& side) {
  constexpr int kParts = 32;
  double length = 0.0;
  Vec3 before = surface.point(side.uv(0.0).x(), side.uv(0.0).y());
  for (int i = 1; i <= kParts; ++i) {
    const Vec2 uv = side.uv(static_cast<double>(i) / kParts);
    const Vec3 here = surface.point(uv.x(), uv.y());
    length += (here - before).norm();
    before = here;
  }
  return length;
}

/// What a place of the border meets; nothing where it is joined, or faces no one.
std::optional<OpenJoint> joint_at(const surface::Surface& surface, const Side& side, double share,
                                  double reach, NearestPatch& nearest) {
  // Within 60 degrees of outwards: beside the end of a border its neighbour is near, and not in front.
  constexpr double kFacing = 0.5;
  const Vec2 uv = side.uv(share);
  const surface::Derivatives d = surface.derivatives(uv.x(), uv.y());
  const NearPlace found = nearest.to(d.S, side, reach);
  if (found.patch < 0 || found.distance <= kJoined_mm) return std::nullopt;
  OpenJoint joint{side.patch, found.patch, d.S, found.place - d.S};
  const Vec3 normal = surface::outward_normal(surface, d, uv);
  const Vec3 along = side.fixed == 0 ? d.Sv : d.Su;
  const Vec3 inwards = side.fixed == 0 ? d.Su : d.Sv;
  Vec3 outwards = side.value == 0.0 ? Vec3(-inwards) : inwards;
  if (along.squaredNorm() > 0.0) outwards -= outwards.dot(along) / along.squaredNorm() * along;
  joint.step_mm = joint.to.dot(normal);
  const Vec3 level = joint.to - joint.step_mm * normal;
  joint.gap_mm = level.norm();
  const bool faces = level.dot(outwards) >= kFacing * joint.gap_mm * outwards.norm();
  if (joint.gap_mm > kJoined_mm && !faces) return std::nullopt;
  return joint;
}

}  // namespace

std::vector<OpenJoint> open_joints(const std::vector<Patch>& patches, double reach) {
  constexpr double kLeastPlaces = 8.0, kMostPlaces = 4000.0;
  NearestPatch nearest(patches);
  std::vector<OpenJoint> joints;
  for (int n = 0; n < static_cast<int>(patches.size()); ++n) {
    const Patch& patch = patches[static_cast<size_t>(n)];
    if (patch.domain != nullptr) continue;
    for (const auto& [fixed, value] :
         std::array<std::pair<int, double>, 4>{{{0, 0.}, {0, 1.}, {1, 0.}, {1, 1.}}}) {
      const Side side{n, fixed, value};
      const double length = length_of(*patch.surface, side);
      if (length <= kJoined_mm) continue;  // a pole
      const double parts = std::clamp(std::ceil(length / kJointStep_mm), kLeastPlaces, kMostPlaces);
      for (double i = 0.0; i <= parts; i += 1.0)
        if (const auto joint = joint_at(*patch.surface, side, i / parts, reach, nearest))
          joints.push_back(*joint);
    }
  }
  return joints;
}

}  // namespace swarf::position

#include "measure/piece_bounds.h"

#include <algorithm>
#include <cmath>

namespace swarf::measure {
namespace {

/// What a column leaves open at its rim, mm.
constexpr double kClear = 2e-5;
/// A facet that is no nearer than another by this is not cut for, mm.
constexpr double kNoNearer = 1e-8;
/// A cut that leaves less than this on one side wins nothing, mm.
constexpr double kLeastCut = 1e-7;
/// Of the column's height: heights exceed distances where the sheets lean.
constexpr double kLeaning = 1.5;
/// Rounding of a distance that was taken twice.
constexpr double kSameAgain = 1e-9;

}  // namespace

PieceBounds::PieceBounds(const DeviationSide& side, uint32_t triangle, const FlatPiece& piece,
                         const DeviationSample& centre)
    : side_(side),
      target_(side.opposite()),
      triangle_(triangle),
      piece_(piece),
      moved_(piece.moved(side.shift(triangle))),
      centre_(centre) {}

void PieceBounds::within(double low, double high) {
  distance_.low = std::max(distance_.low, low);
  distance_.high = std::min(distance_.high, high);
}

void PieceBounds::tighten(Step step) {
  if (step == Step::kWay) {
    const double d = centre_.distance, own = target_.error(centre_.facet), r = moved_.radius();
    const double most = target_.most_error;
    // Only an error that comes as far as the centre changes the sign there.
    const double near = std::max(target_.near_error(centre_.facet), std::min(TargetMesh::kQuiet, most));
    const double other_side = std::min(std::abs(d) - near, std::max(0.0, std::abs(d) - most)) - r;
    const double away = std::abs(d) + own + r;
    if (d < 0.0) {
      within(-away, -other_side);
    } else {
      within(other_side, away);
    }
  } else if (step == Step::kFacet) {
    const double most = target_.distance_over(centre_.facet, moved_);
    within(-most, most);
  } else if (step == Step::kColumn) {
    const double height = kLeaning * std::abs(centre_.distance) + moved_.radius();
    const DistanceRange column = clear_column(moved_, target_, height, side_.other_is_open());
    within(column.low, column.high);
    // Against an offset design the distance itself must not fall short.
    const double asked = side_.offset_mm();
    if (asked > 0.0 && distance_.low < asked && centre_.distance > 0.0 &&
        column.low >= -kClear - target_.most_error)
      within(least_distance(moved_, *target_.mesh, centre_.distance) - target_.most_error, distance_.high);
  } else {
    look_from_corners();
  }
}

void PieceBounds::look_from_corners() {
  for (size_t i = 0; i < moved_.count; ++i) {
    const Vec3& p = moved_.points[i];
    const double within_mm = target_.distance(centre_.facet, p) * (1.0 + kSameAgain) + kSameAgain;
    const mesh::NearestPoint near = target_.mesh->tree().nearest(p, within_mm);
    const bool found = std::isfinite(near.distance_mm);
    facets_[i] = found ? near.triangle : centre_.facet;
    away_[i] = found ? near.distance_mm : within_mm;
    const auto before = facets_.begin() + static_cast<ptrdiff_t>(i);
    if (facets_[i] == centre_.facet || std::find(facets_.begin(), before, facets_[i]) != before) continue;
    const double most = target_.distance_over(facets_[i], moved_);
    within(-most, most);
  }
}

DistanceRange PieceBounds::deviation() const {
  const double own = side_.own_error(triangle_);
  const double low = distance_.low - own, high = distance_.high + own;
  if (side_.on_design()) return {-high, -low};
  return {low - side_.offset_mm(), high - side_.offset_mm()};
}

Vec3 PieceBounds::farthest_corner() const {
  const auto end = away_.begin() + static_cast<ptrdiff_t>(moved_.count);
  return piece_.points[static_cast<size_t>(std::max_element(away_.begin(), end) - away_.begin())];
}

size_t PieceBounds::corner_farthest_from_facet(double& excess_mm) const {
  size_t corner = 0;
  excess_mm = 0.0;
  for (size_t i = 0; i < moved_.count; ++i) {
    const double more = target_.distance(centre_.facet, moved_.points[i]) - away_[i];
    if (more <= excess_mm) continue;
    excess_mm = more;
    corner = i;
  }
  return corner;
}

std::optional<std::array<FlatPiece, 2>> PieceBounds::cut_at(const CutPlane& plane) const {
  auto parts = cut(moved_, plane, kLeastCut);
  if (!parts) return parts;
  const Vec3 back = -side_.shift(triangle_);
  return std::array<FlatPiece, 2>{(*parts)[0].moved(back), (*parts)[1].moved(back)};
}

std::optional<std::array<FlatPiece, 2>> PieceBounds::cut_beside_facet(uint32_t facet,
                                                                      const Vec3& beyond) const {
  const Corners c = target_.corners(facet);
  const Vec3& normal = target_.mesh->face_normal(facet);
  CutPlane farthest;
  double most = kLeastCut;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3 out = (c[(i + 1) % 3] - c[i]).cross(normal).normalized();
    const CutPlane side{out, out.dot(c[i])};
    if (side.height(beyond) <= most) continue;
    most = side.height(beyond);
    farthest = side;
  }
  return most > kLeastCut ? cut_at(farthest) : std::nullopt;
}

/// The places that are as far from the plane of one facet as from that of the other, on the side where `at`
/// lies.
std::optional<std::array<FlatPiece, 2>> PieceBounds::cut_between(uint32_t a, uint32_t b,
                                                                 const Vec3& at) const {
  const auto plane_of = [&](uint32_t facet) {
    const Vec3& normal = target_.mesh->face_normal(facet);
    CutPlane plane{normal, normal.dot(target_.mesh->corner(facet, 0))};
    return plane.height(at) < 0.0 ? CutPlane{-plane.normal, -plane.offset} : plane;
  };
  const CutPlane first = plane_of(a), second = plane_of(b);
  return cut_at({first.normal - second.normal, first.offset - second.offset});
}

std::array<FlatPiece, 2> PieceBounds::parts() const {
  double excess = 0.0;
  const size_t corner = corner_farthest_from_facet(excess);
  const Vec3 centre = moved_.centre();
  std::optional<std::array<FlatPiece, 2>> found;
  if (excess > kNoNearer) {
    found = cut_beside_facet(centre_.facet, moved_.points[corner]);
    if (!found) found = cut_beside_facet(facets_[corner], centre);
    if (!found) found = cut_between(centre_.facet, facets_[corner], moved_.points[corner]);
  } else {
    // One facet is nearest everywhere: on either side of it the deviation has one sign.
    const Vec3& normal = target_.mesh->face_normal(centre_.facet);
    found = cut_at({normal, normal.dot(target_.mesh->corner(centre_.facet, 0))});
  }
  return found ? *found : halves_of(piece_);
}

}  // namespace swarf::measure

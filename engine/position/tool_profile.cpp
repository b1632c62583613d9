#include "position/tool_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/diagnostics.h"
#include "cutter/profile.h"

namespace swarf::position {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSame_mm = 1e-9;
constexpr double kSameSlope = 1e-9;

ProfilePiece piece_of(const cutter::OutlineElement& element) {
  ProfilePiece piece;
  piece.from = element.from.x();
  piece.to = element.to.x();
  piece.height_from = element.from.y();
  if (element.is_line()) {
    piece.slope = (element.to.y() - element.from.y()) / (piece.to - piece.from);
  } else {
    piece.radius = element.radius;
    // What lies above the equator cannot touch first.
    piece.to = std::min(piece.to, element.centre.x() + element.radius / std::hypot(1.0, 1.0 / kSteepest));
    piece.centre_rho = element.centre.x();
    piece.centre_z = element.centre.y();
  }
  return piece;
}

[[noreturn]] void refuse(const cutter::Cutter& cutter, const Vec2& at) {
  throw InputError(
      "profile-not-convex", {},
      fmt::format("{} cannot be set down on a surface: its outline is hollow {:.6g} mm from its "
                  "axis, {:.6g} mm above the tip",
                  cutter::call_name(cutter), at.x(), at.y()),
      "use a flat, ball, bull nose, taper, drill or APT form, or a profile that bulges outwards");
}

}  // namespace

double ProfilePiece::height(double rho) const {
  if (is_line()) return height_from + slope * (rho - from);
  const double x = rho - centre_rho;
  return centre_z - std::sqrt(std::max(0.0, radius * radius - x * x));
}

double ProfilePiece::slope_at(double rho) const {
  if (is_line()) return slope;
  const double x = rho - centre_rho, rest = radius * radius - x * x;
  return rest > 0.0 ? x / std::sqrt(rest) : kInfinity;
}

ToolProfile::ToolProfile(const cutter::Cutter& cutter) {
  const std::vector<cutter::OutlineElement> outline = cutter::outline(cutter);
  double steepest = 0.0;
  for (const cutter::OutlineElement& element : outline) {
    // The flank, or what leads back to the axis: nothing above it touches first.
    if (element.to.x() <= element.from.x() + kSame_mm) break;
    const ProfilePiece piece = piece_of(element);
    const double slope = piece.slope_at(piece.from);
    if (element.radius < 0.0 || slope < steepest - kSameSlope) refuse(cutter, element.from);
    steepest = piece.slope_at(piece.to);
    pieces_.push_back(piece);
    if (steepest >= kSteepest * (1.0 - 1e-6)) break;
  }
  // A wider part further up stands over a hollow.
  const double widest = cutter::greatest_radius(outline);
  if (pieces_.empty() || widest > radius() * (1.0 + 1.0 / (kSteepest * kSteepest)) + kSame_mm)
    refuse(cutter, {widest, height(radius())});
  make_tangents();
}

void ToolProfile::make_tangents() {
  const double last = touching(kSteepestTangent).low;
  tangents_per_mm_ = static_cast<double>(kTangents) / radius();
  for (size_t i = 0; i < kTangents; ++i) {
    const double rho = std::min(last, (static_cast<double>(i) + 0.5) / tangents_per_mm_);
    const double slope = std::min(kSteepestTangent, piece(rho).slope_at(rho));
    tangents_[i] = {slope, lift(slope)};
  }
}

const ProfilePiece& ToolProfile::piece(double rho) const {
  size_t i = 0;
  while (i + 1 < pieces_.size() && rho >= pieces_[i].to) ++i;
  return pieces_[i];
}

RhoRange ToolProfile::touching(double slope) const {
  RhoRange range{radius(), radius()};
  for (const ProfilePiece& piece : pieces_) {
    if (piece.is_line()) {
      if (slope > piece.slope) continue;
      range.low = piece.from;
      range.high = slope == piece.slope ? piece.to : piece.from;
      return range;
    }
    if (slope > piece.slope_at(piece.to)) continue;
    const double rho = piece.centre_rho + piece.radius * slope / std::sqrt(1.0 + slope * slope);
    range.low = range.high = std::max(piece.from, rho);
    return range;
  }
  return range;
}

double ToolProfile::lift(double slope) const {
  const double rho = touching(slope).low;
  return slope * rho - height(rho);
}

}  // namespace swarf::position

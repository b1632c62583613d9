// The underside of a cutter, as what is set down on a surface sees it: the height w(rho) of its cutting part
// above the tip, convex and never falling with rho.
//
//      w ^        /|            lines and arcs from the axis to the greatest radius; beyond it the flank
//        |    __-' |            passes. A point of the part at height h and distance rho from the axis keeps
//        |__-'     |            the tip at h - w(rho) or above.
//        +---------+--> rho
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "cutter/cutter.h"

namespace swarf::position {

/// Arcs end where they are as steep as this: a wall is passed when it is within half a millionth of their
/// radius (2.5 nm for a ball D10) of the flank. Bounds of heights stay finite so.
inline constexpr double kSteepest = 1000.0;

/// A part of the profile between two radii; mm.
struct ProfilePiece {
  double from = 0.0, to = 0.0;  ///< rho, from < to
  double height_from = 0.0;     ///< w(from)
  double slope = 0.0;           ///< of a line: dw/drho
  double radius = 0.0;          ///< above 0: an arc about (centre_rho, centre_z), bulging down; 0: a line
  double centre_rho = 0.0, centre_z = 0.0;

  bool is_line() const { return radius == 0.0; }
  double height(double rho) const;
  /// dw/drho; infinite at an arc's vertical end.
  double slope_at(double rho) const;
};

/// Where a plane touches: any rho between the two (they differ for a plane as steep as one of its lines).
struct RhoRange {
  double low = 0.0, high = 0.0;
};

/// A line below the underside: w(rho) >= slope rho - lift for every rho up to the radius.
struct Tangent {
  double slope = 0.0, lift = 0.0;
};

class ToolProfile {
 public:
  /// The cutting part of a cutter without problems (validate). Throws InputError "profile-not-convex" for
  /// outlines with a hollow or an undercut, which cannot be set down from above.
  explicit ToolProfile(const cutter::Cutter& cutter);

  double radius() const { return pieces_.back().to; }
  std::span<const ProfilePiece> pieces() const { return pieces_; }
  /// w(rho) for 0 <= rho <= radius(), mm.
  double height(double rho) const { return piece(rho).height(rho); }
  /// The piece that holds rho; of two, the outer one.
  const ProfilePiece& piece(double rho) const;
  /// Where w has this slope (tangent of the plane's angle, >= 0): the rho that maximise s rho - w(rho).
  RhoRange touching(double slope) const;
  /// The greatest s rho - w(rho): how far a plane of this slope lifts the tip above its height on the axis.
  double lift(double slope) const;
  /// A tangent that touches near this rho >= 0, of slope kSteepestTangent at most: from a table, for bounds.
  const Tangent& tangent(double rho) const {
    return tangents_[std::min(kTangents - 1, static_cast<size_t>(rho * tangents_per_mm_))];
  }
  static constexpr double kSteepestTangent = 8.0;

 private:
  static constexpr size_t kTangents = 128;
  void make_tangents();

  std::vector<ProfilePiece> pieces_;
  std::array<Tangent, kTangents> tangents_;
  double tangents_per_mm_ = 0.0;
};

}  // namespace swarf::position

// NURBS surfaces: what CAD systems exchange. Every span is kept as a rational Bezier patch; evaluation and
// proven bounds read those. Piegl & Tiller, The NURBS Book (1997), for the nouns and eq. 4.8, 4.9 for the
// derivatives of a quotient.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surface/surface.h"

namespace swarf::surface {

using Vec4 = Eigen::Vector4d;

/// Higher degrees are refused: evaluation works in fixed arrays.
inline constexpr int kMostNurbsDegree = 11;

/// S(s,t) = sum N_i(s) N_j(t) w_ij P_ij / sum N_i(s) N_j(t) w_ij, as files have it.
struct NurbsData {
  int degree_u = 1, degree_v = 1;
  std::vector<double> knots_u, knots_v;  ///< not falling; poles + degree + 1 of them, clamped or not
  std::vector<Vec3> poles;               ///< mm; P_ij at i * count_v() + j
  std::vector<double> weights;           ///< above 0, as the poles; none: all are 1
  int outward_sign = 1;                  ///< of Su x Sv against the outward normal

  int count_u() const { return static_cast<int>(knots_u.size()) - degree_u - 1; }
  int count_v() const { return static_cast<int>(knots_v.size()) - degree_v - 1; }
};

/// What is wrong with the data, one sentence each, with numbers; empty: it is a surface. A knot inside that
/// is repeated more often than the degree (a gap) is refused.
std::vector<std::string> nurbs_problems(const NurbsData& data);

/// The spans of a surface as Bezier patches, (w x, w y, w z, w).
struct BezierGrid {
  int degree_u = 1, degree_v = 1;
  std::vector<double> breaks_u, breaks_v;  ///< rising, from 0 to 1
  std::vector<Vec4> poles;  ///< patch (i, j) begins at (i (breaks_v - 1) + j) (degree_u + 1)(degree_v + 1)

  size_t patch_size() const { return static_cast<size_t>((degree_u + 1) * (degree_v + 1)); }
};

/// The data must have no problems. The knots' domain is mapped to the unit square.
BezierGrid bezier_grid(const NurbsData& data);

/// Over the unit square, which is the knots' domain; continues beyond by the polynomials of the end spans.
/// Its first derivatives are continuous: see smooth_parts().
class NurbsSurface final : public Surface {
 public:
  /// Data without problems and without creases.
  explicit NurbsSurface(const NurbsData& data);
  /// Of a grid without creases; `outward_sign` is +1 or -1.
  NurbsSurface(BezierGrid grid, int outward_sign);
  /// For places and slopes only: bend_bounds() says nothing about what happens across a crease.
  static NurbsSurface with_creases(const NurbsData& data) { return {bezier_grid(data), data.outward_sign}; }

  Vec3 point(double u, double v) const override;
  Derivatives derivatives(double u, double v) const override;
  BendBounds bend_bounds(const Vec2& low, const Vec2& high) const override;
  int outward_sign() const override { return outward_sign_; }

  const BezierGrid& grid() const { return grid_; }
  bool is_rational() const { return rational_; }

 private:
  struct Rect {
    Vec2 low, high;
  };
  /// Patch of a place and the parameters inside it.
  struct Place {
    size_t patch;
    double s, t, du, dv;  ///< in the patch's [0,1]^2 or beyond; width of the patch
  };
  Place find(double u, double v) const;
  BendBounds patch_bounds(size_t i, size_t j, const Rect& rect) const;

  BezierGrid grid_;
  int outward_sign_;
  bool rational_ = false;
  std::vector<Vec4> powers_;          ///< of (s - 1/2)^i (t - 1/2)^j, laid out as the poles
  std::vector<double> least_weight_;  ///< of each patch; above 0
  std::vector<BendBounds> whole_;     ///< of each patch
};

/// A part of a surface without creases and the rectangle of the whole's unit square that it covers.
struct NurbsPart {
  std::shared_ptr<const NurbsSurface> surface;
  Vec2 low, high;
};

/// Cut along the lines of knots where a first derivative jumps by more than this share of its greatest
/// length (below lies what rounding makes of circles, whose knots are repeated and whose arcs are smooth).
inline constexpr double kCreaseJump = 1e-10;
std::vector<NurbsPart> smooth_parts(const NurbsData& data);

}  // namespace swarf::surface

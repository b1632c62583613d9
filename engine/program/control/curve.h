// Parametric curves of programs (NURBS, polynomials) as the control takes them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/frames.h"
#include "program/control/target.h"

namespace swarf::program::nc {

/// How far the chords of a programmed curve may lie beside it: a tenth of what motion keeps to.
inline constexpr double kCurveToleranceMm = 1e-4;

/// A point of a curve, program coordinates.
struct CurvePoint {
  Vec3 tip = Vec3::Zero();
  std::optional<Vec3> axis;                     ///< tool axis, any length above 0
  std::array<std::optional<double>, 3> rotary;  ///< programmed values of A B C, rad
};

/// A curve over [0, 1]. `breaks`: inner parameters where it is less smooth; each becomes the end of a move.
class Curve {
 public:
  virtual ~Curve() = default;
  virtual CurvePoint at(double u) const = 0;
  virtual std::vector<double> breaks() const { return {}; }
};

/// Ends (0, 1] of the pieces whose chords the curve's tip leaves by at most the tolerance, mm; its breaks are
/// among them.
std::vector<double> chord_ends(const Curve& curve, double tolerance_mm);

/// Angle of an arc without its further turns, in (0, 2 pi], counter-clockwise about its normal; one that ends
/// where it starts is a whole circle.
double swept(const Segment& arc);

/// An arc or helix of the linear axes with rotary axes that turn evenly along it.
class TurningArc final : public Curve {
 public:
  using Rotaries = std::array<std::optional<double>, 3>;  ///< programmed values of A B C, rad
  /// `angle`: that the arc goes round, further turns included, rad. The radius may grow evenly on the way.
  TurningArc(const Segment& arc, double angle, const Rotaries& from, const Rotaries& to);
  CurvePoint at(double u) const override;
  std::vector<double> breaks() const override;

 private:
  Segment arc_;
  double angle_, growth_;  ///< growth: of the radius, as a factor less one
  Rotaries from_, to_;
};

/// Rational B-spline: de Boor's recursion on homogeneous coordinates (Piegl & Tiller, The NURBS Book, A4.1).
class NurbsCurve final : public Curve {
 public:
  /// order = degree + 1; knots.size() == points.size() + order, not decreasing, the ones inside [order - 1,
  /// points.size()] span the curve; weights above 0, as many as points. Throws std::invalid_argument with a
  /// text for the user when they do not fit together.
  NurbsCurve(int order, std::vector<CurvePoint> points, std::vector<double> weights,
             std::vector<double> knots);
  CurvePoint at(double u) const override;
  std::vector<double> breaks() const override;

 private:
  int order_;
  std::vector<CurvePoint> points_;
  std::vector<double> weights_, knots_;
};

}  // namespace swarf::program::nc

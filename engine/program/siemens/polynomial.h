// Polynomial interpolation of Siemens 840D (POLY), as a curve of the control.
//
//   f(p) = a0 + a1 p + a2 p^2 + ... + a5 p^5,  0 <= p <= PL
//   a0: where the axis stands, a2 ... a5: as programmed, a1: from f(PL) = xe
//   PO[]=(de,d2,...): X Y Z run along f(p) / d(p) with d(0) = 1, d(PL) = de and f(PL) = xe de
//
// Rotary axes and tool vectors are not in FGROUP as it is delivered. They follow the way s of X Y Z (SPATH,
// the setting of delivery: f at p = PL s/S) or the parameter itself (UPATH: f at p).
// (Programming manual NC programming, "Polynomial interpolation" and "Settable path reference".)
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "program/control/curve.h"
#include "program/siemens/expression.h"

namespace swarf::program::nc::siemens {

/// a2 ... a5 of PO[X]=(xe,a2,a3,a4,a5) as written.
struct Coefficients {
  std::array<double, 4> a{};
  size_t offset = 0;  ///< of PO, or of the axis in X=PO(...)
  bool given = false;
  explicit operator bool() const { return given; }
};

/// Reads (xe,a2,a3,a4,a5): one to five numbers. `end` gets xe. Throws InputError "bad-block",
/// "too-many-coefficients", and what formulas refuse.
Coefficients read_coefficients(TokenReader& reader, Variables& variables, size_t offset, double& end);

/// One axis of a block, mm or rad.
struct PolynomialAxis {
  double from = 0.0, to = 0.0;
  std::array<double, 4> a{};  ///< a2 ... a5, mm or rad per p^k
};

struct PolynomialBlock {
  std::array<PolynomialAxis, 3> linear;
  std::array<std::optional<PolynomialAxis>, 3> rotary;
  /// Tool axis at both ends, unit, not opposite: turns along the great circle.
  std::optional<std::array<Vec3, 2>> axis;
  double interval = 1.0;                         ///< PL, above 0
  std::optional<std::array<double, 5>> divisor;  ///< de, d2 ... d5
  bool by_way = true;                            ///< SPATH; false: UPATH
};

/// The curve of a block, over [0, 1] = p / PL.
class PolynomialCurve final : public nc::Curve {
 public:
  explicit PolynomialCurve(const PolynomialBlock& block);

  nc::CurvePoint at(double u) const override;
  /// So many that rotary axes and vectors, straight over the way between them, miss their law by 0.001
  /// degrees at most.
  std::vector<double> breaks() const override;
  /// Least value of the divisor on the interval; the curve has a pole where it is not above 0.
  double divisor_min() const;
  /// Sum of the amounts of all coefficients over [0, 1], mm and rad: a bound of how far the curve swings, not
  /// finite where a coefficient is not.
  double swing() const;
  /// Tangent at the end, not normalised; zero where the curve comes to rest.
  Vec3 direction_at_end() const { return velocity(1.0); }

 private:
  using Polynomial = std::array<double, 6>;  ///< of u
  static double value(const Polynomial& c, double u);
  static double slope(const Polynomial& c, double u);
  static Polynomial scaled(const std::array<double, 4>& a, double from, double to, double interval);
  Vec3 tip(double u) const;
  Vec3 velocity(double u) const;
  double way_between(double u, double v) const;
  double way(double u) const;
  double share(double u) const;
  double off_straight(double a, double b, double t) const;
  void divide(double a, double b, int depth, std::vector<double>& inner) const;

  PolynomialBlock block_;
  std::array<Polynomial, 3> linear_{};  ///< numerators
  std::array<Polynomial, 3> rotary_{};
  Polynomial divisor_{1.0};
  double angle_ = 0.0;  ///< between the tool axes, rad
  bool turns_ = false;
  std::array<bool, 3> stands_{};
  int degree_ = 1;
  std::vector<double> way_;  ///< up to the ends of equal pieces; empty unless something turns
};

}  // namespace swarf::program::nc::siemens

#include "toolpath/surface_curve.h"

#include <array>
#include <cmath>

#include "base/quadrature.h"

namespace swarf::toolpath {
namespace {

/// Pieces of the whole curve for its length; what their integrals leave out is rounding on polynomial
/// patches.
constexpr double kLengthPieces = 64.0;

}  // namespace

surface::Derivatives PassSurface::at(double t, double w) const {
  surface::Derivatives d = surface_->derivatives(u(t, w), v(t, w));
  if (along_u_) return d;
  return {d.S, d.Sv, d.Su, d.Svv, d.Suv, d.Suu};
}

GraphPoint graph_point(const PassSurface& surface, const CubicSpline& w, double t) {
  const CubicSpline::Value g = w.at(t);
  GraphPoint point;
  point.d = surface.at(t, g.w);
  const surface::Derivatives& d = point.d;
  point.p = d.S;
  point.dp = d.Su + g.dw * d.Sv;
  point.ddp = d.Suu + 2.0 * g.dw * d.Suv + g.dw * g.dw * d.Svv + g.ddw * d.Sv;
  return point;
}

NormalJet normal_along(const PassSurface& surface, const surface::Derivatives& d, double dw) {
  const double sign = surface.outward_sign();
  const Vec3 by_t = d.Suu.cross(d.Sv) + d.Su.cross(d.Suv);
  const Vec3 by_w = d.Suv.cross(d.Sv) + d.Su.cross(d.Svv);
  return {sign * d.Su.cross(d.Sv), sign * (by_t + dw * by_w)};
}

CurvePoint curve_at(const surface::Surface& surface, const SurfaceCurve& curve, double t) {
  const CubicSpline::Value g = curve.w.at(t);
  CurvePoint point;
  point.u = curve.along_u ? t : g.w;
  point.v = curve.along_u ? g.w : t;
  point.surface = surface.derivatives(point.u, point.v);
  const surface::Derivatives& d = point.surface;
  const Vec3& along = curve.along_u ? d.Su : d.Sv;
  const Vec3& across = curve.along_u ? d.Sv : d.Su;
  const Vec3& along2 = curve.along_u ? d.Suu : d.Svv;
  const Vec3& across2 = curve.along_u ? d.Svv : d.Suu;
  point.C = d.S;
  point.dC = along + g.dw * across;
  point.ddC = along2 + 2.0 * g.dw * d.Suv + g.dw * g.dw * across2 + g.ddw * across;
  return point;
}

Vec3 curve_point(const surface::Surface& surface, const SurfaceCurve& curve, double t) {
  const double w = curve.w.at(t).w;
  return curve.along_u ? surface.point(t, w) : surface.point(w, t);
}

double curve_length(const surface::Surface& surface, const SurfaceCurve& curve, double from, double to) {
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(to - from) * kLengthPieces)));
  const double piece = (to - from) / pieces;
  const auto speed = [&](double t) { return curve_at(surface, curve, t).dC.norm(); };
  double sum = 0.0;
  for (int i = 0; i < pieces; ++i) sum += smooth_integral(speed, from + i * piece, from + (i + 1) * piece);
  return std::abs(sum);
}

double travel_along(const surface::Surface& surface, const SurfaceCurve& curve, double t, double distance) {
  // Midpoint speed, iterated: overruns are a few millimetres and need no more than a hundredth of one.
  double step = distance / curve_at(surface, curve, t).dC.norm();
  for (int i = 0; i < 3; ++i) step = distance / curve_at(surface, curve, t + 0.5 * step).dC.norm();
  return t + step;
}

}  // namespace swarf::toolpath

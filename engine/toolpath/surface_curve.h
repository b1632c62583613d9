// Curves on a surface in pass parameters: t runs along the pass, w across, whichever of u and v they are.
#pragma once

#include "toolpath/tool_path.h"

namespace swarf::toolpath {

/// A surface seen in pass parameters (t,w) = (u,v) or (v,u). Borrows the surface.
class PassSurface {
 public:
  PassSurface(const surface::Surface& surface, bool along_u) : surface_(&surface), along_u_(along_u) {}

  double u(double t, double w) const { return along_u_ ? t : w; }
  double v(double t, double w) const { return along_u_ ? w : t; }
  Vec3 point(double t, double w) const { return surface_->point(u(t, w), v(t, w)); }
  /// Su, Sv, ... are derivatives by t, w, ...
  surface::Derivatives at(double t, double w) const;
  /// Sign of S_t x S_w that points out of the material.
  int outward_sign() const { return along_u_ ? surface_->outward_sign() : -surface_->outward_sign(); }

 private:
  const surface::Surface* surface_;
  bool along_u_;
};

/// Surface and curve derivatives at one t of the graph w(t), in pass parameters.
struct GraphPoint {
  surface::Derivatives d;  ///< by t, w
  Vec3 p, dp, ddp;         ///< curve, mm per unit t
};
GraphPoint graph_point(const PassSurface& surface, const CubicSpline& w, double t);

/// Outward normal vector S_t x S_w (not normalised) on the graph and its derivative along it.
struct NormalJet {
  Vec3 m, dm;
};
NormalJet normal_along(const PassSurface& surface, const surface::Derivatives& d, double dw);

/// Length of the curve between two parameters, mm; what its quadrature leaves out is rounding.
double curve_length(const surface::Surface& surface, const SurfaceCurve& curve, double t_from, double t_to);

/// The parameter that lies `distance_mm` along the curve from t (negative: backwards).
double travel_along(const surface::Surface& surface, const SurfaceCurve& curve, double t, double distance_mm);

}  // namespace swarf::toolpath

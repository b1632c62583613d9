// The proof between the rays where the raw stock is no box: it comes close where the design lies on the raw
// stock's own surface.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "base/units.h"
#include "measure/certificate.h"
#include "stock/rays/surface_dexels.h"
#include "surface/analytic.h"

namespace swarf::measure::raw_certificate_test {
namespace {

using stock::RawShape;

struct RawJob {
  stock::RayFieldPtr field;
  RawShape raw;
  stock::CutterSolid cutter{5.0, 25.0};
  std::vector<stock::Sweep> sweeps = {};
};

Certificate certified(const RawJob& job) {
  stock::Stock stock(job.raw, 0.4);
  stock.cut(job.sweeps, job.cutter);
  const stock::FreeRange ranges({&job.field, 1});
  const SweepCutters cutters(job.cutter);
  Progress progress;
  return certify({.field = *job.field,
                  .ranges = ranges,
                  .sweeps = job.sweeps,
                  .cutters = cutters,
                  .stock = stock,
                  .gouge_limit_mm = 1e-3,
                  .excess_limit_mm = 5e-3,
                  .wants_scallop = true,
                  .scallop_limit_mm = 5e-3,
                  .progress = progress});
}

surface::SurfacePtr cylinder(double radius, double from_x, double length) {
  surface::Turn turn;
  turn.base_W = {from_x, 0, 0};
  turn.axis_W = Vec3::UnitX();
  turn.from_rad = 0.3;
  turn.to_rad = 0.33;
  return surface::cylinder_surface(turn, radius, length, surface::MaterialSide::kConvex);
}

RawShape bar(double radius, double inner = 0.0) {
  return RawShape::of_tube({{-20, 0, 0}, Vec3::UnitX(), radius, inner, 40.0});
}

TEST(RawCertificate, ADesignOnTheBarsOwnSurfaceIsProvenWithoutACut) {
  const Certificate proof = certified({stock::rays_on_surface(cylinder(12.0, -0.2, 0.4), 0.2), bar(12.0)});
  EXPECT_LT(proof.excess.um, 5.0);
  EXPECT_LT(proof.gouge.um, 1.0);
  EXPECT_EQ(proof.open_cells, 0U);
}

}  // namespace
}  // namespace swarf::measure::raw_certificate_test

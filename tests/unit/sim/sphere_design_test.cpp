// [design] kind = "sphere" up to its poles: rays everywhere, with normals and the area of the closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/units.h"
#include "sim/job/design_keys.h"
#include "stock/rays/ray_field.h"
#include "support/program_run.h"

namespace swarf::sim {
namespace {

TEST(SphereDesign, ReachesItsPoles) {
  constexpr double kRadius = 20.0;
  for (const auto& [from, to] : {std::pair{0.0, 180.0}, {0.0, 60.0}, {120.0, 180.0}, {30.0, 90.0}}) {
    const std::string file = (test::fresh_folder("sphere_design") / "scene.toml").string();
    test::write_text(file,
                     fmt::format("[design]\nkind = \"sphere\"\nside = \"convex\"\ncentre_mm = [1, 2, 3]\n"
                                 "radius_mm = {}\npolar_deg = [{}, {}]\n",
                                 kRadius, from, to));
    Diagnostics diagnostics;
    ConfigTable root = ConfigTable::load(file, {}, diagnostics);
    const DesignSettings design = read_design(root.table("design"), true);
    ASSERT_FALSE(diagnostics.has_errors()) << from << " " << to;
    const stock::RayFieldPtr rays = stock::rays_on_surface(design.surfaces.front(), 0.5);
    for (size_t n = 0; n < rays->size(); ++n) {
      const Vec3 radial = (rays->points[n] - Vec3(1, 2, 3)) / kRadius;
      ASSERT_LT((rays->normals[n] - radial).norm(), 1e-9) << n;
    }
    const double area = std::accumulate(rays->areas_mm2.begin(), rays->areas_mm2.end(), 0.0);
    const double exact =
        2.0 * kPi * kRadius * kRadius * (std::cos(rad_from_deg(from)) - std::cos(rad_from_deg(to)));
    // The trapezoidal rule over cells of half a pitch: its relative error is the square of a cell's angle.
    EXPECT_NEAR(area, exact, exact * std::pow(0.5 / kRadius, 2)) << from << " " << to;
  }
}

}  // namespace
}  // namespace swarf::sim

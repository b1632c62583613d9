// A plate with two drilled holes as a mesh of long thin facets, the second hole drilled aside: the gouge of
// its wall is known in closed form and does not hang on the pitch of the rays.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/program_run.h"

namespace thin_facets_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Point = std::array<double, 3>;

constexpr double kPi = 3.14159265358979323846;
constexpr int kSides = 32;  // of a hole; the middle of one faces +X
constexpr double kRadius = 3.0, kThick = 2.0, kWide = 6.0, kLong = 14.0, kAside = 0.8;  // mm

class Stl {
 public:
  void add(const Point& a, const Point& b, const Point& c) {
    text_ += "facet normal 0 0 0\nouter loop\n";
    for (const Point& p : {a, b, c}) text_ += fmt::format("vertex {} {} {}\n", p[0], p[1], p[2]);
    text_ += "endloop\nendfacet\n";
  }
  /// From the lower edge (a, b) up, outward to the right of a -> b.
  void add_wall(const Point& a, const Point& b) {
    const Point high_a{a[0], a[1], 0.0}, high_b{b[0], b[1], 0.0};
    const Point low_a{a[0], a[1], -kThick}, low_b{b[0], b[1], -kThick};
    add(low_a, low_b, high_b);
    add(low_a, high_b, high_a);
  }
  std::string text() const { return "solid plate\n" + text_ + "endsolid plate\n"; }

 private:
  std::string text_;
};

/// The half of the plate from x0 to x1 with its hole: slivers fan from the corners to the hole's sides.
void add_half(Stl& stl, double x0, double x1) {
  const double middle = 0.5 * (x0 + x1);
  const std::array<Point, 4> corners{{{x1, kWide, 0}, {x0, kWide, 0}, {x0, -kWide, 0}, {x1, -kWide, 0}}};
  std::vector<Point> hole;
  for (int i = 0; i <= kSides; ++i) {
    const double angle = 2.0 * kPi * (i % kSides + 0.5) / kSides;
    hole.push_back({middle + kRadius * std::cos(angle), kRadius * std::sin(angle), 0.0});
  }
  const auto both_faces = [&](Point a, Point b, Point c) {
    stl.add(a, b, c);
    a[2] = b[2] = c[2] = -kThick;
    stl.add(a, c, b);
  };
  for (size_t i = 0; i < kSides; ++i) {
    both_faces(corners[4 * i / kSides], hole[i + 1], hole[i]);
    stl.add_wall(hole[i + 1], hole[i]);
  }
  for (size_t k = 0; k < 4; ++k) both_faces(corners[k], corners[(k + 1) % 4], hole[(k + 1) * kSides / 4]);
  stl.add_wall(corners[2], corners[3]);
  stl.add_wall(corners[0], corners[1]);
}

std::string plate() {
  Stl stl;
  add_half(stl, -kLong, 0.0);
  add_half(stl, 0.0, kLong);
  stl.add_wall({kLong, -kWide, 0}, {kLong, kWide, 0});
  stl.add_wall({-kLong, kWide, 0}, {-kLong, -kWide, 0});
  return stl.text();
}

TEST(ThinFacets, AHoleDrilledAsideGougesByTheSameAtAnyPitch) {
  const fs::path folder = swarf::test::fresh_folder("thin_facets");
  swarf::test::write_text(folder / "plate.stl", plate());
  swarf::test::write_text(folder / "path.cl", fmt::format("UNITS/MM\nLOADTL/1\nMULTAX/ON\nSPINDL/8000,CLW\n"
                                                          "FROM/-7,0,30,0,0,1\nFEDRAT/300,MMPM\n"
                                                          "GOTO/-7,0,-4,0,0,1\nGOTO/-7,0,10,0,0,1\n"
                                                          "GOTO/{0},0,10,0,0,1\nGOTO/{0},0,-4,0,0,1\n"
                                                          "GOTO/{0},0,10,0,0,1\nFINI\n",
                                                          7.0 + kAside));
  swarf::test::write_text(folder / "scene.toml",
                          "machine = \"" SWARF_SOURCE_DIR
                          "/assets/machines/lin_koren_xyzab/machine.toml\"\ncl = \"path.cl\"\n"
                          "[cutter]\nnumber = 1\ndiameter_mm = 6\nflute_length_mm = 25\nlength_mm = 60\n"
                          "[stock]\nbox_mm = [[-14, -6, -2], [14, 6, 0]]\nvoxel_mm = 0.4\n"
                          "[design]\nkind = \"mesh\"\nmesh = \"plate.stl\"\n"
                          "[interpolator]\nmode = \"tcp\"\n[movie]\nseconds = 0\n");
  // The drill reaches kAside beyond the circle through the corners of the sides.
  const double truth_um = 1e3 * (kAside + kRadius * (1.0 - std::cos(kPi / kSides)));
  for (const char* pitch : {"0.5", "1", "2"}) {
    const auto run = swarf::test::run_swarf("run " + (folder / "scene.toml").string() + " --no-render -o " +
                                            (folder / "run").string() + " --set design.pitch_mm=" + pitch);
    ASSERT_LE(run.exit_code, 1) << run.output;
    const json metrics = json::parse(std::ifstream(folder / "run" / "metrics.json"));
    EXPECT_NEAR(metrics.at("surface").at("gouge_max_um").get<double>(), truth_um, 0.2) << pitch;
    const json& worst = metrics.at("gouges").at(0);
    EXPECT_NEAR(worst.at("worst_um").get<double>(), truth_um, 0.2) << pitch;
    EXPECT_EQ(worst.at("line"), 10) << pitch;
    for (const json& gouge : metrics.at("gouges")) {
      EXPECT_GT(gouge.at("area_mm2").get<double>(), 0.0) << pitch;
      EXPECT_LE(gouge.at("worst_um").get<double>(), truth_um + 0.2) << pitch;
    }
  }
  fs::remove_all(folder);
}

}  // namespace

}  // namespace thin_facets_test

// Random plates, right and wrong ones: what a run tells of its part and what `swarf compare` finds on the
// same finished stock lie within each other's bounds, and every place told lies on the design.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "mesh/mesh_io.h"
#include "mesh/signed_distance.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace random_plates_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::Vec3;

constexpr double kFaceMill = 20.0, kTool = 4.0, kBottom = -12.0;

/// A plate over a grid of cells: some are pockets, slots or through, some bosses, the rest is faced.
struct Plate {
  std::vector<double> x{0.0}, y{0.0};
  std::vector<std::vector<double>> top;
};

Plate make_plate(std::mt19937& random) {
  const auto pick = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Plate plate;
  for (std::vector<double>* lines : {&plate.x, &plate.y}) {
    const int cells = std::uniform_int_distribution<int>(2, 4)(random);
    for (int i = 0; i < cells; ++i) lines->push_back(lines->back() + std::round(pick(6.0, 14.0) * 8.0) / 8.0);
  }
  const std::vector<double> heights{0.0, 0.0, -1.5, -4.0, -7.25};
  for (size_t i = 0; i + 1 < plate.x.size(); ++i) {
    plate.top.emplace_back();
    for (size_t j = 0; j + 1 < plate.y.size(); ++j)
      plate.top.back().push_back(
          heights[std::uniform_int_distribution<size_t>(0, heights.size() - 1)(random)]);
  }
  // Two towers that touch along an upright edge are no manifold.
  for (bool touches = true; touches;) {
    touches = false;
    for (size_t i = 1; i < plate.top.size(); ++i) {
      for (size_t j = 1; j < plate.top[i].size(); ++j) {
        const double a = plate.top[i - 1][j - 1], b = plate.top[i - 1][j], c = plate.top[i][j - 1];
        double& d = plate.top[i][j];
        if (std::min(a, d) <= std::max(b, c) && std::min(b, c) <= std::max(a, d)) continue;
        d = b;
        touches = true;
      }
    }
  }
  return plate;
}

/// A line that an upright flat end runs along, and all that stands above it.
struct Cut {
  swarf::Vec2 from, to;
  double z, radius;
  bool removes(const Vec3& p) const {
    if (p.z() < z) return false;
    const swarf::Vec2 way = to - from, off = p.head<2>() - from;
    const double length2 = way.squaredNorm();
    const double share = length2 > 0.0 ? std::clamp(off.dot(way) / length2, 0.0, 1.0) : 0.0;
    return (off - share * way).norm() <= radius;
  }
};

/// A program and what it cuts.
class Program {
 public:
  void call(int tool, double diameter_mm) {
    radius_ = 0.5 * diameter_mm;
    text_ << "T" << tool << " M6\nS5000 M3\nG0 Z5\nG43 H" << tool << " Z5\n";
  }
  void plunge(double x, double y, double z) {
    text_ << "G0 Z5\nX" << x << " Y" << y << "\nG1 Z" << z << " F300\n";
    at_ = {x, y};
    z_ = z;
    cuts_.push_back({at_, at_, z_, radius_});
  }
  void go_to(double x, double y) {
    text_ << "X" << x << " Y" << y << "\n";
    cuts_.push_back({at_, {x, y}, z_, radius_});
    at_ = {x, y};
  }
  std::string text() const { return "%\nG21 G90 G17 G54\n" + text_.str() + "G0 Z5\nM30\n%\n"; }
  bool removes(const Vec3& p) const {
    return std::any_of(cuts_.begin(), cuts_.end(), [&](const Cut& cut) { return cut.removes(p); });
  }

 private:
  std::ostringstream text_;
  std::vector<Cut> cuts_;
  swarf::Vec2 at_ = swarf::Vec2::Zero();
  double z_ = 0.0, radius_ = 0.0;
};

/// Three decimals, as the program has them.
double rounded(double mm) {
  return std::round(1e3 * mm) * 1e-3;
}

/// Faces the plate, then runs round in each pocket cell; a cell in three is cut wrongly by up to 50 um.
Program program_of(const Plate& plate, std::mt19937& random) {
  const auto error = [&] {
    return std::uniform_int_distribution<int>(0, 2)(random) == 0
               ? std::uniform_real_distribution<double>(-0.05, 0.05)(random)
               : 0.0;
  };
  Program program;
  program.call(1, kFaceMill);
  for (double y = 0.0; y < plate.y.back() + 10.0; y += 8.0) {
    program.plunge(-12.0, y, 0.0);
    program.go_to(plate.x.back() + 12.0, y);
  }
  program.call(2, kTool);
  for (size_t i = 0; i + 1 < plate.x.size(); ++i) {
    for (size_t j = 0; j + 1 < plate.y.size(); ++j) {
      if (plate.top[i][j] == 0.0) continue;
      const double r = 0.5 * kTool + error();
      const double x0 = rounded(plate.x[i] + r), x1 = rounded(plate.x[i + 1] - r),
                   y0 = rounded(plate.y[j] + r), y1 = rounded(plate.y[j + 1] - r);
      program.plunge(x0, y0, rounded(plate.top[i][j] + error()));
      for (double y = y0; y < y1; y += 3.0) {
        program.go_to(x0, y);
        program.go_to(x1, y);
        program.go_to(x0, y);
      }
      for (const auto& [x, y] : {std::pair{x0, y1}, {x1, y1}, {x1, y0}, {x0, y0}}) program.go_to(x, y);
    }
  }
  return program;
}

/// The finished part as it is, point by point.
struct Truth {
  const swarf::mesh::SignedDistance& design;
  const Program& program;
  swarf::Box stock;

  /// Leftover above 0, gouge below, mm; 0 where the part is right.
  double at(const Vec3& p) const {
    const bool inside = (p.array() > stock.lower.array()).all() && (p.array() < stock.upper.array()).all();
    const double distance = design.at(p).distance_mm;
    const bool is_material = inside && !program.removes(p);
    return is_material == (distance < 0.0) ? 0.0 : distance;
  }
};

/// The worst of random places around one: a place that is told is real where they come near to what is told.
double worst_near(const Truth& truth, const Vec3& place, double reach_mm, double sign, std::mt19937& random) {
  constexpr double kThinnest = 1e-3;  // mm: walls between two cells that are cut a little too narrow
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::bernoulli_distribution is_beside(0.4);
  double worst = 0.0;
  for (const double reach : {reach_mm, 0.3 * reach_mm}) {
    for (int n = 0; n < 20'000; ++n) {
      Vec3 off;
      for (int k = 0; k < 3; ++k) off[k] = part(random) * (is_beside(random) ? kThinnest : reach);
      worst = std::max(worst, sign * truth.at(place + off));
    }
  }
  return worst;
}

json check_of(const json& metrics, const std::string& name) {
  for (const json& check : metrics.at("checks"))
    if (check.at("name") == name) return check;
  return {};
}

json metrics_of(const fs::path& folder) {
  return json::parse(swarf::test::read_text(folder / "metrics.json"));
}

/// A random place over a facet or below it.
Vec3 place_beside(const swarf::TriMesh& mesh, double reach_mm, std::mt19937& random) {
  const auto pick = [&](double high) { return std::uniform_real_distribution<double>(0.0, high)(random); };
  const auto& t = mesh.triangles[std::uniform_int_distribution<size_t>(0, mesh.triangles.size() - 1)(random)];
  const auto corner = [&](size_t k) {
    const auto& p = mesh.positions[t[k]];
    return Vec3(p[0], p[1], p[2]);
  };
  double u = pick(1.0), v = pick(1.0);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  const Vec3 ab = corner(1) - corner(0), ac = corner(2) - corner(0);
  return corner(0) + u * ab + v * ac + (2.0 * pick(reach_mm) - reach_mm) * ab.cross(ac).normalized();
}

class RandomPlates : public testing::TestWithParam<unsigned> {};

TEST_P(RandomPlates, AreToldAsTheyAre) {
  const unsigned seed = GetParam();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const fs::path folder = swarf::test::fresh_folder("plate_" + std::to_string(seed));
  const Plate plate = make_plate(random);
  const swarf::TriMesh mesh =
      swarf::test::towers(plate.x, plate.y, kBottom, [&](int i, int j) { return plate.top[i][j]; });
  const Program program = program_of(plate, random);
  swarf::mesh::save_mesh((folder / "part.stl").string(), mesh);
  swarf::test::write_text(folder / "part.nc", program.text());
  const swarf::Box stock{Vec3(0, 0, kBottom), Vec3(plate.x.back(), plate.y.back(), 0.5)};
  std::ostringstream scene;
  scene << "nc = \"part.nc\"\ntools = \"T1=" << kFaceMill << ",T2=" << kTool << "\"\nstock.box_mm = [[0, 0, "
        << kBottom << "], [" << stock.upper.x() << ", " << stock.upper.y()
        << ", 0.5]]\nstock.voxel_mm = 0.25\n"
        << "setup.work_origin_mm = \"on_table\"\n[design]\nmesh = \"part.stl\"\n"
        << "[accept]\ngouge_max_um = 2\nexcess_max_um = 10\n";
  swarf::test::write_text(folder / "scene.toml", scene.str());
  const auto run = swarf::test::run_swarf("run " + (folder / "scene.toml").string() + " --no-render -o " +
                                          (folder / "run").string());
  ASSERT_LE(run.exit_code, 1) << run.output;
  const json told = json::parse(swarf::test::read_text(folder / "run/metrics.json"));
  const swarf::mesh::SignedDistance design(mesh);
  const Truth truth{design, program, stock};
  double left = 0.0, cut = 0.0;
  for (const double reach : {0.06, 0.06, 8.0}) {
    for (int n = 0; n < 20'000; ++n) {
      const double off = truth.at(place_beside(mesh, reach, random));
      left = std::max(left, off);
      cut = std::max(cut, -off);
    }
  }
  for (const auto& [name, seen_mm, sign] : {std::tuple{"excess", left, 1.0}, {"gouge", cut, -1.0}}) {
    const json check = check_of(told, name);
    const double value_mm = 1e-3 * check.at("value").get<double>(),
                 bound_mm = 1e-3 * check.at("bound").get<double>();
    double real_mm = seen_mm;
    EXPECT_LE(seen_mm, bound_mm) << name;
    EXPECT_LE(value_mm, bound_mm) << name;
    for (const json& finding : json::parse(swarf::test::read_text(folder / "run/findings.json"))) {
      if (finding.at("code") != name) continue;
      const json& p = finding.at("place_mm");
      const Vec3 place(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
      EXPECT_LE(std::abs(design.at(place).distance_mm), value_mm + 1e-3) << finding.at("text");
      const double near_mm = worst_near(truth, place, value_mm, sign, random);
      EXPECT_GT(near_mm, 0.0) << "phantom: " << finding.at("text");
      real_mm = std::max(real_mm, near_mm);
    }
    // Thin spikes are seldom met by their tips.
    if (value_mm > 0.01) EXPECT_GT(real_mm, 0.5 * value_mm) << name << ": nothing like it is there";
  }
}

/// SWARF_PLATES=200 tries more of them.
std::vector<unsigned> seeds() {
  const char* const more = std::getenv("SWARF_PLATES");
  std::vector<unsigned> list(more != nullptr ? std::strtoul(more, nullptr, 10) : 6);
  for (unsigned n = 0; n < list.size(); ++n) list[n] = n + 1;
  return list;
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomPlates, testing::ValuesIn(seeds()));

}  // namespace
}  // namespace random_plates_test

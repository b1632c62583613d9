// The colours of part.glb, read back to deviations at random places, are those of the part: exact walls have
// the colour of 0, whatever stands or is missing beside them.
//
// Finished part and design are solids of faces in closed form. A place of a coloured triangle is moved along
// the triangle's normal onto the finished part, as a ray would find it, and its distance from the design is
// what the colour must say.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/rng.h"
#include "mesh/mesh_io.h"
#include "mesh/plain_solids.h"
#include "mesh/polygon.h"
#include "render/figures/colour.h"
#include "support/glb.h"
#include "support/program_run.h"

namespace colours_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::Vec2;
using swarf::Vec3;
using swarf::test::Glb;

/// A straight side, or the arc about a centre from a to b, counter-clockwise or clockwise: nearest distance.
struct Side {
  Vec2 a, b, centre = Vec2::Zero();
  double radius = 0.0;  ///< 0: straight

  double distance(const Vec2& p) const {
    if (radius > 0.0) {
      const Vec2 way = p - centre, middle = 0.5 * (a + b) - centre;
      const bool whole = (a - b).norm() < 1e-9;
      const bool within = whole || way.normalized().dot(middle.normalized()) >=
                                       (a - centre).normalized().dot(middle.normalized()) - 1e-12;
      if (within) return std::abs(way.norm() - radius);
      return std::min((p - a).norm(), (p - b).norm());
    }
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
  }
};

/// A closed outline; arcs are at most half a circle, or whole.
struct Outline {
  std::vector<Side> sides;
  bool is_circle = false;

  double distance(const Vec2& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Side& side : sides) least = std::min(least, side.distance(p));
    return least;
  }
  /// By the corners; a rounded corner belongs to the inside as far as its arc.
  bool holds(const Vec2& p) const {
    if (is_circle) return (p - sides[0].centre).norm() <= sides[0].radius;
    bool in = false;
    for (const Side& side : sides) {
      const Vec2 &a = side.a, &b = side.b;
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        in = !in;
      if (side.radius > 0.0 && (p - side.centre).norm() < side.radius) {
        const Vec2 out = 0.5 * (a + b) - side.centre;
        if ((p - side.centre).dot(out) > out.squaredNorm()) return true;
      }
    }
    return in;
  }
};

Outline circle(const Vec2& centre, double radius, int facets) {
  Outline out;
  const auto at = [&](int i) {
    const double turn = 2.0 * swarf::kPi * (i % std::max(facets, 1)) / std::max(facets, 1);
    return Vec2(centre + radius * Vec2(std::cos(turn), std::sin(turn)));
  };
  if (facets == 0) {
    out.sides.push_back({at(0), at(0), centre, radius});
    out.is_circle = true;
    return out;
  }
  for (int i = 0; i < facets; ++i) out.sides.push_back({at(i), at(i + 1)});
  return out;
}

/// A rectangle whose corners are quarter circles, or polylines of so many facets each.
Outline rectangle(const Vec2& centre, const Vec2& half, double radius, int facets) {
  std::vector<Side> sides;
  const auto join = [&](const Vec2& a, const Vec2& b) {
    if ((a - b).norm() > 1e-12) sides.push_back({a, b});
  };
  Vec2 last = centre + Vec2(half.x(), -half.y() + radius);
  const Vec2 begin = last;
  for (int k = 0; k < 4; ++k) {
    const Vec2 corner = centre + Vec2((k == 0 || k == 3 ? 1 : -1) * (half.x() - radius),
                                      (k < 2 ? 1 : -1) * (half.y() - radius));
    const auto at = [&](double share) {
      const double turn = 0.5 * swarf::kPi * (k + share);
      return Vec2(corner + radius * Vec2(std::cos(turn), std::sin(turn)));
    };
    join(last, at(0.0));
    if (radius > 0.0 && facets == 0) sides.push_back({at(0.0), at(1.0), corner, radius});
    for (int i = 0; radius > 0.0 && i < facets; ++i)
      join(at(static_cast<double>(i) / facets), at(static_cast<double>(i + 1) / facets));
    last = at(1.0);
  }
  join(last, begin);
  return {sides};
}

/// What stands over an outline from one height to another, or is taken out there.
struct Layer {
  Outline outline;
  double low, high;
  bool holds(const Vec3& p) const { return p.z() >= low && p.z() <= high && outline.holds(p.head<2>()); }
};

/// Blocks on each other with holes in them; no wall of one continues one of another.
struct Solid {
  std::vector<Layer> blocks, holes;

  bool holds(const Vec3& p) const {
    const auto in = [&](const Layer& layer) { return layer.holds(p); };
    return std::any_of(blocks.begin(), blocks.end(), in) && std::none_of(holes.begin(), holes.end(), in);
  }
  /// From its surface: of a design of one block with holes.
  double distance(const Vec3& p) const {
    const Vec2 at = p.head<2>();
    double least = std::numeric_limits<double>::infinity();
    const auto wall = [&](const Layer& layer, double low, double high) {
      const double over = std::max({low - p.z(), p.z() - high, 0.0});
      least = std::min(least, std::hypot(layer.outline.distance(at), over));
    };
    const Layer& block = blocks.front();
    wall(block, block.low, block.high);
    for (const Layer& hole : holes) {
      wall(hole, std::max(hole.low, block.low), block.high);
      if (hole.low > block.low && hole.outline.holds(at)) least = std::min(least, std::abs(p.z() - hole.low));
    }
    for (const double z : {block.low, block.high}) {
      const bool open = std::any_of(holes.begin(), holes.end(), [&](const Layer& hole) {
        return hole.outline.holds(at) && hole.low < z && hole.high > z;
      });
      if (block.outline.holds(at) && !open) least = std::min(least, std::abs(p.z() - z));
    }
    return holds(p) ? -least : least;
  }
};

/// A plate with a pocket and a bore; a tool of D8 mills it.
struct Plate {
  Vec2 half{30, 20}, pocket{8, 0}, pocket_half{12, 10}, bore{-18, 0};
  double thick = 12, pocket_depth = 6, corner = 5, bore_radius = 6;
};
constexpr double kToolRadius = 4.0, kRaw = 1.5, kRawTop = 1.0;

/// What is wrong with it: mm.
struct Faults {
  double top = 0.02;     ///< left on it
  double floor = -0.03;  ///< below the pocket's
  double wall = 0.0;     ///< left on the pocket's
  double bore = 0.012;   ///< of its radius, too large
  double skirt = 10.0;   ///< the outside is milled down to
};

/// Below `far` nothing ends: the hole goes through.
constexpr double kFar = 100.0;

Solid design_of(const Plate& p, int facets) {
  return {{{rectangle({0, 0}, p.half, 0.0, 0), -p.thick, 0.0}},
          {{circle(p.bore, p.bore_radius, facets), -kFar, kFar},
           {rectangle(p.pocket, p.pocket_half, p.corner, facets / 4), -p.pocket_depth, kFar}}};
}

Solid finished_of(const Plate& p, const Faults& f) {
  return {{{rectangle({0, 0}, p.half, 0.0, 0), -p.thick, f.top},
           {rectangle({0, 0}, p.half + Vec2::Constant(kRaw), 0.0, 0), -p.thick, -f.skirt}},
          {{circle(p.bore, p.bore_radius + f.bore, 0), -kFar, kFar},
           {rectangle(p.pocket, p.pocket_half - Vec2::Constant(f.wall), p.corner - f.wall, 0),
            -p.pocket_depth + f.floor, kFar}}};
}

std::string g1(const Vec2& p) {
  return fmt::format("G1 X{:.4f} Y{:.4f} F1200\n", p.x(), p.y());
}

/// Around a rectangle of tool centres whose corners are arcs.
std::string around(const Vec2& centre, const Vec2& half, double r) {
  const Vec2 c = centre, h = half;
  return g1(c + Vec2(0, -h.y())) + g1(c + Vec2(h.x() - r, -h.y())) +
         fmt::format("G3 X{:.4f} Y{:.4f} R{:.4f}\n", c.x() + h.x(), c.y() - h.y() + r, r) +
         g1(c + Vec2(h.x(), h.y() - r)) +
         fmt::format("G3 X{:.4f} Y{:.4f} R{:.4f}\n", c.x() + h.x() - r, c.y() + h.y(), r) +
         g1(c + Vec2(-h.x() + r, h.y())) +
         fmt::format("G3 X{:.4f} Y{:.4f} R{:.4f}\n", c.x() - h.x(), c.y() + h.y() - r, r) +
         g1(c + Vec2(-h.x(), -h.y() + r)) +
         fmt::format("G3 X{:.4f} Y{:.4f} R{:.4f}\n", c.x() - h.x() + r, c.y() - h.y(), r) +
         g1(c + Vec2(0, -h.y()));
}

std::string program_of(const Plate& p, const Faults& f) {
  std::string nc = "%\nO1\nG21 G90 G94 G17 G54\nT1 M6\nS8000 M3\nG0 X-60. Y-60.\nG43 H1 Z20.\n";
  nc += fmt::format("G0 Z{:.4f}\n", f.top);
  const double x = p.half.x() + 8.0;
  double from = -x;
  for (double y = -p.half.y() - 1.0; y < p.half.y() + 4.0; y += 6.0, from = -from)
    nc += g1({from, y}) + g1({-from, y});
  nc += fmt::format("G0 Z20.\nG0 X{:.4f} Y{:.4f}\nG1 Z{:.4f} F300\n", p.bore.x(), p.bore.y(), -p.thick - 0.5);
  const double orbit = p.bore_radius + f.bore - kToolRadius;
  nc += g1(p.bore + Vec2(orbit, 0)) +
        fmt::format("G3 X{:.4f} Y{:.4f} I{:.4f} J0\n", p.bore.x() + orbit, p.bore.y(), -orbit) + g1(p.bore);
  nc += fmt::format("G0 Z20.\nG0 X{:.4f} Y{:.4f}\nG1 Z{:.4f} F300\n", p.pocket.x(), p.pocket.y(),
                    -p.pocket_depth + f.floor);
  const Vec2 last = p.pocket_half - Vec2::Constant(f.wall + kToolRadius);
  for (const double share : {0.3, 0.6, 0.85}) nc += around(p.pocket, share * last, 0.1);
  nc += around(p.pocket, last, p.corner - f.wall - kToolRadius);
  nc += g1(p.pocket) + fmt::format("G0 Z20.\nG0 X-60. Y-60.\nG0 Z{:.4f}\n", -f.skirt);
  const Vec2 out = p.half + Vec2::Constant(kToolRadius);
  nc += g1({-out.x(), -60}) + g1({-out.x(), out.y()}) + g1({out.x(), out.y()}) + g1({out.x(), -out.y()}) +
        g1({-60, -out.y()});
  return nc + "G0 Z20.\nM5\nM30\n%\n";
}

/// The design as triangles: top and bottom in two halves along y = 0, which pocket and bore lie on.
class PlateMesh {
 public:
  PlateMesh(const Plate& p, int facets) {
    const Solid design = design_of(p, facets);
    const double bottom = -p.thick, floor = -p.pocket_depth;
    const Outline &block = design.blocks[0].outline, &bore = design.holes[0].outline,
                  &pocket = design.holes[1].outline;
    for (const double side : {1.0, -1.0}) {
      add_half({&block, &bore, &pocket}, side, 0.0, true);
      add_half({&block, &bore}, side, bottom, false);
      add_half({&pocket}, side, floor, true);
    }
    add_walls(block, bottom, 0.0, true);
    add_walls(bore, bottom, 0.0, false);
    add_walls(pocket, floor, 0.0, false);
  }
  swarf::TriMesh mesh;

 private:
  uint32_t add(const Vec2& p, double z) {
    const double y = std::abs(p.y()) < 1e-9 ? 0.0 : p.y();
    mesh.positions.push_back({static_cast<float>(p.x()), static_cast<float>(y), static_cast<float>(z)});
    return static_cast<uint32_t>(mesh.positions.size() - 1);
  }
  /// Corners of an outline on one side of y = 0, those on it too, from left to right.
  static std::vector<Vec2> half_of(const Outline& outline, double side) {
    std::vector<Vec2> half;
    for (const Side& one : outline.sides) {
      if (side * one.a.y() > 1e-9) half.push_back(one.a);
      if ((one.a.y() > 1e-9 && one.b.y() < -1e-9) || (one.a.y() < -1e-9 && one.b.y() > 1e-9))
        half.push_back({one.a.x() + one.a.y() / (one.a.y() - one.b.y()) * (one.b.x() - one.a.x()), 0.0});
      if (std::abs(one.a.y()) <= 1e-9) half.push_back({one.a.x(), 0.0});
    }
    double middle = 0.0;
    for (const Vec2& p : half) middle += p.x() / static_cast<double>(half.size());
    std::sort(half.begin(), half.end(), [&](const Vec2& a, const Vec2& b) {
      return std::atan2(std::abs(a.y()), a.x() - middle) > std::atan2(std::abs(b.y()), b.x() - middle);
    });
    return half;
  }
  void add_half(const std::vector<const Outline*>& outlines, double side, double z, bool up) {
    std::vector<Vec2> corners = half_of(*outlines[0], side);
    std::reverse(corners.begin(), corners.end());  // from right to left; back along y = 0
    for (size_t n = 1; n < outlines.size(); ++n)
      for (const Vec2& p : half_of(*outlines[n], side)) corners.push_back(p);
    if ((side > 0.0) != up) std::reverse(corners.begin(), corners.end());
    std::vector<uint32_t> polygon;
    for (const Vec2& p : corners) polygon.push_back(add(p, z));
    ASSERT_TRUE(swarf::mesh::append_polygon(polygon, mesh.positions, mesh.triangles));
  }
  void add_walls(const Outline& outline, double low, double high, bool out) {
    const auto quad = [&](Vec2 a, Vec2 b) {
      if (!out) std::swap(a, b);
      const uint32_t i = add(a, low), j = add(b, low), k = add(b, high), l = add(a, high);
      mesh.triangles.push_back({i, j, k});
      mesh.triangles.push_back({i, k, l});
    };
    for (const Side& one : outline.sides) {
      const double ya = one.a.y(), yb = one.b.y();
      if ((ya > 1e-9 && yb < -1e-9) || (ya < -1e-9 && yb > 1e-9)) {
        const Vec2 middle(one.a.x() + ya / (ya - yb) * (one.b.x() - one.a.x()), 0.0);
        quad(one.a, middle);
        quad(middle, one.b);
      } else {
        quad(one.a, one.b);
      }
    }
  }
};

/// A triangle of part.glb with linear colours.
struct Corner {
  Vec3 place, colour;
};
using Coloured = std::array<Corner, 3>;

class GlbMesh {
 public:
  GlbMesh(const Glb& glb, const std::string& name) : glb_(glb) {
    for (const json& mesh : glb.model.at("meshes"))
      if (mesh.at("name") == name) primitive_ = &mesh.at("primitives").at(0);
  }
  bool empty() const { return primitive_ == nullptr; }
  std::vector<Coloured> triangles() const {
    const json& attributes = primitive_->at("attributes");
    const json& indices = accessor(primitive_->at("indices"));
    std::vector<Coloured> out(indices.at("count").get<size_t>() / 3);
    const bool wide = indices.at("componentType") == 5125;
    for (size_t i = 0; i < 3 * out.size(); ++i) {
      const size_t v = wide ? read<uint32_t>(indices, i, 1, 0) : read<uint16_t>(indices, i, 1, 0);
      Corner& corner = out[i / 3][i % 3];
      for (size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<int>(k);
        corner.place[axis] = read<float>(accessor(attributes.at("POSITION")), v, 3, k);
        if (attributes.contains("COLOR_0"))
          corner.colour[axis] = read<uint8_t>(accessor(attributes.at("COLOR_0")), v, 4, k) / 255.0;
      }
    }
    return out;
  }

 private:
  const json& accessor(const json& index) const { return glb_.model.at("accessors").at(index.get<size_t>()); }
  template <typename T>
  T read(const json& accessor, size_t i, size_t components, size_t k) const {
    const json& view = glb_.model.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
    const size_t stride = view.value("byteStride", components * sizeof(T));
    T value{};
    std::memcpy(&value,
                glb_.binary.data() + view.value("byteOffset", size_t{0}) +
                    accessor.value("byteOffset", size_t{0}) + i * stride + k * sizeof(T),
                sizeof value);
    return value;
  }
  const Glb& glb_;
  const json* primitive_ = nullptr;
};

Vec3 cross_of(const Coloured& t) {
  return (t[1].place - t[0].place).cross(t[2].place - t[0].place);
}

double area_of(const std::vector<Coloured>& triangles) {
  double sum = 0.0;
  for (const Coloured& t : triangles) sum += 0.5 * cross_of(t).norm();
  return sum;
}

/// The deviation whose colour is nearest, um.
class Decoder {
 public:
  explicit Decoder(double scale_um) : scale_(scale_um) {
    for (int i = -kSteps; i <= kSteps; ++i) {
      const auto c =
          swarf::render::deviation_colour(scale_um * i / kSteps, swarf::render::DeviationScale(scale_um));
      colours_.emplace_back(c[0], c[1], c[2]);
    }
  }
  double operator()(const Vec3& colour) const {
    size_t best = 0;
    for (size_t i = 1; i < colours_.size(); ++i)
      if ((colours_[i] - colour).squaredNorm() < (colours_[best] - colour).squaredNorm()) best = i;
    return scale_ * (static_cast<double>(best) / kSteps - 1.0);
  }

 private:
  static constexpr int kSteps = 1000;
  double scale_;
  std::vector<Vec3> colours_;
};

/// Where the finished part's surface lies on the line, between 0.05 mm below a place and above it.
std::optional<Vec3> on_surface(const Solid& part, const Vec3& place, const Vec3& normal) {
  double low = -0.05, high = 0.05;
  if (!part.holds(place + low * normal) || part.holds(place + high * normal)) return {};
  for (int i = 0; i < 40; ++i)
    (part.holds(place + 0.5 * (low + high) * normal) ? low : high) = 0.5 * (low + high);
  return Vec3(place + low * normal);
}

struct Agreement {
  size_t seen = 0, wrong = 0;
  double worst_um = 0.0;
  Vec3 where = Vec3::Zero();
};

/// Of random places of coloured triangles, evenly by area.
Agreement agreement(const std::vector<Coloured>& triangles, const Solid& part, const Solid& design,
                    double scale_um, size_t places) {
  const Decoder decoded(scale_um);
  std::vector<double> sums;
  double sum = 0.0;
  for (const Coloured& t : triangles) sums.push_back(sum += 0.5 * cross_of(t).norm());
  swarf::Rng rng(41);
  Agreement found;
  for (size_t n = 0; n < places; ++n) {
    const auto i =
        static_cast<size_t>(std::lower_bound(sums.begin(), sums.end(), rng.uniform(0.0, sum)) - sums.begin());
    const Coloured& t = triangles[std::min(i, triangles.size() - 1)];
    double u = rng.uniform(), v = rng.uniform();
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const Vec3 place = (1.0 - u - v) * t[0].place + u * t[1].place + v * t[2].place;
    const auto met = on_surface(part, place, cross_of(t).normalized());
    if (!met) continue;
    ++found.seen;
    const double truth = std::clamp(1e3 * design.distance(*met), -scale_um, scale_um);
    const double shown = decoded((1.0 - u - v) * t[0].colour + u * t[1].colour + v * t[2].colour);
    const double off = std::abs(shown - truth);
    if (off > std::max(1.0, 0.02 * scale_um)) ++found.wrong;
    if (off <= found.worst_um) continue;
    found.worst_um = off;
    found.where = place;
  }
  return found;
}

class ColoursOfAPart : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder(std::string("colours_of_") +
                                        ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs the plate with these faults against a design ("mesh = ..", "step = .."), and compares.
  void expect_true_colours(const Plate& plate, const Faults& faults, const std::string& design, int facets,
                           double limit_um) {
    swarf::test::write_text(folder_ / "plate.nc", program_of(plate, faults));
    const Vec2 raw = plate.half + Vec2::Constant(kRaw);
    swarf::test::write_text(
        folder_ / "scene.toml",
        fmt::format("nc = \"plate.nc\"\ntools = \"T1=8\"\n[setup]\nwork_origin_mm = \"on_table\"\n"
                    "[stock]\nbox_mm = [[{}, {}, {}], [{}, {}, {}]]\nvoxel_mm = 0.4\n"
                    "[accept]\ngouge_max_um = {}\nexcess_max_um = {}\n[design]\npitch_mm = 2\n{}\n",
                    -raw.x(), -raw.y(), -plate.thick, raw.x(), raw.y(), kRawTop, limit_um, limit_um, design));
    const auto run = swarf::test::run_swarf("run " + (folder_ / "scene.toml").string() + " -o " +
                                            (folder_ / "run").string() +
                                            " --set movie.seconds=0 --set \"stills.kinds=[]\"");
    ASSERT_LE(run.exit_code, 1) << run.output;
    const Glb glb = swarf::test::read_glb(folder_ / "run/part.glb");
    const json& extras = glb.model.at("asset").at("extras");
    EXPECT_EQ(extras.at("deviation_scale_below_um"), extras.at("deviation_scale_above_um"));
    EXPECT_EQ(extras.at("deviation_scale_above_um"), limit_um);
    const GlbMesh measured(glb, "machined surface"), rest(glb, "part");
    ASSERT_FALSE(measured.empty());
    const std::vector<Coloured> triangles = measured.triangles();
    const double area = area_of(triangles), grey = rest.empty() ? 0.0 : area_of(rest.triangles());
    EXPECT_LT(grey, 5e-3 * area) << "but at edges all of it can be measured";
    constexpr size_t kPlaces = 10000;
    const Agreement found =
        agreement(triangles, finished_of(plate, faults), design_of(plate, facets), limit_um, kPlaces);
    EXPECT_GT(found.seen, kPlaces * 99 / 100) << "but at edges each place lies over the part";
    EXPECT_LE(found.wrong, kPlaces * 6 / 1000) << found.worst_um << " um off at " << found.where.transpose();
    EXPECT_LT(fs::file_size(folder_ / "run/part.glb"), 6U << 20);
    // A part with another floor must not agree: the comparison sees what it is to see.
    Faults other = faults;
    other.floor += 0.004;
    EXPECT_GT(
        agreement(triangles, finished_of(plate, other), design_of(plate, facets), limit_um, kPlaces).wrong,
        100U);
  }
  fs::path folder_;
};

TEST_F(ColoursOfAPart, WithAMeshAreThoseOfTheWholePart) {
  const Plate plate;
  const int facets = 64;
  swarf::mesh::save_mesh((folder_ / "plate.stl").string(), PlateMesh(plate, facets).mesh);
  expect_true_colours(plate, {}, "mesh = \"plate.stl\"", facets, 50.0);
}

TEST_F(ColoursOfAPart, WithANarrowScaleTellMicrometres) {
  Plate plate;
  plate.half = {42, 27};
  plate.pocket_half = {19, 15};
  plate.bore = {-26, 0};
  plate.thick = 15;
  plate.pocket_depth = 9;
  plate.bore_radius = 7.5;
  const int facets = 96;
  swarf::mesh::save_mesh((folder_ / "plate.stl").string(), PlateMesh(plate, facets).mesh);
  expect_true_colours(plate, {0.004, 0.0, 0.006, -0.005, 15.5}, "mesh = \"plate.stl\"", facets, 10.0);
}

TEST_F(ColoursOfAPart, WithCadFacesAreThoseOfTheWholePart) {
  fs::copy_file(SWARF_SOURCE_DIR "/tests/data/parts/plate.stp", folder_ / "plate.stp");
  expect_true_colours({}, {}, "step = \"plate.stp\"", 0, 50.0);
}

/// A faced plate of 100 x 70 whose top is two facets; the ball dents it, 1 mm across and 20 um deep.
class ColoursOfAFacet : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder(std::string("colours_of_a_facet_") +
                                        ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Coloured triangles with the ball's tip at this height.
  std::vector<Coloured> with_ball_at(double z) {
    swarf::TriMesh plate;
    swarf::mesh::add_box(plate, {{-50, -35, -12}, {50, 35, 0}});
    swarf::mesh::save_mesh((folder_ / "plate.stl").string(), plate);
    std::string nc = "%\nO1\nG21 G90 G94 G17 G54\nT1 M6\nS8000 M3\nG0 X-70. Y-40.\nG43 H1 Z0\n";
    for (double y = -32.0, from = -70.0; y < 45.0; y += 14.0, from = -from)
      nc += g1({from, y}) + g1({-from, y});
    nc += "G0 Z20.\nT2 M6\nS8000 M3\n";
    nc += fmt::format("G0 X{:.4f} Y{:.4f}\nG43 H2 Z5.\nG1 Z{:.4f} F100\nG0 Z20.\nM5\nM30\n%\n", kDent.x(),
                      kDent.y(), z);
    swarf::test::write_text(folder_ / "plate.nc", nc);
    swarf::test::write_text(
        folder_ / "scene.toml",
        "nc = \"plate.nc\"\ntools = \"T1=16,T2=ball12.5\"\n[setup]\n"
        "work_origin_mm = \"on_table\"\n[stock]\nbox_mm = [[-50, -35, -12], [50, 35, 1]]\n"
        "voxel_mm = 0.8\n[accept]\ngouge_max_um = 20\nexcess_max_um = 20\n"
        "[design]\npitch_mm = 0.4\nmesh = \"plate.stl\"\n");
    const auto run = swarf::test::run_swarf("run " + (folder_ / "scene.toml").string() + " -o " +
                                            (folder_ / "run").string() +
                                            " --set movie.seconds=0 --set \"stills.kinds=[]\"");
    EXPECT_LE(run.exit_code, 1) << run.output;
    const Glb glb = swarf::test::read_glb(folder_ / "run/part.glb");
    EXPECT_EQ(glb.model.at("asset").at("extras").at("colours_off_share"), 0.0);
    return GlbMesh(glb, "machined surface").triangles();
  }
  /// What the colour at a place of the top says, um.
  static double shown_at(const std::vector<Coloured>& triangles, const Vec2& p) {
    const Decoder decoded(20.0);
    for (const Coloured& t : triangles) {
      const Vec3 cross = cross_of(t);
      if (cross.z() < 0.9 * cross.norm() || cross.z() <= 0.0) continue;
      const Vec3 at(p.x(), p.y(), 0.0);
      Vec3 shares;
      for (size_t k = 0; k < 3; ++k)
        shares[static_cast<int>(k)] =
            (t[(k + 1) % 3].place - at).cross(t[(k + 2) % 3].place - at).z() / cross.z();
      if (shares.minCoeff() < 0.0) continue;
      return decoded(shares[0] * t[0].colour + shares[1] * t[1].colour + shares[2] * t[2].colour);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Vec2 kDent{13.3, 7.7};
  fs::path folder_;
};

TEST_F(ColoursOfAFacet, ShowADentOfAMillimetreWhereItIs) {
  const double radius = 6.25, depth = 0.02;
  const std::vector<Coloured> dented = with_ball_at(-depth);
  for (const double away : {0.0, 0.1, 0.2, 0.3, 0.4, 0.6, 1.0, 3.0}) {
    const double truth = std::min(0.0, radius - depth - std::sqrt(radius * radius - away * away));
    EXPECT_NEAR(shown_at(dented, kDent + Vec2(away, 0.0)), 1e3 * truth, 1.5) << away << " mm away";
  }
}

TEST_F(ColoursOfAFacet, WithoutADentAreOne) {
  for (const Coloured& t : with_ball_at(0.5))
    for (const Corner& corner : t)
      EXPECT_NEAR(Decoder(20.0)(corner.colour), 0.0, 0.1) << corner.place.transpose();
}

}  // namespace
}  // namespace colours_test

// The drop cutter table: every form of cutter on every feature of a part, upright and tilted,
// against closed forms or a brute force search that brackets the truth. The worst of each pair is printed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <set>

#include "brute_force.h"
#include "nurbs_edge_part.h"
#include "patch_scene.h"
#include "position/face_target.h"
#include "position/mesh_target.h"

namespace swarf::position {
namespace {

/// .05 um.
constexpr double kAsked_mm = 5e-5;

/// Columns of the table, in its order.
const std::vector<std::string> kFeatures{"plane", "edge",   "vertex",    "sphere",
                                         "torus", "saddle", "triangles", "NURBS edge"};

/// What the calculator is asked on one feature, and the truth between two bounds.
struct Feature {
  std::string name;
  /// Places of the tip's line, for the i-th try.
  std::function<GuideLine(Rng&, bool tilted)> line;
  std::function<Rest(const ToolProfile&, const GuideLine&)> rest;
  std::function<HeightBracket(const ClosedForm&, const GuideLine&)> truth;
  int tries = 10;
};

/// Upright, or leaned by 5 to 25 degrees in any direction: lead and tilt of five axes.
GuideLine line_at(Rng& rng, const Vec3& at, bool tilted) {
  if (!tilted) return upright(at.x(), at.y());
  const double lean = rad_from_deg(rng.uniform(5.0, 25.0)), turn = rng.uniform(0.0, 2.0 * kPi);
  return guide_line(at, {std::sin(lean) * std::cos(turn), std::sin(lean) * std::sin(turn), std::cos(lean)});
}
GuideLine line_within(Rng& rng, const Vec3& centre, double half, bool tilted) {
  const double x = rng.uniform(-half, half), y = rng.uniform(-half, half);
  return line_at(rng, centre + Vec3(x, y, 0.0), tilted);
}

template <typename TargetOf>
auto rest_of(std::shared_ptr<TargetOf> target) {
  return [target](const ToolProfile& profile, const GuideLine& line) {
    Rest rest;
    if constexpr (std::is_same_v<TargetOf, MeshTarget>) {
      int near = -1;
      target->raise(profile, line, rest, near);
    } else if constexpr (std::is_same_v<TargetOf, FaceTarget>) {
      Near near;
      PatchWork work;
      target->raise(profile, line, rest, near, work);
      EXPECT_EQ(work.gap, kPatchProof_mm);
    } else {
      PatchWork work;
      rest = rest_on(*target, profile, line, &work);
      EXPECT_EQ(work.gap, kPatchProof_mm);
    }
    return rest;
  };
}

HeightBracket exactly(double height) {
  return {height, height, 0};
}

/// z = point + lift of the plane's slope: theory 3, by the greatest of slope rho - w(rho).
Feature plane() {
  const Vec3 normal = Vec3(-0.35, 0.2, 1.0).normalized(), origin(0.5, -1.0, 2.0);
  const Vec3 u = 60.0 * Vec3(1.0, 0.0, 0.35), v = 60.0 * Vec3(0.0, 1.0, -0.2);
  const auto target =
      std::make_shared<PatchTarget>(std::vector<Patch>{plane_patch(origin - 0.5 * (u + v), u, v)});
  return {"plane", [](Rng& rng, bool tilted) { return line_within(rng, Vec3::Zero(), 10.0, tilted); },
          rest_of(target),
          [normal, origin](const ClosedForm& tool, const GuideLine& line) {
            const double along = normal.dot(line.axis_W);
            const double slope = normal.cross(line.axis_W).norm() / along;
            const double over_axis = normal.dot(origin - line.point_W) / along;
            return exactly(over_axis + greatest([&](double share) {
                             const double rho = share * tool.radius;
                             return slope * rho - tool.height(rho);
                           }));
          }};
}

/// A pyramid of four facets whose corners are floats, as faces trimmed to triangles; its apex is off centre.
struct Pyramid {
  Vec3 apex{0.5, -0.25, 6.0};
  std::array<Vec3, 4> foot{Vec3(-16, -14, -2), Vec3(15, -16, -1.5), Vec3(14, 15, -3), Vec3(-15, 16, -1)};

  TriMesh mesh() const {
    TriMesh mesh;
    for (size_t k = 0; k < 4; ++k) add_triangle(mesh, foot[k], foot[(k + 1) % 4], apex);
    return mesh;
  }
  std::vector<surface::Face> faces() const {
    std::vector<surface::Face> faces;
    for (size_t k = 0; k < 4; ++k) {
      surface::Face& face = faces.emplace_back();
      const Vec3 &a = foot[k], &b = foot[(k + 1) % 4];
      // Twice as far as the triangle: its three sides are loops within the square.
      face.surface = std::make_shared<surface::PlaneSurface>(apex, 2.0 * (a - apex), 2.0 * (b - apex));
      face.loops = {{{0.0, 0.0}, {0.5, 0.0}, {0.0, 0.5}}};
    }
    return faces;
  }
};

/// Along the ridges, with the ridge or a side under the tool, or about the apex.
Feature pyramid(const char* name, bool vertex, bool as_mesh) {
  const Pyramid part;
  const auto place = [part, vertex](Rng& rng, bool tilted) {
    if (vertex) return line_within(rng, part.apex, 0.4, tilted);
    const Vec3& foot = part.foot[rng.next() % 4];
    return line_within(rng, part.apex + rng.uniform(0.3, 0.8) * (foot - part.apex), 0.3, tilted);
  };
  const auto truth = [mesh = part.mesh()](const ClosedForm& tool, const GuideLine& line) {
    return exactly(brute_mesh(tool, line, mesh));
  };
  if (as_mesh) return {name, place, rest_of(std::make_shared<MeshTarget>(part.mesh())), truth};
  return {name, place, rest_of(std::make_shared<FaceTarget>(part.faces())), truth};
}

/// The sphere about the origin: its places in the plane of the two axes ask for the most, and F is concave
/// there.
Feature sphere() {
  constexpr double kRadius = 20.0;
  surface::Turn turn;
  turn.axis_W = Vec3::UnitX();
  const auto target = std::make_shared<PatchTarget>(std::vector<Patch>{
      {surface::sphere_surface(turn, kRadius, 0.05, kPi - 0.05, surface::MaterialSide::kConvex)}});
  return {"sphere",
          [](Rng& rng, bool tilted) {
            return line_within(rng, {0, 0, 20}, 11.0, tilted);
          },
          rest_of(target),
          [](const ClosedForm& tool, const GuideLine& line) {
            const Vec3 centre = line.local(Vec3::Zero());
            const double d = centre.head<2>().norm();
            return exactly(centre.z() + greatest([&](double share) {
                             const double rho = share * tool.radius, out = d - rho;
                             if (std::abs(out) >= kRadius) return -1e3 - std::abs(out);
                             return std::sqrt(kRadius * kRadius - out * out) - tool.height(rho);
                           }));
          }};
}

/// Tube radius 5 about radius 14, as two surfaces of revolution: the outer and the inner half of the tube.
Feature torus() {
  constexpr double kRing = 14.0, kTube = 5.0;
  std::vector<Patch> patches;
  for (const double side : {1.0, -1.0}) {
    const auto meridian = [side](double v) {
      const double a = kPi * (v - 0.5);
      surface::Meridian m;
      m.r = kRing + side * kTube * std::cos(a);
      m.dr = -side * kTube * kPi * std::sin(a);
      m.ddr = -side * kTube * kPi * kPi * std::cos(a);
      m.z = kTube * std::sin(a);
      m.dz = kTube * kPi * std::cos(a);
      m.ddz = -kTube * kPi * kPi * std::sin(a);
      return m;
    };
    patches.push_back({std::make_shared<surface::RevolvedSurface>(
        surface::Turn{}, meridian, surface::MeridianBounds{kRing + kTube, kTube * kPi, kTube * kPi * kPi},
        surface::MaterialSide::kConvex)});
  }
  const Sheet ring{[](double u, double v) {
                     const double turn = 2.0 * kPi * u, a = 2.0 * kPi * v, r = kRing + kTube * std::cos(a);
                     return Vec3(r * std::cos(turn), r * std::sin(turn), kTube * std::sin(a));
                   },
                   4.0 * kPi * kPi * (kRing + kTube), 4.0 * kPi * kPi * kTube};
  return {"torus",
          [](Rng& rng, bool tilted) {
            return line_within(rng, {0, 0, 5}, 14.0, tilted);
          },
          rest_of(std::make_shared<PatchTarget>(patches)),
          [ring](const ClosedForm& tool, const GuideLine& line) {
            return BracketedHeight(tool, line).over({ring});
          }};
}

/// z = (a x^2 + c y^2) / 2 + b x y.
Feature saddle() {
  constexpr double kA = 0.06, kB = 0.015, kC = -0.08, kSize = 25.0;
  const Sheet sheet{[](double u, double v) {
                      const double x = kSize * (2.0 * u - 1.0), y = kSize * (2.0 * v - 1.0);
                      return Vec3(x, y, 0.5 * (kA * x * x + kC * y * y) + kB * x * y);
                    },
                    4.0 * kSize * kSize * kA, -4.0 * kSize * kSize * kC};
  const auto target = std::make_shared<PatchTarget>(std::vector<Patch>{quadric_patch(kA, kB, kC, kSize)});
  return {"saddle", [](Rng& rng, bool tilted) { return line_within(rng, Vec3::Zero(), 9.0, tilted); },
          rest_of(target),
          [sheet](const ClosedForm& tool, const GuideLine& line) {
            return BracketedHeight(tool, line).over({sheet});
          }};
}

/// Of every size and attitude; a mesh of 40 under the tool.
Feature triangles() {
  Rng rng(404);
  TriMesh mesh;
  const auto any = [&](double half) {
    return Vec3(rng.uniform(-half, half), rng.uniform(-half, half), rng.uniform(-half, half));
  };
  for (int i = 0; i < 40; ++i) {
    const Vec3 at = any(6.0);
    const double size = i % 4 == 0 ? 8.0 : 2.0;
    add_triangle(mesh, at + any(size), at + any(size), at + any(size));
  }
  return {"triangles", [](Rng& r, bool tilted) { return line_within(r, Vec3::Zero(), 6.0, tilted); },
          rest_of(std::make_shared<MeshTarget>(mesh)),
          [mesh](const ClosedForm& tool, const GuideLine& line) {
            return exactly(brute_mesh(tool, line, mesh));
          }};
}

/// About the curved edges of the part: along the side and round the hole.
Feature nurbs_edge() {
  const NurbsEdgePart part;
  const std::vector<surface::Face> faces = part.faces_from_step();
  EXPECT_GE(faces.size(), 7U) << "top, floor, five walls";
  // The sheets ask the part, which the function keeps.
  const auto kept = std::make_shared<NurbsEdgePart>(part);
  return {"NURBS edge",
          [kept](Rng& rng, bool tilted) {
            if (rng.next() % 2 == 0) {
              const double x = rng.uniform(-7.0, 7.0), y = kept->side(x) + rng.uniform(-1.0, 3.5);
              return line_at(rng, {x, y, kept->top(x, y)}, tilted);
            }
            return line_within(rng, {NurbsEdgePart::kHoleX, NurbsEdgePart::kHoleY, 1.0}, 3.0, tilted);
          },
          rest_of(std::make_shared<FaceTarget>(faces)),
          [kept](const ClosedForm& tool, const GuideLine& line) {
            return BracketedHeight(tool, line).over(kept->sheets());
          }};
}

struct Worst {
  double off_mm = 0.0;  ///< from the far end of the bracket
  int compared = 0;
  std::set<Touched> touched;
};

/// How far the height may lie from the truth: to the far end of the bracket.
double off_truth(const Feature& feature, const cutter::Cutter& cutter, const GuideLine& line, Worst& worst) {
  const Rest rest = feature.rest(ToolProfile(cutter), line);
  const HeightBracket truth = feature.truth(ClosedForm(cutter), line);
  EXPECT_EQ(rest.touches(), !std::isinf(truth.high)) << paste(line);
  if (!rest.touches() || std::isinf(truth.high)) return 0.0;
  ++worst.compared;
  worst.touched.insert(rest.what);
  return std::max(truth.high - rest.height, rest.height - truth.low);
}

void compare_places(const Feature& feature, const cutter::Cutter& cutter, bool tilted, Worst& worst) {
  Rng rng(tilted ? 77 : 7);
  for (int i = 0; i < feature.tries; ++i) {
    const GuideLine line = feature.line(rng, tilted);
    const double off = off_truth(feature, cutter, line, worst);
    EXPECT_LE(off, kAsked_mm) << paste(line);
    worst.off_mm = std::max(worst.off_mm, off);
  }
}

using Table = std::map<std::string, std::map<std::string, Worst>>;

void print(const char* title, const Table& table) {
  std::string text = fmt::format("{}, um:\n{:12}", title, "");
  for (const std::string& name : kFeatures) text += fmt::format("{:>12}", name);
  for (const auto& [cutter, row] : table) {
    text += fmt::format("\n{:12}", cutter);
    for (const std::string& name : kFeatures) text += fmt::format("{:12.5f}", 1e3 * row.at(name).off_mm);
  }
  std::printf("%s\n", text.c_str());
}

// Within .05 um.
TEST(DropCutterTable, EveryCutterOnEveryFeature) {
  std::vector<Feature> features{plane(),
                                pyramid("edge", false, true),
                                pyramid("edge", false, false),
                                pyramid("vertex", true, true),
                                pyramid("vertex", true, false),
                                sphere(),
                                torus(),
                                saddle(),
                                triangles(),
                                nurbs_edge()};
  for (const bool tilted : {false, true}) {
    Table table;
    std::map<std::string, std::set<Touched>> touched;
    for (const Feature& feature : features) {
      for (const NamedCutter& named : cutters_under_test()) {
        SCOPED_TRACE(feature.name + " " + named.name);
        Worst& worst = table[named.name][feature.name];
        compare_places(feature, named.cutter, tilted, worst);
        EXPECT_GE(worst.compared, feature.tries / 2);
        touched[feature.name].insert(worst.touched.begin(), worst.touched.end());
      }
    }
    print(tilted ? "worst deviation, leaned by 5 to 25 degrees" : "worst deviation, upright", table);
    EXPECT_TRUE(touched["edge"].count(Touched::kEdge) && touched["vertex"].count(Touched::kVertex));
    EXPECT_TRUE(touched["NURBS edge"].count(Touched::kEdge) && touched["NURBS edge"].count(Touched::kFace));
  }
}

// A slender taper turns what the edge is moved by into eight times as much height: loops that followed their
// edges within 1e-5 mm left .064 um here.
TEST(DropCutterTable, SteepFlanksOnNurbsEdges) {
  const Feature feature = nurbs_edge();
  const cutter::Cutter taper = cutters_under_test()[4].cutter;
  for (const GuideLine& line : {guide_line({-2.1457006211642655, -2.5688494737085947, 1},
                                           {-0.14965435150041978, 0.040624106509092796, 0.98790346544959884}),
                                guide_line({-2.705893528531444, 8.3503384646325038, 0.23823585031360558},
                                           {0.13852536350486444, -0.31948738894633694, 0.93741054611632002}),
                                upright(-1.8117777820587957, 8.1894301450743097)}) {
    Worst worst;
    EXPECT_LE(off_truth(feature, taper, line, worst), kAsked_mm) << paste(line);
    EXPECT_EQ(worst.touched, std::set<Touched>{Touched::kEdge});
  }
}

}  // namespace
}  // namespace swarf::position

// CAD files of several forms, written here, against volumes and areas in closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <Geom_BSplineSurface.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Compound.hxx>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "base/angles.h"
#include "base/units.h"
#include "brep/facet_estimate.h"
#include "brep/model.h"
#include "brep/refine_facets.h"
#include "mesh/mesh_check.h"
#include "surface/face.h"
#include "surface/nurbs.h"

namespace swarf::brep {
namespace {

class Cad : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              fmt::format("swarf_brep_{}_{}", ::getpid(),
                          testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    Message::DefaultMessenger()->ChangePrinters().Clear();
    STEPControl_Writer();  // the names of its settings exist from here on
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string step(const TopoDS_Shape& shape, const char* schema = "AP214IS", const char* unit = "MM") {
    Interface_Static::SetCVal("write.step.schema", schema);
    Interface_Static::SetCVal("write.step.unit", unit);
    STEPControl_Writer writer;
    EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
    const std::string path = (folder_ / fmt::format("part{}.stp", ++count_)).string();
    EXPECT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
    Interface_Static::SetCVal("write.step.unit", "MM");
    return path;
  }
  std::string iges(const TopoDS_Shape& shape, const char* unit, int form) {
    IGESControl_Controller::Init();
    IGESControl_Writer writer(unit, form);
    EXPECT_TRUE(writer.AddShape(shape));
    writer.ComputeModel();
    const std::string path = (folder_ / fmt::format("part{}.igs", ++count_)).string();
    EXPECT_TRUE(writer.Write(path.c_str()));
    return path;
  }
  std::string text_file(const std::string& name, const std::string& text) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path) << text;
    return path;
  }
  static std::string text_of(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  static std::string code_of(const std::function<void()>& read) {
    try {
      read();
    } catch (const InputError& error) {
      EXPECT_FALSE(error.diagnostics.list().front().fix.empty());
      return error.diagnostics.list().front().code;
    }
    return "none";
  }

  std::filesystem::path folder_;
  int count_ = 0;
};

TopoDS_Shape block() {
  return BRepPrimAPI_MakeBox(gp_Pnt(10, 20, 30), gp_Pnt(110, 80, 70)).Shape();
}

TopoDS_Shape holed() {
  const gp_Ax2 axis(gp_Pnt(60, 50, 0), gp::DZ());
  return BRepAlgoAPI_Cut(block(), BRepPrimAPI_MakeCylinder(axis, 12, 200).Shape()).Shape();
}

/// A B-spline dome over a square, trimmed by a cylinder that stands through it.
TopoDS_Shape trimmed_spline() {
  TColgp_Array2OfPnt poles(1, 5, 1, 5);
  for (int i = 1; i <= 5; ++i) {
    for (int j = 1; j <= 5; ++j) poles(i, j) = gp_Pnt(10 * i, 10 * j, (i - 3) * (j - 3));
  }
  TColStd_Array1OfReal knots(1, 3);
  TColStd_Array1OfInteger times(1, 3);
  for (int k = 1; k <= 3; ++k) {
    knots(k) = k - 1;
    times(k) = k == 2 ? 1 : 4;
  }
  const Handle(Geom_BSplineSurface) S = new Geom_BSplineSurface(poles, knots, knots, times, times, 3, 3);
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(S, 1e-7).Shape();
  return BRepAlgoAPI_Cut(face,
                         BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(30, 30, -50), gp::DZ()), 8, 100).Shape())
      .Shape();
}

void expect_body(const Model& model, size_t faces, double area, double volume) {
  ASSERT_EQ(model.solids.size(), 1U);
  EXPECT_TRUE(model.solids[0].closed);
  EXPECT_EQ(model.face_count, static_cast<int>(faces));
  // Loops follow circles to kLoopChord.
  EXPECT_NEAR(model.solids[0].area_mm2, area, 1e-6 * area);
  EXPECT_NEAR(model.solids[0].volume_mm3, volume, 1e-6 * volume);
  for (const Diagnostic& d : model.warnings) ADD_FAILURE() << format(d);
}

TEST_F(Cad, ABlockIsTheSameInEverySchemaAndUnit) {
  for (const char* schema : {"AP203", "AP214IS", "AP242DIS"}) {
    for (const char* unit : {"MM", "INCH", "M", "CM"}) {
      const Model model = read_step(step(block(), schema, unit));
      SCOPED_TRACE(fmt::format("{} in {}", schema, unit));
      expect_body(model, 6, 2 * (100 * 60 + 60 * 40 + 100 * 40), 100 * 60 * 40);
      EXPECT_EQ(model.edges.size(), 12U);
      EXPECT_EQ(model.vertices.size(), 8U);
      const double expected = std::string(unit) == "INCH" ? 25.4
                              : unit[0] == 'C'            ? 10
                              : unit[1] == 'M'            ? 1
                                                          : 1000;
      EXPECT_NEAR(model.mm_per_unit, expected, 1e-12) << model.unit;
      for (const surface::Face& face : model.faces) {
        const surface::Derivatives d = face.surface->derivatives(0.5, 0.5);
        const Vec3 from_middle = d.S - Vec3(60, 50, 50);
        EXPECT_GT(outward_normal(*face.surface, d).dot(from_middle), 0.0) << "outward";
        EXPECT_TRUE(face.loops.empty()) << "the whole of its patch";
      }
    }
  }
}

TEST_F(Cad, OneInchIs25Point4Millimetres) {
  const std::string path = step(BRepPrimAPI_MakeBox(25.4, 25.4, 25.4).Shape(), "AP214IS", "INCH");
  EXPECT_NE(text_of(path).find("CARTESIAN_POINT('',(1.,"), std::string::npos) << "inches in the file";
  expect_body(read_step(path), 6, 6 * 25.4 * 25.4, 25.4 * 25.4 * 25.4);
}

TEST_F(Cad, RoundBodiesAreExact) {
  const double R = 30, r = 8, h = 40;
  expect_body(read_step(step(BRepPrimAPI_MakeSphere(R).Shape())), 1, 4 * kPi * R * R,
              4.0 / 3 * kPi * R * R * R);
  expect_body(read_step(step(BRepPrimAPI_MakeTorus(R, r).Shape(), "AP203", "INCH")), 1, 4 * kPi * kPi * R * r,
              2 * kPi * kPi * R * r * r);
  expect_body(read_step(step(BRepPrimAPI_MakeCylinder(R, h).Shape())), 3, 2 * kPi * R * (R + h),
              kPi * R * R * h);
  const double slant = std::hypot(R, h);
  expect_body(read_step(step(BRepPrimAPI_MakeCone(R, 0, h).Shape())), 2, kPi * R * (R + slant),
              kPi * R * R * h / 3);
}

TEST_F(Cad, PlacesOfASphereLieOnIt) {
  const Model model = read_step(step(BRepPrimAPI_MakeSphere(gp_Pnt(5, 6, 7), 30).Shape()));
  ASSERT_EQ(model.faces.size(), 1U) << "arcs without creases";
  for (const double u : {0.0, 0.21, 0.5, 0.83, 1.0}) {
    for (const double v : {0.0, 0.3, 0.9, 1.0}) {
      const auto d = model.faces[0].surface->derivatives(u, v);
      EXPECT_NEAR((d.S - Vec3(5, 6, 7)).norm(), 30, 1e-12);
      EXPECT_LT((outward_normal(*model.faces[0].surface, d, {u, v}) - (d.S - Vec3(5, 6, 7)) / 30).norm(),
                1e-7);
    }
  }
}

TEST_F(Cad, AHoleIsNotPartOfItsFace) {
  const double area = 2 * (100 * 60 + 60 * 40 + 100 * 40) - 2 * kPi * 144 + 2 * kPi * 12 * 40;
  const Model model = read_step(step(holed()));
  expect_body(model, 7, area, 40 * (6000 - kPi * 144));
  int holes = 0;
  for (const surface::Face& face : model.faces) {
    if (face.loops.size() != 2) continue;
    ++holes;
    const surface::FaceDomain domain(face);
    EXPECT_FALSE(domain.inside({0.5, 0.5}));
    EXPECT_TRUE(domain.inside({0.1, 0.1}));
  }
  EXPECT_EQ(holes, 2);
}

TEST_F(Cad, InstancesOfAnAssemblyStandWhereTheyArePlaced) {
  BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  const TopoDS_Shape one = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  gp_Trsf turn, shift;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp::DX()), kPi / 2);
  shift.SetTranslation(gp_Vec(100, 0, 0));
  builder.Add(all, one);
  builder.Add(all, one.Moved(TopLoc_Location(turn)));
  builder.Add(all, one.Moved(TopLoc_Location(shift * turn)));
  Interface_Static::SetIVal("write.step.assembly", 1);
  const Model model = read_step(step(all, "AP242DIS", "INCH"));
  Interface_Static::SetIVal("write.step.assembly", 0);
  ASSERT_EQ(model.solids.size(), 3U);
  EXPECT_EQ(model.face_count, 18);
  std::vector<Vec3> lowest;
  for (const Solid& solid : model.solids) {
    EXPECT_NEAR(solid.volume_mm3, 6000, 1e-6);
    Vec3 low(1e9, 1e9, 1e9);
    for (const size_t n : solid.faces) {
      for (const double u : {0.0, 1.0}) {
        for (const double v : {0.0, 1.0}) low = low.cwiseMin(model.faces[n].surface->point(u, v));
      }
    }
    lowest.push_back(low);
  }
  EXPECT_LT((lowest[0] - Vec3(0, 0, 0)).norm(), 1e-9);
  EXPECT_LT((lowest[1] - Vec3(0, -30, 0)).norm(), 1e-9);
  EXPECT_LT((lowest[2] - Vec3(100, -30, 0)).norm(), 1e-9);
}

TEST_F(Cad, ATrimmedSplineFaceKeepsItsHole) {
  const Model model = read_step(step(trimmed_spline()));
  ASSERT_EQ(model.faces.size(), 1U);
  EXPECT_FALSE(model.solids[0].closed);
  EXPECT_EQ(model.faces[0].loops.size(), 2U);
  const surface::FaceDomain domain(model.faces[0]);
  int in = 0;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 60; ++j) {
      const Vec2 uv(i / 60.0, j / 60.0);
      const Vec3 P = model.faces[0].surface->point(uv.x(), uv.y());
      const double distance = std::hypot(P.x() - 30, P.y() - 30);
      if (std::abs(distance - 8) < 1e-3 || uv.minCoeff() == 0.0 || uv.maxCoeff() == 1.0) continue;
      EXPECT_EQ(domain.inside(uv), distance > 8) << uv.transpose();
      in += domain.inside(uv);
    }
  }
  EXPECT_GT(in, 1000);
}

TEST_F(Cad, IgesOfBothFormsIsTheSame) {
  for (const char* unit : {"MM", "IN"}) {
    for (const int form : {0, 1}) {  // loose faces; solids
      SCOPED_TRACE(fmt::format("{} form {}", unit, form));
      const Model model = read_iges(iges(holed(), unit, form));
      const double area = 2 * (100 * 60 + 60 * 40 + 100 * 40) - 2 * kPi * 144 + 2 * kPi * 12 * 40;
      expect_body(model, 7, area, 40 * (6000 - kPi * 144));
      EXPECT_NEAR(model.mm_per_unit, unit[0] == 'I' ? 25.4 : 1.0, 1e-12);
    }
  }
}

TEST_F(Cad, AFileOfNxIsRead) {
  const std::string folder = std::string(SWARF_SOURCE_DIR) + "/assets/programs/stepnode/";
  const Model part = read_cad(folder + "simple_block_workpiece.stp"),
              raw = read_cad(folder + "simple_block_rawpiece.stp");
  ASSERT_EQ(part.solids.size(), 1U);
  EXPECT_EQ(part.solids[0].name, "WORKPIECE");
  EXPECT_EQ(part.face_count, 9);
  EXPECT_NEAR(raw.solids[0].volume_mm3, 100 * 100 * 25, 1e-6);
  EXPECT_LT(part.solids[0].volume_mm3, raw.solids[0].volume_mm3);
  EXPECT_EQ(part.mm_per_unit, 1.0);
}

TEST_F(Cad, FacetsAreWatertightAndTheirChordIsProven) {
  for (const double chord : {0.1, 0.02}) {
    const Model ball = read_step(step(BRepPrimAPI_MakeSphere(20).Shape()));
    const Facets facets = tessellate(ball, chord);
    EXPECT_EQ(mesh::check_closed(facets.mesh), "");
    EXPECT_TRUE(facets.proven);
    EXPECT_LE(facets.chord_mm, chord + 1e-5);
    const double volume = 4.0 / 3 * kPi * 8000;
    EXPECT_NEAR(mesh::enclosed_volume(facets.mesh), volume, 4 * kPi * 400 * chord);
    for (const auto& t : facets.mesh.triangles) {
      Vec3 middle = Vec3::Zero();
      for (const uint32_t n : t) {
        const auto& p = facets.mesh.positions[n];
        middle += Vec3(p[0], p[1], p[2]) / 3;
      }
      ASSERT_LE(20 - middle.norm(), facets.chord_mm);
    }
    EXPECT_EQ(mesh::check_closed(tessellate(read_step(step(holed())), chord).mesh), "");
    EXPECT_EQ(
        mesh::check_closed(tessellate(read_step(step(BRepPrimAPI_MakeTorus(20, 5).Shape())), chord).mesh),
        "");
  }
}

/// How far a point lies from the side of a cone from (radius, z = 0) to (top, height); a cylinder is one.
double off_cone(const Vec3& p, double radius, double top, double height) {
  const double tilt = std::atan2(radius - top, height);
  return std::abs((std::hypot(p.x(), p.y()) - radius) * std::cos(tilt) + p.z() * std::sin(tilt));
}

TEST_F(Cad, FineFacetsOfRoundBodiesLieAsNearAsTold) {
  constexpr double kChord = 4e-4, kRadius = 5.0, kHeight = 20.0;
  const auto radial = [](double top) {
    return [top](const Vec3& p) {
      return std::min({off_cone(p, kRadius, top, kHeight), std::abs(p.z()), std::abs(p.z() - kHeight)});
    };
  };
  struct Case {
    TopoDS_Shape shape;
    std::function<double(const Vec3&)> off;
    size_t most;  ///< facets
  };
  // From rim to rim there are no rows; pi / acos(1 - chord / radius) = 249 sides suffice.
  const std::vector<Case> cases{{BRepPrimAPI_MakeCylinder(kRadius, kHeight).Shape(), radial(kRadius), 2600},
                                {BRepPrimAPI_MakeCone(kRadius, 2, kHeight).Shape(), radial(2.0), 2600},
                                {BRepPrimAPI_MakeCone(kRadius, 0, kHeight).Shape(), radial(0.0), 2600},
                                {BRepPrimAPI_MakeSphere(kRadius).Shape(),
                                 [](const Vec3& p) { return std::abs(p.norm() - kRadius); }, 200000}};
  for (const Case& one : cases) {
    const FineFacets fine =
        refine_facets(tessellate(read_step(step(one.shape)), 0.05, true, 0.02), kChord, 200000);
    ASSERT_FALSE(fine.mesh.triangles.empty());
    EXPECT_EQ(mesh::check_closed(fine.mesh), "");
    EXPECT_LE(fine.mesh.triangles.size(), one.most);
    EXPECT_LE(fine.chord_mm, 3.0 * kChord);  // radii differ by 2.5
    for (const auto& t : fine.mesh.triangles) {
      for (const auto& share : {Vec3(1, 1, 1), Vec3(0, 1, 1), Vec3(1, 0, 1), Vec3(1, 1, 0), Vec3(4, 1, 1)}) {
        Vec3 p = Vec3::Zero();
        for (size_t k = 0; k < 3; ++k) {
          const auto& at = fine.mesh.positions[t[k]];
          p += share[static_cast<Eigen::Index>(k)] / share.sum() * Vec3(at[0], at[1], at[2]);
        }
        ASSERT_LE(one.off(p), fine.chord_mm) << p.transpose();
      }
    }
  }
}

// Never above what the library makes, within a factor of twelve, whatever the unit.
TEST_F(Cad, FacetsAreEstimatedBeforeTheyAreMade) {
  const TopoDS_Shape bodies[] = {BRepPrimAPI_MakeSphere(20).Shape(), holed()};
  for (const TopoDS_Shape& body : bodies) {
    const Model model = read_step(step(body));
    for (const double chord : {0.1, 0.02}) {
      const double expected = estimated_facets(model, chord, kEdgeChord);
      const auto made = static_cast<double>(tessellate(model, chord).mesh.triangles.size());
      EXPECT_LE(expected, 2.0 * made) << chord;
      EXPECT_GE(12.0 * expected, made) << chord;
    }
  }
  const Model ball = read_step(step(BRepPrimAPI_MakeSphere(20).Shape()));
  EXPECT_THROW(tessellate(ball, 1e-6), InputError);
}

// Facets are the parameters of the faces: at their corners, and at places in between, the faces are where the
// closed form has them, and their normals point out of the body; however coarse the facets are.
TEST_F(Cad, FacetsLieOnTheirFaces) {
  const Model ball = read_step(step(BRepPrimAPI_MakeSphere(20).Shape()));
  const Model bored = read_step(step(holed()));
  for (const bool in_hole : {false, true}) {
    const Facets facets = tessellate(in_hole ? bored : ball, 0.5, true);
    ASSERT_NE(facets.under, nullptr);
    ASSERT_EQ(facets.under->facets.size(), facets.mesh.triangles.size());
    EXPECT_EQ(facets.across_creases, 0U);
    size_t curved = 0;
    for (uint32_t f = 0; f < facets.mesh.triangles.size(); ++f) {
      if (!facets.under->is_curved(f)) continue;
      ++curved;
      const surface::FacetOnSurface& on = facets.under->facets[f];
      const surface::Surface& face = *facets.under->surfaces[static_cast<size_t>(on.surface)];
      for (size_t k = 0; k < 3; ++k) {
        const auto& p = facets.mesh.positions[facets.mesh.triangles[f][k]];
        EXPECT_LT((face.point(on.uv[k].x(), on.uv[k].y()) - Vec3(p[0], p[1], p[2])).norm(), 1e-4);
      }
      const Vec2 uv = 0.5 * on.uv[0] + 0.3 * on.uv[1] + 0.2 * on.uv[2];
      const surface::Derivatives d = face.derivatives(uv.x(), uv.y());
      const Vec3 from = in_hole ? Vec3(d.S.x() - 60, d.S.y() - 50, 0) : d.S;
      EXPECT_NEAR(from.norm(), in_hole ? 12.0 : 20.0, 1e-9);
      EXPECT_NEAR(surface::outward_normal(face, d, uv).dot(from.normalized()), in_hole ? -1.0 : 1.0, 1e-9);
    }
    EXPECT_GT(curved, 10U);
  }
}

// Edges say where faces end: they stay within two micrometres of the circle, however coarse the facets are.
TEST_F(Cad, EdgesAreFinerThanFacets) {
  const Facets facets = tessellate(read_step(step(holed())), 0.5, true);
  for (const auto& t : facets.mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const auto &a = facets.mesh.positions[t[k]], &b = facets.mesh.positions[t[(k + 1) % 3]];
      const auto radius = [](double x, double y) { return std::hypot(x - 60, y - 50); };
      const bool on_edge = a[2] == b[2] && std::abs(radius(a[0], a[1]) - 12) < 1e-3 &&
                           std::abs(radius(b[0], b[1]) - 12) < 1e-3;
      if (on_edge) {
        EXPECT_GT(radius(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])), 12 - 2.5e-3);
      }
    }
  }
}

// How far facets end before or beyond a curved edge is told: the chord of 96 mm / n on a circle of radius 12,
// and nothing where all edges are straight.
TEST_F(Cad, WhatFacetsLeaveBesideEdgesIsTold) {
  const Model round = read_step(step(holed()));
  double before = 1.0;
  for (const double asked : {2e-3, 5e-4}) {
    const double told = tessellate(round, 0.5, true, asked).under->edge_mm;
    EXPECT_LT(told, 1.1 * asked);
    EXPECT_GT(told, 0.05 * asked);
    EXPECT_LT(told, before);
    before = told;
  }
  EXPECT_LT(tessellate(read_step(step(block())), 0.5, true).under->edge_mm, 1e-12);
}

// Curved faces follow the places of their trimmed edges, whatever the facets' chord: the mould's rim and
// foot, in the wall, in the crown and in both patches of the ground. Between two places nothing is left.
TEST_F(Cad, CurvedFacesKnowThePlacesOfTheirEdges) {
  const Model mould = read_step(SWARF_SOURCE_DIR "/scenes/kato_mould/mould.stp");
  const Facets facets = tessellate(mould, 0.02, true);
  const surface::UnderFacets& under = *facets.under;
  EXPECT_LE(under.edge_mm, surface::kLoopChord);
  size_t sides = 0;
  double chord = 0.0;
  for (const surface::FacetOnSurface& on : under.facets) {
    for (size_t k = 0; k < 3; ++k) {
      chord = std::max(chord, on.chords_mm[k]);
      if (on.edges[k] == surface::FacetOnSurface::kNone) continue;
      ++sides;
      const surface::EdgePlaces& places = under.edges[static_cast<size_t>(on.edges[k])];
      EXPECT_EQ(places.front(), on.uv[k]);
      EXPECT_EQ(places.back(), on.uv[(k + 1) % 3]);
      // On the wall's cone, 30 deg about (2, 1): its places and the crown's or ground's are the same.
      const Vec2 uv = places[places.size() / 2];
      const Vec3 p = under.surfaces[static_cast<size_t>(on.surface)]->point(uv.x(), uv.y());
      const double radius = std::hypot(p.x() - 2.0, p.y() - 1.0);
      EXPECT_NEAR(radius, 11.0 - (p.z() + 4.0) * std::tan(rad_from_deg(30.0)), 2e-5);
    }
  }
  EXPECT_GT(sides, 200U);
  EXPECT_GT(chord, 2e-4);
  EXPECT_LT(chord, 1.1 * kEdgeChord);
}

// Faces that share an edge and do not meet there: how far apart, and where. Of a mould the one half of the
// ground is raised by .05 mm in the file's text.
TEST_F(Cad, FacesThatDoNotMeetAreMeasured) {
  const std::string text = text_of(SWARF_SOURCE_DIR "/scenes/kato_mould/mould.stp");
  const auto widest = [&](const Model& model) {
    return *std::max_element(model.edges.begin(), model.edges.end(),
                             [](const Edge& a, const Edge& b) { return a.gap_mm < b.gap_mm; });
  };
  EXPECT_LT(widest(read_step(SWARF_SOURCE_DIR "/scenes/kato_mould/mould.stp")).gap_mm, 1e-3);
  const std::string pole = "#206 = CARTESIAN_POINT('',(0.,-5.,1.));";
  ASSERT_NE(text.find(pole), std::string::npos);
  std::string raised = text;
  raised.replace(raised.find(pole), pole.size(), "#206 = CARTESIAN_POINT('',(0.,-5.,1.05));");
  const std::string path = (folder_ / "raised.stp").string();
  std::ofstream(path) << raised;
  const Edge edge = widest(read_step(path));
  // The patch rises by .05 mm times at most 4/9 (Bernstein's 3 t (1-t)^2), across a wall of 60 deg by more.
  EXPECT_LT(edge.gap_mm, 0.05);
  EXPECT_GT(edge.gap_mm, 0.015);
  EXPECT_GT(edge.gap_at.x(), -0.1);
}

TEST_F(Cad, WhatIsNoPartIsRefusedWithItsFix) {
  const std::string good = step(block());
  const std::string text = text_of(good);
  EXPECT_EQ(code_of([&] { read_step((folder_ / "missing.stp").string()); }), "cad-unreadable");
  EXPECT_EQ(code_of([&] { read_step(text_file("empty.stp", "")); }), "cad-unreadable");
  EXPECT_EQ(code_of([&] { read_step(text_file("prose.stp", "This is no part at all.")); }), "cad-unreadable");
  EXPECT_EQ(code_of([&] { read_step(text_file("iges.stp", text_of(iges(block(), "MM", 0)))); }),
            "cad-unreadable");
  EXPECT_EQ(code_of([&] { read_iges(good); }), "cad-unreadable");
  std::string unit = text;
  for (size_t at; (at = unit.find("LENGTH_UNIT()")) != std::string::npos;)
    unit.replace(at, 13, "PLANE_ANGLE_UNIT()");
  EXPECT_EQ(code_of([&] { read_step(text_file("unit.stp", unit)); }), "cad-no-unit");
  EXPECT_EQ(
      code_of([&] { read_step(step(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Shape())); }),
      "cad-empty");
}

// A loop that lacks one of its edges is refused with the place where it stays open.
TEST_F(Cad, ALoopThatDoesNotCloseIsRefusedWithItsPlace) {
  std::string text = text_of(SWARF_SOURCE_DIR "/scenes/kato_mould/mould.stp");
  const size_t loop = text.find("EDGE_LOOP('',("), end = text.find(')', loop + 14);
  const size_t last = text.rfind(',', end);
  text.erase(last, end - last);
  try {
    read_step(text_file("loop.stp", text));
    ADD_FAILURE() << "taken as it is";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a loop does not close: 10 mm are missing at (-21, 15, -10) mm"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(Cad, AFileThatIsCutOffNeverPassesAsWhole) {
  const std::string text = text_of(step(holed()));
  for (int k = 1; k < 40; ++k) {
    const std::string path = text_file("cut.stp", text.substr(0, text.size() * static_cast<size_t>(k) / 40));
    try {
      const Model model = read_step(path);
      EXPECT_FALSE(model.warnings.empty()) << "cut at " << k << "/40";
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace swarf::brep

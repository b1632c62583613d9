// Fine facets of CAD shapes against closed forms: each facet's own chord, and how fine they become.
#include <gtest/gtest.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>

#include "brep/model.h"
#include "brep/refine_facets.h"
#include "support/scratch.h"

namespace swarf::brep {
namespace {

/// The facets that the library keeps, as a CAD file of the shape gives them.
Facets facets_of(const TopoDS_Shape& shape) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const std::filesystem::path folder =
      test::scratch_folder() / testing::UnitTest::GetInstance()->current_test_info()->name();
  std::filesystem::create_directories(folder);
  STEPControl_Writer writer;
  EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
  const std::string path = (folder / "part.stp").string();
  EXPECT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
  const Facets facets = tessellate(read_step(path), 0.05, true, 0.02);
  std::filesystem::remove_all(folder);
  return facets;
}

constexpr double kHoleX = 60.0, kHoleY = 50.0, kHoleRadius = 12.0;

TopoDS_Shape plain_box() {
  return BRepPrimAPI_MakeBox(gp_Pnt(10, 20, 30), gp_Pnt(110, 80, 70)).Shape();
}
TopoDS_Shape bored_box() {
  const gp_Ax2 axis(gp_Pnt(kHoleX, kHoleY, 0), gp::DZ());
  return BRepAlgoAPI_Cut(plain_box(), BRepPrimAPI_MakeCylinder(axis, kHoleRadius, 200).Shape()).Shape();
}

double off_cylinder(const Vec3& p, double radius, double height) {
  const double side = std::abs(std::hypot(p.x(), p.y()) - radius);
  return std::min({side, std::abs(p.z()), std::abs(p.z() - height)});
}

/// Distance from the surface of a torus about z, mm.
double off_torus(const Vec3& p, double ring, double tube) {
  return std::abs(std::hypot(std::hypot(p.x(), p.y()) - ring, p.z()) - tube);
}

/// Places of a facet, in barycentric shares.
std::vector<Vec3> places_of(const TriMesh& mesh, const std::array<uint32_t, 3>& t) {
  constexpr int kSteps = 6;
  std::vector<Vec3> places;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      Vec3 p = Vec3::Zero();
      const std::array<int, 3> share{i, j, kSteps - i - j};
      for (size_t k = 0; k < 3; ++k) {
        const auto& at = mesh.positions[t[k]];
        p += static_cast<double>(share[k]) / kSteps * Vec3(at[0], at[1], at[2]);
      }
      places.push_back(p);
    }
  }
  return places;
}

// Each facet by its own chord, and no chord several times what its facet strays by.
TEST(FineFacets, TheChordOfEachFineFacetHolds) {
  constexpr double kRing = 20.0, kTube = 6.0, kRadius = 5.0, kHeight = 20.0, kChord = 1e-3;
  struct Case {
    TopoDS_Shape shape;
    std::function<double(const Vec3&)> off;
  };
  const std::vector<Case> cases{
      {BRepPrimAPI_MakeTorus(kRing, kTube).Shape(), [](const Vec3& p) { return off_torus(p, kRing, kTube); }},
      {BRepPrimAPI_MakeSphere(kRadius).Shape(), [](const Vec3& p) { return std::abs(p.norm() - kRadius); }},
      {BRepPrimAPI_MakeCylinder(kRadius, kHeight).Shape(),
       [](const Vec3& p) { return off_cylinder(p, kRadius, kHeight); }}};
  for (const Case& one : cases) {
    const FineFacets fine = refine_facets(facets_of(one.shape), kChord, 300000);
    ASSERT_EQ(fine.chords_mm.size(), fine.mesh.triangles.size());
    ASSERT_FALSE(fine.chords_mm.empty());
    EXPECT_EQ(fine.chord_mm, *std::max_element(fine.chords_mm.begin(), fine.chords_mm.end()));
    double worst = 0.0;
    for (size_t n = 0; n < fine.chords_mm.size(); ++n) {
      for (const Vec3& p : places_of(fine.mesh, fine.mesh.triangles[n])) {
        ASSERT_LE(one.off(p), fine.chords_mm[n]) << p.transpose();
        worst = std::max(worst, one.off(p));
      }
    }
    EXPECT_GT(worst, 0.25 * fine.chord_mm);
  }
}

// Of a plane only those facets stray whose sides lie along a curved edge: the others by the rounding of
// floats.
TEST(FineFacets, FineFacetsOfPlanesAreExactButBesideCurvedEdges) {
  constexpr double kFloats = 2e-5;
  const FineFacets solid = refine_facets(facets_of(plain_box()), 1e-3, 10000);
  ASSERT_FALSE(solid.chords_mm.empty());
  EXPECT_LE(solid.chord_mm, kFloats);
  const FineFacets bored = refine_facets(facets_of(bored_box()), 1e-3, 10000);
  ASSERT_FALSE(bored.chords_mm.empty());
  size_t exact = 0, beside = 0;
  for (size_t n = 0; n < bored.chords_mm.size(); ++n) {
    const auto at_hole = [&](uint32_t v) {
      const auto& p = bored.mesh.positions[v];
      return std::abs(std::hypot(p[0] - kHoleX, p[1] - kHoleY) - kHoleRadius) < 1e-3;
    };
    const auto& t = bored.mesh.triangles[n];
    const auto corners = std::count_if(t.begin(), t.end(), at_hole);
    if (corners <= 1) {
      ++exact;
      EXPECT_LE(bored.chords_mm[n], kFloats);
    } else if (bored.chords_mm[n] > kFloats) {
      ++beside;
    }
  }
  EXPECT_GT(exact, 8U);
  EXPECT_GT(beside, 100U);
}

TEST(FineFacets, TheFinestFacetsAreThoseWhoseNumberIsAllowed) {
  constexpr std::array kChords{1e-3, 4e-3, 1.6e-2};
  const Facets facets = facets_of(BRepPrimAPI_MakeTorus(20.0, 6.0).Shape());
  std::array<size_t, 3> counts{};
  for (size_t i = 0; i < 3; ++i) counts[i] = refine_facets(facets, kChords[i], 1000000).mesh.triangles.size();
  ASSERT_LT(counts[2], counts[1]);
  ASSERT_LT(counts[1], counts[0]);
  for (size_t i = 0; i < 3; ++i) {
    // More than one over the chord makes of the coarsest, and no more than the next finer one has.
    const auto growth = static_cast<size_t>(static_cast<double>(counts[2]) * kChords[2] / kChords[i]);
    const FineFacets fine = finest_facets(facets, kChords, std::max(counts[i], growth) + 1);
    EXPECT_EQ(fine.mesh.triangles.size(), counts[i]) << i;
    EXPECT_LE(fine.chord_mm, 3.0 * kChords[i]) << i;
  }
  EXPECT_TRUE(finest_facets(facets, kChords, counts[2] - 1).mesh.triangles.empty());
}

}  // namespace
}  // namespace swarf::brep

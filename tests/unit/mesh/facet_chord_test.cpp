// How far facets lie off the curved faces that they stand for: prisms in closed form, parts without any.
#include "mesh/facet_chord.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/solids.h"

namespace swarf::mesh::facet_chord_test {
namespace {

using test::add_quad;
using test::add_triangle;

/// An upright prism over a regular polygon, from z = 0 to 10.
TriMesh prism(int sides, double radius) {
  TriMesh mesh;
  const auto at = [&](int k, double z) {
    const double angle = 2.0 * M_PI * (k % sides) / sides;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int k = 0; k < sides; ++k) {
    add_quad(mesh, at(k, 0), at(k + 1, 0), at(k + 1, 10), at(k, 10));
    add_triangle(mesh, {0, 0, 10}, at(k, 10), at(k + 1, 10));
    add_triangle(mesh, {0, 0, 0}, at(k + 1, 0), at(k, 0));
  }
  return mesh;
}

TEST(FacetChord, OfARoundWallIsTheSagittaOfItsStrips) {
  for (const double radius : {0.5, 3.4, 80.0}) {
    for (const int sides : {16, 48, 200}) {
      const double sagitta = radius * (1.0 - std::cos(M_PI / sides));
      const FacetChord chord = estimate_facet_chord(prism(sides, radius));
      EXPECT_NEAR(chord.mm, sagitta, 0.02 * sagitta) << radius << " mm, " << sides << " sides";
      EXPECT_NEAR(std::hypot(chord.place.x(), chord.place.y()), radius, 1e-4 * radius);
    }
  }
}

TEST(FacetChord, OfFlatsIsNone) {
  EXPECT_EQ(estimate_facet_chord(prism(4, 20.0)).mm, 0.0);
  EXPECT_EQ(estimate_facet_chord(prism(6, 20.0)).mm, 0.0);
  // A roof of 5 degrees: two large flats that meet at a small angle.
  const double h = 50.0 * std::tan(5.0 * M_PI / 180.0);
  const TriMesh roof =
      test::towers({0, 50, 100}, {0, 40}, 0.0, [&](int i, int) { return i == 0 ? 10.0 : 10.0 + h; });
  EXPECT_EQ(estimate_facet_chord(roof).mm, 0.0);
}

TEST(FacetChord, OfASphereIsOfTheSizeOfItsSagitta) {
  constexpr double kRadius = 10.0;
  constexpr int kRows = 40;
  TriMesh mesh;
  const auto at = [&](int i, int k) {
    const double lat = M_PI * i / kRows, lon = M_PI * k / kRows;
    return Vec3(kRadius * std::sin(lat) * std::cos(lon), kRadius * std::sin(lat) * std::sin(lon),
                kRadius * std::cos(lat));
  };
  for (int i = 0; i < kRows; ++i) {
    for (int k = 0; k < 2 * kRows; ++k) {
      const int next = (k + 1) % (2 * kRows);
      if (i + 1 < kRows) add_triangle(mesh, at(i, k), at(i + 1, k), at(i + 1, next));
      if (i > 0) add_triangle(mesh, at(i, k), at(i + 1, next), at(i, next));
    }
  }
  // The middle of a cell at the equator, 4.5 by 4.5 degrees.
  const double side = M_PI / kRows, sagitta = kRadius * (1.0 - std::cos(0.5 * side * std::sqrt(2.0)));
  const double told = estimate_facet_chord(mesh).mm;
  EXPECT_GT(told, 0.25 * sagitta);
  EXPECT_LT(told, 2.0 * sagitta);
}

}  // namespace
}  // namespace swarf::mesh::facet_chord_test

// Splitting triangles for a field leaves the surface where it is, and shows the field.
#include "mesh/shown_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/mesh_check.h"
#include "mesh/mesh_ops.h"
#include "mesh/plain_solids.h"

namespace shown_field_test {
namespace {

using swarf::TriMesh;
using swarf::Vec3;
using swarf::mesh::ShownField;

constexpr double kFacetAngle = 0.5;

/// A block of 100 x 60 x 20 whose top has a step of 20 um along y = 7; elsewhere it is right.
ShownField step_on_the_top() {
  ShownField field{[](TriMesh& places) {
                     places.deviation_um.clear();
                     for (size_t i = 0; i < places.positions.size(); ++i) {
                       const bool top = places.normals[i][2] > 0.9F;
                       places.deviation_um.push_back(top && places.positions[i][1] > 7.0F ? 20.0F : 0.0F);
                     }
                   },
                   [](const std::array<float, 3>& um, const Vec3& shares, float truth) {
                     return std::abs(shares[0] * um[0] + shares[1] * um[1] + shares[2] * um[2] - truth);
                   }};
  field.known_changes = {{1.0, 7.0, 20.0}};
  field.near_mm = 0.2;
  field.most_vertices = 5000;
  return field;
}

TriMesh split_block() {
  TriMesh block;
  swarf::mesh::add_box(block, {{0, 0, 0}, {100, 60, 20}});
  swarf::mesh::compute_vertex_normals(block, kFacetAngle);
  return block;
}

TEST(ShownField, IsShownWhereItSteps) {
  const ShownField field = step_on_the_top();
  TriMesh block = split_block();
  swarf::mesh::show_field(field, block);
  EXPECT_GT(block.triangles.size(), 20U);
  const auto found = swarf::mesh::shown_agreement(field, block, 10000);
  EXPECT_GT(found.seen, 9990U);
  EXPECT_LT(found.wrong, 20U) << found.worst << " at " << found.where.transpose();
}

TEST(ShownField, LeavesTheSurfaceWhereItIs) {
  TriMesh block = split_block();
  swarf::mesh::show_field(step_on_the_top(), block);
  EXPECT_NEAR(swarf::mesh::enclosed_volume(block), 100.0 * 60.0 * 20.0, 1e-2);
  for (const auto& p : block.positions) {
    const double off = std::min({std::abs(p[0]), std::abs(p[0] - 100.0F), std::abs(p[1]),
                                 std::abs(p[1] - 60.0F), std::abs(p[2]), std::abs(p[2] - 20.0F)});
    EXPECT_LT(off, 1e-5) << p[0] << " " << p[1] << " " << p[2];
  }
}

TEST(ShownField, MakesNoMoreVerticesThanAreAsked) {
  ShownField field = step_on_the_top();
  field.most_vertices = 60;
  TriMesh block = split_block();
  swarf::mesh::show_field(field, block);
  EXPECT_LE(block.positions.size(), 60U);
}

TEST(ShownField, OfOneValueNeedsNoSplit) {
  ShownField field = step_on_the_top();
  field.known_changes.clear();
  field.measure = [](TriMesh& places) { places.deviation_um.assign(places.positions.size(), 3.0F); };
  TriMesh block = split_block();
  swarf::mesh::show_field(field, block);
  EXPECT_EQ(block.triangles.size(), 12U);
}

}  // namespace
}  // namespace shown_field_test

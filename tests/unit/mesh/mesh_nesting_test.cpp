// Bodies in bodies: what bounds a solid is let pass, what does not is found.
#include "mesh/mesh_nesting.h"

#include <gtest/gtest.h>

#include "support/solids.h"

namespace swarf::mesh {
namespace {

using test::block;
using test::together;
using test::turned;

const TriMesh kOuter = block({0, 0, 0}, {40, 40, 40});
const TriMesh kMiddle = block({5, 5, 5}, {30, 30, 30});
const TriMesh kInner = block({10, 10, 10}, {20, 20, 20});
const TriMesh kBeside = block({50, 0, 0}, {60, 10, 10});

TEST(MeshNesting, SolidsPass) {
  for (const TriMesh& mesh : {kOuter, together({kOuter, kBeside}), together({kOuter, turned(kInner)}),
                              together({turned(kMiddle), kOuter, kInner}),  // a body loose in a cavity
                              together({kOuter, block({40, 5, 5}, {50, 30, 30})}),  // two that touch
                              test::torus(30, 10, {0, 0, 0}, 60, 20), TriMesh{}})
    EXPECT_FALSE(find_misplaced_body(mesh));
}

TEST(MeshNesting, MisplacedBodiesAreFound) {
  struct Case {
    const char* name;
    TriMesh mesh;
    double volume_mm3;
    int around;
  };
  for (const Case& c :
       {Case{"a body in a body", together({kOuter, kInner}), 1000.0, 1},
        Case{"the same, the inner first", together({kInner, kOuter}), 1000.0, 1},
        Case{"a cavity outside", together({kOuter, turned(kBeside)}), -1000.0, 0},
        Case{"a cavity in a cavity", together({kOuter, turned(kMiddle), turned(kInner)}), -1000.0, 0},
        Case{"a body in a body in a body", together({kMiddle, kOuter, kInner}), 15625.0, 1},
        Case{"inside the hole of the ring, but in the ring's tube",
             together({test::torus(30, 10, {0, 0, 0}, 60, 20), block({29, -1, -1}, {31, 1, 1})}), 8.0, 1}}) {
    SCOPED_TRACE(c.name);
    const auto body = find_misplaced_body(c.mesh);
    ASSERT_TRUE(body);
    EXPECT_NEAR(body->volume_mm3, c.volume_mm3, 1e-6 * std::abs(c.volume_mm3));
    EXPECT_EQ(body->around, c.around);
  }
}

TEST(MeshNesting, BodiesThatOverlapAreFound) {
  const auto faults = [](const TriMesh& mesh) {
    Diagnostics told;
    check_apart(mesh, "part.stl", told, "design mesh");
    return told.has_errors();
  };
  for (const TriMesh& apart : {kOuter, together({kOuter, kBeside}), together({kOuter, turned(kInner)}),
                               together({turned(kMiddle), kOuter, kInner}), TriMesh{}})
    EXPECT_FALSE(faults(apart));
  const TriMesh bar =
      block({-5, 15, 15}, {45, 20, 20});  // through the block, no corner of either in the other
  for (const TriMesh& met : {together({kOuter, bar}), together({kOuter, block({39.99, 5, 5}, {50, 30, 30})}),
                             together({kOuter, block({40, 5, 5}, {50, 30, 30})})})
    EXPECT_TRUE(faults(met));
}

TEST(MeshNesting, ABodyInTheHoleOfARingPasses) {
  EXPECT_FALSE(find_misplaced_body(
      together({test::torus(30, 10, {0, 0, 0}, 60, 20), block({-1, -1, -1}, {1, 1, 1})})));
}

}  // namespace
}  // namespace swarf::mesh

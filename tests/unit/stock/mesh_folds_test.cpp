// The mesh of a stock is a solid that others can measure: closed, and without folds that run through
// themselves.
#include <gtest/gtest.h>

#include "dome.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_crossing.h"
#include "mesh/signed_distance.h"
#include "stock/stock.h"

namespace swarf::stock {
namespace {

TEST(MeshFolds, RimOfADomeInTheFacesOfItsBlock) {
  Stock stock({Vec3(-50, -40, -5), Vec3(50, 40, 37)}, 0.4);
  stock.cut(dome_passes(-0.02, 1.02, 41, 100), {5.0, 40.0});
  const TriMesh mesh = stock.mesh();
  EXPECT_EQ(mesh::check_closed(mesh), "");
  const mesh::Crossings crossings = mesh::find_crossings(mesh::SignedDistance(mesh));
  EXPECT_EQ(crossings.pairs, 0U) << "first at " << crossings.place.transpose() << " mm";
}

}  // namespace
}  // namespace swarf::stock

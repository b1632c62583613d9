// What is written as .obj reads back to the last bit.
#include <gtest/gtest.h>

#include "mesh/mesh_io.h"
#include "support/scratch.h"

namespace swarf::mesh {
namespace {

TEST(ObjWritten, ReadsBackToTheLastBit) {
  TriMesh written;
  written.positions = {{0.1F, 1e-7F, -3.3333333F}, {12345.678F, 0, 0}, {0, 7, 0.30000001F}, {1, 1, 1}};
  written.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::string path = (test::scratch_folder() / "written.obj").string();
  save_mesh(path, written);
  const TriMesh read = load_mesh(path);
  EXPECT_EQ(read.positions, written.positions);
  EXPECT_EQ(read.triangles, written.triangles);
}

}  // namespace
}  // namespace swarf::mesh

// Meshes as STEP files: read back by the library, they are the bodies they were.
#include "brep/write_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/diagnostics.h"
#include "base/rng.h"
#include "brep/model.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_slivers.h"

namespace swarf::brep {
namespace {

namespace fs = std::filesystem;

/// Appends a box; turned inward it is a cavity.
void add_box(TriMesh& mesh, const Vec3& low, const Vec3& high, bool inward = false) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({static_cast<float>((i & 1) != 0 ? high.x() : low.x()),
                              static_cast<float>((i & 2) != 0 ? high.y() : low.y()),
                              static_cast<float>((i & 4) != 0 ? high.z() : low.z())});
  const std::array<std::array<uint32_t, 4>, 6> sides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& s : sides) {
    for (std::array<uint32_t, 3> t : {std::array{s[0], s[1], s[2]}, std::array{s[0], s[2], s[3]}}) {
      if (inward) std::swap(t[1], t[2]);
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
}

/// Splits a side of a triangle at a place on it, so that a triangle without area closes the gap to its
/// neighbour.
void split_with_sliver(TriMesh& mesh, size_t triangle, double share) {
  const std::array<uint32_t, 3> t = mesh.triangles[triangle];
  const auto middle = static_cast<uint32_t>(mesh.positions.size());
  std::array<float, 3> p{};
  for (size_t k = 0; k < 3; ++k)
    p[k] = static_cast<float>((1.0 - share) * mesh.positions[t[0]][k] + share * mesh.positions[t[1]][k]);
  mesh.positions.push_back(p);
  mesh.triangles[triangle] = {t[0], middle, t[2]};
  mesh.triangles.push_back({middle, t[1], t[2]});
  mesh.triangles.push_back({t[0], t[1], middle});
}

class WriteStep : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("swarf_write_step_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string bytes(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  fs::path folder_;
};

TEST_F(WriteStep, BodiesWithTheirCavitiesComeBack) {
  TriMesh mesh;
  add_box(mesh, {0, 0, 0}, {10, 10, 10});
  add_box(mesh, {3, 3, 3}, {6, 6, 6}, true);
  add_box(mesh, {4, 4, 4}, {5, 5, 5});  // in the cavity
  add_box(mesh, {20, 0, 0}, {22, 2, 2});
  write_step(path("bodies.step"), mesh, "a part");
  const Model model = read_step(path("bodies.step"));
  ASSERT_EQ(model.solids.size(), 3U);
  std::vector<double> volumes;
  for (const Solid& solid : model.solids) {
    EXPECT_TRUE(solid.closed);
    volumes.push_back(solid.volume_mm3);
  }
  std::sort(volumes.begin(), volumes.end());
  EXPECT_NEAR(volumes[0], 1.0, 1e-9);
  EXPECT_NEAR(volumes[1], 8.0, 1e-9);
  EXPECT_NEAR(volumes[2], 1000.0 - 27.0, 1e-9);
  EXPECT_EQ(model.mm_per_unit, 1.0);
  EXPECT_NE(bytes(path("bodies.step")).find("'a part'"), std::string::npos);
}

TEST_F(WriteStep, TrianglesWithoutAreaAreFlippedAway) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    TriMesh mesh;
    add_box(mesh, {0, 0, 0}, {10, 7, 5});
    for (int i = 0; i < 12; ++i)
      split_with_sliver(mesh, static_cast<size_t>(rng.uniform(0.0, 12.0)), rng.uniform(0.2, 0.8));
    ASSERT_EQ(mesh::check_closed(mesh), "") << "Rng rng(" << seed << ")";
    write_step(path("split.step"), mesh, "split");
    const Model model = read_step(path("split.step"));
    ASSERT_EQ(model.solids.size(), 1U) << "Rng rng(" << seed << ")";
    EXPECT_TRUE(model.solids[0].closed) << "Rng rng(" << seed << ")";
    EXPECT_NEAR(model.solids[0].volume_mm3, 350.0, 1e-4) << "Rng rng(" << seed << ")";
    EXPECT_TRUE(model.warnings.empty()) << model.warnings.front().text << ", Rng rng(" << seed << ")";
  }
}

TEST_F(WriteStep, ASheetWithoutThicknessIsLeftOut) {
  TriMesh mesh;
  add_box(mesh, {0, 0, 0}, {4, 4, 4});
  mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  mesh.triangles.push_back({8, 9, 10});
  mesh.triangles.push_back({8, 10, 9});
  write_step(path("sheet.step"), mesh, "sheet");
  const Model model = read_step(path("sheet.step"));
  ASSERT_EQ(model.solids.size(), 1U);
  EXPECT_NEAR(model.solids[0].volume_mm3, 64.0, 1e-9);
}

TEST_F(WriteStep, FilesOfOnePartAreTheSame) {
  TriMesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 2, 3});
  write_step(path("one.step"), mesh, "same");
  write_step(path("two.step"), mesh, "same");
  EXPECT_EQ(bytes(path("one.step")), bytes(path("two.step")));
}

TEST_F(WriteStep, RefusesWhatIsNoBodyTooLargeOrCannotBeWritten) {
  const auto code_of = [](const std::string& file, const TriMesh& mesh) -> std::string {
    try {
      write_step(file, mesh, "refused");
    } catch (const InputError& error) {
      return error.diagnostics.list().front().code;
    }
    return "";
  };
  EXPECT_EQ(code_of(path("none.step"), {}), "step-empty");
  TriMesh inward;
  add_box(inward, {0, 0, 0}, {1, 1, 1}, true);
  EXPECT_EQ(code_of(path("in.step"), inward), "step-not-closed");
  EXPECT_FALSE(fs::exists(path("in.step")));
  TriMesh box;
  add_box(box, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(code_of(path("missing/box.step"), box), "cannot-write-file");
  box.triangles.resize(kMostStepTriangles + 1, {0, 1, 2});
  EXPECT_EQ(code_of(path("large.step"), box), "step-too-large");
}

}  // namespace
}  // namespace swarf::brep

// Mesh files: what is written comes back, broken files are refused, closed means closed.
#include "mesh/mesh_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/diagnostics.h"
#include "base/rng.h"
#include "support/full_disk.h"
#include "support/scratch.h"

namespace swarf::mesh::mesh_io_test {
namespace {

namespace fs = std::filesystem;

/// A folder that goes away with the test.
class MeshIo : public testing::Test {
 protected:
  MeshIo() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~MeshIo() override { fs::remove_all(folder_); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string with_bytes(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }

 private:
  fs::path folder_ = test::scratch_folder() / (std::string("swarf_mesh_io_") +
                                               testing::UnitTest::GetInstance()->current_test_info()->name());
};

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// A closed tube bent to a ring: n x n vertices, outward orientation.
TriMesh torus(uint32_t n) {
  TriMesh mesh;
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t k = 0; k < n; ++k) {
      const double a = 2.0 * kPi * i / n, b = 2.0 * kPi * k / n, r = 30.0 + 8.0 * std::cos(b);
      mesh.positions.push_back({static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)),
                                static_cast<float>(8.0 * std::sin(b))});
      const uint32_t i1 = (i + 1) % n, k1 = (k + 1) % n;
      mesh.triangles.push_back({i * n + k, i1 * n + k, i1 * n + k1});
      mesh.triangles.push_back({i * n + k, i1 * n + k1, i * n + k1});
    }
  }
  return mesh;
}

double volume(const TriMesh& mesh) {
  double six_volumes = 0.0;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](int i) {
      return Eigen::Vector3f(mesh.positions[t[i]].data()).cast<double>().eval();
    };
    six_volumes += corner(0).dot(corner(1).cross(corner(2)));
  }
  return six_volumes / 6.0;
}

TEST_F(MeshIo, StlAndPlyKeepTheSolid) {
  const TriMesh mesh = torus(24);
  for (const char* name : {"ring.stl", "ring.ply", "RING.PLY"}) {
    save_mesh(file(name), mesh);
    const TriMesh back = load_mesh(file(name));
    EXPECT_EQ(back.positions.size(), mesh.positions.size()) << name;
    EXPECT_EQ(back.triangles.size(), mesh.triangles.size()) << name;
    EXPECT_NEAR(volume(back), volume(mesh), 1e-9 * volume(mesh)) << name;
    EXPECT_EQ(check_closed(back), "") << name;
  }
}

TEST_F(MeshIo, PlyKeepsNormalsAndColours) {
  TriMesh mesh = torus(12);
  Rng rng(4);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 n = rng.direction();
    mesh.normals.push_back({static_cast<float>(n.x()), static_cast<float>(n.y()), static_cast<float>(n.z())});
    const auto byte = [&] { return static_cast<uint8_t>(rng.next() & 255U); };
    mesh.colours.push_back({byte(), byte(), byte(), 255});
  }
  save_mesh(file("ring.ply"), mesh);
  const TriMesh back = load_mesh(file("ring.ply"));
  EXPECT_EQ(back.positions, mesh.positions);
  EXPECT_EQ(back.normals, mesh.normals);
  EXPECT_EQ(back.colours, mesh.colours);
}

TEST_F(MeshIo, PlyCarriesTheDeviationAsAScalar) {
  TriMesh mesh = torus(3);
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.deviation_um.push_back(0.25F * static_cast<float>(i));
  save_mesh(file("ring.ply"), mesh);
  const std::string bytes = bytes_of(file("ring.ply"));
  const std::string end = "end_header\n";
  ASSERT_NE(bytes.find("property float z\nproperty float deviation_um\nelement face 18\n"),
            std::string::npos);
  const char* vertices = bytes.data() + bytes.find(end) + end.size();
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    float deviation = 0.0F;
    std::memcpy(&deviation, vertices + 16 * i + 12, sizeof(float));
    EXPECT_EQ(deviation, mesh.deviation_um[i]);
  }
  EXPECT_EQ(bytes.size(), bytes.find(end) + end.size() + 9 * 16 + 18 * 13);
}

TEST_F(MeshIo, ReadsObjWithQuadsAsTriangles) {
  const TriMesh mesh = load_mesh(with_bytes("square.obj", "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 1 2 3 4\n"));
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.positions.size(), 4U);
  EXPECT_NE(check_closed(mesh).find("one side only"), std::string::npos);
}

/// The code of the refusal, "" when the file is read.
std::string refusal(const std::string& path) {
  try {
    load_mesh(path);
  } catch (const InputError& error) {
    return error.diagnostics.list().at(0).code;
  }
  return "";
}

TEST_F(MeshIo, RefusesWhatIsNoMesh) {
  EXPECT_EQ(refusal(file("none.stl")), "mesh-not-found");
  EXPECT_EQ(refusal(test::scratch_folder().string()), "mesh-not-found");
  EXPECT_EQ(refusal(with_bytes("empty.stl", "")), "mesh-unreadable");
  EXPECT_EQ(refusal(with_bytes("text.ply", "hello")), "mesh-unreadable");
  EXPECT_EQ(refusal(with_bytes("mesh.xyz", "1 2 3\n")), "mesh-unreadable");
  EXPECT_EQ(refusal(with_bytes("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), "mesh-unreadable");
}

TEST_F(MeshIo, RefusesPositionsThatAreNotFinite) {
  TriMesh mesh = torus(6);
  mesh.positions[5][1] = std::nanf("");
  save_mesh(file("nan.ply"), mesh);
  EXPECT_EQ(refusal(file("nan.ply")), "mesh-unreadable");
}

TEST_F(MeshIo, EveryTruncationIsRefusedOrHasSoundIndices) {
  // A PLY file that ends too early must neither be waited for nor be filled up.
  save_mesh(file("ring.stl"), torus(6));
  save_mesh(file("ring.ply"), torus(6));
  fs::copy_file(SWARF_SOURCE_DIR "/tests/data/machines/tetrahedron.ply", file("ascii.ply"));
  for (const char* name : {"ring.stl", "ring.ply", "ascii.ply"}) {
    const std::string bytes = bytes_of(file(name));
    const size_t step = bytes.size() > 1000 ? 13 : 1;
    for (size_t length = 0; length < bytes.size(); length += step) {
      const std::string path = with_bytes(std::string("cut_") + name, bytes.substr(0, length));
      if (!refusal(path).empty()) continue;
      const TriMesh mesh = load_mesh(path);
      for (const auto& t : mesh.triangles) {
        for (const uint32_t v : t) ASSERT_LT(v, mesh.positions.size()) << name << " cut to " << length;
      }
    }
  }
}

TEST_F(MeshIo, AFailedWriteLeavesTheOldFile) {
  EXPECT_THROW(save_mesh(file("ring.off"), torus(4)), InputError);
  EXPECT_THROW(save_mesh(file("no/such/folder.stl"), torus(4)), InputError);
  save_mesh(file("ring.stl"), torus(4));
  const std::string before = bytes_of(file("ring.stl"));
  {
    const test::FullDisk disk(before.size() / 2);
    EXPECT_THROW(save_mesh(file("ring.stl"), torus(5)), InputError);
  }
  EXPECT_EQ(bytes_of(file("ring.stl")), before);
}

TEST(CheckClosed, FindsAMissingAndATurnedTriangle) {
  TriMesh mesh = torus(8);
  EXPECT_EQ(check_closed(mesh), "");
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  EXPECT_NE(check_closed(mesh).find("twice in the same direction"), std::string::npos);
  mesh.triangles.erase(mesh.triangles.begin() + 7);
  EXPECT_NE(check_closed(mesh).find("one side only"), std::string::npos);
}

TEST(CheckClosed, TakesSplitVerticesAsOneAndIgnoresCollapsedTriangles) {
  const TriMesh whole = torus(8);
  TriMesh split;
  for (const auto& t : whole.triangles) {
    const auto first = static_cast<uint32_t>(split.positions.size());
    for (const uint32_t v : t) split.positions.push_back(whole.positions[v]);
    split.triangles.push_back({first, first + 1, first + 2});
  }
  split.triangles.push_back({0, 0, 1});
  EXPECT_EQ(check_closed(split), "");
}

}  // namespace
}  // namespace swarf::mesh::mesh_io_test

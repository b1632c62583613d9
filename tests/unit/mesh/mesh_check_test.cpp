// Design meshes: each fault has its code and says where and how much; a large file is read whole.
#include "mesh/mesh_check.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "mesh/mesh_io.h"
#include "support/scratch.h"

namespace swarf::mesh::mesh_check_test {
namespace {

/// A box from the origin, two facets per face, turned outward.
TriMesh box(float x, float y, float z) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back({(i & 1) != 0 ? x : 0.0F, (i & 2) != 0 ? y : 0.0F, (i & 4) != 0 ? z : 0.0F});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

const Box kStock{{-5, -5, -5}, {105, 85, 45}};

/// Codes of what is found, joined by spaces; the first text is kept.
std::string codes(const TriMesh& mesh, std::string* text = nullptr, const Box* stock = &kStock) {
  Diagnostics diagnostics;
  check_design_mesh(mesh, "design.stl", stock, diagnostics);
  std::string found;
  for (const Diagnostic& d : diagnostics.list()) found += (found.empty() ? "" : " ") + d.code;
  if (text != nullptr && !diagnostics.list().empty())
    *text = diagnostics.list().front().text + "; " + diagnostics.list().front().fix;
  return found;
}

TEST(MeshCheck, ASoundDesignHasNoFaults) {
  EXPECT_EQ(codes(box(100, 80, 40)), "");
  EXPECT_EQ(codes(box(100, 80, 40), nullptr, nullptr), "");
}

TEST(MeshCheck, ASheetOfZeroThicknessEnclosesNoVolume) {
  TriMesh sheet;
  sheet.positions = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  EXPECT_EQ(codes(sheet), "mesh-no-volume");
  EXPECT_EQ(codes(box(100, 80, 0.001F)), "");
}

TEST(MeshCheck, OpenSaysHowManyEdgesAndWhere) {
  TriMesh mesh = box(100, 80, 40);
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // the top
  std::string text;
  EXPECT_EQ(codes(mesh, &text), "mesh-open");
  EXPECT_NE(text.find("4 boundary edges"), std::string::npos) << text;
  EXPECT_NE(text.find("(0.000, 0.000, 40.000) .. (100.000, 80.000, 40.000) mm"), std::string::npos) << text;
}

TEST(MeshCheck, InvertedTurnedAndCrowded) {
  TriMesh inverted = box(100, 80, 40);
  for (auto& t : inverted.triangles) std::swap(t[1], t[2]);
  std::string text;
  EXPECT_EQ(codes(inverted, &text), "mesh-inverted");
  EXPECT_NE(text.find("-320000.000 mm3"), std::string::npos) << text;
  TriMesh turned = box(100, 80, 40);
  std::swap(turned.triangles[3][1], turned.triangles[3][2]);
  EXPECT_EQ(codes(turned, &text), "mesh-turned-facets");
  EXPECT_NE(text.find("3 edges"), std::string::npos) << text;
  TriMesh crowded = box(100, 80, 40);  // an inner wall hangs on the edge 0-1
  crowded.positions.push_back({50, 40, 20});
  crowded.triangles.push_back({0, 1, 8});
  EXPECT_EQ(codes(crowded, &text), "mesh-open mesh-non-manifold");
}

TEST(MeshCheck, SizesThatDoNotFitTheStock) {
  std::string text;
  EXPECT_EQ(codes(box(100 / 25.4F, 80 / 25.4F, 40 / 25.4F), &text), "mesh-in-inches");
  EXPECT_NE(text.find("(3.937, 3.150, 1.575)"), std::string::npos) << text;
  EXPECT_EQ(codes(box(100 * 25.4F, 80 * 25.4F, 40 * 25.4F)), "mesh-scaled-by-25");
  EXPECT_EQ(codes(box(100, 80, 50)), "mesh-outside-stock");
  TriMesh aside = box(100, 80, 40);
  for (auto& p : aside.positions) p[0] += 30.0F;
  EXPECT_EQ(codes(aside, &text), "mesh-outside-stock");
  EXPECT_NE(text.find("moved by X -25.000 Y 0.000 Z 0.000 mm"), std::string::npos) << text;
  EXPECT_EQ(codes(box(30, 20, 10)), "");  // a small part in a large block is nobody's mistake
}

TEST(MeshCheck, FacetsWithoutAreaAndPositionsThatAreNone) {
  TriMesh mesh = box(100, 80, 40);
  mesh.triangles.push_back({3, 3, 7});
  std::string text;
  EXPECT_EQ(codes(mesh, &text), "mesh-zero-area");
  EXPECT_NE(text.find("1 of 13 facets"), std::string::npos) << text;
  EXPECT_EQ(codes(TriMesh{}), "mesh-empty");
  mesh.positions[2][1] = std::nanf("");
  EXPECT_EQ(codes(mesh, &text), "mesh-not-finite");
  EXPECT_NE(text.find("1 of 8 vertices"), std::string::npos) << text;
}

TEST(MeshCheck, WeldTakesBothZerosAsOnePlace) {
  TriMesh mesh;
  mesh.positions = {{0.0F, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0F, 0, 0}, {0, 1, 0}, {1, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.points.size(), 4u);
  EXPECT_EQ(welded.triangles[1], (std::array<uint32_t, 3>{0, 2, 3}));
}

/// A closed ring of n x n quads, written as binary STL; 2 n^2 facets.
TriMesh torus(uint32_t n) {
  TriMesh mesh;
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t k = 0; k < n; ++k) {
      const double a = 6.283185307179586 * i / n, b = 6.283185307179586 * k / n, r = 30.0 + 8.0 * std::cos(b);
      mesh.positions.push_back({static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)),
                                static_cast<float>(8.0 * std::sin(b))});
      const uint32_t i1 = (i + 1) % n, k1 = (k + 1) % n;
      mesh.triangles.push_back({i * n + k, i1 * n + k, i1 * n + k1});
      mesh.triangles.push_back({i * n + k, i1 * n + k1, i * n + k1});
    }
  }
  return mesh;
}

// SWARF_STL_RING sets the ring's n: 2237 makes ten million facets (the file then has 500 MB).
TEST(MeshCheck, ALargeBinaryStlIsReadWhole) {
  const char* wanted = std::getenv("SWARF_STL_RING");
  const uint32_t n = wanted != nullptr ? static_cast<uint32_t>(std::atoi(wanted)) : 300;
  const auto path = (std::filesystem::path(test::scratch_text()) / "swarf_ring.stl").string();
  save_mesh(path, torus(n));
  const auto start = std::chrono::steady_clock::now();
  const TriMesh back = load_mesh(path);
  const double read_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(back.triangles.size(), size_t{2} * n * n);
  EXPECT_EQ(back.positions.size(), size_t{n} * n);
  EXPECT_EQ(codes(back, nullptr, nullptr), "");
  const double both_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("facets", std::to_string(back.triangles.size()));
  std::printf("%zu facets: read in %.2f s, checked in %.2f s\n", back.triangles.size(), read_s,
              both_s - read_s);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_THROW(load_mesh(path), InputError);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace swarf::mesh::mesh_check_test

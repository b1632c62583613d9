// The readers of STL, PLY and OBJ: what they read is exact, what they refuse is named with its place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/diagnostics.h"
#include "base/frames.h"
#include "mesh/mesh_io.h"
#include "mesh/polygon.h"
#include "support/scratch.h"

namespace swarf::mesh {
namespace {

namespace fs = std::filesystem;

class MeshReaders : public testing::Test {
 protected:
  MeshReaders() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~MeshReaders() override { fs::remove_all(folder_); }

  std::string with_bytes(const std::string& name, const std::string& bytes) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  TriMesh read(const std::string& name, const std::string& bytes) const {
    return load_mesh(with_bytes(name, bytes));
  }
  /// "line:column text" of the refusal; "" when the file is read.
  std::string refusal(const std::string& name, const std::string& bytes) const {
    try {
      read(name, bytes);
    } catch (const InputError& error) {
      const Diagnostic& first = error.diagnostics.list().at(0);
      EXPECT_EQ(first.code, "mesh-unreadable");
      EXPECT_FALSE(first.fix.empty());
      EXPECT_EQ(fs::path(first.where.file).filename(), name);
      return std::to_string(first.where.line) + ":" + std::to_string(first.where.column) + " " + first.text;
    }
    return "";
  }

 private:
  fs::path folder_ = test::scratch_folder() / (std::string("swarf_mesh_readers_") +
                                               testing::UnitTest::GetInstance()->current_test_info()->name());
};

template <typename T>
void put(std::string& out, T value, bool big = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big) std::reverse(raw, raw + sizeof(T));
  out.append(raw, sizeof(T));
}

const std::vector<std::array<float, 3>> kCorners{{0.1F, 0, 0}, {10, 0, 0}, {0, 1e-3F, 0}, {0, 0, -10.25F}};
const std::vector<std::array<uint32_t, 3>> kFacets{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

std::string ply_header(const std::string& format, const std::string& extra = "") {
  return "ply\nformat " + format + " 1.0\ncomment a comment of several words\n" +
         "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + extra +
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string binary_ply(bool big) {
  std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian");
  for (const auto& p : kCorners) {
    for (const float x : p) put(bytes, x, big);
  }
  for (const auto& t : kFacets) {
    put(bytes, uint8_t{3});
    for (const uint32_t v : t) put(bytes, v, big);
  }
  return bytes;
}

const char* const kTextBody = "0.1 0 0\n10 0 0\n0 1e-3 0\n\n0 0 -10.25\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string text_stl() {
  std::string text = "solid a name of several words\n";
  for (const auto& t : kFacets) {
    text += "facet normal nan 0 0\n outer loop\n";
    for (const uint32_t v : t) {
      text += "  vertex " + std::to_string(kCorners[v][0]) + " " + std::to_string(kCorners[v][1]) + " " +
              std::to_string(kCorners[v][2]) + "\n";
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid a name\n";
}

std::string binary_stl() {
  std::string bytes(80, 'x');
  put(bytes, static_cast<uint32_t>(kFacets.size()));
  for (const auto& t : kFacets) {
    bytes.append(12, '\0');
    for (const uint32_t v : t) {
      for (const float x : kCorners[v]) put(bytes, x);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

TEST_F(MeshReaders, EveryFormOfPlyGivesTheSameMesh) {
  for (const std::string& bytes :
       {ply_header("ascii") + kTextBody, binary_ply(false), binary_ply(true), binary_ply(false) + "\n"}) {
    const TriMesh mesh = read("solid.ply", bytes);
    EXPECT_EQ(mesh.positions, kCorners);
    EXPECT_EQ(mesh.triangles, kFacets);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.colours.empty());
  }
}

TEST_F(MeshReaders, PlyMayEndItsLinesAsItLikes) {
  std::string text = ply_header("ascii") + kTextBody;
  for (size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2) text.insert(at, "\r");
  EXPECT_EQ(read("dos.ply", text).triangles, kFacets);
  text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
  EXPECT_EQ(read("mac.ply", text).triangles, kFacets);
}

TEST_F(MeshReaders, PlyReadsOverWhatItDoesNotKnow) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement material 1\nproperty float shine\nproperty list uchar float rest\n"
      "element vertex 3\nproperty double y\nproperty float quality\nproperty short x\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 1\nproperty uchar flags\nproperty list int ushort vertex_index\nend_header\n";
  const TriMesh mesh = read(
      "mixed.ply", header + "0.5 2 nan inf\n0 nan 1 2 255 0 7\n5 0 2 3 0 0 0\n7 0 3 4 1 2 3\n9 3 2 0 1\n");
  EXPECT_EQ(mesh.positions, (std::vector<std::array<float, 3>>{{1, 0, 2}, {2, 5, 3}, {3, 7, 4}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<uint32_t, 3>>{{2, 0, 1}}));
  EXPECT_EQ(mesh.colours.at(0), (std::array<uint8_t, 4>{255, 0, 7, 255}));
}

TEST_F(MeshReaders, PlyFacesMayStandBeforeTheVertices) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(read("turned.ply", text).triangles.size(), 1U);
}

TEST_F(MeshReaders, PlyRefusalsNameTheirPlace) {
  const auto text = [&](const std::string& from, const std::string& to) {
    std::string whole = ply_header("ascii") + kTextBody;
    return refusal("bad.ply", whole.replace(whole.find(from), from.size(), to));
  };
  EXPECT_EQ(text("10 0 0", "10 nan 0"), "12:4 y is not finite");
  EXPECT_EQ(text("10 0 0", "10 0 -1e7"), "12:6 z is -1e+07 mm, beyond the 1e+06 mm that a mesh may reach");
  EXPECT_EQ(text("10 0 0", "10 1,5 0"), "12:4 '1,5' is no number for a value");
  EXPECT_EQ(text("10 0 0", "10 0"), "12:5 the line ends where a value should stand");
  EXPECT_EQ(text("10 0 0", "10 0 0 0"), "12:8 '0' is too much in this line");
  EXPECT_EQ(text("3 0 3 2", "3 0 4 2"), "18:5 vertex 4 is not there: the file has vertices 0 to 3");
  EXPECT_EQ(text("3 0 3 2", "3 0 -1 2"), "18:5 vertex -1 is not there: the file has vertices 0 to 3");
  EXPECT_EQ(text("3 0 3 2", "300 0 3 2"), "18:1 this is no whole number of the type that the header names");
  EXPECT_EQ(text("3 0 3 2", "2 0 3"), "18:1 a face of 2 corners, not 3 to 1024");
  EXPECT_EQ(text("3 1 2 3\n", ""), "19:1 the file ends before everything that its header announces");
  EXPECT_EQ(text("3 1 2 3\n", "3 1 2 3\n3 1 2 3\n"), "20:1 more stands here than the header announces");
  EXPECT_EQ(text("vertex 4", "vertex 5"),
            "16:7 '1' is too much in this line");  // a face where the fifth vertex should be
  EXPECT_EQ(text("vertex 4", "vertex 4000000000"),
            "4:1 4000000000 items of 'vertex' cannot stand in the 68 bytes after the header: the file is cut "
            "off, or the count is wrong");
  EXPECT_EQ(text("vertex 4", "vertex 99999999999999999999"),
            "4:16 '99999999999999999999' is no number of items");
  EXPECT_EQ(text("float x", "flaot x"), "5:10 'flaot' is no type of PLY");
  EXPECT_EQ(text("float x", "float q"), "4:1 the vertices have no x, y and z");
  EXPECT_EQ(text("format ascii", "format text"), "2:8 'text' is no format of PLY");
  EXPECT_EQ(text("end_header\n", ""), "10:1 '0.1' is no word of a PLY header");
}

TEST_F(MeshReaders, BinaryPlyRefusalsNameTheirByte) {
  const std::string whole = binary_ply(false);
  const size_t body = whole.find("end_header\n") + 11;
  const auto byte = [](size_t at) { return "0:0 byte " + std::to_string(at) + ": "; };
  std::string bytes = whole;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&bytes[body + 16], &nan, sizeof(nan));
  EXPECT_EQ(refusal("bad.ply", bytes), byte(body + 16) + "y is not finite");
  bytes = whole;
  bytes[body + 48 + 1 + 3] = 1;  // the highest byte of the first index
  EXPECT_EQ(refusal("bad.ply", bytes),
            byte(body + 49) + "vertex 16777216 is not there: the file has vertices 0 to 3");
  bytes = whole;
  bytes[body + 48] = '\xff';
  EXPECT_EQ(refusal("bad.ply", bytes),
            byte(body + 48) + "a list of 255 values cannot stand in the rest of the file");
  EXPECT_EQ(refusal("bad.ply", whole + "xyz"), byte(whole.size()) + "3 bytes more than the header announces");
  EXPECT_NE(refusal("bad.ply", whole.substr(0, whole.size() - 1)), "");
}

TEST_F(MeshReaders, TextAndBinaryStlGiveTheSameMesh) {
  const TriMesh binary = read("binary.stl", binary_stl()), text = read("text.stl", text_stl());
  EXPECT_EQ(binary.positions.size(), 4U);
  EXPECT_EQ(binary.positions, text.positions);
  EXPECT_EQ(binary.triangles, text.triangles);
  std::string shouted = text_stl();
  for (char& c : shouted) c = c == 'n' ? c : static_cast<char>(std::toupper(c));
  EXPECT_EQ(read("loud.stl", shouted).triangles, text.triangles);
  EXPECT_EQ(read("two.stl", text_stl() + "\n" + text_stl()).triangles.size(), 8U);
}

TEST_F(MeshReaders, BinaryStlMayStartWithTheWordSolid) {
  std::string bytes = binary_stl();
  bytes.replace(0, 12, "solid by CAD");
  EXPECT_EQ(read("solid.stl", bytes).triangles.size(), 4U);
}

TEST_F(MeshReaders, StlRefusalsNameTheirPlace) {
  std::string bytes = binary_stl();
  const float huge = -3e38F;
  std::memcpy(&bytes[84 + 50 * 2 + 12 + 12 + 8], &huge, sizeof(huge));
  EXPECT_EQ(refusal("bad.stl", bytes),
            "0:0 byte 216: z of corner 2 of facet 3 is -3e+38 mm, beyond the 1e+06 mm that a mesh may reach");
  bytes = binary_stl();
  bytes[80] = 5;
  EXPECT_EQ(refusal("bad.stl", bytes),
            "0:0 bytes 80 to 83 announce 5 facets, which is a file of 334 bytes; it has 284");
  bytes[83] = '\xff';
  EXPECT_NE(refusal("bad.stl", bytes), "");
  EXPECT_EQ(refusal("bad.stl", std::string(84, '\0')), "0:0 the mesh has no triangles");

  const auto text = [&](const std::string& from, const std::string& to) {
    std::string whole = text_stl();
    return refusal("bad.stl", whole.replace(whole.find(from), from.size(), to));
  };
  EXPECT_EQ(text("vertex 10.000000", "vertex inf"), "6:10 x is not finite");
  EXPECT_EQ(text("vertex 10.0", "vertix 10.0"), "6:3 'vertix' stands where 'vertex' should");
  EXPECT_EQ(text("endsolid a name\n", ""), "30:1 the file ends without 'endsolid': it is cut off");
  EXPECT_EQ(text(" endloop\n", ""), "7:1 'endfacet' stands where 'endloop' should");
}

TEST_F(MeshReaders, ObjReadsPolygonsNormalsColoursAndNumbersFromTheEnd) {
  const std::string text =
      "# a comment\nmtllib a.mtl\no square\nv 0 0 0 1 0 0\nv 2 0 0 1 0 0\nv 2 3 0 0 1 0.5\nv 0 3 0 0 0 1 # "
      "end\n"
      "v 9 9 9 0 0 0\nvt 0 0\nvn 0 0 1\ns off\nusemtl steel\nf -5//1 2/1/-1 \\\n 3//1 4//1\nl 1 2\n";
  const TriMesh mesh = read("square.obj", text);
  EXPECT_EQ(mesh.positions, (std::vector<std::array<float, 3>>{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.normals, (std::vector<std::array<float, 3>>(4, {0, 0, 1})));
  EXPECT_EQ(mesh.colours.at(2), (std::array<uint8_t, 4>{0, 255, 128, 255}));
}

TEST_F(MeshReaders, ObjRefusalsNameTheirPlace) {
  const std::string corners = "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\n";
  EXPECT_EQ(refusal("bad.obj", corners + "f 1 2 5\n"), "5:7 vertex 5 is not there: 4 stand before this line");
  EXPECT_EQ(refusal("bad.obj", corners + "f 1 2 0\n"), "5:7 vertex 0 is not there: 4 stand before this line");
  EXPECT_EQ(refusal("bad.obj", corners + "f 1 2 -5\n"),
            "5:7 vertex -5 is not there: 4 stand before this line");
  EXPECT_EQ(refusal("bad.obj", corners + "f 1 2 x\n"), "5:7 'x' is no number of a vertex");
  EXPECT_EQ(refusal("bad.obj", corners + "f 1 2 3/1/1/1\n"), "5:7 '3/1/1/1' is no corner of a face");
  EXPECT_EQ(refusal("bad.obj", corners + "f 1 2\n"), "5:6 a face of 2 corners");
  EXPECT_EQ(refusal("bad.obj", corners + "f 1 3 2 4\n"), "5:10 this face of 4 corners crosses itself");
  EXPECT_EQ(refusal("bad.obj", corners + "face 1 2 3\n"), "5:1 'face' is no word of an OBJ file");
  EXPECT_EQ(refusal("bad.obj", corners + "surf 0 1 0 1 1 2 3\n"),
            "5:1 'surf' belongs to free-form geometry, which is not read");
  EXPECT_EQ(refusal("bad.obj", "v 0 1e300 0\n"),
            "1:5 y is 1e+300 mm, beyond the 1e+06 mm that a mesh may reach");
  EXPECT_EQ(refusal("bad.obj", "v 0 0\n"), "1:6 the line ends where z should stand");
  EXPECT_EQ(refusal("bad.obj", corners), "0:0 the mesh has no triangles");
}

TEST_F(MeshReaders, FilesTooLargeAreRefusedUnread) {
  const std::string path = with_bytes("huge.ply", "ply\n");
  fs::resize_file(path, uint64_t{1} << 40U);  // a hole: takes no space
  EXPECT_THROW(load_mesh(path), InputError);
}

double area_of(const std::vector<std::array<uint32_t, 3>>& triangles,
               const std::vector<std::array<float, 3>>& p) {
  double area = 0.0;
  for (const auto& t : triangles) {
    area += 0.5 * ((p[t[1]][0] - p[t[0]][0]) * (p[t[2]][1] - p[t[0]][1]) -
                   (p[t[1]][1] - p[t[0]][1]) * (p[t[2]][0] - p[t[0]][0]));
  }
  return area;
}

TEST(Polygons, OfManyShapesAreCoveredOnce) {
  struct Case {
    const char* name;
    std::vector<std::array<float, 3>> points;
    double area;
  };
  const std::vector<Case> cases{
      {"dart", {{0, 0, 0}, {4, 2, 0}, {0, 4, 0}, {1, 2, 0}}, 6.0},
      {"L", {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}}, 7.0},
      {"corners in line", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}}, 4.0},
      {"U", {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, 7.0},
      {"hole with a bridge",
       {{0, 0, 0},
        {4, 0, 0},
        {4, 4, 0},
        {0, 4, 0},
        {0, 0, 0},
        {1, 1, 0},
        {1, 3, 0},
        {3, 3, 0},
        {3, 1, 0},
        {1, 1, 0}},
       12.0}};
  for (const Case& one : cases) {
    for (size_t turn = 0; turn < one.points.size(); ++turn) {
      auto points = one.points;
      std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(turn), points.end());
      std::vector<uint32_t> corners(points.size());
      for (uint32_t i = 0; i < corners.size(); ++i) corners[i] = i;
      std::vector<std::array<uint32_t, 3>> triangles;
      ASSERT_TRUE(append_polygon(corners, points, triangles)) << one.name << " from corner " << turn;
      EXPECT_EQ(triangles.size(), points.size() - 2) << one.name;
      EXPECT_EQ(area_of(triangles, points), one.area) << one.name << " from corner " << turn;
      for (const auto& t : triangles) EXPECT_GE(area_of({t}, points), 0.0) << one.name;
      // The other way round, seen from below: the same area with the other sign.
      std::reverse(corners.begin(), corners.end());
      triangles.clear();
      ASSERT_TRUE(append_polygon(corners, points, triangles)) << one.name;
      EXPECT_EQ(area_of(triangles, points), -one.area) << one.name;
    }
  }
}

}  // namespace
}  // namespace swarf::mesh

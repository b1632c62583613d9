// Raw stocks of other shapes than a box, on the shipped program: volumes in closed form, the second clamping,
// and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "mesh/mesh_io.h"
#include "support/json_path.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace raw_stock_scene_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::TriMesh;
using swarf::test::at_path;
using swarf::test::run_swarf;
using swarf::test::write_text;

/// A cross of two slots, 6 wide and 5 deep, through the middle and out of any stock of 40 mm.
const char* const kCross =
    "G21 G17 G90 G94 G54\nT1 M6\nS8000 M3\nG0 X-30 Y0\nZ2\nG1 Z-5 F2000\nX30\nG0 Z10\nX0 Y-30\nG1 Z-5\nY30\n"
    "G0 Z20\nM5\nM2\n";

/// Its first slot alone.
const char* const kSlot =
    "G21 G17 G90 G94 G54\nT1 M6\nS8000 M3\nG0 X-30 Y0\nZ2\nG1 Z-5 F2000\nX30\nG0 Z20\nM5\nM2\n";

/// A folder with a scene whose [stock] holds `stock`, and cross.ngc.
fs::path scene_with(const std::string& name, const std::string& stock) {
  const fs::path folder = swarf::test::fresh_folder("raw_" + name);
  write_text(folder / "cross.ngc", kCross);
  write_text(folder / "scene.toml",
             "nc = \"cross.ngc\"\ndialect = \"linuxcnc\"\ntools = \"T1=6\"\n[setup]\nwork_origin_mm = "
             "\"on_table\"\nwithout_length = \"tip\"\n[stock]\nvoxel_mm = 0.4\n" +
                 stock + "\n[movie]\nseconds = 0\n");
  return folder;
}

swarf::test::ProgramRun run_in(const fs::path& folder, const std::string& more = "") {
  return run_swarf("run " + (folder / "scene.toml").string() + " --no-render -q -o " +
                   (folder / "out").string() + " " + more);
}

json metrics_of(const fs::path& folder) {
  return json::parse(std::ifstream(folder / "out/metrics.json"));
}

double number(const json& metrics, const char* path) {
  return at_path(metrics, path).get<double>();
}

TEST(RawStockScene, CylinderAndTubeHaveTheirVolumesInClosedForm) {
  const double bar = M_PI * 20.0 * 20.0 * 15.0, bore = M_PI * 8.0 * 8.0 * 15.0;
  // Where the slot leaves the bar its end is round: 2 (strip of the disc) - middle, 5 deep.
  const auto strip = [](double r) {
    return 2.0 * (3.0 * std::sqrt(r * r - 9.0) + r * r * std::asin(3.0 / r));
  };
  const double middle = 36.0;
  const double slots = 5.0 * (2.0 * strip(20.0) - middle);
  const double in_bore = 5.0 * (2.0 * strip(8.0) - middle);
  struct Case {
    const char *name, *keys;
    double volume, removed;
  };
  for (const Case& one :
       {Case{"cylinder", "cylinder = { diameter_mm = 40, length_mm = 15, base_mm = [0, 0, -15] }", bar,
             slots},
        Case{"tube", "tube = { diameter_mm = 40, inner_diameter_mm = 16, length_mm = 15, axis = [0, 0, -1] }",
             bar - bore, slots - in_bore}}) {
    const fs::path folder = scene_with(one.name, one.keys);
    const auto run = run_in(folder);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const json metrics = metrics_of(folder);
    EXPECT_NEAR(number(metrics, "stock.raw.volume_mm3"), one.volume, 1e-9 * one.volume) << one.name;
    EXPECT_NEAR(number(metrics, "stock.volume_removed_mm3") + number(metrics, "stock.volume_left_mm3"),
                one.volume, 1e-9 * one.volume);
    EXPECT_NEAR(number(metrics, "stock.volume_removed_mm3"), one.removed, 3e-3 * one.removed) << one.name;
    EXPECT_LT(std::abs(number(metrics, "stock.volume_removed_mm3") - one.removed),
              number(metrics, "stock.volume_error_bound_mm3"));
    fs::remove_all(folder);
  }
}

TEST(RawStockScene, TheSecondClampingBeginsWithWhatTheFirstHasLeft) {
  const fs::path first = scene_with("first", "box_mm = [[-20, -20, -15], [20, 20, 0]]");
  write_text(first / "cross.ngc", kSlot);
  ASSERT_EQ(run_in(first).exit_code, 0);
  const double left = number(metrics_of(first), "stock.volume_left_mm3");
  // Turned over about X, its lower face becomes the upper one.
  const fs::path second = scene_with(
      "second", "from_run = \"" + (first / "out").string() +
                    "\"\nfrom_run_pose = { position_mm = [0, 0, -15], rotation_deg = [180, 0, 0] }");
  write_text(second / "cross.ngc", kSlot);
  const auto run = run_in(second);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json metrics = metrics_of(second);
  EXPECT_EQ(number(metrics, "stock.raw.volume_mm3"), 40.0 * 40.0 * 15.0) << "the first one's, turned";
  EXPECT_NEAR(number(metrics, "stock.volume_left_mm3") + number(metrics, "stock.volume_removed_mm3"), left,
              1e-4 * left)
      << "of what it left, on another grid";
  // The same slot once more, from the other side.
  const double slot = 5.0 * 40.0 * 6.0;
  EXPECT_NEAR(number(metrics, "stock.volume_removed_mm3"), slot, 3e-3 * slot);
  EXPECT_NE(at_path(metrics, "stock.earlier.cuts").get<std::string>().find("sweeps"), std::string::npos);
  EXPECT_TRUE(fs::exists(second / "out/input/earlier_run/stock.vdb"));
  fs::remove_all(first);
  fs::remove_all(second);
}

TEST(RawStockScene, AResumedAndAReplayedRunEndAsThePlainOne) {
  const fs::path folder =
      scene_with("resumed", "cylinder = { diameter_mm = 40, length_mm = 15, base_mm = [0, 0, -15] }");
  ASSERT_EQ(run_in(folder, "--record --save-stock-after 7").exit_code, 0);
  const json plain = metrics_of(folder);
  const fs::path out = folder / "out";
  const auto replayed = run_swarf("replay " + (out / "run.record").string());
  EXPECT_EQ(replayed.exit_code, 0) << replayed.output;
  const auto resumed =
      run_swarf("run " + (folder / "scene.toml").string() + " --no-render -q -o " +
                (folder / "again").string() + " --from " + (out / "stock_after_line_7.vdb").string());
  EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
  const json again = json::parse(std::ifstream(folder / "again/metrics.json"));
  EXPECT_EQ(at_path(plain, "stock.hash"), at_path(again, "stock.hash"));
  const auto other = run_swarf("run " + (folder / "scene.toml").string() + " --no-render -q -o " +
                               (folder / "other").string() + " --set stock.cylinder.length_mm=16 --from " +
                               (out / "stock_after_line_7.vdb").string());
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.output.find("another raw stock"), std::string::npos) << other.output;
  fs::remove_all(folder);
}

TEST(RawStockScene, TheCommandLineSaysBarsTubesAndMeshes) {
  const fs::path folder = scene_with("words", "");
  swarf::mesh::save_mesh((folder / "casting.stl").string(), swarf::test::block({-20, -20, -15}, {20, 20, 0}));
  for (const auto& [words, text] : {std::pair{std::string("cyl,40,15"), "cylinder D 40 mm, 15 mm long"},
                                    std::pair{std::string("tube,40,16,15"), "tube D 40 and 16 mm"},
                                    std::pair{(folder / "casting.stl").string(), "mesh casting.stl of 12"}}) {
    const auto run = run_swarf("run " + (folder / "cross.ngc").string() +
                               " --tool 6 --voxel 0.8 --no-render -q"
                               " --stock " +
                               words + " -o " + (folder / "out").string());
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const std::string shape = at_path(metrics_of(folder), "stock.raw.shape").get<std::string>();
    EXPECT_NE(shape.find(text), std::string::npos) << shape;
  }
  const auto wrong = run_swarf("run " + (folder / "cross.ngc").string() + " --tool 6 --stock cyl,40");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.output.find("bad-stock"), std::string::npos) << wrong.output;
  fs::remove_all(folder);
}

TEST(RawStockScene, InchesMetresAndATurnBringAMeshToItsPlace) {
  const fs::path folder = scene_with(
      "units",
      "mesh = \"a.stl\"\nmesh_unit = \"m\"\nmesh_position_mm = [0, 0, -15]\nmesh_rotation_deg = [0, 0, 90]");
  TriMesh mesh = swarf::test::block({-20, -15, 0}, {20, 15, 15});
  swarf::test::scale(mesh, 1e-3);
  swarf::mesh::save_mesh((folder / "a.stl").string(), mesh);
  const auto run = run_in(folder);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json box = at_path(metrics_of(folder), "stock.raw.box_mm");
  EXPECT_NEAR(box[0][0].get<double>(), -15.0, 1e-5);
  EXPECT_NEAR(box[0][1].get<double>(), -20.0, 1e-5);
  EXPECT_NEAR(box[1][2].get<double>(), 0.0, 1e-5);
  fs::remove_all(folder);
}

struct BadStock {
  const char *name, *keys, *code, *text;
};

TEST(RawStockScene, WhatIsNoStockIsRefusedWithItsPlace) {
  const std::vector<BadStock> cases{
      {"two", "box_mm = [[0, 0, 0], [1, 1, 1]]\nmesh = \"good.stl\"", "two-shapes", "'box_mm' in line 9"},
      {"open", "mesh = \"open.stl\"", "mesh-open", "the first from ("},
      {"inverted", "mesh = \"inverted.stl\"", "mesh-inverted", "inside out"},
      {"crossing", "mesh = \"crossing.stl\"", "mesh-self-crossing", "the first at ("},
      {"metres", "mesh = \"metres.stl\"", "mesh-unit-suspicious", "stock.mesh_unit = \"m\""},
      {"inches", "mesh = \"inches.stl\"", "mesh-unit-suspicious", "stock.mesh_unit = \"inch\""},
      {"two_units", "mesh = \"good.3mf\"\nmesh_unit = \"inch\"", "unit-twice", "scene.toml:10:"},
      {"no_file", "mesh = \"none.stl\"", "mesh-not-found", "none.stl"},
      {"no_run", "from_run = \"nowhere\"", "not-a-run", "nowhere"},
      {"no_such_stock", "from_run = \"nowhere/stock_after_line_7.vdb\"", "from-run-unfinished",
       "in the middle"},
      {"zero", "cylinder = { diameter_mm = 0, length_mm = 10 }", "out-of-range", "scene.toml:9:"},
      {"no_length", "cylinder = { diameter_mm = 10 }", "missing-key", "length_mm"},
      {"no_wall", "tube = { diameter_mm = 10, inner_diameter_mm = 10, length_mm = 5 }", "out-of-range",
       "no wall"},
      {"no_axis", "cylinder = { diameter_mm = 10, length_mm = 5, axis = [0, 0, 0] }", "out-of-range",
       "no direction"},
      {"flat", "outline = { points_mm = [[0, 0], [9, 0], [9, 9]], z_mm = [1, 1] }", "out-of-range",
       "0 mm high"},
      {"two_corners", "outline = { points_mm = [[0, 0], [9, 0]], z_mm = [0, 1] }", "out-of-range",
       "2 corners"},
      {"bow", "outline = { points_mm = [[0, 0], [9, 9], [9, 0], [0, 9]], z_mm = [-5, 0] }",
       "outline-crosses-itself", "(9.000, 0.000)"},
      {"misses", "cylinder = { diameter_mm = 10, length_mm = 5, base_mm = [200, 0, -5] }",
       "path-misses-stock", "stock.cylinder moves"}};
  for (const BadStock& bad : cases) {
    const fs::path folder = scene_with(bad.name, bad.keys);
    const TriMesh good = swarf::test::block({-20, -20, -15}, {20, 20, 0});
    const auto save = [&](const char* name, const TriMesh& mesh) {
      swarf::mesh::save_mesh((folder / name).string(), mesh);
    };
    save("good.stl", good);
    save("good.3mf", good);
    TriMesh mesh = good;
    mesh.triangles.pop_back();
    save("open.stl", mesh);
    mesh = good;
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    save("inverted.stl", mesh);
    mesh = good;
    swarf::test::append(mesh, swarf::test::block({10, 10, -10}, {30, 30, -5}));
    save("crossing.stl", mesh);
    mesh = good;
    swarf::test::scale(mesh, 1e-3);
    save("metres.stl", mesh);
    mesh = good;
    swarf::test::scale(mesh, 0.1);
    save("inches.stl", mesh);
    const auto run = run_in(folder);
    EXPECT_NE(run.output.find(bad.code), std::string::npos) << bad.name << ": " << run.output;
    EXPECT_NE(run.output.find(bad.text), std::string::npos) << bad.name << ": " << run.output;
    if (std::string(bad.code) != "mesh-unit-suspicious") {
      EXPECT_EQ(run.exit_code, 2) << bad.name << run.output;
    }
    fs::remove_all(folder);
  }
}

TEST(RawStockScene, AWallThinnerThanAVoxelIsTold) {
  const fs::path folder = scene_with("thin", "mesh = \"thin.stl\"");
  swarf::mesh::save_mesh((folder / "thin.stl").string(),
                         swarf::test::towers({-20, -19.7, 20}, {-20, 20}, -15.0,
                                             [](int i, int) { return i == 0 ? 0.0 : -3.0; }));
  const auto run =
      run_swarf("run " + (folder / "scene.toml").string() + " --no-render -o " + (folder / "out").string());
  EXPECT_NE(run.output.find("stock-wall-thin"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("a wall of 0.3 mm at ("), std::string::npos) << run.output;
  fs::remove_all(folder);
}

/// A block 20 x 20 x 10 mm, its top at z = 0; its raw stock, a mesh, may hold a closed void 2.5 deep in it.
TEST(RawStockScene, AVoidOfTheStockWithinTheDesignIsAGouge) {
  for (const bool is_hollow : {false, true}) {
    const fs::path folder = swarf::test::fresh_folder(is_hollow ? "raw_void" : "raw_solid");
    swarf::mesh::save_mesh((folder / "part.stl").string(), swarf::test::block({-10, -10, -10}, {10, 10, 0}));
    TriMesh raw = swarf::test::block({-10, -10, -10}, {10, 10, 1});
    if (is_hollow) {
      const TriMesh hole = swarf::test::block({-2, -2, -5}, {2, 2, -2.5});
      const auto first = static_cast<uint32_t>(raw.positions.size());
      raw.positions.insert(raw.positions.end(), hole.positions.begin(), hole.positions.end());
      for (const auto& t : hole.triangles)
        raw.triangles.push_back({first + t[0], first + t[2], first + t[1]});
    }
    swarf::mesh::save_mesh((folder / "raw.stl").string(), raw);
    write_text(folder / "face.ngc",
               "G21 G17 G90 G94 G54\nT1 M6\nS8000 M3\nG0 X-30 Y0\nZ5\nG1 Z0 F2000\nX30\nG0 Z20\nM5\nM2\n");
    write_text(folder / "scene.toml",
               "nc = \"face.ngc\"\ndialect = \"linuxcnc\"\ntools = \"T1=30\"\n[setup]\nwork_origin_mm = "
               "\"on_table\"\nwithout_length = \"tip\"\n[stock]\nvoxel_mm = 0.4\nmesh = \"raw.stl\"\n"
               "[design]\nmesh = \"part.stl\"\n[accept]\ngouge_max_um = 2\nexcess_max_um = 10\n[movie]\n"
               "seconds = 0\n");
    const swarf::test::ProgramRun run = run_in(folder);
    EXPECT_EQ(run.exit_code, is_hollow ? 1 : 0) << run.output;
    const json metrics = metrics_of(folder);
    EXPECT_NEAR(number(metrics, "surface.gouge_max_um"), is_hollow ? 5000.0 : 0.0, is_hollow ? 6.0 : 1.0);
  }
}

}  // namespace
}  // namespace raw_stock_scene_test

// swarf compare STOCK DESIGN with pairs whose answers are known: twelve wrong ones in both directions, twelve
// right ones, and what is refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "mesh/mesh_io.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace compare_test {
namespace {

using nlohmann::json;
using swarf::TriMesh;
using swarf::Vec3;
using swarf::test::block;
using swarf::test::towers;

constexpr double kFloat = 0.01;  // um: floats of 30 mm, as STL has them

const std::vector<double> kLines{-20, -10, -2.5, 2.5, 10, 20};

TriMesh plate(double middle) {
  return towers(kLines, kLines, 0.0, [&](int i, int j) { return i == 2 && j == 2 ? middle : 10.0; });
}
TriMesh pocketed(double floor) {
  return towers(kLines, kLines, 0.0,
                [&](int i, int j) { return i > 0 && i < 4 && j > 0 && j < 4 ? floor : 10.0; });
}
/// A boss away from the middle: its mirror image is another part.
TriMesh handed() {
  return towers(kLines, kLines, 0.0, [&](int i, int j) { return i == 3 && j == 1 ? 15.0 : 10.0; });
}
TriMesh mirrored(TriMesh mesh) {
  swarf::test::mirror(mesh);
  return mesh;
}
TriMesh two_bodies(double second_height) {
  TriMesh mesh = block({-20, -20, 0}, {-5, 20, 10});
  swarf::test::append(mesh, block({5, -20, 0}, {20, 20, second_height}));
  return mesh;
}
TriMesh with_wall(double height) {
  return towers({-20, -0.05, 0.05, 20}, {-20, -10, 10, 20}, 0.0,
                [&](int i, int j) { return i == 1 && j == 1 ? 10.0 + height : 10.0; });
}
/// A strip of facets a thousand times longer than wide.
TriMesh needles(double top) {
  std::vector<double> x{-20.0};
  for (int i = 0; i <= 20; ++i) x.push_back(-0.4 + 0.04 * i);
  x.push_back(20.0);
  return towers(x, {-20, 20}, 0.0, [&](int, int) { return top; });
}

class Compare : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder(std::string("compare_") +
                                        testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const TriMesh& mesh) {
    const std::string path = (folder_ / name).string();
    swarf::mesh::save_mesh(path, mesh);
    return path;
  }
  swarf::test::ProgramRun run(const TriMesh& stock, const TriMesh& design, const std::string& options) {
    return swarf::test::run_swarf("compare " + file("stock.stl", stock) + " " + file("design.stl", design) +
                                  " " + options + " --pitch-mm 0.8");
  }
  json measure(const TriMesh& stock, const TriMesh& design, const std::string& options, int exit_code) {
    const auto result = run(stock, design, "--json " + options);
    EXPECT_EQ(result.exit_code, exit_code) << result.output;
    return result.exit_code < 2 ? json::parse(result.output) : json{};
  }

  /// Wrong either way round: excess and gouge change places.
  void expect_wrong(const char* name, const TriMesh& more, const TriMesh& less, double depth_um,
                    double volume_mm3) {
    for (const bool swapped : {false, true}) {
      SCOPED_TRACE(std::string(name) + (swapped ? ", too little" : ", too much"));
      const json result = swapped ? measure(less, more, "", 1) : measure(more, less, "", 1);
      if (result.empty()) continue;
      const std::string kind = swapped ? "gouge" : "excess", volume = kind + "_mm3";
      EXPECT_EQ(result["verdict"], "findings");
      EXPECT_NEAR(result["surface"][kind + "_max_um"].get<double>(), depth_um, 0.1 + kFloat);
      EXPECT_GE(result["surface"][kind + "_bound_um"].get<double>(), depth_um - kFloat);
      EXPECT_NEAR(result["volume"][volume].get<double>(), volume_mm3, 0.01 * volume_mm3);
      EXPECT_NEAR(std::abs(result["volume"]["difference_mm3"].get<double>()), volume_mm3, 0.01 * volume_mm3);
      double listed = 0.0;
      for (const auto& region : result["surface"]["regions"]) listed += region["volume_mm3"].get<double>();
      EXPECT_NEAR(listed, volume_mm3, 0.01 * volume_mm3);
      EXPECT_EQ(result["surface"]["unmeasured_area_mm2"], 0.0);
    }
  }

  std::filesystem::path folder_;
};

TEST_F(Compare, TellsTwelveWrongPairsInBothDirections) {
  const TriMesh solid = block({-20, -20, 0}, {20, 20, 10});
  expect_wrong("pocket not cut", solid, pocketed(6.0), 4000.0, 1600.0);
  expect_wrong("boss of 5 mm", plate(15.0), plate(10.0), 5000.0, 125.0);
  expect_wrong("hole of 5 mm", plate(10.0), plate(7.0), 3000.0, 75.0);
  expect_wrong("pocket floor .02 high", pocketed(6.02), pocketed(6.0), 20.0, 8.0);
  expect_wrong("top .02 high", block({-20, -20, 0}, {20, 20, 10.02}), solid, 20.0, 32.0);
  expect_wrong("one of two bodies", two_bodies(10.0), block({-20, -20, 0}, {-5, 20, 10}), 25000.0, 6000.0);
  expect_wrong("second body .05 high", two_bodies(10.05), two_bodies(10.0), 50.0, 30.0);
  expect_wrong("thin plate", block({-20, -20, 0}, {20, 20, 0.25}), block({-20, -20, 0}, {20, 20, 0.2}), 50.0,
               80.0);
  expect_wrong("wall .1 x 3 x 20 mm", with_wall(3.0), with_wall(0.0), 3000.0, 6.0);
  expect_wrong("a body inside the other", solid, block({-5, -5, 3}, {5, 5, 7}), std::sqrt(459.0) * 1e3,
               15600.0);
  expect_wrong("needles .02 high", needles(10.02), needles(10.0), 20.0, 32.0);
  expect_wrong("needles against a block", needles(10.02), solid, 20.0, 32.0);
}

TEST_F(Compare, TellsAMirrorImage) {
  const json result = measure(handed(), mirrored(handed()), "", 1);
  EXPECT_NEAR(result["surface"]["excess_max_um"].get<double>(), 5000.0, 0.1);
  EXPECT_NEAR(result["surface"]["gouge_max_um"].get<double>(), 5000.0, 0.1);
  EXPECT_NEAR(result["volume"]["difference_mm3"].get<double>(), 0.0, 1e-3);
}

TEST_F(Compare, PassesTwelveRightPairs) {
  const TriMesh solid = block({-20, -20, 0}, {20, 20, 10});
  const auto expect_right = [&](const char* name, const TriMesh& stock, const TriMesh& design,
                                const std::string& options) {
    SCOPED_TRACE(name);
    const json result = measure(stock, design, options, 0);
    if (result.empty()) return;
    EXPECT_EQ(result["verdict"], "pass");
    for (const auto& check : result["checks"]) {
      EXPECT_EQ(check["outcome"], "holds") << check.dump();
      if (check["bound"].is_number()) {
        EXPECT_LE(check["bound"], check["limit"]);
      }
    }
  };
  expect_right("itself, a nanometre allowed", plate(15.0), plate(15.0), "--excess-um .001 --gouge-um .001");
  expect_right("other facets", plate(10.0), solid, "--excess-um .1 --gouge-um .1");
  expect_right("top .008 high", block({-20, -20, 0}, {20, 20, 10.008}), solid, "");
  expect_right("top .0008 low", block({-20, -20, 0}, {20, 20, 9.9992}), solid, "");
  expect_right("pocket floor .008 high", pocketed(6.008), pocketed(6.0), "");
  expect_right("mirror image of a symmetric part", mirrored(pocketed(6.0)), pocketed(6.0),
               "--excess-um .1 --gouge-um .1");
  expect_right("two bodies", two_bodies(10.0), two_bodies(10.0), "--excess-um .001 --gouge-um .001");
  expect_right("thin plate", block({-20, -20, 0}, {20, 20, 0.205}), block({-20, -20, 0}, {20, 20, 0.2}), "");
  expect_right("allowance of .3 mm", block({-20.3, -20.3, -0.3}, {20.3, 20.3, 10.3}), solid,
               "--allowance-mm .3 --excess-um 220");
  expect_right("needles", needles(10.008), solid, "");
  expect_right("sphere shifted by 7 um", swarf::test::sphere(25, {0.007, 0, 0}, 200, 100),
               swarf::test::sphere(25, {0, 0, 0}, 200, 100), "--excess-um 7.1 --gouge-um 7.1");
  expect_right("torus shifted by 7 um", swarf::test::torus(30, 10, {0, 0, 0.007}, 200, 80),
               swarf::test::torus(30, 10, {0, 0, 0}, 200, 80), "--excess-um 7.1 --gouge-um 7.1");
}

TEST_F(Compare, RefusesWhatCannotBeCompared) {
  const TriMesh solid = block({-20, -20, 0}, {20, 20, 10});
  const auto expect_refused = [&](const TriMesh& stock, const TriMesh& design, const char* code) {
    const auto result = run(stock, design, "");
    EXPECT_EQ(result.exit_code, 2) << code << "\n" << result.output;
    EXPECT_NE(result.output.find(code), std::string::npos) << result.output;
  };
  TriMesh open = solid, inverted = solid, inches = solid, metres = solid, far = solid;
  open.triangles.pop_back();
  for (auto& t : inverted.triangles) std::swap(t[1], t[2]);
  swarf::test::scale(inches, 1.0 / 25.4);
  swarf::test::scale(metres, 1e-3);
  for (auto& p : far.positions) p[0] += 100.0F;
  TriMesh crossing = block({-20, -20, 0}, {5, 20, 10}), doubled = solid;
  swarf::test::append(crossing, block({-5, -10, 2}, {20, 10, 8}));
  swarf::test::append(doubled, solid);
  // A face in another; a body in a body; a cavity where no body is.
  TriMesh covered = solid, nested = solid, beside = solid, cavity = block({30, 0, 0}, {35, 5, 5});
  swarf::test::append(covered, block({-5, -5, 5}, {5, 5, 10}));
  swarf::test::append(nested, block({-5, -5, 3}, {5, 5, 7}));
  for (auto& t : cavity.triangles) std::swap(t[1], t[2]);
  swarf::test::append(beside, cavity);
  for (const auto& [bad, code] :
       std::vector<std::pair<TriMesh, const char*>>{{open, "mesh-open"},
                                                    {inverted, "mesh-inverted"},
                                                    {inches, "looks-like-inches"},
                                                    {metres, "looks-like-metres"},
                                                    {far, "boxes-apart"},
                                                    {crossing, "mesh-self-crossing"},
                                                    {doubled, "mesh-non-manifold"},
                                                    {covered, "mesh-self-crossing"},
                                                    {nested, "mesh-nested-bodies"},
                                                    {beside, "mesh-nested-bodies"}}) {
    expect_refused(bad, solid, code);
    expect_refused(solid, bad, code);
  }
}

/// A strip that a cut through the plate has set free.
TEST_F(Compare, APieceThatIsCutLooseIsTold) {
  TriMesh cut = block({-20, -20, 0}, {10, 20, 10});
  swarf::test::append(cut, block({10.004, -20, 0}, {20, 20, 10}));
  const json loose = measure(cut, block({-20, -20, 0}, {20, 20, 10}), "--gouge-um 5000", 1);
  ASSERT_EQ(loose["pieces"]["loose"].size(), 1U) << loose["pieces"];
  EXPECT_NEAR(loose["pieces"]["loose"][0]["volume_mm3"].get<double>(), 3998.4, 0.1);
  EXPECT_NEAR(loose["pieces"]["loose"][0]["place_mm"][0].get<double>(), 15.002, 1e-3);
  const auto told = run(cut, block({-20, -20, 0}, {20, 20, 10}), "--gouge-um 5000");
  EXPECT_NE(told.output.find("2 pieces, the design is 1: loose is 3998 mm3 around (15.002, 0.000, 5.000) mm"),
            std::string::npos)
      << told.output;
  EXPECT_EQ(measure(two_bodies(10.0), two_bodies(10.0), "", 0)["pieces"]["loose"].size(), 0U);
}

TEST_F(Compare, RefusesLimitsOfZeroAndDesignsWithoutThickness) {
  const TriMesh solid = block({-20, -20, 0}, {20, 20, 10});
  TriMesh sheet;
  swarf::test::add_quad(sheet, {-20, -20, 5}, {20, -20, 5}, {20, 20, 5}, {-20, 20, 5});
  swarf::test::add_quad(sheet, {-20, -20, 5}, {-20, 20, 5}, {20, 20, 5}, {20, -20, 5});
  for (const auto& [design, options] :
       {std::pair{solid, "--excess-um 0"}, {solid, "--gouge-um 0"}, {sheet, ""}}) {
    const auto refused = run(solid, design, options);
    EXPECT_EQ(refused.exit_code, 2) << options << refused.output;
  }
}

TEST_F(Compare, RefusesAPitchWhoseSamplesWouldFillTheMemory) {
  const std::string files = file("a.stl", plate(10.0)) + " " + file("b.stl", plate(10.0));
  const auto refused = swarf::test::run_swarf("compare " + files + " --pitch-mm 1e-9");
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("[pitch-too-fine]"), std::string::npos) << refused.output;
}

/// It has nothing to keep, so it ends where it stands: it went on to its end.
TEST_F(Compare, OneInterruptEndsIt) {
  const std::string files = file("a.stl", plate(10.0)) + " " + file("b.stl", plate(10.0));
  const auto stopped = swarf::test::run_command("timeout -s INT 0.3 " + std::string(SWARF_PROGRAM) +
                                                " compare " + files + " --pitch-mm 0.04");
  EXPECT_EQ(stopped.exit_code, 124) << stopped.output;
  EXPECT_EQ(stopped.output.find("PASS"), std::string::npos) << stopped.output;
}

TEST_F(Compare, RefusesFilesOfCadPrograms) {
  const std::string solid = file("solid.stl", block({-20, -20, 0}, {20, 20, 10}));
  for (const char* name : {"part.step", "part.STP", "part.igs"}) {
    const std::string cad = (folder_ / name).string();
    swarf::test::write_text(cad, "ISO-10303-21;\nHEADER;\nENDSEC;\nEND-ISO-10303-21;\n");
    for (const std::string& pair : {cad + " " + solid, solid + " " + cad}) {
      const auto result = swarf::test::run_swarf("compare " + pair);
      EXPECT_EQ(result.exit_code, 2) << result.output;
      const bool as_stock = pair.starts_with(cad);
      EXPECT_NE(result.output.find(as_stock ? "[cad-format]" : "[cad-"), std::string::npos) << result.output;
    }
  }
}

TEST_F(Compare, WritesMapsThatShowTheWorstPlaces) {
  const std::string out = (folder_ / "out").string();
  measure(plate(10.0), plate(15.0), "-o " + out, 1);
  const json metrics = json::parse(swarf::test::read_text(out + "/metrics.json"));
  EXPECT_EQ(metrics["surface"]["region_count"], 1);
  for (const char* name : {"deviation.ply", "deviation.png", "design.ply", "design.png"})
    EXPECT_GT(std::filesystem::file_size(out + "/" + name), 1000U) << name;
}

}  // namespace

}  // namespace compare_test

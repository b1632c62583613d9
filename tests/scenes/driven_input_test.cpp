// Bad input of [driven] scenes on the shipped program: exit 2 with the key or the place and what to do,
// before anything moves, and no output folder.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/program_run.h"

namespace driven_input_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::run_swarf;

/// Overrides of scenes/kato_step, or of one guide over the same part.
struct BadDriven {
  const char* name;
  const char* set;
  const char* code;
  const char* told;  ///< must be printed
  bool guide = false;
};

void PrintTo(const BadDriven& bad, std::ostream* out) {
  *out << bad.name;
}

class DrivenInput : public testing::TestWithParam<BadDriven> {};

TEST_P(DrivenInput, IsRefusedBeforeAnythingMoves) {
  const BadDriven& bad = GetParam();
  const fs::path folder = swarf::test::fresh_folder(std::string("driven_") + bad.name);
  std::string scene = SWARF_SOURCE_DIR "/scenes/kato_step/scene.toml";
  if (bad.guide) {
    std::string text = swarf::test::read_text(scene);
    const std::string scan = "mode = \"scan\"\ninterval_mm = 3\n";
    const auto at = text.find(scan);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, scan.size(), "mode = \"guide\"\nguide_mm = [[-20, 0], [20, 0]]\n");
    fs::copy(SWARF_SOURCE_DIR "/scenes/kato_step/step.nc", folder / "step.nc");
    scene = (folder / "scene.toml").string();
    swarf::test::write_text(scene, text);
  }
  const auto run = run_swarf("run " + scene + " --no-render -q -o " + (folder / "out").string() + " --set '" +
                             bad.set + "'");
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find(std::string("[") + bad.code + "]"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find(bad.told), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
  EXPECT_FALSE(fs::exists(folder / "out"));
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, DrivenInput,
    testing::Values(
        BadDriven{"feed", "driven.feed_mm_min=0", "out-of-range", "'driven.feed_mm_min' is 0"},
        BadDriven{"feed_negative", "driven.feed_mm_min=-5", "out-of-range", "'driven.feed_mm_min' is -5"},
        BadDriven{"feed_nan", "driven.feed_mm_min=nan", "out-of-range", "'driven.feed_mm_min' is nan"},
        BadDriven{"feed_of_months", "driven.feed_mm_min=1e-9", "too-many-cycles", "more than 1000 h"},
        BadDriven{"interval", "driven.interval_mm=0", "out-of-range", "'driven.interval_mm' is 0"},
        BadDriven{"period", "interpolator.period_ms=0", "out-of-range", "'interpolator.period_ms' is 0"},
        BadDriven{"period_negative", "interpolator.period_ms=-1", "out-of-range", "from 0.01 to 100"},
        BadDriven{"period_nan", "interpolator.period_ms=nan", "out-of-range", "from 0.01 to 100"},
        BadDriven{"period_of_a_second", "interpolator.period_ms=1000", "out-of-range", "from 0.01 to 100"},
        BadDriven{"tolerance", "driven.chord_tolerance_um=0", "out-of-range",
                  "'driven.chord_tolerance_um' is 0"},
        BadDriven{"two_parts", "driven.mesh=part.stl", "two-parts", "keep one of them"},
        BadDriven{"design_and_file", "driven.by_design=true", "two-parts", "keep one of them"},
        BadDriven{"no_part", "driven.surface=none.nc", "file-not-found", "none.nc"},
        BadDriven{"mode", "driven.mode=spin", "unknown-choice", "scan, contour, spiral, guide"},
        BadDriven{"area_turned", "driven.area_mm=[[5,5],[0,0]]", "out-of-range", "'area_mm' is no rectangle"},
        BadDriven{"area_elsewhere", "driven.area_mm=[[200,200],[210,210]]", "guide-misses-part",
                  "(200.000, 200.000) mm"},
        BadDriven{"comparison", "driven.compare_cam_um=[10,-1]", "out-of-range", "a tolerance of -1 um"},
        BadDriven{"angle", "driven.angle_deg=500", "out-of-range", "from -180 to 180"},
        BadDriven{"override", "driven.override=[[0,1,50]]", "out-of-range",
                  "'override' has the row [0, 1, 50]"},
        BadDriven{"held", "driven.override=[[2,1,0]]", "feed-held", "pass 2 is held and never goes on"},
        BadDriven{"override_without_pass", "driven.override=[[99,0,50]]", "override-no-pass",
                  "names pass 99, and there are 11"},
        BadDriven{"axis_without_length", "driven.axis=[0,0,0]", "out-of-range", "'axis' has no length"},
        BadDriven{"lead", "driven.lead_deg=90", "out-of-range", "from -89 to 89"},
        BadDriven{"axis_too_low", "driven.tilt_deg=88", "axis-too-low", "lead_deg or tilt_deg"},
        BadDriven{"key", "driven.angel_deg=5", "unknown-key", "did you mean 'angle_deg'?"},
        BadDriven{"one_point", "driven.guide_mm=[[0,0]]", "area-too-small", "the points of guide_mm", true},
        BadDriven{"no_way", "driven.guide_mm=[[0,0],[0,0]]", "area-too-small", "the points of guide_mm",
                  true},
        BadDriven{"off_the_part", "driven.guide_mm=[[0,0],[100,0]]", "guide-misses-part", "pass 1", true}),
    [](const testing::TestParamInfo<BadDriven>& one) { return std::string(one.param.name); });

// A ball rounder than the narrowest hollow is told before anything moves: where, and what ball fits. A
// cylinder of radius 4 from inside.
TEST(DrivenByDesign, AHollowTooNarrowForTheBallIsTold) {
  const fs::path folder = swarf::test::fresh_folder("driven_hollow");
  swarf::test::write_text(
      folder / "scene.toml",
      "machine = \"mill_3axis\"\n[cutter]\nnumber = 1\nshape = \"ball\"\ndiameter_mm = 10\nflute_length_mm = "
      "30\n"
      "shank_diameter_mm = 10\nlength_mm = 60\n[setup]\nwork_origin_mm = \"on_table\"\n"
      "[stock]\nbox_mm = [[-6, -4, -6], [6, 4, 1]]\nvoxel_mm = 0.4\n"
      "[driven]\nby_design = true\ninterval_mm = 2\nfeed_mm_min = 1500\narea_mm = [[-2, -3], [2, 3]]\n"
      "[design]\nkind = \"cylinder\"\nbase_mm = [0, -4, 0]\naxis = [0, 1, 0]\nradius_mm = 4\nheight_mm = 8\n"
      "side = \"concave\"\nangle_deg = [20, 160]\n");
  const auto run =
      run_swarf("run " + (folder / "scene.toml").string() + " --no-render -o " + (folder / "out").string());
  EXPECT_NE(run.output.find("[cutter-too-round]"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("a hollow of radius 4 mm at"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("touches everywhere inside the faces (proven)"), std::string::npos) << run.output;
  fs::remove_all(folder);
}

// Faces of a STEP file that leave a gap: a ball sinks into it, the flat bottom of a bull nose rides over it.
TEST(DrivenFaces, AGapIsToldWithItsPlaceBeforeAnythingMoves) {
  const fs::path folder = swarf::test::fresh_folder("driven_gap");
  std::string part = swarf::test::read_text(SWARF_SOURCE_DIR "/scenes/kato_mould/mould.stp");
  const std::string pole = "#206 = CARTESIAN_POINT('',(0.,-5.,1.));";
  ASSERT_NE(part.find(pole), std::string::npos);
  part.replace(part.find(pole), pole.size(), "#206 = CARTESIAN_POINT('',(0.,-5.,1.15));");
  swarf::test::write_text(folder / "mould.stp", part);
  std::string scene = swarf::test::read_text(SWARF_SOURCE_DIR "/scenes/kato_mould/scene.toml");
  swarf::test::write_text(folder / "bull.toml", scene);
  const std::string shape = "shape = \"bull_nose\"", corner = "corner_radius_mm = 1.5\n";
  scene.replace(scene.find(shape), shape.size(), "shape = \"ball\"");
  scene.erase(scene.find(corner), corner.size());
  swarf::test::write_text(folder / "ball.toml", scene);
  const auto bull = run_swarf("check " + (folder / "bull.toml").string());
  EXPECT_NE(bull.output.find("[part-gap]"), std::string::npos) << bull.output;
  EXPECT_NE(bull.output.find("the cutter rides over it"), std::string::npos) << bull.output;
  const auto ball = run_swarf("check " + (folder / "ball.toml").string());
  EXPECT_EQ(ball.exit_code, 2) << ball.output;
  EXPECT_NE(ball.output.find("[part-gap-wide]"), std::string::npos) << ball.output;
  EXPECT_NE(ball.output.find("mm apart at ("), std::string::npos) << ball.output;
  EXPECT_NE(ball.output.find("fix: "), std::string::npos) << ball.output;
  fs::remove_all(folder);
}

// A part of 42 m, its unit read as metres: facets of that chord would take more memory than there is.
TEST(DrivenFaces, APartInMetresIsRefusedBeforeItIsDivided) {
  const fs::path folder = swarf::test::fresh_folder("driven_metres");
  std::string part = swarf::test::read_text(SWARF_SOURCE_DIR "/scenes/kato_mould/mould.stp");
  const std::string unit = "SI_UNIT(.MILLI.,.METRE.)";
  part.replace(part.find(unit), unit.size(), "SI_UNIT($,.METRE.)");
  swarf::test::write_text(folder / "mould.stp", part);
  swarf::test::write_text(folder / "scene.toml",
                          swarf::test::read_text(SWARF_SOURCE_DIR "/scenes/kato_mould/scene.toml"));
  const auto run = run_swarf("check " + (folder / "scene.toml").string());
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find("[cad-too-fine]"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("42000 x 30000 x"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("unit metre = 1000 mm"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
  fs::remove_all(folder);
}

/// Two plates of 10 x 8 mm that lie side by side, as surface blocks; the second one farther along X and
/// higher.
std::string plates(double gap, double step) {
  std::ostringstream text;
  text << "G17 G21 G54 G90\n";
  for (int n = 1; n <= 2; ++n) {
    const double x = n == 1 ? 0.0 : 10.0 + gap, z = n == 1 ? 0.0 : step;
    text << "G10 L70 P" << n << " Q1 R1\nG10 L71 P" << n << " I0 J0 X" << x << " Y0 Z" << z << "\nG10 L71 P"
         << n << " I1 J0 X10 Y0 Z0\nG10 L71 P" << n << " I0 J1 X0 Y8 Z0\nG10 L79 P" << n << " D1\n";
  }
  return text.str();
}

// Surfaces that do not meet, and guides that leave them: what is refused, what is told, and where.
TEST(DrivenSurfaces, GapsStepsAndEndsAreToldBeforeAnythingMoves) {
  const fs::path folder = swarf::test::fresh_folder("driven_plates");
  const std::string ball = "shape = \"ball\"", flat = "shape = \"flat\"", area = "[[0, 0], [20, 8]]";
  const auto check = [&](double gap, double step, const std::string& shape, const std::string& driven) {
    swarf::test::write_text(folder / "part.nc", plates(gap, step));
    swarf::test::write_text(
        folder / "scene.toml",
        "machine = \"mill_3axis\"\n[cutter]\nnumber = 1\n" + shape +
            "\ndiameter_mm = 6\nflute_length_mm = 30\nshank_diameter_mm = 6\nlength_mm = 60\n"
            "[setup]\nwork_origin_mm = \"on_table\"\n[stock]\nbox_mm = [[0, 0, -10], [22, 8, 6]]\n"
            "voxel_mm = 0.5\n[driven]\nsurface = \"part.nc\"\ninterval_mm = 4\nfeed_mm_min = "
            "1500\n" +
            driven);
    return run_swarf("check " + (folder / "scene.toml").string());
  };
  const auto expect = [](const swarf::test::ProgramRun& run, int exit_code, const std::string& told) {
    EXPECT_EQ(run.exit_code, exit_code) << run.output;
    EXPECT_NE(run.output.find(told), std::string::npos) << told << "\n" << run.output;
  };
  const auto met = check(0, 0, ball, "area_mm = " + area);
  EXPECT_EQ(met.exit_code, 0) << met.output;
  EXPECT_EQ(met.output.find("warning:"), std::string::npos) << met.output;
  // A ball of radius 3 sinks by 3 - sqrt(8) mm into 2 mm.
  expect(check(2, 0, ball, "area_mm = " + area), 2,
         "surfaces 1 and 2 leave a gap of 2 mm at (10.000, 0.000, 0.000) mm: the tip sinks into it by up to "
         "172 um");
  expect(check(2, 0, ball, "floor_mm = -1\narea_mm = " + area), 0, "[part-gap-wide]");
  expect(check(2, 0, flat, "area_mm = " + area), 0, "the cutter rides over it");
  expect(check(0, 0.05, ball, "area_mm = " + area), 0, "surface 1 ends 0.05 mm below surface 2 at (10.000, ");
  // The axis 2 mm beside the plates: over one side of three passes and the way from it, and over the ends of
  // the two others.
  expect(check(0, 0, ball, "area_mm = [[0, -2], [20, 6]]"), 0,
         "along 21.8 mm of the guides, first of pass 1");
  expect(check(0, 0, ball, "area_mm = [[-2, 0], [20, 8]]"), 0, "[guide-beyond-part]");
  expect(check(0, 0, ball, "area_mm = [[-4, 0], [20, 8]]"), 2, "[guide-misses-part]");
  // Beyond a gap that is wider than the cutter nothing stops it: told in the middle of a pass.
  const auto fallen = check(8, 0, ball, "area_mm = [[0, 0], [28, 8]]");
  expect(fallen, 2, "pass 1: the tool rests on nothing at (13.");
  EXPECT_NE(fallen.output.find("scene.toml:"), std::string::npos) << fallen.output;
  fs::remove_all(folder);
}

// A driven path that leaves the travel of axes is told with place, axis, value and limit before its first
// cycle.
TEST(DrivenTravel, AxesThatWouldLeaveTheirTravelAreTold) {
  const fs::path folder = swarf::test::fresh_folder("driven_travel");
  fs::copy(SWARF_SOURCE_DIR "/scenes/kato_five_axis/dome.nc", folder / "dome.nc");
  std::string scene = swarf::test::read_text(SWARF_SOURCE_DIR "/scenes/kato_five_axis/scene.toml");
  const std::string assets = "../../assets";
  scene.replace(scene.find(assets), assets.size(), SWARF_SOURCE_DIR "/assets");
  const auto check = [&](const char* origin) {
    swarf::test::write_text(folder / "scene.toml", scene + "\n[setup]\nwork_origin_mm = " + origin + "\n");
    return run_swarf("check " + (folder / "scene.toml").string());
  };
  const auto run = check("[8, 400, 160]");
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_NE(run.output.find("[driven-travel]"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("axis X would have to go to -300.163 mm in pass 2 at ("), std::string::npos)
      << run.output;
  EXPECT_NE(run.output.find("0.163 mm beyond its travel of -300.000 .. 300.000 mm"), std::string::npos)
      << run.output;
  const auto right = check("[8, 96, 160]");
  EXPECT_EQ(right.exit_code, 0) << right.output;
  EXPECT_EQ(right.output.find("[driven-travel]"), std::string::npos) << right.output;
  fs::remove_all(folder);
}

// CAD files that cannot drive, through the shipped program.
TEST(DrivenFaces, FilesThatAreNoPartAreRefused) {
  const fs::path folder = swarf::test::fresh_folder("driven_no_part");
  const std::string part = swarf::test::read_text(SWARF_SOURCE_DIR "/scenes/kato_mould/mould.stp");
  fs::copy(SWARF_SOURCE_DIR "/scenes/kato_mould/scene.toml", folder / "scene.toml");
  const auto told = [&](const std::string& text) {
    swarf::test::write_text(folder / "mould.stp", text);
    const auto run = run_swarf("check " + (folder / "scene.toml").string());
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
    return run.output;
  };
  std::string no_unit = part;
  const size_t unit = no_unit.find("LENGTH_UNIT()");
  ASSERT_NE(unit, std::string::npos);
  no_unit.replace(unit, 13, "PLANE_ANGLE_UNIT()");
  EXPECT_NE(told(no_unit).find("[cad-no-unit]"), std::string::npos);
  EXPECT_NE(told("").find("[cad-unreadable]"), std::string::npos);
  EXPECT_NE(told("                                        S      1\n").find("this is no STEP file"),
            std::string::npos);
  std::string no_solid = part;
  const size_t solid = no_solid.find("#15 = MANIFOLD_SOLID_BREP('',#16);");
  ASSERT_NE(solid, std::string::npos);
  no_solid.replace(solid, 34, "#15 = CARTESIAN_POINT('',(0.,0.,0.));");
  EXPECT_NE(told(no_solid).find("[cad-empty]"), std::string::npos);
  // Sheets bound no body; an entity whose list is no list is the file's damage, with its number.
  const auto turned = [&](const char* model) {
    std::string text = no_solid;
    text.replace(text.find("#15 = CARTESIAN_POINT('',(0.,0.,0.));"), 37, model);
    text.replace(text.find("CLOSED_SHELL"), 12, "OPEN_SHELL");
    return text;
  };
  const std::string sheets = told(turned("#15 = SHELL_BASED_SURFACE_MODEL('',(#16));"));
  EXPECT_NE(sheets.find("[cad-open]"), std::string::npos) << sheets;
  EXPECT_EQ(sheets.find("[mesh-empty]"), std::string::npos) << sheets;
  const std::string damaged = told(turned("#15 = SHELL_BASED_SURFACE_MODEL('',#16);"));
  EXPECT_NE(damaged.find("[cad-unreadable]"), std::string::npos) << damaged;
  EXPECT_NE(damaged.find("#15 = SHELL_BASED_SURFACE_MODEL"), std::string::npos) << damaged;
  fs::remove_all(folder);
}

// A mesh that drives and is open, or inside out, is refused with the place and what to do.
TEST(DrivenMesh, OpenOrInsideOutIsRefused) {
  const fs::path folder = swarf::test::fresh_folder("driven_mesh");
  const std::vector<std::string> corners = {"0 0 0", "20 0 0", "0 20 0", "0 0 9"};
  const auto write = [&](const std::vector<std::vector<size_t>>& facets) {
    std::string text = "solid part\n";
    for (const auto& facet : facets) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const size_t corner : facet) text += "vertex " + corners[corner] + "\n";
      text += "endloop\nendfacet\n";
    }
    swarf::test::write_text(folder / "part.stl", text + "endsolid\n");
  };
  swarf::test::write_text(
      folder / "scene.toml",
      "machine = \"mill_3axis\"\n[cutter]\nnumber = 1\nshape = \"ball\"\ndiameter_mm = 6\nflute_length_mm = "
      "30\n"
      "shank_diameter_mm = 6\nlength_mm = 60\n[setup]\nwork_origin_mm = \"on_table\"\n[stock]\n"
      "box_mm = [[0, 0, 0], [20, 20, 10]]\nvoxel_mm = 0.5\n[driven]\nmesh = \"part.stl\"\ninterval_mm = 4\n"
      "feed_mm_min = 1500\n");
  const auto check = [&] { return run_swarf("check " + (folder / "scene.toml").string()); };
  write({{0, 2, 1}, {0, 1, 3}, {0, 3, 2}});
  const auto open = check();
  EXPECT_EQ(open.exit_code, 2) << open.output;
  EXPECT_NE(open.output.find("[mesh-open]"), std::string::npos) << open.output;
  EXPECT_NE(open.output.find("3 boundary edges, the first from ("), std::string::npos) << open.output;
  write({{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
  const auto inverted = check();
  EXPECT_EQ(inverted.exit_code, 2) << inverted.output;
  EXPECT_NE(inverted.output.find("[mesh-inverted]"), std::string::npos) << inverted.output;
  EXPECT_NE(inverted.output.find("fix: turn all its facets round"), std::string::npos) << inverted.output;
  // As it should be: a run of it is drawn again from its folder.
  write({{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  const std::string out = (folder / "out").string();
  const auto run = run_swarf("run " + (folder / "scene.toml").string() +
                             " --no-render -q --set driven.floor_mm=0 --set design.pitch_mm=2 -o " + out);
  EXPECT_LE(run.exit_code, 1) << run.output;
  const auto again = run_swarf("render " + out + " --kind part --size 64 64 --still " + out + ".png");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  fs::remove_all(folder);
}

// A part that stands in the scene itself: the same patch as surface blocks and as a NURBS surface of [design]
// gives the same cycles.
TEST(DrivenByDesign, ANurbsSurfaceDrivesAsItsPolynomialDoes) {
  const fs::path folder = swarf::test::fresh_folder("driven_by_design");
  const std::string rest =
      "machine = \"mill_3axis\"\n[cutter]\nnumber = 1\nshape = \"ball\"\ndiameter_mm = 6\nflute_length_mm = "
      "30\n"
      "shank_diameter_mm = 6\nlength_mm = 60\n[setup]\nwork_origin_mm = \"on_table\"\n"
      "[stock]\nbox_mm = [[0, 0, -10], [10, 8, 6]]\nvoxel_mm = 0.4\n[accept]\ngouge_max_um = 0.2\nroughing = "
      "true\n"
      "[driven]\ninterval_mm = 2\nfeed_mm_min = 1500\n";
  // z = 2 x (10 - x) / 25 over 10 x 8 mm.
  swarf::test::write_text(
      folder / "part.nc",
      "N10 G17 G21 G54 G90\nN20 T1 M6\nN30 S12000 M3\nN40 G10 L70 P1 Q2 R1\n"
      "N50 G10 L71 P1 I0 J0 X0 Y0 Z0\nN60 G10 L71 P1 I1 J0 X10 Y0 Z8\n"
      "N70 G10 L71 P1 I2 J0 X0 Y0 Z-8\nN80 G10 L71 P1 I0 J1 X0 Y8 Z0\nN90 G10 L79 P1 D1\nN100 M30\n");
  swarf::test::write_text(folder / "blocks.toml", rest + "surface = \"part.nc\"\n");
  swarf::test::write_text(
      folder / "nurbs.toml",
      rest +
          "by_design = true\n[design]\nkind = \"nurbs\"\noutward = \"u_cross_v\"\ndegree = [2, 1]\ncount = "
          "[3, 2]\n"
          "knots_u = [0, 0, 0, 1, 1, 1]\nknots_v = [0, 0, 1, 1]\n"
          "poles_mm = [[0, 0, 0], [0, 8, 0], [5, 0, 4], [5, 8, 4], [10, 0, 0], [10, 8, 0]]\n");
  std::vector<double> cycles, bounds;
  for (const char* name : {"blocks", "nurbs"}) {
    const auto run =
        run_swarf("run " + (folder / name).string() + ".toml --no-render -q -o " + (folder / name).string());
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto metrics = nlohmann::json::parse(std::ifstream(folder / name / "metrics.json"));
    cycles.push_back(metrics.at("driven").at("cycles").get<double>());
    bounds.push_back(metrics.at("surface").at("gouge_bound_um").get<double>());
  }
  EXPECT_EQ(cycles[0], cycles[1]);
  EXPECT_LT(bounds[0], 0.2);
  EXPECT_LT(bounds[1], 0.2);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace driven_input_test

// The page of swarf compare, two revisions of a stock, and stocks that are moved first.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "measure/alignment.h"
#include "mesh/mesh_io.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace compare_page_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::Pose;
using swarf::TriMesh;
using swarf::Vec3;
using swarf::test::ProgramRun;
using swarf::test::read_text;
using swarf::test::run_swarf;

/// A plate 40 x 40 x 10 with towers of these heights beside its middle.
TriMesh plate(double first, double second) {
  return swarf::test::towers({-20, -12, -6, 4, 11, 20}, {-20, -7, 3, 20}, 0.0, [&](int i, int j) {
    return j != 1 ? 10.0 : i == 1 ? first : i == 3 ? second : 10.0;
  });
}

class ComparePage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder(std::string("compare_page_") +
                                        testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string file(const std::string& name, const TriMesh& mesh) {
    const std::string path = (folder_ / name).string();
    swarf::mesh::save_mesh(path, mesh);
    return path;
  }
  fs::path folder_;
};

TEST_F(ComparePage, ShowsTheWorstPlacesWithPicturesSectionsAndHistogram) {
  const std::string out = (folder_ / "out").string();
  const ProgramRun run = run_swarf("compare '" + file("a<b>.stl", plate(10.3, 9.9)) + "' " +
                                   file("design.stl", plate(10.0, 10.0)) + " --pitch-mm 0.8 -o " + out);
  ASSERT_EQ(run.exit_code, 1) << run.output;
  const std::string page = read_text(out + "/report.html");
  for (const char* text : {"a&lt;b&gt;.stl", "excess 300.000 µm", "gouge 100.000 µm", "id=\"finding-2\"",
                           "class=\"finding-picture\"", "Area by deviation", "across X", "Place 2, close",
                           "class=\"scale-bar\"", "Regions beyond a limit", "id=\"part-glb\""})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("id=\"finding-3\""), std::string::npos);
  EXPECT_EQ(page.find("Lin &amp; Koren"), std::string::npos);
  for (const char* name : {"place_1.png", "place_2.png", "metrics.json", "deviation.ply", "design.png"})
    EXPECT_GT(fs::file_size(out + "/" + name), 500U) << name;
  // Over an earlier result, whole.
  const ProgramRun good = run_swarf("compare " + (folder_ / "design.stl").string() + " " +
                                    (folder_ / "design.stl").string() + " --pitch-mm 0.8 -o " + out);
  ASSERT_EQ(good.exit_code, 0) << good.output;
  EXPECT_FALSE(fs::exists(out + "/place_1.png"));
  EXPECT_NE(read_text(out + "/report.html").find("None, in what was checked"), std::string::npos);
}

TEST_F(ComparePage, AMovedStockIsBroughtBack) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.03, Vec3(1, 1, 4).normalized()).toRotationMatrix();
  pose.translation() = Vec3(1.5, -0.7, 0.4);
  const TriMesh design = plate(14.0, 12.0);
  const std::string words = "compare " + file("stock.stl", swarf::measure::moved(design, pose)) + " " +
                            file("design.stl", design) + " --pitch-mm 0.8 --json ";
  EXPECT_EQ(run_swarf(words).exit_code, 1);
  const auto pair = [&](const Vec3& p) {
    const Vec3 at = pose * p;
    char text[200];
    std::snprintf(text, sizeof text, " --align %.9f,%.9f,%.9f=%g,%g,%g", at.x(), at.y(), at.z(), p.x(), p.y(),
                  p.z());
    return std::string(text);
  };
  const std::string pairs = pair({-20, -20, 0}) + pair({20, -20, 0}) + pair({-20, 20, 10});
  for (const std::string& options : {pairs, std::string("--best-fit"), pairs + " --best-fit"}) {
    const ProgramRun run = run_swarf(words + options);
    ASSERT_EQ(run.exit_code, 0) << options << run.output;
    const json alignment = json::parse(run.output).at("alignment");
    EXPECT_LT(alignment.at("rms_um").get<double>(), 0.1) << options;
    const Pose back = pose.inverse();
    for (int r = 0; r < 3; ++r)
      EXPECT_NEAR(alignment.at("matrix_mm").at(r).at(3).get<double>(), back.matrix()(r, 3), 1e-4) << options;
  }
  EXPECT_NE(run_swarf(words.substr(0, words.find(" --json")) + " --best-fit").output.find("turned by 1.7188"),
            std::string::npos);
  for (const char* bad : {"1,2,3", "1,2,3=4,5", "1,2,3=4,5,6x", "1,2,nan=4,5,6", ""}) {
    const ProgramRun run = run_swarf(words + "--align '" + bad + "'");
    EXPECT_EQ(run.exit_code, 2) << bad << run.output;
  }
  EXPECT_NE(run_swarf(words + "--align 0,0,0=0,0,0").output.find("[points-on-a-line]"), std::string::npos);
}

TEST_F(ComparePage, TwoRevisionsOfAStockSayWhatChanged) {
  const auto run = [&](const std::string& name, const char* depth) {
    swarf::test::write_text(
        folder_ / (name + ".ngc"),
        std::string("G21 G90\nT1 M6\nS9000 M3\nG0 X5 Y5\nZ2\nG1 Z-") + depth + " F600\nX15\nG0 Z20\nM2\n");
    const ProgramRun done =
        run_swarf("run " + (folder_ / (name + ".ngc")).string() + " --tool 6 --stock 0,0,-8,20,10,0 " +
                  "--voxel 0.5 --no-render -o " + (folder_ / name).string());
    EXPECT_LE(done.exit_code, 1) << done.output;
    return (folder_ / name / "stock.vdb").string();
  };
  const std::string earlier = run("earlier", "2"), now = run("now", "2.5");
  const ProgramRun changed =
      run_swarf("compare " + now + " " + earlier + " --pitch-mm 1 --gouge-um 400 --scallop-um 400 -o " +
                (folder_ / "out").string());
  EXPECT_EQ(changed.exit_code, 1) << changed.output;
  const std::string page = read_text(folder_ / "out/report.html");
  EXPECT_NE(page.find("What changed"), std::string::npos);
  EXPECT_NE(page.find("<code>removed</code>"), std::string::npos);
  EXPECT_EQ(run_swarf("compare " + now + " " + now + " --pitch-mm 1").exit_code, 0);
  // The errors of both grids are in no number: what they are was told as 0, and as included.
  EXPECT_NE(changed.output.find("against voxels of 0.5 mm"), std::string::npos) << changed.output;
  EXPECT_EQ(changed.output.find("numbers include"), std::string::npos) << changed.output;
  const json told = json::parse(run_swarf("compare " + now + " " + earlier + " --pitch-mm 1 --json").output);
  const json& grids = told.at("accuracy").at("grids_not_included");
  EXPECT_EQ(grids.at("design_voxel_mm"), 0.5);
  EXPECT_GT(grids.at("stock_error_um").get<double>(), 1.0);
  EXPECT_GT(grids.at("design_error_um").get<double>(), 1.0);
}

/// A solid of STEP against the STL of the same solid, and against one that is 20 um too high: proven, with a
/// page. The facets of the STEP file are exact there.
TEST_F(ComparePage, AStepDesignIsComparedAndProven) {
  const std::string assets = SWARF_SOURCE_DIR "/assets/programs/stepnode/";
  TriMesh mesh = swarf::mesh::load_mesh(assets + "step_block.stl");
  const std::string step = assets + "simple_block_workpiece.stp", out = (folder_ / "out").string();
  const ProgramRun same =
      run_swarf("compare " + file("same.stl", mesh) + " " + step + " --pitch-mm 2 --json");
  ASSERT_EQ(same.exit_code, 0) << same.output;
  EXPECT_LT(json::parse(same.output).at("surface").at("excess_bound_um").get<double>(), 0.1);
  float top = mesh.positions.front()[2];
  for (const auto& p : mesh.positions) top = std::max(top, p[2]);
  for (auto& p : mesh.positions)
    if (p[2] == top) p[2] += 0.02F;
  const ProgramRun high =
      run_swarf("compare " + file("high.stl", mesh) + " " + step + " --pitch-mm 2 -o " + out);
  EXPECT_EQ(high.exit_code, 1) << high.output;
  const json metrics = json::parse(read_text(out + "/metrics.json"));
  EXPECT_NEAR(metrics.at("surface").at("excess_max_um").get<double>(), 20.0, 0.02);
  EXPECT_NE(read_text(out + "/report.html").find("id=\"finding-1\""), std::string::npos);
}

/// Of a part in mm whose representation is #9, of #20 (its place) and #21 (its solid).
std::string step_head() {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('bar','',(''),(''),'','','');\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n"
         "#1=APPLICATION_CONTEXT('automotive design');\n#2=PRODUCT_CONTEXT('',#1,'mechanical');\n"
         "#3=PRODUCT('bar','bar','',(#2));\n#4=PRODUCT_DEFINITION_FORMATION('','',#3);\n"
         "#5=PRODUCT_DEFINITION_CONTEXT('part "
         "definition',#1,'design');\n#6=PRODUCT_DEFINITION('','',#4,#5);\n"
         "#7=PRODUCT_DEFINITION_SHAPE('','',#6);\n#8=SHAPE_DEFINITION_REPRESENTATION(#7,#9);\n"
         "#9=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#20,#21),#10);\n"
         "#10=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#11))"
         "GLOBAL_UNIT_ASSIGNED_CONTEXT((#12,#13,#14))REPRESENTATION_CONTEXT('',''));\n"
         "#11=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),#12,'distance_accuracy_value','');\n"
         "#12=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
         "#13=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n"
         "#14=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());\n";
}

/// A round bar along z from 0, of one cylinder and two planes, in mm.
std::string step_bar(double radius, double length) {
  return step_head() +
         fmt::format(
             "#20=AXIS2_PLACEMENT_3D('',#30,#32,#33);\n#21=MANIFOLD_SOLID_BREP('',#22);\n"
             "#22=CLOSED_SHELL('',(#60,#61,#62));\n#30=CARTESIAN_POINT('',(0.,0.,0.));\n"
             "#31=CARTESIAN_POINT('',(0.,0.,{1:.6f}));\n#32=DIRECTION('',(0.,0.,1.));\n"
             "#33=DIRECTION('',(1.,0.,0.));\n#34=AXIS2_PLACEMENT_3D('',#31,#32,#33);\n"
             "#35=CARTESIAN_POINT('',({0:.6f},0.,0.));\n#36=CARTESIAN_POINT('',({0:.6f},0.,{1:.6f}));\n"
             "#37=VERTEX_POINT('',#35);\n#38=VERTEX_POINT('',#36);\n#39=CIRCLE('',#20,{0:.6f});\n"
             "#40=CIRCLE('',#34,{0:.6f});\n#41=VECTOR('',#32,1.);\n#42=LINE('',#35,#41);\n"
             "#43=EDGE_CURVE('',#37,#37,#39,.T.);\n#44=EDGE_CURVE('',#38,#38,#40,.T.);\n"
             "#45=EDGE_CURVE('',#37,#38,#42,.T.);\n#50=ORIENTED_EDGE('',*,*,#43,.T.);\n"
             "#51=ORIENTED_EDGE('',*,*,#45,.T.);\n#52=ORIENTED_EDGE('',*,*,#44,.F.);\n"
             "#53=ORIENTED_EDGE('',*,*,#45,.F.);\n#54=ORIENTED_EDGE('',*,*,#43,.F.);\n"
             "#55=ORIENTED_EDGE('',*,*,#44,.T.);\n#56=EDGE_LOOP('',(#50,#51,#52,#53));\n"
             "#57=EDGE_LOOP('',(#54));\n#58=EDGE_LOOP('',(#55));\n"
             "#60=ADVANCED_FACE('',(#63),#66,.T.);\n#61=ADVANCED_FACE('',(#64),#67,.F.);\n"
             "#62=ADVANCED_FACE('',(#65),#68,.T.);\n#63=FACE_OUTER_BOUND('',#56,.T.);\n"
             "#64=FACE_OUTER_BOUND('',#57,.T.);\n#65=FACE_OUTER_BOUND('',#58,.T.);\n"
             "#66=CYLINDRICAL_SURFACE('',#20,{0:.6f});\n#67=PLANE('',#20);\n#68=PLANE('',#34);\n"
             "ENDSEC;\nEND-ISO-10303-21;\n",
             radius, length);
}

/// A torus about z, of one face whose seams are its outermost circle and one of the tube.
std::string step_torus(double ring, double tube) {
  return step_head() +
         fmt::format(
             "#20=AXIS2_PLACEMENT_3D('',#30,#32,#33);\n#21=MANIFOLD_SOLID_BREP('',#22);\n"
             "#22=CLOSED_SHELL('',(#60));\n#30=CARTESIAN_POINT('',(0.,0.,0.));\n"
             "#31=CARTESIAN_POINT('',({0:.6f},0.,0.));\n#32=DIRECTION('',(0.,0.,1.));\n"
             "#33=DIRECTION('',(1.,0.,0.));\n#36=DIRECTION('',(0.,-1.,0.));\n"
             "#34=AXIS2_PLACEMENT_3D('',#31,#36,#33);\n#35=CARTESIAN_POINT('',({2:.6f},0.,0.));\n"
             "#37=VERTEX_POINT('',#35);\n#39=CIRCLE('',#20,{2:.6f});\n#40=CIRCLE('',#34,{1:.6f});\n"
             "#43=EDGE_CURVE('',#37,#37,#39,.T.);\n#44=EDGE_CURVE('',#37,#37,#40,.T.);\n"
             "#50=ORIENTED_EDGE('',*,*,#43,.T.);\n#51=ORIENTED_EDGE('',*,*,#44,.T.);\n"
             "#52=ORIENTED_EDGE('',*,*,#43,.F.);\n#53=ORIENTED_EDGE('',*,*,#44,.F.);\n"
             "#56=EDGE_LOOP('',(#50,#51,#52,#53));\n#60=ADVANCED_FACE('',(#63),#66,.T.);\n"
             "#63=FACE_OUTER_BOUND('',#56,.T.);\n#66=TOROIDAL_SURFACE('',#20,{0:.6f},{1:.6f});\n"
             "ENDSEC;\nEND-ISO-10303-21;\n",
             ring, tube, ring + tube);
}

/// A prism of `sides` sides about z whose corners stand at the radius.
TriMesh prism(double radius, double length, int sides) {
  TriMesh mesh;
  const auto corner = [&](int i, double z) {
    const double angle = 2.0 * swarf::kPi * (i % sides) / sides;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int i = 0; i < sides; ++i) {
    swarf::test::add_quad(mesh, corner(i, 0), corner(i + 1, 0), corner(i + 1, length), corner(i, length));
    swarf::test::add_triangle(mesh, {0, 0, length}, corner(i, length), corner(i + 1, length));
    swarf::test::add_triangle(mesh, {0, 0, 0}, corner(i + 1, 0), corner(i, 0));
  }
  return mesh;
}

/// swarf compare STOCK SCENE, whose design are the faces of a STEP file in facets of 20 um: a bar of R1 in a
/// stock whose corners stand 100 um above it. The facets are divided until what they stray by, which is in
/// what is proven, is less than a micrometre.
TEST_F(ComparePage, ASceneWithAStepDesignIsProvenByFacetsWithinAMicrometre) {
  constexpr double kRadius = 1.0, kLength = 0.5, kOverUm = 100.0;
  constexpr double kEdgeUm = 2.0;  // planes end this much before or beyond curved edges at most
  swarf::test::write_text(folder_ / "bar.stp", step_bar(kRadius, kLength));
  swarf::test::write_text(folder_ / "bar.nc", "G21 G90\nT1 M6\nS9000 M3\nG0 X30 Y0 Z30\nG1 X-30 F600\nM2\n");
  swarf::test::write_text(folder_ / "scene.toml", R"(nc = "bar.nc"
tools = "T1=6"
stock.box_mm = [[-2, -2, -1], [2, 2, 2]]
stock.voxel_mm = 0.5
[design]
step = "bar.stp"
chord_um = 20
pitch_mm = 1
)");
  const std::string words = "compare " + file("bar.stl", prism(kRadius + 1e-3 * kOverUm, kLength, 8)) + " " +
                            (folder_ / "scene.toml").string() +
                            " --pitch-mm 0.5 --gouge-um 40 --json --excess-um ";
  const auto compared = [&](const char* limit_um, int exit_code) {
    const ProgramRun run = run_swarf(words + limit_um);
    EXPECT_EQ(run.exit_code, exit_code) << run.output;
    const json found = json::parse(run.output), surface = found.at("surface");
    EXPECT_NEAR(surface.at("excess_max_um").get<double>(), kOverUm, 0.5);
    EXPECT_LE(surface.at("gouge_max_um").get<double>(), kEdgeUm);
    EXPECT_GE(surface.at("excess_bound_um").get<double>(), kOverUm);
    return found;
  };
  EXPECT_LE(compared("101", 0).at("surface").at("excess_bound_um").get<double>(), kOverUm + 0.6);
  const double facets_um = compared("99", 1).at("accuracy").at("facet_error_um").get<double>();
  EXPECT_GT(facets_um, 0.0);
  EXPECT_LE(facets_um, 0.5);
}

/// A prism whose corners lie on the bar misses R (1 - cos(pi / n)) of it in the middle of its sides.
TEST_F(ComparePage, ABarOfManySidesAgainstAStepBarIsOffByTheSagitta) {
  constexpr double kRadius = 10.0, kLength = 20.0;
  swarf::test::write_text(folder_ / "round.stp", step_bar(kRadius, kLength));
  for (const int sides : {48, 100, 160}) {
    const double sagitta_um = 1e3 * kRadius * (1.0 - std::cos(swarf::kPi / sides));
    const auto compared = [&](double limit_um, int exit_code) {
      const ProgramRun run = run_swarf(fmt::format("compare {} {} --json --excess-um 2 --gouge-um {:.3f}",
                                                   file("sides.stl", prism(kRadius, kLength, sides)),
                                                   (folder_ / "round.stp").string(), limit_um));
      EXPECT_EQ(run.exit_code, exit_code) << run.output;
      const json surface = json::parse(run.output).at("surface");
      EXPECT_NEAR(surface.at("gouge_max_um").get<double>(), sagitta_um, 0.6);
      EXPECT_GE(surface.at("gouge_bound_um").get<double>(), sagitta_um);
      EXPECT_LE(surface.at("gouge_bound_um").get<double>(), sagitta_um + 1.0);
      EXPECT_LE(surface.at("excess_bound_um").get<double>(), 1.0);
    };
    compared(sagitta_um + 1.0, 0);
    compared(sagitta_um - 1.0, 1);
  }
}

/// Greatest distances of a mesh of a torus from it, um: beyond it and within it.
std::array<double, 2> off_torus_um(const TriMesh& mesh, double ring, double tube) {
  constexpr int kSteps = 24;
  std::array<double, 2> most{};
  for (const auto& t : mesh.triangles) {
    std::array<Vec3, 3> at;
    for (size_t k = 0; k < 3; ++k) {
      const auto& p = mesh.positions[t[k]];
      at[k] = Vec3(p[0], p[1], p[2]);
    }
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Vec3 p = (i * at[0] + j * at[1] + (kSteps - i - j) * at[2]) / kSteps;
        const double um = 1e3 * (std::hypot(std::hypot(p.x(), p.y()) - ring, p.z()) - tube);
        most[0] = std::max(most[0], um);
        most[1] = std::max(most[1], -um);
      }
    }
  }
  return most;
}

/// Facets of a torus stray both ways. Its STEP file is divided as finely as the number of facets allows, and
/// what is proven is as close as that.
TEST_F(ComparePage, AMeshOfATorusAgainstItsStepFileIsProvenAsCloseAsItIsMeasured) {
  // Facets of the STEP file stray by about 1 um, bounds end .5 um above what is found.
  constexpr double kRing = 12.0, kTube = 4.0, kCloseUm = 2.0;
  swarf::test::write_text(folder_ / "torus.stp", step_torus(kRing, kTube));
  const TriMesh mesh = swarf::test::torus(kRing, kTube, {0, 0, 0}, 100, 44);
  const std::array<double, 2> off = off_torus_um(mesh, kRing, kTube);
  ASSERT_GT(off[0], 2.0);
  ASSERT_GT(off[1], 8.0);
  const std::string files = file("torus.stl", mesh) + " " + (folder_ / "torus.stp").string();
  const auto compared = [&](double more_um, int exit_code) {
    const ProgramRun run = run_swarf(fmt::format("compare {} --json --excess-um {:.3f} --gouge-um {:.3f}",
                                                 files, off[0] + more_um, off[1] + more_um));
    EXPECT_EQ(run.exit_code, exit_code) << run.output;
    const json surface = json::parse(run.output).at("surface");
    size_t k = 0;
    for (const char* kind : {"excess", "gouge"}) {
      const double bound = surface.at(std::string(kind) + "_bound_um").get<double>();
      EXPECT_NEAR(surface.at(std::string(kind) + "_max_um").get<double>(), off[k], 1.0) << kind;
      EXPECT_GE(bound, off[k]) << kind;
      EXPECT_LE(bound, off[k] + kCloseUm) << kind;
      ++k;
    }
  };
  compared(kCloseUm, 0);
  compared(-1.1, 1);
}

}  // namespace
}  // namespace compare_page_test

// One judge, on the shipped program: what it says, to whom, and that false alarms are gone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "support/json_path.h"
#include "support/program_run.h"

namespace verdict_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::run_swarf;

const std::string kScenes = SWARF_SOURCE_DIR "/scenes/";

struct Judged {
  swarf::test::ProgramRun run;
  json metrics, findings;

  const json& check(const std::string& name) const {
    const json& checks = metrics.at("checks");
    return *std::find_if(checks.begin(), checks.end(), [&](const json& c) { return c.at("name") == name; });
  }
  std::string outcome(const std::string& name) const { return check(name).at("outcome"); }
};

Judged run_scene(const std::string& scene, const std::string& options = "") {
  const fs::path folder = swarf::test::fresh_folder("verdict");
  Judged judged;
  judged.run = run_swarf("run " + scene + " --no-render -o " + (folder / "run").string() +
                         " --set movie.seconds=0 " + options);
  judged.metrics = json::parse(std::ifstream(folder / "run" / "metrics.json"));
  judged.findings = json::parse(std::ifstream(folder / "run" / "findings.json"));
  fs::remove_all(folder);
  return judged;
}

std::string shipped(const std::string& name) {
  return kScenes + name + "/scene.toml";
}

/// The scene in a folder of its own, its paths made absolute, with texts replaced in scene and program.
std::string altered(const std::string& name, const std::array<std::string, 2>& in_scene,
                    const std::array<std::string, 2>& in_program) {
  const fs::path folder = swarf::test::fresh_folder("verdict_altered");
  const auto replaced = [](std::string text, const std::array<std::string, 2>& change) {
    const size_t at = change[0].empty() ? std::string::npos : text.find(change[0]);
    EXPECT_EQ(at == std::string::npos, change[0].empty()) << change[0];
    return at == std::string::npos ? text : text.replace(at, change[0].size(), change[1]);
  };
  std::string scene = swarf::test::read_text(shipped(name));
  scene = replaced(scene, {"../../assets", SWARF_SOURCE_DIR "/assets"});
  swarf::test::write_text(folder / "scene.toml", replaced(scene, in_scene));
  swarf::test::write_text(folder / "path.cl",
                          replaced(swarf::test::read_text(kScenes + name + "/path.cl"), in_program));
  return (folder / "scene.toml").string();
}

TEST(Verdict, IsOneListForTerminalExitCodeAndFiles) {
  const Judged judged = run_scene(shipped("exact_slot_flat"));
  EXPECT_EQ(judged.run.exit_code, 0) << judged.run.output;
  EXPECT_EQ(judged.metrics.at("verdict"), "pass");
  const std::string sentence = judged.metrics.at("verdict_text");
  EXPECT_NE(judged.run.output.find(sentence), std::string::npos) << judged.run.output;
  EXPECT_TRUE(sentence.starts_with("PASS: ")) << sentence;
  EXPECT_NE(sentence.find("not judged: excess (no limit in [accept])"), std::string::npos) << sentence;
  for (const json& one : judged.metrics.at("not_judged")) {
    EXPECT_EQ(judged.outcome(one.at("name")), "not_judged");
    EXPECT_FALSE(one.at("reason").get<std::string>().empty());
  }
  EXPECT_EQ(judged.outcome("collisions"), "holds");
  EXPECT_EQ(judged.check("collisions").at("limit"), 0.0);
}

TEST(Verdict, TheSpindleOfClDataIsJudgedWhereItIsSaid) {
  EXPECT_EQ(run_scene(shipped("exact_slot_flat")).outcome("spindle_wrong"), "holds");
  const Judged reversed = run_scene(altered("exact_slot_flat", {}, {"8000,CLW", "8000,CCLW"}));
  EXPECT_EQ(reversed.run.exit_code, 1) << reversed.run.output;
  EXPECT_EQ(reversed.outcome("spindle_wrong"), "fails");
  const Judged silent = run_scene(altered("exact_slot_flat", {}, {"SPINDL/8000,CLW\n", ""}));
  EXPECT_EQ(silent.run.exit_code, 0) << silent.run.output;
  EXPECT_EQ(silent.outcome("spindle_wrong"), "not_judged");
  EXPECT_TRUE(silent.check("spindle_wrong").at("value").is_null());
}

/// The slot is 3 mm deep: the shank behind flutes of 2 mm stands 1 mm in what lies before it, from the slot's
/// first move on.
TEST(Verdict, CuttingAboveTheFlutesAndWithTheSpindleStoppedAreTold) {
  const auto told = [](const Judged& judged, const std::string& code) -> json {
    for (const json& one : judged.findings)
      if (one.at("code") == code) return one;
    return {};
  };
  const Judged shorter =
      run_scene(altered("exact_slot_flat", {"flute_length_mm = 25", "flute_length_mm = 2"}, {}));
  EXPECT_EQ(shorter.run.exit_code, 1) << shorter.run.output;
  EXPECT_EQ(shorter.outcome("collisions"), "fails");
  const json shank = told(shorter, "shank-in-stock");
  ASSERT_FALSE(shank.is_null()) << shorter.findings.dump(2);
  EXPECT_EQ(shank.at("line"), 13);
  EXPECT_NE(shank.at("text").get<std::string>().find("1.00 mm deep"), std::string::npos) << shank.at("text");

  const Judged stopped =
      run_scene(altered("exact_slot_flat", {}, {"FEDRAT/600,MMPM\n", "SPINDL/OFF\nFEDRAT/600,MMPM\n"}));
  EXPECT_EQ(stopped.run.exit_code, 1) << stopped.run.output;
  EXPECT_EQ(stopped.outcome("spindle_wrong"), "fails");
  const json spindle = told(stopped, "spindle");
  ASSERT_FALSE(spindle.is_null()) << stopped.findings.dump(2);
  EXPECT_EQ(spindle.at("line"), 14);
  EXPECT_NE(spindle.at("text").get<std::string>().find("with the spindle stopped"), std::string::npos)
      << spindle.at("text");
}

TEST(Verdict, RapidsInMaterialCountUntilTheSceneAllowsThem) {
  const std::array<std::string, 2> rapid{"FEDRAT/600,MMPM\n", "RAPID\n"};
  const Judged found = run_scene(altered("exact_slot_flat", {}, rapid));
  EXPECT_EQ(found.run.exit_code, 1) << found.run.output;
  EXPECT_EQ(found.outcome("rapids_in_material"), "fails");
  const Judged allowed =
      run_scene(altered("exact_slot_flat", {"[accept]\n", "[accept]\nrapids_in_material = 1\n"}, rapid));
  EXPECT_EQ(allowed.run.exit_code, 0) << allowed.run.output;
  EXPECT_EQ(allowed.outcome("rapids_in_material"), "holds");
  const bool warned = std::any_of(allowed.findings.begin(), allowed.findings.end(), [](const json& f) {
    return f.at("check") == "rapids_in_material" && f.at("severity") == "warning";
  });
  EXPECT_TRUE(warned) << allowed.findings.dump(2);
}

TEST(Verdict, AMeshIsNotComparedWithTheLevelSet) {
  const Judged judged = run_scene(shipped("exact_scallop_mesh"));
  EXPECT_EQ(judged.outcome("stock_and_rays"), "not_judged");
  for (const char* name : {"holds", "max_um", "bound_um"})
    EXPECT_TRUE(judged.metrics.at("cross_check").at(name).is_null()) << name;
}

TEST(Verdict, CoarseRaysDoNotDisagreeWithTheStock) {
  for (const std::string pitch : {"0.2", "0.5", "1", "2"}) {
    for (const char* scene : {"exact_gouges", "exact_scallop_ball_plane"}) {
      const Judged judged = run_scene(shipped(scene), "--set design.pitch_mm=" + pitch);
      EXPECT_EQ(judged.outcome("stock_and_rays"), "holds")
          << scene << " at " << pitch << ": " << judged.check("stock_and_rays").dump(2);
    }
  }
}

/// 2 R L + pi R^2 by D; A L + pi D^2 (3 R - D) / 3 with the circle's segment A below the block's top.
TEST(Verdict, VolumesLieWithinTheirBounds) {
  constexpr double pi = 3.14159265358979323846, R = 5.0, L = 30.0, D = 3.0;
  const double flat = (2.0 * R * L + pi * R * R) * D;
  const double half = std::acos((R - D) / R);
  const double segment = R * R * (half - std::sin(half) * std::cos(half));
  const double ball = segment * L + pi * D * D * (3.0 * R - D) / 3.0;
  for (const double voxel : {0.2, 0.37}) {
    for (const auto& [scene, exact] : {std::pair{"exact_slot_flat", flat}, {"exact_slot_ball", ball}}) {
      const Judged judged = run_scene(shipped(scene), "--set stock.voxel_mm=" + std::to_string(voxel));
      const json& stock = judged.metrics.at("stock");
      const double removed = stock.at("volume_removed_mm3"), left = stock.at("volume_left_mm3");
      const double bound = stock.at("volume_error_bound_mm3");
      EXPECT_NEAR(removed + left, 50.0 * 20.0 * 8.0, 1e-9) << scene;
      EXPECT_LE(std::abs(removed - exact), bound) << scene << " voxel " << voxel;
      // Some 3700 mm2 of surface: a fifth of a voxel on all of it.
      EXPECT_LE(bound, 0.2 * voxel * 3700.0) << scene;
    }
  }
}

TEST(Verdict, CheckFindsWhatTheMachineCannotDo) {
  const std::string far =
      altered("exact_slot_flat", {"[design]", "[setup]\nwork_origin_mm = [290, 0, 0]\n\n[design]"}, {});
  const auto found = run_swarf("check --json " + far);
  EXPECT_EQ(found.exit_code, 1) << found.output;
  const json object = json::parse(found.output);
  EXPECT_FALSE(object.at("right"));
  EXPECT_FALSE(object.at("files").at(0).at("right"));
  EXPECT_EQ(object.at("files").at(0).at("travel"), "fails");
  EXPECT_EQ(object.at("files").at(0).at("diagnostics").at(0).at("code"), "travel");
  const auto right = run_swarf("check --json " + shipped("exact_slot_flat"));
  EXPECT_EQ(right.exit_code, 0) << right.output;
  EXPECT_TRUE(json::parse(right.output).at("right"));
}

/// The stock reaches from X -10 to 40, Y -10 to 10, Z -8 to 0 mm. What a raw stock lacks is no gouge.
TEST(Verdict, ADesignOutsideTheStockIsRefusedAndOneThatReachesOutIsTold) {
  const std::string out = swarf::test::fresh_folder("verdict_outside").string();
  const auto run = [&](const std::string& keys) {
    return run_swarf("run " + shipped("exact_slot_flat") + " --no-render -o " + out + keys);
  };
  for (const char* origin : {"[0, 90, -3]", "[0, -3, 0.001]"}) {
    const auto refused = run(std::string(" --set 'design.origin_mm=") + origin + "'");
    EXPECT_EQ(refused.exit_code, 2) << refused.output;
    EXPECT_NE(refused.output.find("[design-outside-stock]"), std::string::npos) << refused.output;
  }
  const auto moved = run(" --set 'design.origin_mm=[0, 90, -3]'");
  EXPECT_NE(moved.output.find("move the design by X 0.000 Y -86.000 Z 0.000"), std::string::npos)
      << moved.output;
  const auto inches =
      run(" --set 'design.origin_mm=[0, -0.1, -0.1]' --set 'design.along_u_mm=[1.2, 0, 0]'"
          " --set 'design.along_v_mm=[0, 0.2, 0]' --set 'stock.box_mm=[[-10, -10, -8], [40, 10, -1]]'");
  EXPECT_NE(inches.output.find("its numbers may be inches"), std::string::npos) << inches.output;

  const Judged partly =
      run_scene(shipped("exact_slot_flat"), "--set 'stock.box_mm=[[-10, -10, -8], [25, 10, 0]]'");
  EXPECT_EQ(partly.run.exit_code, 1) << partly.run.output;
  EXPECT_EQ(partly.outcome("gouge"), "fails");
  EXPECT_NE(partly.run.output.find("by 5.000 mm at (30.000, "), std::string::npos) << partly.run.output;
  EXPECT_NE(partly.check("gouge").at("reason").get<std::string>().find("nobody has cut it"),
            std::string::npos);
  const auto codes = [&](const char* code) {
    return std::count_if(partly.findings.begin(), partly.findings.end(),
                         [&](const json& one) { return one.at("code") == code; });
  };
  EXPECT_EQ(codes("stock-missing"), 1) << partly.findings.dump(2);
  EXPECT_EQ(codes("gouge"), 0) << partly.findings.dump(2);
}

/// A part that the stock cannot hold passed where nobody had set a limit of gouges. A box of 38 mm in a bar
/// of D 40 mm lacks sqrt(2) 19 - 20 mm = 6.870 mm at its edges, where no measuring ray stands.
TEST(Verdict, WithoutALimitOfGougesADesignThatTheStockCannotHoldFails) {
  const fs::path folder = swarf::test::fresh_folder("verdict_missing");
  swarf::test::write_text(folder / "air.nc",
                          "G21 G17 G90 G94\nT1 M6\nS5000 M3\nG0 X-40 Y0 Z5\nG1 X-19 Y0 Z-3 F2000\nX19\n"
                          "G0 Z20\nM2\n");
  swarf::test::write_text(
      folder / "part.obj",
      "v -19 -19 -20\nv 19 -19 -20\nv 19 19 -20\nv -19 19 -20\nv -19 -19 -3\nv 19 -19 -3\n"
      "v 19 19 -3\nv -19 19 -3\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n"
      "f 4 1 5 8\n");
  const auto scene = [&](const char* name, const std::string& stock, const std::string& design) {
    swarf::test::write_text(folder / name,
                            "nc = \"air.nc\"\ntools = \"T1=6\"\n"
                            "setup = { work_origin_mm = \"on_table\", without_length = \"tip\" }\n"
                            "[stock]\nvoxel_mm = 0.5\n" +
                                stock + "[accept]\nroughing = true\n[design]\npitch_mm = 2\n" + design);
    return run_scene((folder / name).string());
  };
  const std::string bar = "cylinder = { base_mm = [0, 0, -20], diameter_mm = 40, length_mm = 20 }\n";
  const std::string plane =
      "kind = \"plane\"\norigin_mm = [5, -1, -3]\nalong_u_mm = [30, 0, 0]\nalong_v_mm = [0, 2, 0]\n";
  for (const auto& [judged, mm] :
       {std::pair(scene("mesh.toml", bar, "mesh = \"part.obj\"\n"), 6.870058),
        std::pair(scene("plane.toml", bar, plane), std::hypot(35.0, 1.0) - 20.0)}) {
    EXPECT_EQ(judged.run.exit_code, 1) << judged.run.output;
    EXPECT_EQ(judged.outcome("gouge"), "fails");
    EXPECT_NEAR(judged.metrics.at("surface").at("stock_missing_um").get<double>(), 1e3 * mm, 0.01);
    const auto missing = [](const json& one) { return one.at("code") == "stock-missing"; };
    EXPECT_EQ(std::count_if(judged.findings.begin(), judged.findings.end(), missing), 1)
        << judged.findings.dump(2);
  }
  const std::string block = "box_mm = [[-19, -19, -20], [19, 19, 0]]\n", part = "mesh = \"part.obj\"\n";
  const Judged whole = scene("whole.toml", block, part);
  EXPECT_EQ(whole.outcome("gouge"), "not_judged") << whole.run.output;
  EXPECT_EQ(whole.run.exit_code, 0) << whole.run.output;
  // Cut .12 mm too deep: no limit is needed to know that this is not the part.
  const std::string deeper = swarf::test::read_text(folder / "air.nc");
  swarf::test::write_text(folder / "air.nc", std::regex_replace(deeper, std::regex("Z-3 "), "Z-3.12 "));
  const Judged gouged = scene("gouged.toml", block, part);
  EXPECT_EQ(gouged.run.exit_code, 1) << gouged.run.output;
  EXPECT_EQ(gouged.outcome("gouge"), "fails");
  const auto gouge = std::find_if(gouged.findings.begin(), gouged.findings.end(),
                                  [](const json& one) { return one.at("code") == "gouge"; });
  ASSERT_NE(gouge, gouged.findings.end()) << gouged.findings.dump(2);
  EXPECT_NE(gouge->at("text").get<std::string>().find("a gouge, 120.000 um about"), std::string::npos)
      << gouge->dump(2);
  EXPECT_EQ(gouge->at("line"), 6) << gouge->dump(2);
}

/// A plate whose top is faced at the height given: the design's is 0.
TEST(Verdict, WithoutALimitOfExcessMaterialLeftHighFails) {
  const fs::path folder = swarf::test::fresh_folder("verdict_left");
  swarf::test::write_text(folder / "part.obj",
                          "v -20 -6 -8\nv 20 -6 -8\nv 20 6 -8\nv -20 6 -8\nv -20 -6 0\nv 20 -6 0\nv 20 6 0\n"
                          "v -20 6 0\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const std::string mesh = "mesh = \"part.obj\"\n",
                    plane =
                        "kind = \"plane\"\norigin_mm = [-19, -5, 0]\nalong_u_mm = [38, 0, 0]\n"
                        "along_v_mm = [0, 10, 0]\n";
  const auto faced = [&](const char* height, const std::string& design, const std::string& options = "") {
    swarf::test::write_text(folder / "face.nc",
                            std::string("G21 G17 G90 G94\nT1 M6\nS5000 M3\nG0 X-35 Y0 Z9\n"
                                        "G1 Z") +
                                height + " F2000\nX35\nG0 Z20\nM2\n");
    swarf::test::write_text(folder / "scene.toml",
                            "nc = \"face.nc\"\ntools = \"T1=16\"\n"
                            "setup = { work_origin_mm = \"on_table\", without_length = \"tip\" }\n"
                            "stock = { box_mm = [[-20, -6, -8], [20, 6, 1]], voxel_mm = 0.4 }\n"
                            "[design]\npitch_mm = 1\n" +
                                design);
    return run_scene((folder / "scene.toml").string(), options);
  };
  for (const std::string& design : {mesh, plane}) {
    const Judged high = faced("0.5", design);
    EXPECT_EQ(high.run.exit_code, 1) << high.run.output;
    EXPECT_EQ(high.outcome("excess"), "fails");
    const auto told = std::find_if(high.findings.begin(), high.findings.end(),
                                   [](const json& one) { return one.at("code") == "excess"; });
    ASSERT_NE(told, high.findings.end()) << high.findings.dump(2);
    EXPECT_NE(told->at("text").get<std::string>().find("material stands above the design, 500.000 um"),
              std::string::npos)
        << told->dump(2);
    EXPECT_EQ(told->at("line"), 6) << told->dump(2);
    const Judged rough = faced("0.5", design, "--roughing");
    EXPECT_EQ(rough.run.exit_code, 0) << rough.run.output;
    EXPECT_EQ(rough.check("excess").at("reason"), "roughing: material may be left");
    EXPECT_EQ(faced("0.5", design, "--set accept.excess_max_um=600").outcome("excess"), "holds");
    const Judged fine = faced("0.09", design);
    EXPECT_EQ(fine.run.exit_code, 0) << fine.run.output;
    EXPECT_EQ(fine.outcome("excess"), "not_judged");
  }
  const auto both =
      run_swarf("run " + (folder / "scene.toml").string() +
                " --roughing --set accept.excess_max_um=600 --no-render -o " + (folder / "both").string());
  EXPECT_EQ(both.exit_code, 2) << both.output;
  EXPECT_NE(both.output.find("[accept-contradiction]"), std::string::npos) << both.output;
}

/// A slot of 3 mm below a plane that is to be whole, as deep as three times the skin of a measuring ray: it
/// was proven to be no deeper than the stock, by all that the proof may spend.
TEST(Verdict, ASlotThroughAPlaneIsProvenAsDeepAsItIs) {
  const Judged judged = run_scene(shipped("exact_slot_flat"),
                                  "--set 'design.origin_mm=[0, -6, 0]' --set 'design.along_v_mm=[0, 12, 0]' "
                                  "--set accept.gouge_max_um=1 --set accept.excess_max_um=1");
  EXPECT_EQ(judged.run.exit_code, 1) << judged.run.output;
  EXPECT_NEAR(judged.check("gouge").at("value").get<double>(), 3000.0, 0.01);
  EXPECT_NEAR(judged.check("gouge").at("bound").get<double>(), 3000.0, 0.7);
  EXPECT_EQ(judged.outcome("excess"), "holds") << judged.check("excess").dump(2);
}

/// Faced by rows that overlap, and drilled through where one row ends: the drill cuts the hole, the row
/// beside it alone covers the rim.
TEST(Verdict, AroundAHoleThroughAFacedPlaneNothingIsLeftOpen) {
  const fs::path folder = swarf::test::fresh_folder("verdict_hole");
  swarf::test::write_text(
      folder / "hole.nc",
      "G21 G17 G90 G94\nT1 M6\nS5000 M3\nG0 X-20 Y-15 Z5\nG1 Z0 F2000\nX20\nY-7\nX-20\nY1\n"
      "X20\nY9\nX-20\nY15\nX20\nG0 Z20\nT2 M6\nS5000 M3\nG0 X3 Y2 Z5\nG1 Z-12\nG0 Z20\nM2\n");
  swarf::test::write_text(folder / "scene.toml",
                          "nc = \"hole.nc\"\ntools = \"T1=12,T2=6\"\n"
                          "setup = { work_origin_mm = \"on_table\", without_length = \"tip\" }\n"
                          "stock = { box_mm = [[-15, -12, -8], [15, 12, 1]], voxel_mm = 0.3 }\n"
                          "[design]\nkind = \"plane\"\norigin_mm = [-14, -11, 0]\nalong_u_mm = [28, 0, 0]\n"
                          "along_v_mm = [0, 22, 0]\npitch_mm = 1\n[accept]\nexcess_max_um = 1\n");
  const Judged judged = run_scene((folder / "scene.toml").string());
  EXPECT_EQ(judged.outcome("excess"), "holds") << judged.run.output;
}

TEST(Verdict, AGridCoarserThanTheBlockOrTheToolIsRefused) {
  for (const char* voxel : {"1e9", "10.5", "9"}) {
    const auto run =
        run_swarf("run " + shipped("exact_slot_flat") + " --no-render -o " +
                  swarf::test::fresh_folder("verdict_voxel").string() + " --set stock.voxel_mm=" + voxel);
    EXPECT_EQ(run.exit_code, 2) << voxel << run.output;
    EXPECT_NE(run.output.find("voxel_mm"), std::string::npos) << run.output;
  }
}

TEST(Verdict, AFolderOrAFullDiskIsAWrongInputNotAFaultOfTheProgram) {
  const std::vector<std::string> commands{"run " + kScenes, "check " + kScenes,
                                          "compare " + kScenes + " " + kScenes,
                                          "plan " + shipped("exact_slot_flat") + " -o /dev/full/path.cl"};
  for (const std::string& command : commands) {
    const auto run = run_swarf(command);
    EXPECT_EQ(run.exit_code, 2) << command << "\n" << run.output;
    EXPECT_EQ(run.output.find("internal error"), std::string::npos) << command << "\n" << run.output;
  }
}

}  // namespace

}  // namespace verdict_test

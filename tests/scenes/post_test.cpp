// swarf post from the command line: every option, its errors, and programs that swarf check reads.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/program_run.h"

namespace {

namespace fs = std::filesystem;
using swarf::test::read_text;
using swarf::test::write_text;

const char* const kPart =
    "$$ SWARF CL DATA\nPARTNO PLATE\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\nFROM/0,0,120,0,0,1\nRAPID\n"
    "GOTO/10,-5,60,0,0,1\nFEDRAT/600,MMPM\nGOTO/10,-5,41.5,0,0,1\nGOTO/30.1234,-5,41.5,0.1,0,0.994987437\n"
    "GOTO/30,15,41.5,0.2,-0.3,0.932737905\nRAPID\nGOTO/30,15,90,0.2,-0.3,0.932737905\nFINI\n";

/// A folder with CL data and a tool table.
fs::path ready(const std::string& name) {
  const fs::path folder = swarf::test::fresh_folder("post_" + name);
  write_text(folder / "part.cls", kPart);
  write_text(folder / "tools.toml",
             "[[tool]]\nnumber = 1\ndiameter_mm = 4\nflute_length_mm = 10\nlength_mm = 40\n");
  return folder;
}

swarf::test::ProgramRun run_in(const fs::path& folder, const std::string& words) {
  return swarf::test::run_command("cd '" + folder.string() + "' && " + std::string(SWARF_PROGRAM) + " " +
                                  words);
}

TEST(PostCommand, WritesWhatCheckReadsOnTheMachine) {
  const fs::path folder = ready("dialects");
  for (const std::string dialect : {"fanuc", "siemens", "heidenhain", "linuxcnc", "haas", "mazak"}) {
    for (const std::string tcp : {"--tcp", "--no-tcp"}) {
      SCOPED_TRACE(dialect + " " + tcp);
      const auto posted = run_in(folder, "post part.cls --machine head_table_bc --dialect " + dialect + " " +
                                             tcp + " --tools tools.toml --work-origin 0 0 150 -o part.nc");
      ASSERT_EQ(posted.exit_code, 0) << posted.output;
      EXPECT_NE(posted.output.find("axis B"), std::string::npos) << posted.output;
      EXPECT_NE(posted.output.find(tcp == "--tcp" ? "with TCP" : "tolerance 10 um"), std::string::npos)
          << posted.output;
      const auto checked = run_in(
          folder, "check part.nc --machine head_table_bc --tools tools.toml --no-drive --dialect " + dialect);
      EXPECT_NE(checked.output.find("NC program"), std::string::npos) << checked.output;
      EXPECT_NE(checked.exit_code, 2) << checked.output << read_text(folder / "part.nc");
    }
  }
}

TEST(PostCommand, ToleranceGivesBlocksAndJsonNumbers) {
  const fs::path folder = ready("json");
  const auto posted = [&](const std::string& words) {
    const auto run =
        run_in(folder,
               "post part.cls --machine maho_600c --no-tcp --dialect linuxcnc --tools tools.toml "
               "--work-origin 0 0 200 --json -o part.ngc 2>/dev/null " +
                   words);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return nlohmann::json::parse(run.output, nullptr, false);
  };
  const auto coarse = posted("--tolerance-um 50"), fine = posted("--tolerance-um 2"),
             straight = posted("--tolerance-um 50 --axis-tolerance-deg 0.001");
  EXPECT_LT(coarse.at("lines").get<int>(), fine.at("lines").get<int>());
  EXPECT_LT(coarse.at("lines").get<int>(), straight.at("lines").get<int>());
  EXPECT_LE(fine.at("tip_deviation_um").get<double>(), 2.0);
  EXPECT_GT(coarse.at("tip_deviation_um").get<double>(), 2.0);
  EXPECT_EQ(fine.at("points"), coarse.at("points"));
  EXPECT_EQ(fine.at("axes").size(), 5u);
  // The work turned by a quarter turns the table by it.
  const auto turned = posted("--work-rotation-deg 90");
  EXPECT_NE(turned.at("axes"), coarse.at("axes"));
}

TEST(PostCommand, AShopsOwnWordsAndTheStandardOutput) {
  const fs::path folder = ready("own");
  std::string words = read_text(fs::path(SWARF_SOURCE_DIR) / "assets/posts/fanuc.toml");
  const size_t at = words.find("M30");
  words.replace(at, 3, "M99");
  write_text(folder / "my.toml", words);
  const auto run = run_in(folder, "-q post part.cls --machine mikron_ucp710 --post my.toml -o - 2>/dev/null");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(run.output.substr(0, 2), "%\n");
  EXPECT_NE(run.output.find("M99\n"), std::string::npos) << run.output;
  EXPECT_EQ(run_in(folder, "check my.toml").exit_code, 0);
  // A wrong word is told with line and column.
  words.replace(words.find("{axes}"), 6, "{axis}");
  write_text(folder / "wrong.toml", words + "[colant]\n");
  const auto wrong = run_in(folder, "post part.cls --machine mikron_ucp710 --post wrong.toml -o part.nc");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.output.find("did you mean {axes}?"), std::string::npos) << wrong.output;
  EXPECT_NE(wrong.output.find("coolant"), std::string::npos) << wrong.output;
  EXPECT_FALSE(fs::exists(folder / "part.nc"));
}

/// Holes across the head: in a plane, or as moves; LinuxCNC has no planes.
TEST(PostCommand, PlanesAreWrittenWhereAsked) {
  const fs::path folder = ready("planes");
  const std::string axis = ",0.5,0,0.866025404\n";
  write_text(folder / "tilted.cls",
             "$$ SWARF CL DATA\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\nFROM/0,0,60" + axis +
                 "RAPID\nGOTO/20,0,60" + axis + "CYCLE/DRILL,DEPTH,6,CLEAR,2,MMPM,120\nGOTO/10,0,20" + axis +
                 "CYCLE/OFF\nRAPID\nGOTO/10,0,60" + axis + "FINI\n");
  const auto written = [&](const std::string& words, int exit_code) {
    const auto run = run_in(
        folder,
        "post tilted.cls --machine fork_head --tools tools.toml --work-origin 0 0 100 -o part.nc " + words);
    EXPECT_EQ(run.exit_code, exit_code) << run.output;
    return exit_code == 0 ? read_text(folder / "part.nc") : run.output;
  };
  EXPECT_NE(written("", 0).find("G68.2 X0. Y0. Z0. I90. J30. K-90.\nG53.1"), std::string::npos);
  EXPECT_EQ(written("--planes never", 0).find("G68.2"), std::string::npos);
  EXPECT_NE(written("--dialect siemens --planes constant", 0).find(",0,30,0,0,0,0,-1,0,1)"),
            std::string::npos);
  EXPECT_NE(written("--dialect linuxcnc --planes cycles", 2).find("[no-planes]"), std::string::npos);
}

/// With --avoid, and as keys of [post] in a scene: the same words.
TEST(PostCommand, PlanesPreferenceAndUnitHoldWithCollisionsToo) {
  const fs::path folder = ready("avoided");
  const std::string axis = ",0.5,0,0.866025404\n";
  write_text(folder / "tilted.cls",
             "$$ SWARF CL DATA\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\nFROM/0,0,60" + axis +
                 "RAPID\nGOTO/20,0,60" + axis + "CYCLE/DRILL,DEPTH,6,CLEAR,2,MMPM,120\nGOTO/10,0,20" + axis +
                 "CYCLE/OFF\nRAPID\nGOTO/10,0,60" + axis + "FINI\n");
  const auto written = [&](const std::string& words) {
    const auto run = run_in(folder, "post " + words + " -o part.nc");
    EXPECT_EQ(run.exit_code, 0) << words << run.output;
    return run.exit_code == 0 ? read_text(folder / "part.nc") + run.output : run.output;
  };
  const std::string avoid =
      "tilted.cls --machine fork_head --tools tools.toml --work-origin 0 0 100 --avoid ";
  EXPECT_NE(written(avoid).find("G68.2 X0. Y0. Z0. I90. J30. K-90.\nG53.1"), std::string::npos);
  EXPECT_EQ(written(avoid + "--planes never").find("G68.2"), std::string::npos);
  EXPECT_NE(written(avoid + "--prefer travel").find("that has the least slide movements"), std::string::npos);
  EXPECT_NE(written(avoid + "--unit inch").find("\nG20 G90"), std::string::npos);
  const std::string scene =
      "cl = \"tilted.cls\"\nmachine = \"fork_head\"\ntool_table = \"tools.toml\"\n[setup]\n"
      "work_origin_mm = [0, 0, 100]\n[stock]\nbox_mm = [[-30, -30, -20], [50, 30, 14]]\nvoxel_mm = 1\n"
      "[design]\nkind = \"none\"\n[post]\n";
  write_text(folder / "scene.toml", scene + "planes = \"never\"\nprefer = \"travel\"\nunit = \"inch\"\n");
  const std::string text = written("scene.toml");
  EXPECT_EQ(text.find("G68.2"), std::string::npos) << text;
  EXPECT_NE(text.find("G20 G90"), std::string::npos) << text;
  EXPECT_NE(text.find("that has the least slide movements"), std::string::npos) << text;
  write_text(folder / "scene.toml", scene + "prefer = \"time\"\nroutes = \"backtrack\"\n");
  const auto both = run_in(folder, "post scene.toml -o part.nc");
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_NE(both.output.find("[prefer-of-backtracking]"), std::string::npos) << both.output;
}

/// Inches of the shipped posts; a shop's own says how it names them, or is refused.
TEST(PostCommand, InchesAreWrittenWhereAsked) {
  const fs::path folder = ready("inches");
  const auto inch =
      run_in(folder, "post part.cls --machine maho_600c --work-origin 0 0 200 --unit inch -o part.nc");
  ASSERT_EQ(inch.exit_code, 0) << inch.output;
  EXPECT_NE(read_text(folder / "part.nc").find("\nG20 G90"), std::string::npos);
  const auto read =
      run_in(folder, "check part.nc --machine maho_600c --tools tools.toml --no-drive --dialect fanuc");
  EXPECT_NE(read.exit_code, 2) << read.output;
  std::string own = read_text(fs::path(SWARF_SOURCE_DIR) / "assets/posts/fanuc.toml");
  own.replace(own.find("{unit}"), 6, "G21");
  write_text(folder / "own.toml", own);
  const auto refused = run_in(
      folder,
      "post part.cls --machine maho_600c --work-origin 0 0 200 --post own.toml --unit inch -o part.nc");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.output.find("[no-unit-words]"), std::string::npos) << refused.output;
}

/// Each criterion has less of what it asks for than the others, and says what it was compared with.
TEST(PostCommand, TheWholeProgramIsChosenByTimeAccuracyOrTravel) {
  const fs::path folder = ready("prefer");
  write_text(
      folder / "two.cls",
      "$$ SWARF CL DATA\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\nFROM/0,0,60,0.3,0,0.953939201\n"
      "FEDRAT/600,MMPM\nGOTO/20,0,60,-0.3,0,0.953939201\nRAPID\nGOTO/20,0,90,-0.3,0,0.953939201\nRAPID\n"
      "GOTO/-20,10,90,0,0.4,0.916515139\nGOTO/-20,10,60,0,0.4,0.916515139\n"
      "GOTO/20,10,60,0,-0.4,0.916515139\nRAPID\nGOTO/20,10,90,0,-0.4,0.916515139\nFINI\n");
  const auto posted = [&](const std::string& words) {
    const auto run =
        run_in(folder,
               "post two.cls --machine maho_600c --dialect linuxcnc --tools tools.toml --work-origin 0 0 200 "
               "--json -o part.nc 2>/dev/null " +
                   words);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return nlohmann::json::parse(run.output, nullptr, false);
  };
  const auto time = posted("--prefer time"), accuracy = posted("--prefer accuracy"),
             travel = posted("--prefer travel");
  const auto seconds = [](const nlohmann::json& one) {
    return one.at("feed_s").get<double>() + one.at("rapid_s").get<double>() + one.at("dwell_s").get<double>();
  };
  const auto slides = [](const nlohmann::json& one) {
    double sum = 0.0;
    for (const auto& axis : one.at("axes")) sum += axis.value("travel_mm", 0.0);
    return sum;
  };
  const auto tip = [](const nlohmann::json& one) { return one.at("tip_deviation_um").get<double>(); };
  for (const auto& other : {time, accuracy, travel, posted("")}) {
    EXPECT_LE(seconds(time), seconds(other) + 1e-9);
    EXPECT_LE(tip(accuracy), tip(other) + 1e-6);
    EXPECT_LE(slides(travel), slides(other) + 1e-6);
  }
  EXPECT_LT(tip(accuracy), 0.6 * tip(time));
  EXPECT_EQ(time.at("choice").at("criterion"), "the least time");
  EXPECT_EQ(time.at("choice").at("routes_dropped"), 0);
  EXPECT_FALSE(time.at("choice").at("stretches").empty());
}

TEST(PostCommand, WhatItRefusesAndThatNothingIsWritten) {
  const fs::path folder = ready("refused");
  write_text(folder / "part.nc", "old\n");
  const auto refused = [&](const std::string& words, const std::string& code) {
    const auto run = run_in(folder, "post part.cls -o part.nc " + words);
    EXPECT_EQ(run.exit_code, 2) << words << run.output;
    EXPECT_NE(run.output.find("[" + code + "]"), std::string::npos) << words << "\n" << run.output;
    EXPECT_EQ(read_text(folder / "part.nc"), "old\n") << words;
  };
  refused("--machine nowhere", "unknown-machine");
  refused("--machine maho_600c --dialect fanuk", "unknown-post");
  refused("--machine maho_600c --dialect fanuc --post my.toml", "two-posts");
  refused("--machine maho_600c --tcp --no-tcp", "tcp-twice");
  refused("--machine mill_3axis --tcp", "no-tcp");
  refused("--machine fork_head --no-tcp", "tool-length");
  refused("--machine maho_600c --work-origin 0 0 -500", "travel");
  refused("--machine mill_3axis --work-origin 0 0 300", "unreachable");
  refused("--machine maho_600c --no-tcp --tolerance-um 0.01 --work-origin 0 0 200", "tolerance-below-digits");
  write_text(folder / "part.cls", std::string(kPart) + "CUTCOM/LEFT\n");
  EXPECT_EQ(run_in(folder, "post part.cls --machine maho_600c -o part.nc --cutcom centre --circle clockwise")
                .exit_code,
            2);
}

}  // namespace

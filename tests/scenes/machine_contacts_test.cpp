// Contacts of links, fixtures and tools in the program as it is shipped: planted ones with their place, and
// their free mirror images.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/page_opens.h"
#include "support/program_run.h"

namespace machine_contacts_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::fresh_folder;
using swarf::test::ProgramRun;
using swarf::test::run_swarf;

/// A frame round the faces of a block of 80 x 60 x 20, whose upper face is Z 0, with a tool of D 6.
const std::string kFrame =
    "G21 G90 G17 G54\nT1 M6\nS5000 M3\nG43 H1\nG0 X0 Y0 Z50\nG1 Z-2 F500\nX60\nY40\nX0\nY0\nG0 Z50\nM2\n";

class MachineContacts : public testing::Test {
 protected:
  MachineContacts() : folder_(fresh_folder("machine_contacts")) {}
  ~MachineContacts() override { fs::remove_all(folder_); }

  /// A run of `program` on `machine`, with what else the scene says.
  ProgramRun run(const std::string& program, const std::string& more, const std::string& flags = "",
                 const std::string& machine = "spinner_u5_620") {
    swarf::test::write_text(folder_ / "part.nc", program);
    swarf::test::write_text(folder_ / "scene.toml",
                            fmt::format("nc = \"part.nc\"\ndialect = \"fanuc\"\nmachine = \"{}\"\n[stock]\n"
                                        "box_mm = [[-10, -10, -20], [70, 50, 0]]\nvoxel_mm = 1\n{}",
                                        machine, more));
    fs::remove_all(out());
    return run_swarf("run " + (folder_ / "scene.toml").string() + " --no-render -q -o " + out().string() +
                     flags);
  }
  fs::path out() const { return folder_ / "out"; }
  json metrics() const { return json::parse(swarf::test::read_text(out() / "metrics.json")); }
  /// Outcome of the check.
  std::string outcome() const {
    const json all = metrics();
    for (const json& check : all["checks"])
      if (check["name"] == "machine_parts") return check["outcome"].get<std::string>();
    return "missing";
  }

  fs::path folder_;
};

/// A cube of STL facets from the origin on.
std::string box_facets(double side) {
  const int faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                            {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  std::string text;
  for (const auto& face : faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face)
      text += fmt::format("vertex {} {} {}\n", (corner & 1) * side, (corner >> 1 & 1) * side,
                          (corner >> 2 & 1) * side);
    text += "endloop\nendfacet\n";
  }
  return text;
}

const std::string kOnTable =
    "[setup]\nwork_origin_mm = \"on_table\"\n[[tool]]\nnumber = 1\ndiameter_mm = 6\n"
    "flute_length_mm = 30\nlength_mm = 60\nholder_diameter_mm = 8\n";

/// A picture of each finding beside it, a pin in the machine where it is; the page leads there.
TEST_F(MachineContacts, EachIsShownInAPictureAndInTheMachine) {
  const std::string pictures =
      "[movie]\nseconds = 0\n[stills]\nkinds = [\"part\"]\nsize = [64, 64]\nsamples = 1\n";
  const std::string clamps = "[[fixture]]\nkind = \"clamps\"\nsides = [\"x-\", \"x+\", \"y+\"]\n";
  run(kFrame, kOnTable + clamps + pictures);
  EXPECT_FALSE(fs::exists(out() / "still_finding_1.png"));  // --no-render
  const auto drawn = run_swarf("run " + (folder_ / "scene.toml").string() + " -q -o " + out().string());
  EXPECT_EQ(drawn.exit_code, 1) << drawn.output;
  const json findings = json::parse(swarf::test::read_text(out() / "findings.json"));
  ASSERT_FALSE(findings.empty());
  for (const json& one : findings) {
    const std::string picture = fmt::format("still_finding_{}.png", one.at("number").get<int>());
    EXPECT_TRUE(fs::exists(out() / picture)) << one.dump();
    EXPECT_EQ(one.at("code"), "machine-contact");
    // The place that the text names, in the machine.
    const json& place = one.at("machine_place_mm");
    EXPECT_NE(one.at("text").get<std::string>().find(fmt::format(
                  "first at ({:.2f}, {:.2f}, {:.2f}) mm of the machine", place.at(0).get<double>(),
                  place.at(1).get<double>(), place.at(2).get<double>())),
              std::string::npos)
        << one.dump();
  }
  swarf::test::expect_review(out());

  run(kFrame, kOnTable + pictures);
  const auto free = run_swarf("run " + (folder_ / "scene.toml").string() + " -q -o " + out().string());
  EXPECT_EQ(free.exit_code, 0) << free.output;
  EXPECT_TRUE(fs::exists(out() / "still_part.png"));
  EXPECT_FALSE(fs::exists(out() / "still_finding_1.png"));
}

/// A bar across the frame's far side: the tool of D 6 leaves a slot of 6 x 20 through its 8 mm. It touches
/// the block, so that its faces are shared by two bodies; a vice below stays whole.
TEST_F(MachineContacts, AFixtureThatIsHitIsCutInto) {
  const std::string bar =
      "[[fixture]]\nname = \"bar\"\non = \"part\"\nbox_mm = [[20, 30, 0], [40, 55, 8]]\n"
      "[[fixture]]\nkind = \"vice\"\ngrip_mm = 15\n";
  const ProgramRun met = run(kFrame, kOnTable + bar, " --set stock.voxel_mm=0.25");
  EXPECT_EQ(met.exit_code, 1) << met.output;
  const json cut = metrics()["machine_contacts"]["fixtures_cut"];
  ASSERT_EQ(cut.size(), 1U) << met.output;
  EXPECT_EQ(cut[0]["name"], "bar");
  EXPECT_NEAR(cut[0]["removed_mm3"].get<double>(), 6.0 * 20.0 * 8.0, 2.0);  // 22 at 1 mm, 6.3 at 0.5: edges

  // The same in the glTF: its bar has a slot, so more triangles than a box.
  const auto drawn =
      run_swarf("run " + (folder_ / "scene.toml").string() + " -q --no-render --report -o " + out().string());
  EXPECT_EQ(drawn.exit_code, 1) << drawn.output;
  const auto whole = fs::file_size(out() / "machine.glb");
  // What is made from the folder later shows it so, too.
  const auto exported = [&] {
    const std::string file = (folder_ / "later.glb").string();
    const auto made = run_swarf("export " + out().string() + " --machine-gltf " + file);
    EXPECT_EQ(made.exit_code, 0) << made.output;
    return fs::file_size(file);
  };
  const auto later = exported();
  run(kFrame, kOnTable + bar, " --set \"fixture[0].box_mm=[[20, 30, 40], [40, 55, 48]]\" --report");
  EXPECT_TRUE(metrics()["machine_contacts"]["fixtures_cut"].empty());
  EXPECT_GT(whole, fs::file_size(out() / "machine.glb") + 1000);
  EXPECT_GT(later, exported() + 1000);
}

/// The straps' posts are hidden by their straps, which reach 10 mm over the upper face: the tool goes into
/// each from the side, and first touches where its flank meets the strap's edge.
TEST_F(MachineContacts, ClampsInTheWayAreFoundWhereTheyAreFirstTouched) {
  const std::string clamps = "[[fixture]]\nkind = \"clamps\"\nsides = [\"x-\", \"x+\", \"y+\"]\n";
  const ProgramRun met = run(kFrame, kOnTable + clamps);
  EXPECT_EQ(met.exit_code, 1) << met.output;
  EXPECT_NE(met.output.find("clamps touches flutes"), std::string::npos) << met.output;
  const json contacts = metrics()["machine_contacts"];
  ASSERT_EQ(contacts["count"], 3) << met.output;
  EXPECT_EQ(outcome(), "fails");
  EXPECT_EQ(contacts["near_miss_min_mm"].get<double>(), 0.0);

  // W stands at (-30, -20, 120) of the machine: the middle of the block over the table, 100 mm above it.
  const json& first = contacts["events"][0];
  EXPECT_EQ(first["a"], "clamps");
  EXPECT_EQ(first["b"], "flutes");
  EXPECT_EQ(first["line"], 8);
  EXPECT_EQ(first["last_line"], 8);
  EXPECT_NEAR(first["place_machine_mm"][0].get<double>(), 60.0 - 30.0, 0.02);  // the strap's edge along Y
  EXPECT_NEAR(first["place_machine_mm"][1].get<double>(), 10.0 - 20.0, 0.02);  // 20 mm wide about Y 20

  // Straps stand over the face, the frame goes 2 mm into it: without them nothing is met.
  const ProgramRun free = run(kFrame, kOnTable + "[[fixture]]\nkind = \"vice\"\ngrip_mm = 15\n");
  EXPECT_EQ(free.exit_code, 0) << free.output;
  EXPECT_EQ(outcome(), "holds");
  EXPECT_EQ(metrics()["machine_contacts"]["count"], 0);

  // As many as are allowed are warnings.
  const ProgramRun allowed = run(kFrame, kOnTable + clamps + "[accept]\nmachine_parts = 3\n");
  EXPECT_EQ(allowed.exit_code, 0) << allowed.output;
  EXPECT_NE(allowed.output.find("warning: clamps touches flutes"), std::string::npos) << allowed.output;
}

/// A jaw 4 mm above the way of the holder's lower face and one 4 mm below it: the second is a near miss.
TEST_F(MachineContacts, HowNearTheHolderCameToAPostIsToldToAMicrometre) {
  // Holder D 8 from Z 58 above the work on (tip at -2, length 60), at X 60 as far as X 64; a post stands 4 mm
  // beyond.
  const auto post = [](double x) {
    return fmt::format("[[fixture]]\nname = \"post\"\nbox_mm = [[{}, 0, 50], [{}, 40, 80]]\non = \"part\"\n",
                       x, x + 5.0);
  };
  const ProgramRun free = run(kFrame, kOnTable + post(68.0));
  EXPECT_EQ(free.exit_code, 0) << free.output;
  EXPECT_NEAR(metrics()["machine_contacts"]["near_miss_min_mm"].get<double>(), 4.0, 5e-3);
  const ProgramRun met = run(kFrame, kOnTable + post(63.9));
  EXPECT_EQ(met.exit_code, 1) << met.output;
  EXPECT_NE(met.output.find("post touches holder"), std::string::npos) << met.output;
}

/// A tool so short that the spindle's nose goes 2 mm below the block's upper face, which is cut away under
/// the tool alone: the nose is in what is left.
TEST_F(MachineContacts, ALinkInWhatIsLeftOfTheStockIsAContact) {
  const std::string short_tool =
      "[setup]\nwork_origin_mm = \"on_table\"\n[[tool]]\nnumber = 1\ndiameter_mm = 6\nflute_length_mm = 1\n"
      "length_mm = 1\nholder_diameter_mm = 6\nholder_length_mm = 1\ngauge_length_mm = 1\n";
  const ProgramRun met = run(kFrame, short_tool + "[accept]\ncollisions = 100\n");
  EXPECT_EQ(met.exit_code, 1) << met.output;
  EXPECT_EQ(outcome(), "fails");
  EXPECT_NE(met.output.find("touches what is left of the stock"), std::string::npos) << met.output;
  const json contacts = metrics()["machine_contacts"];
  EXPECT_GT(contacts["count"], 0);
  EXPECT_EQ(contacts["stock"]["contacts"], contacts["count"]);
  // A block that is laid around the path says nothing about a real one.
  swarf::test::write_text(folder_ / "around.toml",
                          "nc = \"part.nc\"\ndialect = \"fanuc\"\nmachine = \"spinner_u5_620\"\n"
                          "[stock]\nvoxel_mm = 1\n[design]\nkind = \"none\"\n" +
                              short_tool + "[accept]\ncollisions = 100\n");
  const ProgramRun around =
      run_swarf("run " + (folder_ / "around.toml").string() + " --no-render -q -o " + out().string());
  EXPECT_EQ(outcome(), "not_judged") << around.output;
}

/// X Y Z under the tool. A bar of 2 x 2 hangs 50 mm beside it in +X and 5 mm deeper than the tip of a tool
/// that reaches 110 mm below the gauge line. The block is 40 x 40 x 20, its upper face Z 0.
class BarBesideTheTool : public MachineContacts {
 protected:
  BarBesideTheTool() {
    std::string machine = "name = \"bar\"\n";
    for (const char axis : {'X', 'Y', 'Z'})
      machine += fmt::format(
          "[[axis]]\nname = \"{}\"\ntype = \"linear\"\ndirection = [{}, {}, {}]\nmin_mm = -900\n"
          "max_mm = 900\nspeed_max_mm_min = 60000\nacceleration_max_mm_s2 = 10000\n"
          "jerk_max_mm_s3 = 1000000\n",
          axis, axis == 'X' ? 1 : 0, axis == 'Y' ? 1 : 0, axis == 'Z' ? 1 : 0);
    machine +=
        "[work]\norigin_mm = [0, 0, 0]\n[tool]\ngauge_mm = [0, 0, 0]\naxis = [0, 0, 1]\n"
        "[[link]]\nname = \"bed\"\nmount = \"work\"\n[[link]]\nname = \"x\"\nparent = \"bed\"\n"
        "axis = \"X\"\n[[link]]\nname = \"y\"\nparent = \"x\"\naxis = \"Y\"\n[[link]]\n"
        "name = \"head\"\nparent = \"y\"\naxis = \"Z\"\nmount = \"tool\"\nmesh = \"bar.obj\"\n";
    swarf::test::write_text(folder_ / "machine.toml", machine);
    std::string bar;
    for (int i = 0; i < 8; ++i)
      bar += fmt::format("v {} {} {}\n", (i & 1) != 0 ? 52 : 50, (i & 2) != 0 ? 1 : -1,
                         (i & 4) != 0 ? -20 : -115);
    for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"})
      bar += fmt::format("f {}\n", face);
    swarf::test::write_text(folder_ / "bar.obj", bar);
  }

  ProgramRun run_bar(const std::string& program, const std::string& flags = "") {
    swarf::test::write_text(folder_ / "part.nc", kStart + program + "M2\n");
    swarf::test::write_text(
        folder_ / "scene.toml",
        "nc = \"part.nc\"\ndialect = \"fanuc\"\nmachine = \"machine.toml\"\n[stock]\n"
        "box_mm = [[0, 0, -20], [40, 40, 0]]\nvoxel_mm = 0.5\n[design]\nkind = \"none\"\n"
        "[setup]\nstart = { X_mm = -100, Y_mm = 20, Z_mm = 160 }\n[interpolator]\nperiod_ms = 20\n[[tool]]\n"
        "number = 1\ndiameter_mm = 10\nflute_length_mm = 30\nlength_mm = 60\nholder_diameter_mm = 10\n");
    fs::remove_all(out());
    return run_swarf("run " + (folder_ / "scene.toml").string() + " --no-render -q -o " + out().string() +
                     " " + flags);
  }
  json contacts() const { return metrics()["machine_contacts"]; }
  json stock() const { return contacts()["stock"]; }

  const std::string kStart = "G21 G90 G17 G54\nT1 M6\nS5000 M3\nG43 H1\nG0 X-100 Y20 Z50\n";
  // 10 wide and 10 deep along X in the middle; the bar goes through 3 mm above its floor.
  const std::string kSlot = "G0 X-7 Y20\nG0 Z-10\nG1 X45 F1000\nG0 Z50\n";
  const std::string kBar = "G0 X-45 Y20\nG0 Z-2\nG0 X-15\nG0 Z50\n";
  // Slots along Y from X 5 to 15 and from 18 to 28, and the bar from one to the other.
  const std::string kTwoSlots =
      "G0 X10 Y-7\nG0 Z-10\nG1 Y47 F1000\nG0 Z50\nG0 X23 Y-7\nG0 Z-10\nG1 Y47\nG0 Z50\n";
  const std::string kThrough = "G0 X-41 Y20\nG0 Z-2\nG0 X-28\nG0 Z50\n";
};

TEST_F(BarBesideTheTool, WhereItWasCutAwayBeforeItIsFree) {
  const ProgramRun after = run_bar(kSlot + kBar);
  EXPECT_EQ(after.exit_code, 0) << after.output;
  EXPECT_EQ(outcome(), "holds");
  EXPECT_EQ(stock()["came_to_raw"], 1);
  EXPECT_EQ(stock()["contacts"], 0);
  EXPECT_EQ(stock()["open"], 0);
  EXPECT_EQ(contacts()["count"], 0);

  const ProgramRun before = run_bar(kBar + kSlot);
  EXPECT_EQ(before.exit_code, 1) << before.output;
  EXPECT_EQ(outcome(), "fails");
  ASSERT_EQ(stock()["contacts"], 1) << before.output;
  EXPECT_EQ(contacts()["count"], 1);
  EXPECT_EQ(stock()["events"][0]["line"], 7);
  EXPECT_EQ(stock()["events"][0]["last_line"], 9);
  EXPECT_NEAR(stock()["events"][0]["depth_seen_mm"].get<double>(), 7.0, 0.05);
  // Its foot, 2 x 2, comes down on the upper face: within a voxel.
  const json first = stock()["events"][0]["first_machine_mm"];
  EXPECT_NEAR(first[0].get<double>(), 6.0, 1.001);
  EXPECT_NEAR(first[1].get<double>(), 20.0, 1.001);
  EXPECT_NEAR(first[2].get<double>(), 0.0, 0.5);

  // The slot first, but a deeper way: 2 mm into its floor.
  const ProgramRun deeper = run_bar(kSlot + "G0 X-45 Y20\nG0 Z-7\nG0 X-15\nG0 Z50\n");
  EXPECT_EQ(deeper.exit_code, 1) << deeper.output;
  ASSERT_EQ(stock()["contacts"], 1) << deeper.output;
  EXPECT_NEAR(stock()["events"][0]["depth_seen_mm"].get<double>(), 2.0, 0.1);
  // A tenth above its floor, within a voxel: neither is proven, and that is not green.
  const ProgramRun near = run_bar(kSlot + "G0 X-45 Y20\nG0 Z-4.9\nG0 X-15\nG0 Z50\n");
  EXPECT_EQ(near.exit_code, 1) << near.output;
  EXPECT_EQ(outcome(), "not_proven");
  EXPECT_EQ(stock()["open"], 1);
  EXPECT_NE(near.output.find("not proven to be clear"), std::string::npos) << near.output;
}

/// A rapid of 13 mm takes ten cycles of 20 ms at most; what stands in it is met between them.
TEST_F(BarBesideTheTool, ARibBetweenTwoCyclesIsMet) {
  const ProgramRun met = run_bar(kTwoSlots + kThrough);
  EXPECT_EQ(met.exit_code, 1) << met.output;
  ASSERT_EQ(stock()["contacts"], 1) << met.output;
  EXPECT_EQ(stock()["events"][0]["line"], 16);
  const double x = stock()["events"][0]["place_machine_mm"][0].get<double>();
  EXPECT_GT(x, 14.5);
  EXPECT_LT(x, 18.5);
  // The rib's first face, at X 15; the way of that cycle is several millimetres long.
  EXPECT_NEAR(stock()["events"][0]["first_machine_mm"][0].get<double>(), 15.0, 0.5);
  const ProgramRun free = run_bar(kTwoSlots + "G0 X16 Y-7\nG0 Z-10\nG1 Y47\nG0 Z50\n" + kThrough);
  EXPECT_EQ(free.exit_code, 0) << free.output;
  EXPECT_EQ(stock()["came_to_raw"], 1);
}

/// While the slot is cut, and twice; on any number of threads, from any saved stock.
TEST_F(BarBesideTheTool, SameForAnyThreadsAndFromASavedStock) {
  const std::string program = kTwoSlots + kThrough + kSlot + kBar + kThrough;
  const std::string full = (folder_ / "full").string();
  const auto run_into = [&](const std::string& more) { return run_bar(program, more); };
  run_into("--threads 1 --save-stock-after 12,15,19");
  const json one = contacts();
  EXPECT_EQ(one["stock"]["came_to_raw"], 3);
  EXPECT_EQ(one["stock"]["contacts"], 1);
  fs::copy(out(), full);
  run_into("--threads 2");
  EXPECT_EQ(contacts(), one);
  for (const char* line : {"12", "15", "19"}) {
    const ProgramRun on = run_into(fmt::format("--from {}/stock_after_line_{}.vdb", full, line));
    EXPECT_EQ(contacts(), one) << on.output;
  }
}

/// What lies behind a saved stock was looked at with the bodies of that run: another one leaves it open.
TEST_F(BarBesideTheTool, ASavedStockOfAnotherBarLeavesWhatLiesBehindOpen) {
  const std::string program = kBar + kSlot + kBar;
  ASSERT_EQ(run_bar(program, "--save-stock-after 13").exit_code, 1);
  EXPECT_EQ(stock()["contacts"], 1);
  const std::string kept = (folder_ / "kept.vdb").string();
  fs::copy(out() / "stock_after_line_13.vdb", kept);
  std::string bar = swarf::test::read_text(folder_ / "bar.obj");
  for (size_t at = 0; (at = bar.find("-115", at)) != std::string::npos;) bar.replace(at, 4, "-114");
  swarf::test::write_text(folder_ / "bar.obj", bar);
  const ProgramRun on = run_bar(program, "--from " + kept);
  EXPECT_EQ(on.exit_code, 1) << on.output;
  EXPECT_EQ(outcome(), "not_proven");
  EXPECT_EQ(stock()["came_to_raw"], 2);
  EXPECT_EQ(stock()["contacts"], 0);
  EXPECT_EQ(stock()["open"], 1);
}

/// What has no mesh cannot be looked at, and is no pass.
TEST_F(MachineContacts, AMachineWithoutMeshesIsNotJudged) {
  std::string machine;
  for (const char* axis : {"X", "Y", "Z"}) {
    machine += fmt::format(
        "[[axis]]\nname = \"{}\"\ntype = \"linear\"\ndirection = [{}, {}, {}]\nmin_mm = -900\n"
        "max_mm = 900\nspeed_max_mm_min = 20000\n",
        axis, axis[0] == 'X' ? 1 : 0, axis[0] == 'Y' ? 1 : 0, axis[0] == 'Z' ? 1 : 0);
  }
  machine +=
      "[work]\norigin_mm = [0, 0, 0]\n[tool]\ngauge_mm = [0, 0, 0]\naxis = [0, 0, 1]\n"
      "[[link]]\nname = \"bed\"\nmount = \"work\"\n[[link]]\nname = \"x\"\nparent = \"bed\"\naxis = \"X\"\n"
      "[[link]]\nname = \"y\"\nparent = \"x\"\naxis = \"Y\"\n"
      "[[link]]\nname = \"head\"\nparent = \"y\"\naxis = \"Z\"\nmount = \"tool\"\n";
  swarf::test::write_text(folder_ / "machine.toml", "name = \"bare\"\n" + machine);
  const ProgramRun bare = run(kFrame, kOnTable, "", (folder_ / "machine.toml").string());
  EXPECT_EQ(bare.exit_code, 0) << bare.output;
  EXPECT_EQ(outcome(), "not_judged");
  EXPECT_NE(bare.output.find("nothing is known of bed with y, bed with head, bed with flutes"),
            std::string::npos)
      << bare.output;
  EXPECT_EQ(metrics()["machine_contacts"]["without_mesh_pairs"][0]["b"], "y");
  const ProgramRun table =
      run_swarf("run " + (folder_ / "scene.toml").string() + " --no-render -o " + out().string());
  EXPECT_NE(table.output.find("not checked: no pairs"), std::string::npos) << table.output;
  EXPECT_EQ(table.output.find("none comes nearer"), std::string::npos) << table.output;

  // A fixture alone is looked at, and the verdict names the pairs that were not.
  const ProgramRun vice =
      run(kFrame, kOnTable + "[[fixture]]\nkind = \"vice\"\n", "", (folder_ / "machine.toml").string());
  EXPECT_EQ(outcome(), "holds");
  EXPECT_NE(vice.output.find("; not looked at: bed with y, bed with head, bed with flutes"),
            std::string::npos)
      << vice.output;
  EXPECT_NE(metrics().dump().find("not looked at: bed (no mesh)"), std::string::npos)
      << metrics()["checks"].dump(1);
}

/// What a scene says of single pairs: allowed ones are left out by name, a near miss of its own is a warning
/// with its line.
TEST_F(MachineContacts, PairsHaveTheirOwnRules) {
  const std::string clamps = "[[fixture]]\nkind = \"clamps\"\nsides = [\"x-\", \"x+\", \"y+\"]\n";
  const ProgramRun touches = run(kFrame, kOnTable + clamps +
                                             "[[contact_pair]]\nparts = [\"flutes\", \"clamps\"]\n"
                                             "may_touch = true\n");
  EXPECT_EQ(outcome(), "holds") << touches.output;
  const std::string why = metrics().dump();
  EXPECT_NE(why.find("clamps with flutes (the scene allows it)"), std::string::npos);
  EXPECT_NE(why.find("bed with cradle (one guides the other)"), std::string::npos);

  // 4 mm beside the holder, as HowNearTheHolderCameToAPostIsToldToAMicrometre.
  const std::string post =
      "[[fixture]]\nname = \"post\"\nbox_mm = [[68, 0, 50], [73, 40, 80]]\non = \"part\"\n";
  const std::string rule = "[[contact_pair]]\nparts = [\"post\", \"holder\"]\nnear_miss_mm = ";
  const ProgramRun near = run(kFrame, kOnTable + post + rule + "5.0\n");
  EXPECT_EQ(near.exit_code, 0) << near.output;
  EXPECT_NE(near.output.find("post comes as near as 4.000 mm to holder, line 8"), std::string::npos)
      << near.output;
  const ProgramRun far = run(kFrame, kOnTable + post + rule + "3.9\n");
  EXPECT_EQ(far.output.find("comes as near"), std::string::npos) << far.output;
}

TEST_F(MachineContacts, RulesOfPairsThatCannotBeAreRefused) {
  const auto refused = [&](const std::string& rule, const std::string& words) {
    const ProgramRun wrong = run(kFrame, kOnTable + "[[contact_pair]]\n" + rule);
    EXPECT_EQ(wrong.exit_code, 2) << rule << wrong.output;
    EXPECT_NE(wrong.output.find(words), std::string::npos) << rule << wrong.output;
    EXPECT_NE(wrong.output.find("scene.toml:"), std::string::npos) << wrong.output;
    EXPECT_FALSE(fs::exists(out())) << rule;
  };
  refused("parts = [\"ramm\", \"holder\"]\nmay_touch = true\n", "did you mean 'ram'?");
  refused("parts = [\"ram\"]\nmay_touch = true\n", "two different parts");
  refused("parts = [\"ram\", \"bed\"]\n", "nothing is said of this pair");
  refused("parts = [\"ram\", \"bed\"]\nmay_touch = true\nnear_miss_mm = 2\n", "may touch have no near miss");
  refused("parts = [\"ram\", \"bed\"]\nnear_miss_mm = 0\n", "near_miss_mm");
  refused("parts = [\"ram\", \"holder\"]\nmay_touch = true\n", "no axis lies between ram and holder");
  refused("parts = [\"stock\", \"holder\"]\nmay_touch = true\n", "accept.collisions");
}

/// A sheet of one facet and one with its facets turned round are met like solids; a closed bar whose facets
/// all look inwards is refused.
TEST_F(MachineContacts, FacetsInAnyOrderAreMet) {
  const auto machine_with = [&](const std::string& triangles, const std::string& name) {
    const fs::path shipped = fs::path(SWARF_SOURCE_DIR) / "assets/machines/spinner_u5_620";
    for (const auto& file : fs::directory_iterator(shipped))
      fs::copy(file, folder_ / file.path().filename(), fs::copy_options::overwrite_existing);
    std::string text = swarf::test::read_text(folder_ / "machine.toml");
    text += "\n[[link]]\nname = \"sheet\"\nparent = \"rotary_table\"\nmesh = \"" + name + "\"\n";
    swarf::test::write_text(folder_ / "machine.toml", text);
    swarf::test::write_text(folder_ / name, "solid s\n" + triangles + "endsolid s\n");
    return (folder_ / "machine.toml").string();
  };
  const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
           "\nendloop\nendfacet\n";
  };
  // W stands at (-30, -20, 120) with the table at zero: a facet across X = 25 of the work, in the flutes' way
  // along the first side, where they stand from Z -2 to 28.
  const std::string a = "-5 -40 130", b = "-5 0 130", c = "-5 -20 160";
  for (const std::string& one : {facet(a, b, c), facet(a, c, b)}) {
    const ProgramRun met = run(kFrame, kOnTable, "", machine_with(one, "one.stl"));
    EXPECT_EQ(met.exit_code, 1) << met.output;
    EXPECT_NE(met.output.find("sheet touches flutes, line 7"), std::string::npos) << met.output;
  }
  const std::string beside = facet("-5 60 130", "-5 100 130", "-5 80 160");
  const ProgramRun free = run(kFrame, kOnTable, "", machine_with(beside, "one.stl"));
  EXPECT_EQ(outcome(), "holds") << free.output;
}

/// Slow to see by poses: two whole turns of the table within one block, free where it starts and ends.
TEST_F(MachineContacts, ATurnThatEndsWhereItBeganIsLookedAtAllTheWay) {
  const std::string turn =
      "G21 G90 G17 G54\nT1 M6\nS5000 M3\nG43 H1\nG0 X30 Y20 Z5 B0 C0\nG1 Z-1 F500\nG0 Z30\nG0 C720\nG0 "
      "Z50\nM2\n";
  const auto bar = [](double x) {
    return fmt::format("[[fixture]]\nname = \"bar\"\nbox_mm = [[{}, 18, 0], [{}, 22, 40]]\non = \"part\"\n",
                       x, x + 4.0);
  };
  // The tool stands over the middle of the table, and so of the bars: 3 mm of its radius.
  const ProgramRun free = run(turn, kOnTable + bar(60.0));
  EXPECT_EQ(free.exit_code, 0) << free.output;
  const std::string off =
      "G21 G90 G17 G54\nT1 M6\nS5000 M3\nG43 H1\nG0 X0 Y20 Z5 B0 C0\nG1 Z-1 F500\nG0 Z30\nG0 C720\nG0 "
      "Z50\nM2\n";
  const ProgramRun met = run(off, kOnTable + bar(60.0));  // the bar passes the tool's place on its circle
  EXPECT_EQ(met.exit_code, 1) << met.output;
  EXPECT_NE(met.output.find("bar touches flutes, line 8"), std::string::npos) << met.output;
}

/// The program in inches meets the clamps at the same places.
TEST_F(MachineContacts, InchesMeetTheSame) {
  const std::string clamps = "[[fixture]]\nkind = \"clamps\"\nsides = [\"x-\", \"x+\", \"y+\"]\n";
  const std::string inches =
      "G20 G90 G17 G54\nT1 M6\nS5000 M3\nG43 H1\nG0 X0 Y0 Z1.9685039\nG1 Z-.0787402 F19.685\n"
      "X2.3622047\nY1.5748031\nX0\nY0\nG0 Z1.9685039\nM2\n";
  run(inches, kOnTable + clamps);
  const json in = metrics()["machine_contacts"]["events"];
  ASSERT_EQ(in.size(), 3U);  // as ClampsInTheWayAreFoundWhereTheyAreFirstTouched
  EXPECT_EQ(in[0]["line"], 8);
  EXPECT_NEAR(in[0]["place_machine_mm"][0].get<double>(), 30.0, 0.02);
  EXPECT_NEAR(in[0]["place_machine_mm"][1].get<double>(), -10.0, 0.02);
}

/// The deepest place of a contact is bounded: the tool of D 6 goes through a bar of 8 mm, 8 deep from above.
TEST_F(MachineContacts, HowDeepAContactIsIsBounded) {
  const std::string bar = "[[fixture]]\nname = \"bar\"\non = \"part\"\nbox_mm = [[20, 30, 0], [40, 55, 8]]\n";
  const ProgramRun met = run(kFrame, kOnTable + bar);
  EXPECT_EQ(met.exit_code, 1) << met.output;
  const json events = metrics()["machine_contacts"]["events"];
  ASSERT_GE(events.size(), 1U);
  // The flank passes half way between the faces of the bar, 4 mm from either.
  const double seen = events[0]["depth_seen_mm"], bound = events[0]["depth_bound_mm"];
  EXPECT_NEAR(seen, 4.0, 0.02);
  EXPECT_GE(bound, seen);
  EXPECT_LE(bound, seen + 0.02);
}

/// A tool longer than the travel along it is named; meshes in metres are told.
TEST_F(MachineContacts, ToolsAndMeshesOfTheWrongSizeAreTold) {
  std::string longer = kOnTable;
  longer.replace(longer.find("length_mm = 60"), 14, "length_mm = 900");
  const ProgramRun too_long = run(kFrame, longer);
  EXPECT_EQ(too_long.exit_code, 1) << too_long.output;
  EXPECT_NE(too_long.output.find("take a shorter tool: "), std::string::npos) << too_long.output;
  EXPECT_NE(too_long.output.find("Z travels 460 mm"), std::string::npos) << too_long.output;

  swarf::test::write_text(folder_ / "small.stl",
                          "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0.2 0 0\n"
                          "vertex 0 0.1 0\nendloop\nendfacet\nendsolid s\n");
  std::string machine =
      swarf::test::read_text(fs::path(SWARF_SOURCE_DIR) / "assets/machines/mill_3axis/machine.toml");
  for (size_t at = machine.find("mesh = \""); at != std::string::npos;
       at = machine.find("mesh = \"", at + 1)) {
    const size_t from = at + 8;
    machine.replace(from, machine.find('"', from) - from, "small.stl");
  }
  swarf::test::write_text(folder_ / "machine.toml", machine);
  const ProgramRun metres = run(kFrame, kOnTable, "", (folder_ / "machine.toml").string());
  EXPECT_NE(metres.output.find("machine-size"), std::string::npos) << metres.output;
  EXPECT_NE(metres.output.find("scale a mesh in metres by 1000"), std::string::npos) << metres.output;
}

TEST_F(MachineContacts, FixturesThatCannotBeAreRefused) {
  const auto refused = [&](const std::string& fixture, const std::string& words) {
    const ProgramRun wrong = run(kFrame, kOnTable + "[[fixture]]\n" + fixture);
    EXPECT_EQ(wrong.exit_code, 2) << wrong.output;
    EXPECT_NE(wrong.output.find(words), std::string::npos) << fixture << wrong.output;
  };
  refused("kind = \"vice\"\nmesh = \"vice.stl\"\n", "nothing is called 'fixture[0].mesh'");
  refused("kind = \"vise\"\n", "vice");
  refused("mesh = \"none.stl\"\n", "none.stl");
  refused("kind = \"chuck\"\n", "grip_diameter_mm");
  refused("kind = \"vice\"\n[[fixture]]\nkind = \"vice\"\n", "two-fixtures");
  swarf::test::write_text(
      folder_ / "open.stl",
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\n"
      "endloop\nendfacet\nendsolid s\n");
  refused("mesh = \"open.stl\"\n", "mesh-open");
  refused("box_mm = [[60, 10, -25], [80, 20, -10]]\non = \"part\"\n",
          "'box' stands 10.000 mm inside the stock");
  // Edges alone cross: no corner of the bar lies in the stock, none of the stock in the bar.
  refused("box_mm = [[20, -30, -12], [30, 90, -8]]\non = \"part\"\n", "mm inside the stock");
  // Metres instead of mm: a warning with what it would be.
  swarf::test::write_text(folder_ / "metres.stl", "solid s\n" + box_facets(0.05) + "endsolid s\n");
  const ProgramRun metres = run(kFrame, kOnTable + "[[fixture]]\nmesh = \"metres.stl\"\n");
  EXPECT_NE(metres.output.find("fixture-size"), std::string::npos) << metres.output;
}

/// Nothing holds the block: said; a vice: not said; a fixture in the air: a warning.
TEST_F(MachineContacts, WhatHoldsTheStockIsToldOrThatNothingDoes) {
  const auto holding = [&]() -> std::string {
    const json all = metrics();
    for (const json& one : all["assumptions"])
      if (one["what"] == "Holding") return one["value"];
    return "";
  };
  const ProgramRun none = run(kFrame, kOnTable);
  EXPECT_EQ(none.exit_code, 0) << none.output;
  EXPECT_EQ(holding(), "nothing touches the stock; 100.000 mm to what is nearest");
  run(kFrame, kOnTable + "[[fixture]]\nkind = \"vice\"\n");
  EXPECT_EQ(holding(), "");
  const ProgramRun air = run(kFrame, kOnTable + "[[fixture]]\nbox_mm = [[200, 0, 50], [210, 10, 60]]\n");
  EXPECT_EQ(air.exit_code, 0) << air.output;
  EXPECT_NE(air.output.find("fixture-floats"), std::string::npos) << air.output;
  EXPECT_NE(holding(), "");
}

/// On the table to the last bit, turned and far out too: it stands, and touching is no contact. Below its
/// face: told.
TEST_F(MachineContacts, AFixtureThatStandsExactlyOnTheTableTouchesNothing) {
  const std::string box =
      "[[fixture]]\nbox_mm = [[0, 0, {}], [30, 30, 25]]\nposition_mm = [130.3, 77.7, 0]\n"
      "rotation_deg = [0, 0, {}]\n";
  for (const int turn : {0, 33}) {
    SCOPED_TRACE(turn);
    const ProgramRun on = run(kFrame, kOnTable + fmt::format(fmt::runtime(box), 0, turn));
    EXPECT_EQ(on.exit_code, 0) << on.output;
    EXPECT_EQ(on.output.find("fixture-"), std::string::npos) << on.output;
    EXPECT_EQ(metrics()["machine_contacts"]["count"], 0);
  }
  const ProgramRun in = run(kFrame, kOnTable + fmt::format(fmt::runtime(box), -7, 0));
  EXPECT_EQ(in.exit_code, 0) << in.output;
  EXPECT_NE(in.output.find("stands 7.000 mm inside 'rotary_table'"), std::string::npos) << in.output;
}

}  // namespace
}  // namespace machine_contacts_test

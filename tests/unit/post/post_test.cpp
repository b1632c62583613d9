// What programs look like and what is refused: number formats, templates, poles, branches, feeds, cycles.
#include <numeric>

#include "unit/post/read_back.h"

namespace swarf::post::post_test {
namespace {

const std::string kHead = "$$ SWARF CL DATA\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\n";

PostOptions without_tcp() {
  PostOptions options;
  options.tcp = false;
  options.tools = {{1, "MILL10", 80.0}, {2, "DRILL5", 80.0}};
  return options;
}
PostOptions with_tcp() {
  PostOptions options = without_tcp();
  options.tcp = true;
  return options;
}

TEST(Numbers, AreWrittenAsTheFormatSays) {
  EXPECT_EQ(written({3, true, false, false}, 10.0), "10.");
  EXPECT_EQ(written({3, false, false, false}, 10.0), "10");
  EXPECT_EQ(written({3, false, true, true}, 10.5), "+10.500");
  EXPECT_EQ(written({3, true, false, false}, -0.0004), "0.");
  EXPECT_EQ(written({0, true, false, false}, -0.4), "0.");
  EXPECT_EQ(written({0, false, false, true}, 0.0), "+0");
  EXPECT_EQ(written({2, false, false, true}, -100.0), "-100");
  EXPECT_EQ(written({0, false, false, false}, 3000.0), "3000");
  EXPECT_DOUBLE_EQ(half_digit({3, true, false, false}), 5e-4);
}

TEST(Templates, LeaveOutWhatIsEmpty) {
  std::string bad;
  const std::vector<Place> places{Place::kAxes, Place::kF, Place::kName};
  const LineTemplate lines("G1 {axes} {F} ; end\nT=\"{name} x\" M6\n{F}\n", places, bad);
  ASSERT_EQ(bad, "");
  PlaceValues values;
  std::vector<std::string> out;
  lines.fill(values, out);
  EXPECT_TRUE(out.empty());
  values.set(Place::kF, "F100");
  values.set(Place::kName, "MILL 10");
  lines.fill(values, out);
  EXPECT_EQ(out, (std::vector<std::string>{"G1 F100 ; end", "T=\"MILL 10 x\" M6", "F100"}));
  EXPECT_TRUE(LineTemplate("G1 {axos}", places, bad).empty());
  EXPECT_EQ(bad, "axos");
  EXPECT_TRUE(LineTemplate("G1 {axes", places, bad).empty());
  EXPECT_EQ(bad, "{axes");
}

TEST(PostFile, TellsEveryFaultWithItsPlace) {
  const std::string file = scratch_file(".toml");
  std::ofstream(file)
      << "name = \"x\"\ndialect = \"fanuk\"\n[motion]\nrapid = \"G0 {axes}\"\nline = \"G1 {F}\"\n"
         "[tool]\nchnage = \"T{T}\"\nchange = \"T{TT} M6\"\n[numbers]\nlinear = { decimals = 12 }\n";
  try {
    load_post(file);
    FAIL();
  } catch (const InputError& error) {
    std::string text;
    for (const Diagnostic& one : error.diagnostics.list()) text += swarf::format(one) + "\n";
    for (const char* part : {":2:", "[unknown-dialect]", ":5:", "[missing-place]",
                             ":7:", "did you mean 'change'", ":8:", "[unknown-place]", ":10:"})
      EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(PostFile, APlaneSaysAllOfItsTurns) {
  const std::string file = scratch_file(".toml");
  std::ofstream(file)
      << "name = \"x\"\ndialect = \"fanuc\"\n[tool]\napproach = \"G0 {rotaries} {across} {along}\"\n"
         "[motion]\nrapid = \"G0 {axes}\"\nline = \"G1 {axes}\"\n[tilted_plane]\n"
         "on = \"G68.2 I{turn_1} J{turn_2}\"\nturns = \"xyz\"\n";
  try {
    load_post(file);
    FAIL();
  } catch (const InputError& error) {
    std::string told;
    for (const Diagnostic& one : error.diagnostics.list()) told += swarf::format(one) + "\n";
    EXPECT_NE(told.find(":9:6: error: on does not say the turn {turn_3}"), std::string::npos) << told;
    EXPECT_NE(told.find(":10:"), std::string::npos) << told;
    EXPECT_NE(told.find("on and off belong together"), std::string::npos) << told;
  }
}

TEST(PostFile, HasToBringEveryAxisToTheWork) {
  const auto faults = [](const std::string& more) {
    const std::string file = scratch_file(".toml");
    std::ofstream(file)
        << "name = \"x\"\ndialect = \"fanuc\"\n[motion]\nrapid = \"G0 {axes}\"\nline = \"G1 {axes} {F}\"\n" +
               more;
    try {
      load_post(file);
    } catch (const InputError& error) {
      return error.diagnostics.list().size();
    }
    return size_t{0};
  };
  const std::string tool = "[tool]\napproach = \"G0 {rotaries} {across}\"\nlength_on = \"G0 {along}\"\n";
  EXPECT_EQ(faults(tool), 0u);
  EXPECT_EQ(faults(""), 3u);
  EXPECT_EQ(faults("[tool]\napproach = \"G0 {rotaries} {across}\"\n"), 1u);
  EXPECT_EQ(faults(tool + "[feed]\ninverse_time = \"G93\"\n"), 1u);
  EXPECT_EQ(faults(tool + "[tcp]\non = \"M128\"\n"), 1u);
}

/// What a post has no words for is told.
TEST(Words, ThatAreMissingAreListed) {
  PostFormat bare = shipped_post("fanuc");
  bare.dwell = bare.clockwise = LineTemplate();
  bare.flood.clear();
  const Posted run =
      run_post(kHead +
                   "COOLNT/ON\nFROM/0,0,80,0,0,1\nFEDRAT/200,MMPM\nGOTO/10,0,80,0,0,1\nDELAY/1\n"
                   "GOTO/20,0,80,0,0,1\nFINI\n",
               placed_machine("mill_3axis"), bare, without_tcp());
  std::vector<std::string> words = run.result.written.not_written;
  std::sort(words.begin(), words.end());
  EXPECT_EQ(words, (std::vector<std::string>{"COOLNT/ON", "DELAY", "SPINDL"})) << run.text;
}

/// The sum of what our interpreter takes for the feeds is the way over the feed, or what the axes allow.
TEST(Feed, TheTipHasItsFeedWithoutTcp) {
  const std::string cl = kHead +
                         "FROM/0,0,60,0.2,0,0.979795897\nFEDRAT/300,MMPM\nGOTO/30,0,60,0.4,0.1,0.911043358\n"
                         "GOTO/30,40,60,0.4,0.1,0.911043358\nGOTO/0,40,55,0.1,0.3,0.948683298\nFINI\n";
  const double way = 30.0 + 40.0 + std::hypot(30.0, 5.0);
  for (const char* post : {"fanuc", "siemens", "linuxcnc", "heidenhain"}) {
    for (const char* machine : {"fork_head", "head_table_bc", "mikron_ucp710", "nutating_head"}) {
      const Posted run = run_post(cl, placed_machine(machine), shipped_post(post), without_tcp());
      ASSERT_EQ(run.faults + reading_faults(run), "") << run.text;
      double seconds = 0.0;
      for (const program::NcMove& move : run.moves) seconds += move.rapid ? 0.0 : move.duration_s;
      EXPECT_EQ(run.result.plan.slowed, 0) << machine;
      EXPECT_NEAR(seconds, way / 5.0, 2e-3 * way / 5.0) << post << " " << machine << "\n" << run.text;
      EXPECT_NEAR(run.result.plan.feed_s, way / 5.0, 1e-9);
    }
  }
}

TEST(Feed, IsSlowedWhereAnAxisCannotFollow) {
  const std::string cl =
      kHead + "FROM/0,0,60,0.05,0,0.998749218\nFEDRAT/3000,MMPM\nGOTO/1,0,60,-0.05,0.001,0.998748718\nFINI\n";
  const Posted run = run_post(cl, placed_machine("maho_600c"), shipped_post("linuxcnc"), without_tcp());
  ASSERT_EQ(run.faults + reading_faults(run), "");
  EXPECT_GT(run.result.plan.slowed, 0);
  for (const program::NcMove& move : run.moves) {
    if (move.rapid) continue;
    for (size_t i = 0; i < run.machine.axes.size(); ++i) {
      const auto row = static_cast<long>(i);
      EXPECT_LE(std::abs(move.q_to[row] - move.q_from[row]),
                run.machine.axes[i].speed_max * move.duration_s * 1.02 + 1e-4);
    }
  }
}

/// Straight through the pole: the continuous solution where the machine tilts to both sides, a turn at rest
/// where it does not.
TEST(Pole, IsPassedAndTheTipStays) {
  const std::string cl =
      kHead + "FROM/0,0,60,0.3,0,0.953939201\nFEDRAT/600,MMPM\nGOTO/20,0,60,-0.3,0,0.953939201\nFINI\n";
  for (const bool tcp : {false, true}) {
    const PostOptions options = tcp ? with_tcp() : without_tcp();
    const Posted both = run_post(cl, placed_machine("head_table_bc"), shipped_post("fanuc"), options);
    ASSERT_EQ(both.faults + reading_faults(both) + compare(both), "") << both.text;
    EXPECT_EQ(both.result.plan.pole_turns, 0);
    kinematics::MachineModel one_side = placed_machine("head_table_bc");
    for (kinematics::Axis& axis : one_side.axes) {
      // A little to the other side is what the continuous way fails by.
      if (axis.name == "B") axis.min = tcp ? 0.0 : -0.001;
    }
    const Posted turned = run_post(cl, one_side, shipped_post("fanuc"), options);
    ASSERT_EQ(turned.faults + reading_faults(turned) + compare(turned), "") << turned.text;
    EXPECT_GT(turned.result.plan.pole_turns, 0) << turned.text;
    EXPECT_NEAR(turned.result.plan.travel[4], kPi, 1e-3);
  }
}

/// Noise of the last digit beside the pole turns nothing.
TEST(Pole, NoiseDoesNotTurnTheTable) {
  std::string cl = kHead + "FROM/0,0,60,0,0,1\nFEDRAT/600,MMPM\n";
  for (int i = 1; i < 20; ++i)
    cl += fmt::format("GOTO/{},0,60,{:.9f},{:.9f},1\n", i, 1e-7 * std::cos(i), 1e-7 * std::sin(i));
  const Posted run =
      run_post(cl + "FINI\n", placed_machine("maho_600c"), shipped_post("linuxcnc"), without_tcp());
  ASSERT_EQ(run.faults + reading_faults(run) + compare(run), "");
  EXPECT_EQ(run.result.plan.travel[4], 0.0);
  EXPECT_EQ(run.result.plan.steps, 20);
}

/// A spiral that would leave the C travel is begun a turn further back; one too long is an error with its
/// line and axis.
TEST(Branches, TheStartLeavesRoomForTheTurns) {
  const auto spiral = [](double turns) {
    std::string cl = kHead;
    for (int i = 0; i <= 200; ++i) {
      const double a = turns * kTurn * i / 200;
      cl += fmt::format("{}/{:.4f},{:.4f},50,{:.9f},{:.9f},{:.9f}\n", i == 0 ? "FROM" : "GOTO",
                        20 * std::cos(a), 20 * std::sin(a), -0.3 * std::cos(a), -0.3 * std::sin(a),
                        std::sqrt(1 - 0.09));
      if (i == 0) cl += "FEDRAT/1000,MMPM\n";
    }
    return cl + "FINI\n";
  };
  const kinematics::MachineModel machine = placed_machine("fork_head");  // C from -360 to 360 degrees
  for (const double turns : {1.6, -1.6}) {
    const Posted run = run_post(spiral(turns), machine, shipped_post("siemens"), without_tcp());
    ASSERT_EQ(run.faults + reading_faults(run) + compare(run), "");
  }
  const Posted too_long = run_post(spiral(2.3), machine, shipped_post("siemens"), with_tcp());
  EXPECT_NE(too_long.faults.find("[axis-jump]"), std::string::npos) << too_long.faults;
  EXPECT_NE(too_long.faults.find("axis C"), std::string::npos) << too_long.faults;
}

/// The order of candidates is the caller's.
TEST(Branches, ChoiceIsAHook) {
  const std::string cl =
      kHead + "FROM/0,0,60,0.3,0,0.953939201\nFEDRAT/600,MMPM\nGOTO/20,0,60,0.3,0,0.953939201\nFINI\n";
  PostOptions options = without_tcp();
  const Posted plain = run_post(cl, placed_machine("head_table_bc"), shipped_post("fanuc"), options);
  size_t offered = 0;
  options.hooks.choice = [&](std::span<const program::Move> moves, std::vector<Start>& starts) {
    EXPECT_EQ(moves.size(), 1u);
    offered = starts.size();
    std::reverse(starts.begin(), starts.end());
  };
  const Posted other = run_post(cl, placed_machine("head_table_bc"), shipped_post("fanuc"), options);
  ASSERT_EQ(other.faults + reading_faults(other) + compare(other), "");
  EXPECT_GT(offered, 1u);
  EXPECT_NE(plain.text, other.text);
  options.hooks.choice = [](std::span<const program::Move>, std::vector<Start>& starts) { starts.clear(); };
  EXPECT_NE(
      run_post(cl, placed_machine("head_table_bc"), shipped_post("fanuc"), options).faults.find("[no-start]"),
      std::string::npos);
}

const std::string kHoles =
    kHead +
    "FROM/0,0,80,0,0,1\nRAPID\nGOTO/0,0,60,0,0,1\nCYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,120\n"
    "GOTO/10,0,40,0,0,1\nGOTO/20,0,40,0,0,1\nGOTO/20,10,41,0,0,1\nCYCLE/OFF\nRAPID\n"
    "GOTO/20,10,80,0,0,1\nFINI\n";

TEST(Cycles, StayCycles) {
  const auto text = [](const char* post) {
    const Posted run = run_post(kHoles, placed_machine("mill_3axis"), shipped_post(post), without_tcp());
    EXPECT_EQ(run.faults + reading_faults(run) + compare(run), "") << run.text;
    EXPECT_EQ(run.result.plan.holes, 3) << post;
    return run;
  };
  const Posted fanuc = text("fanuc");
  EXPECT_EQ(fanuc.count("G81"), 2u) << fanuc.text;  // the third hole lies higher
  EXPECT_NE(fanuc.text.find("G98 G81 Z35. R42. F120.\nX20.\nG80\n"), std::string::npos) << fanuc.text;
  EXPECT_EQ(text("siemens").count("CYCLE81(42,40,2,35)"), 2u);
  const Posted heidenhain = text("heidenhain");
  EXPECT_EQ(heidenhain.count("CYCL DEF 200"), 2u) << heidenhain.text;
  EXPECT_EQ(heidenhain.count("CYCL CALL"), 3u);
  EXPECT_EQ(text("linuxcnc").count("G81"), 2u);
}

/// Across the machine's Z no control drills with a fixed cycle: without a plane the moves are written.
TEST(Cycles, AreMovesWhereTheHeadIsTilted) {
  std::string cl = kHoles;
  for (size_t at = cl.find(",0,0,1\n"); at != std::string::npos; at = cl.find(",0,0,1\n"))
    cl.replace(at, 6, ",0.3,0,0.953939201");
  PostOptions options = without_tcp();
  options.planes = PlaneUse::kNever;
  const Posted head = run_post(cl, placed_machine("nutating_head"), shipped_post("fanuc"), options);
  ASSERT_EQ(head.faults + reading_faults(head) + compare(head), "") << head.text;
  EXPECT_EQ(head.result.plan.holes, 0);
  const Posted table = run_post(cl, placed_machine("mikron_ucp710"), shipped_post("fanuc"), without_tcp());
  ASSERT_EQ(table.faults + reading_faults(table) + compare(table), "") << table.text;
  EXPECT_EQ(table.result.plan.holes, 3);
}

/// The first rapid of a second tool is its approach; what comes behind it is a hole all the same.
TEST(Cycles, StayCyclesBehindAToolChange) {
  const std::string cl = kHead +
                         "FROM/0,0,80,0,0,1\nRAPID\nGOTO/0,0,60,0,0,1\nLOADTL/2\nSPINDL/RPM,800,CLW\nRAPID\n"
                         "GOTO/5,0,60,0,0,1\nCYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,120\nGOTO/10,0,40,0,0,1\n"
                         "GOTO/20,0,40,0,0,1\nCYCLE/OFF\nRAPID\nGOTO/20,0,80,0,0,1\nFINI\n";
  PostOptions options = without_tcp();
  options.tools = {{1, "MILL10", 80.0}, {2, "DRILL5", 80.0}};
  const Posted run = run_post(cl, placed_machine("mill_3axis"), shipped_post("fanuc"), options);
  ASSERT_EQ(run.faults + reading_faults(run) + compare(run), "") << run.text;
  EXPECT_EQ(run.result.plan.holes, 2) << run.text;
}

TEST(Words, ToolsCoolantDwellsAndNotes) {
  const std::string cl =
      kHead +
      "COOLNT/ON\nFROM/0,0,80\nFEDRAT/200,MMPM\nGOTO/10,0,80\nDELAY/1.5\nGOTO/20,0,80\nPPRINT SECOND "
      "(TOOL)\nLOADTL/2\nSPINDL/RPM,800,CCLW\nCOOLNT/MIST\nRAPID\nGOTO/0,0,70\nSTOP\nGOTO/5,0,70\n"
      "OPSTOP\nINSERT M77\nAUXFUN/88\nFINI\n";
  std::string plain = cl;
  plain.replace(plain.find("MULTAX/ON\n"), 10, "");
  const Posted run = run_post(plain, placed_machine("mill_3axis"), shipped_post("fanuc"), without_tcp());
  ASSERT_EQ(run.faults, "");
  for (const char* part : {"T1 M6\nS3000 M3\n", "G43 Z80. H1\nM8\n", "G4 X1.5\n", "(SECOND TOOL)",
                           "M9\nG49\nT2 M6\nS800 M4\n", "G43 Z70. H2\nM7\n", "M0\n", "M1\n", "M77\n"})
    EXPECT_NE(run.text.find(part), std::string::npos) << part << "\n" << run.text;
  EXPECT_EQ(run.result.written.not_written, std::vector<std::string>{"AUXFUN"});
  EXPECT_EQ(run.result.written.comments_changed, 1);
}

TEST(Refused, ToolsFeedsAndPlaces) {
  const auto code = [](const std::string& cl, const char* machine, const char* post, PostOptions options) {
    options.cl.unit_mm = 1.0;
    const std::string faults =
        run_post(kHead + cl + "FINI\n", placed_machine(machine), shipped_post(post), options).faults;
    const size_t from = faults.find(" [");
    return from == std::string::npos ? faults : faults.substr(from + 2, faults.find(']', from) - from - 2);
  };
  const std::string way = "FROM/0,0,60,0,0,1\nFEDRAT/600,MMPM\nGOTO/9,0,60,0,0,1\n";
  EXPECT_EQ(code("LOADTL/7\n" + way, "mill_3axis", "fanuc", without_tcp()), "unknown-tool");
  const std::string silent = run_post(kHead + ("LOADTL/7\n" + way) + "FINI\n", placed_machine("mill_3axis"),
                                      shipped_post("fanuc"), without_tcp())
                                 .faults;
  EXPECT_NE(silent.find("[units-assumed]"), std::string::npos) << silent;
  EXPECT_EQ(code("TOOL PATH/A,TOOL,MILL10\n" + way, "mill_3axis", "fanuc", without_tcp()), "");
  PostOptions by_name = without_tcp();
  by_name.tools = {{0, "MILL10", 80.0}, {1, "", 80.0}};
  EXPECT_EQ(code("TOOL PATH/A,TOOL,MILL10\n" + way, "mill_3axis", "fanuc", by_name), "tool-number");
  EXPECT_EQ(code("TOOL PATH/A,TOOL,MILL10\n" + way, "mill_3axis", "siemens", by_name), "");
  EXPECT_EQ(
      code("FROM/0,0,60,0,0,1\nFEDRAT/0.01,MMPM\nGOTO/9,0,60,0,0,1\n", "mill_3axis", "fanuc", without_tcp()),
      "feed-below-digits");
  EXPECT_EQ(code("FROM/0,0,60,0,0,1\nFEDRAT/600,MMPM\nGOTO/9000,0,60,0,0,1\n", "mill_3axis", "fanuc",
                 without_tcp()),
            "travel");
  EXPECT_EQ(
      code("FROM/0,0,60,0,0,1\nFEDRAT/600,MMPM\nGOTO/9,0,60,1,0,0\n", "mill_3axis", "fanuc", without_tcp()),
      "unreachable");
  const std::string no_tool = run_post("$$ SWARF CL DATA\n" + way + "FINI\n", placed_machine("mill_3axis"),
                                       shipped_post("fanuc"), without_tcp())
                                  .faults;
  EXPECT_NE(no_tool.find("[tool-not-loaded]"), std::string::npos) << no_tool;
  kinematics::MachineModel odd = placed_machine("maho_600c");
  odd.axes[0].name = "U";
  const std::string named =
      run_post(kHead + way + "FINI\n", odd, shipped_post("fanuc"), without_tcp()).faults;
  EXPECT_NE(named.find("[axis-names]"), std::string::npos) << named;
  PostOptions fine = without_tcp();
  fine.tip_mm = 1e-6;
  EXPECT_EQ(code(way, "mill_3axis", "fanuc", fine), "tolerance-below-digits");
}

/// An arc whose ends are in the travel and whose bulge is not.
TEST(Refused, ABulgeOutOfTravel) {
  const kinematics::MachineModel machine = placed_machine("mill_3axis");
  const double far = machine.axes[0].max - machine.X_MW.translation().x();
  const std::string cl = kHead + fmt::format(
                                     "FROM/{0},0,60,0,0,1\nFEDRAT/600,MMPM\nCIRCLE/{0},10,60,0,0,-1,10\n"
                                     "GOTO/{0},20,60,0,0,1\nFINI\n",
                                     far - 5.0);
  const Posted run = run_post(cl, machine, shipped_post("fanuc"), without_tcp());
  EXPECT_NE(run.faults.find("axis X would go to"), std::string::npos) << run.faults << run.text;
}

/// With TCP the linear axes bulge while the table turns under a standing tip: ends in travel are not enough.
TEST(Refused, ABulgeOutOfTravelWithTcp) {
  kinematics::MachineModel machine = placed_machine("head_table_bc");
  const Vec3 low(0.3 * std::cos(0.5), -0.3 * std::sin(0.5), std::sqrt(1.0 - 0.09));
  const std::string cl = kHead + fmt::format(
                                     "FROM/100,0,60,{:.9f},{:.9f},{:.9f}\nFEDRAT/600,MMPM\n"
                                     "GOTO/100,0,60,{:.9f},{:.9f},{:.9f}\nFINI\n",
                                     low.x(), low.y(), low.z(), low.x(), -low.y(), low.z());
  PostOptions options = with_tcp();
  options.axis_rad = 1.0;
  // The other solution would bulge to the other side, where there is room.
  options.hooks.choice = [](std::span<const program::Move>, std::vector<Start>& starts) {
    std::erase_if(starts, [](const Start& one) { return one.q[3] < 0.0; });
  };
  const Posted free = run_post(cl, machine, shipped_post("fanuc"), options);
  ASSERT_EQ(free.faults + reading_faults(free) + compare(free), "");
  EXPECT_EQ(free.result.plan.steps, 2);
  const double end = free.moves.back().q_to[0];
  for (const double room : {3.0, 20.0}) {
    machine.axes[0].max = end + room;
    const Posted run = run_post(cl, machine, shipped_post("fanuc"), options);
    EXPECT_EQ(run.faults.find("axis X would go to") != std::string::npos, room < 10.0)
        << end << run.faults << run.text;
  }
}

TEST(Streams, LongStretchesGoOnWhereTheyAreCut) {
  std::string cl = kHead + "FROM/0,0,60,0,0,1\nFEDRAT/600,MMPM\n";
  const int moves = static_cast<int>(kMovesAhead) + 100;
  for (int i = 1; i <= moves; ++i)
    cl += fmt::format("GOTO/{:.3f},{:.3f},60,0,0,1\n", i % 97 * 0.1, i % 89 * 0.1);
  const Posted run =
      run_post(cl + "FINI\n", placed_machine("mill_3axis"), shipped_post("linuxcnc"), without_tcp());
  ASSERT_EQ(run.faults + reading_faults(run), "");
  EXPECT_EQ(run.result.plan.points, moves + 1);
  EXPECT_EQ(run.result.plan.approaches, 1);
  long feeds = 0;
  for (const program::NcMove& move : run.moves) feeds += move.rapid ? 0 : 1;
  EXPECT_EQ(feeds, moves);
}

}  // namespace
}  // namespace swarf::post::post_test

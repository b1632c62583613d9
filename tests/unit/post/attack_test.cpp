// What CL data can do to a post at its edges: axes that turn over, the pole, one position, coarse digits, and
// the choice of solutions for a whole program.
#include "post/preference.h"
#include "unit/post/read_back.h"

namespace swarf::post::attack_test {
namespace {

const std::string kStart = "$$ SWARF CL DATA\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\n";

PostOptions plain(bool tcp) {
  PostOptions options;
  options.tcp = tcp;
  options.tools = {{1, "MILL10", 80.0}};
  return options;
}

std::string read_faults(const Posted& run) {
  return run.faults + reading_faults(run) + (run.faults.empty() ? compare(run) : "");
}

/// No great circle leads from an axis to its opposite, and no machine here gets there: told, with its line.
TEST(Attack, AnAxisThatTurnsOverIsRefused) {
  const std::string cl =
      kStart + "FROM/0,0,60,0,0,1\nFEDRAT/300,MMPM\nGOTO/10,0,60,0,0,1\nGOTO/20,0,60,0,0,-1\nFINI\n";
  for (const bool tcp : {false, true}) {
    const Posted run = run_post(cl, placed_machine("mikron_ucp710"), shipped_post("fanuc"), plain(tcp));
    EXPECT_NE(run.faults.find(":8:"), std::string::npos) << run.faults << run.text;
  }
}

/// A whole pass with the tool along the pole turns nothing, and its feed is the programmed one.
TEST(Attack, APassAtThePoleTurnsNothing) {
  std::string cl = kStart + "FROM/0,0,60,0,0,1\nFEDRAT/600,MMPM\n";
  for (int i = 1; i <= 12; ++i)
    cl += fmt::format("GOTO/{:.4f},{:.4f},60,0,0,1\n", 10.0 * i, 3.0 * std::sin(i));
  for (const char* machine : {"maho_600c", "fork_head", "nutating_head", "head_table_bc"}) {
    for (const bool tcp : {false, true}) {
      const Posted run = run_post(cl + "FINI\n", placed_machine(machine), shipped_post("fanuc"), plain(tcp));
      ASSERT_EQ(read_faults(run), "") << run.text;
      EXPECT_EQ(run.count("G93"), 0u) << run.text;
      EXPECT_NE(run.line_with("F600."), "") << run.text;
      for (size_t i = 3; i < 5; ++i) EXPECT_EQ(run.result.plan.travel[static_cast<long>(i)], 0.0);
    }
  }
}

/// Out of the pole into a tilt: the turn at rest is by the axes' own speed, the rest by inverse time, and
/// both together last as long as our interpreter takes.
TEST(Attack, InverseTimesAreRightAtThePole) {
  const std::string cl =
      kStart +
      "FROM/0,0,60,0,0,1\nFEDRAT/300,MMPM\nGOTO/20,0,60,0,0,1\nGOTO/40,0,60,0,0.5,0.866025404\n"
      "GOTO/60,0,60,0,0,1\nGOTO/80,0,60,0.5,0,0.866025404\nFINI\n";
  for (const char* post : {"fanuc", "siemens", "heidenhain", "linuxcnc"}) {
    const Posted run = run_post(cl, placed_machine("maho_600c"), shipped_post(post), plain(false));
    ASSERT_EQ(read_faults(run), "") << run.text;
    double seconds = 0.0;
    for (const program::NcMove& move : run.moves) seconds += move.rapid ? 0.0 : move.duration_s;
    EXPECT_NEAR(seconds, run.result.plan.feed_s, 5e-3 * run.result.plan.feed_s + 0.02) << post << run.text;
    EXPECT_GE(run.result.plan.feed_s, 80.0 / 5.0 - 1e-9);
  }
}

/// Holes with the tool along the pole stay cycles without a plane, whatever the turn of the table.
TEST(Attack, CyclesAtThePole) {
  const std::string cl =
      kStart +
      "FROM/0,0,80,0,0,1\nRAPID\nGOTO/0,0,60,0,0,1\nCYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,120\n"
      "GOTO/10,0,40,0,0,1\nGOTO/20,5,40,0,0,1\nCYCLE/OFF\nRAPID\nGOTO/20,0,80,0,0,1\nFINI\n";
  for (const char* machine : {"maho_600c", "fork_head", "nutating_head"}) {
    for (const PlaneUse use : {PlaneUse::kCycles, PlaneUse::kConstant}) {
      PostOptions options = plain(true);
      options.planes = use;
      const Posted run = run_post(cl, placed_machine(machine), shipped_post("fanuc"), options);
      ASSERT_EQ(read_faults(run), "") << run.text;
      EXPECT_EQ(run.result.plan.holes, 2);
      EXPECT_EQ(run.result.plan.tilts, 0) << run.text;
    }
  }
}

/// An arc right behind a cycle starts where TCP says, not where the cycle's own coordinates were.
TEST(Attack, AnArcBehindACycle) {
  const std::string cl =
      kStart +
      "FROM/0,0,80,0.3,0,0.953939201\nRAPID\nGOTO/0,0,60,0.3,0,0.953939201\n"
      "CYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,120\nGOTO/10,0,40,0.3,0,0.953939201\nCYCLE/OFF\n"
      "FEDRAT/300,MMPM\nCIRCLE/0,0,41.907878402,0,0,-1,10.6\nGOTO/0,10.6,41.907878402,0.3,0,0.953939201\n"
      "RAPID\nGOTO/0,0,80,0.3,0,0.953939201\nFINI\n";
  for (const char* machine : {"maho_600c", "fork_head", "mikron_ucp710"}) {
    for (const char* post : {"fanuc", "siemens", "heidenhain"}) {
      for (const PlaneUse use : {PlaneUse::kNever, PlaneUse::kCycles, PlaneUse::kConstant}) {
        PostOptions options = plain(true);
        options.planes = use;
        const Posted run = run_post(cl, placed_machine(machine), shipped_post(post), options);
        ASSERT_EQ(read_faults(run), "") << machine << " " << post << "\n" << run.text;
      }
    }
  }
}

TEST(Attack, OnePosition) {
  for (const char* post : {"fanuc", "siemens", "heidenhain", "linuxcnc"}) {
    for (const std::string move : {"", "GOTO/0,0,60,0.3,0,0.953939201\n"}) {
      const Posted run =
          run_post(kStart + "FROM/0,0,60,0.3,0,0.953939201\nFEDRAT/300,MMPM\n" + move + "FINI\n",
                   placed_machine("maho_600c"), shipped_post(post), plain(false));
      if (move.empty()) {
        EXPECT_NE(run.faults.find("[no-motion]"), std::string::npos) << run.faults;
      } else {
        EXPECT_EQ(read_faults(run), "") << run.text;
      }
    }
  }
}

/// CL data in inches: its positions are written in mm.
TEST(Attack, InchesAreWrittenInMillimetres) {
  const Posted run = run_post(
      "$$ SWARF CL DATA\nUNITS/INCHES\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\n"
      "FROM/0,0,2,0,0,1\nFEDRAT/20,IPM\nGOTO/1,0,2,0,0,1\nFINI\n",
      placed_machine("maho_600c"), shipped_post("fanuc"), plain(false));
  ASSERT_EQ(read_faults(run), "") << run.text;
  EXPECT_NE(run.line_with("X25.4 "), "") << run.text;
  EXPECT_NE(run.line_with("F508."), "") << run.text;
}

/// Two decimals: what the digits cost is in the bound; a tolerance below it is refused before anything is
/// written.
TEST(Attack, TwoDecimals) {
  PostFormat coarse = shipped_post("fanuc");
  coarse.numbers.linear.decimals = coarse.numbers.rotary.decimals = 2;
  const std::string cl =
      kStart +
      "FROM/0,0,60,0.3,0,0.953939201\nFEDRAT/300,MMPM\nGOTO/13.333,7.777,61.111,0.1,0.2,0.974679434\n"
      "CIRCLE/3.333,7.777,61.111,0,0,-1,10\nGOTO/3.333,17.777,61.111,0.1,0.2,0.974679434\nFINI\n";
  for (const bool tcp : {false, true}) {
    PostOptions options = plain(tcp);
    options.tip_mm = 0.3;
    const Posted run = run_post(cl, placed_machine("nutating_head"), coarse, options);
    ASSERT_EQ(read_faults(run), "") << run.text;
    EXPECT_GT(run.result.plan.digits_mm, 5e-3);
  }
  PostOptions fine = plain(false);
  fine.tip_mm = 0.004;
  const Posted refused = run_post(cl, placed_machine("nutating_head"), coarse, fine);
  EXPECT_NE(refused.faults.find("[tolerance-below-digits]"), std::string::npos) << refused.faults;
}

/// The same with the 45 degree head as far as it goes: its horizon, from both sides.
TEST(Attack, TheNutatingHeadAtItsHorizon) {
  const std::string cl = kStart +
                         "FROM/0,0,250,0,0,1\nFEDRAT/300,MMPM\nGOTO/10,0,250,0.5,0,0.866025404\n"
                         "GOTO/20,0,250,0.984807753,0,0.173648178\nGOTO/30,0,250,1,0,0\nGOTO/"
                         "30,20,250,0.9,0.3,0.316227766\nFINI\n";
  for (const bool tcp : {false, true}) {
    const Posted run = run_post(cl, placed_machine("nutating_head"), shipped_post("siemens"), plain(tcp));
    ASSERT_EQ(read_faults(run), "") << run.text;
  }
  const Posted below =
      run_post(kStart + "FROM/0,0,250,0,0,1\nFEDRAT/300,MMPM\nGOTO/10,0,250,1,0,-0.01\nFINI\n",
               placed_machine("nutating_head"), shipped_post("siemens"), plain(true));
  EXPECT_NE(below.faults.find("[unreachable]"), std::string::npos) << below.faults;
}

/// Over all choices of start of every stretch, one after the other: dynamic programming finds the least.
TEST(Preferred, IsTheLeastOfAllChoices) {
  const kinematics::MachineModel machine = placed_machine("head_table_bc");
  std::string cl = kStart + "FROM/0,0,80,0.2,0,0.979795897\nFEDRAT/600,MMPM\n";
  for (const double turn : {0.0, 2.2, 4.1}) {
    const auto pose = [&](double along) {
      return fmt::format("{:.4f},{:.4f},80,{:.9f},{:.9f},0.8\n", 30 * std::cos(turn) + along,
                         30 * std::sin(turn), 0.6 * std::cos(turn + 0.02 * along),
                         0.6 * std::sin(turn + 0.02 * along));
    };
    cl += "RAPID\nGOTO/" + pose(0) + "RAPID\nGOTO/" + pose(1) + "GOTO/" + pose(20) + "GOTO/" + pose(40);
  }
  cl += "FINI\n";
  for (const Preference preferred : {Preference::kTime, Preference::kAccuracy, Preference::kTravel}) {
    const auto cost = [&](const PlanSummary& plan) { return preference_cost(preferred, machine, plan); };
    PostOptions options = plain(false);
    options.hooks.routes_most = kRoutesMost;
    options.hooks.cost = cost;
    const Posted best = run_post(cl, machine, shipped_post("linuxcnc"), options);
    ASSERT_EQ(read_faults(best), "") << best.text;
    EXPECT_EQ(best.result.routes_dropped, 0);
    // One of the first three candidates of each of the stretches.
    double least = 1e300;
    const size_t stretches = best.result.choices.size();
    ASSERT_GE(stretches, 3u);
    for (size_t code = 0; code < static_cast<size_t>(std::pow(3, stretches)); ++code) {
      size_t left = code;
      PostOptions forced = plain(false);
      forced.hooks.choice = [&](std::span<const program::Move>, std::vector<Start>& starts) {
        const size_t wanted = std::min(left % 3, starts.size() - 1);
        left /= 3;
        starts = {starts[wanted]};
      };
      const Posted one = run_post(cl, machine, shipped_post("linuxcnc"), forced);
      if (one.faults.empty()) least = std::min(least, cost(one.result.plan));
    }
    EXPECT_LE(cost(best.result.plan), least * (1.0 + 1e-9));
  }
}

}  // namespace
}  // namespace swarf::post::attack_test

// Whole paths: passes, free moves, findings, modes against each other.
#include "unit/motion/interpolated.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/rng.h"
#include "dome.h"
#include "motion/blocks/block_interpolator.h"
#include "motion/judged/motion_check.h"
#include "motion/speed/free_move.h"

namespace swarf::motion::interpolator_test {
namespace {

const cutter::Cutter kCutter;

Interpolated run(const toolpath::ToolPath& path, const MotionOptions& options = {},
                 const kinematics::MachineModel& machine = paper_machine()) {
  Progress silent;
  return interpolate(path, machine, kCutter, options, silent);
}

toolpath::ToolPath dome_path(double feed = 50.0) {
  std::vector<toolpath::SurfacePass> passes;
  for (const double v : {0.0, 0.3, 0.49, 0.52, 1.0}) {
    passes.push_back(iso_pass(dome(), v, feed));
    if (passes.size() % 2 == 0) std::swap(passes.back().t_start, passes.back().t_end);
  }
  return path_of(passes, kCutter.radius());
}

void expect_clean(const Interpolated& result, const kinematics::MachineModel& machine) {
  EXPECT_EQ(check_motion(result.trajectory, machine), "");
  for (const MotionFinding& finding : result.findings) ADD_FAILURE() << finding.code << ": " << finding.text;
}

TEST(Interpolate, DomePathIsCleanAndKeepsAllAxisLimits) {
  const kinematics::MachineModel machine = paper_machine();
  const Interpolated result = run(dome_path());
  expect_clean(result, machine);
  const MotionStatistics& is = result.statistics;
  EXPECT_LT(is.feed_error_max_rel, 1e-9);
  EXPECT_LT(is.fk_ik_error_max_mm, 1e-9);
  EXPECT_LT(is.orientation_error_max_rad, 1e-12);
  EXPECT_LT(is.chord_error_max_mm, 1e-5);
  EXPECT_LT(is.tip_error_max_mm, 1e-3);
  EXPECT_EQ(is.singular_ticks, 0u);
  EXPECT_GT(is.tick_ns_median, 0.0);
  EXPECT_GE(is.tick_ns_p999, is.tick_ns_median);
  EXPECT_EQ(is.ticks + 1, result.trajectory.samples.size());
  ASSERT_EQ(is.axes.size(), 5u);
  for (size_t i = 0; i < 5; ++i) {
    SCOPED_TRACE(is.axes[i].name);
    EXPECT_LE(is.axes[i].speed_max, machine.axes[i].speed_max);
    EXPECT_LE(is.axes[i].acceleration_max, machine.axes[i].acceleration_max);
    EXPECT_GT(is.axes[i].travel, is.axes[i].max - is.axes[i].min - 1e-9);
  }
  // Near the apex the rotary must turn fast and the feed gives way.
  EXPECT_LT(is.feed_min_mm_s, 10.0);
  EXPECT_EQ(is.pole_element, 10);
  // Pass v = .49 runs .8 mm from the apex, where the cross curvature is .01875.
  EXPECT_NEAR(is.pole_distance_min_rad, 0.8 * .01875, 1e-5);
}

TEST(Interpolate, StartsAndStopsAtRestAtEveryElement) {
  const Interpolated result = run(dome_path());
  const auto& samples = result.trajectory.samples;
  for (size_t k = 1; k + 1 < samples.size(); ++k) {
    if (samples[k].element == samples[k + 1].element) continue;
    for (const size_t end : {k, k + 1}) {
      const double speed = (samples[end].pose.tip_W - samples[end - 1].pose.tip_W).norm() / 1e-3;
      EXPECT_LT(speed, 2.0) << "sample " << end;  // a_max T = 2 mm/s
    }
  }
}

TEST(Interpolate, IsDeterministic) {
  const auto hash = [](const Trajectory& trajectory) {
    Hash value;
    for (size_t k = 0; k < trajectory.samples.size(); ++k) {
      for (int i = 0; i < 5; ++i) value.add(trajectory.axes[k][i]);
      for (int i = 0; i < 3; ++i) value.add(trajectory.samples[k].pose.tip_W[i]);
      value.add(trajectory.samples[k].feed_mm_s);
    }
    return value.text();
  };
  EXPECT_EQ(hash(run(dome_path()).trajectory), hash(run(dome_path()).trajectory));
}

TEST(Interpolate, LeanedPassesAreClean) {
  toolpath::SurfacePass pass = iso_pass(dome(), 0.3, 50.0);
  pass.lead_rad = 0.1;
  pass.tilt_rad = -0.05;
  expect_clean(run(path_of({pass}, kCutter.radius())), paper_machine());
}

TEST(Interpolate, PassThroughThePoleChangesTheBranchInsteadOfTurning) {
  // v = .5 meets the pole exactly at u = .5: the tilt goes through zero, the rotary stands still.
  const Interpolated result = run(path_of({iso_pass(dome(), 0.5, 50.0)}, kCutter.radius()));
  expect_clean(result, paper_machine());
  double low = 1e9, high = -1e9;
  for (size_t k = 0; k < result.trajectory.samples.size(); ++k) {
    if (result.trajectory.samples[k].kind != SampleKind::kCutting) continue;
    low = std::min(low, result.trajectory.axes[k][3]);
    high = std::max(high, result.trajectory.axes[k][3]);
  }
  EXPECT_LT(low, -0.5);
  EXPECT_GT(high, 0.5);
}

TEST(Interpolate, RandomNearPolePassesKeepTheAxisSpeeds) {
  constexpr int kCases = 80;
  Rng rng(11);
  for (int i = 0; i < kCases; ++i) {
    // Distance from the apex line between 10 nm and 2 mm, any length.
    const double distance = std::exp(rng.uniform(std::log(1e-5), std::log(2.0)));
    toolpath::SurfacePass pass = iso_pass(dome(), 0.5 + distance / 80.0, rng.uniform(5.0, 120.0));
    pass.t_start = rng.uniform(0.0, 0.45);
    pass.t_end = rng.uniform(0.55, 1.0);
    MotionOptions options;
    if (i % 2 == 1) options.mode = Mode::kTaylor1;
    const Interpolated result = run(path_of({pass}, kCutter.radius()), options);
    SCOPED_TRACE(testing::Message() << (i % 2 == 1 ? "taylor1" : "surface") << ": v 0.5 + " << distance
                                    << " / 80, t " << pass.t_start << " .. " << pass.t_end << ", feed "
                                    << pass.feed_mm_s);
    expect_clean(result, paper_machine());
    for (size_t axis = 0; axis < 5; ++axis)
      EXPECT_LE(result.statistics.axes[axis].acceleration_max, paper_machine().axes[axis].acceleration_max)
          << result.statistics.axes[axis].name;
  }
}

TEST(Interpolate, LeavingThePoleAtOnceIsAFindingAndTakesNoEternity) {
  // The move starts at the pole and wants the rotary at 90 degrees at once: nothing can follow that.
  toolpath::ToolPath path;
  const ToolPose pole{Vec3(0, 0, 50), Vec3::UnitZ()};
  const ToolPose aside{Vec3(0, 0, 50), Vec3(0.5, 0, std::sqrt(0.75))};
  path.elements.push_back({toolpath::FreeMove{toolpath::MoveKind::kRapid, pole, aside, 0.0}, 0,
                           SourceLocation{"test.nc", 11, 1}});
  const Interpolated result = run(path);
  EXPECT_LT(result.statistics.time_s, 10.0);
  ASSERT_FALSE(result.findings.empty());
  EXPECT_EQ(result.findings.front().code, "axis-speed");
}

TEST(Interpolate, TravelBeyondALimitIsAFindingWithAmountAndUnit) {
  kinematics::MachineModel machine = paper_machine();
  const toolpath::ToolPath path = path_of({iso_pass(dome(), 0.3, 50.0)}, kCutter.radius());
  const double reached = run(path).statistics.axes[2].max;
  machine.axes[2].max = std::floor(reached) - 1.0;
  const Interpolated result = run(path, {}, machine);
  const auto finding = std::find_if(result.findings.begin(), result.findings.end(),
                                    [](const MotionFinding& one) { return one.code == "travel"; });
  ASSERT_NE(finding, result.findings.end());
  EXPECT_NE(finding->text.find("axis Z"), std::string::npos) << finding->text;
  EXPECT_NE(finding->text.find("mm beyond its travel of -500.000 .."), std::string::npos) << finding->text;
  EXPECT_EQ(finding->where.line, 11);
  EXPECT_GE(finding->t_s, 0.0);
}

TEST(Interpolate, UnreachablePosesAreAFinding) {
  // Without the rotary table only normals in the plane of the tilt can be reached.
  kinematics::MachineModel machine = paper_machine();
  machine.axes.pop_back();
  machine.table_chain = {3};
  const Interpolated result = run(path_of({iso_pass(dome(), 0.3, 50.0)}, kCutter.radius()), {}, machine);
  const auto finding = std::find_if(result.findings.begin(), result.findings.end(),
                                    [](const MotionFinding& one) { return one.code == "unreachable"; });
  ASSERT_NE(finding, result.findings.end());
  EXPECT_EQ(check_motion(result.trajectory, machine).substr(0, 1), "5");
}

TEST(Interpolate, BadOptionsAreRefused) {
  MotionOptions options;
  options.period_s = 0.0;
  options.path_jerk_max = std::nan("");
  EXPECT_EQ(validate(options).size(), 2u);
  EXPECT_THROW(run(dome_path(), options), InputError);
}

TEST(Interpolate, EndlessPassesAreRefusedWithTheirPlace) {
  try {
    run(path_of({iso_pass(dome(), 0.3, 1e-6)}, kCutter.radius()));
    FAIL() << "a pass of 1e11 cycles was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().front().code, "too-many-cycles");
    EXPECT_EQ(error.diagnostics.list().front().where.line, 11);
  }
}

TEST(Interpolate, StopsBetweenWindowsWhenAsked) {
  struct Impatient : Progress {
    double done = 0.0;
    void advance(double now) override { done = now; }
    bool stop_requested() const override { return done >= 2.0; }
  } impatient;
  const Interpolated result = interpolate(dome_path(2.0), paper_machine(), kCutter, {}, impatient);
  EXPECT_LT(result.trajectory.samples.size(), run(dome_path(2.0)).trajectory.samples.size());
  EXPECT_EQ(result.statistics.ticks + 1, result.trajectory.samples.size());
  EXPECT_EQ(check_motion(result.trajectory, paper_machine()), "");
}

TEST(Offline, SegmentsKeepTheChordToleranceAndUseIt) {
  const toolpath::SurfacePass pass = iso_pass(cylinder_of_eq8(), 0.0, 50.0);
  EXPECT_EQ(segment_pass(pass).size() - 1, 55u);  // theory 1.4, greedy
  toolpath::SurfacePass back = pass;
  std::swap(back.t_start, back.t_end);
  EXPECT_EQ(segment_pass(back).size() - 1, 55u);
}

Interpolated offline(OfflineOrientation orientation, bool look_ahead) {
  MotionOptions options;
  options.mode = Mode::kOffline;
  options.orientation = orientation;
  options.look_ahead = look_ahead;
  return run(path_of({iso_pass(dome(), 0.3, 50.0)}, kCutter.radius()), options);
}

TEST(Offline, ErrorsOfTheThreeOrientations) {
  const auto error = [](OfflineOrientation orientation) {
    const Interpolated result = offline(orientation, false);
    expect_clean(result, paper_machine());
    EXPECT_LE(result.statistics.chord_error_max_mm, 1.001e-3);
    EXPECT_GT(result.statistics.chord_error_max_mm, 0.9e-3);
    return result.statistics.orientation_error_max_rad;
  };
  const double constant = error(OfflineOrientation::kConstant);
  const double in_u = error(OfflineOrientation::kLinearInU);
  const double along_chord = error(OfflineOrientation::kLinearAlongChord);
  // Segments of 2 sqrt(2 R e) = .7 mm on radii of 60 mm turn by about .01 rad.
  EXPECT_NEAR(constant, 0.011, 0.002);
  EXPECT_LT(in_u, 1e-4);
  EXPECT_LT(along_chord, 1e-4);
  EXPECT_GT(along_chord, 1e-8);
}

TEST(Offline, StoppingCostsTimeAndLookAheadWinsItBack) {
  MotionOptions surface;
  const double real_time =
      run(path_of({iso_pass(dome(), 0.3, 50.0)}, kCutter.radius()), surface).statistics.time_s;
  const Interpolated look_ahead = offline(OfflineOrientation::kLinearAlongChord, true);
  expect_clean(look_ahead, paper_machine());
  const double stops = offline(OfflineOrientation::kLinearAlongChord, false).statistics.time_s;
  EXPECT_GT(stops, 2.0 * real_time);
  EXPECT_LT(std::abs(look_ahead.statistics.time_s - real_time), 0.25 * real_time);
}

TEST(FreeMove, RapidsUseTheAxesAndKeepTheirJerk) {
  const kinematics::MachineModel machine = paper_machine();
  const kinematics::InverseKinematics inverse(machine);
  const toolpath::FreeMove move{
      toolpath::MoveKind::kRapid, {Vec3(0, 0, 100), Vec3::UnitZ()}, {Vec3(200, 0, 100), Vec3::UnitZ()}, 0.0};
  const kinematics::AxisValues start = inverse.solve_nearest(move.from, kinematics::AxisValues::Zero()).q;
  const std::vector<ToolSample> samples = sample_free_move(move, machine, inverse, {}, start);
  double p1 = 0, p2 = 0, p3 = 0, fastest = 0, hardest = 0, roughest = 0;
  for (const ToolSample& sample : samples) {
    const double p = sample.pose.tip_W.x();
    fastest = std::max(fastest, (p - p1) / 1e-3);
    hardest = std::max(hardest, std::abs(p - 2 * p1 + p2) / 1e-6);
    roughest = std::max(roughest, std::abs(p - 3 * p1 + 3 * p2 - p3) / 1e-9);
    p3 = p2;
    p2 = p1;
    p1 = p;
  }
  EXPECT_EQ(samples.back().pose.tip_W, move.to.tip_W);
  EXPECT_LE(fastest, 500.0);
  EXPECT_GT(fastest, 490.0);
  EXPECT_LE(hardest, 5000.0);
  EXPECT_LE(roughest, 1e5 * (1 + 1e-9) + 1.0);
}

TEST(FreeMove, NowhereTakesNoTime) {
  const kinematics::MachineModel machine = paper_machine();
  const kinematics::InverseKinematics inverse(machine);
  const ToolPose pose{Vec3(1, 2, 3), Vec3::UnitZ()};
  EXPECT_TRUE(sample_free_move({toolpath::MoveKind::kRapid, pose, pose, 0.0}, machine, inverse, {},
                               kinematics::AxisValues::Zero())
                  .empty());
}

TEST(CheckMotion, NamesTheBrokenInvariant) {
  const kinematics::MachineModel machine = paper_machine();
  const Trajectory good = run(path_of({iso_pass(dome(), 0.3, 50.0)}, kCutter.radius())).trajectory;
  const auto reason = [&](auto&& spoil) {
    Trajectory bad = good;
    spoil(bad);
    return check_motion(bad, machine).substr(0, 1);
  };
  EXPECT_EQ(reason([](Trajectory&) {}), "");
  EXPECT_EQ(reason([](Trajectory& t) { t.axes.pop_back(); }), "1");
  EXPECT_EQ(reason([](Trajectory& t) { t.samples[5].u = std::nan(""); }), "2");
  EXPECT_EQ(reason([](Trajectory& t) { t.samples[5].pose.axis_W *= 1.0 + 1e-11; }), "3");
  EXPECT_EQ(reason([](Trajectory& t) { t.samples[5].t_s += 1e-6; }), "4");
  EXPECT_EQ(reason([](Trajectory& t) { t.axes[5][0] += 1e-8; }), "5");
  kinematics::MachineModel slow = machine;
  slow.axes[0].speed_max = 1.0;
  EXPECT_EQ(check_motion(good, slow).substr(0, 1), "6");
}

}  // namespace
}  // namespace swarf::motion::interpolator_test

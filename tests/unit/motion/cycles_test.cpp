// Cycles made anew from any place are those of the first pass, to the last bit; runs that are longer than the
// look-ahead keep all limits.
#include <gtest/gtest.h>

#include <cstring>

#include "motion/judged/motion_check.h"
#include "unit/motion/random_program.h"

namespace swarf::motion::cycles_test {
namespace {

const cutter::Cutter kCutter;

toolpath::ToolPath dome_path() {
  std::vector<toolpath::SurfacePass> passes;
  for (const double v : {0.0, 0.2, 0.4, 0.49, 0.52, 0.6, 0.8, 1.0}) {
    passes.push_back(iso_pass(dome(), v, 5.0));
    if (passes.size() % 2 == 0) std::swap(passes.back().t_start, passes.back().t_end);
  }
  return path_of(passes, kCutter.radius());
}

bool same(const Cycle& a, const Cycle& b) {
  const auto bits = [](double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  const ToolSample &s = a.sample, &t = b.sample;
  return a.q == b.q && s.pose.tip_W == t.pose.tip_W && s.pose.axis_W == t.pose.axis_W &&
         s.contact_W == t.contact_W && bits(s.t_s, t.t_s) && bits(s.u, t.u) && bits(s.v, t.v) &&
         bits(s.feed_mm_s, t.feed_mm_s) && s.element == t.element && s.kind == t.kind && s.tool == t.tool &&
         s.rounded == t.rounded && a.reached == b.reached;
}

struct Walked {
  std::vector<Cycle> all;
  MotionResult result;
};

Walked walk(Cycles& cycles) {
  Walked walked;
  Progress silent;
  walked.result = interpolate(cycles, silent, [&](std::span<const Cycle> window) {
    walked.all.insert(walked.all.end(), window.begin(), window.end());
  });
  return walked;
}

void expect_random_access(const Cycles& cycles, const std::vector<Cycle>& all, Rng& rng,
                          bool by_place = true) {
  ASSERT_EQ(cycles.size(), all.size());
  CycleReader reader(cycles);
  for (int i = 0; i < 40; ++i) {
    const auto k = static_cast<size_t>(rng.uniform(0.0, 1.0) * static_cast<double>(all.size() - 1));
    for (size_t n = k; n < std::min(all.size(), k + 20); ++n)
      ASSERT_TRUE(same(reader.at(n), all[n])) << "cycle " << n << " of " << all.size();
    if (!by_place) continue;
    // By place: the first that is not short of it.
    const ToolSample& aim = all[k].sample;
    const auto first = std::find_if(all.begin(), all.end(), [&](const Cycle& one) {
      return one.sample.element > aim.element || (one.sample.element == aim.element && one.sample.u >= aim.u);
    });
    ASSERT_EQ(reader.reaching(aim.element, aim.u), static_cast<size_t>(first - all.begin())) << "cycle " << k;
  }
  if (by_place) {
    EXPECT_EQ(reader.reaching(1 << 30, 0.0), all.size() - 1);
  }
}

/// Far steps pass over what lies between; near ones, back too, read on.
void expect_far_steps(const Cycles& cycles, const std::vector<Cycle>& all, Rng& rng) {
  CycleReader reader(cycles);
  for (size_t k = 0; k < all.size();) {
    for (const size_t n : {k, k > 5 ? k - 5 : 0, std::min(k + 3, all.size() - 1)})
      ASSERT_TRUE(same(reader.at(n), all[n])) << "cycle " << n << " of " << all.size();
    k += 1 + static_cast<size_t>(rng.uniform(0.0, 60'000.0));
  }
}

TEST(Cycles, OfSurfacePassesAreMadeAnewFromAnyPlace) {
  Rng rng(7);
  const kinematics::MachineModel machine = paper_machine();
  const toolpath::ToolPath path = dome_path();
  for (const Mode mode : {Mode::kSurface, Mode::kOffline}) {
    MotionOptions options;
    options.mode = mode;
    Cycles cycles(path.elements, std::span(&machine, 1), kCutter, options, {{}, 0});
    const Walked walked = walk(cycles);
    EXPECT_GT(cycles.places().size(), 1U);
    expect_random_access(cycles, walked.all, rng, false);
  }
}

TEST(Cycles, OfBlocksAreMadeAnewFromAnyPlaceWhateverTheLookAhead) {
  const kinematics::MachineModel machine = paper_machine();
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    Rng rng(seed);
    const toolpath::ToolPath path = random_program(machine, rng, 400);
    const LookAheadReach reach = seed % 2 == 0 ? LookAheadReach{60, 20} : LookAheadReach{};
    const size_t kept = seed % 3 == 0 ? 777 : 0;
    Cycles cycles(path.elements, std::span(&machine, 1), cutter::Cutter{}, MotionOptions{}, {reach, kept});
    SCOPED_TRACE(fmt::format("Rng rng({})", seed));
    const Walked walked = walk(cycles);
    expect_random_access(cycles, walked.all, rng);
  }
}

TEST(Cycles, RunsBeyondTheLookAheadKeepAllLimitsAndLoseLittleTime) {
  const kinematics::MachineModel machine = paper_machine();
  double slower = 0.0;
  int stretched = 0;
  for (uint64_t seed = 2000; seed < 2012; ++seed) {
    Rng rng(seed);
    const toolpath::ToolPath path = random_program(machine, rng, 300);
    Progress silent;
    const Interpolated whole = interpolate(path, machine, cutter::Cutter{}, MotionOptions{}, silent);
    const Interpolated part =
        interpolate(path, machine, cutter::Cutter{}, MotionOptions{}, silent, {100, 40});
    SCOPED_TRACE(fmt::format("Rng rng({})", seed));
    EXPECT_EQ(check_motion(part.trajectory, machine), "");
    EXPECT_LE(axis_excess(part.trajectory, machine).relative, 1e-9);
    EXPECT_GE(part.statistics.time_s, whole.statistics.time_s - 1e-2);
    slower = std::max(slower, part.statistics.time_s / whole.statistics.time_s - 1.0);
    if (part.statistics.ticks != whole.statistics.ticks) ++stretched;
  }
  fmt::print("stretches of 100 cells that see 40 ahead: {} programs differ, the slowest by {:.4f} %\n",
             stretched, 100.0 * slower);
  EXPECT_LT(slower, 0.01);
}

/// Slow and long: each stretch has many windows of cycles, so that a reader passes over most of them.
TEST(Cycles, AFarCycleIsFoundWithoutThoseBeforeIt) {
  const kinematics::MachineModel machine = paper_machine();
  for (uint64_t seed = 31; seed <= 36; ++seed) {
    Rng rng(seed);
    toolpath::ToolPath path = random_program(machine, rng, 300);
    std::vector<toolpath::Element> elements(path.elements.begin(), path.elements.end());
    for (toolpath::Element& element : elements) {
      auto& block = std::get<toolpath::BlockMove>(element.what);
      if (!is_rapid(block)) block.feed_mm_s = 0.05;
    }
    path.elements = toolpath::Elements(elements);
    const LookAheadReach reach = seed % 2 == 0 ? LookAheadReach{60, 20} : LookAheadReach{};
    MotionOptions options;
    options.period_s = 1e-2;
    Cycles cycles(path.elements, std::span(&machine, 1), cutter::Cutter{}, options, {reach, 0});
    SCOPED_TRACE(fmt::format("Rng rng({})", seed));
    const Walked walked = walk(cycles);
    EXPECT_GT(walked.all.size(), 2 * CycleStream::kWindow);
    expect_far_steps(cycles, walked.all, rng);
  }
}

TEST(Cycles, AMotionIsRecalledFromItsPlacesAndRefusedWhereItIsAnother) {
  const kinematics::MachineModel machine = paper_machine();
  int refused = 0;
  for (uint64_t seed = 41; seed <= 44; ++seed) {
    Rng rng(seed);
    toolpath::ToolPath path = random_program(machine, rng, 400);
    const CycleLimits limits{LookAheadReach{60, 20}, 0};
    Cycles first(path.elements, std::span(&machine, 1), cutter::Cutter{}, MotionOptions{}, limits);
    SCOPED_TRACE(fmt::format("Rng rng({})", seed));
    const Walked walked = walk(first);
    Cycles again(path.elements, std::span(&machine, 1), cutter::Cutter{}, MotionOptions{}, limits);
    again.recall(first.recalled());
    expect_random_access(again, walked.all, rng);

    // Another law of speed: refused where the cycles behind the place show it.
    MotionOptions other;
    other.path_acceleration_max *= 0.5;
    Cycles changed(path.elements, std::span(&machine, 1), cutter::Cutter{}, other, limits);
    walk(changed);
    const bool shows = changed.recalled().checks.front() != first.recalled().checks.front();
    Cycles wrong(path.elements, std::span(&machine, 1), cutter::Cutter{}, other, limits);
    wrong.recall(first.recalled());
    CycleReader reader(wrong);
    if (shows) {
      EXPECT_THROW(reader.at(0), InputError);
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

/// The second block dwells.
toolpath::ToolPath with_dwell(toolpath::ToolPath path, double dwell_s) {
  std::vector<toolpath::Element> elements(path.elements.begin(), path.elements.end());
  std::get<toolpath::BlockMove>(elements[1].what).dwell_s = dwell_s;
  elements[1].where = {"slow.nc", 7, 1};
  path.elements = toolpath::Elements(elements);
  return path;
}

/// A dwell, a stop of the user, and an empty path.
TEST(Cycles, ADwellIsWalkedThroughInWindows) {
  const kinematics::MachineModel machine = paper_machine();
  Rng rng(5);
  const toolpath::ToolPath path = with_dwell(random_program(machine, rng, 3), 100.0);  // 100 000 cycles
  Cycles cycles(path.elements, std::span(&machine, 1), cutter::Cutter{}, MotionOptions{});
  const Walked walked = walk(cycles);
  EXPECT_NEAR(walked.result.statistics.cycle.dwell_s, 100.0, 0.01);
  expect_random_access(cycles, walked.all, rng);
}

TEST(Cycles, AProgramOfMonthsIsRefusedWithItsBlock) {
  const kinematics::MachineModel machine = paper_machine();
  Rng rng(5);
  const toolpath::ToolPath path = with_dwell(random_program(machine, rng, 3), 1e9);
  Cycles cycles(path.elements, std::span(&machine, 1), cutter::Cutter{}, MotionOptions{});
  Progress silent;
  try {
    interpolate(cycles, silent);
    FAIL() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().front().code, "too-many-cycles");
    EXPECT_EQ(error.diagnostics.list().front().where.line, 7);
  }
}

}  // namespace
}  // namespace swarf::motion::cycles_test

// A run that the user stops at any moment leaves a stock to go on from: the finished one is that of a run
// that was never stopped.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "sim/simulation.h"
#include "support/program_run.h"

namespace swarf::sim {
namespace {

/// Asks to stop when it has been looked at so often.
class StopAfter : public Progress {
 public:
  explicit StopAfter(int looks) : left_(looks) {}
  bool stop_requested() const override { return left_.fetch_sub(1) <= 0; }

 private:
  mutable std::atomic<int> left_;
};
/// Counts how often a whole run looks.
class CountLooks : public Progress {
 public:
  bool stop_requested() const override {
    ++looks;
    return false;
  }
  mutable std::atomic<int> looks{0};
};

struct StoppedJob {
  const char* scene;
  std::vector<std::string> overrides;
};
void PrintTo(const StoppedJob& job, std::ostream* out) {
  *out << job.scene;
}

class StoppedRun : public testing::TestWithParam<StoppedJob> {};

TEST_P(StoppedRun, GoesOnFromEveryMoment) {
  const Job job = load_job(fmt::format("{}/scenes/{}/scene.toml", SWARF_SOURCE_DIR, GetParam().scene),
                           GetParam().overrides);
  CountLooks whole;
  const Result expected = simulate(job, {}, whole);
  const auto folder = test::fresh_folder(std::string("stopped_run_") + GetParam().scene);
  const std::string file = (folder / "stock.vdb").string();
  int uncut = 0, partly = 0;
  // The first looks are those between the windows of the interpolation; of the others every quarter.
  for (int looks = 0; looks < whole.looks; looks += looks < 2 ? 1 : std::max(1, whole.looks / 4)) {
    SCOPED_TRACE(fmt::format("stopped at look {} of {}", looks, whole.looks));
    StopAfter stop(looks);
    const Result part = simulate(job, {}, stop);
    // How often the proof looks depends on the threads: at its end a run may be over before it is asked.
    if (!part.stopped) {
      EXPECT_GT(10 * looks, 9 * whole.looks);
      EXPECT_EQ(part.stock->hash(), expected.stock->hash());
      break;
    }
    part.stock->save(file, part.cut.metadata);
    ++(part.cut.state.sweeps == 0 ? uncut : partly);
    CutOptions options;
    options.resume_file = file;
    // Stopped again before it has come anywhere: nothing of what was cut is lost.
    StopAfter at_once(0);
    const Result again = simulate(job, options, at_once);
    ASSERT_TRUE(again.stopped);
    EXPECT_EQ(again.cut.state.sweeps, part.cut.state.sweeps);
    again.stock->save(file, again.cut.metadata);
    Progress silent;
    const Result resumed = simulate(job, options, silent);
    EXPECT_FALSE(resumed.stopped);
    ASSERT_EQ(resumed.stock->hash(), expected.stock->hash());
    EXPECT_EQ(clearance_text(resumed.clearance), clearance_text(expected.clearance));
    EXPECT_EQ(bad_cuts_text(resumed.cut.state.bad_cuts), bad_cuts_text(expected.cut.state.bad_cuts));
  }
  EXPECT_GT(uncut, 0);
  EXPECT_GT(partly, 0);
  std::filesystem::remove_all(folder);
}

/// Counts the steps that are told of one stage.
class StepsOf : public Progress {
 public:
  explicit StepsOf(std::string stage) : stage_(std::move(stage)) {}
  void begin(std::string_view stage, double total, std::string_view /*unit*/) override {
    counts_ = stage == stage_;
    total_ = total;
  }
  void advance(double done) override {
    if (!counts_) return;
    EXPECT_GT(done, last);
    EXPECT_LT(done, total_);
    last = done;
  }
  double last = 0.0;

 private:
  std::string stage_;
  bool counts_ = false;
  double total_ = 0.0;
};

TEST(RunProgress, OfTheMeasuringRaysIsToldWhileTheyAreMade) {
  const Job job = load_job(SWARF_SOURCE_DIR "/scenes/exact_rounded_corner/scene.toml",
                           {"stock.voxel_mm=0.5", "accept.gouge_max_um=100", "accept.excess_max_um=1000"});
  StepsOf rays("cut measuring rays");
  simulate(job, {}, rays);
  EXPECT_EQ(rays.last, 4.0);
}

// Wide limits: that they hold is soon proven, and the stocks are what is compared.
INSTANTIATE_TEST_SUITE_P(
    Jobs, StoppedRun,
    testing::Values(StoppedJob{"exact_rounded_corner",
                               {"stock.voxel_mm=0.5", "accept.gouge_max_um=100",
                                "accept.excess_max_um=1000"}},
                    StoppedJob{"nc_pocket", {"stock.voxel_mm=0.8"}},
                    StoppedJob{"lin_koren_dome",
                               {"stock.voxel_mm=2", "design.pitch_mm=3", "toolpath.compare=false",
                                "interpolator.period_ms=4", "accept.gouge_max_um=100",
                                "accept.excess_max_um=100", "accept.scallop_max_um=100"}}),
    [](const testing::TestParamInfo<StoppedJob>& one) { return std::string(one.param.scene); });

}  // namespace
}  // namespace swarf::sim

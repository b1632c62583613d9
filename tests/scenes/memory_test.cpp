// Memory on the shipped program: predicted within 15 % of the real peak, and refused when it is too much.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/json_path.h"
#include "support/program_run.h"

namespace memory_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::run_swarf;

const std::string kScene = SWARF_SOURCE_DIR "/scenes/lin_koren_dome/scene.toml";
const std::string kAlone = std::string(" --set toolpath.compare=false ") + swarf::test::kSoonProven;

struct Setting {
  const char *name, *options;
  const char* scene = "lin_koren_dome";
  const char* limits = swarf::test::kSoonProven;
};
void PrintTo(const Setting& setting, std::ostream* out) {
  *out << setting.name;
}

class MemoryTest : public testing::TestWithParam<Setting> {};

TEST_P(MemoryTest, IsPredictedWithin15Percent) {
  const fs::path out = swarf::test::fresh_folder(std::string("memory_") + GetParam().name) / "run";
  const auto run = run_swarf("run " SWARF_SOURCE_DIR "/scenes/" + std::string(GetParam().scene) +
                             "/scene.toml " + GetParam().options + GetParam().limits + "-o " + out.string());
  ASSERT_LE(run.exit_code, 1) << run.output;
  const json metrics = json::parse(std::ifstream(out / "metrics.json"));
  const double predicted = at_path(metrics, "memory_predicted_mb"), peak = at_path(metrics, "memory_peak_mb");
  std::printf("%s: predicted %.0f MB, peak %.0f MB, ratio %.3f\n", GetParam().name, predicted, peak,
              predicted / peak);
  EXPECT_NEAR(predicted / peak, 1.0, 0.15);
  EXPECT_NE(run.output.find("memory: stock "), std::string::npos) << run.output;
  fs::remove_all(out.parent_path());
}

// What takes the most memory differs: the path, the rays, a fine stock, comparisons, a movie, stills; where a
// limit breaks all over, the proof's list of it would.
INSTANTIATE_TEST_SUITE_P(
    Runs, MemoryTest,
    testing::Values(Setting{"path",
                            "--no-render --set toolpath.compare=false --set stock.voxel_mm=2 "
                            "--set design.pitch_mm=2 --set interpolator.period_ms=0.5"},
                    Setting{"rays",
                            "--no-render --set toolpath.compare=false --set stock.voxel_mm=0.5 "
                            "--set design.pitch_mm=0.1",
                            "lin_koren_dome", " "},
                    Setting{"stock",
                            "--no-render --set toolpath.compare=false --set stock.voxel_mm=0.14 "
                            "--set design.pitch_mm=1"},
                    Setting{"comparisons", "--no-render --set stock.voxel_mm=1 --set design.pitch_mm=0.5"},
                    Setting{"stills", "--set stills.samples=1", "cl_simple_block"},
                    Setting{"large_still",
                            "--set stills.samples=1 --set 'stills.kinds=[\"part\"]' "
                            "--set 'stills.size=[3840,2160]'",
                            "cl_simple_block"},
                    Setting{"fine_still",
                            "--set toolpath.compare=false --set stills.samples=1 --set movie.seconds=0 "
                            "--set 'stills.kinds=[\"deviation\"]' --set stock.voxel_mm=0.25 "
                            "--set design.pitch_mm=1"},
                    Setting{"broken", "--no-render --set design.pitch_mm=0.25", "exact_walls", " "},
                    Setting{"movie",
                            "--set toolpath.compare=false --set stock.voxel_mm=0.4 --set design.pitch_mm=0.5 "
                            "--set movie.seconds=0.2"}),
    [](const testing::TestParamInfo<Setting>& one) { return std::string(one.param.name); });

TEST(MemoryLimit, IsRefusedWithAVoxelThatFits) {
  const fs::path out = swarf::test::fresh_folder("memory_limit") / "run";
  const std::string options =
      kAlone + "--no-render --set design.pitch_mm=1 --max-memory 300 -o " + out.string();
  const auto refused = run_swarf("run " + kScene + " --set stock.voxel_mm=0.1" + options);
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("[out-of-memory]"), std::string::npos) << refused.output;
  EXPECT_FALSE(fs::exists(out));
  const size_t at = refused.output.find("voxel_mm = ", refused.output.find("fix: "));
  ASSERT_NE(at, std::string::npos) << refused.output;
  const std::string fitting = std::to_string(std::stod(refused.output.substr(at + 11)));
  const auto accepted = run_swarf("run " + kScene + " --set stock.voxel_mm=" + fitting + options);
  EXPECT_EQ(accepted.exit_code, 0) << accepted.output;
  fs::remove_all(out.parent_path());
}

/// Where a picture takes it all, no voxel is named that would not help, but a size that fits.
TEST(MemoryLimit, OfALargeStillNamesASizeThatFits) {
  const fs::path out = swarf::test::fresh_folder("memory_still") / "run";
  const auto run_with = [&](int width, int height) {
    return run_swarf(
        "run " SWARF_SOURCE_DIR
        "/scenes/exact_gouges/scene.toml --set 'stills.kinds=[\"part\"]' --set stills.samples=1 " +
        fmt::format("--set 'stills.size=[{},{}]' --max-memory 420 -o {}", width, height, out.string()));
  };
  const auto refused = run_with(2560, 1440);
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("[out-of-memory]"), std::string::npos) << refused.output;
  EXPECT_FALSE(fs::exists(out));
  const std::string named = "fix: stills.size = [2560, 1440] is too large: ";
  const size_t at = refused.output.find(named);
  ASSERT_NE(at, std::string::npos) << refused.output;
  int width = 0, height = 0;
  ASSERT_EQ(std::sscanf(refused.output.c_str() + at + named.size(), "[%d, %d] fits", &width, &height), 2);
  const auto accepted = run_with(width, height);
  EXPECT_EQ(accepted.exit_code, 1) << "the gouges: " << accepted.output;
  fs::remove_all(out.parent_path());
}

/// Where the movie's own stock takes it all, its voxel is named and not that of the stock.
TEST(MemoryLimit, OfAFineMovieNamesItsVoxel) {
  const fs::path out = swarf::test::fresh_folder("memory_movie") / "run";
  const auto refused = run_swarf("run " SWARF_SOURCE_DIR
                                 "/scenes/nc_pocket/scene.toml --set 'stills.kinds=[]' --set "
                                 "movie.voxel_mm=0.05 --max-memory 700 -o " +
                                 out.string());
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("[out-of-memory]"), std::string::npos) << refused.output;
  EXPECT_NE(refused.output.find("fix: movie.voxel_mm = 0.05 is too fine: 0."), std::string::npos)
      << refused.output;
  EXPECT_FALSE(fs::exists(out));
  // The stock goes to the disk, the movie's own does not: what was said to be enough was twenty times as
  // much.
  const auto spilled = run_swarf("run " SWARF_SOURCE_DIR
                                 "/scenes/nc_pocket/scene.toml --set 'stills.kinds=[]' --set "
                                 "movie.voxel_mm=0.05 --max-memory 700 --spill -o " +
                                 out.string());
  EXPECT_EQ(spilled.exit_code, 2) << spilled.output;
  EXPECT_NE(spilled.output.find("a movie.voxel_mm above 0.05 takes less"), std::string::npos)
      << spilled.output;
}

}  // namespace

}  // namespace memory_test

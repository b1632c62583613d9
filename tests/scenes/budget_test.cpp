// --budget and output.budget_s: proofs end in time, pictures are left out by name, and nothing turns green by
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "mesh/mesh_io.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace budget_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::run_swarf;

/// A block that a wide tool faces by 1 mm. The design is what is left, or lies lower by `left_mm`.
std::string faced(const fs::path& folder, double left_mm = 0.0) {
  const double top = -1.0 - left_mm;
  swarf::mesh::save_mesh((folder / "part.stl").string(),
                         swarf::test::towers({0, 20}, {0, 20}, -10.0, [&](int, int) { return top; }));
  swarf::test::write_text(
      folder / "face.nc",
      "%\nG21 G90 G17 G54\nT1 M6\nS3000 M3\nG0 X-40 Y10\nG43 H1 Z5\nG1 Z-1 F900\nX60\nG0 Z50\nM30\n%\n");
  swarf::test::write_text(
      folder / "scene.toml",
      "nc = \"face.nc\"\ntools = \"T1=30\"\nstock.box_mm = [[0, 0, -10], [20, 20, 0]]\n"
      "stock.voxel_mm = 0.5\nsetup.work_origin_mm = \"on_table\"\n[design]\nmesh = \"part.stl\"\n"
      "[accept]\ngouge_max_um = 2\nexcess_max_um = 10\n[movie]\nseconds = 1\nsize = [160, 120]\n");
  return (folder / "scene.toml").string();
}

struct Told {
  int exit_code;
  std::string output;
  nlohmann::json metrics;
  std::string outcome(const std::string& name) const {
    for (const auto& check : metrics.at("checks"))
      if (check.at("name") == name) return check.at("outcome");
    return "";
  }
};

Told run(const fs::path& folder, const std::string& words) {
  const auto done =
      run_swarf("run " + (folder / "scene.toml").string() + " -o " + (folder / "out").string() + " " + words);
  const fs::path file = folder / "out/metrics.json";
  return {done.exit_code, done.output,
          fs::exists(file) ? nlohmann::json::parse(swarf::test::read_text(file)) : nlohmann::json()};
}

TEST(TimeBudget, ThatIsSpentLeavesTheLimitsUnprovenAndNamesWhatIsMissing) {
  const fs::path folder = swarf::test::fresh_folder("budget_spent");
  faced(folder);
  const Told spent = run(folder, "--budget 0.001s");
  EXPECT_EQ(spent.exit_code, 1) << spent.output;
  EXPECT_EQ(spent.outcome("gouge"), "not_proven");
  EXPECT_EQ(spent.outcome("excess"), "not_proven");
  EXPECT_NE(spent.output.find("the time budget of 0.001 s ended the proof"), std::string::npos)
      << spent.output;
  EXPECT_NE(spent.output.find("left out"), std::string::npos) << spent.output;
  const auto& left_out = spent.metrics.at("budget").at("left_out");
  for (const char* file : {"part.glb", "movie.mp4", "still_part.png"})
    EXPECT_NE(std::find(left_out.begin(), left_out.end(), file), left_out.end()) << file;
  EXPECT_FALSE(fs::exists(folder / "out/movie.mp4"));
  EXPECT_TRUE(fs::exists(folder / "out/report.html"));
  EXPECT_TRUE(fs::exists(folder / "out/stock.vdb"));
}

TEST(TimeBudget, ThatSufficesChangesNothing) {
  const fs::path folder = swarf::test::fresh_folder("budget_enough");
  faced(folder);
  const Told plain = run(folder, "--no-render");
  const Told limited = run(folder, "--no-render --budget 30min");
  EXPECT_EQ(plain.exit_code, 0) << plain.output;
  EXPECT_EQ(limited.exit_code, 0) << limited.output;
  EXPECT_TRUE(plain.metrics.at("budget").is_null());
  EXPECT_EQ(limited.metrics.at("budget").at("seconds"), 1800.0);
  EXPECT_TRUE(limited.metrics.at("budget").at("left_out").empty());
  EXPECT_EQ(plain.metrics.at("surface"), limited.metrics.at("surface"));
}

TEST(TimeBudget, DoesNotHideWhatTheRaysHaveFound) {
  const fs::path folder = swarf::test::fresh_folder("budget_fault");
  faced(folder, 0.05);
  const Told fails = run(folder, "--no-render --set output.budget_s=0.001");
  EXPECT_EQ(fails.exit_code, 1) << fails.output;
  EXPECT_EQ(fails.outcome("excess"), "fails");
}

TEST(TimeBudget, OfNothingOrInOtherUnitsIsRefused) {
  const fs::path folder = swarf::test::fresh_folder("budget_refused");
  const std::string scene = faced(folder);
  for (const char* words : {"--budget 0", "--budget -3s", "--budget 5parsecs", "--set output.budget_s=0"})
    EXPECT_EQ(run_swarf("run " + scene + " " + words).exit_code, 2) << words;
}

}  // namespace
}  // namespace budget_test

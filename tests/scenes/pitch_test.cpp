// What is measured does not hang on where the rays stand: the exact scenes at pitches far coarser and finer
// than their own, on the shipped program. Gouge, excess and scallop move by less than 0.2 um or 0.5 %, what a
// scene claims of them; verdict, outcomes and exit code do not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program_run.h"

namespace pitch_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kClaimUm = 0.2, kClaimShare = 0.005;

struct Measured {
  int exit_code = 0;
  json metrics;
};

Measured run(const std::string& scene, const std::string& pitch) {
  const fs::path folder = swarf::test::fresh_folder("pitch_" + scene);
  const auto ran = swarf::test::run_swarf("run " SWARF_SOURCE_DIR "/scenes/" + scene + "/scene.toml -o " +
                                          (folder / "run").string() + " --no-render" +
                                          (pitch.empty() ? "" : " --set design.pitch_mm=" + pitch));
  EXPECT_LE(ran.exit_code, 1) << ran.output;
  Measured measured{ran.exit_code, json::parse(std::ifstream(folder / "run" / "metrics.json"))};
  fs::remove_all(folder);
  return measured;
}

/// "gouge fails, excess not_judged, ..": all but the check of the grid by the rays, which is no measure.
std::string outcomes(const json& metrics) {
  std::string text;
  for (const json& check : metrics.at("checks")) {
    if (check.at("name") == "stock_and_rays") continue;
    text += check.at("name").get<std::string>() + " " + check.at("outcome").get<std::string>() + ", ";
  }
  return text;
}

/// Raw stock over a patch reaches up to where the patch itself is as near, which is only known to a pitch: no
/// claim, unless it is proven.
bool is_left_uncut(const json& metrics) {
  const json& surface = metrics.at("surface");
  const nlohmann::json& bound = surface.at("excess_bound_um");
  const double most = surface.at("excess_max_um").get<double>();
  return most > 1000.0 && (bound.is_null() || bound.get<double>() > 1.05 * most);
}

class AnyPitch : public testing::TestWithParam<const char*> {};

TEST_P(AnyPitch, MeasuresAndJudgesTheSame) {
  const Measured own = run(GetParam(), "");
  for (const char* pitch : {"2", "0.33"}) {
    const Measured other = run(GetParam(), pitch);
    EXPECT_EQ(other.exit_code, own.exit_code) << pitch;
    EXPECT_EQ(outcomes(other.metrics), outcomes(own.metrics)) << pitch;
    for (const char* figure : {"gouge_max_um", "excess_max_um", "scallop_max_um"}) {
      if (std::string(figure) == "excess_max_um" && is_left_uncut(own.metrics)) continue;
      const double a = own.metrics.at("surface").at(figure), b = other.metrics.at("surface").at(figure);
      EXPECT_GE(b, 0.0) << figure << " at " << pitch;
      EXPECT_NEAR(b, a, std::max(kClaimUm, kClaimShare * std::abs(a))) << figure << " at " << pitch;
    }
    const json& surface = other.metrics.at("surface");
    // What stands on a ridge is material.
    EXPECT_GE(surface.at("excess_max_um").get<double>(), surface.at("scallop_max_um").get<double>()) << pitch;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, AnyPitch,
                         testing::Values("exact_between_rays", "exact_gouges", "exact_walls",
                                         "exact_scallop_ball_plane", "exact_scallop_ball_convex",
                                         "exact_scallop_ball_concave", "exact_scallop_flat_cylinder",
                                         "exact_scallop_flat_lead", "exact_scallop_flat_oblique",
                                         "exact_scallop_mesh", "exact_slot_flat", "exact_slot_ball",
                                         "exact_rounded_corner", "exact_flank_f1"),
                         [](const auto& one) { return one.param; });

}  // namespace

}  // namespace pitch_test

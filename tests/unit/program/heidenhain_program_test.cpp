// A whole program: a dome with the tool along its normals and four holes square to its flanks.
#include "unit/program/heidenhain_support.h"

namespace swarf::program::heidenhain_program_test {
namespace {

const char* const kProgram = "tests/data/programs/nc/heidenhain/good/dome_and_holes.h";

TEST(HeidenhainProgram, DomeAndHoles) {
  const std::string path = (std::filesystem::path(SWARF_SOURCE_DIR) / kProgram).string();
  const NcRun run = run_file(path, std::nullopt, five_axis_setup());
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(run.summary.dialect, Dialect::kHeidenhain);
  EXPECT_EQ(run.summary.tools_used, (std::vector<int>{1, 2}));
  const Vec3 centre(0, 0, -20);
  int on_dome = 0;
  std::vector<NcMove> bottoms;
  for (size_t i = 0; i < run.moves().size(); ++i) {
    const NcMove& move = run.moves()[i];
    if (move.law == BlockLaw::kTcp) {
      ++on_dome;
      const Vec3 out = move.to.tip_W - centre;
      EXPECT_NEAR(out.norm(), 20.0, 1e-9);
      EXPECT_NEAR((move.to.axis_W - out / 20.0).norm(), 0.0, 1e-9);
    }
    if (move.tool == 2 && !move.rapid && run.moves()[i + 1].dwell_s > 0.0) bottoms.push_back(move);
  }
  EXPECT_EQ(on_dome, 41);  // 0 to 60 degrees by 1.5
  ASSERT_EQ(bottoms.size(), 4u);
  for (size_t i = 0; i < bottoms.size(); ++i) {
    const double azimuth = 0.5 * kPi * static_cast<double>(i), polar = kPi / 6.0;
    const Vec3 normal(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                      std::cos(polar));
    EXPECT_NEAR((bottoms[i].to.tip_W - (centre + 12.0 * normal)).norm(), 0.0, 1e-9) << i;
    EXPECT_NEAR((bottoms[i].to.axis_W - normal).norm(), 0.0, 1e-9) << i;
  }
}

}  // namespace
}  // namespace swarf::program::heidenhain_program_test

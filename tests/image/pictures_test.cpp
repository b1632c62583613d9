// Pictures of three jobs and two frames of a movie against committed references. Refresh them with
// SWARF_REFRESH_REFERENCES=1.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "image/movie_frames.h"
#include "image/reference_picture.h"
#include "render/image_io.h"
#include "support/program_run.h"

namespace swarf::test {
namespace {

namespace fs = std::filesystem;
using render::Image;

/// A finished run of a scene; each is made once.
struct SceneRun {
  fs::path folder;
  ProgramRun run;
};
const SceneRun& scene_run(const std::string& scene, const std::string& options) {
  static std::map<std::string, SceneRun> runs;
  const auto [found, made] = runs.try_emplace(scene);
  if (made) {
    found->second.folder = fresh_folder("pictures_" + scene) / "run";
    found->second.run = run_swarf("run " SWARF_SOURCE_DIR "/scenes/" + scene + "/scene.toml -o " +
                                  found->second.folder.string() + " " + options);
  }
  return found->second;
}

const SceneRun& dome() {
  return scene_run("lin_koren_dome",
                   "--set movie.seconds=0 --set toolpath.compare=false --set 'stills.size=[480,270]' "
                   "--set stills.samples=4");
}

class DomePictures : public testing::TestWithParam<const char*> {};

TEST_P(DomePictures, LookLikeTheReference) {
  ASSERT_EQ(dome().run.exit_code, 0) << dome().run.output;
  const std::string name = std::string("still_") + GetParam() + ".png";
  expect_like_reference(render::load_png((dome().folder / name).string()), name);
}

INSTANTIATE_TEST_SUITE_P(Stills, DomePictures, testing::Values("machine", "part", "deviation", "fan"));

struct LaterStill {
  const char *scene, *kind, *camera;
};

class LaterPictures : public testing::TestWithParam<LaterStill> {};

TEST_P(LaterPictures, LookLikeTheReference) {
  const LaterStill& still = GetParam();
  const SceneRun& job = scene_run(still.scene, "--no-render");
  ASSERT_EQ(job.run.exit_code, still.scene == std::string("exact_gouges") ? 1 : 0) << job.run.output;
  const std::string name = fmt::format("{}_{}.png", still.scene, still.kind);
  const ProgramRun run =
      run_swarf(fmt::format("render {} --still {} --kind {} --camera {} --size 480 270 --samples 4",
                            job.folder.string(), (job.folder / name).string(), still.kind, still.camera));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  expect_like_reference(render::load_png((job.folder / name).string()), name);
}

INSTANTIATE_TEST_SUITE_P(Stills, LaterPictures,
                         testing::Values(LaterStill{"nc_pocket", "part", "iso"},
                                         LaterStill{"nc_pocket", "machine", "machine"},
                                         LaterStill{"exact_gouges", "deviation", "top"},
                                         LaterStill{"exact_gouges", "fan", "left"}),
                         [](const auto& info) {
                           return fmt::format("{}_{}", info.param.scene, info.param.kind);
                         });

TEST(MoviePictures, AThirdAndTheEndLookLikeTheReference) {
  const SceneRun& job = scene_run("nc_pocket", "--no-render");
  const fs::path movie = job.folder / "movie.mp4";
  const ProgramRun run = run_swarf(
      fmt::format("render {} --movie {} --seconds 1 --size 480 270", job.folder.string(), movie.string()));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const std::vector<Image> frames = movie_frames(movie.string());
  ASSERT_EQ(frames.size(), 30u);
  expect_like_reference(frames[10], "movie_frame_10.png");
  expect_like_reference(frames[29], "movie_frame_29.png");
}

/// The stock's part of the picture is what the whole picture's mean let pass.
TEST(PictureDifference, APartThatIsMissingIsSeen) {
  const Image reference = render::load_png((kReferences / "still_part.png").string());
  Image empty = reference;
  for (int y = 0; y < empty.height; ++y) {
    for (int x = 1; x < empty.width; ++x) {
      for (size_t c = 0; c < 4; ++c) {
        const auto row = static_cast<size_t>(y) * static_cast<size_t>(empty.width);
        empty.rgba[4 * (row + static_cast<size_t>(x)) + c] = reference.rgba[4 * row + c];
      }
    }
  }
  EXPECT_GT(largest_difference(empty, reference).mean, 5.0 * kTileTolerance);
  EXPECT_EQ(largest_difference(reference, reference).mean, 0.0);
}

TEST(PictureDifference, IsTheMeanOfTheWorstTile) {
  const auto grey = [](uint8_t value) { return Image{40, 20, std::vector<uint8_t>(4 * 40 * 20, value)}; };
  Image changed = grey(100);
  // The tile at (32, 16) has 8 x 4 pixels; half of its red ones become darker by 30, one alpha is lost.
  for (int x = 32; x < 40; ++x)
    for (int y = 16; y < 18; ++y) changed.rgba[static_cast<size_t>(4 * (y * 40 + x))] = 70;
  changed.rgba[3] = 0;
  const TileDifference worst = largest_difference(changed, grey(100));
  EXPECT_DOUBLE_EQ(worst.mean, 30.0 * 16 / (3.0 * 32));
  EXPECT_EQ(worst.x, 32);
  EXPECT_EQ(worst.y, 16);
}

}  // namespace
}  // namespace swarf::test

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
  const char* section = "";
};

class LaterPictures : public testing::TestWithParam<LaterStill> {};

TEST_P(LaterPictures, LookLikeTheReference) {
  const LaterStill& still = GetParam();
  const SceneRun& job = scene_run(still.scene, "--no-render");
  ASSERT_EQ(job.run.exit_code, still.scene == std::string("exact_gouges") ? 1 : 0) << job.run.output;
  const std::string section = still.section;
  const std::string name =
      fmt::format("{}_{}{}.png", still.scene, still.kind, section.empty() ? "" : "_section");
  const ProgramRun run = run_swarf(fmt::format(
      "render {} --still {} --kind {} --camera {} --size 480 270 --samples 4 {}", job.folder.string(),
      (job.folder / name).string(), still.kind, still.camera, section.empty() ? "" : "--section " + section));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  expect_like_reference(render::load_png((job.folder / name).string()), name);
}

INSTANTIATE_TEST_SUITE_P(
    Stills, LaterPictures,
    testing::Values(LaterStill{"nc_pocket", "part", "iso"}, LaterStill{"nc_pocket", "machine", "machine"},
                    LaterStill{"exact_gouges", "deviation", "top"}, LaterStill{"exact_gouges", "fan", "left"},
                    LaterStill{"nc_pocket", "part", "iso", "y=12"},
                    LaterStill{"nc_pocket", "machine", "machine", "y=12"},
                    LaterStill{"exact_gouges", "fan", "0.4,-1,0.6", "y=0"},
                    LaterStill{"exact_gouges", "deviation", "0.4,-1,0.6", "y=0"}),
    [](const auto& info) {
      const bool opened = *info.param.section != 0;
      return fmt::format("{}_{}{}", info.param.scene, info.param.kind, opened ? "_section" : "");
    });

/// Stills of a finished run that show nothing, and what is said of them.
TEST(SectionStill, WhatCannotBeSeenIsToldWithWhatCan) {
  const SceneRun& job = scene_run("exact_gouges", "--no-render");
  const fs::path file = job.folder / "none.png";
  const auto refused = [&](const std::string& options, const std::string& code, const std::string& fix) {
    const ProgramRun run = run_swarf(
        fmt::format("render {} --size 64 64 --still {} {}", job.folder.string(), file.string(), options));
    EXPECT_EQ(run.exit_code, 2) << options << run.output;
    EXPECT_NE(run.output.find("[" + code + "]"), std::string::npos) << options << run.output;
    EXPECT_NE(run.output.find(fix), std::string::npos) << options << run.output;
    EXPECT_FALSE(fs::exists(file)) << options;
  };
  refused("--section x=10", "section-misses", "the part reaches x from -10 to 10 mm");
  refused("--section 0,0,500,1,1,1", "section-misses", "along the normal");
  refused("--section u=1", "bad-section", "x=12.5");
  refused("--section x=nan", "bad-section", "x=12.5");
  refused("--section x=0 --camera front", "section-edge-on", "straight on");
  refused("--section x=10 --kind fan", "section-misses", "the part reaches x from -10 to 10 mm");
  refused("--section x=200 --kind machine", "section-misses", "the part reaches x from -10 to 10 mm");
  refused("--section x=0 --kind machine --camera front", "section-edge-on", "name another camera");
  refused("--section x=0 --finding 1", "nothing-to-do", "--section x=10 --still");
}

/// The scene's own pictures are what `swarf render` makes of the run.
TEST(StillShots, AreThoseOfTheFlags) {
  const fs::path folder = fresh_folder("pictures_shots") / "run";
  const std::string small = "'stills.size=[320,180]' --set stills.samples=1 --set movie.seconds=0";
  const ProgramRun run = run_swarf("run " SWARF_SOURCE_DIR
                                   "/scenes/exact_gouges/scene.toml --set 'stills.kinds=[\"part\"]' --set "
                                   "stills.labels=false --set stills.transparent=true --set "
                                   "'stills.shot=[{kind=\"deviation\",section=\"y=0\"}]' "
                                   "--set " +
                                   small + " -o " + folder.string());
  ASSERT_EQ(run.exit_code, 1) << run.output;
  const auto again = [&](const std::string& options) {
    const fs::path file = folder / "again.png";
    const ProgramRun made =
        run_swarf(fmt::format("render {} --still {} {}", folder.string(), file.string(), options));
    EXPECT_EQ(made.exit_code, 0) << made.output;
    return read_text(file);
  };
  const std::string part = read_text(folder / "still_part.png"), cut = read_text(folder / "still_shot_1.png");
  EXPECT_EQ(render::load_png((folder / "still_part.png").string()).rgba[3], 0) << "transparent";
  EXPECT_EQ(again(""), part);
  EXPECT_NE(again("--labels"), part);
  EXPECT_NE(again("--no-transparent"), part);
  EXPECT_EQ(again("--kind deviation --section y=0"), cut);
  EXPECT_NE(again("--kind deviation --section y=0 --labels"), cut);
}

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

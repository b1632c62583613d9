// Movies by storyboard, pictures of findings, and what is wrong with either, from the shipped program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "image/movie_frames.h"
#include "image/reference_picture.h"
#include "render/image_io.h"
#include "support/program_run.h"

namespace swarf::test {
namespace {

namespace fs = std::filesystem;
using render::Image;

constexpr const char* kPocket = "run " SWARF_SOURCE_DIR "/scenes/nc_pocket/scene.toml ";

/// A run of the pocket with these shots, and its folder.
struct PocketRun {
  fs::path folder;
  ProgramRun run;
};
PocketRun pocket(const std::string& name, const std::string& shots, const std::string& more) {
  PocketRun job;
  job.folder = fresh_folder("storyboard_" + name) / "run";
  job.run =
      run_swarf(kPocket + fmt::format("-o {} --set 'stills.kinds=[\"part\"]' --set stills.samples=1 --set "
                                      "'movie.size=[480,270]' --set 'movie.shot={}' {}",
                                      job.folder.string(), shots, more));
  return job;
}

TEST(Storyboard, SplitSectionTrailAndToolColoursLookLikeTheReference) {
  const PocketRun job = pocket("shots",
                               "[{view=\"split\", speed=\"cutting\", seconds=0.5},"
                               "{view=\"part\", orbit_deg=40, section_mm=[[20,15,0],[0,-1,0]], seconds=0.5},"
                               "{follow=\"tool\", camera=\"left\", trail_s=3, speed=\"block\", seconds=0.5}]",
                               "--set movie.colours=tool");
  ASSERT_EQ(job.run.exit_code, 0) << job.run.output;
  const std::vector<Image> frames = movie_frames((job.folder / "movie.mp4").string());
  ASSERT_EQ(frames.size(), 45U);
  expect_like_reference(frames[12], "shot_split.png");
  expect_like_reference(frames[25], "shot_section.png");
  expect_like_reference(frames[36], "shot_tool.png");
}

TEST(Storyboard, ALineThatMovesNothingIsToldBeforeAnythingIsCut) {
  const PocketRun job = pocket("line", "[{from_line=100000}]", "");
  EXPECT_EQ(job.run.exit_code, 2) << job.run.output;
  EXPECT_NE(job.run.output.find("place-unknown"), std::string::npos) << job.run.output;
  EXPECT_NE(job.run.output.find("the nearest line with motion"), std::string::npos) << job.run.output;
  EXPECT_FALSE(fs::exists(job.folder));
}

TEST(Storyboard, AnUnknownCameraIsToldBeforeAnythingIsCut) {
  const PocketRun job = pocket("camera", "[{camera=\"drone\"}]", "");
  EXPECT_EQ(job.run.exit_code, 2);
  EXPECT_NE(job.run.output.find("unknown-camera"), std::string::npos) << job.run.output;
  EXPECT_FALSE(fs::exists(job.folder));
}

/// A run with findings, made once.
const PocketRun& gouges() {
  static const PocketRun job = [] {
    PocketRun made;
    made.folder = fresh_folder("storyboard_gouges") / "run";
    made.run = run_swarf("run " SWARF_SOURCE_DIR "/scenes/exact_gouges/scene.toml --no-render -o " +
                         made.folder.string());
    return made;
  }();
  return job;
}

ProgramRun render_gouges(const std::string& options) {
  return run_swarf(fmt::format("render {} --size 320 180 --samples 2 {}", gouges().folder.string(), options));
}

TEST(FindingPicture, ShowsWhereItIsOrSaysHowManyThereAre) {
  ASSERT_EQ(gouges().run.exit_code, 1) << gouges().run.output;
  const fs::path file = gouges().folder / "finding.png";
  const ProgramRun made = render_gouges("--finding 1 --still " + file.string());
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_EQ(render::load_png(file.string()).width, 320);
  const ProgramRun none = render_gouges("--finding 999 --still " + file.string());
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.output.find("unknown-finding"), std::string::npos) << none.output;
  EXPECT_EQ(render_gouges("--finding 1").exit_code, 2);
}

TEST(TransparentStill, HasNothingBehindThePart) {
  const fs::path file = gouges().folder / "clear.png";
  const ProgramRun made = render_gouges("--transparent --kind part --still " + file.string());
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const Image image = render::load_png(file.string());
  EXPECT_EQ(image.rgba[3], 0);
  EXPECT_EQ(image.rgba[static_cast<size_t>(4 * (90 * 320 + 160) + 3)], 255);
}

/// Of the strip along the upper edge: pixels of a red plate, and how red they are.
struct RedPlate {
  int pixels = 0;
  double mean = 0.0;
};
RedPlate red_plate(const Image& image) {
  RedPlate plate;
  for (int y = 0; y < image.height / 5; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* p = &image.rgba[static_cast<size_t>(4 * (y * image.width + x))];
      if (p[0] < 70 || p[0] < 2 * std::max(p[1], p[2])) continue;
      ++plate.pixels;
      plate.mean += p[0];
    }
  }
  plate.mean /= std::max(plate.pixels, 1);
  return plate;
}

TEST(MovieFindings, FlashFromTheirMomentOn) {
  const fs::path file = gouges().folder / "flash.mp4";
  // The first gouge is at 47.558 s, frame 7 of 30; a plate is bright for half a second and dim for the next.
  const ProgramRun made = render_gouges("--seconds 1 --from 47 --to 49.4 --movie " + file.string());
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const std::vector<Image> frames = movie_frames(file.string());
  ASSERT_EQ(frames.size(), 30U);
  const RedPlate before = red_plate(frames[4]), bright = red_plate(frames[11]), dim = red_plate(frames[19]);
  EXPECT_LT(before.pixels, 50);
  EXPECT_GT(bright.pixels, 2000);
  EXPECT_GT(dim.pixels, 2000);
  EXPECT_GT(bright.mean, dim.mean + 40.0);
  expect_like_reference(frames[11], "finding_bright.png");
  expect_like_reference(frames[19], "finding_dim.png");
}

/// Two hours of roughing in twenty seconds, of feed moves alone: at a frame a second. The tool is at work in
/// each of them.
TEST(MovieOfTwoHours, ShowsTheToolAtWork) {
  const fs::path folder = fresh_folder("storyboard_coremill") / "run";
  const ProgramRun run =
      run_swarf("run " SWARF_SOURCE_DIR
                "/scenes/cl_coremill/scene.toml --set 'stills.kinds=[]' --set stock.voxel_mm=4 "
                "--set movie.voxel_mm=4 --set movie.seconds=20 --set movie.fps=1 --set movie.overlay=false "
                "--set 'movie.size=[320,180]' --set "
                "'movie.speed=\"cutting\"' -o " +
                folder.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const std::vector<Image> frames = movie_frames((folder / "movie.mp4").string());
  ASSERT_EQ(frames.size(), 20U);
  expect_like_reference(frames[2], "coremill_2.png");
  expect_like_reference(frames[11], "coremill_11.png");
  expect_like_reference(frames[19], "coremill_19.png");
}

/// One block of 124 mm through a bar of 100 mm, seen from the front and above, what is cut in the tool's
/// blue; and cut open where either wall of the slot is.
constexpr const char* kSlotScene = R"(machine = "mill_3axis"
nc = "slot.ngc"
dialect = "linuxcnc"
[cutter]
number = 1
diameter_mm = 10
flute_length_mm = 25
length_mm = 60
[setup]
work_origin_mm = "on_table"
[stock]
box_mm = [[0, -15, -12], [100, 15, 0]]
voxel_mm = 0.5
[design]
kind = "none"
[stills]
kinds = []
[movie]
seconds = 1.4
fps = 10
size = [320, 180]
overlay = false
colours = "tool"
[[movie.shot]]
view = "part"
camera = "0,-1,0.9"
from_line = 9
to_line = 9
seconds = 0.5
[[movie.shot]]
view = "part"
camera = "front"
section = "y=5"
from_line = 9
to_line = 9
seconds = 0.2
[[movie.shot]]
view = "part"
camera = "front"
section = "y=-5"
from_line = 9
to_line = 9
seconds = 0.2
[[movie.shot]]
view = "part"
camera = "0,-1,0.9"
chips = true
from_line = 9
to_line = 9
seconds = 0.5
)";
constexpr size_t kSlotFrames = 14;

/// The slot's run, made once.
const fs::path& slot() {
  static const fs::path folder = [] {
    const fs::path made = fresh_folder("storyboard_slot");
    std::ofstream(made / "slot.ngc") << "G21 G90 G17 G94\nG54\nT1 M6\nG43 H1\nS8000 M3\nG0 X-12 Y0\nG0 "
                                        "Z10\nG1 Z-4 F500\nG1 X112 F500\nG0 Z20\nM30\n";
    std::ofstream(made / "scene.toml") << kSlotScene;
    const ProgramRun run = run_swarf(fmt::format("run {0}/scene.toml -o {0}/run", made.string()));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return made / "run";
  }();
  return folder;
}

/// Pixels of the tool's blue, left and right of the middle of the picture.
std::array<int, 2> cut_pixels(const Image& image) {
  std::array<int, 2> pixels{};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* p = &image.rgba[static_cast<size_t>(4 * (y * image.width + x))];
      if (p[2] > p[0] + 40) ++pixels[x < image.width / 2 ? 0 : 1];
    }
  }
  return pixels;
}

TEST(MovieOfALongBlock, ShowsTheSlotUpToTheTool) {
  const std::vector<Image> frames = movie_frames((slot() / "movie.mp4").string());
  ASSERT_EQ(frames.size(), kSlotFrames);
  // The tool is at x = 12.8, 37.6, 62.4, 87.2 and 112 mm.
  const std::array<int, 2> early = cut_pixels(frames[1]), late = cut_pixels(frames[3]),
                           end = cut_pixels(frames[4]);
  EXPECT_GT(early[0], 300);
  EXPECT_EQ(early[1], 0);
  EXPECT_GT(late[0], early[0]);
  EXPECT_GT(late[1], 100);
  EXPECT_GT(end[1], late[1] + 100);
  expect_like_reference(frames[2], "slot_middle.png");
}

int pixels_apart(const Image& a, const Image& b) {
  int pixels = 0;
  for (size_t i = 0; i < a.rgba.size(); i += 4) {
    if (std::abs(a.rgba[i] - b.rgba[i]) > 24) ++pixels;
  }
  return pixels;
}

/// The last five frames are the first five with chips: from the wall at x = 0 on, and none after the bar.
TEST(MovieChips, FlyWhereTheSlotIsCutTheSameForAnyThreadsAndAfterTheRun) {
  const std::vector<Image> frames = movie_frames((slot() / "movie.mp4").string());
  ASSERT_EQ(frames.size(), kSlotFrames);
  for (const size_t f : {1U, 2U, 3U}) EXPECT_GT(pixels_apart(frames[f], frames[9 + f]), 100) << f;
  expect_like_reference(frames[11], "slot_chips.png");
  const std::string movie = (slot() / "again.mp4").string();
  for (const int threads : {1, 2}) {
    const ProgramRun made =
        run_swarf(fmt::format("render {} --movie {} --threads {}", slot().string(), movie, threads));
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const std::vector<Image> again = movie_frames(movie);
    ASSERT_EQ(again.size(), kSlotFrames);
    for (size_t f = 9; f < kSlotFrames; ++f) EXPECT_EQ(again[f].rgba, frames[f].rgba) << f;
  }
}

/// Height of the orange face of the cut for its width, taken as a rectangle.
double cut_face(const Image& image) {
  int pixels = 0, left = image.width, right = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* p = &image.rgba[static_cast<size_t>(4 * (y * image.width + x))];
      if (p[0] < p[1] + 45) continue;
      ++pixels;
      left = std::min(left, x);
      right = std::max(right, x + 1);
    }
  }
  return static_cast<double>(pixels) / ((right - left) * (right - left));
}

/// The bar is 100 mm long and 12 high, the slot 4 deep. At y = 5 the material behind the wall is kept and
/// cut, at y = -5 that before it is taken away.
TEST(SectionOnAWall, CutsAllOfItOrTakesAllOfItAway) {
  constexpr double kWhole = 0.12, kBelow = 0.08, kEdges = 0.01;  // edges: outlines and the eye's distance
  const std::vector<Image> frames = movie_frames((slot() / "movie.mp4").string());
  ASSERT_EQ(frames.size(), kSlotFrames);
  EXPECT_NEAR(cut_face(frames[6]), kWhole, kEdges);
  EXPECT_NEAR(cut_face(frames[8]), kBelow, kEdges);
  const fs::path file = slot() / "section.png";
  for (const auto& [section, height] : {std::pair{"y=5", kWhole}, {"y=-5", kBelow}}) {
    const ProgramRun made =
        run_swarf(fmt::format("render {} --still {} --kind part --section {} --size 640 360 --samples 2",
                              slot().string(), file.string(), section));
    ASSERT_EQ(made.exit_code, 0) << made.output;
    EXPECT_NEAR(cut_face(render::load_png(file.string())), height, kEdges) << section;
  }
}

/// Its work travels far on a machine many times its size: the camera goes with it and the tool, which waits
/// at home above the picture, is spoken of.
TEST(MovieOfASmallPart, FillsThePictureAndSaysWhereTheToolIs) {
  const fs::path folder = fresh_folder("storyboard_opener") / "run";
  const ProgramRun run = run_swarf("run " SWARF_SOURCE_DIR
                                   "/scenes/spinner_bottle_opener/scene.toml --set 'stills.kinds=[]' --set "
                                   "movie.seconds=0.4 --set movie.fps=10 --set 'movie.size=[480,270]' -o " +
                                   folder.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const std::vector<Image> frames = movie_frames((folder / "movie.mp4").string());
  ASSERT_EQ(frames.size(), 4U);
  expect_like_reference(frames[1], "opener_1.png");
  expect_like_reference(frames[3], "opener_3.png");
}

/// A number of the PNG format, most significant byte first.
uint32_t big_endian(const std::string& bytes, size_t at, int many) {
  uint32_t value = 0;
  for (int k = 0; k < many; ++k) value = value << 8 | static_cast<uint8_t>(bytes.at(at + k));
  return value;
}

TEST(ReadmeMovie, HasItsSizeItsLengthAndPlaysForEver) {
  const fs::path file = gouges().folder / "readme.apng";
  const ProgramRun made = render_gouges("--seconds 0.5 --movie " + file.string());
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const std::vector<Image> frames = movie_frames(file.string());
  ASSERT_EQ(frames.size(), 15U);
  EXPECT_EQ(frames.back().width, 320);
  EXPECT_EQ(frames.back().height, 180);
  const std::string bytes = read_text(file);
  const size_t control = bytes.find("acTL");
  ASSERT_NE(control, std::string::npos);
  EXPECT_EQ(big_endian(bytes, control + 4, 4), 15U) << "frames";
  EXPECT_EQ(big_endian(bytes, control + 8, 4), 0U) << "plays: 0 is for ever";
  // Each frame says how long it stands, as a fraction.
  double seconds = 0.0;
  for (size_t at = bytes.find("fcTL"); at != std::string::npos; at = bytes.find("fcTL", at + 4))
    seconds += static_cast<double>(big_endian(bytes, at + 24, 2)) / big_endian(bytes, at + 26, 2);
  EXPECT_NEAR(seconds, 0.5, 1e-9);
}

TEST(MovieEnding, WebmAndApngAreMadeAndOthersRefused) {
  for (const std::string ending : {".webm", ".apng"}) {
    const fs::path file = gouges().folder / ("movie" + ending);
    const ProgramRun made = render_gouges("--seconds 0.2 --movie " + file.string());
    ASSERT_EQ(made.exit_code, 0) << made.output;
    EXPECT_EQ(movie_frames(file.string()).size(), 6U) << ending;
  }
  const ProgramRun other = render_gouges("--movie " + (gouges().folder / "movie.avi").string());
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.output.find("movie-ending"), std::string::npos) << other.output;
}

}  // namespace
}  // namespace swarf::test

// The pictures of the main job against committed references. Refresh them with SWARF_REFRESH_REFERENCES=1.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "render/image_io.h"
#include "support/program_run.h"

namespace {

namespace fs = std::filesystem;
using swarf::render::Image;

// Mean difference of a channel, of 255. The pictures are seeded, so on one machine it is 0; another
// instruction set of Embree or llvmpipe moves single pixels at edges, which changes the mean by less than
// this.
constexpr double kMeanTolerance = 1.5;

const fs::path kReferences = SWARF_SOURCE_DIR "/tests/image/reference";

double mean_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.rgba.size(); ++i)
    sum += std::abs(static_cast<int>(a.rgba[i]) - static_cast<int>(b.rgba[i]));
  return sum / static_cast<double>(a.rgba.size());
}

class DomePictures : public testing::TestWithParam<const char*> {
 protected:
  static void SetUpTestSuite() {
    folder_ = swarf::test::fresh_folder("pictures") / "run";
    run_ = swarf::test::run_swarf(
        "run " SWARF_SOURCE_DIR "/scenes/lin_koren_dome/scene.toml -o " + folder_.string() +
        " --set movie.seconds=0 --set toolpath.compare=false --set 'stills.size=[480,270]' "
        "--set stills.samples=4");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_.parent_path()); }
  static fs::path folder_;
  static swarf::test::ProgramRun run_;
};
fs::path DomePictures::folder_;
swarf::test::ProgramRun DomePictures::run_;

TEST_P(DomePictures, LookLikeTheReference) {
  ASSERT_EQ(run_.exit_code, 0) << run_.output;
  const std::string name = std::string("still_") + GetParam() + ".png";
  if (std::getenv("SWARF_REFRESH_REFERENCES") != nullptr) {
    fs::create_directories(kReferences);
    fs::copy_file(folder_ / name, kReferences / name, fs::copy_options::overwrite_existing);
  }
  const Image picture = swarf::render::load_png((folder_ / name).string());
  const Image reference = swarf::render::load_png((kReferences / name).string());
  ASSERT_EQ(picture.width, reference.width);
  ASSERT_EQ(picture.height, reference.height);
  const double difference = mean_difference(picture, reference);
  if (difference > kMeanTolerance) {
    const fs::path kept = fs::current_path() / "image_failures";
    fs::create_directories(kept);
    fs::copy_file(folder_ / name, kept / name, fs::copy_options::overwrite_existing);
    ADD_FAILURE() << "mean difference " << difference << " of 255; the picture is kept in " << kept / name
                  << ", the reference is " << kReferences / name;
  }
}

INSTANTIATE_TEST_SUITE_P(Stills, DomePictures, testing::Values("machine", "part", "deviation", "fan"));

}  // namespace

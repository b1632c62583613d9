// [movie] and [[movie.shot]].
#include "sim/job/movie_keys.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace swarf::sim {
namespace {

MovieSettings read(const std::string& text, Diagnostics& diagnostics) {
  ConfigTable root = ConfigTable::parse(text, "scene.toml", {}, diagnostics);
  MovieSettings movie = read_movie(root.table("movie"));
  root.finish();
  return movie;
}

/// The one error, as "code line".
std::string fault(const std::string& text) {
  Diagnostics diagnostics;
  read(text, diagnostics);
  if (diagnostics.list().size() != 1) return std::to_string(diagnostics.list().size()) + " diagnostics";
  const Diagnostic& found = diagnostics.list().front();
  return found.code + " " + std::to_string(found.where.line);
}

TEST(MovieKeys, WithoutShotsThereIsOneWithWhatTheMovieSays) {
  Diagnostics diagnostics;
  const MovieSettings movie =
      read("[movie]\nseconds = 20\nspeed = \"cutting\"\nview = \"split\"\n", diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  ASSERT_EQ(movie.shots.size(), 1U);
  EXPECT_EQ(movie.shots[0].speed, MovieSpeed::kCutting);
  EXPECT_EQ(movie.shots[0].view, MovieView::kSplit);
  EXPECT_EQ(movie.shots[0].seconds, 20.0);
}

TEST(MovieKeys, ShotsTakeWhatTheyDoNotSayFromTheMovie) {
  Diagnostics diagnostics;
  const MovieSettings movie = read(
      "[movie]\nseconds = 8\ncamera = \"left\"\ntrail_s = 2\nchips = true\n"
      "[[movie.shot]]\nseconds = 3\nfollow = \"tool\"\nwidth_in = 2\n"
      "[[movie.shot]]\ncamera = \"1,0,0.5\"\norbit_deg = -90\nfrom_line = 4\nto_s = 9.5\n"
      "section_mm = [[0, 5, 0], [0, -2, 0]]\nchips = false\n",
      diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  ASSERT_EQ(movie.shots.size(), 2U);
  EXPECT_EQ(movie.shots[0].camera, "left");
  EXPECT_EQ(movie.shots[0].follow, MovieFollow::kTool);
  EXPECT_DOUBLE_EQ(movie.shots[0].width_mm, 50.8);
  EXPECT_EQ(movie.shots[1].trail_s, 2.0);
  EXPECT_TRUE(movie.shots[0].chips);
  EXPECT_FALSE(movie.shots[1].chips);
  EXPECT_EQ(movie.shots[1].from_line, 4);
  EXPECT_EQ(movie.shots[1].to_s, 9.5);
  EXPECT_TRUE(movie.shots[1].section->normal_W.isApprox(Vec3(0, -1, 0)));
  EXPECT_EQ(movie.seconds, 3.0 + 8.0 / 2);  // an even share where a shot does not say
}

TEST(MovieKeys, FaultsAreToldAtTheirLine) {
  EXPECT_EQ(fault("[movie]\n[[movie.shot]]\ncamera = \"drone\"\n"), "unknown-camera 3");
  EXPECT_EQ(fault("[movie]\ncamera = \"1,2\"\n"), "unknown-camera 2");
  EXPECT_EQ(fault("[movie]\ncamera = \"0,0,0\"\n"), "unknown-camera 2");
  EXPECT_EQ(fault("[movie]\ncamera = \"1,0,0 m\"\n"), "unknown-camera 2");
  EXPECT_EQ(fault("[movie]\n[[movie.shot]]\nfrom_line = 3\nfrom_s = 1\n"), "two-places 4");
  EXPECT_EQ(fault("[movie]\n[[movie.shot]]\nsection_mm = [[0, 0, 0], [0, 0, 0]]\n"), "bad-section 3");
  EXPECT_EQ(fault("[movie]\n[[movie.shot]]\nsection_mm = [[0, 0, 0]]\n"), "bad-section 3");
  EXPECT_NE(fault("[movie]\n[[movie.shot]]\nspeed = \"fast\"\n"), "0 diagnostics");
  EXPECT_NE(fault("[movie]\n[[movie.shot]]\nseconds = 0\n"), "0 diagnostics");
  EXPECT_NE(fault("[movie]\n[[movie.shot]]\nwidth_mm = -1\n"), "0 diagnostics");
  EXPECT_NE(fault("[movie]\n[[movie.shot]]\ncamra = \"iso\"\n"), "0 diagnostics");
}

TEST(MovieKeys, EveryNamedCameraLooksFromSomewhere) {
  const std::string names = camera_names();
  EXPECT_NE(names.find("machine"), std::string::npos);
  EXPECT_TRUE(camera_named("iso"));
  EXPECT_FALSE(camera_named(""));
  EXPECT_FALSE(camera_named("1,nan,0"));
}

}  // namespace
}  // namespace swarf::sim

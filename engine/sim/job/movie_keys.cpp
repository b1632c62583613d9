#include "sim/job/movie_keys.h"

#include <fmt/format.h>

#include <cstdio>

namespace swarf::sim {
namespace {

const std::vector<std::pair<std::string, Vec3>>& cameras() {
  static const std::vector<std::pair<std::string, Vec3>> table{
      {"iso", {0.55, -0.87, 0.64}}, {"low", {0.3, -0.95, 0.3}},      {"front", {0.0, -1.0, 0.25}},
      {"back", {0.0, 1.0, 0.3}},    {"left", {-1.0, -0.1, 0.3}},     {"right", {1.0, -0.1, 0.3}},
      {"top", {0.0, -0.02, 1.0}},   {"machine", {-0.75, -1.0, 0.55}}};
  return table;
}

/// Index of one of the words; `now` where the key is not there.
template <typename Kind>
Kind read_kind(ConfigTable& table, const char* key, const std::vector<std::string>& words, Kind now) {
  const std::string word = table.choice(key, words, words[static_cast<size_t>(now)]);
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) return static_cast<Kind>(i);
  }
  return now;
}

void read_places(ConfigTable& table, MovieShot& shot) {
  const auto line = [&](const char* key, std::optional<int>& value) {
    if (table.has(key)) value = table.integer(key, 1, 2000000000);
  };
  const auto time = [&](const char* key, std::optional<double>& value) {
    if (table.has(key)) value = table.number(key, kZeroOrMore);
  };
  line("from_line", shot.from_line);
  line("to_line", shot.to_line);
  time("from_s", shot.from_s);
  time("to_s", shot.to_s);
  const auto once = [&](const char* a, const char* b) {
    if (table.has(a) && table.has(b))
      table.error("two-places", b, fmt::format("the shot has '{}' and '{}'", a, b), "keep one of both");
  };
  once("from_line", "from_s");
  once("to_line", "to_s");
}

/// What [movie] and each [[movie.shot]] may say.
MovieShot read_shot(ConfigTable& table, MovieShot shot) {
  shot.where = table.where();
  shot.view = read_kind(table, "view", {"machine", "part", "split"}, shot.view);
  shot.camera = read_camera(table, shot.camera);
  shot.orbit_deg = table.number("orbit_deg", {-3600.0, 3600.0}, shot.orbit_deg);
  shot.follow = read_kind(table, "follow", {"nothing", "work", "tool"}, shot.follow);
  if (table.has("width_mm")) shot.width_mm = table.number("width_mm", kAboveZero);
  shot.speed = read_kind(table, "speed", {"time", "block", "cutting"}, shot.speed);
  shot.trail_s = table.number("trail_s", kZeroOrMore, shot.trail_s);
  shot.chips = table.boolean("chips", shot.chips);
  if (const auto section = read_section(table)) shot.section = section;
  return shot;
}

}  // namespace

std::optional<Vec3> camera_named(const std::string& name) {
  for (const auto& [known, direction] : cameras()) {
    if (known == name) return direction;
  }
  Vec3 direction;
  char more = 0;
  if (std::sscanf(name.c_str(), "%lf,%lf,%lf%c", &direction.x(), &direction.y(), &direction.z(), &more) ==
          3 &&
      direction.allFinite() && direction.norm() > 0.0) {
    return direction;
  }
  return {};
}

std::string camera_names() {
  std::string names;
  for (const auto& [known, direction] : cameras()) names += (names.empty() ? "" : ", ") + known;
  return names;
}

std::string read_camera(ConfigTable& table, const std::string& now) {
  if (!table.has("camera")) return now;
  const std::string camera = table.text("camera");
  if (!camera.empty() && !camera_named(camera))
    table.error("unknown-camera", "camera", fmt::format("there is no camera '{}'", camera),
                fmt::format("one of {}, or a direction x,y,z from the subject to the eye", camera_names()));
  return camera;
}

std::array<int, 2> read_picture_size(ConfigTable& table) {
  const std::vector<double> size = table.numbers("size", 2, std::vector<double>{1280, 720});
  for (const double side : size) {
    if (side < 64 || side > 7680 || static_cast<int>(side) % 2 != 0) {
      table.error("out-of-range", "size", fmt::format("'size' has a side of {:g} pixels", side),
                  "both sides must be even numbers from 64 to 7680");
      return {1280, 720};
    }
  }
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

MovieSettings read_movie(ConfigTable table) {
  MovieSettings movie;
  movie.seconds = table.number("seconds", {0.0, 3600.0}, movie.seconds);
  movie.size = read_picture_size(table);
  movie.fps = table.integer("fps", 1, 120, movie.fps);
  movie.auto_voxel = !table.has("voxel_mm");
  movie.voxel_mm = table.number("voxel_mm", kAboveZero, movie.voxel_mm);
  movie.samples = table.integer("samples", 1, 4, movie.samples);
  if (movie.samples != 1 && movie.samples != 4) {
    table.error("out-of-range", "samples", fmt::format("'movie.samples' is {}", movie.samples),
                "write 1 or 4");
  }
  movie.colours = read_kind(table, "colours", {"material", "tool", "deviation"}, movie.colours);
  movie.overlay = table.boolean("overlay", movie.overlay);
  const MovieShot all = read_shot(table, {});
  movie.shots = {all};
  movie.shots.front().seconds = movie.seconds;
  if (!table.has("shot")) return movie;
  movie.shots.clear();
  std::vector<ConfigTable> shots = table.tables("shot");
  for (ConfigTable& shot : shots) {
    movie.shots.push_back(read_shot(shot, all));
    read_places(shot, movie.shots.back());
    movie.shots.back().seconds =
        shot.number("seconds", {0.0, 3600.0, true}, movie.seconds / static_cast<double>(shots.size()));
  }
  if (movie.seconds <= 0.0) return movie;
  movie.seconds = 0.0;
  for (const MovieShot& shot : movie.shots) movie.seconds += shot.seconds;
  return movie;
}

}  // namespace swarf::sim

// The [movie] table of a scene and its storyboard, [[movie.shot]].
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/config.h"
#include "base/frames.h"
#include "sim/job/section_keys.h"

namespace swarf::sim {

enum class MovieView {
  kMachine,  ///< the machine at work
  kPart,     ///< the work and the tool, standing still in the work frame
  kSplit,    ///< both beside each other
};
enum class MovieSpeed {
  kTime,     ///< program time runs evenly
  kBlock,    ///< every block takes as long
  kCutting,  ///< feed moves alone, each tool at least kToolShare of its even share
};
enum class MovieFollow { kNothing, kWork, kTool };
enum class MovieColours { kMaterial, kTool, kDeviation };

/// One shot of the movie; without [[movie.shot]] there is one, with what [movie] says.
struct MovieShot {
  SourceLocation where;
  MovieView view = MovieView::kMachine;
  std::string camera;      ///< a name or a direction (camera_direction); "": machine, iso for the part
  double orbit_deg = 0.0;  ///< that the camera turns about the vertical from the shot's start to its end
  MovieFollow follow = MovieFollow::kNothing;
  double width_mm = 0.0;  ///< across the picture; 0: as much as must be seen
  std::optional<SectionPlane> section;
  MovieSpeed speed = MovieSpeed::kTime;
  std::optional<double> from_s, to_s;
  std::optional<int> from_line, to_line;
  double trail_s = 0.0;  ///< of program time that the tip's trail goes back; 0: none
  bool chips = false;    ///< drawn where material is removed
  double seconds = 0.0;
};

struct MovieSettings {
  double seconds = 10.0;
  std::vector<MovieShot> shots{MovieShot{}};
  MovieColours colours = MovieColours::kMaterial;
  /// Line, place, axis values, feed, spindle and progress on the picture; below 420 lines without the axis
  /// values, below 331 without the place too.
  bool overlay = true;
  std::array<int, 2> size{1280, 720};
  int fps = 30;
  int samples = 4;  ///< per pixel, 1 or 4: 4 smooths edges and takes two thirds longer
  /// Of the stock that the movie shows; it is not measured. With an automatic stock.voxel_mm twice that.
  double voxel_mm = 0.8;
  bool auto_voxel = true;  ///< the scene does not say it
};

/// Of a feed move's even share of the frames that a tool gets at least under MovieSpeed::kCutting.
inline constexpr double kToolShare = 0.4;

/// From the subject to the eye; none: there is no camera of this name, and it is no direction "x,y,z".
std::optional<Vec3> camera_named(const std::string& name);
/// Names that camera_named() knows, in one line.
std::string camera_names();

/// `camera`: a name or a direction; `now` where the key is not there.
std::string read_camera(ConfigTable& table, const std::string& now);

/// Of a table that is not there the defaults.
MovieSettings read_movie(ConfigTable table);

/// Both sides even, 64 to 7680 pixels.
std::array<int, 2> read_picture_size(ConfigTable& table);

}  // namespace swarf::sim

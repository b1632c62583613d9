// The [stills] table of a scene and its further pictures, [[stills.shot]].
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/config.h"
#include "sim/job/section_keys.h"

namespace swarf::sim {

/// The stills that a run makes, by the names of `swarf render --kind`.
inline const std::vector<std::string> kStillKinds{"machine", "part", "deviation", "fan"};

/// A picture beside those of StillSettings::kinds.
struct StillShot {
  SourceLocation where;
  std::string kind = "part";            ///< one of kStillKinds
  std::string camera;                   ///< as MovieShot::camera; "": the usual one of its kind
  std::optional<SectionPlane> section;  ///< cut open, seen from the side taken away
};

struct StillSettings {
  std::vector<std::string> kinds = kStillKinds;
  std::array<int, 2> size{1280, 720};
  int samples = 16;  ///< rays per pixel: more is smoother and slower
  /// Scale bar and values. None: of the run's part, deviation and sections; of `swarf render` by its flags.
  std::optional<bool> labels;
  bool transparent = false;  ///< nothing behind the drawing
  std::vector<StillShot> shots;

  bool any() const { return !kinds.empty() || !shots.empty(); }
};

/// Of a table that is not there the defaults.
StillSettings read_stills(ConfigTable table);

/// Every section of a still goes through the raw stock, and deviations have a design. Throws InputError
/// "section-misses", "nothing-measured" at the shot.
void require_still_shots(const StillSettings& stills, const Box& stock_W, bool has_design);

}  // namespace swarf::sim

// The [driven] table of a scene: a part that is machined by its own surface, without a program (Kato et al.).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/config.h"
#include "toolpath/driven/driven_path.h"

namespace swarf::sim {

struct DrivenSettings {
  toolpath::DrivenPlan plan;  ///< but for its area, where that is open, and the stock's top
  bool area_said = false;     ///< else the rectangle around the part
  std::optional<double> floor_mm;
  std::string file;  ///< of the part: surface blocks, a mesh or a CAD file
  bool mesh = false;
  bool step = false;       ///< a CAD file: its faces drive as they are, facets of them are measured
  double chord_mm = 1e-4;  ///< of those facets
  SourceLocation where;
  std::vector<double> compare_mm;  ///< tolerances of CAM paths to compare with
};

/// `file` is left as written.
DrivenSettings read_driven(ConfigTable table);

}  // namespace swarf::sim

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
  bool by_design = false;  ///< no file: the surfaces of [design], as kind = "nurbs" has them
  bool step = false;       ///< a CAD file: its faces drive as they are, and are measured
  double chord_mm = 5e-3;  ///< of the facets that tell their edges
  SourceLocation where;
  std::vector<double> compare_mm;  ///< tolerances of CAM paths to compare with
};

/// `file` is left as written.
DrivenSettings read_driven(ConfigTable table);

}  // namespace swarf::sim

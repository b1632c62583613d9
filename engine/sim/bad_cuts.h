// Material taken by moves that must not take any: rapids, and cuts with a spindle that stands or turns the
// wrong way. Programs of blocks only.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/job_sweeps.h"
#include "sim/scene.h"
#include "stock/stock.h"

namespace swarf::sim {

enum class BadCutKind {
  kRapid,            ///< the move is a rapid
  kSpindleStands,    ///< S is 0, M3 is missing
  kSpindleReversed,  ///< M4 with a right-hand tool, M3 with a left-hand one
};

struct BadCut {
  BadCutKind kind = BadCutKind::kRapid;
  uint32_t block = 0;     ///< Sweep::block of the first sweep that met material
  double depth_mm = 0.0;  ///< how deep the flutes stood in it; saturates at the level set's band
};

/// Points on the flutes (rings at most 2 mm apart) at poses along each suspicious sweep, against the stock as
/// it stands before that sweep. Material less than one voxel deep is not counted: the cuts before leave it.
/// Of a row of feed moves with the same wrong spindle the first that cuts is kept; of rapids each.
class BadCutCheck {
 public:
  /// Path and sweeps must outlive it.
  BadCutCheck(const Job& job, const toolpath::ToolPath& path, const JobSweeps& sweeps);
  /// True when the sweep has to be looked at before it is cut.
  bool suspicious(const stock::Sweep& sweep) const;
  void check(const stock::Stock& stock, const stock::Sweep& sweep);
  const std::vector<BadCut>& result() const { return found_; }
  /// Goes on from what was found before.
  void resume(const std::vector<BadCut>& earlier) { found_ = earlier; }

 private:
  struct Element {
    std::optional<BadCutKind> kind;
    int row = 0;  ///< elements of one row have the same kind without another between them
  };
  const Element& element_of(uint32_t block) const {
    return elements_[static_cast<size_t>(sweeps_.sources[block].element)];
  }
  double depth_at(const stock::Stock& stock, const ToolPose& pose, size_t tool) const;

  const JobSweeps& sweeps_;
  std::vector<Element> elements_;           ///< by ToolPath::elements
  std::vector<std::vector<Vec3>> points_;   ///< of each tool's flutes, in the tool's frame
  std::vector<double> reach_mm_, step_mm_;  ///< by tool: of the flutes from the tip; between two poses
  double voxel_mm_;
  std::vector<BadCut> found_;
};

/// "kind block depth;..." for stock files, and back; false: not such a text.
std::string bad_cuts_text(const std::vector<BadCut>& cuts);
bool parse_bad_cuts(const std::string& text, std::vector<BadCut>& cuts);

}  // namespace swarf::sim

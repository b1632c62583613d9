// Neck, shank and holder against the stock as it stands before each sweep, over the whole sweep.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cutter/cutter.h"
#include "sim/run/earlier_cuts.h"
#include "sim/run/sweep_places.h"
#include "stock/contact/contact_finder.h"

namespace swarf::sim {

/// A part of the tool that does not cut, by its shape.
struct ToolPart {
  std::string name;  ///< "neck", "shank", "holder"
  stock::RevolvedPart body;
};
std::vector<ToolPart> tool_parts(const cutter::Cutter& cutter);

/// Material only shrinks: what is clear of the stock before a batch of sweeps is clear throughout it. The
/// others, the suspects, are judged one by one against the stock as it stands before their own sweep, less
/// what their own flutes have taken until the part comes. Material that the grid does not show well is
/// looked at by the sweeps before (EarlierCuts).
class ToolClearanceCheck {
 public:
  /// `places`, `sweeps` and `earlier` must outlive it.
  ToolClearanceCheck(std::span<const cutter::Cutter> tools, const CutSweeps& sweeps,
                     const SweepPlaces& places, const EarlierCuts& earlier, double voxel_mm);

  /// Gaps of sweeps [begin, end), before any of them is cut; those of `known_suspects`, in order, are not
  /// looked at.
  struct Outlook {
    std::vector<size_t> suspects;  ///< indices of sweeps
    double nearest_mm = 0.0;       ///< of the others
  };
  Outlook look_ahead(const stock::ContactFinder& finder, size_t begin, size_t end,
                     std::span<const size_t> known_suspects = {}) const;
  /// Takes a gap into the result.
  void saw(double gap_mm);

  /// One suspect, before it is cut, and again when it is.
  void judge_before(const stock::ContactFinder& finder, size_t sweep);
  void judge_after(const stock::ContactFinder& finder, size_t sweep);

  const ToolClearance& result() const { return result_; }
  /// Goes on from an earlier result of the same tools and voxel size.
  void resume(const ToolClearance& earlier) { result_ = earlier; }

 private:
  void add(const ContactEvent& event);
  /// A contact that only the sweeps themselves show; true when there is one.
  bool shallow(const stock::ContactFinder& finder, size_t sweep, const ToolPart& part, double gap);
  size_t tool_of(size_t sweep) const { return static_cast<size_t>(sweeps_.tool(sweep)); }

  const CutSweeps& sweeps_;
  const SweepPlaces& places_;
  const EarlierCuts& earlier_;
  std::vector<std::vector<ToolPart>> parts_;      ///< by tool
  std::vector<stock::CutterSolid> flutes_;        ///< by tool
  std::vector<const stock::RevolvedPart*> free_;  ///< parts of the suspect that its own flutes clear the way
  ToolClearance result_;
};

}  // namespace swarf::sim

// Cameras and things to draw of a shot.
#pragma once

#include <map>
#include <span>

#include "render/draw_list.h"
#include "reports/chips.h"
#include "reports/machine_view.h"
#include "reports/movie_stock.h"
#include "reports/storyboard.h"

namespace swarf::reports {

/// Makes the lists of a movie's frames. `tip_trail`: tips in the work frame up to now, oldest first.
class ShotView {
 public:
  explicit ShotView(const FinishedRun& run, const std::string& default_camera);

  /// kMachine or kPart at this frame; `size` of the picture in px. The stock must outlive the list.
  render::DrawList list(const PlannedFrame& frame, sim::MovieView view, const std::array<int, 2>& size,
                        const StockState& stock, const std::vector<uint64_t>& revisions,
                        const std::vector<Vec3>& tip_trail, std::span<const Chip> chips = {}) const;

 private:
  render::Camera camera(const PlannedFrame& frame, sim::MovieView view, const std::array<int, 2>& size) const;
  Vec3 direction(const PlannedFrame& frame, sim::MovieView view) const;
  void find_enclosed();
  void add_chips(std::span<const Chip> chips, const Pose& X_drawn, bool part,
                 std::vector<render::DrawItem>& items) const;

  const FinishedRun& run_;
  MachineView view_;
  std::map<const TriMesh*, mesh::Enclosed> enclosed_;  ///< of the machine's meshes; those that enclose any
  std::vector<TriMesh> chips_;                         ///< by tool
  std::string default_camera_;
  Box seen_;  ///< machine frame: where the middle of the stock goes
};

}  // namespace swarf::reports

// The form of the raw stock in [stock]: one of box_mm, cylinder, tube, outline, mesh, from_run.
#pragma once

#include <optional>
#include <string>

#include "base/config.h"
#include "base/diagnostics.h"
#include "base/placement.h"
#include "stock/raw/raw_shape.h"

namespace swarf::sim {

enum class RawKind {
  kBox,
  kTube,
  kOutline,
  kMesh,
  kRun,     ///< what another run has left (set_ups.h)
  kSetups,  ///< what the set-ups before this one have left: the first one says it
};

/// What the scene says of it.
struct RawSettings {
  RawKind kind = RawKind::kBox;
  std::string key = "box_mm";  ///< of [stock], that says it
  SourceLocation where;
  stock::RawTube tube;
  stock::RawOutline outline;
  std::string file;      ///< a mesh; of kRun the folder of the run
  double unit_mm = 1.0;  ///< of the mesh's numbers
  bool unit_said = false;
  Pose X_WF = Pose::Identity();  ///< from the file's frame to the work

  /// The key that moves it: "stock.box_mm".
  std::string spoken_key() const { return kind == RawKind::kSetups ? "setup.part_pose" : "stock." + key; }
};

/// { position_mm = [..], rotation_deg = [..] }: about the fixed axes, X first, then Y, then Z. Quarter turns
/// are exact.
Pose read_pose(ConfigTable table);
/// The same from the table that also says of which point: origin = "work", "corner" or "centre".
Placement read_placement(ConfigTable& table);

/// Reads the keys of all forms but the box and its key: more than one form is "two-shapes", with both places.
/// `file` is as the scene writes it.
RawSettings read_raw(ConfigTable& table);

/// The body that the settings mean, for any but a box: files are read and checked. What is wrong goes to
/// `diagnostics`, and nothing comes back: mesh-open and the others of check_design_mesh,
/// "mesh-crosses-itself", "mesh-nested-bodies", "outline-crosses-itself", "stock-folder-empty", what
/// load_mesh and Stock::load throw.
/// Warnings: "mesh-unit-suspicious", where the stock is thinner than the largest tool, `tool_mm` in diameter.
std::optional<stock::RawShape> load_raw(const RawSettings& raw, double tool_mm, Diagnostics& diagnostics);

}  // namespace swarf::sim

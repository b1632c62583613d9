// What `swarf compare -o DIR` leaves: the deviation map as mesh and picture, and its numbers.
#pragma once

#include <string>

#include "mesh/tri_mesh.h"

namespace swarf::reports {

/// The file that marks a folder as a result of `swarf compare`.
inline constexpr const char* kCompareMark = "deviation.ply";

/// deviation.ply and .png (the stock), design.ply and .png, and metrics.json, the folder replaced whole. Both
/// meshes carry deviation_um; `scale_um` is the colour scale's half width.
void write_compare(const std::string& folder, TriMesh stock, TriMesh design, double scale_um,
                   const std::string& metrics_json);

}  // namespace swarf::reports

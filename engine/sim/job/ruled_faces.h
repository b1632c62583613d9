// [design] kind = "ruled_faces": faces of a CAD file that are proven to be ruled.
#pragma once

#include "base/config.h"
#include "sim/job/design_keys.h"

namespace swarf::sim {

/// The keys step and [[design.face]].
void read_ruled_faces(ConfigTable& table, DesignSettings& design);

/// The faces as surfaces linear in v. Diagnostics: "cad-no-face" with the numbers there are; "face-not-ruled"
/// with how far it departs, as bound and as seen; "face-trimmed" where it is no rectangle of its parameters.
std::vector<surface::SurfacePtr> load_ruled_faces(const DesignSettings& design, Diagnostics& diagnostics);

}  // namespace swarf::sim

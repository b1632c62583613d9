// A curled chip, as it comes off a tooth.
#pragma once

#include "mesh/tri_mesh.h"

namespace swarf::render {

/// A strip wound up to a helix of most of a turn, closed, about the origin; `size_mm`: its greatest extent.
TriMesh chip_mesh(double size_mm);

}  // namespace swarf::render

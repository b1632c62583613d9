// A ruled surface that goes straight on beyond its first and its last ruling, so that a tool can.
#pragma once

#include "surface/surface.h"

namespace swarf::flank {

/// S on [0,1]; before u = 0 and behind u = 1 both guide curves follow their tangents, so the surface is ruled
/// there too and its normals go over into those of S without a step.
surface::SurfacePtr extended(surface::SurfacePtr surface);

}  // namespace swarf::flank

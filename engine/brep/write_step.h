// A mesh as a CAD file.
#pragma once

#include <cstddef>
#include <string>

#include "mesh/tri_mesh.h"

namespace swarf::brep {

/// More are refused: the library takes some 7 kB of memory for each and a tenth of a millisecond, and a CAD
/// system half a millisecond to read it.
inline constexpr size_t kMostStepTriangles = 250'000;

/// Writes a closed mesh, mm, whose triangles share vertices, as STEP (AP214): a solid of plane triangles
/// (FACETED_BREP) for each body, its cavities as voids. `name`: of the product. Triangles lower than 1e-6 mm,
/// which have no plane, are flipped into their neighbours. Throws InputError "step-too-large" above
/// kMostStepTriangles, "step-empty" where there is no body, "step-not-closed" where the mesh bounds no
/// bodies, and "cannot-write-file".
void write_step(const std::string& path, const TriMesh& mesh, const std::string& name);

}  // namespace swarf::brep

// Fixtures as a program leaves them: where flutes come to one it is cut into, as the stock is.
#pragma once

#include <string>
#include <vector>

#include "sim/job/scene.h"

namespace swarf::sim {

struct Result;

/// A fixture that flutes have cut.
struct WornFixture {
  size_t link = 0;           ///< index into MachineScene::links
  std::string name;          ///< of the link
  double removed_mm3 = 0.0;  ///< by its level set, of stock.voxel_mm
  TriMesh mesh_M;            ///< with all axes at zero, as the link's own
};

/// Of the fixtures with which the run has found contacts of flutes; each of their closed bodies is a level
/// set of its own that all sweeps of the program cut. A body that is thinner than a voxel, or from which
/// nothing is taken, stays as it was drawn.
std::vector<WornFixture> worn_fixtures(const Job& job, const Result& result);

/// The job with its fixtures as they are behind the program, for pictures.
Job with_worn(const Job& job, const std::vector<WornFixture>& worn);

}  // namespace swarf::sim

// Whether what holds the work holds it: no fixture inside the stock, none in the air, no stock that nothing
// holds.
#pragma once

#include "base/diagnostics.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// Of a job whose fixtures hang on its machine. Diagnostics: "fixture-in-part", an error where
/// some place of one lies more than kInsideMm inside the other; "fixture-floats", a warning where a fixture
/// touches neither the table nor what stands on it; "machine-size", a warning where the machine's meshes are
/// tiny. A stock that nothing touches is a row of `assumptions`: it stands in the air.
struct HeldStock {
  const TriMesh& mesh_W;
  double error_mm = 0.0;  ///< of the mesh: so much deeper or farther away counts as well
};
void check_clamping(const Job& job, const HeldStock& stock, Diagnostics& diagnostics,
                    Assumptions& assumptions);

inline constexpr double kInsideMm = 0.01;
inline constexpr double kTouchesMm =
    0.1;  ///< what is no farther apart counts as touching: drawn tables have chamfers

}  // namespace swarf::sim

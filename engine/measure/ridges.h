// Cusps between passes, refined between the rays. Internal to this folder.
//
//        \   pass A      pass B   /        Two neighbouring rays i, i+1 were last lowered by different
//        passes:
//         \ .__            __.  /          the cusp lies between them. On the exact normal at each parameter
//            i  `--. /\.--'  i+1           both passes' heights follow from their sweeps (ray_height), and
//            the
//                  root                    cusp is where they are equal. No grid limits its height.
#pragma once

#include <span>
#include <vector>

#include "measure/metrics.h"
#include "stock/surface_dexels.h"
#include "stock/sweep.h"

namespace swarf::measure {

/// In the order of the grid, for any number of threads. A ridge is taken along the grid direction that
/// crosses it more squarely, once per grid line. The pitch must be well below the interval of the passes.
std::vector<Ridge> find_ridges(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                               std::span<const int> pass_of_sweep, const stock::CutterSolid& cutter);

}  // namespace swarf::measure

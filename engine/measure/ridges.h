// Cusps between passes, refined between the rays. Internal to this folder.
//
//        \   pass A      pass B   /        Two neighbouring rays were last lowered by different passes: the
//        cusp
//         \ .__            __.  /          lies between them. On the exact normal at each place between their
//         feet
//            i  `--. /\.--'  k             both passes' heights follow from their sweeps (ray_height), and
//            the cusp
//                  root                    is where they are equal. No grid limits its height.
#pragma once

#include <span>
#include <vector>

#include "measure/metrics.h"
#include "measure/pass_rule.h"
#include "measure/sweep_index.h"
#include "stock/rays/surface_dexels.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

/// In the order of the field's edges, for any number of threads. A ridge is taken on the edges that cross it
/// by 45 degrees or more: on a grid once per grid line. The pitch must be well below the interval of the
/// passes.
std::vector<Ridge> find_ridges(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                               const PassRule& rule, const SweepCutters& cutters, const SweepIndex& index);

}  // namespace swarf::measure

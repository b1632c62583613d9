// The stage of the measuring rays: what a path cuts of them, and what they then tell of the design.
#pragma once

#include <functional>

#include "base/progress.h"
#include "base/ranks.h"
#include "sim/job/scene.h"

namespace swarf::sim {

struct MeasuredPath;

/// Makes the rays and cuts a share of their tiles. `step`: called after sweeps, rays and ranges are made, and
/// when the share is cut. `same_design`: as of cut_dexels().
void cut_ray_share(const Job& job, MeasuredPath& measured, Share share, const std::function<void()>& step,
                   const MeasuredPath* same_design = nullptr);

/// Makes and cuts all of them. `ranks`: that share their tiles; null: none do. `same_design`: whose rays
/// stand on the job's design, and need not be made again; or null. Throws InputError "rank-differs".
void cut_dexels(const Job& job, MeasuredPath& measured, Progress& progress, Ranks* ranks = nullptr,
                const MeasuredPath* same_design = nullptr);

/// Scallops, gouges and what stands highest, of rays that are cut.
void measure_dexels(const Job& job, MeasuredPath& measured);

}  // namespace swarf::sim

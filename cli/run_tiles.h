// `swarf run --tiles`: one of the processes that mpirun has started (sim/run/tile_ranks.h).
#pragma once

#include <functional>

#include "cli/run_options.h"

namespace swarf::cli {

/// What the ranks would have to agree on first: throws InputError "not-in-tiles".
void refuse_for_tiles(const RunOptions& options);
void refuse_for_tiles(const sim::Job& job);

/// `run`: what rank 0 does, with its ranks in the options; the others do what it asks. Exit code. Throws
/// InputError "no-mpi", "no-mpirun".
int run_as_rank(RunOptions options, const std::function<int(const RunOptions&)>& run);

}  // namespace swarf::cli

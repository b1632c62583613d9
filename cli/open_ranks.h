// The ranks of `swarf run --tiles`: a module that is loaded when it is asked for, because it needs MPI.
#pragma once

#include <memory>

#include "base/ranks.h"

namespace swarf::cli {

/// File of the module, beside the program or in its library folder.
inline constexpr const char* kRanksModule = "swarf_mpi.so";

/// This process as one of those that mpirun has started. Once in a process. Throws InputError "no-mpi" when
/// the module is missing or cannot be loaded, "no-mpirun" when nothing has started it as a rank.
std::unique_ptr<Ranks> open_ranks();

}  // namespace swarf::cli

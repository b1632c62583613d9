#include "cli/open_ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

#include "base/diagnostics.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

std::string module_path() {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
  const fs::path beside = program / kRanksModule;
  return fs::exists(beside) ? beside.string()
                            : (program / SWARF_MODULES / kRanksModule).lexically_normal().string();
}

/// mpirun names each of its processes; so does what stands for it in Slurm, PMIx or PMI.
bool is_started_as_rank() {
  constexpr std::array kNames{"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [](const char* name) { return std::getenv(name) != nullptr; });
}

}  // namespace

std::unique_ptr<Ranks> open_ranks() {
  const std::string path = module_path();
  // MPI loads modules of its own, which look for its symbols: they must be seen by all.
  void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
  void* const make = module != nullptr ? dlsym(module, "swarf_make_ranks") : nullptr;
  if (make == nullptr)
    throw InputError("no-mpi", {"--tiles"}, fmt::format("there is no MPI here: {}", dlerror()),
                     "install libopenmpi-dev and openmpi-bin and build again, or run without --tiles");
  // MPI would begin alone, and so would each of several that do not know of each other.
  if (!is_started_as_rank())
    throw InputError("no-mpirun", {"--tiles"}, "this process is none of several: mpirun has not started it",
                     "mpirun -n 4 swarf run SCENE --tiles; or run without --tiles");
  return std::unique_ptr<Ranks>(reinterpret_cast<Ranks* (*)()>(make)());
}

}  // namespace swarf::cli

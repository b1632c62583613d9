#include "cli/open_ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>

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

}  // namespace

std::unique_ptr<Ranks> open_ranks() {
  const std::string path = module_path();
  // MPI loads modules of its own, which look for its symbols: they must be seen by all.
  void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
  void* const make = module != nullptr ? dlsym(module, "swarf_make_ranks") : nullptr;
  if (make == nullptr)
    throw InputError("no-mpi", {"--tiles"}, fmt::format("there is no MPI here: {}", dlerror()),
                     "install libopenmpi-dev and openmpi-bin and build again, or run without --tiles");
  return std::unique_ptr<Ranks>(reinterpret_cast<Ranks* (*)()>(make)());
}

}  // namespace swarf::cli

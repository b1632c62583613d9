#include "cli/version.h"

#include <fmt/format.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>

#include "swarf_commit.h"  // written by cmake/commit.cmake

namespace swarf::cli {

std::string version_text() {
  return fmt::format(
      "{}\ncommit {}\ncompiler {}\nlibraries Eigen {}.{}.{}, OpenVDB {}, Embree {}, TBB {}, HDF5 {}, fmt "
      "{}.{}.{}, "
      "CLI11 {}",
      SWARF_VERSION, SWARF_COMMIT, __VERSION__, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION,
      SWARF_OPENVDB, SWARF_EMBREE, SWARF_TBB, SWARF_HDF5, FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
      FMT_VERSION % 100, CLI11_VERSION);
}

}  // namespace swarf::cli

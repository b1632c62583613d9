// What a run has found, for comparisons of runs that must find the same; and the long program that they
// share.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program_run.h"

namespace swarf::test {

/// Everything but times, memory and the command that was given.
inline nlohmann::json facts(const std::filesystem::path& folder) {
  const nlohmann::json all = nlohmann::json::parse(read_text(folder / "metrics.json")).flatten();
  nlohmann::json kept;
  for (const auto& [path, value] : all.items()) {
    const bool measured = path.ends_with("_s") || path.find("seconds") != std::string::npos ||
                          path.find("memory") != std::string::npos || path.find("_ns") != std::string::npos ||
                          path.find("threads") != std::string::npos ||
                          path.find("command") != std::string::npos ||
                          path.find("per_s") != std::string::npos;
    if (!measured) kept[path] = value;
  }
  return kept;
}

/// The wave of tests/bench/wave.py as scene.toml and wave.ngc.
inline void write_wave(const std::filesystem::path& folder, long blocks, double voxel_mm) {
  const auto written = run_command(fmt::format("/usr/bin/python3 '{}/tests/bench/wave.py' {} '{}' {}",
                                               SWARF_SOURCE_DIR, blocks, folder.string(), voxel_mm));
  ASSERT_EQ(written.exit_code, 0) << written.output;
}

}  // namespace swarf::test

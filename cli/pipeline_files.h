// --sarif and --junit: what a command found, for build servers.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "reports/pipeline_output.h"

namespace swarf::cli {

struct PipelineFiles {
  std::string sarif, junit;  ///< "": not written
};

void add_pipeline_options(CLI::App& command, PipelineFiles& files);

/// Runs a command that says what it found through its argument, and returns its exit code. The files are
/// tried before it and written after it, also when it throws InputError (which goes on). `input`: the file
/// that an error without a place belongs to.
int with_pipeline_files(const PipelineFiles& files, const std::string& input,
                        const std::function<int(std::vector<reports::FileVerdict>&)>& command);

}  // namespace swarf::cli

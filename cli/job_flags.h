// A job said by flags instead of a scene: swarf run part.nc --tool 6.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "program/nc_program.h"
#include "sim/job/scene_text.h"

namespace swarf::cli {

/// The flags as they were given; "" and 0: not given.
struct JobWords {
  std::string tool, tools, stock, origin, machine, design, units, dialect;
  double voxel_mm = 0.0;
  int start_tool = 0;
  bool t_changes_tool = false;
  std::string slot_ends, tracut;
};

void add_job_flags(CLI::App& command, JobWords& words);

/// --set-parameter, as overrides of the scene's [parameters].
void add_parameter_flag(CLI::App& command, std::vector<std::string>& overrides);

/// Reads "500=3.5" and "R1=2". Throws InputError "bad-option" and "given-twice".
program::Presets presets_of(const std::vector<std::string>& given);

/// Those that were given, as a shell takes them: "--tool", "6".
std::vector<std::string> given_words(const JobWords& words);

/// True where the file is a program and no scene or machine: its name does not end in .toml.
bool is_program_file(const std::string& file);

/// The job of a program file. Throws InputError: "bad-tool-list" for --tools that is neither a file nor
/// words, "needs-scene" for a program of surface blocks, and as take_stock does.
sim::JobFlags job_flags(const std::string& program_file, const JobWords& words);

/// How many [[setup]] the file has; 0: it is a program, or a scene of one set-up. Throws InputError
/// "file-not-found" and as sim::count_setups.
size_t count_setups(const std::string& file, const std::vector<std::string>& overrides);

/// All set-ups of a scene, or the first `last` of them; 0: all. Throws InputError "no-such-set-up".
std::vector<std::shared_ptr<const sim::Job>> load_setups(const std::string& file, size_t last,
                                                         const std::vector<std::string>& overrides);

/// The scene of a job: the file itself, or the text that flags and program mean. Throws InputError
/// "file-not-found" with what can be run, "flags-and-scene" for flags beside a scene.
sim::Job load_job(const std::string& file, const JobWords& words, const std::vector<std::string>& overrides);

}  // namespace swarf::cli

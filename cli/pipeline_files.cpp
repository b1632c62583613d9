#include "cli/pipeline_files.h"

#include "cli/commands.h"
#include "reports/pending_folder.h"

namespace swarf::cli {
namespace {

void write_pipeline_files(const PipelineFiles& files, const std::vector<reports::FileVerdict>& found,
                          int exit_code) {
  if (!files.sarif.empty()) reports::write_text(files.sarif, reports::sarif_text(found, exit_code));
  if (!files.junit.empty()) reports::write_text(files.junit, reports::junit_text(found, exit_code));
}

}  // namespace

void add_pipeline_options(CLI::App& command, PipelineFiles& files) {
  command.add_option("--sarif", files.sarif,
                     "write diagnostics, findings and checks as SARIF 2.1.0, with file, line and column");
  command.add_option("--junit", files.junit,
                     "write each check as a test of JUnit XML; what is not judged is skipped");
}

int with_pipeline_files(const PipelineFiles& files, const std::string& input,
                        const std::function<int(std::vector<reports::FileVerdict>&)>& command) {
  for (const std::string& file : {files.sarif, files.junit}) reports::check_output_file(file);
  // Of a command that is killed or fails they say so, not what an earlier one has found.
  write_pipeline_files(files, {{input, {}}}, kInternalError);
  std::vector<reports::FileVerdict> found;
  try {
    const int exit_code = command(found);
    write_pipeline_files(files, found, exit_code);
    return exit_code;
  } catch (const InputError& error) {
    found.push_back({input, error.diagnostics.list()});
    write_pipeline_files(files, found, kBadInput);
    throw;
  }
}

}  // namespace swarf::cli

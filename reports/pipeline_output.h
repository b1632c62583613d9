// What a command found, as files that build servers read: SARIF 2.1.0 (findings in place) and JUnit XML
// (checks as tests).
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "sim/check.h"

namespace swarf::reports {

/// What was said of one input file.
struct FileVerdict {
  std::string file;              ///< as it was given
  std::vector<Diagnostic> told;  ///< of the input, and findings of the simulation
  std::vector<sim::Check> checks{};
};

/// Results with file, line and column relative to the working folder; each check is a result too, so that one
/// that was not judged or not proven is seen ("open") and never taken for one that holds.
std::string sarif_text(const std::vector<FileVerdict>& files, int exit_code);

/// A test suite for each file: "input" holds what is wrong with it, then each check; not proven is a failure,
/// not judged is skipped with its reason. A command that has not done its work (exit code 2 or more) without
/// a failure that says why has an error instead. Ends with a new line.
std::string junit_text(const std::vector<FileVerdict>& files, int exit_code);

/// Text between tags and in attributes of XML, whatever bytes it has.
std::string xml_text(const std::string& text);

}  // namespace swarf::reports

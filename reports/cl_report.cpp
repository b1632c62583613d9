#include "reports/cl_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace swarf::reports {
namespace {

/// Words of CL data that only describe; every other note is something that a machine would do.
constexpr std::array<std::string_view, 15> kDescribe{"PARTNO", "PPRINT",      "REMARK", "PAINT",     "MACHIN",
                                                     "INTOL",  "OUTTOL",      "TOLER",  "TPRINT",    "TOOLNO",
                                                     "DISPLY", "END-OF-PATH", "SEQNO",  "TOOL PATH", "MODE"};

}  // namespace

FactGroup cl_facts(const program::ClProgram& program) {
  const std::string writer =
      program.writer_reason.empty()
          ? "unknown: the file bears no mark"
          : fmt::format("{} ({})", program::writer_name(program.writer), program.writer_reason);
  FactGroup group{"CL data",
                  {{"Written by", writer},
                   {"Statements", fmt::format("{}, {} moves", program.statements, program.moves.size())}}};
  for (const std::string& remark : program.remarks) group.facts.push_back({"Taken as given", remark});
  return group;
}

std::vector<Check> cl_checks(const program::ClProgram& program) {
  std::vector<std::string> words;
  for (const program::ClNote& note : program.notes) {
    if (std::find(kDescribe.begin(), kDescribe.end(), note.word) != kDescribe.end()) continue;
    std::string text = note.text.empty() ? note.word : note.word + "/" + note.text;
    if (std::find(words.begin(), words.end(), text) == words.end()) words.push_back(std::move(text));
  }
  if (words.empty()) return {};
  return {{"Words of the CL data without effect on the geometry", "",
           fmt::format("read, not simulated: {}", fmt::join(words, ", ")), State::kNotChecked}};
}

}  // namespace swarf::reports

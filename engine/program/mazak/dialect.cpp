#include "program/mazak/dialect.h"

#include "program/fanuc/dialect.h"
#include "program/mazak/words.h"

namespace swarf::program::nc::mazak {

Evidence evidence(const ProgramHead& head) {
  constexpr std::string_view kOnlyHere[] = {"G34.1", "G37.1", "G61.2", "G68.5", "G69.5",
                                            "G71.1", "G72.1", "G84.2", "G84.3", "G92.5"};
  return fanuc::derived_evidence(head, kOnlyHere, 0);
}

void run(const std::string& path, Control& control) {
  fanuc::run_as(kRules, path, control);
}

}  // namespace swarf::program::nc::mazak

#include "program/haas/dialect.h"

#include "program/fanuc/dialect.h"
#include "program/haas/words.h"

namespace swarf::program::nc::haas {

Evidence evidence(const ProgramHead& head) {
  constexpr std::string_view kOnlyHere[] = {"G47",  "G103", "G143", "G150", "G154", "G187", "G234",
                                            "G253", "G254", "G255", "G268", "G269", "M97",  "DPRNT"};
  return fanuc::derived_evidence(head, kOnlyHere, 5);
}

void run(const std::string& path, Control& control) {
  fanuc::run_as(kRules, path, control);
}

}  // namespace swarf::program::nc::haas

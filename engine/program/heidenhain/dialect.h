// The row of Heidenhain in the table of dialects (program/dialects.h).
#pragma once

#include <string>

#include "program/evidence.h"

namespace swarf::program::nc {
struct Control;
}

namespace swarf::program::nc::heidenhain {

Evidence evidence(const ProgramHead& head);
void run(const std::string& path, Control& control);

}  // namespace swarf::program::nc::heidenhain

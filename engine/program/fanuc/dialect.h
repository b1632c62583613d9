// The row of Fanuc in the table of dialects (program/dialects.h).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "program/evidence.h"

namespace swarf::program::nc {
struct Control;
}

namespace swarf::program::nc::fanuc {

Evidence evidence(const ProgramHead& head);
/// Of a dialect derived from this one: `words` that only it has, O numbers of so many digits (0: none are its
/// own). Where one stands, what speaks for Fanuc (G65, macro statements) speaks for it too.
Evidence derived_evidence(const ProgramHead& head, std::span<const std::string_view> words,
                          size_t program_digits);
void run(const std::string& path, Control& control);

}  // namespace swarf::program::nc::fanuc

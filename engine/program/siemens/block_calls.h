// Words of a block that bring brackets: calls with their arguments, groups and indices of axes. Each is read
// behind its name, which stands at `offset`; throws what read_block throws.
#pragma once

#include <string>

#include "program/siemens/block.h"

namespace swarf::program::nc::siemens {

inline constexpr std::string_view kAxisNames = "XYZABC";

/// CYCLE81(10,0,2,-5): left out arguments are none.
void read_call(TokenReader& reader, Variables& variables, BlockWords& words, const std::string& name,
               size_t offset);
/// FGROUP(X,Y,Z): the names become the texts of its arguments.
void read_feed_group(TokenReader& reader, BlockWords& words, const std::string& name, size_t offset);
/// FGREF[B]=50.
void read_feed_radius(TokenReader& reader, Variables& variables, BlockWords& words, const std::string& name,
                      size_t offset);
/// ACC[X]=50: kept for the report.
void read_noted_index(TokenReader& reader, Variables& variables, BlockWords& words, const std::string& name,
                      size_t offset);

}  // namespace swarf::program::nc::siemens

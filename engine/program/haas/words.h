// The words and rules of Haas NGC (mills), where they are not those of Fanuc's series 30i.
#pragma once

#include "program/fanuc/steps.h"

namespace swarf::program::nc::haas {

extern const fanuc::Rules kRules;

/// G70: L holes of the cycle that is on, evenly on a circle of radius I, the first at J degrees.
void bolt_circle(fanuc::Fanuc& haas);
/// G71: L holes on a circle of radius I, from J degrees on, K degrees apart.
void bolt_arc(fanuc::Fanuc& haas);
/// Variables that are others than Fanuc's: tool offsets, modal groups, settings.
std::optional<double> variable(fanuc::Fanuc& haas, long number, size_t place);

}  // namespace swarf::program::nc::haas

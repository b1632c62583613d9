// The words and rules of Haas NGC (mills), where they are not those of Fanuc's series 30i.
#pragma once

#include "program/fanuc/steps.h"

namespace swarf::program::nc::haas {

extern const fanuc::Rules kRules;

/// G70: L holes of the cycle that is on, evenly on a circle of radius I, the first at J degrees.
void bolt_circle(fanuc::Fanuc& haas);
/// G71: L holes on a circle of radius I, from J degrees on, K degrees apart.
void bolt_arc(fanuc::Fanuc& haas);
/// G254: programs count from the work offset's point where the standing rotary axes have carried it, along
/// the machine's own X Y Z. Rotary words are refused until G255.
void dynamic_offset_on(fanuc::Fanuc& haas);
void dynamic_offset_off(fanuc::Fanuc& haas);
/// Variables that are others than Fanuc's: tool offsets, modal groups, settings.
std::optional<double> variable(fanuc::Fanuc& haas, long number, size_t place);

}  // namespace swarf::program::nc::haas

// The words and rules of Mazak EIA/ISO (machining centres), where they are not those of Fanuc's series 30i.
#pragma once

#include "program/fanuc/steps.h"

namespace swarf::program::nc::mazak {

extern const fanuc::Rules kRules;

/// G34.1: K holes of the cycle that is on, evenly on a circle of radius I about X Y, the first at J degrees;
/// K below zero goes round clockwise.
void bolt_circle(fanuc::Fanuc& mazak);
/// G35: K holes, I apart, from X Y on along J degrees.
void bolt_line(fanuc::Fanuc& mazak);
/// G36: K holes on a circle of radius I about X Y, from J degrees on, P degrees apart.
void bolt_arc(fanuc::Fanuc& mazak);
/// Variables that are others than Fanuc's.
std::optional<double> variable(fanuc::Fanuc& mazak, long number, size_t place);

}  // namespace swarf::program::nc::mazak

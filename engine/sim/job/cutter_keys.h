// One cutter as scenes and tool tables describe it: [cutter] and [[tool]].
#pragma once

#include "base/config.h"
#include "cutter/cutter.h"

namespace swarf::sim {

/// Reads the keys that the shape knows (scenes/README.md lists them); every other key is unknown to it. What
/// contradicts itself is reported at its key as "bad-cutter". Without `shape` the corner radius tells: none
/// is a flat end, half the diameter a ball, anything between a bull nose.
/// Its number is 1 by default.
cutter::Cutter read_cutter(ConfigTable table);

/// The same of a [[tool]], which has no number and no name by default.
cutter::Cutter read_tool(ConfigTable table);

}  // namespace swarf::sim

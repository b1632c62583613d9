// The [cutter] table of a scene.
#pragma once

#include "base/config.h"
#include "cutter/cutter.h"

namespace swarf::sim {

/// Reads the keys that the shape knows (scenes/README.md lists them); every other key is unknown to it. What
/// contradicts itself is reported at its key as "bad-cutter". Without `shape` the corner radius tells: none
/// is a flat end, half the diameter a ball, anything between a bull nose.
cutter::Cutter read_cutter(ConfigTable table);

}  // namespace swarf::sim

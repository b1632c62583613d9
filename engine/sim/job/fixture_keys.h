// [[fixture]] of a scene: what holds the work.
#pragma once

#include <string>
#include <vector>

#include "base/config.h"
#include "machine/fixture.h"

namespace swarf::sim {

/// Reads every [[fixture]] (scenes/README.md lists the keys); mesh files are not read yet. "two-fixtures"
/// where two have one name.
std::vector<machine::Fixture> read_fixtures(ConfigTable& root);

/// The file of one that is a mesh; null for others.
std::string* mesh_file_of(machine::Fixture& fixture);

struct Job;

/// Reads their meshes and hangs them on the machine, at the work as it is clamped. `table_M`: the machine's
/// own [work] origin. Diagnostics: what check_design_mesh says of a mesh, "fixture-size", and as
/// fixture_mesh().
void place_fixtures(Job& job, const Vec3& table_M, Diagnostics& diagnostics);

}  // namespace swarf::sim

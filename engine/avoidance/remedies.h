// What Kruth et al. do about a collision, by what collides (their Tables 1 and 2).
#pragma once

#include <string>
#include <vector>

#include "collision/body.h"
#include "machine/machine_scene.h"

namespace swarf::avoidance {

/// The paper's names of what may collide.
enum class Part {
  kHead,       ///< links that axes move with the tool: milling head, ram, spindle
  kHolder,     ///< neck, shank and holder
  kCutter,     ///< flutes
  kWork,       ///< raw, half cut or finished
  kFixture,    ///< clamping tools
  kTable,      ///< the link that carries the work
  kArm,        ///< the other links that axes move with the work
  kStructure,  ///< what stands still
};
const char* part_name(Part part);
Part part_of(const machine::MachineScene& machine, const collision::Body& body);

/// What CONTROL may do; A goes before B.
enum class Remedy {
  kMoveClamping,  ///< A
  kExtendTool,    ///< B
  kShortenTool,   ///< B-
};
const char* remedy_name(Remedy remedy);

/// Of a collision, by Table 1; empty: the set-up (C) or the tool path (D) has to change, which only the user
/// can. Parts of one side, and a machine that meets itself, are freed by other axis values: A.
std::vector<Remedy> remedies_of(Part a, Part b);
/// Of an axis that would leave its travel: a linear one A, then B-; a rotary one none.
std::vector<Remedy> remedies_of_limit(bool linear);

}  // namespace swarf::avoidance

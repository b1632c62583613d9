// Which pairs of bodies are watched, and which are not, with the reason.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "collision/closest_approach.h"

namespace swarf::collision {

enum class PairReason {
  kRigid,          ///< no axis lies between them
  kGuided,         ///< one link guides the other: it is its parent, or the next one that has a mesh
  kAllowed,        ///< the user's list, or the caller's: flutes and the material
  kTouchesAtHome,  ///< two links that overlap where the axes stand at home: their meshes are drawn so
};
/// In a sentence of its own.
std::string text_of(PairReason reason);

struct LeftOutPair {
  size_t a = 0, b = 0;  ///< indices into the bodies, a < b
  PairReason reason = PairReason::kRigid;
};

struct PairChoice {
  std::vector<std::pair<size_t, size_t>> watched;  ///< indices into the bodies, the lesser first
  std::vector<LeftOutPair> left_out;
};

/// All pairs but those that cannot or may touch. Links that already overlap at home are left out with a
/// warning "links-touch-at-home" that names both; other bodies that do are watched, for theirs is a contact.
/// `allowed`: pairs of names; throws InputError "unknown-body" for a name that no body has. A gap of
/// `touch_mm` or less is a contact.
PairChoice choose_pairs(const machine::MachineScene& scene, const std::vector<Body>& bodies,
                        const std::vector<std::pair<std::string, std::string>>& allowed, double touch_mm,
                        Diagnostics& diagnostics);

/// The axis values of home.
AxisValues home_of(const machine::MachineScene& scene);

}  // namespace swarf::collision

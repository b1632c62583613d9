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

/// Two bodies by name.
using NamePair = std::pair<std::string, std::string>;

/// A pair that has a near-miss distance of its own, and is watched for it.
struct NearMissRule {
  NamePair names;
  double near_miss_mm = 10.0;  ///< above 0
};

/// What is said of single pairs.
struct PairRules {
  std::vector<NamePair> allowed;      ///< may touch: not watched
  std::vector<NearMissRule> watched;  ///< though one guides the other, or they overlap at home
  /// null: the pair has none.
  const NearMissRule* near_miss_of(const std::string& a, const std::string& b) const;
};

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
/// Throws InputError "unknown-body" for a name of `rules` that no body has. A gap of `touch_mm` or less is a
/// contact.
PairChoice choose_pairs(const machine::MachineScene& scene, const std::vector<Body>& bodies,
                        const PairRules& rules, double touch_mm, Diagnostics& diagnostics);

/// The axis values of home.
AxisValues home_of(const machine::MachineScene& scene);

}  // namespace swarf::collision

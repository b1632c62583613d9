// Whether the sweep of a convex body passes clear of a design. Internal to this folder.
//
// A facet is clear of the body where a plane parts them. In the tool's frame the body stands still and the
// corners of the facet move on straight lines (stock/sweep/sweep_map.h): the hull of their ends holds the
// facet at all times. In the work's frame the hull of the body's two ends, widened by the sagitta, holds the
// body at all times. One suits a wide tool that turns over small facets, the other a wide facet.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "collision/convex_shape.h"
#include "proof/solid_design.h"
#include "stock/sweep/sweep.h"

namespace swarf::proof {

/// What a sweep meets: a facet, or kInside where it lies in the design without meeting one.
inline constexpr uint32_t kInside = 0xffffffffu;
using Meeting = std::optional<uint32_t>;

/// A direction in the tool's frame, and how far a body reaches in it.
struct Reach {
  Vec3 direction;
  double mm = 0.0;
};

/// How far a solid of revolution reaches, in the half-plane of its profile. The solid is borrowed.
class MeridianProfile {
 public:
  explicit MeridianProfile(const collision::RevolvedSolid& solid);
  const collision::RevolvedSolid& solid() const { return *solid_; }
  /// Greatest d . (rho, z) over the profile; d.x() >= 0.
  double greatest(const Vec2& d) const;

 private:
  const collision::RevolvedSolid* solid_;
  std::vector<Vec2> outer_;  ///< the corners of its hull, from the lowest to the highest
};

/// For one thread: it remembers the directions that parted a body from facets, which part it from those
/// beside them.
class SweepPassage {
 public:
  explicit SweepPassage(const SolidDesign& design) : design_(design) {}

  /// The first facet that keeps the body from being clear; nothing: it is clear. The body stands in the
  /// tool's frame, along z, and must outlive the passage.
  Meeting meets(const stock::Sweep& sweep, const collision::RevolvedSolid& solid);

 private:
  struct KnownBody {
    explicit KnownBody(const collision::RevolvedSolid& solid) : profile(solid) {}
    MeridianProfile profile;
    std::vector<Reach> reaches;  ///< the latest first
  };

  const SolidDesign& design_;
  std::map<const collision::RevolvedSolid*, KnownBody> bodies_;
};

}  // namespace swarf::proof

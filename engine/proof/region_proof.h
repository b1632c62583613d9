// The proof that a convex region holds no leftover material (leftover_bound.h). Internal to this folder.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "measure/sweep_index.h"
#include "proof/convex_sets.h"
#include "proof/leftover_bound.h"
#include "proof/polytope.h"

namespace swarf::proof {

/// A region, and the height over its feature that says which places are nearer to another one.
struct Region {
  Polytope body;
  HeightOver height;
};

enum class RegionState { kProven, kLeftover, kOpen };

/// Proves regions one after another. For one thread; the order of the regions decides how fast it is.
class RegionProver {
 public:
  RegionProver(const LeftoverQuestion& question, const measure::SweepIndex& index)
      : in_(question), index_(index) {}

  /// `above_mm`: lower leftover is allowed. kLeftover: found() tells the farthest so far.
  RegionState prove(const Region& region, double above_mm);

  /// From a leftover place to others farther off the design, as long as a step to any side finds one.
  void look_around(const Vec3& x, double height_mm);

  double found_mm() const { return found_mm_; }
  const Vec3& top() const { return top_; }
  const Vec3& foot() const { return foot_; }
  size_t parts() const { return parts_; }

 private:
  struct Candidate {
    ConvexSet set;
    uint32_t sweep = 0;
    uint32_t piece = 0;
  };
  struct Part {
    Polytope body;
    std::vector<uint32_t> near;  ///< of candidates_
    bool is_root = false;
  };

  bool is_closed_by_last(const Polytope& body);
  bool is_beyond_raw(const Polytope& body, const Vec3& centre, double radius) const;
  void find_candidates(const Polytope& body, const Vec3& centre, double radius);
  std::optional<RegionState> look_at(Part& part, const Region& region, double above_mm);
  void split(Part& part, const ConvexSet* by, const Vec3& centre);
  mesh::SignedPoint nearest(const Vec3& x, const Region& region, double above_mm) const;
  bool is_leftover(const Vec3& x) const;
  void climb(const Vec3& x, double height_mm);

  const LeftoverQuestion& in_;
  const measure::SweepIndex& index_;
  std::vector<Candidate> candidates_;
  std::deque<Candidate> last_;  ///< that closed a region, the newest first
  std::vector<Part> stack_;
  size_t parts_ = 0, region_parts_ = 0;
  double found_mm_ = 0.0;
  Vec3 top_ = Vec3::Zero(), foot_ = Vec3::Zero();
};

}  // namespace swarf::proof

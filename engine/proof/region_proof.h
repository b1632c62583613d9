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
  /// `raw`: facets that hold the raw stock; null where it is a box.
  RegionProver(const LeftoverQuestion& question, const measure::SweepIndex& index, const SolidDesign* raw)
      : in_(question), index_(index), raw_(raw) {}

  /// `above_mm`: lower leftover is allowed. kLeftover: found() tells the farthest so far.
  RegionState prove(const Region& region, double above_mm);

  /// From a leftover place to others farther off the design, as long as a step to any side finds one.
  void look_around(const Vec3& x, double height_mm);

  /// In the raw stock, and farther than a touch from all that the sweeps remove.
  bool is_leftover(const Vec3& x) const;
  /// By a sweep, or no farther than a touch from what one removes.
  bool is_removed(const Vec3& x) const;

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
    std::vector<uint32_t> near;        ///< of candidates_
    std::vector<uint32_t> raw_facets;  ///< of the raw stock, that may cross it
    bool is_root = false;
  };

  /// Which sweeps are tried: all near the body, or those that the body before was tried with. From kept ones
  /// leftover is never told.
  enum class Candidates { kAll, kKept };

  RegionState prove_body(const Polytope& body, const Region& region, double above_mm, Candidates from);
  bool is_closed_by_last(const Polytope& body);
  bool is_closed_by_nearest(const Polytope& body, const Vec3& centre, const std::vector<uint32_t>& sweeps);
  void remember(const Candidate& one);
  bool is_beyond_raw(const Polytope& body, const Vec3& centre, double radius) const;
  void keep_crossing_raw(Part& part) const;
  void find_candidates(const std::vector<uint32_t>& sweeps, const Vec3& centre, double radius);
  std::optional<RegionState> look_at(Part& part, const Region& region, double above_mm);
  void split(Part& part, const ConvexSet* by, const Vec3& centre);
  mesh::SignedPoint nearest(const Vec3& x, const Region& region, double above_mm) const;
  void climb(const Vec3& x, double height_mm);

  const LeftoverQuestion& in_;
  const measure::SweepIndex& index_;
  const SolidDesign* raw_;
  std::vector<Candidate> candidates_;
  std::vector<uint32_t> found_;                       ///< sweeps near the root
  std::vector<std::pair<double, uint32_t>> nearest_;  ///< of them, by the distance of their tips
  std::deque<Candidate> last_;                        ///< that closed a region, the newest first
  Candidates from_ = Candidates::kAll;
  std::vector<Part> stack_;
  size_t parts_ = 0, region_parts_ = 0;
  double found_mm_ = 0.0;
  Vec3 top_ = Vec3::Zero(), foot_ = Vec3::Zero();
};

}  // namespace swarf::proof

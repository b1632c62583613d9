// Parts of the tool against the material, along the whole way of a sweep.
//
// How deep a part stands in the material at an instant is the greatest s for which somewhere a ball of radius
// a of the part and a ball of radius s - a of the material have one centre: the part must move by s at least
// to be free. With the level set phi and the part's distance d that is  - min over x of phi(x) + d(x) ; the
// same sum is the gap between the two where they are apart. Flat against flat it is exact.
//
// x runs over the grid points in and at the material (phi < kReach voxels), where phi is known without
// interpolation, and d over the whole motion, in closed form and convex (revolved_part.h): nothing is sampled
// in time. A contact s deep shows as at least s minus 0.2 voxel at a flat face, a straight edge or a corner
// of either side; kDeep voxels and more are a contact.
//
// Ribs, plates and needles between the grid points, and shallow contacts, show less: any speck of material s
// deep in a part that is some voxels thick shows as s minus 0.86 voxel at least on the grid points with phi <
// kWide voxels (worst of a half-space or a right-angled rim in any place and direction). There phi, the
// greatest of many distances, lies below the true one beside convex edges of the material, so that kHint
// voxels are no more than a hint: shallow_contact() looks for a point that the sweeps themselves have left in
// the material and that the part passes over. So every contact of a voxel and more is found, and most of
// kLeastMm and more.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "stock/stock.h"
#include "stock/sweep/revolved_part.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

/// What the cutter takes away before the part comes: in the same sweep, or in the one given. Borrowed.
struct OwnCut {
  const CutterSolid* cutter = nullptr;
  SweepMap map;
  bool with_the_part = true;  ///< up to the instant that is looked at; false: the whole sweep, before it
};

struct Contact {
  double first_t = 0.0, last_t = 1.0;  ///< of the sweep: when the part comes into the material and leaves it
  double depth_mm = 0.0;               ///< greatest; in the stock as it stands before the sweep
  double deepest_t = 0.0;
  Vec3 place_W = Vec3::Zero();  ///< on the part's surface, where it stands deepest
};

class ContactFinder {
 public:
  /// Shallower ones are none: cuts leave that much at the flank, by their chords and steps.
  static constexpr double kDeep = 0.8;  // voxels
  /// Every point of the material has a grid point this near whose value is below it.
  static constexpr double kReach = 0.87;  // voxels, sqrt(3) / 2
  /// Hints of shallow contacts: see above.
  static constexpr double kHint = 0.1, kWide = 1.5;  // voxels
  /// A contact shallower than this is none: the sweeps follow the motion no closer.
  static constexpr double kLeastMm = 0.01;

  /// What is looked at: all of the stock, or the tiles that this process cuts (stock_tiles.h). gap() and
  /// may_be_shallow() of all are the least and the "or" of those of every process; only they know tiles.
  enum class Tiles { kAll, kOwn };

  /// The stock must outlive it.
  explicit ContactFinder(const Stock& stock, Tiles tiles = Tiles::kAll);
  /// After cutting: what became air is no longer looked at. Answers do not depend on it.
  void refresh();
  double deep_mm() const;

  /// The least of `above` and the gap between part and material over the sweep, mm; once it is known to be a
  /// contact it looks no further, and the value is only known to be below -deep_mm().
  /// `reach`: of the grid points looked at, voxels from the material.
  double gap(const SweepMap& map, const RevolvedPart& part, double above, double reach = kReach) const;
  /// The contact, if there is one. `own`: what the flutes clear out of the part's way; may be null.
  std::optional<Contact> contact(const SweepMap& map, const RevolvedPart& part, const OwnCut* own) const;

  /// Whether there may be a contact that is shallower or thinner than contact() tells; `gap`: of the same
  /// sweep.
  bool may_be_shallow(const SweepMap& map, const RevolvedPart& part, double gap) const;
  /// Signed distance of a point to the material before the sweep, by the sweeps themselves; exact inside.
  using Material = std::function<double(const Vec3& point_W)>;
  /// Such a contact, at the one instant and place where it was found deepest.
  std::optional<Contact> shallow_contact(const SweepMap& map, const RevolvedPart& part, const OwnCut* own,
                                         const Material& material) const;
  /// A place that shows that the air is no farther than that: |place - point| + more.
  struct Witness {
    Vec3 place = Vec3::Zero();
    double more = std::numeric_limits<double>::infinity();
    double bound(const Vec3& point_W) const { return (place - point_W).norm() + more; }
  };
  /// How far the nearest air is from a point in the material, however deep, mm; 0 outside. Looks no further
  /// once it is known to be no farther than `enough`. `witness`: of a point near by, replaced by this one's.
  double depth_of(const Vec3& point_W, Witness& witness, double enough = 0.0) const;

 private:
  friend class ContactSearch;
  friend class ShallowSearch;
  struct Level {
    int size[3];
    std::vector<uint8_t> material;  ///< 1: some leaf position below it is not air
  };
  /// Below the distance of the moving part, from the centre of a cell: the lesser of two linear functions.
  struct Bound {
    Vec3 centre = Vec3::Zero();
    std::array<double, 2> at{};
    std::array<Vec3, 2> slope{Vec3::Zero(), Vec3::Zero()};
    double least(double half) const;
  };
  Bound bound_at(const SweepMap& map, const RevolvedPart& part, const Vec3& centre, double enough) const;
  /// Grid points of a leaf position, no farther than `reach` voxels from the material, that may bring the sum
  /// below `least`: their places in the leaf.
  size_t candidates(size_t leaf, const Bound& bound, double least, double reach, uint16_t* places) const;
  /// Looks for a better witness at one leaf position.
  void look_for_air(size_t leaf, const Vec3& point_W, Witness& best, double& least) const;
  double value_at(size_t leaf, int place) const;
  Vec3 point_at(size_t leaf, int place) const;
  /// Calls visit(leaf, bound) for each leaf position that may bring the sum below `least`, which visit may
  /// lower; until it says no.
  void each_leaf(const SweepMap& map, const RevolvedPart& part, const double& least,
                 const std::function<bool(size_t leaf, const Bound& bound)>& visit) const;

  const Stock& stock_;
  Tiles tiles_;
  double voxel_;
  std::vector<Level> levels_;  ///< from the leaf positions up to one cell
};

}  // namespace swarf::stock

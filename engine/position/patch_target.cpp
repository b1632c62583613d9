#include "position/patch_target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace swarf::position {
namespace {

constexpr double kNothingYet = -std::numeric_limits<double>::infinity();
/// Of the tree and of halves below its leaves: each level leaves one cell behind.
constexpr size_t kStack = 512;

/// A cell of the tree, or a part of one of its leaves. Without initial values: a stack of them costs nothing.
struct Waiting {
  int cell;
  bool part;
  Vec2 centre, half;  ///< of a part
  double bound;
};

Waiting whole_cell(int cell, double bound) {
  return {cell, false, Vec2::Zero(), Vec2::Zero(), bound};
}

class PatchSearch {
 public:
  PatchSearch(const Setting& setting, const std::vector<PatchCell>& cells, Rest& best, PatchHint& near,
              PatchWork& work, const PatchHint& loop)
      : setting_(setting), cells_(cells), best_(best), near_(near), work_(work), loop_(loop) {}

  void run() {
    if (cells_.empty()) return;
    start();
    push_cell(static_cast<int>(cells_.size()) - 1);
    while (count_ > 0) {
      const Waiting next = stack_[--count_];
      if (next.bound <= enough()) continue;
      if (work_.leaves >= PatchTarget::kMostLeaves) {
        open_ = std::max(open_, next.bound);
        continue;
      }
      const PatchCell& cell = cells_[static_cast<size_t>(next.cell)];
      if (next.part) {
        const surface::Surface& surface = *setting_.patches[static_cast<size_t>(cell.patch)].surface;
        leaf_part(next.cell, part_of(surface, cell, next.centre, next.half));
      } else if (cell.child < 0) {
        leaf(next.cell, cell);
      } else if (!settled(cell)) {
        push_children(cell.child);
      }
    }
    work_.gap = std::max(work_.gap, open_ - best_.height);
    if (raised_on_ring_) {
      // On a ring the slope was chosen for the leaf that the contact was found in: now for the patch.
      best_.gradient = footing_at(setting_, near_.patch, {}, near_.uv).slope;
    }
  }

 private:
  double enough() const { return best_.height + kPatchProof_mm; }

  /// A first contact, so that most of the tree is left out: near the last one, else near the axis.
  void start() {
    const bool hinted = near_.patch >= 0 && near_.patch < static_cast<int>(setting_.patches.size());
    if (hinted) climb(near_.patch, near_.uv);
    if (!has_known_ && loop_.patch >= 0) keep_loop();
    if (!has_known_) start_near_axis();
  }
  /// The tool has come to rest on a loop: what bounds the patch is the support there, though it is no summit.
  void keep_loop() {
    const Footing at = footing_at(setting_, loop_.patch, {}, loop_.uv);
    if (at.under()) keep(at);
  }
  void start_near_axis() {
    const PatchCell* cell = &cells_.back();
    while (cell->child >= 0) {
      const PatchCell& one = cells_[static_cast<size_t>(cell->child)];
      const PatchCell& two = cells_[static_cast<size_t>(cell->child) + 1];
      cell = beside(one) <= beside(two) ? &one : &two;
    }
    climb(cell->patch, cell->centre);
  }
  /// How far the sphere is from the axis; where it meets it, how well it does.
  double beside(const PatchCell& cell) const {
    const Vec3 d = cell.p - setting_.line.point_W;
    return std::hypot(d.dot(setting_.line.x_W), d.dot(setting_.line.y_W)) - cell.radius;
  }
  void climb(int patch, const Vec2& uv) {
    const Footing at = settle(setting_, patch, {}, uv, work_.steps);
    if (at.under() && belongs(at) && (!has_known_ || at.height >= known_.height)) know(at);
  }
  bool trimmed(int patch) const { return setting_.patches[static_cast<size_t>(patch)].domain != nullptr; }
  bool belongs(const Footing& at) const {
    return !trimmed(at.patch) || setting_.patches[static_cast<size_t>(at.patch)].domain->inside(at.uv);
  }
  void know(const Footing& at) {
    take(at);
    keep(at);
  }
  void keep(const Footing& at) {
    known_ = at;
    support_ = support_paraboloid(setting_.profile, setting_.line, at);
    has_known_ = true;
  }

  void take(const Footing& at) {
    if (!(at.height > best_.height)) return;
    best_.height = at.height;
    best_.contact_W = setting_.line.world(at.d.S);
    best_.number = at.patch;
    best_.gradient = at.slope;
    best_.u = at.uv.x();
    best_.v = at.uv.y();
    int borders = 0;
    for (int i = 0; i < 2; ++i) borders += at.uv[i] <= 0.0 || at.uv[i] >= 1.0 ? 1 : 0;
    best_.what = borders == 0 ? Touched::kFace : borders == 1 ? Touched::kEdge : Touched::kVertex;
    near_ = {at.patch, at.uv};
    raised_on_ring_ = at.ring >= 0 || at.tip;
  }

  double bound(const PatchCell& cell) {
    ++work_.cells;
    if (cell.region == surface::Region::kOutside) return kNothingYet;
    return cell_bound(cell, setting_.profile, setting_.line, has_known_ ? &support_ : nullptr, enough());
  }
  void push(const Waiting& waiting) {
    if (waiting.bound <= enough()) return;
    SWARF_CHECK(count_ < kStack, "a tree of cells is no deeper than the stack of the search");
    stack_[count_++] = waiting;
  }
  void push_cell(int cell) { push(whole_cell(cell, bound(cells_[static_cast<size_t>(cell)]))); }
  void push_both(Waiting one, Waiting two) {
    // The higher one is taken first.
    if (one.bound > two.bound) std::swap(one, two);
    push(one);
    push(two);
  }
  void push_children(int first) {
    const double one = bound(cells_[static_cast<size_t>(first)]);
    const double two = bound(cells_[static_cast<size_t>(first) + 1]);
    push_both(whole_cell(first, one), whole_cell(first + 1, two));
  }

  bool holds(const PatchCell& cell, const Footing& at) const {
    return at.patch == cell.patch && (at.uv.array() >= cell.low().array()).all() &&
           (at.uv.array() <= cell.high().array()).all();
  }

  /// Whether the contact that is known is the highest of a cell that is not yet a leaf.
  bool settled(const PatchCell& cell) const {
    if (!has_known_ || !holds(cell, known_)) return false;
    // Not worth trying where the surface is not known to bend less than the tool.
    const double bends = cell.stray_uu + cell.stray_uv + cell.stray_vv;
    if (bends > 0.25 * support_.modulus * (cell.a.squaredNorm() + cell.b.squaredNorm())) return false;
    return known_.height + excess_bound(cell, known_, setting_.profile, setting_.line) <= enough();
  }
  void leaf_part(int index, PatchCell part) {
    // A part of what belongs to the part whole, does.
    if (part.region == surface::Region::kCrossing)
      part.region = region_of(setting_.patches[static_cast<size_t>(part.patch)], part.low(), part.high());
    leaf(index, part);
  }
  /// Newton in the cell, then the proof; else its halves.
  void leaf(int index, const PatchCell& cell) {
    ++work_.leaves;
    const double above = bound(cell);
    if (above <= enough()) return;
    // Its edges have been asked (face_target.h).
    if (cell.region == surface::Region::kCrossing && rises_everywhere(cell, setting_.profile, setting_.line))
      return;
    const UvBox box{cell.low(), cell.high()};
    Footing at = known_;
    if (!holds(cell, known_)) {
      const Vec2 start = known_.patch == cell.patch ? box.nearest(known_.uv) : cell.centre;
      at = settle(setting_, cell.patch, box, start, work_.steps);
    }
    double proven = above;
    if (at.under()) {
      if (at.height > best_.height && belongs(at)) {
        know(at);
        climb(at.patch, at.uv);
      }
      proven = std::min(above, at.height + excess_bound(cell, at, setting_.profile, setting_.line));
    } else if (beside_tool(cell, box, at.uv)) {
      return;
    }
    if (proven > enough()) push_halves(index, cell, proven);
  }
  /// A wall that bends along the flank.
  bool beside_tool(const PatchCell& cell, const UvBox& box, const Vec2& uv) {
    const Footing at = nearest_to_axis(setting_, cell.patch, box, uv, work_.steps);
    return at.rho > setting_.profile.radius() && beyond_rim(cell, at, setting_.profile, setting_.line);
  }
  void push_halves(int index, const PatchCell& cell, double above) {
    const int side = longer_side(cell);
    Waiting one{index, true, cell.centre, cell.half, above};
    one.half[side] *= 0.5;
    one.centre[side] -= one.half[side];
    Waiting two = one;
    two.centre[side] += 2.0 * one.half[side];
    if (one.half[side] > 0.0 && one.centre[side] < two.centre[side]) {
      push_both(one, two);
    } else {
      // As small as numbers get: what stays unproven is told.
      open_ = std::max(open_, above);
    }
  }

  const Setting& setting_;
  const std::vector<PatchCell>& cells_;
  Rest& best_;
  PatchHint& near_;
  PatchWork& work_;
  const PatchHint& loop_;
  Footing known_;    ///< the highest so far of this part
  Support support_;  ///< of it
  bool has_known_ = false;
  bool raised_on_ring_ = false;
  double open_ = kNothingYet;  ///< the highest bound that was not settled
  size_t count_ = 0;
  std::array<Waiting, kStack> stack_;
};

}  // namespace

PatchTarget::PatchTarget(std::vector<Patch> patches, const CellOptions& options)
    : patches_(std::move(patches)), cells_(cell_tree(patches_, options)) {}

void PatchTarget::raise(const ToolProfile& profile, const GuideLine& line, Rest& best,
                        PatchHint& near) const {
  PatchWork work;
  raise(profile, line, best, near, work);
}

void PatchTarget::raise(const ToolProfile& profile, const GuideLine& line, Rest& best, PatchHint& near,
                        PatchWork& work, const PatchHint& loop) const {
  work = {};
  const Setting setting{patches_, profile, line};
  PatchSearch(setting, cells_, best, near, work, loop).run();
}

}  // namespace swarf::position

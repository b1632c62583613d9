#include "measure/root_proof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "measure/cell_parts.h"
#include "measure/column_range.h"
#include "measure/height_bounds.h"
#include "measure/rest_bound.h"
#include "measure/root_sweeps.h"
#include "stock/rays/ray_height.h"
#include "surface/face.h"

namespace swarf::measure {
namespace {

/// Cells on the border of a gouge or of material left standing are divided down to this; mm.
constexpr double kBorder = 0.01;
/// In cells smaller than this the deepest place of the lowest sweep is measured too; mm.
constexpr double kProbed = 0.1;
/// Of the deepest, or highest: heights need not be known closer for the volume beyond a limit.
constexpr double kVolumeShare = 0.1;
/// No cell is divided below this; mm, and of columns that fan out from one place, rad.
constexpr double kSmallest = 1e-3, kSmallestTurn = 1e-2;
constexpr double kThrough = 1e4;  // mm: any part
/// Sweeps are first looked for up to this height over the design, mm; where more is left, up to the box's
/// top.
constexpr double kNearHeight = 0.05;

bool is_divisible(const DesignCell& cell) {
  double turn = 0.0;
  for (size_t k = 0; k < 3; ++k)
    turn = std::max(turn, (cell.corners[k].normal - cell.corners[(k + 1) % 3].normal).norm());
  const double edge = cell.longest_edge();
  return edge > 0.0 ? edge > kSmallest : turn > kSmallestTurn;
}

CornerHeights through_stock(const Cell& cell, const Box& stock) {
  CornerHeights through{};
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& at = cell.corners[k].at;
    through[k] = leaves_box(stock, at.point, -at.normal);
  }
  return through;
}

/// The grid tells nothing of a cell wider than its band, and no more of one much smaller than of the cell
/// around it.
bool asks_grid(const Cell& cell, double voxel) {
  double highest = 0.0;
  for (const Corner& corner : cell.corners) highest = std::max(highest, corner.height);
  return cell.shape.radius() < 2.0 * voxel && (cell.air == kNever || cell.shape.radius() > voxel / 32.0) &&
         cell.air > highest + 2.0 * voxel;
}

/// Whether the depth down to which a cut is looked for may not suffice for what was measured.
bool is_deep(const Cell& cell) {
  return std::any_of(cell.corners.begin(), cell.corners.end(),
                     [](const Corner& corner) { return corner.height < -0.5 * stock::kSkin; });
}

/// A cut that goes deeper than kSkin is followed to where the columns end.
CornerHeights deepest_seen(const std::vector<CornerHeights>& ends) {
  double most = kNever;
  for (const CornerHeights& end : ends) most = std::min(most, *std::max_element(end.begin(), end.end()));
  most = std::min(most, kThrough);
  return {most, most, most};
}

/// Whether the raw stock lacks what is asked for all over the cell: no cut has a border or a volume there.
bool is_missing(const Cell& cell, double limit_mm) {
  return std::all_of(cell.corners.begin(), cell.corners.end(), [&](const Corner& corner) {
    return corner.near == stock::kUncut && -corner.height > limit_mm;
  });
}

class RootProof {
 public:
  RootProof(const CertificateInput& input, const SweepIndex& index, const RootCell& root,
            const Budget& budget)
      : input_(input), index_(index), root_(root), budget_(budget) {}

  RootResult prove() {
    const double near = 2.0 * std::min(input_.excess_known_mm, input_.excess_limit_mm) + kNearHeight;
    for (const double reach : {near, kNever}) {
      result_ = {};
      layers_ = roofs_ = {};
      gouges_.clear();
      excesses_.clear();
      highest_seen_ = 0.0;
      floors_.clear();
      reach_ = reach;
      near_ = RootSweeps(input_, numbers_up_to(reach, root_, input_, index_));
      gouge_goal_ = std::min(input_.gouge_known_mm, input_.gouge_limit_mm);
      excess_goal_ = std::min(input_.excess_known_mm, input_.excess_limit_mm);
      const auto& c = root_.cell.corners;
      kept_.resize(near_.size());
      for (uint32_t n = 0; n < kept_.size(); ++n) kept_[n] = n;
      planes_.clear();
      planes_.add(near_.numbers(), input_.sweeps, input_.cutters);
      std::array<Corner, 3> corners;
      for (size_t k = 0; k < 3; ++k) {
        corners[k] = measured({c[k]}, 0, kept_.size(), {});
        corners[k].at_rim = true;
      }
      visit({root_.cell, corners, root_.edges, 0, kept_.size(), kNever, kNever, true, {true, true, true}});
      if (highest_seen_ < reach) break;
    }
    result_.gouges = join_pieces(gouges_);
    result_.excesses = join_pieces(excesses_);
    return std::move(result_);
  }

 private:
  /// A place inside a cell that was measured besides its corners.
  struct Probe {
    Vec3 place;  ///< barycentric
    Corner corner;
  };
  /// Of what stands over the cell: the least height, the height of all, and of what stands on the design.
  struct Bounds {
    double low, high, skin;
  };

  /// Height at one corner, by the sweeps kept_[begin, end); `guesses` go first.
  Corner measured(const CellCorner& at, size_t begin, size_t end, std::array<uint32_t, 2> guesses) {
    Corner corner;
    corner.at = at;
    take_range(input_, corner);
    take_raw(raw_, corner);
    const auto look_at = [&](uint32_t n) {
      const double low = lowest_cut(at, near_[n], corner.height, fans_, input_.field);
      if (low >= corner.height) return;
      corner.height = low;
      corner.near = n;
    };
    for (const uint32_t guess : {guesses[0], guesses[1], between(guesses)}) {
      if (guess < near_.size()) look_at(guess);
    }
    column_heights(at, planes_.from(begin), end - begin, heights_);
    for (size_t i = begin; i < end; ++i) {
      if (floors_.size() == kept_.size() && floors_[i] >= corner.height) continue;
      if (heights_[i - begin] < corner.height + kPlaneSlack) look_at(kept_[i]);
    }
    // The kept sweeps prove bounds; what counts as found is measured against all of them: what is more than
    // is asked for, or than was found before.
    const double asked = std::min(excess_target(), scallop_target());
    const double known = std::max(result_.excess_found, input_.excess_known_mm);
    if (root_.looks_up && corner.height > std::min(asked, known)) {
      // At the bottom of the stack.
      column_heights(at, planes_.from(0), near_.size(), heights_);
      for (uint32_t n = 0; n < near_.size(); ++n)
        if (heights_[n] < corner.height + kPlaneSlack) look_at(n);
    }
    keep_own(input_, corner);
    note(corner);
    return corner;
  }

  void note(const Corner& corner) {
    highest_seen_ = std::max(highest_seen_, corner.height);
    const uint32_t block = corner.near == stock::kUncut ? stock::kUncut : near_.number(corner.near);
    if (root_.looks_down && -corner.height > result_.gouge_found) {
      result_.gouge_found = -corner.height;
      result_.gouge_bottom = corner.at.point + corner.height * corner.at.normal;
      result_.gouge_block = block;
    }
    if (root_.looks_up && corner.height > result_.excess_found) {
      result_.excess_found = corner.height;
      result_.excess_top = corner.at.point + corner.height * corner.at.normal;
      result_.excess_block = block;
    }
  }

  /// Whether nothing that stands on the cell breaks the limit in a root where something does, and a roof may.
  bool may_hide_roof(const Cell& cell, const Bounds& bounds) const {
    const double limit = input_.excess_limit_mm;
    return root_.looks_up && bounds.high > limit &&
           std::max(result_.excess_found, result_.above_found) > limit &&
           std::all_of(cell.corners.begin(), cell.corners.end(),
                       [&](const Corner& corner) { return corner.height <= limit; }) &&
           rest_.ends_below(cell, {bounds.high, bounds.high, bounds.high});
  }

  /// Where no division closes a cell whose sweeps leave none on the design, because of what stands above a
  /// gap: that is measured at the corners.
  void measure_above(Cell& cell, const Bounds& bounds) {
    if (!root_.looks_up || !input_.wants_excess || !(bounds.high > input_.excess_limit_mm)) return;
    const bool open = bounds.high > excess_target() && resists_division(cell, input_.stock.voxel_mm());
    if (!open && !may_hide_roof(cell, bounds)) return;
    if (!roofs_.is_worth_it(result_.work)) return;
    for (Corner& corner : cell.corners) look_above(corner);
    if (std::any_of(cell.corners.begin(), cell.corners.end(),
                    [](const Corner& corner) { return corner.highest() > corner.height + stock::kSliver; }))
      roofs_.count_success();
  }

  void look_above(Corner& corner) {
    if (!corner.above) {
      corner.above = rest_top(corner.at, corner.range, raw_, all_near());
      roofs_.count(all_near().size(), result_.work);
    }
    const double top = *corner.above;
    if (!(top > std::max(result_.above_found, corner.height + stock::kSliver))) return;
    result_.above_found = top;
    result_.above_top = corner.at.point + top * corner.at.normal;
    highest_seen_ = std::max(highest_seen_, top);
  }

  double gouge_target() const {
    return target(std::max(result_.gouge_found, gouge_goal_), input_.gouge_limit_mm);
  }
  double excess_target() const {
    if (!input_.wants_excess) return kNever;
    const double close = target(std::max(result_.excess_found, excess_goal_), input_.excess_limit_mm);
    return result_.above_found > input_.excess_limit_mm
               ? std::max(close, result_.above_found + above_gap(input_.stock.voxel_mm()))
               : close;
  }
  double scallop_target() const {
    return input_.wants_scallop
               ? target(std::max(result_.excess_found, excess_goal_), input_.scallop_limit_mm)
               : kNever;
  }
  /// The bound to reach where `found` was measured: it need not be closer than decides a limit.
  double target(double found, double limit) const {
    const double decided = limit - input_.sweep_bound_mm - kTouch;
    const double close = found + kGap + kGapShare * found;
    if (found >= decided) return close;
    return decided;
  }

  /// How deep the cell's columns count at most: linear functions, each of which bounds all of them. What is
  /// nearer to another face is that one's, and below the stock there is nothing.
  std::vector<CornerHeights> ends_below(const Cell& cell, const std::vector<CornerHeights>& own) const {
    DesignCell below = cell.shape;
    for (CellCorner& corner : below.corners) corner.normal = -corner.normal;
    std::vector<CornerHeights> ends = own;
    add_box(input_.stock.box(), below, ends);
    return ends;
  }

  /// Least height over the cell; floors_ gets each sweep's. A bound holds however much deeper it looks, so
  /// what is the cell's own, which asks for distances, is asked for only where that does not suffice; and
  /// each sweep's bound may look as deep as it likes best.
  double lower_bound(const Cell& cell) {
    std::fill(floors_.begin() + static_cast<std::ptrdiff_t>(cell.begin),
              floors_.begin() + static_cast<std::ptrdiff_t>(cell.end), -kNever);
    ColumnDepths depths{{stock::kSkin, stock::kSkin, stock::kSkin}, {}};
    double low = lower_bound(cell, depths);
    if (low >= -gouge_target() || !root_.looks_down) return low;
    const std::vector<CornerHeights> own = own_below(cell.shape, input_.field,
                                                     through_stock(cell, input_.stock.box())),
                                     ends = ends_below(cell, own);
    const bool flat = is_flat(cell.shape);
    if (flat) depths.own = own;
    bool looked = depths.own.empty();
    for (const CornerHeights& end : ends) {
      const double most = *std::max_element(end.begin(), end.end());
      if (*std::min_element(end.begin(), end.end()) >= stock::kSkin || most == kNever) continue;
      // Where columns fan out the product of depth and direction is no linear function.
      depths.seen = flat ? end : CornerHeights{most, most, most};
      low = lower_bound(cell, depths);
      if (low >= -gouge_target()) return low;
      looked = true;
    }
    if (!looked) low = lower_bound(cell, depths);
    if (low == -kNever && is_deep(cell)) low = lower_bound(cell, {deepest_seen(ends), depths.own});
    return low == -kNever ? -std::min(highest_left(ends).height, kThrough) : low;
  }

  double lower_bound(const Cell& cell, const ColumnDepths& depths) {
    double low = std::min(cell.dropped, stood_before(cell, raw_));
    const double enough = -gouge_target();
    cell_heights(cell.shape, depths, planes_.from(cell.begin), cell.end - cell.begin, heights_);
    for (size_t i = cell.begin; i < cell.end; ++i) {
      if (floors_[i] < enough) {
        const double by_plane = heights_[i - cell.begin];
        floors_[i] = std::max(floors_[i], by_plane > enough
                                              ? by_plane
                                              : least_height(cell.shape, near_[kept_[i]], depths, enough));
      }
      low = std::min(low, floors_[i]);
    }
    return low;
  }

  double upper_bound(Cell& cell) {
    // Where the columns leave the box, and a little for what lies between the corners.
    double leave = 0.0;
    for (const Corner& corner : cell.corners)
      leave = std::max(leave, leaves_box(input_.stock.box(), corner.at.point, corner.at.normal));
    double top = std::min(leave + cell.shape.radius(), cell.air);
    const double target = excess_target();
    const std::vector<CornerHeights> own = rest_.own_above(cell);
    if (!raw_.is_box()) top = look_at_raw(raw_, own, top, cell);
    double high = left(cell, own, tops_of(own, top), target);
    if (high > target && asks_grid(cell, input_.stock.voxel_mm())) {
      cell.air = std::min(cell.air,
                          air_above(cell.shape, input_.stock, input_.stock_bound_mm, std::max(leave, 0.0)));
      top = std::min(top, cell.air);
      high = left(cell, own, tops_of(own, top), target);
    }
    if (high > target) high = std::min(high, left_below_layers(cell, own, tops_of(own, top), target));
    return std::min(high, top);
  }

  /// The same where it takes several sweeps, one above the other, to clear a column.
  double left_below_layers(Cell& cell, const std::vector<CornerHeights>& own, const CornerHeights& tops,
                           double target) {
    if (!layers_.is_worth_it(result_.work) || !rest_.ends_below(cell, tops)) return kNever;
    layers_.count(all_near().size(), result_.work);
    const std::optional<CornerHeights> lowered = rest_.lowered(cell, tops, target, all_near());
    if (!lowered) return kNever;
    const double most = *std::max_element(lowered->begin(), lowered->end());
    cell.air = std::min(cell.air, most);
    const double high = most > target ? std::min(most, left(cell, own, *lowered, target)) : most;
    if (!(high > target)) layers_.count_success();
    return high;
  }

  /// Up to the stock's top, whatever was looked for.
  const std::vector<NearSweep>& all_near() {
    if (!all_near_) all_near_ = sweeps_up_to(kNever, root_, input_, index_);
    return *all_near_;
  }

  double left(const Cell& cell, const std::vector<CornerHeights>& own, const CornerHeights& tops,
              double enough) {
    const size_t count = cell.end - cell.begin;
    return rest_.left(cell, own, tops, enough,
                      {std::span(kept_).subspan(cell.begin, count),
                       std::span(floors_).subspan(cell.begin, count), planes_.from(cell.begin)});
  }

  /// Of what stands on the design: whatever lies above its first air.
  double skin_bound(const Cell& cell, double high) {
    if (!(high > scallop_target())) return high;
    return std::min(high, left(cell, rest_.own_above(cell), kNoTop, scallop_target()));
  }

  void close(const Cell& cell, const Bounds& bounds, const std::optional<Probe>& probed) {
    if (root_.looks_down && -bounds.low > result_.gouge) {
      result_.gouge = -bounds.low;
      result_.gouge_at = cell.shape.centroid();
    }
    if (root_.looks_up && bounds.high > result_.excess) {
      result_.excess = bounds.high;
      result_.excess_at = cell.shape.centroid();
    }
    if (root_.looks_up && bounds.skin > result_.scallop) {
      result_.scallop = bounds.skin;
      result_.scallop_at = cell.shape.centroid();
    }
    if (!probed) {
      add_pieces(cell, bounds);
      return;
    }
    for (size_t k = 0; k < 3; ++k) {
      Cell part = cell;
      part.corners[k] = probed->corner;
      part.shape = make_cell({part.corners[0].at, part.corners[1].at, part.corners[2].at}, root_.bounds);
      add_pieces(part, bounds);
    }
  }

  /// A corner beyond the cell's bounds is touched from the next cell, and no part of this one.
  void add_pieces(const Cell& cell, const Bounds& bounds) {
    std::array<double, 3> heights{}, depths{};
    std::array<uint32_t, 3> blocks{};
    for (size_t k = 0; k < 3; ++k) {
      heights[k] = std::min(cell.corners[k].highest(), bounds.high + kTouch);
      depths[k] = std::min(-cell.corners[k].height, -bounds.low);
      blocks[k] = cell.corners[k].near == stock::kUncut ? stock::kUncut : near_.number(cell.corners[k].near);
    }
    if (root_.looks_down)
      add_piece(cell.shape, depths, blocks, input_.gouge_limit_mm, cell.near_rim, gouges_);
    if (root_.looks_up)
      add_piece(cell.shape, heights, blocks, input_.excess_limit_mm, cell.near_rim, excesses_);
  }

  /// Whether part of the cell may break a limit and part of it keep it, or its volume is told too coarsely.
  bool on_border(const Cell& cell, const Bounds& bounds) {
    const bool gouge =
        root_.looks_down && -bounds.low > input_.gouge_limit_mm && !(-bounds.high > input_.gouge_limit_mm) &&
        result_.gouge_found > input_.gouge_limit_mm && !is_missing(cell, input_.gouge_limit_mm);
    const bool excess = root_.looks_up && asks_above(input_) && bounds.high > input_.excess_limit_mm &&
                        !(bounds.low > input_.excess_limit_mm) &&
                        result_.excess_found > input_.excess_limit_mm;
    if (gouge || !excess) return gouge;
    // Of a roof above a gap no division tells more.
    const double skin = left(cell, rest_.own_above(cell), kNoTop, input_.excess_limit_mm);
    double least = kNever;
    for (const Corner& corner : cell.corners) least = std::min(least, corner.height);
    return skin > input_.excess_limit_mm &&
           !(std::min(skin, bounds.high) - least <= kVolumeShare * result_.excess_found &&
             least > input_.excess_limit_mm && stands_above(cell));
  }

  /// Whether all of the cell stands above the limit.
  bool stands_above(const Cell& cell) {
    const double limit = input_.excess_limit_mm;
    const ColumnDepths depths{{stock::kSkin, stock::kSkin, stock::kSkin}, {}};
    const auto stays_above = [&](uint32_t n) {
      return least_height(cell.shape, near_[n], depths, limit) > limit;
    };
    if (!(stood_before(cell, raw_) > limit)) return false;
    for (size_t i = cell.begin; i < cell.end; ++i)
      if (!(floors_[i] > limit) && !stays_above(kept_[i])) return false;
    if (cell.dropped > limit) return true;
    result_.work += near_.size();
    for (uint32_t n = 0; n < near_.size(); ++n)
      if (!stays_above(n)) return false;
    return true;
  }

  /// Whether a roof over the cell breaks the limit at some corners alone, or between them.
  bool on_border_of_roof(const Cell& cell, const Bounds& bounds, double edge) const {
    if (!input_.wants_excess || !may_hide_roof(cell, bounds)) return false;
    const auto breaking = std::count_if(cell.corners.begin(), cell.corners.end(), [&](const Corner& corner) {
      return corner.highest() > input_.excess_limit_mm;
    });
    return breaking == 0 ? !resists_division(cell, input_.stock.voxel_mm()) : breaking < 3 && edge > kBorder;
  }

  /// Whether the cell lies in a gouge of whose volume it tells too little.
  bool is_coarse(const Cell& cell, const Bounds& bounds) const {
    return root_.looks_down && !is_missing(cell, input_.gouge_limit_mm) &&
           -bounds.low > input_.gouge_limit_mm && result_.gouge_found > input_.gouge_limit_mm &&
           bounds.high - bounds.low > kVolumeShare * result_.gouge_found;
  }

  /// One root may take long where the design has few, and one cell ask for thousands of distances.
  bool is_stopped() {
    stopped_ = stopped_ || input_.progress.stop_requested();
    return stopped_;
  }

  bool breaks_limit() {
    result_.broken = (root_.looks_down && result_.gouge_found > input_.gouge_limit_mm) ||
                     (root_.looks_up && asks_above(input_) &&
                      std::max(result_.excess_found, result_.above_found) > input_.excess_limit_mm);
    return result_.broken;
  }

  /// Measures where the sweep that bounds the cell lowest should cut deepest.
  std::optional<Probe> probe(const Cell& cell) {
    // Places beyond an edge are none of the design.
    if (cell.begin == cell.end || cell.shape.strip_mm > surface::kLoopChord) return std::nullopt;
    const auto first = floors_.begin() + static_cast<std::ptrdiff_t>(cell.begin);
    const auto lowest = std::min_element(first, floors_.begin() + static_cast<std::ptrdiff_t>(cell.end));
    const uint32_t n = kept_[static_cast<size_t>(lowest - floors_.begin())];
    const std::optional<Vec3> place = deepest_place(cell.shape, near_[n]);
    if (!place) return std::nullopt;
    const CellCorner at = place_in(cell.shape, *place, root_.bounds);
    return Probe{*place, measured(at, cell.begin, cell.end, {n, n})};
  }

  void visit(Cell cell) {
    // Bounds above the height up to which sweeps were looked for need all of them: the root is begun anew.
    if (highest_seen_ > reach_) return;
    ++result_.cells;
    if (is_stopped()) return;
    // A cell of a mesh asks for distances, which cost as much as many sweeps.
    constexpr size_t kCellOfMesh = 64, kCell = 4;
    result_.work += (input_.field.design != nullptr ? kCellOfMesh : kCell) + cell.end - cell.begin;
    floors_.resize(kept_.size());
    Bounds bounds{lower_bound(cell), 0.0, 0.0};
    bounds.high = upper_bound(cell);
    measure_above(cell, bounds);
    if (highest_seen_ > reach_) return;
    bounds.skin = skin_bound(cell, bounds.high);
    const double edge = cell.shape.longest_edge();
    std::optional<Probe> probed;
    if (root_.looks_down && edge < kProbed && -bounds.low > std::min(gouge_target(), input_.gouge_limit_mm))
      probed = probe(cell);
    const bool gouge_open = root_.looks_down && -bounds.low > gouge_target();
    const bool excess_open =
        root_.looks_up && (bounds.high > excess_target() || bounds.skin > scallop_target());
    const bool seen = std::any_of(cell.corners.begin(), cell.corners.end(), [&](const Corner& corner) {
      return -corner.height > input_.gouge_limit_mm || corner.height > input_.excess_limit_mm;
    });
    const bool divide = ((gouge_open || excess_open) && is_divisible(cell.shape)) ||
                        (on_border(cell, bounds) && edge > (seen ? kBorder : kSmallest)) ||
                        on_border_of_roof(cell, bounds, edge) ||
                        (is_coarse(cell, bounds) && edge > 2.0 * kBorder);
    const bool too_much = result_.work > (breaks_limit() ? budget_.broken : budget_.all);
    result_.cut_short = result_.cut_short || (divide && too_much);
    if (!divide || too_much) {
      if (gouge_open || excess_open)
        result_.open.push_back({-bounds.low, bounds.high, bounds.skin, cell.shape.area_mm2()});
      close(cell, bounds, probed);
      return;
    }
    divide_cell(cell, bounds);
  }

  /// Sweeps that may still be the lowest somewhere in the cell are kept for its parts.
  void divide_cell(const Cell& cell, const Bounds& bounds) {
    const size_t begin = kept_.size();
    double dropped = cell.dropped;
    // Above the highest corner a sweep can only matter for the upper bound, which needs no certain set.
    double highest = -kNever;
    for (const Corner& corner : cell.corners) highest = std::max(highest, corner.height);
    const double slack = 0.05 * cell.shape.radius();
    places_.clear();
    for (size_t i = cell.begin; i < cell.end; ++i) {
      const bool deep = root_.looks_down && -floors_[i] > gouge_target();
      const bool low = floors_[i] <= highest + slack && floors_[i] < bounds.high;
      if (deep || low) {
        places_.push_back(static_cast<uint32_t>(i));
        kept_.push_back(kept_[i]);
        floors_.push_back(floors_[i]);
      } else {
        dropped = std::min(dropped, floors_[i]);
      }
    }
    planes_.repeat(places_);
    const size_t end = kept_.size();
    const bool resists = bounds.high > excess_target() && resists_division(cell, input_.stock.voxel_mm());
    const Seams seams = resists ? rest_.seams_of(cell) : Seams{};
    const auto is_seam = [](const auto& place) { return place.has_value(); };
    const bool halved = std::count_if(seams.begin(), seams.end(), is_seam) == 1;
    const auto side = static_cast<size_t>(std::find_if(seams.begin(), seams.end(), is_seam) - seams.begin());
    std::array<Corner, 3> middles;
    for (size_t k = 0; k < 3; ++k) {
      if (halved && k != side) continue;
      const Corner &a = cell.corners[k], &b = cell.corners[(k + 1) % 3];
      const CellCorner at = seams[k] ? *seams[k] : middle(a.at, b.at, root_.bounds, cell.edges[k]);
      middles[k] = measured(at, begin, end, {a.near, b.near});
      middles[k].at_rim = cell.outer[k];
    }
    const auto& c = cell.corners;
    const bool near_rim = std::any_of(c.begin(), c.end(), [](const Corner& corner) { return corner.at_rim; });
    for (const CellPart& part : halved ? halves_of(cell, side, middles[side]) : quarters_of(cell, middles)) {
      visit(
          {make_cell({part.corners[0].at, part.corners[1].at, part.corners[2].at}, root_.bounds, part.edges),
           part.corners, part.edges, begin, end, dropped, cell.air, near_rim, part.outer});
      kept_.resize(end);
      floors_.resize(end);
      planes_.resize(end);
    }
    kept_.resize(begin);
    floors_.resize(begin);
    planes_.resize(begin);
  }

  const CertificateInput& input_;
  const stock::RawShape& raw_{input_.stock.raw()};
  const SweepIndex& index_;
  const RootCell& root_;
  const bool fans_{root_.cell.area_mm2() == 0.0};  ///< its columns begin at an edge, or a corner
  Budget budget_;
  double gouge_goal_ = 0.0, excess_goal_ = 0.0, highest_seen_ = 0.0, reach_ = kNever;
  RootSweeps near_;
  std::optional<std::vector<NearSweep>> all_near_;  ///< up to the stock's top, once they are asked for
  std::vector<uint32_t> kept_;  ///< a stack: the sweeps of a cell lie above those of the cell around it
  std::vector<double> floors_;  ///< least heights of kept_ over the cell last looked at
  BottomPlanes planes_;         ///< of kept_
  std::vector<double>
      heights_;  ///< of the sweeps of the cell, or the corner, last looked at, by their planes
  std::vector<uint32_t> places_;  ///< in kept_, of those that stay
  RestBound rest_{input_, root_, near_};
  bool stopped_ = false;
  LooksAtAll layers_, roofs_;  ///< of left_below_layers() and measure_above()
  RootResult result_;
  std::vector<RegionPiece> gouges_, excesses_;
};

}  // namespace

RootResult prove_root(const CertificateInput& input, const SweepIndex& index, const RootCell& root,
                      const Budget& budget) {
  return RootProof(input, index, root, budget).prove();
}

}  // namespace swarf::measure

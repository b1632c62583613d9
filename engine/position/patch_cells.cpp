#include "position/patch_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/parallel.h"

namespace swarf::position {
namespace {

void set_radius(PatchCell& cell) {
  cell.stray = cell.stray_uu + cell.stray_uv + cell.stray_vv;
  const double corner = std::max((cell.a + cell.b).norm(), (cell.a - cell.b).norm());
  cell.radius = corner + cell.uu.norm() + cell.uv.norm() + cell.vv.norm() + cell.stray;
}

/// Cells that may still be made; shared by the patches, so that the limit holds for all together.
size_t share_of(const CellOptions& options, size_t patches) {
  return std::max<size_t>(1, options.most_cells / std::max<size_t>(1, patches));
}

[[noreturn]] void refuse_count(int patch, const CellOptions& options) {
  throw InputError("too-many-cells", {},
                   fmt::format("patch {} needs more than its share of {} cells to be resolved to {:g} mm",
                               patch, options.most_cells, options.most_bend),
                   "cut the patch where it is strongly curved, or allow more cells");
}

void refuse_unbounded(const PatchCell& cell) {
  if (std::isfinite(cell.radius) && cell.p.allFinite()) return;
  throw InputError("patch-not-finite", {},
                   fmt::format("patch {} has no finite bound about u {:g}, v {:g}", cell.patch,
                               cell.centre.x(), cell.centre.y()),
                   "give a surface that is finite over its whole square");
}

/// By how much a part of a cell strays from the quadratic of the whole: the difference of the two
/// quadratics, in the part's coordinates, and its own stray.
double stray_of_part(const PatchCell& whole, const PatchCell& part) {
  const Vec2 at = (part.centre - whole.centre).cwiseQuotient(whole.half);
  const Vec2 size = part.half.cwiseQuotient(whole.half);
  const double s = at.x(), t = at.y(), u = size.x(), v = size.y();
  const Vec3 p = whole.p + s * whole.a + t * whole.b + s * s * whole.uu + s * t * whole.uv + t * t * whole.vv;
  const Vec3 a = u * (whole.a + 2.0 * s * whole.uu + t * whole.uv);
  const Vec3 b = v * (whole.b + 2.0 * t * whole.vv + s * whole.uv);
  return (part.p - p).norm() + (part.a - a).norm() + (part.b - b).norm() +
         (part.uu - u * u * whole.uu).norm() + (part.uv - u * v * whole.uv).norm() +
         (part.vv - v * v * whole.vv).norm() + part.stray;
}

/// The cells of one patch, children behind their parent, the patch itself first.
class CellMaker {
 public:
  CellMaker(const Patch& of, int patch, const CellOptions& options, size_t most)
      : of_(of), surface_(*of.surface), patch_(patch), options_(options), most_(most) {}

  std::vector<PatchCell> make() {
    cells_.push_back(cell_of({0.0, 0.0}, {1.0, 1.0}));
    for (size_t i = 0; i < cells_.size(); ++i) {
      refuse_unbounded(cells_[i]);
      if (!fine(cells_[i])) split(i);
    }
    for (size_t i = cells_.size(); i-- > 0;) tighten(cells_[i]);
    return std::move(cells_);
  }

 private:
  PatchCell cell_of(const Vec2& low, const Vec2& high) const {
    PatchCell cell = patch_cell(surface_, patch_, low, high);
    cell.region = region_of(of_, low, high);
    return cell;
  }
  bool fine(const PatchCell& cell) const {
    if (cell.region == surface::Region::kOutside) return true;
    const double bend = cell.uu.norm() + cell.uv.norm() + cell.vv.norm();
    return bend <= options_.most_bend && cell.stray <= options_.most_stray;
  }
  void split(size_t i) {
    if (cells_.size() + 2 > most_) refuse_count(patch_, options_);
    const PatchCell cell = cells_[i];
    const int side = longer_side(cell);
    Vec2 high = cell.high(), low = cell.low();
    high[side] = low[side] = cell.centre[side];
    cells_[i].child = static_cast<int>(cells_.size());
    cells_.push_back(cell_of(cell.low(), high));
    cells_.push_back(cell_of(low, cell.high()));
  }

  /// From its halves, which stand behind it.
  void tighten(PatchCell& cell) const {
    if (cell.child < 0) return;
    double stray = 0.0;
    for (int i = 0; i < 2; ++i)
      stray = std::max(stray, stray_of_part(cell, cells_[static_cast<size_t>(cell.child + i)]));
    if (stray >= cell.stray) return;
    cell.radius -= cell.stray - stray;
    cell.stray = stray;
  }

  const Patch& of_;
  const surface::Surface& surface_;
  int patch_;
  const CellOptions& options_;
  size_t most_;
  std::vector<PatchCell> cells_;
};

/// A cell about two others: nothing but their sphere.
PatchCell around(const std::vector<PatchCell>& cells, int first) {
  const PatchCell& one = cells[static_cast<size_t>(first)];
  const PatchCell& two = cells[static_cast<size_t>(first) + 1];
  const Vec3 way = two.p - one.p;
  const double apart = way.norm();
  PatchCell both;
  both.child = first;
  both.radius = std::max({one.radius, two.radius, 0.5 * (apart + one.radius + two.radius)});
  const double along = apart > 0.0 ? (both.radius - one.radius) / apart : 0.0;
  both.p = one.p + std::clamp(along, 0.0, 1.0) * way;
  both.radius = std::max((both.p - one.p).norm() + one.radius, (both.p - two.p).norm() + two.radius);
  both.stray = both.radius;
  return both;
}

/// Roots of the patches as one tree: halves by the middle of the longest side of the box of their centres.
PatchCell group(std::vector<PatchCell>& cells, std::vector<PatchCell>& roots, size_t from, size_t to) {
  if (to - from == 1) return roots[from];
  Vec3 low = roots[from].p, high = low;
  for (size_t i = from; i < to; ++i) {
    low = low.cwiseMin(roots[i].p);
    high = high.cwiseMax(roots[i].p);
  }
  Eigen::Index side = 0;
  (high - low).maxCoeff(&side);
  const auto at = [&](size_t i) { return roots.begin() + static_cast<std::ptrdiff_t>(i); };
  std::sort(at(from), at(to), [side](const PatchCell& x, const PatchCell& y) {
    return x.p[side] != y.p[side] ? x.p[side] < y.p[side] : x.patch < y.patch;
  });
  const size_t middle = (from + to) / 2;
  const PatchCell one = group(cells, roots, from, middle), two = group(cells, roots, middle, to);
  const int first = static_cast<int>(cells.size());
  cells.push_back(one);
  cells.push_back(two);
  return around(cells, first);
}

}  // namespace

PatchCell patch_cell(const surface::Surface& surface, int patch, const Vec2& low, const Vec2& high) {
  PatchCell cell;
  cell.patch = patch;
  cell.centre = 0.5 * (low + high);
  cell.half = 0.5 * (high - low);
  const double u = cell.half.x(), v = cell.half.y();
  const surface::Derivatives d = surface.derivatives(cell.centre.x(), cell.centre.y());
  const surface::BendBounds bend = surface.bend_bounds(low, high);
  cell.p = d.S;
  cell.a = u * d.Su;
  cell.b = v * d.Sv;
  cell.uu = 0.5 * u * u * bend.uu.mean;
  cell.uv = u * v * bend.uv.mean;
  cell.vv = 0.5 * v * v * bend.vv.mean;
  cell.stray_uu = 0.5 * u * u * bend.uu.stray;
  cell.stray_uv = u * v * bend.uv.stray;
  cell.stray_vv = 0.5 * v * v * bend.vv.stray;
  set_radius(cell);
  return cell;
}

PatchCell part_of(const surface::Surface& surface, const PatchCell& leaf, const Vec2& centre,
                  const Vec2& half) {
  const double u = half.x() / leaf.half.x(), v = half.y() / leaf.half.y();
  const surface::Derivatives d = surface.derivatives(centre.x(), centre.y());
  PatchCell cell = leaf;
  cell.centre = centre;
  cell.half = half;
  cell.p = d.S;
  cell.a = half.x() * d.Su;
  cell.b = half.y() * d.Sv;
  cell.uu *= u * u;
  cell.uv *= u * v;
  cell.vv *= v * v;
  cell.stray_uu *= u * u;
  cell.stray_uv *= u * v;
  cell.stray_vv *= v * v;
  set_radius(cell);
  return cell;
}

surface::Region region_of(const Patch& patch, const Vec2& low, const Vec2& high) {
  return patch.domain ? patch.domain->classify(low, high) : surface::Region::kInside;
}

int longer_side(const PatchCell& cell) {
  // By the whole extent: a side that collapses at the centre may still bend.
  const double u = cell.a.norm() + cell.uu.norm() + cell.stray_uu;
  const double v = cell.b.norm() + cell.vv.norm() + cell.stray_vv;
  return u >= v ? 0 : 1;
}

std::vector<PatchCell> cell_tree(const std::vector<Patch>& patches, const CellOptions& options) {
  std::vector<std::vector<PatchCell>> of(patches.size());
  parallel_chunks(patches.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      SWARF_CHECK(patches[i].surface != nullptr, "a patch has a surface");
      CellMaker maker(patches[i], static_cast<int>(i), options, share_of(options, patches.size()));
      of[i] = maker.make();
    }
  });
  std::vector<PatchCell> cells, roots;
  for (const std::vector<PatchCell>& part : of) {
    // The patch itself goes to the tree of patches; its descendants move up by one.
    const int moved = static_cast<int>(cells.size()) - 1;
    for (size_t i = 0; i < part.size(); ++i) {
      PatchCell cell = part[i];
      if (cell.child >= 0) cell.child += moved;
      (i == 0 ? roots : cells).push_back(cell);
    }
  }
  if (!roots.empty()) cells.push_back(group(cells, roots, 0, roots.size()));
  return cells;
}

}  // namespace swarf::position

#include "surface/ruled_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace swarf::surface {
namespace {

constexpr double kUndecided = std::numeric_limits<double>::infinity();
/// Ratios of weights that differ by less are equal.
constexpr double kSameRatio = 1e-12;

/// Rows of control points along the rulings: all patches of one strip between two breaks of the guide's
/// parameter.
class Strip {
 public:
  Strip(const BezierGrid& grid, RulingDirection direction, size_t strip)
      : grid_(grid), along_v_(direction == RulingDirection::kV), strip_(strip) {}
  size_t patches() const { return (along_v_ ? grid_.breaks_v : grid_.breaks_u).size() - 1; }
  int rows() const { return (along_v_ ? grid_.degree_u : grid_.degree_v) + 1; }
  int columns() const { return (along_v_ ? grid_.degree_v : grid_.degree_u) + 1; }
  const Vec4& pole(size_t patch, int row, int column) const {
    const size_t i = along_v_ ? strip_ : patch, j = along_v_ ? patch : strip_;
    const size_t first = (i * (grid_.breaks_v.size() - 1) + j) * grid_.patch_size();
    const int a = along_v_ ? row : column, b = along_v_ ? column : row;
    return grid_.poles[first + static_cast<size_t>(a * (grid_.degree_v + 1) + b)];
  }
  Vec3 point(size_t patch, int row, int column) const {
    const Vec4& p = pole(patch, row, column);
    return p.head<3>() / p.w();
  }
  Vec3 first(int row) const { return point(0, row, 0); }
  Vec3 last(int row) const { return point(patches() - 1, row, columns() - 1); }

 private:
  const BezierGrid& grid_;
  bool along_v_;
  size_t strip_;
};

/// Of one column against the ends of its rows; the share of the way is the one that suits all rows best.
double column_departure(const Strip& strip, size_t patch, int column) {
  double dot = 0.0, square = 0.0;
  for (int row = 0; row < strip.rows(); ++row) {
    const Vec3 way = strip.last(row) - strip.first(row);
    dot += way.dot(strip.point(patch, row, column) - strip.first(row));
    square += way.squaredNorm();
  }
  const double share = square > 0.0 ? dot / square : 0.0;
  double most = 0.0;
  for (int row = 0; row < strip.rows(); ++row) {
    const Vec3 on_line = strip.first(row) + share * (strip.last(row) - strip.first(row));
    most = std::max(most, (strip.point(patch, row, column) - on_line).norm());
  }
  return most;
}

/// Every row has the weights of the first, times a number of its own: then the mean over the rows is the same
/// for all columns.
bool weights_agree(const Strip& strip, size_t patch) {
  for (int row = 1; row < strip.rows(); ++row) {
    const double ratio = strip.pole(patch, row, 0).w() / strip.pole(0, 0, 0).w();
    const double own = strip.pole(patch, 0, 0).w() / strip.pole(0, 0, 0).w();
    for (int column = 0; column < strip.columns(); ++column) {
      const double expected = strip.pole(patch, 0, column).w() * ratio / own;
      if (std::abs(strip.pole(patch, row, column).w() - expected) > kSameRatio * expected) return false;
    }
  }
  return true;
}

/// The same number of a row in all patches, so that both ends of the ruling are means with the same shares.
bool rows_agree(const Strip& strip, size_t patch) {
  for (int row = 0; row < strip.rows(); ++row) {
    const double here = strip.pole(patch, row, 0).w() / strip.pole(patch, 0, 0).w();
    const double there = strip.pole(0, row, 0).w() / strip.pole(0, 0, 0).w();
    if (std::abs(here - there) > kSameRatio * there) return false;
  }
  return true;
}

class RuledBetween final : public Surface {
 public:
  explicit RuledBetween(RuledPart part) : part_(std::move(part)) {
    // Exchanged parameters and exchanged guides turn Su x Sv over, each of them.
    sign_ = part_.surface->outward_sign();
    if (along_u()) sign_ = -sign_;
    if (part_.exchanged) sign_ = -sign_;
  }

  Vec3 point(double u, double v) const override { return (1.0 - v) * guide(u, 0).C + v * guide(u, 1).C; }
  Derivatives derivatives(double u, double v) const override {
    const Guide a = guide(u, 0), b = guide(u, 1);
    Derivatives d;
    d.S = (1.0 - v) * a.C + v * b.C;
    d.Su = (1.0 - v) * a.dC + v * b.dC;
    d.Sv = b.C - a.C;
    d.Suu = (1.0 - v) * a.ddC + v * b.ddC;
    d.Suv = b.dC - a.dC;
    d.Svv = Vec3::Zero();
    return d;
  }
  BendBounds bend_bounds(const Vec2& low, const Vec2& high) const override {
    const Bend a = guide_bend(low.x(), high.x(), 0), b = guide_bend(low.x(), high.x(), 1);
    const double v = 0.5 * (low.y() + high.y()), half_u = 0.5 * (high.x() - low.x()),
                 half_v = 0.5 * (high.y() - low.y());
    BendBounds bounds;
    bounds.uu.mean = (1.0 - v) * a.mean + v * b.mean;
    bounds.uu.stray = std::max(a.stray, b.stray) + half_v * (b.mean - a.mean).norm();
    bounds.uv.mean = derivatives(0.5 * (low.x() + high.x()), v).Suv;
    bounds.uv.stray = half_u * ((b.mean - a.mean).norm() + a.stray + b.stray);
    return bounds;
  }
  int outward_sign() const override { return sign_; }

 private:
  struct Guide {
    Vec3 C, dC, ddC;
  };
  bool along_u() const { return part_.direction == RulingDirection::kU; }
  /// The edge's own coordinate, and how much of the face's parameter is one of ours.
  double edge(int which) const {
    const int side = part_.exchanged ? 1 - which : which;
    const Vec2& corner = side == 0 ? part_.low : part_.high;
    return along_u() ? corner.x() : corner.y();
  }
  double width() const { return along_u() ? (part_.high - part_.low).y() : (part_.high - part_.low).x(); }
  Vec2 place(double u, int which) const {
    const double across = edge(which);
    return along_u() ? Vec2(across, part_.low.y() + u * width()) : Vec2(part_.low.x() + u * width(), across);
  }
  Guide guide(double u, int which) const {
    const Vec2 at = place(u, which);
    const Derivatives d = part_.surface->derivatives(at.x(), at.y());
    const double w = width();
    return along_u() ? Guide{d.S, w * d.Sv, w * w * d.Svv} : Guide{d.S, w * d.Su, w * w * d.Suu};
  }
  Bend guide_bend(double low, double high, int which) const {
    const BendBounds bounds = part_.surface->bend_bounds(place(low, which), place(high, which));
    Bend bend = along_u() ? bounds.vv : bounds.uu;
    bend.mean *= width() * width();
    bend.stray *= width() * width();
    return bend;
  }

  RuledPart part_;
  int sign_ = 1;
};

}  // namespace

double ruled_departure_bound(const NurbsSurface& surface, RulingDirection direction) {
  const BezierGrid& grid = surface.grid();
  const size_t strips = (direction == RulingDirection::kV ? grid.breaks_u : grid.breaks_v).size() - 1;
  double most = 0.0;
  for (size_t s = 0; s < strips; ++s) {
    const Strip strip(grid, direction, s);
    for (size_t patch = 0; patch < strip.patches(); ++patch) {
      if (!weights_agree(strip, patch) || !rows_agree(strip, patch)) return kUndecided;
      for (int column = 0; column < strip.columns(); ++column)
        most = std::max(most, column_departure(strip, patch, column));
    }
  }
  return most;
}

double ruled_departure_seen(const NurbsSurface& surface, RulingDirection direction) {
  constexpr int kPlaces = 64;
  const auto at = [&](double guide, double ruling) {
    return direction == RulingDirection::kV ? surface.point(guide, ruling) : surface.point(ruling, guide);
  };
  double most = 0.0;
  for (int i = 0; i <= kPlaces; ++i) {
    const double g = static_cast<double>(i) / kPlaces;
    const Vec3 from = at(g, 0.0), way = at(g, 1.0) - from;
    for (int j = 1; j < kPlaces; ++j) {
      const Vec3 p = at(g, static_cast<double>(j) / kPlaces) - from;
      const double share =
          way.squaredNorm() > 0.0 ? std::clamp(p.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0.0;
      most = std::max(most, (p - share * way).norm());
    }
  }
  return most;
}

SurfacePtr ruled_between(const RuledPart& part) {
  return std::make_shared<RuledBetween>(part);
}

std::optional<std::array<Vec2, 2>> rectangle_of(const Face& face) {
  if (face.loops.empty()) return std::array<Vec2, 2>{Vec2::Zero(), Vec2::Ones()};
  if (face.loops.size() > 1) return std::nullopt;
  Vec2 low = face.loops[0][0], high = low;
  for (const Vec2& p : face.loops[0]) low = low.cwiseMin(p), high = high.cwiseMax(p);
  low = low.cwiseMax(Vec2::Zero());
  high = high.cwiseMin(Vec2::Ones());
  const Vec2 size = high - low;
  if (!(size.minCoeff() > 0.0)) return std::nullopt;
  // A loop that stays on the border of its box and goes round once encloses the box.
  constexpr double kOnBorder = 1e-6;
  double area = 0.0;
  for (size_t i = 0; i < face.loops[0].size(); ++i) {
    const Vec2 p = face.loops[0][i], q = face.loops[0][(i + 1) % face.loops[0].size()];
    area += 0.5 * (p.x() * q.y() - p.y() * q.x());
    const Vec2 near = ((p - low).cwiseAbs().cwiseMin((high - p).cwiseAbs())).cwiseQuotient(size);
    if (near.minCoeff() > kOnBorder) return std::nullopt;
  }
  if (std::abs(std::abs(area) / (size.x() * size.y()) - 1.0) > 4.0 * kOnBorder) return std::nullopt;
  return std::array<Vec2, 2>{low, high};
}

}  // namespace swarf::surface

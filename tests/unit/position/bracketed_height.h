// Where a tool comes to rest on curved sheets, between two bounds, by subdivision: an oracle that shares
// nothing with the position calculator.
//
// A place p asks for the height F(p) = z - w(rho) in coordinates about the tool's line. w is convex and never
// falls, so F is concave over the cylinder rho <= R: with a base b in it and a slope g of F there,
//   F(p) <= F(b) + g.(p - b)    for every p under the tool.
// A piece of a sheet over a rectangle du x dv lies within e = (du^2 max|Suu| + dv^2 max|Svv|) / 8 of the hull
// of its four corners c_k (bilinear interpolation), so nowhere in it F is above
//   F(b) + max_k g.(c_k - b) + |g| e.
// Pieces are halved, highest bound first; the places tried bound the height from below.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <queue>
#include <vector>

#include "brute_force.h"
#include "surface/face.h"

namespace swarf::position {

struct Sheet {
  std::function<Vec3(double, double)> at;  ///< W, mm, over the unit square
  double bend_u = 0.0, bend_v = 0.0;       ///< |Suu|, |Svv| at most, mm
  /// What of a rectangle belongs to the sheet; null: everything.
  std::function<surface::Region(const Vec2& low, const Vec2& high)> part = nullptr;
};

struct HeightBracket {
  double low = -std::numeric_limits<double>::infinity();  ///< of a place that was tried
  double high = low;                                      ///< proven
  int pieces = 0;
};

class BracketedHeight {
 public:
  BracketedHeight(const ClosedForm& tool, const GuideLine& line) : tool_(tool), line_(line) {}

  /// Until the bounds are `within` of each other, or too many pieces were taken.
  HeightBracket over(const std::vector<Sheet>& sheets, double within = 1e-6) {
    result_ = {};
    for (const Sheet& sheet : sheets) add({&sheet, Vec2::Zero(), Vec2::Ones(), 0.0});
    constexpr int kMost = 400'000;
    while (!pieces_.empty() && pieces_.top().bound > result_.low + within && result_.pieces < kMost) {
      const Piece piece = pieces_.top();
      pieces_.pop();
      halve(piece);
    }
    result_.high = std::max(result_.low, pieces_.empty() ? result_.low : pieces_.top().bound);
    return result_;
  }

 private:
  struct Piece {
    const Sheet* sheet;
    Vec2 low, high;
    double bound;
    bool operator<(const Piece& other) const { return bound < other.bound; }
  };

  Vec3 local(const Sheet& sheet, double u, double v) const {
    const Vec3 d = sheet.at(u, v) - line_.point_W;
    return {d.dot(line_.x_W), d.dot(line_.y_W), d.dot(line_.axis_W)};
  }
  double height_at(const Vec3& p) const {
    const double rho = p.head<2>().norm();
    return rho <= tool_.radius ? p.z() - tool_.height(rho) : -std::numeric_limits<double>::infinity();
  }
  void try_place(const Sheet& sheet, const Vec2& uv, const Vec3& p) {
    const double height = height_at(p);
    if (height > result_.low && (sheet.part == nullptr || sheet.part(uv, uv) == surface::Region::kInside))
      result_.low = height;
  }

  /// The bound from a base over the piece's middle, no farther from the axis than `most`.
  double bound_from(const std::array<Vec3, 4>& corners, const Vec3& middle, double most, double stray) const {
    Vec3 base = middle;
    const double out = base.head<2>().norm();
    if (out > most) base.head<2>() *= most / out;
    const double rho = std::min(out, most);
    Vec3 slope = Vec3::UnitZ();
    if (rho > 0.0) slope.head<2>() = -tool_.slope(rho) / rho * base.head<2>();
    double rise = -std::numeric_limits<double>::infinity();
    for (const Vec3& corner : corners) rise = std::max(rise, slope.dot(corner - base));
    return base.z() - tool_.height(rho) + rise + slope.norm() * stray;
  }

  void add(Piece piece) {
    const Sheet& sheet = *piece.sheet;
    if (sheet.part != nullptr && sheet.part(piece.low, piece.high) == surface::Region::kOutside) return;
    ++result_.pieces;
    const Vec2 &l = piece.low, &h = piece.high, centre = 0.5 * (l + h);
    const std::array<Vec2, 4> places{l, Vec2(h.x(), l.y()), h, Vec2(l.x(), h.y())};
    std::array<Vec3, 4> corners;
    Vec3 middle = Vec3::Zero();
    for (size_t k = 0; k < 4; ++k) {
      corners[k] = local(sheet, places[k].x(), places[k].y());
      middle += 0.25 * corners[k];
      try_place(sheet, places[k], corners[k]);
    }
    try_place(sheet, centre, local(sheet, centre.x(), centre.y()));
    double reach = 0.0;
    for (const Vec3& corner : corners) reach = std::max(reach, (corner - middle).norm());
    const Vec2 size = h - l;
    const double stray = 0.125 * (size.x() * size.x() * sheet.bend_u + size.y() * size.y() * sheet.bend_v);
    if (middle.head<2>().norm() - reach - stray > tool_.radius) return;
    // Near the rim of a ball the slope is steep: a base further in may tell more.
    piece.bound = std::min(bound_from(corners, middle, (1.0 - 1e-6) * tool_.radius, stray),
                           bound_from(corners, middle, 0.9 * tool_.radius, stray));
    if (piece.bound > result_.low) pieces_.push(piece);
  }

  void halve(const Piece& piece) {
    // Sheets may close: by the chord of a side and by how far its middle may leave it.
    const Vec3 origin = local(*piece.sheet, piece.low.x(), piece.low.y());
    const Vec2 size = piece.high - piece.low;
    const auto length = [&](const Vec3& end, double share, double bend) {
      return (end - origin).norm() + 0.125 * share * share * bend;
    };
    const bool along_u =
        length(local(*piece.sheet, piece.high.x(), piece.low.y()), size.x(), piece.sheet->bend_u) >=
        length(local(*piece.sheet, piece.low.x(), piece.high.y()), size.y(), piece.sheet->bend_v);
    const Eigen::Index k = along_u ? 0 : 1;
    const double middle = 0.5 * (piece.low[k] + piece.high[k]);
    Piece first = piece, second = piece;
    first.high[k] = second.low[k] = middle;
    add(first);
    add(second);
  }

  const ClosedForm& tool_;
  GuideLine line_;
  HeightBracket result_;
  std::priority_queue<Piece> pieces_;
};

}  // namespace swarf::position

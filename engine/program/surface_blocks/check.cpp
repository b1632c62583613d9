#include "program/surface_blocks/check.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace swarf::program {
namespace {

constexpr int kCellsPerDegree = 8;
constexpr int kMinCells = 32;
constexpr int kMaxCells = 128;  ///< keeps the check of degree 99 near a second
constexpr double kSuspectShare =
    0.1;  ///< local minima above this share of the largest |Su x Sv| are not searched
constexpr double kLastStep = 1e-12;  ///< of the compass search, in parameters

Vec3 cross_at(const surface::PolynomialSurface& surface, double u, double v) {
  const auto d = surface.derivatives(u, v);
  return d.Su.cross(d.Sv);
}

struct Grid {
  int cells_u = 0, cells_v = 0;
  std::vector<Vec3> cross;  ///< Su x Sv
  double scale = 0.0;       ///< max|Su| max|Sv|
  double largest = 0.0;     ///< max|Su x Sv|

  double u(int i) const { return static_cast<double>(i) / cells_u; }
  double v(int j) const { return static_cast<double>(j) / cells_v; }
  bool inside(int i, int j) const { return i >= 0 && j >= 0 && i <= cells_u && j <= cells_v; }
  const Vec3& at(int i, int j) const { return cross[static_cast<size_t>(i) * (cells_v + 1) + j]; }
};

/// Fills the grid; the place of the first derivative that is not finite, if any.
std::optional<WeakSpot> sample(const surface::PolynomialSurface& surface, Grid& grid) {
  double longest_u = 0.0;
  double longest_v = 0.0;
  for (int i = 0; i <= grid.cells_u; ++i) {
    for (int j = 0; j <= grid.cells_v; ++j) {
      const auto d = surface.derivatives(grid.u(i), grid.v(j));
      const Vec3 cross = d.Su.cross(d.Sv);
      const double area = cross.norm();
      const bool finite = std::isfinite(area) && d.S.allFinite() && d.Suu.allFinite() && d.Suv.allFinite() &&
                          d.Svv.allFinite();
      if (!finite) return WeakSpot{grid.u(i), grid.v(j), false};
      grid.cross.push_back(cross);
      longest_u = std::max(longest_u, d.Su.norm());
      longest_v = std::max(longest_v, d.Sv.norm());
      grid.largest = std::max(grid.largest, area);
    }
  }
  grid.scale = longest_u * longest_v;
  return std::nullopt;
}

bool is_local_minimum(const Grid& grid, int i, int j) {
  const double here = grid.at(i, j).squaredNorm();
  for (int di = -1; di <= 1; ++di) {
    for (int dj = -1; dj <= 1; ++dj) {
      if (grid.inside(i + di, j + dj) && grid.at(i + di, j + dj).squaredNorm() < here) return false;
    }
  }
  return true;
}

bool folds_towards(const Grid& grid, int i, int j, int di, int dj) {
  return grid.inside(i + di, j + dj) && grid.at(i, j).dot(grid.at(i + di, j + dj)) < 0.0;
}

bool is_suspect(const Grid& grid, int i, int j) {
  if (folds_towards(grid, i, j, 1, 0) || folds_towards(grid, i, j, 0, 1)) return true;
  return grid.at(i, j).norm() < kSuspectShare * grid.largest && is_local_minimum(grid, i, j);
}

/// Compass search for the smallest |Su x Sv| near (u,v) inside the unit square.
std::pair<WeakSpot, double> search_from(const surface::PolynomialSurface& surface, double u, double v,
                                        double step) {
  WeakSpot best{u, v, true};
  double smallest = cross_at(surface, u, v).norm();
  for (; step > kLastStep && smallest > 0.0;) {
    const WeakSpot centre = best;
    for (int di = -1; di <= 1; ++di) {
      for (int dj = -1; dj <= 1; ++dj) {
        const WeakSpot trial{std::clamp(centre.u + di * step, 0.0, 1.0),
                             std::clamp(centre.v + dj * step, 0.0, 1.0), true};
        const double area = cross_at(surface, trial.u, trial.v).norm();
        if (area < smallest) {
          smallest = area;
          best = trial;
        }
      }
    }
    if (best.u == centre.u && best.v == centre.v) step *= 0.5;
  }
  return {best, smallest};
}

/// De Casteljau's point of one row or column: `count` points, `stride` apart.
Vec3 de_casteljau(std::vector<Vec3> points, double t) {
  for (size_t n = points.size(); n > 1; --n) {
    for (size_t i = 0; i + 1 < n; ++i) points[i] = (1.0 - t) * points[i] + t * points[i + 1];
  }
  return points.front();
}

}  // namespace

std::optional<WeakSpot> find_degenerate_point(const surface::PolynomialSurface& surface) {
  Grid grid;
  grid.cells_u = std::clamp(kCellsPerDegree * surface.degree_u(), kMinCells, kMaxCells);
  grid.cells_v = std::clamp(kCellsPerDegree * surface.degree_v(), kMinCells, kMaxCells);
  if (const auto overflow = sample(surface, grid)) return overflow;
  const double limit = kDegenerateShare * grid.scale;
  // A surface squeezed into a line has no regular point to start from.
  if (grid.largest <= limit) return WeakSpot{0.0, 0.0, true};
  const double step = std::max(1.0 / grid.cells_u, 1.0 / grid.cells_v);
  for (int i = 0; i <= grid.cells_u; ++i) {
    for (int j = 0; j <= grid.cells_v; ++j) {
      if (!is_suspect(grid, i, j)) continue;
      const auto [spot, area] = search_from(surface, grid.u(i), grid.v(j), step);
      if (area <= limit) return spot;
    }
  }
  return std::nullopt;
}

double bezier_conversion_error(const surface::PolynomialSurface& surface,
                               const std::vector<Vec3>& control_points) {
  constexpr int kCells = 8;
  const auto row_length = std::ptrdiff_t{surface.degree_v()} + 1;
  double worst = 0.0;
  for (int a = 0; a <= kCells; ++a) {
    for (int b = 0; b <= kCells; ++b) {
      const double u = static_cast<double>(a) / kCells;
      const double v = static_cast<double>(b) / kCells;
      std::vector<Vec3> column;
      for (auto row = control_points.begin(); row != control_points.end(); row += row_length) {
        column.push_back(de_casteljau({row, row + row_length}, v));
      }
      worst = std::max(worst, (surface.point(u, v) - de_casteljau(std::move(column), u)).norm());
    }
  }
  return worst;
}

}  // namespace swarf::program

// Closed plates with bores, counterbores, countersinks and pockets of n facets.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "support/solids.h"

namespace swarf::test {

/// Round about the middle of a cell of the plate: radius and depth, from the top down. It goes through where
/// the last depth is the plate's bottom, else it ends in a flat floor. `facets`: a multiple of 4.
struct Bore {
  int facets = 4;
  std::vector<std::pair<double, double>> profile;  ///< radius, z
};

class BoredPlate {
 public:
  BoredPlate(std::vector<double> x, std::vector<double> y, double bottom, double top)
      : x_(std::move(x)), y_(std::move(y)), bottom_(bottom), top_(top) {}

  TriMesh mesh(const std::map<std::pair<int, int>, Bore>& bores) {
    mesh_ = {};
    const int nx = static_cast<int>(x_.size()) - 1, ny = static_cast<int>(y_.size()) - 1;
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        const auto bore = bores.find({i, j});
        if (bore != bores.end()) {
          add_bore(i, j, bore->second);
        } else {
          add_cell(i, j, top_);
          add_cell(i, j, bottom_);
        }
      }
    }
    for (int j = 0; j < ny; ++j) {
      add_wall({x_[0], y_[j + 1]}, {x_[0], y_[j]});
      add_wall({x_[nx], y_[j]}, {x_[nx], y_[j + 1]});
    }
    for (int i = 0; i < nx; ++i) {
      add_wall({x_[i], y_[0]}, {x_[i + 1], y_[0]});
      add_wall({x_[i + 1], y_[ny]}, {x_[i], y_[ny]});
    }
    return std::move(mesh_);
  }

 private:
  std::array<Vec3, 4> corners(int i, int j, double z) const {
    return {Vec3(x_[i + 1], y_[j + 1], z), Vec3(x_[i], y_[j + 1], z), Vec3(x_[i], y_[j], z),
            Vec3(x_[i + 1], y_[j], z)};
  }
  void add_facet(const Vec3& a, const Vec3& b, const Vec3& c, bool up) {
    add_triangle(mesh_, a, up ? b : c, up ? c : b);
  }
  void add_cell(int i, int j, double z) {
    const auto c = corners(i, j, z);
    add_facet(c[0], c[1], c[2], z == top_);
    add_facet(c[0], c[2], c[3], z == top_);
  }
  void add_wall(const std::pair<double, double>& from, const std::pair<double, double>& to) {
    add_quad(mesh_, {from.first, from.second, bottom_}, {to.first, to.second, bottom_},
             {to.first, to.second, top_}, {from.first, from.second, top_});
  }
  void add_bore(int i, int j, const Bore& bore) {
    // To 0.1 mm: a side that is a little off moves no bore.
    const auto middle = [](double a, double b) { return 0.1 * std::round(5.0 * (a + b)); };
    const double cx = middle(x_[i], x_[i + 1]), cy = middle(y_[j], y_[j + 1]);
    const auto at = [&](double r, int k, double z) {
      const double angle = 2.0 * M_PI * (k % bore.facets) / bore.facets;
      return Vec3(cx + r * std::cos(angle), cy + r * std::sin(angle), z);
    };
    const auto ring = [&](double r, double z) {
      const auto c = corners(i, j, z);
      const int quarter = bore.facets / 4;
      for (int q = 0; q < 4; ++q) {
        for (int k = q * quarter; k < (q + 1) * quarter; ++k)
          add_facet(at(r, k, z), c[q], at(r, k + 1, z), z == top_);
        add_facet(at(r, (q + 1) * quarter, z), c[q], c[(q + 1) % 4], z == top_);
      }
    };
    double r = bore.profile.front().first, z = top_;
    ring(r, z);
    for (const auto& [next_r, next_z] : bore.profile) {
      for (int k = 0; k < bore.facets && (next_r != r || next_z != z); ++k)
        add_quad(mesh_, at(r, k, z), at(r, k + 1, z), at(next_r, k + 1, next_z), at(next_r, k, next_z));
      r = next_r;
      z = next_z;
    }
    if (z == bottom_) {
      ring(r, z);
      return;
    }
    for (int k = 0; k < bore.facets; ++k) add_triangle(mesh_, {cx, cy, z}, at(r, k, z), at(r, k + 1, z));
    add_cell(i, j, bottom_);
  }

  std::vector<double> x_, y_;
  double bottom_, top_;
  TriMesh mesh_;
};

/// 100 x 70 x 20 mm: four bores of 6.8, a counterbore, a countersink and a round pocket.
struct OrdinaryPlate {
  int facets = 128;
  double right = 50.0, floor = -8.0, pocket_radius = 8.0;
  bool all_bores = true;

  TriMesh mesh() const {
    std::map<std::pair<int, int>, Bore> bores;
    for (const auto& cell : {std::pair{0, 0}, {3, 0}, {0, 2}}) bores[cell] = {facets, {{3.4, -20.0}}};
    if (all_bores) bores[{3, 2}] = {facets, {{3.4, -20.0}}};
    bores[{1, 1}] = {facets, {{8.0, -5.0}, {4.5, -5.0}, {4.5, -20.0}}};
    bores[{2, 1}] = {facets, {{pocket_radius, floor}}};
    bores[{2, 2}] = {facets, {{6.0, 0.0}, {3.0, -3.0}, {3.0, -20.0}}};
    return BoredPlate({-50, -25, 0, 25, right}, {-35, -10, 10, 35}, -20.0, 0.0).mesh(bores);
  }
};

inline TriMesh shifted(TriMesh mesh, const Vec3& by) {
  for (auto& p : mesh.positions) {
    for (size_t k = 0; k < 3; ++k) p[k] = static_cast<float>(p[k] + by[static_cast<int>(k)]);
  }
  return mesh;
}

}  // namespace swarf::test

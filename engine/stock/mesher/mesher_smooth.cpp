#include <algorithm>
#include <bit>
#include <cmath>

#include "stock/mesher/mesher_vertex.h"

namespace swarf::stock {
namespace {

/// A second difference in voxels: a sheet of radius r gives at most 1 / r, two sheets whose normals differ by
/// D at least |D| / sqrt(12) at one end of the grid edge that their border crosses.
constexpr float kKink = 0.12F;
/// Slopes of a sheet are 1; below this square the interpolation says nothing about direction.
constexpr float kLeastSlope2 = 0.25F;

/// Where an edge's lower end lies, and along which axis it runs.
struct EdgePlace {
  std::array<float, 3> start;
  int low, high, axis;
};

std::array<EdgePlace, kCellEdges> edge_places() {
  std::array<EdgePlace, kCellEdges> places;
  for (int e = 0; e < kCellEdges; ++e) {
    const int low = edge_corner(e), axis = e / 4;
    places[e] = {
        {static_cast<float>(low >> 2 & 1), static_cast<float>(low >> 1 & 1), static_cast<float>(low & 1)},
        low,
        low + corner_step(axis),
        axis};
  }
  return places;
}

const std::array<EdgePlace, kCellEdges> kEdges = edge_places();

}  // namespace

CellSample::CellSample(const float* corner) {
  for (int c = 0; c < 8; ++c) {
    const float* at =
        corner + (c >> 2) * ValueBlock::kStrides[0] + (c >> 1 & 1) * ValueBlock::kStrides[1] + (c & 1);
    value[c] = *at;
    for (int axis = 0; axis < 3; ++axis) {
      const float after = at[ValueBlock::kStrides[axis]], before = at[-ValueBlock::kStrides[axis]];
      slope[axis][c] = 0.5F * (after - before);
      bend[axis][c] = after + before - 2.0F * *at;
    }
  }
}

bool CellSample::kinked() const {
  float most = 0.0F;
  for (const auto& along : bend) {
    for (const float b : along) most = std::max(most, std::abs(b));
  }
  return most > kKink;
}

float CellSample::crossing(int edge) const {
  const float low = value[kEdges[edge].low], high = value[kEdges[edge].high];
  return low / (low - high);
}

CellVertex CellSample::vertex(uint16_t edges) const {
  std::array<float, 3> x{};
  for (unsigned rest = edges; rest != 0; rest &= rest - 1) {
    const int e = std::countr_zero(rest);
    const EdgePlace& edge = kEdges[e];
    for (int axis = 0; axis < 3; ++axis) x[axis] += edge.start[axis];
    x[edge.axis] += crossing(e);
  }
  const float share = 1.0F / static_cast<float>(std::popcount(edges));
  for (float& coordinate : x) coordinate *= share;

  alignas(32) std::array<float, 8> weight;
  for (int c = 0; c < 8; ++c) {
    weight[c] = ((c & 4) != 0 ? x[0] : 1.0F - x[0]) * ((c & 2) != 0 ? x[1] : 1.0F - x[1]) *
                ((c & 1) != 0 ? x[2] : 1.0F - x[2]);
  }
  const auto mean = [&](const std::array<float, 8>& at) {
    float sum = 0.0F;
    for (int c = 0; c < 8; ++c) sum += weight[c] * at[c];
    return sum;
  };
  float value_here = mean(value), slope2 = 0.0F;
  std::array<float, 3> g;
  for (int axis = 0; axis < 3; ++axis) {
    g[axis] = mean(slope[axis]);
    slope2 += g[axis] * g[axis];
    // What linear interpolation leaves out of a parabola.
    value_here -= 0.5F * x[axis] * (1.0F - x[axis]) * mean(bend[axis]);
  }
  CellVertex vertex;
  vertex.place = {x[0], x[1], x[2]};
  if (slope2 < kLeastSlope2) {
    vertex.normal = slope2 > 0.0F ? Eigen::Vector3f(g[0], g[1], g[2]).normalized() : Eigen::Vector3f::UnitZ();
    return vertex;
  }
  vertex.normal = Eigen::Vector3f(g[0], g[1], g[2]) / std::sqrt(slope2);
  vertex.place -= value_here / slope2 * Eigen::Vector3f(g[0], g[1], g[2]);
  return vertex;
}

}  // namespace swarf::stock

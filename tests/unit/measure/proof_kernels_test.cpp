// What the proof asks of many sweeps, or of three columns, at once: against one sweep, one column at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "measure/bottom_planes.h"
#include "measure/column_lanes.h"
#include "measure/height_bounds.h"
#include "unit/cutter/shapes.h"
#include "unit/measure/dome_cut.h"
#include "unit/stock/stock_test_support.h"

namespace swarf::measure {
namespace {

using cutter::Shape;
using cutter::test::of_shape;

std::vector<stock::CutterSolid> cutters() {
  return {stock::CutterSolid(5.0, 25.0), stock::CutterSolid(of_shape(Shape::kBullNose, 10.0, 1.0, 25.0)),
          stock::CutterSolid(of_shape(Shape::kBall, 10.0, 5.0, 25.0)),
          stock::CutterSolid(cutter::test::taper(4.0, 1.0, 5.0, 25.0))};
}

/// A cell of the dome, or a flat one.
DesignCell cell_of(Rng& rng, double size_mm, bool is_flat) {
  const surface::SurfacePtr design = dome();
  PatchBounds bounds;
  const Vec2 uv(rng.uniform(0.1, 0.8), rng.uniform(0.1, 0.8));
  const double part = size_mm / 100.0;
  const auto corner = [&](double u, double v) {
    const surface::Derivatives d = design->derivatives(uv.x() + u * part, uv.y() + v * part);
    return CellCorner{d.S, surface::outward_normal(*design, d, uv), uv + part * Vec2(u, v)};
  };
  std::array<CellCorner, 3> corners{corner(0.0, 0.0), corner(1.0, 0.1), corner(0.2, 1.0)};
  if (is_flat) {
    for (CellCorner& one : corners) one.normal = corners[0].normal;
    return make_cell(corners, bounds);
  }
  bounds.surface = design;
  bounds.bends = design->bend_bounds(uv, uv + Vec2(part, part));
  bounds.turn_u = bounds.turn_v = 3.0;
  return make_cell(corners, bounds);
}

/// A sweep that passes near the cell, its axis within some degrees of the cell's normal.
stock::Sweep sweep_at(Rng& rng, const DesignCell& cell, double lean) {
  const auto pose = [&](const Vec3& aside, const Vec3& turn) {
    return ToolPose{cell.centroid() + aside, (cell.mean_normal() + turn).normalized()};
  };
  const Vec3 aside = rng.uniform(0.0, 4.0) * rng.direction(), turn = lean * rng.direction();
  const bool turns = rng.uniform() < 0.7;
  return {pose(aside, turn),
          pose(aside + 0.2 * rng.direction(), turns ? Vec3(turn + 0.01 * rng.direction()) : turn), 0};
}

NearSweep near_of(const stock::Sweep& sweep, const stock::CutterSolid& cutter) {
  return {stock::sweep_map(sweep), &cutter, 0, sweep.start.axis_W != sweep.end.axis_W};
}

/// Some sweeps about a cell, with each of the cutters in turn, and their planes.
struct About {
  std::vector<stock::CutterSolid> tools = cutters();
  std::vector<stock::Sweep> sweeps;
  std::vector<int> tool_of;
  BottomPlanes planes;

  About(Rng& rng, const DesignCell& cell, size_t count, double lean) {
    std::vector<uint32_t> numbers;
    for (size_t k = 0; k < count; ++k) {
      numbers.push_back(static_cast<uint32_t>(k));
      sweeps.push_back(sweep_at(rng, cell, lean));
      tool_of.push_back(static_cast<int>(k % tools.size()));
    }
    planes.add(numbers, sweeps, SweepCutters(tools, tool_of));
  }
  NearSweep near(size_t k) const { return near_of(sweeps[k], tools[k % tools.size()]); }
};

TEST(BottomPlanes, TellWhatOneSweepAfterTheOtherTells) {
  Rng rng(20260);
  constexpr size_t kSweeps = 61;  // no multiple of what a processor takes at once
  size_t told = 0, above = 0;
  for (int n = 0; n < 200; ++n) {
    const DesignCell cell = cell_of(rng, n % 2 == 0 ? 1.0 : 0.05, n % 3 == 0);
    const double depth = rng.uniform(0.05, 4.0), enough = rng.uniform(-0.1, 0.1);
    const ColumnDepths depths{{depth, depth, depth}, {}};
    const About about(rng, cell, kSweeps, n % 5 == 0 ? 1.5 : 0.1);
    std::vector<double> heights, columns;
    cell_heights(cell, depths, about.planes.from(0), kSweeps, heights);
    column_heights(cell.corners[0], about.planes.from(0), kSweeps, columns);
    for (size_t k = 0; k < kSweeps; ++k) {
      if (heights[k] > enough) {
        ++told;
        ASSERT_EQ(heights[k], least_height(cell, about.near(k), depths, enough)) << n << ", " << k;
      }
      if (columns[k] >= depth + kPlaneSlack) {
        ++above;
        ASSERT_TRUE(stays_above(cell.corners[0], about.near(k), depth)) << n << ", " << k;
      }
    }
  }
  EXPECT_GT(told, 1000u);
  EXPECT_GT(above, 1000u);
}

TEST(BottomPlanes, TellNothingOfACellWhoseColumnsTurnWithoutBound) {
  Rng rng(20264);
  DesignCell cell = cell_of(rng, 1.0, false);
  const About about(rng, cell, 9, 0.1);
  cell.turn = kNever;  // beside a pole of its surface
  std::vector<double> heights;
  cell_heights(cell, {{1.0, 1.0, 1.0}, {}}, about.planes.from(0), 9, heights);
  for (size_t k = 0; k < 9; ++k) EXPECT_EQ(heights[k], kUntold);
}

TEST(BottomPlanes, RepeatedOnTheStackTellTheSame) {
  Rng rng(20261);
  const DesignCell cell = cell_of(rng, 1.0, false);
  BottomPlanes planes = About(rng, cell, 20, 0.1).planes;
  std::vector<double> all, some;
  column_heights(cell.corners[1], planes.from(0), 20, all);
  const std::vector<uint32_t> places{1, 2, 7, 18, 19};
  planes.repeat(places);
  column_heights(cell.corners[1], planes.from(20), places.size(), some);
  for (size_t k = 0; k < places.size(); ++k) EXPECT_EQ(some[k], all[places[k]]);
}

TEST(BottomPlanes, EveryInstructionSetGivesTheSameBits) {
  Rng rng(20262);
  for (int n = 0; n < 100; ++n) {
    const DesignCell cell = cell_of(rng, 0.5, n % 2 == 0);
    constexpr size_t kSweeps = 19;
    const BottomPlanes planes = About(rng, cell, kSweeps, n % 5 == 0 ? 1.5 : 0.1).planes;
    const PlainCell plain = plain_cell(cell, {{2.0, 1.0, 2.0}, {}});
    const Vec3 &p = cell.corners[2].point, &q = cell.corners[2].normal;
    const double point[3] = {p.x(), p.y(), p.z()}, normal[3] = {q.x(), q.y(), q.z()};
    std::array<std::vector<double>, 2> first, one;
    for (const BottomPlaneVariant& variant : bottom_plane_variants()) {
      for (std::vector<double>& heights : one) heights.assign(kSweeps + BottomPlanes::kMostLanes, 0.0);
      variant.over_cell(planes.from(0), kSweeps, plain, one[0].data());
      variant.over_column(planes.from(0), kSweeps, point, normal, one[1].data());
      for (std::vector<double>& heights : one) heights.resize(kSweeps);
      if (first[0].empty()) first = one;
      EXPECT_EQ(first, one) << variant.instruction_set;
    }
  }
}

/// F of a piece along a column, and how far within it the column must lie.
struct Column {
  const cutter::ConvexPiece& piece;
  Vec3 P, N;
  ColumnMargin margin;

  double excess(double s) const {
    const Vec3 X = P + s * N;
    return cutter::signed_distance(piece, X.head<2>().norm(), X.z()) + margin.aside + margin.stray +
           std::abs(s) * margin.turn - kTouch;
  }
};

TEST(ColumnLanes, EnterThePieceWhereEachColumnDoes) {
  Rng rng(20263);
  size_t entered = 0, never = 0;
  for (const stock::CutterSolid& cutter : cutters()) {
    for (int n = 0; n < 300; ++n) {
      const DesignCell cell = cell_of(rng, 1.0, false);
      const NearSweep near = near_of(sweep_at(rng, cell, 0.3), cutter);
      const cutter::ConvexPiece& piece = cutter.pieces.front();
      const ColumnNumbers instants{{rng.uniform(), 0.0, 1.0, 0.0}}, from{{-3.0, -2.0, -1.0, -3.0}},
          tops{{5.0, 0.0, -std::numeric_limits<double>::infinity(), 5.0}};
      const ColumnMargin margin{1e-3 * rng.uniform(), 1e-3 * rng.uniform(), 1e-2 * rng.uniform()};
      ColumnNumbers heights{};
      bool is_first = true;
      for (const ColumnLanesVariant& variant : column_lanes_variants()) {
        ColumnLanes lanes;
        ColumnNumbers found;
        variant.columns_of(near.map, cell.corners, lanes);
        variant.covered(piece, lanes, instants, from, tops, margin, found);
        if (is_first) heights = found;
        is_first = false;
        EXPECT_EQ(std::memcmp(&heights, &found, 3 * sizeof(double)), 0) << variant.instruction_set;
      }
      for (size_t k = 0; k < 3; ++k) {
        const Vec3 &p = cell.corners[k].point, &normal = cell.corners[k].normal;
        const double t = instants[k];
        const Column column{piece, (1.0 - t) * near.map.start(p) + t * near.map.end(p),
                            (1.0 - t) * (near.map.R0t * normal) + t * (near.map.R1t * normal), margin};
        if (heights[k] == kNever) {
          ++never;
          // Above `top`, or nowhere on a way of some millimetres.
          const bool is_left = tops[k] > from[k] && column.excess(tops[k]) > 0.0;
          for (double s = from[k]; s < 8.0 && !is_left; s += 0.05) ASSERT_GT(column.excess(s), -1e-9);
          continue;
        }
        ++entered;
        ASSERT_LE(column.excess(heights[k]), 1e-12);
        if (heights[k] > from[k]) {
          ASSERT_GT(column.excess(heights[k] - 1e-6), 0.0);
        }
      }
    }
  }
  EXPECT_GT(entered, 500u);
  EXPECT_GT(never, 500u);
}

}  // namespace
}  // namespace swarf::measure

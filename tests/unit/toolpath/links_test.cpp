// Free moves: continuous, from clearance to clearance, and clear of the part.
#include "toolpath/links.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dome.h"

namespace swarf::toolpath::links_test {
namespace {

using program::StartBoundary;

ToolPath planned(bool zigzag, Planner planner = Planner::kConstantScallop, double lead = 0.0) {
  program::Program program = test::area_program(test::dome(), StartBoundary::kV0, 0.05);
  program.operations[0].zigzag = zigzag;
  program.operations[0].lead_rad = lead;
  program.operations.push_back(program.operations[0]);
  program.operations[1].start = StartBoundary::kU1;
  Diagnostics diagnostics;
  ToolPath path = plan(program, cutter::Cutter{}, test::options_for(planner), diagnostics);
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << format(d);
  return path;
}

PassEnds ends(const Element& element) {
  if (const auto* pass = std::get_if<SurfacePass>(&element.what)) return ends_of(*pass, {5.0});
  const auto& move = std::get<FreeMove>(element.what);
  return {move.from, move.to};
}

double gap(const ToolPose& a, const ToolPose& b) {
  return (a.tip_W - b.tip_W).norm() + (a.axis_W - b.axis_W).norm();
}

TEST(Links, EveryElementBeginsWhereTheOneBeforeEnds) {
  for (const bool zigzag : {true, false}) {
    for (const double lead : {0.0, 0.1}) {
      const ToolPath path = planned(zigzag, Planner::kConstantScallop, lead);
      double links = 0.0;
      for (size_t i = 0; i < path.elements.size(); ++i) {
        if (i > 0) {
          EXPECT_LT(gap(ends(path.elements[i - 1]).end, ends(path.elements[i]).start), 1e-9) << i;
        }
        const Element element = path.elements[i];
        const auto* move = std::get_if<FreeMove>(&element.what);
        if (move != nullptr) links += (move->to.tip_W - move->from.tip_W).norm();
      }
      EXPECT_NEAR(path.link_length_mm, links, 1e-9);
    }
  }
}

TEST(Links, BeginsAndEndsAtTheClearanceHeight) {
  const ToolPath path = planned(true);
  const auto first = std::get<FreeMove>(path.elements[0].what);
  const auto last = std::get<FreeMove>(path.elements.back().what);
  EXPECT_EQ(first.kind, MoveKind::kRapid);
  EXPECT_DOUBLE_EQ(first.from.tip_W.z(), 65.0);
  EXPECT_DOUBLE_EQ(last.to.tip_W.z(), 65.0);
  // The way through raw material, below the top of the stock at 45 mm, is made at approach feed.
  const auto approach = std::get<FreeMove>(path.elements[1].what);
  EXPECT_EQ(approach.kind, MoveKind::kApproach);
  EXPECT_GE(approach.from.tip_W.z(), 45.0);
  EXPECT_DOUBLE_EQ(approach.feed_mm_s, 25.0);
}

TEST(Links, ZigzagReversesEveryOtherPassAndOneWayNone) {
  for (const bool zigzag : {true, false}) {
    for (const SurfacePass& pass : test::passes_of(planned(zigzag)))
      EXPECT_EQ(pass.t_end > pass.t_start, !zigzag || pass.pass % 2 == 0);
  }
}

TEST(Links, RetractAndApproachAlongTheToolAxis) {
  for (const Element& element : planned(false).elements) {
    const auto* move = std::get_if<FreeMove>(&element.what);
    if (move == nullptr || move->kind == MoveKind::kRapid) continue;
    const double sign = move->kind == MoveKind::kRetract ? 1.0 : -1.0;
    const Vec3 way = move->to.tip_W - move->from.tip_W;
    EXPECT_GE(way.norm(), 5.0 - 1e-9);
    EXPECT_NEAR(way.normalized().dot(move->from.axis_W), sign, 1e-12);
    EXPECT_EQ(move->from.axis_W, move->to.axis_W);
  }
}

/// Signed distance bound: the convex part lies below each of its tangent planes, so a flat bottom all above
/// one of them is outside. Returns how far, for the best plane.
double outside_by(const ToolPose& pose, const surface::Surface& surface) {
  double best = -1e9;
  // Planes of the continuation support the part as well: the whole paraboloid is convex.
  for (int i = -4; i <= 44; ++i) {
    for (int j = -4; j <= 44; ++j) {
      const surface::Derivatives d = surface.derivatives(i / 40.0, j / 40.0);
      const Vec3 n = surface::outward_normal(surface, d);
      const double rim = 5.0 * n.cross(pose.axis_W).norm();
      best = std::max(best, (pose.tip_W - d.S).dot(n) - rim);
    }
  }
  return best;
}

TEST(Links, NoRapidTouchesThePart) {
  for (const bool zigzag : {true, false}) {
    const ToolPath path = planned(zigzag);
    const surface::SurfacePtr dome = test::dome();
    for (size_t k = 0; k < path.elements.size(); k += zigzag ? 1 : 3) {
      const Element element = path.elements[k];
      const auto* move = std::get_if<FreeMove>(&element.what);
      if (move == nullptr || move->kind != MoveKind::kRapid) continue;
      const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(move->from.axis_W, move->to.axis_W);
      for (int i = 0; i <= 20; ++i) {
        const double x = i / 20.0;
        const ToolPose pose{move->from.tip_W + x * (move->to.tip_W - move->from.tip_W),
                            Eigen::Quaterniond::Identity().slerp(x, turn) * move->from.axis_W};
        EXPECT_GT(outside_by(pose, *dome), 0.0) << "element " << k << " at " << x;
      }
    }
  }
}

TEST(Links, AStraightWayThroughTheDomeIsNotClear) {
  const surface::SurfacePtr dome = test::dome();
  const Obstacle obstacle = obstacle_of(*dome, 2.5);
  const cutter::Cutter cutter;
  const ToolPose left{{-60, 0, 12}, Vec3::UnitZ()};
  const ToolPose right{{60, 0, 12}, Vec3::UnitZ()};
  EXPECT_FALSE(move_is_clear(left, right, obstacle, cutter, 2.5));
  // The apex stands at 35 mm: over it with 2.5 mm to spare, and not with less.
  const ToolPose up_left{{-60, 0, 37.6}, Vec3::UnitZ()};
  const ToolPose up_right{{60, 0, 37.6}, Vec3::UnitZ()};
  EXPECT_TRUE(move_is_clear(up_left, up_right, obstacle, cutter, 2.5));
  EXPECT_FALSE(move_is_clear(up_left, up_right, obstacle, cutter, 2.8));
}

}  // namespace
}  // namespace swarf::toolpath::links_test

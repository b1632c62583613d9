// Milling cycles of the 840D: what is left of a block after them, by closed forms. The tool's way is cut into
// points and rasterised nowhere: areas come from the union of the ways, measured along lines across them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/angles.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens {
namespace {

constexpr double kRadius = 5.0;  // of T1

ControlSetup mill_setup(std::optional<SlotEnds> ends = {}) {
  ControlSetup setup = setup_of(spinner());
  setup.slot_ends = ends;
  return setup;
}

Ran mill(const std::string& cycle, std::optional<SlotEnds> ends = {}) {
  return run_text("G17 G90 G54 G94\nT1 M6\nS2000 M3 F700\nG0 X0 Y0 Z50\n" + cycle + "\nG0 Z60\nM30\n",
                  mill_setup(ends));
}

Ran mill_clean(const std::string& cycle, std::optional<SlotEnds> ends = {}) {
  Ran ran = mill(cycle, ends);
  EXPECT_FALSE(ran.diagnostics.has_errors()) << all_text(ran.diagnostics) << cycle;
  return ran;
}

/// A feed move's piece in the plane at one height.
struct Way {
  Vec2 from, to, centre;
  double turn = 0.0;  ///< swept angle, counter-clockwise above 0; 0: straight
  double low = 0.0;
};

/// Counter-clockwise about +z above 0; a whole turn where both ends are one.
double swept_of(const NcMove& move) {
  const Vec2 a = (move.from.tip_W - move.arc->centre_W).head<2>(),
             b = (move.to.tip_W - move.arc->centre_W).head<2>();
  const double sense = move.arc->normal_W.z() > 0.0 ? 1.0 : -1.0;
  double angle = sense * std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  if (angle < 1e-9) angle += 2.0 * kPi;
  return sense * angle;
}

std::vector<Way> ways(const Ran& ran) {
  std::vector<Way> all;
  for (const NcMove& move : ran.moves) {
    if (move.rapid) continue;
    Way way{move.from.tip_W.head<2>(), move.to.tip_W.head<2>(), Vec2::Zero(), 0.0,
            std::min(move.from.tip_W.z(), move.to.tip_W.z())};
    if (move.arc) {
      way.centre = move.arc->centre_W.head<2>();
      way.turn = swept_of(move);
    }
    all.push_back(way);
  }
  return all;
}

/// Distance from a point to a piece.
double distance(const Way& way, const Vec2& p) {
  const double ends = std::min((p - way.from).norm(), (p - way.to).norm());
  if (way.turn == 0.0) {
    const Vec2 d = way.to - way.from;
    if (d.squaredNorm() == 0.0) return ends;
    const double t = std::clamp((p - way.from).dot(d) / d.squaredNorm(), 0.0, 1.0);
    return (p - way.from - t * d).norm();
  }
  const Vec2 a = way.from - way.centre, b = p - way.centre;
  double angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  if (way.turn < 0.0) angle = -angle;
  if (angle < 0.0) angle += 2.0 * kPi;
  return angle <= std::abs(way.turn) + 1e-12 ? std::abs(b.norm() - a.norm()) : ends;
}

/// Signed: below 0 where the tool's edge has passed at `height` or below.
double cleared(const std::vector<Way>& all, const Vec2& p, double height) {
  double nearest = 1e9;
  for (const Way& way : all) {
    if (way.low <= height + 1e-9) nearest = std::min(nearest, distance(way, p));
  }
  return nearest - kRadius;
}

using Region = std::function<double(const Vec2&)>;  ///< signed distance, below 0 inside

double box_distance(const Vec2& p, double half_x, double half_y, double corner) {
  const Vec2 q = p.cwiseAbs() - Vec2(half_x - corner, half_y - corner);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - corner;
}

/// The cut at `height` is the region: nowhere beyond it, everywhere within it, the border to `tolerance`.
void expect_region(const Ran& ran, const Region& region, double height, double reach) {
  const std::vector<Way> all = ways(ran);
  ASSERT_FALSE(all.empty());
  int inside = 0;
  for (double x = -reach; x <= reach; x += 0.37) {
    for (double y = -reach; y <= reach; y += 0.41) {
      const double want = region({x, y}), have = cleared(all, {x, y}, height);
      if (want < -1e-9) {
        ++inside;
        EXPECT_LE(have, 1e-9) << "material is left at " << x << ", " << y << ", " << -want << " mm within";
      } else if (want > 1e-9) {
        // Outside the distance to the cut is the distance to the region: the border agrees to the last
        // digits.
        EXPECT_NEAR(have, want, 1e-9) << "at " << x << ", " << y;
      }
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(inside, 100);
}

double floor_of(const Ran& ran) {
  double low = 1e9;
  for (const Way& way : ways(ran)) low = std::min(low, way.low);
  return low;
}

TEST(SiemensMilling, RectangularPocketRoughedToItsAllowances) {
  // 60 by 40, corners 8, .75 on the walls, .2 on the floor; manual's example of POCKET3 in its form.
  const Ran ran = mill_clean("POCKET3(5,0,.5,-17.5,60,40,8,0,0,0,4,.75,.2,1000,750,0,11,5,,,,,)");
  expect_region(
      ran, [](const Vec2& p) { return box_distance(p, 29.25, 19.25, 7.25); }, -17.3, 36.0);
  EXPECT_DOUBLE_EQ(floor_of(ran), -17.3);
}

TEST(SiemensMilling, InfeedsAreEqualAndTheFewest) {
  const Ran ran = mill_clean("POCKET3(5,0,.5,-17.5,60,40,8,0,0,0,4,0,0,1000,750,0,11,5)");
  std::vector<double> heights;
  for (const Way& way : ways(ran)) {
    if (heights.empty() || std::abs(way.low - heights.back()) > 1e-9) heights.push_back(way.low);
  }
  ASSERT_EQ(heights.size(), 5u);  // 18 mm from .5 in steps of at most 4
  for (size_t n = 0; n < 5; ++n) EXPECT_NEAR(heights[n], 0.5 - 3.6 * static_cast<double>(n + 1), 1e-12);
}

TEST(SiemensMilling, TurnedPocketLiesWhereItShould) {
  const Ran ran = mill_clean("POCKET3(5,0,1,-6,50,30,6,12,-3,30,0,0,0,800,200,3,21,60,,,,4,2,0,,,0,0,10)");
  const double c = std::sqrt(3.0) / 2.0, s = 0.5;
  expect_region(
      ran,
      [&](const Vec2& p) {
        const Vec2 q = p - Vec2(12.0, -3.0);
        return box_distance({c * q.x() + s * q.y(), -s * q.x() + c * q.y()}, 25.0, 15.0, 6.0);
      },
      -6.0, 46.0);
}

TEST(SiemensMilling, CornersNarrowerThanTheToolGetItsRadius) {
  const Ran ran = mill_clean("POCKET3(5,0,1,-4,30,30,2,0,0,0,0,0,0,800,200,2,11,0)");
  expect_region(
      ran, [](const Vec2& p) { return box_distance(p, 15.0, 15.0, 5.0); }, -4.0, 22.0);
}

TEST(SiemensMilling, FinishedWallsAndFloorOfAPocket) {
  const Ran ran = mill_clean("POCKET3(5,0,1,-8,60,40,8,0,0,0,0,.5,.3,800,200,0,2,8)");
  // The floor is milled within the walls, and both at the final size.
  expect_region(
      ran, [](const Vec2& p) { return box_distance(p, 30.0, 20.0, 8.0); }, -8.0, 36.0);
  const Ran edge = mill_clean("POCKET3(5,0,1,-8,60,40,8,0,0,0,0,.5,.3,800,200,0,4,8)");
  EXPECT_NEAR(cleared(ways(edge), {29.99, 0.0}, -8.0), -0.01, 1e-9);
  EXPECT_GT(cleared(ways(edge), {0.0, 0.0}, -8.0), 0.0);  // the middle of the floor is not touched
}

TEST(SiemensMilling, RoundPocketsByPlungeAndHelix) {
  for (const char* kind : {"1", "11", "21"}) {
    const Ran ran =
        mill_clean(std::string("POCKET4(3,0,.5,-20,25,4,-7,6,.2,0,200,100,1,") + kind + ",0,0,0,3,2)");
    expect_region(
        ran, [](const Vec2& p) { return (p - Vec2(4.0, -7.0)).norm() - 24.8; }, -20.0, 36.0);
  }
}

TEST(SiemensMilling, AHelixTurnsWholeTurnsOfAtMostItsPitch) {
  const Ran ran = mill_clean("POCKET4(3,0,1,-6,25,0,0,0,0,0,200,100,3,21,0,0,0,3,2)");
  int turns = 0;
  for (const NcMove& move : ran.moves) {
    if (!move.arc || move.from.tip_W.z() == move.to.tip_W.z()) continue;
    ++turns;
    EXPECT_NEAR(move.from.tip_W.z() - move.to.tip_W.z(), 1.75, 1e-12);  // 7 mm in 4 turns
    EXPECT_NEAR(swept_of(move), 2.0 * kPi, 1e-12);
  }
  EXPECT_EQ(turns, 4);
}

TEST(SiemensMilling, ASwingGoesNoSteeperThanItsAngle) {
  const Ran ran = mill_clean("POCKET3(5,0,1,-6,50,24,6,0,0,0,4,0,0,800,200,3,31,0,,,,10)");
  int strokes = 0;
  for (const NcMove& move : ran.moves) {
    const Vec3 way = move.to.tip_W - move.from.tip_W;
    if (move.rapid || move.arc || way.z() >= -1e-12 || way.head<2>().norm() < 1e-9) continue;
    ++strokes;
    EXPECT_LE(-way.z() / way.head<2>().norm(), std::tan(rad_from_deg(10.0)) + 1e-12);
  }
  EXPECT_EQ(strokes, 2);
  expect_region(
      ran, [](const Vec2& p) { return box_distance(p, 25.0, 12.0, 6.0); }, -6.0, 30.0);
}

TEST(SiemensMilling, ClimbMillingTurnsWithTheSpindle) {
  const auto turn = [](const std::string& spindle, const std::string& direction, const std::string& head,
                       const std::string& tail) {
    const Ran ran = run_text("G17 G90 G54\nT1 M6\nS2000 " + spindle + " F700\nG0 X0 Y0 Z50\n" + head +
                                 direction + tail + "\nM30\n",
                             mill_setup());
    EXPECT_FALSE(ran.diagnostics.has_errors()) << all_text(ran.diagnostics);
    double sum = 0.0;  // twice the area that the way encloses
    for (const Way& way : ways(ran))
      sum += way.from.x() * way.to.y() - way.from.y() * way.to.x() + 100 * way.turn;
    return sum > 0.0 ? 1 : -1;
  };
  const std::string pocket = "POCKET4(3,0,1,-5,25,0,0,0,0,0,200,100,",
                    spigot = "CYCLE77(3,0,1,-5,,30,0,0,0,0,0,200,100,";
  EXPECT_EQ(turn("M3", "0", pocket, ",11)"), 1);
  EXPECT_EQ(turn("M3", "1", pocket, ",11)"), -1);
  EXPECT_EQ(turn("M4", "0", pocket, ",11)"), -1);
  EXPECT_EQ(turn("M4", "2", pocket, ",11)"), -1);
  EXPECT_EQ(turn("M4", "3", pocket, ",11)"), 1);
  EXPECT_EQ(turn("M3", "0", spigot, ",1,40)"), -1);
  EXPECT_EQ(turn("M3", "1", spigot, ",1,40)"), 1);
}

/// A slot along x from `inner` to `outer`, its round ends' middles.
double slot_distance(const Vec2& p, double inner, double outer, double half) {
  const double x = std::clamp(p.x(), inner, outer);
  return (p - Vec2(x, 0.0)).norm() - half;
}

TEST(SiemensMilling, LongHolesAreStadiumsAsWideAsTheTool) {
  const std::string cycle = "LONGHOLE(5,0,1,,9,4,30,0,0,20,0,90,100,320,3)";
  for (const SlotEnds ends : {SlotEnds::kEdge, SlotEnds::kCentre}) {
    const Ran ran = mill_clean(cycle, ends);
    const double inner = ends == SlotEnds::kEdge ? 25.0 : 20.0;
    expect_region(
        ran,
        [&](const Vec2& p) {
          double nearest = 1e9;
          for (int n = 0; n < 4; ++n) {
            const Vec2 q(cos_deg(90.0 * n) * p.x() + sin_deg(90.0 * n) * p.y(),
                         -sin_deg(90.0 * n) * p.x() + cos_deg(90.0 * n) * p.y());
            nearest = std::min(nearest, slot_distance(q, inner, inner + 20.0, 5.0));
          }
          return nearest;
        },
        -9.0, 56.0);
  }
  const Ran silent = mill(cycle);
  EXPECT_EQ(errors_of(silent.diagnostics), std::vector<std::string>{"slot-ends 5:28"});
}

TEST(SiemensMilling, LongHolesGoDownAtBothEndsInTurn) {
  const Ran ran = mill_clean("LONGHOLE(5,0,1,,9,1,30,0,0,20,0,0,100,320,3)", SlotEnds::kCentre);
  std::vector<double> down;
  for (const NcMove& move : ran.moves) {
    const Vec3 way = move.to.tip_W - move.from.tip_W;
    if (!move.rapid && way.head<2>().norm() < 1e-9) down.push_back(move.to.tip_W.x());
  }
  EXPECT_EQ(down, (std::vector<double>{20.0, 40.0, 20.0, 40.0}));  // 10 mm in 4 infeeds of 2.5
}

TEST(SiemensMilling, SlotsAlongRadiiAndAlongTheCircle) {
  const Ran straight =
      mill_clean("SLOT1(5,0,1,-23,,4,30,15,0,0,25,0,90,100,320,6,2,.5,0,10,400,1200,.6)", SlotEnds::kEdge);
  expect_region(
      straight,
      [](const Vec2& p) {
        double nearest = 1e9;
        for (int n = 0; n < 4; ++n) {
          const Vec2 q(cos_deg(90.0 * n) * p.x() + sin_deg(90.0 * n) * p.y(),
                       -sin_deg(90.0 * n) * p.x() + cos_deg(90.0 * n) * p.y());
          nearest = std::min(nearest, slot_distance(q, 32.5, 47.5, 7.5));
        }
        return nearest;
      },
      -23.0, 60.0);
  const Ran round = mill_clean("SLOT2(2,0,2,-13,,3,70,15,0,0,42,0,120,100,300,6,2,.5,0)", SlotEnds::kCentre);
  expect_region(
      round,
      [](const Vec2& p) {
        double nearest = 1e9;
        for (int n = 0; n < 3; ++n) {
          const double a = rad_from_deg(120.0 * n);
          const Vec2 q(std::cos(a) * p.x() + std::sin(a) * p.y(), -std::sin(a) * p.x() + std::cos(a) * p.y());
          double angle = std::atan2(q.y(), q.x());
          const double end = rad_from_deg(70.0);
          if (angle < end / 2.0 - kPi) angle += 2.0 * kPi;
          const double at = std::clamp(angle, 0.0, end);
          nearest = std::min(nearest, (q - 42.0 * Vec2(std::cos(at), std::sin(at))).norm() - 7.5);
        }
        return nearest;
      },
      -13.0, 60.0);
}

TEST(SiemensMilling, SpigotsStandAsTheyAreAskedFor) {
  const Ran round = mill_clean("CYCLE77(10,0,3,,20,50,6,-4,10,.5,0,900,800,1,1,60)");
  const Ran square = mill_clean("CYCLE76(10,0,2,-17.5,,60,40,15,0,0,20,11,0,0,900,800,0,1,80,50)");
  const std::vector<Way> around = ways(round), about = ways(square);
  for (double turn = 0.0; turn < 360.0; turn += 3.7) {
    const Vec2 u(std::cos(rad_from_deg(turn)), std::sin(rad_from_deg(turn)));
    EXPECT_NEAR(cleared(around, Vec2(6.0, -4.0) + 25.5 * u, -20.0), 0.0, 1e-9);
    EXPECT_NEAR(cleared(around, Vec2(6.0, -4.0) + 24.0 * u, -20.0), 1.5, 1e-9);
    // From the corner spigot's middle: the cut stops at its outline.
    const double c = std::cos(rad_from_deg(20.0)), s = std::sin(rad_from_deg(20.0));
    double near = 0.0, far = 60.0;
    while (far - near > 1e-12) {
      const Vec2 p = 0.5 * (near + far) * u;
      (box_distance({c * p.x() + s * p.y(), -s * p.x() + c * p.y()}, 30.0, 20.0, 15.0) < 0.0 ? near : far) =
          0.5 * (near + far);
    }
    EXPECT_NEAR(cleared(about, near * u, -17.5), 0.0, 1e-9) << turn;
  }
}

TEST(SiemensMilling, FacesAreCoveredAndStandOutAsTheManualSays) {
  for (const char* kind : {"11", "21", "31", "41", "32"}) {
    const Ran ran =
        mill_clean(std::string("CYCLE71(10,0,2,-11,-30,-20,60,40,0,6,8,2,.5,400,") + kind + ",0)");
    const std::vector<Way> all = ways(ran);
    const double height = std::string(kind) == "32" ? -11.0 : -10.5;
    for (double x = -29.9; x < 30.0; x += 0.93) {
      for (double y = -19.9; y < 20.0; y += 0.77) EXPECT_LE(cleared(all, {x, y}, height), 1e-9) << kind;
    }
    const bool second = kind[0] == '2' || kind[0] == '4';
    double first = 1e9, last = -1e9;
    for (const Way& way : all) {
      const double across = second ? way.from.x() : way.from.y();
      first = std::min(first, across);
      last = std::max(last, across);
    }
    // The tool stands out by its diameter less the step; the last pass ends at the edge.
    EXPECT_NEAR(first, (second ? -30.0 : -20.0) + 8.0 - kRadius, 1e-12) << kind;
    EXPECT_NEAR(last, (second ? 30.0 : 20.0) - kRadius, 1e-12) << kind;
  }
  const Ran newer = mill_clean("CYCLE61(50,1,1,0,-30,-20,60,40,2,80,0,1000,31,0,1,11010)");
  for (double x = -29.9; x < 30.0; x += 0.93) {
    for (double y = -19.9; y < 20.0; y += 0.77) EXPECT_LE(cleared(ways(newer), {x, y}, 0.0), 1e-9);
  }
}

TEST(SiemensMilling, ImpossibleCyclesAreRefusedWhereTheyStand) {
  const auto code = [](const std::string& cycle) {
    const Ran ran = mill(cycle, SlotEnds::kEdge);
    const std::vector<std::string> errors = errors_of(ran.diagnostics);
    return errors.empty() ? std::string("none") : errors.front();
  };
  EXPECT_EQ(code("POCKET3(5,0,1,-6,50,9,2,0,0,0,0,0,0,800,200,0,11,5)"), "bad-tool 5:18");
  EXPECT_EQ(code("POCKET3(5,0,1,-6,50,12,2,0,0,0,0,1.5,0,800,200,0,11,5)"), "bad-tool 5:18");
  EXPECT_EQ(code("POCKET3(5,0,1,-6,50,30,16,0,0,0,0,0,0,800,200,0,11,5)"), "bad-cycle 5:24");
  EXPECT_EQ(code("POCKET3(5,0,1,-6,50,30,6,0,0,0,0,0,0,800,200,0,11,11)"), "out-of-range 5:51");
  EXPECT_EQ(code("POCKET3(5,0,1,-6,50,30,6,0,0,0,0,0,0,800,200,4,11,5)"), "out-of-range 5:46");
  EXPECT_EQ(code("POCKET3(5,0,1,-6,50,30,6,0,0,0,0,0,0,800,200,0,13,5)"), "out-of-range 5:48");
  EXPECT_EQ(code("POCKET3(5,0,1,6,50,30,6,0,0,0,0,0,0,800,200,0,11,5)"), "bad-cycle 5:15");
  EXPECT_EQ(code("POCKET3(.5,0,1,-6,50,30,6,0,0,0,0,0,0,800,200,0,11,5)"), "bad-cycle 5:9");
  EXPECT_EQ(code("POCKET3(5,0,1,-6,50,30,6,0,0,0,0,0,0,800,200,0,11,5,30,20,3)"), "unsupported-word 5:53");
  EXPECT_EQ(code("POCKET4(3,0,.5,-20,8,0,0,6,0,0,200,100,1,21,0,0,0,4,2)"), "bad-cycle 5:51");
  EXPECT_EQ(code("POCKET4(3,0,.5,-20,8,0,0,.0001,0,0,200,100,1,11)"), "bad-cycle 5:26");
  EXPECT_EQ(code("SLOT1(5,0,1,-23,,4,30,9,0,0,25,0,90,100,320,6,2,.5,0)"), "bad-tool 5:23");
  EXPECT_EQ(code("SLOT1(5,0,1,-23,,1,50,25,0,0,25,0,90,100,320,6,2,.5,0)"), "bad-tool 5:23");
  EXPECT_EQ(code("SLOT1(5,0,1,-23,,4,30,15,0,0,0,0,90,100,320,6,2,.5,0)"), "bad-cycle 5:18");
  EXPECT_EQ(code("SLOT2(2,0,2,-13,,3,121,15,0,0,42,0,120,100,300,6,2,.5,0)"), "bad-cycle 5:20");
  EXPECT_EQ(code("SLOT2(2,0,2,-13,,0,70,15,0,0,42,0,120,100,300,6,2,.5,0)"), "out-of-range 5:18");
  EXPECT_EQ(code("CYCLE71(10,0,2,-11,-30,-20,60,40,0,6,12,2,.5,400,11,0)"), "out-of-range 5:38");
  EXPECT_EQ(code("CYCLE77(10,0,3,-20,20,50,6,-4,10,.5,0,900,800,1,1,60)"), "wrong-arguments 5:16");
  EXPECT_EQ(code("CYCLE77(10,0,3,,20,50,6,-4,10,.5,0,900,800,1,1,40)"), "bad-cycle 5:48");
  EXPECT_EQ(code("D0\nCYCLE77(10,0,3,,20,50,6,-4,10,.5,0,900,800,1,1,60)"), "no-tool-offset 6:1");
  EXPECT_EQ(code("M5\nCYCLE77(10,0,3,,20,50,6,-4,10,.5,0,900,800,1,1,60)"), "feed-without-spindle 6:44");
  EXPECT_EQ(code("MIRROR X0\nCYCLE77(10,0,3,,20,50,6,-4,10,.5,0,900,800,1,1,60)"), "unsupported-word 6:1");
}

}  // namespace
}  // namespace swarf::program::nc::siemens

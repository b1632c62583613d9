#include "collision/path_check.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "collision/free_range.h"
#include "collision/overlap_bound.h"
#include "unit/collision/brute_distance.h"
#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

using motion::Cycle;

/// Cycles of a polyline through the corners, `each` to a side; a side is an element.
std::vector<Cycle> polyline(const std::vector<AxisValues>& corners, int each) {
  std::vector<Cycle> cycles;
  for (size_t side = 0; side + 1 < corners.size(); ++side) {
    for (int k = side == 0 ? 0 : 1; k <= each; ++k) {
      Cycle cycle;
      cycle.number = cycles.size();
      const double share = static_cast<double>(k) / each;
      cycle.q = (1.0 - share) * corners[side] + share * corners[side + 1];
      cycle.sample.t_s = 1e-3 * static_cast<double>(cycles.size());
      cycle.sample.element = static_cast<int>(side);
      cycles.push_back(cycle);
    }
  }
  return cycles;
}

Body on_table(const std::string& name, const TriMesh& mesh) {
  return mesh_body(name, BodyKind::kFixture, kTable, mesh);
}
Body on_head(const std::string& name, const TriMesh& mesh) {
  return mesh_body(name, BodyKind::kLink, kZSlide, mesh);
}

PathFindings check(const machine::MachineScene& scene, const std::vector<Body>& bodies,
                   const std::vector<Cycle>& cycles, const PathCheckOptions& options = {},
                   size_t window = 777) {
  Diagnostics diagnostics;
  PathCheck path(scene, bodies, options, diagnostics);
  for (size_t k = 0; k < cycles.size(); k += window) {
    path.add(std::span(cycles).subspan(k, std::min(window, cycles.size() - k)));
  }
  return path.finish();
}

TEST(PathCheck, ThinWallBetweenTwoCyclesIsMet) {
  const machine::MachineScene scene = toy_machine();
  const std::vector<Body> bodies{on_table("wall", box_mesh({50, -50, 0}, {50.05F, 50, 100})),
                                 on_head("needle", box_mesh({-0.1, -0.1, 50}, {0, 0, 150}))};
  // Element 0 rises to the height, 1 flies through in five cycles, 2 returns above the wall.
  const std::vector<Cycle> cycles =
      polyline({axes(0, 0, 200), axes(0), axes(101), axes(101, 0, 200), axes(0, 0, 200)}, 5);
  const PathFindings found = check(scene, bodies, cycles);
  ASSERT_EQ(found.pairs.size(), 1U);
  const PairFindings& pair = found.pairs[0];
  ASSERT_EQ(pair.contacts.size(), 1U);
  const ContactEvent& event = pair.contacts[0];
  EXPECT_EQ(event.first_element, 1);
  EXPECT_EQ(event.last_element, 1);
  EXPECT_EQ(event.first.cycle, 7U);  // 5 + 2: 40.4 to 60.6
  EXPECT_EQ(event.last_cycle, 8U);
  EXPECT_NEAR((event.first.share + 2.0) * 20.2, 50.0, 0.0101);
  EXPECT_NEAR(event.first.time_s, 1e-3 * (5.0 + 50.0 / 20.2), 1e-6);
  EXPECT_NEAR(event.point_a.x(), 50.0, 0.0101);
  EXPECT_EQ(pair.near_miss.lower, 0.0);
  EXPECT_LE(pair.near_miss.upper, 1e-4);
}

TEST(PathCheck, PassingOverItIsANearMiss) {
  const machine::MachineScene scene = toy_machine();
  const std::vector<Body> bodies{on_table("wall", box_mesh({50, -50, 0}, {50.05F, 50, 100})),
                                 on_head("needle", box_mesh({-0.1, -0.1, 50}, {0, 0, 150}))};
  const std::vector<Cycle> cycles =
      polyline({axes(0, 0, 200), axes(0, 0, 50.5), axes(101, 0, 50.25), axes(101, 0, 200)}, 3000);
  const PairFindings pair = check(scene, bodies, cycles).pairs.at(0);
  EXPECT_TRUE(pair.contacts.empty());
  // Lowest over the far edge of the wall, reached by the needle's left side.
  const double gap = 0.5 - 0.25 * 50.15 / 101.0;
  EXPECT_TRUE(pair.near_miss.within);
  EXPECT_NEAR(pair.near_miss.upper, gap, 2e-3);
  EXPECT_LE(pair.near_miss.lower, gap);
  EXPECT_GE(pair.near_miss.lower, gap - 2.1e-3);
  EXPECT_EQ(pair.near_miss.place.element, 1);
}

TEST(PathCheck, LeastOfManyCyclesOnACurvedPath) {
  const machine::MachineScene scene = toy_machine();
  Rng rng(21);
  for (int trial = 0; trial < 3; ++trial) {
    const std::vector<Body> bodies{on_table("part", bumpy_ball(Vec3(10, 0, 10), 20.0, 5, 7, rng)),
                                   on_head("head", bumpy_ball(Vec3(0, 0, 70), 15.0, 5, 6, rng))};
    std::vector<Cycle> cycles(700);
    const double turns = rng.uniform(-4.0, 4.0), phase = rng.uniform(0.0, 6.0);
    for (size_t k = 0; k < cycles.size(); ++k) {
      const double t = static_cast<double>(k) / 700.0;
      cycles[k].number = k;
      cycles[k].q = axes(5 * std::sin(9 * t), 4 * std::cos(7 * t), 3 * std::sin(5 * t + phase),
                         0.3 * std::sin(3 * t), turns * t);
    }
    const PairFindings pair = check(scene, bodies, cycles, {50.0, 2e-3, 1e-4, {}}).pairs.at(0);
    const Encounter both = encounter(scene, bodies[0], bodies[1]);
    double least = INFINITY;
    for (size_t k = 0; k < cycles.size(); k += 3) {
      least = std::min(least, brute_distance(bodies[0], bodies[1], both.b_from_a.pose(cycles[k].q)));
    }
    const NearMiss& near = pair.near_miss;
    EXPECT_LE(near.lower, least) << trial;
    EXPECT_LE(near.upper, least + 2e-3) << trial;
    EXPECT_NEAR(near.upper, least, 5e-3) << trial;
    EXPECT_LE(near.upper - near.lower, 2e-3 + 1e-9) << trial;
    // It occurs where it is said to.
    const AxisSegment there =
        way(cycles[near.place.cycle].q, cycles[std::min<size_t>(699, near.place.cycle + 1)].q);
    const AxisValues q = there.at(near.place.share);
    const double there_mm = brute_distance(bodies[0], bodies[1], both.b_from_a.pose(q));
    EXPECT_LE(there_mm, near.upper + 1e-9) << trial;
    EXPECT_GE(there_mm, near.lower - 1e-9) << trial;
    EXPECT_NEAR((near.point_a - near.point_b).norm(), near.upper, 1e-6) << trial;
  }
}

/// Looking at every way by itself, which the stretches must not differ from.
struct OneByOne {
  double least = INFINITY;
  std::vector<bool> touches;
};
OneByOne one_by_one(const Encounter& pair, const std::vector<Cycle>& cycles) {
  OneByOne all;
  for (size_t k = 0; k + 1 < cycles.size(); ++k) {
    const AxisSegment segment = way(cycles[k].q, cycles[k + 1].q);
    all.least = std::min(all.least, closest_approach(pair, segment).upper);
    all.touches.push_back(first_contact(pair, segment).touches);
  }
  return all;
}

/// A path of a random kind: lines, loops that come back to where they were, turns, jumps, pauses.
std::vector<Cycle> random_path(Rng& rng) {
  std::vector<AxisValues> corners(1, axes(rng.uniform(-30, 30), rng.uniform(-30, 30), rng.uniform(0, 40)));
  for (int i = 0; i < 6; ++i) {
    AxisValues next = corners.back();
    const auto kind = static_cast<int>(rng.uniform(0.0, 5.0));
    if (kind == 0) next += axes(rng.uniform(-60, 60), rng.uniform(-60, 60), rng.uniform(-20, 20));
    if (kind == 1) next[kC] += rng.uniform(-7.0, 7.0);
    if (kind == 2) next += axes(rng.uniform(-9, 9), 0, 0, rng.uniform(-0.6, 0.6), rng.uniform(-2, 2));
    if (kind == 3) next = corners.front();
    corners.push_back(next);
  }
  return polyline(corners, 1 + static_cast<int>(rng.uniform(0.0, 40.0)));
}

TEST(PathCheck, StretchesSayWhatEveryWaySays) {
  const machine::MachineScene scene = toy_machine();
  size_t touching = 0, near = 0;
  for (int i = 0; i < 150; ++i) {
    Rng rng(500 + i);
    const double thin = i % 3 == 0 ? 0.05 : 4.0, size = rng.uniform(0.1, 10.0);
    const Vec3 at = 30.0 * rng.uniform() * rng.direction();
    const std::vector<Body> bodies{on_table("wall", box_mesh(at, at + Vec3(thin, 30, 20))),
                                   on_head("head", box_mesh({-size, -size, 5}, {size, size, 60}))};
    const std::vector<Cycle> cycles = random_path(rng);
    const PairFindings pair = check(scene, bodies, cycles).pairs.at(0);
    const OneByOne all = one_by_one(encounter(scene, bodies[0], bodies[1]), cycles);
    std::vector<bool> told(all.touches.size(), false);
    for (const ContactEvent& one : pair.contacts) {
      for (uint64_t k = one.first.cycle; k < one.last_cycle; ++k) told[k] = told[k] || !one.inside;
    }
    EXPECT_EQ(told, all.touches) << "seed " << 500 + i;
    EXPECT_LE(pair.near_miss.lower, all.least + 1e-9) << "seed " << 500 + i;
    EXPECT_NEAR(pair.near_miss.upper, std::min(10.0, all.least), 3e-3) << "seed " << 500 + i;
    touching += std::count(all.touches.begin(), all.touches.end(), true);
    near += all.least > 1e-3 && all.least < 10.0 ? 1 : 0;
  }
  EXPECT_GT(touching, 300U);
  EXPECT_GT(near, 15U);
}

/// Everything that is told, as text.
std::string text_of(const PathFindings& found) {
  std::string text;
  const auto add = [&](const void* data, size_t size) { text.append(static_cast<const char*>(data), size); };
  const auto add_all = [&](std::initializer_list<double> values) {
    for (const double value : values) add(&value, sizeof(value));
  };
  for (const PairFindings& pair : found.pairs) {
    const NearMiss& near = pair.near_miss;
    add_all({near.lower, near.upper, near.place.share, near.place.time_s, double(near.place.cycle),
             near.point_a.x(), double(pair.contact_count())});
    for (const ContactEvent& one : pair.contacts) {
      add_all({one.first.share, one.free.share, double(one.first.cycle), double(one.last_cycle), one.depth_mm,
               one.point_b.y(), double(one.first_element), double(one.last_element)});
    }
  }
  return text;
}

TEST(PathCheck, SameForAnyThreadsAndWindows) {
  const machine::MachineScene scene = toy_machine();
  Rng rng(5);
  const std::vector<Body> bodies{
      on_table("part", bumpy_ball(Vec3(0, 0, 10), 20.0, 8, 9, rng)),
      on_table("clamp", box_mesh({25, -5, 0}, {30, 5, 30})),
      on_head("head", bumpy_ball(Vec3(0, 0, 52), 15.0, 7, 8, rng)),
      mesh_body("arm", BodyKind::kLink, kArm, box_mesh({-60, -60, -30}, {60, 60, -20}))};
  std::vector<AxisValues> corners;
  for (int i = 0; i < 9; ++i) {
    corners.push_back(axes(rng.uniform(-20, 20), rng.uniform(-20, 20), rng.uniform(-10, 15),
                           rng.uniform(-0.5, 0.5), rng.uniform(-2, 2)));
  }
  const std::vector<Cycle> cycles = polyline(corners, 5000);
  set_thread_count(1);
  const std::string one = text_of(check(scene, bodies, cycles));
  set_thread_count(0);
  EXPECT_EQ(one, text_of(check(scene, bodies, cycles)));
  EXPECT_EQ(one, text_of(check(scene, bodies, cycles, {}, 100000)));
  EXPECT_EQ(one, text_of(check(scene, bodies, cycles, {}, 1)));
  EXPECT_GT(check(scene, bodies, cycles).pairs.at(0).contact_count(), 0U);
}

/// Many short stretches of the same places, so that boxes that are known to be free are used: every place in
/// a box that is covered is as far away as was asked.
TEST(FreeRange, NothingIsNearAtAnyPlaceThatIsCovered) {
  const machine::MachineScene scene = toy_machine();
  size_t covered = 0, not_covered = 0;
  for (int i = 0; i < 60; ++i) {
    Rng rng(7000 + i);
    const double size = rng.uniform(1.0, 10.0), least = rng.uniform(0.1, 10.0);
    const Body wall = on_table("wall", box_mesh(Vec3(20, -30, 0), Vec3(26, 30, rng.uniform(5, 40))));
    const Body head = on_head("head", box_mesh({-size, -size, 5}, {size, size, 60}));
    const Encounter pair = encounter(scene, wall, head);
    FreeRange range;
    for (int n = 0; n < 12; ++n) {
      const AxisValues at = axes(rng.uniform(-60, 15), rng.uniform(-30, 30), rng.uniform(0, 60),
                                 rng.uniform(-0.2, 0.2), rng.uniform(-0.3, 0.3));
      const AxisValues wide = axes(rng.uniform(0, 9), rng.uniform(0, 9), 0, rng.uniform(0, 0.1), 0.05);
      const AxisBox box{at - wide, at + wide};
      if (!range.covers(pair, box, least, 2e-3)) {
        ++not_covered;
        continue;
      }
      ++covered;
      for (int s = 0; s < 20; ++s) {
        AxisSegment still;
        for (int k = 0; k < 5; ++k) still.q0[k] = rng.uniform(box.low[k], box.high[k]);
        still.q1 = still.q0;
        ApproachQuery query;
        query.limit = least;
        EXPECT_FALSE(closest_approach(pair, still, query).within) << "seed " << 7000 + i;
        EXPECT_FALSE(one_holds_other(pair, still.q0)) << "seed " << 7000 + i;
      }
    }
  }
  EXPECT_GT(covered, 100U);
  EXPECT_GT(not_covered, 50U);
}

TEST(PathCheck, OneContactOverManyStretchesIsOneEvent) {
  const machine::MachineScene scene = toy_machine();
  const std::vector<Body> bodies{on_table("block", box_mesh({0, -5, 0}, {100, 5, 10})),
                                 on_head("head", box_mesh({-2, -1, 7}, {0, 1, 30}))};
  // 3 mm deep from x = 0 to 102, then free, then once more.
  const std::vector<Cycle> cycles = polyline({axes(-10), axes(190), axes(-10)}, 20000);
  const PairFindings pair = check(scene, bodies, cycles).pairs.at(0);
  ASSERT_EQ(pair.contacts.size(), 2U);
  EXPECT_EQ(pair.contact_count(), 2U);
  EXPECT_EQ(pair.contacts[0].first_element, 0);
  EXPECT_NEAR(pair.contacts[0].first.time_s, 1.0, 2e-3);
  EXPECT_NEAR(static_cast<double>(pair.contacts[0].last_cycle), 11200.0, 2.0);
  EXPECT_NEAR(pair.contacts[0].depth_mm, 3.0, 1e-3);
  EXPECT_EQ(pair.contacts[1].first_element, 1);
  EXPECT_NEAR(static_cast<double>(pair.contacts[1].first.cycle), 28800.0, 2.0);
}

TEST(PathCheck, WhollyInsideIsAContact) {
  const machine::MachineScene scene = toy_machine();
  const Body outer = on_table("outer", box_mesh({-50, -50, -50}, {50, 50, 50}));
  Body sheet = outer;
  sheet.closed = false;
  sheet.name = "sheet";
  const std::vector<Cycle> cycles = polyline({axes(0), axes(10), axes(-10)}, 50);
  const std::vector<Body> bodies{outer, sheet, on_head("inner", box_mesh({-1, -1, -1}, {1, 1, 1}))};
  const PathFindings found = check(scene, bodies, cycles);
  ASSERT_EQ(found.pairs.size(), 2U);
  ASSERT_EQ(found.pairs[0].contacts.size(), 1U);
  EXPECT_TRUE(found.pairs[0].contacts[0].inside);
  EXPECT_EQ(found.pairs[0].contacts[0].last_cycle, 100U);
  EXPECT_GT(found.pairs[0].contacts[0].depth_mm, 40.0);
  EXPECT_TRUE(found.pairs[1].contacts.empty());  // an open mesh holds nothing
  // A tool of revolution inside it, too.
  const std::vector<Body> with_tool{outer, solid_body("tool", BodyKind::kToolPart, kZSlide,
                                                      {frustum(Vec3::Zero(), Vec3::UnitZ(), -3, 3, 2, 2)})};
  ASSERT_EQ(check(scene, with_tool, cycles).pairs[0].contacts.size(), 1U);
}

TEST(PathCheck, ToolsAreThereOnlyWhileTheyAreInTheSpindle) {
  const machine::MachineScene scene = toy_machine();
  Body first =
      solid_body("T1", BodyKind::kToolPart, kZSlide, {frustum(Vec3::Zero(), Vec3::UnitZ(), 0, 50, 3, 3)});
  Body second =
      solid_body("T2", BodyKind::kToolPart, kZSlide, {frustum(Vec3(0, 0, 20), Vec3::UnitZ(), 0, 30, 3, 3)});
  first.tool = 0;
  second.tool = 1;
  const std::vector<Body> bodies{on_table("block", box_mesh({-50, -50, 0}, {50, 50, 10})), first, second};
  std::vector<Cycle> cycles = polyline({axes(0, 0, 100), axes(0, 0, 30), axes(0, 0, 1), axes(9, 0, 1)}, 100);
  for (Cycle& cycle : cycles) cycle.sample.tool = cycle.sample.element >= 1 ? 1 : 0;
  PathFindings found = check(scene, bodies, cycles);
  ASSERT_EQ(found.pairs.size(), 2U);
  EXPECT_TRUE(found.pairs[0].contacts.empty());
  EXPECT_FALSE(found.pairs[0].near_miss.within);  // 20 mm above it with the first tool
  EXPECT_TRUE(found.pairs[1].contacts.empty());
  EXPECT_FALSE(found.pairs[1].near_miss.within);         // 11 mm
  EXPECT_EQ(found.unseen_changes, std::vector<int>{1});  // the axes do not stand still over it
  for (Cycle& cycle : cycles) cycle.sample.tool = 0;
  found = check(scene, bodies, cycles);
  EXPECT_TRUE(found.unseen_changes.empty());
  EXPECT_EQ(found.pairs[0].contacts.size(), 1U);
  EXPECT_TRUE(found.pairs[1].contacts.empty());
}

TEST(PathCheck, PairsThatAreLeftOutAreNamed) {
  machine::MachineScene scene = toy_machine();
  const std::vector<Body> bodies{
      mesh_body("column", BodyKind::kLink, kColumn, box_mesh({-100, -100, -100}, {-80, 100, 100})),
      mesh_body("x_slide", BodyKind::kLink, kXSlide, box_mesh({-90, -10, 0}, {0, 10, 10})),
      mesh_body("y_slide", BodyKind::kLink, kYSlide, box_mesh({-85, -10, 5}, {0, 10, 50})),
      on_head("z_slide", box_mesh({20, 0, 60}, {30, 5, 70})),
      on_table("clamp", box_mesh({40, 40, 0}, {45, 45, 5})),
      on_table("vice", box_mesh({60, 40, 0}, {65, 45, 5}))};
  for (machine::Link& link : scene.links) link.mesh = box_mesh({0, 0, 0}, {1, 1, 1});  // none is skipped
  Diagnostics diagnostics;
  const PairChoice choice = choose_pairs(scene, bodies, {{{"clamp", "z_slide"}}, {}}, 1e-4, diagnostics);
  EXPECT_EQ(choice.watched.size() + choice.left_out.size(), 15U);
  const auto reason = [&](size_t a, size_t b) {
    for (const LeftOutPair& one : choice.left_out) {
      if (one.a == a && one.b == b) return static_cast<int>(one.reason);
    }
    return -1;
  };
  EXPECT_EQ(reason(0, 1), static_cast<int>(PairReason::kGuided));
  EXPECT_EQ(reason(0, 2), static_cast<int>(PairReason::kTouchesAtHome));
  EXPECT_EQ(reason(3, 4), static_cast<int>(PairReason::kAllowed));
  EXPECT_EQ(reason(4, 5), static_cast<int>(PairReason::kRigid));
  EXPECT_EQ(reason(3, 5), -1);
  ASSERT_EQ(diagnostics.list().size(), 1U);
  EXPECT_EQ(diagnostics.list()[0].code, "links-touch-at-home");
  EXPECT_NE(diagnostics.list()[0].text.find("column"), std::string::npos);
  EXPECT_THROW(choose_pairs(scene, bodies, {{{"clmp", "vice"}}, {}}, 1e-4, diagnostics), InputError);
  EXPECT_THROW(PathCheck(scene, bodies, {-1.0, 1e-3, 1e-4, {}}, diagnostics), InputError);
}

/// A pair with a near-miss distance of its own is watched, though one link guides the other, and up to there.
TEST(PathCheck, APairMayHaveANearMissOfItsOwn) {
  machine::MachineScene scene = toy_machine();
  const std::vector<Body> bodies{
      mesh_body("column", BodyKind::kLink, kColumn, box_mesh({-100, -100, -100}, {-80, 100, 100})),
      mesh_body("x_slide", BodyKind::kLink, kXSlide, box_mesh({-50, -10, 0}, {0, 10, 10})),
      on_table("post", box_mesh({25, -10, 0}, {30, 10, 10}))};
  for (machine::Link& link : scene.links) link.mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  const std::vector<Cycle> cycles = polyline({axes(0), axes(20)}, 50);
  EXPECT_EQ(check(scene, bodies, cycles).pairs.size(), 2U);  // both with the post
  PathCheckOptions options;
  options.rules.watched = {{{"x_slide", "column"}, 31.0}, {{"post", "x_slide"}, 4.0}};
  const PathFindings found = check(scene, bodies, cycles, options);
  ASSERT_EQ(found.pairs.size(), 3U);
  EXPECT_TRUE(found.pairs[0].near_miss.within);
  EXPECT_NEAR(found.pairs[0].near_miss.upper, 30.0, 2e-3);
  EXPECT_FALSE(found.pairs[2].near_miss.within);
  EXPECT_EQ(found.pairs[2].near_miss.lower, 4.0);
}

TEST(PathCheck, NothingAndOneCycle) {
  const machine::MachineScene scene = toy_machine();
  const std::vector<Body> bodies{on_table("block", box_mesh({0, 0, 0}, {10, 10, 10})),
                                 on_head("head", box_mesh({5, 5, 5}, {30, 30, 30})), on_head("none", {})};
  EXPECT_EQ(check(scene, bodies, {}).cycles, 0U);
  const PathFindings found = check(scene, bodies, {Cycle{}});
  ASSERT_EQ(found.pairs.size(), 2U);
  EXPECT_EQ(found.pairs[0].contacts.size(), 1U);
  EXPECT_NEAR(found.pairs[0].contacts.at(0).depth_mm, 5.0, kDepthTolerance);
  EXPECT_TRUE(found.pairs[1].contacts.empty());
}

TEST(MeshBody, RefusesWhatIsNoMesh) {
  TriMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(mesh_body("box", BodyKind::kPart, 0, mesh).closed);
  mesh.positions[3][1] = NAN;
  EXPECT_THROW(mesh_body("box", BodyKind::kPart, 0, mesh), InputError);
  mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  mesh.triangles.pop_back();
  EXPECT_FALSE(mesh_body("box", BodyKind::kPart, 0, mesh).closed);
  mesh.triangles.push_back({0, 1, 8});
  EXPECT_THROW(mesh_body("box", BodyKind::kPart, 0, mesh), InputError);
}

TEST(SolidBody, RefusesWhatIsNoProfile) {
  const auto body_of = [](const RevolvedSolid& solid) {
    return solid_body("tool", BodyKind::kToolPart, 0, {solid});
  };
  const RevolvedSolid good = frustum(Vec3::Zero(), Vec3::UnitZ(), 0, 5, 2, 3);
  EXPECT_EQ(body_of(good).nodes.size(), 1U);
  EXPECT_THROW(body_of(frustum(Vec3::Zero(), Vec3::UnitZ(), 5, 0, 2, 3)), InputError);
  EXPECT_THROW(body_of(frustum(Vec3::Zero(), Vec3::UnitZ(), 0, 5, -2, 3)), InputError);
  EXPECT_THROW(body_of(frustum(Vec3::Zero(), Vec3(0, 0, 2), 0, 5, 2, 3)), InputError);
  EXPECT_THROW(body_of(frustum(Vec3::Zero(), Vec3::UnitZ(), 0, NAN, 2, 3)), InputError);
  EXPECT_THROW(body_of({}), InputError);
}

}  // namespace
}  // namespace swarf::collision

// Whatever two bodies look like and however the axes move them: no pose of a dense row contradicts what is
// said of the whole motion, and the answer does not depend on which body is named first nor on the sense of
// time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "collision/closest_approach.h"
#include "collision/stock_body.h"
#include "unit/collision/brute_distance.h"
#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

/// A box of any proportion (plates of 0.05 mm, needles), a ball, a sheet, triangles without area.
TriMesh any_mesh(Rng& rng) {
  const Vec3 centre = 60.0 * rng.uniform() * rng.direction();
  const auto kind = static_cast<int>(rng.uniform(0.0, 6.0));
  if (kind == 0) return bumpy_ball(centre, rng.uniform(0.5, 20.0), 4, 5, rng);
  Vec3 half(rng.uniform(0.1, 30.0), rng.uniform(0.1, 30.0), rng.uniform(0.1, 30.0));
  if (kind == 1) half.x() = 0.025;
  if (kind == 2) half.x() = half.y() = 0.01;
  if (kind == 3) half.z() = 0.0;
  TriMesh mesh = box_mesh(centre - half, centre + half);
  if (kind == 4) mesh.triangles.push_back({0, 0, 7});
  if (kind == 5) mesh.triangles = {{0, 1, 1}, {3, 5, 6}};
  return mesh;
}

/// A mesh, or a part of a tool.
Body any_body(const char* name, BodyKind kind, int link, Rng& rng) {
  if (rng.uniform() < 0.75) return mesh_body(name, kind, link, any_mesh(rng));
  const double low = rng.uniform(-20.0, 0.0), high = low + rng.uniform(0.01, 60.0);
  const Vec3 foot = 40.0 * rng.uniform() * rng.direction();
  const Vec3 axis = rng.uniform() < 0.5 ? Vec3(Vec3::UnitZ()) : rng.direction();
  return solid_body(name, kind, link,
                    {frustum(foot, axis, low, high, rng.uniform(0.0, 20.0), rng.uniform(0.1, 20.0))});
}

/// At rest; of solids by our own search, which `ConvexDistance` holds against closed forms.
double distance_at_rest(const Encounter& pair, const AxisValues& q) {
  if (pair.a->solids.empty() && pair.b->solids.empty()) {
    return brute_distance(*pair.a, *pair.b, pair.b_from_a.pose(q));
  }
  ApproachQuery query;
  query.tolerance = 1e-6;
  return closest_approach(pair, way(q, q), query).upper;
}

AxisSegment any_motion(Rng& rng) {
  AxisSegment segment;
  const auto kind = static_cast<int>(rng.uniform(0.0, 5.0));
  for (int k = 0; k < 5; ++k) segment.q0[k] = k < 3 ? rng.uniform(-40, 40) : rng.uniform(-1, 1);
  segment.q1 = segment.q0;
  for (int k = 0; k < 5; ++k) {
    const bool moves = kind == 0 || (kind == 1 && k < 3) || (kind == 2 && k == kC) || (kind == 3 && k >= kZ);
    if (moves) segment.q1[k] += k < 3 ? rng.uniform(-150, 150) : rng.uniform(-7, 7);
  }
  return segment;
}

/// The case, ready to paste: the seed makes everything else.
std::string pasted(uint64_t seed) {
  return fmt::format("check_case({}U);", seed);
}

void check_case(uint64_t seed) {
  constexpr int kPoses = 48;
  const machine::MachineScene scene = toy_machine();
  Rng rng(seed);
  const Body a = any_body("a", BodyKind::kPart, static_cast<int>(rng.uniform(-1.0, 6.0)), rng);
  const Body b = any_body("b", BodyKind::kToolPart, kZSlide, rng);
  const AxisSegment segment = any_motion(rng), back = way(segment.q1, segment.q0);
  const Encounter pair = encounter(scene, a, b), other = encounter(scene, b, a);
  const Approach found = closest_approach(pair, segment);
  const FirstContact contact = first_contact(pair, segment);
  double least = INFINITY;
  for (int k = 0; k <= kPoses; ++k) {
    const double t = static_cast<double>(k) / kPoses;
    const double distance = distance_at_rest(pair, segment.at(t));
    least = std::min(least, distance);
    ASSERT_TRUE(t >= contact.t_free || distance > 0.0) << pasted(seed) << " at " << t;
  }
  ASSERT_LE(found.lower, least + 1e-9) << pasted(seed);
  ASSERT_LE(found.upper, least + 1e-3) << pasted(seed);
  ASSERT_LE(found.upper - found.lower, 1e-3 + 1e-6) << pasted(seed);
  const double there = distance_at_rest(pair, segment.at(found.t));
  ASSERT_LE(there, found.upper + 1e-6) << pasted(seed);
  ASSERT_GE(there, found.lower - 1e-6) << pasted(seed);
  // A distance of zero and a contact are one.
  ASSERT_TRUE(contact.touches ? found.lower <= 1e-4 : found.upper > 1e-4) << pasted(seed);
  ASSERT_LE(contact.gap, 1e-4 + 1e-6) << pasted(seed);
  for (const Approach& same : {closest_approach(other, segment), closest_approach(pair, back)}) {
    ASSERT_NEAR(same.upper, found.upper, 1e-3 + 1e-6) << pasted(seed);
  }
  ASSERT_EQ(first_contact(other, segment).touches, contact.touches) << pasted(seed);
  ASSERT_EQ(first_contact(pair, back).touches, contact.touches) << pasted(seed);
}

TEST(CollisionProperty, NoPoseContradictsTheWholeMotion) {
  for (uint64_t seed = 1; seed <= 600 && !HasFatalFailure(); ++seed) check_case(seed);
}

/// A block of 40 x 20 x 10 on the table with two slots along X, 6 mm deep, and a wall of 1 mm between them.
constexpr double kVoxel = 0.5;

stock::Stock walled_block() {
  stock::Stock stock({Vec3(0, 0, 0), Vec3(40, 20, 10)}, kVoxel);
  const stock::CutterSolid cutter(3.0, 30.0);
  std::vector<stock::Sweep> sweeps;
  for (const double y : {6.5, 13.5})
    sweeps.push_back({{Vec3(-10, y, 4), Vec3::UnitZ()}, {Vec3(50, y, 4), Vec3::UnitZ()}, 0});
  stock.cut(sweeps, cutter);
  return stock;
}

/// A link as a mesh, or a holder as a solid, `wide` across, from `foot` upwards.
Body planted_body(bool solid, int link, const Vec3& foot, double wide, double high) {
  if (solid)
    return solid_body("holder", BodyKind::kToolPart, link,
                      {frustum(foot, Vec3::UnitZ(), 0.0, high, 0.5 * wide, 0.5 * wide)});
  const Vec3 half(0.5 * wide, 0.5 * wide, 0.0);
  return mesh_body("head", BodyKind::kLink, link, box_mesh(foot - half, foot + half + high * Vec3::UnitZ()));
}

struct PlantedInStock {
  Body body;
  AxisSegment segment;
  double way_mm = 0.0,
         free_mm = 0.0;  ///< of the whole segment, and until the body comes to the block; 0: no closed form
};

/// One straight way of the axes, fast; but for the way down free at both ends. `off`: mm that the body stays
/// clear, below 0 that it goes into the material.
PlantedInStock planted_in_stock(Rng& rng, int kind, double off) {
  const bool solid = rng.uniform() < 0.5;
  const double thick = rng.uniform(0.6, 3.0), high = rng.uniform(8.0, 60.0);
  const double x = rng.uniform(5.0, 35.0), far = rng.uniform(60.0, 300.0);
  if (kind == 0)  // along the first slot, over its floor at 4
    return {planted_body(solid, kZSlide, {-far, 6.5, 4.0 + off}, thick, high), way(axes(0), axes(2.0 * far)),
            2.0 * far, far - 0.5 * thick};
  if (kind == 1) {  // along it, beside its wall at y = 3.5
    // Of a cylinder that part goes ahead which stands behind the wall's face.
    const double radius = 0.5 * thick, beside = std::max(0.0, radius + off);
    const double ahead = solid ? std::sqrt(std::max(0.0, radius * radius - beside * beside)) : radius;
    return {planted_body(solid, kZSlide, {-far, 3.5 + off + radius, 6.0}, thick, high),
            way(axes(0), axes(2.0 * far)), 2.0 * far, far - ahead};
  }
  if (kind == 2)  // across the block and the wall of 1 mm
    return {planted_body(solid, kZSlide, {x, -far, 10.0 + off}, thick, high),
            way(axes(0), axes(0, 2.0 * far)), 2.0 * far, far - 0.5 * thick};
  if (kind ==
      3)  // down into the floor of the slot and up again within one way is no straight one: down alone
    return {planted_body(solid, kZSlide, {x, 6.5, 4.0 + far}, thick, high),
            way(axes(0), axes(0, 0, off - far)), far - off, far};
  // A post stands still, the table turns by 360 degrees or more: the block's corner passes at radius 44.72.
  const double radius = std::hypot(40.0, 20.0) + off + 0.5 * thick, turn = rng.uniform(1.5, 5.5);
  const Vec3 foot(radius * std::cos(turn), radius * std::sin(turn), 2.0);
  const double all = rng.uniform() < 0.5 ? kTurn : -2.0 * kTurn;
  return {planted_body(true, kColumn, foot, thick, high), way(axes(0), axes(0, 0, 0, 0, all))};
}

TEST(CollisionProperty, ContactsPlantedInTheStockAsCutAndTheirFreeTwins) {
  const machine::MachineScene scene = toy_machine();
  StockBody stock(scene, Box{Vec3(0, 0, 0), Vec3(40, 20, 10)});
  stock.refresh(walled_block());
  for (int i = 0; i < 100; ++i) {
    const double deep = Rng(i).uniform(1.3, 2.0) * kVoxel, clear = Rng(i).uniform(1.8, 3.0) * kVoxel;
    Rng rng(7000 + i), same(7000 + i);
    const PlantedInStock hit = planted_in_stock(rng, i % 5, -deep);
    ASSERT_EQ(stock.over(hit.body, hit.segment).outcome, StockOutcome::kContact) << "seed " << i;
    const std::array<AxisValues, 2> into{hit.segment.q0, hit.segment.q1};
    ASSERT_EQ(stock.clear_ways(hit.body, into, 0.0), 0U) << "seed " << i;
    const std::optional<StockTouch> touch = stock.first_touch(hit.body, into);
    ASSERT_TRUE(touch && touch->way == 0) << "seed " << i;
    if (hit.way_mm > 0.0) ASSERT_NEAR(touch->at.t_touch * hit.way_mm, hit.free_mm, kVoxel) << "seed " << i;
    const PlantedInStock free = planted_in_stock(same, i % 5, clear);
    const StockOutcome outcome = stock.over(free.body, free.segment).outcome;
    ASSERT_TRUE(outcome == StockOutcome::kClear || outcome == StockOutcome::kClearOfRaw) << "seed " << i;
    const std::array<AxisValues, 2> past{free.segment.q0, free.segment.q1};
    ASSERT_EQ(stock.clear_ways(free.body, past, 0.0), 1U) << "seed " << i;
  }
}

/// The gap to the stock as cut within a voxel of the closed form.
TEST(CollisionProperty, GapsToTheStockAsCutWithinAVoxel) {
  const machine::MachineScene scene = toy_machine();
  StockBody stock(scene, Box{Vec3(0, 0, 0), Vec3(40, 20, 10)});
  stock.refresh(walled_block());
  for (int i = 0; i < 120; ++i) {
    const double gap = Rng(i).uniform(0.05, 0.95) * kVoxel;
    Rng rng(8000 + i);
    const PlantedInStock near = planted_in_stock(rng, i % 5, gap);
    const StockAnswer found = stock.over(near.body, near.segment);
    if (found.outcome == StockOutcome::kClearOfRaw) continue;  // outside the block: told exactly
    ASSERT_NEAR(found.upper, gap, kVoxel) << "seed " << i;
    ASSERT_LE(found.lower, gap + kVoxel) << "seed " << i;
  }
}

}  // namespace
}  // namespace swarf::collision

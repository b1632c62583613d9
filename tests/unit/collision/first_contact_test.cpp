// Contacts that are planted, of every kind of pair, direction and motion, and their free twins: none is
// missed, none is made up, and the first instant is that of the closed form.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "collision/closest_approach.h"
#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

/// A case with a known answer.
struct Planted {
  std::string text;
  Body still, moving;
  AxisSegment segment;
  double contact_t = 0.0;  ///< first instant; above 1: free
  double travel = 1.0;     ///< mm that the place of contact moves over the segment
};

/// Float positions round by this, mm; the closed forms do not know it.
constexpr double kFloat = 2e-5;

Body head_mesh(const TriMesh& mesh) {
  return mesh_body("moving", BodyKind::kLink, kZSlide, mesh);
}
Body floor_mesh(const TriMesh& mesh) {
  return mesh_body("still", BodyKind::kLink, kColumn, mesh);
}

/// A spike whose tip is at `tip` and that widens against `way`.
TriMesh spike(const Vec3& tip, const Vec3& along, double length, double width) {
  const Vec3 x = along.unitOrthogonal(), y = along.cross(x), base = tip - length * along;
  TriMesh mesh;
  const auto add = [&](const Vec3& p) {
    mesh.positions.push_back({float(p.x()), float(p.y()), float(p.z())});
  };
  add(tip);
  for (int i = 0; i < 3; ++i) {
    const double turn = 2.0 * kPi * i / 3.0;
    add(base + width * (std::cos(turn) * x + std::sin(turn) * y));
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  return mesh;
}

/// A spike flies straight at a wall of 0.05 mm or more and through it; free: it passes `gap` above the wall.
Planted straight_at_wall(Rng& rng, bool contact, double gap) {
  const double thick = rng.uniform() < 0.5 ? 0.05 : rng.uniform(0.05, 30.0);
  const double before = rng.uniform(0.5, 200.0), behind = rng.uniform(1.0, 300.0);
  const int axis = static_cast<int>(rng.uniform(0.0, 3.0));
  const double sign = rng.uniform() < 0.5 ? -1.0 : 1.0;
  const int up = (axis + 1) % 3;
  Vec3 low = Vec3::Constant(-20.0), high = Vec3::Constant(20.0);
  low[axis] = std::min(0.0, sign * thick);
  high[axis] = std::max(0.0, sign * thick);
  Vec3 tip = rng.uniform(-5.0, 5.0) * Vec3::Unit((axis + 2) % 3);
  tip[axis] = -sign * before;
  tip[up] = contact ? rng.uniform(-10.0, 10.0) : 20.0 + gap + 0.3;
  Planted one;
  one.still = floor_mesh(box_mesh(low, high));
  one.moving = head_mesh(spike(tip, sign * Vec3::Unit(axis), rng.uniform(1.0, 60.0), 0.3));
  AxisValues to = AxisValues::Zero();
  to[axis] = sign * (before + behind);
  one.segment = way(AxisValues::Zero(), to);
  one.travel = before + behind;
  one.contact_t = contact ? before / one.travel : 2.0;
  one.text = fmt::format("spike along {} at a wall of {} mm", axis, thick);
  return one;
}

/// A box on the table turns about C (or B) until its corner meets a post; free: the post stands `gap`
/// farther.
Planted turning_box(Rng& rng, bool contact, double gap) {
  const bool about_c = rng.uniform() < 0.5;
  const Vec3 axis = about_c ? Vec3::UnitZ() : Vec3::UnitY(), pivot = about_c ? Vec3::Zero() : Vec3(0, 0, -50);
  const double reach = rng.uniform(30.0, 300.0), sign = rng.uniform() < 0.5 ? -1.0 : 1.0;
  // A flat needle from the axis outwards along X; it turns onto a spike whose tip lies on its circle or just
  // off it.
  const double meets = rng.uniform(0.3, 2.5);
  const Vec3 out = about_c ? Vec3(std::cos(meets), sign * std::sin(meets), 0)
                           : Vec3(std::cos(meets), 0, -sign * std::sin(meets));
  const double radius = contact ? reach - rng.uniform(0.05, 5.0) : reach + gap + 1e-4;
  Planted one;
  TriMesh needle;
  const Vec3 end = pivot + reach * Vec3::UnitX();
  const auto add = [&](const Vec3& p) {
    needle.positions.push_back({float(p.x()), float(p.y()), float(p.z())});
  };
  add(pivot + 5.0 * Vec3::UnitX() - 4.0 * axis);
  add(pivot + 5.0 * Vec3::UnitX() + 4.0 * axis);
  add(end - 4.0 * axis);
  add(end + 4.0 * axis);
  needle.triangles = {{0, 1, 3}, {0, 3, 2}};  // a sheet
  one.moving = mesh_body("moving", BodyKind::kFixture, about_c ? kTable : kArm, needle);
  one.still = floor_mesh(spike(pivot + radius * out, -out, 40.0, 1e-4));
  AxisValues to = AxisValues::Zero();
  // A table axis turns its link the other way (ISO 841); about Y a positive turn carries X to -Z.
  const double turn = meets + rng.uniform(0.2, 0.6);
  to[about_c ? kC : kB] = -sign * turn;
  one.segment = way(AxisValues::Zero(), to);
  one.travel = turn * reach;
  one.contact_t = contact ? meets / turn : 2.0;
  one.text = fmt::format("turn about {} at radius {}, spike {} mm inside", about_c ? "C" : "B", reach,
                         reach - radius);
  return one;
}

/// A cylinder of a tool comes down on, or passes, an edge or a point.
Planted tool_at_block(Rng& rng, bool contact, double gap) {
  const double radius = rng.uniform(0.5, 30.0), beside = rng.uniform(-0.95, 0.95) * radius;
  const double from = rng.uniform(radius + 1.0, 200.0), to = rng.uniform(radius + 1.0, 200.0);
  Planted one;
  // The cylinder along Z moves in X past a vertical edge (a sliver that stands at y = beside).
  const double y = contact ? beside : (beside < 0.0 ? -1.0 : 1.0) * (radius + gap + kFloat);
  one.still = floor_mesh(spike(Vec3(0, y, 0), Vec3::UnitZ(), 30.0, 1e-4));
  one.moving = solid_body("moving", BodyKind::kToolPart, kZSlide,
                          {frustum(Vec3(-from, 0, -20), Vec3::UnitZ(), 0.0, 60.0, radius, radius)});
  one.segment = way(AxisValues::Zero(), axes(from + to));
  one.travel = from + to;
  one.contact_t = contact ? (from - std::sqrt(radius * radius - y * y)) / one.travel : 2.0;
  one.text = fmt::format("cylinder of radius {} past a needle {} mm beside its axis", radius, y);
  return one;
}

/// A block slides over a face and grazes a step of a micron or more; free: it slides at a gap.
Planted grazing_step(Rng& rng, bool contact, double gap) {
  const double depth = contact ? 0.001 * std::pow(10.0, rng.uniform(0.0, 2.0)) : -gap - kFloat;
  const double from = rng.uniform(1.0, 100.0);
  Planted one;
  one.still = floor_mesh(box_mesh({0, -50, -10}, {200, 50, 0}));
  one.moving = head_mesh(box_mesh({-from - 20, -20, -depth}, {-from, 20, 20}));
  one.segment = way(AxisValues::Zero(), axes(from + 50.0));
  one.travel = from + 50.0;
  one.contact_t = contact ? from / one.travel : 2.0;
  one.text = fmt::format("block slides {} mm below a face", depth);
  return one;
}

Planted planted(Rng& rng, int kind, bool contact, double gap) {
  switch (kind) {
    case 0:
      return straight_at_wall(rng, contact, gap);
    case 1:
      return turning_box(rng, contact, gap);
    case 2:
      return tool_at_block(rng, contact, gap);
    default:
      return grazing_step(rng, contact, gap);
  }
}

/// What the closed forms leave out: the width of spikes and the rounding of positions, mm.
constexpr double kForm = 1e-3;

void expect_answer(const Planted& one, const std::string& label) {
  const machine::MachineScene scene = toy_machine();
  for (const bool swapped : {false, true}) {
    const Encounter pair =
        swapped ? encounter(scene, one.moving, one.still) : encounter(scene, one.still, one.moving);
    const FirstContact found = first_contact(pair, one.segment);
    ApproachQuery fine;
    fine.tolerance = 1e-4;
    const Approach least = closest_approach(pair, one.segment, fine);
    const bool touches = one.contact_t <= 1.0;
    ASSERT_EQ(found.touches, touches) << label << one.text;
    ASSERT_EQ(least.lower <= 1e-4, touches) << label << one.text;
    if (!touches) continue;
    EXPECT_LE(least.upper, 1e-4) << label << one.text;
    EXPECT_LE((found.t_touch - found.t_free) * one.travel, 0.0101) << label << one.text;
    EXPECT_GE(found.t_touch * one.travel, one.contact_t * one.travel - kForm) << label << one.text;
    EXPECT_LE(found.t_free * one.travel, one.contact_t * one.travel + kForm) << label << one.text;
    EXPECT_NEAR(found.t_touch * one.travel, one.contact_t * one.travel, 0.01 + kForm) << label << one.text;
    EXPECT_LE((found.point_a - found.point_b).norm(), 1.02e-4) << label << one.text;
  }
}

TEST(FirstContact, TwoHundredPlantedAndTheirFreeTwins) {
  for (int i = 0; i < 200; ++i) {
    Rng rng(1000 + i);
    const double gap = 1e-3 * std::pow(10.0, Rng(i).uniform(0.0, 2.0));
    const Planted hit = planted(rng, i % 4, true, gap);
    Rng same(1000 + i);
    const Planted free = planted(same, i % 4, false, gap);
    expect_answer(hit, fmt::format("seed {} contact: ", i));
    expect_answer(free, fmt::format("seed {} free by {}: ", i, gap));
  }
}

TEST(FirstContact, TouchingFromTheStart) {
  const machine::MachineScene scene = toy_machine();
  const Body a = floor_mesh(box_mesh({0, 0, 0}, {10, 10, 10})),
             b = head_mesh(box_mesh({5, 5, 5}, {15, 15, 15}));
  const FirstContact found = first_contact(encounter(scene, a, b), way(axes(0), axes(100)));
  EXPECT_TRUE(found.touches);
  EXPECT_EQ(found.t_free, 0.0);
  EXPECT_LE(found.t_touch, 1e-4);
  // Standing still.
  EXPECT_TRUE(first_contact(encounter(scene, a, b), way(axes(1), axes(1))).touches);
  EXPECT_FALSE(first_contact(encounter(scene, a, b), way(axes(11), axes(11))).touches);
}

TEST(FirstContact, ComesAndLeavesWithinOneWay) {
  // The first of two plates is met, not the thicker second one.
  const machine::MachineScene scene = toy_machine();
  TriMesh plates = box_mesh({10, -5, -5}, {10.05F, 5, 5});
  const TriMesh second = box_mesh({20, -5, -5}, {40, 5, 5});
  for (const auto& t : second.triangles) plates.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  plates.positions.insert(plates.positions.end(), second.positions.begin(), second.positions.end());
  const Body a = floor_mesh(plates), b = head_mesh(box_mesh({-1, -1, -1}, {0, 1, 1}));
  const FirstContact found = first_contact(encounter(scene, a, b), way(axes(0), axes(1000)));
  EXPECT_NEAR(found.t_touch * 1000.0, 10.0, 0.0101);
  const FirstContact back = first_contact(encounter(scene, a, b), way(axes(1000), axes(0)));
  EXPECT_NEAR(back.t_touch * 1000.0, 1000.0 - 41.0, 0.0101);
}

}  // namespace
}  // namespace swarf::collision

// Whatever two bodies look like and however the axes move them: no pose of a dense row contradicts what is
// said of the whole motion, and the answer does not depend on which body is named first nor on the sense of
// time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "collision/closest_approach.h"
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

}  // namespace
}  // namespace swarf::collision

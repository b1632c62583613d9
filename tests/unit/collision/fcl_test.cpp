// The Flexible Collision Library as an oracle that shares no line with ours.
#include <fcl/fcl.h>
#include <gtest/gtest.h>

#include <memory>

#include "collision/closest_approach.h"
#include "unit/collision/brute_distance.h"
#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<FclMesh> fcl_mesh(const Body& body) {
  auto model = std::make_shared<FclMesh>();
  model->beginModel();
  for (const Triangle& t : body.triangles) model->addTriangle(t[0], t[1], t[2]);
  model->endModel();
  return model;
}

/// Distance by FCL; 0 where they meet.
double fcl_distance(const std::shared_ptr<FclMesh>& a, const std::shared_ptr<FclMesh>& b, const Pose& pose) {
  const fcl::CollisionObjectd one(a, Pose::Identity()), other(b, pose);
  const fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return std::max(0.0, fcl::distance(&one, &other, request, result));
}

bool fcl_collides(const std::shared_ptr<FclMesh>& a, const std::shared_ptr<FclMesh>& b, const Pose& pose) {
  const fcl::CollisionObjectd one(a, Pose::Identity()), other(b, pose);
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(&one, &other, request, result) > 0;
}

AxisValues random_place(Rng& rng) {
  return axes(rng.uniform(-30, 30), rng.uniform(-30, 30), rng.uniform(-30, 30), rng.uniform(-1, 1),
              rng.uniform(-3, 3));
}

TEST(FclOracle, DistancesOfMeshesAtRest) {
  const machine::MachineScene scene = toy_machine();
  Rng rng(11);
  int apart = 0, together = 0;
  for (int i = 0; i < 40; ++i) {
    const Body a =
        mesh_body("a", BodyKind::kPart, kTable, bumpy_ball(5.0 * rng.direction(), 20.0, 12, 16, rng));
    const Body b =
        mesh_body("b", BodyKind::kLink, kZSlide, bumpy_ball(30.0 * rng.direction(), 15.0, 10, 14, rng));
    const Encounter pair = encounter(scene, a, b);
    const auto fcl_a = fcl_mesh(a), fcl_b = fcl_mesh(b);
    for (int k = 0; k < 10; ++k) {
      const AxisValues q = random_place(rng);
      const Approach ours = closest_approach(pair, way(q, q));
      const Pose pose = pair.b_from_a.pose(q);
      if (fcl_collides(fcl_a, fcl_b, pose)) {
        EXPECT_LE(ours.upper, 1e-6) << i << ' ' << k;
        ++together;
        continue;
      }
      const double theirs = fcl_distance(fcl_a, fcl_b, pose);
      EXPECT_NEAR(ours.upper, theirs, 1e-3 + 1e-6) << i << ' ' << k;
      EXPECT_LE(ours.lower, theirs + 1e-6) << i << ' ' << k;
      ++apart;
    }
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(together, 50);
}

/// Where ours says that a whole motion is free, FCL finds no pose on it that is not.
TEST(FclOracle, NoPoseOfAFreeMotionCollides) {
  const machine::MachineScene scene = toy_machine();
  Rng rng(12);
  int free = 0;
  for (int i = 0; i < 60; ++i) {
    const Body a =
        mesh_body("a", BodyKind::kPart, kTable, bumpy_ball(5.0 * rng.direction(), 20.0, 8, 12, rng));
    const Body b =
        mesh_body("b", BodyKind::kLink, kZSlide, bumpy_ball(45.0 * rng.direction(), 15.0, 8, 10, rng));
    const Encounter pair = encounter(scene, a, b);
    const AxisSegment segment = way(random_place(rng), random_place(rng));
    const FirstContact found = first_contact(pair, segment);
    const auto fcl_a = fcl_mesh(a), fcl_b = fcl_mesh(b);
    for (int k = 0; k <= 100; ++k) {
      const double t = found.t_free * (1.0 - 1e-9) * k / 100.0;
      if (found.t_free == 0.0) break;
      EXPECT_FALSE(fcl_collides(fcl_a, fcl_b, pair.b_from_a.pose(segment.at(t)))) << i << " at " << t;
    }
    free += found.touches ? 0 : 1;
  }
  EXPECT_GT(free, 10);
}

}  // namespace
}  // namespace swarf::collision

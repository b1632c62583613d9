// A machine without meshes for the tests: X Y Z under the tool, B and C under the work, and meshes of boxes.
#pragma once

#include <array>
#include <vector>

#include "base/rng.h"
#include "base/units.h"
#include "collision/closest_approach.h"

namespace swarf::collision {

enum ToyLink { kColumn, kXSlide, kYSlide, kZSlide, kArm, kTable };
enum ToyAxis { kX, kY, kZ, kB, kC };

inline machine::MachineScene toy_machine() {
  using kinematics::Axis;
  machine::MachineScene scene;
  scene.file = "toy.toml";
  const auto axis = [&](const char* name, kinematics::AxisKind kind, kinematics::Side side, const Vec3& way,
                        const Vec3& origin) {
    Axis one;
    one.name = name;
    one.kind = kind;
    one.side = side;
    one.direction_M = way;
    one.origin_M = origin;
    one.min = -1000.0;
    one.max = 1000.0;
    scene.model.axes.push_back(one);
  };
  using enum kinematics::AxisKind;
  axis("X", kLinear, kinematics::Side::kHead, Vec3::UnitX(), Vec3::Zero());
  axis("Y", kLinear, kinematics::Side::kHead, Vec3::UnitY(), Vec3::Zero());
  axis("Z", kLinear, kinematics::Side::kHead, Vec3::UnitZ(), Vec3::Zero());
  axis("B", kRotary, kinematics::Side::kTable, Vec3::UnitY(), Vec3(0, 0, -50));
  axis("C", kRotary, kinematics::Side::kTable, Vec3::UnitZ(), Vec3::Zero());
  scene.model.head_chain = {kX, kY, kZ};
  scene.model.table_chain = {kB, kC};
  const auto link = [&](const char* name, int parent, int with) {
    machine::Link one;
    one.name = name;
    one.parent = parent;
    one.axis = with;
    scene.links.push_back(one);
  };
  link("column", -1, -1);
  link("x_slide", kColumn, kX);
  link("y_slide", kXSlide, kY);
  link("z_slide", kYSlide, kZ);
  link("arm", kColumn, kB);
  link("table", kArm, kC);
  scene.work_link = kTable;
  scene.tool_link = kZSlide;
  return scene;
}

/// Twelve triangles, outward.
inline TriMesh box_mesh(const Vec3& low, const Vec3& high) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back({static_cast<float>(i & 1 ? high.x() : low.x()),
                              static_cast<float>(i & 2 ? high.y() : low.y()),
                              static_cast<float>(i & 4 ? high.z() : low.z())});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// A ball with bumps, closed; 2 (rings - 1) around triangles.
inline TriMesh bumpy_ball(const Vec3& centre, double radius, int rings, int around, Rng& rng) {
  TriMesh mesh;
  const auto add = [&](double polar, double turn) {
    const double r = radius * rng.uniform(0.8, 1.2);
    const Vec3 p = centre + r * Vec3(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                                     std::cos(polar));
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  };
  add(0.0, 0.0);
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) add(kPi * i / rings, 2.0 * kPi * j / around);
  add(kPi, 0.0);
  const auto at = [&](int i, int j) { return static_cast<uint32_t>(1 + (i - 1) * around + j % around); };
  const auto last = static_cast<uint32_t>(mesh.positions.size() - 1);
  for (int j = 0; j < around; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

inline AxisValues axes(double x, double y = 0.0, double z = 0.0, double b = 0.0, double c = 0.0) {
  AxisValues q;
  q << x, y, z, b, c;
  return q;
}

inline AxisSegment way(const AxisValues& q0, const AxisValues& q1) {
  AxisSegment segment;
  segment.q0 = q0;
  segment.q1 = q1;
  return segment;
}

}  // namespace swarf::collision

#include "sim/job/clamping_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "collision/containment.h"
#include "mesh/mesh_ops.h"

namespace swarf::sim {
namespace {

using collision::Body;
using collision::BodyKind;

/// What rides on the table: the links that nothing moves against it, fixtures, the stock last.
std::vector<Body> bodies_on_table(const Job& job, const TriMesh& stock_W) {
  std::vector<Body> bodies;
  const auto rides = [&](int link) {
    return collision::RelativeMotion(job.machine, job.machine.work_link, link).rigid();
  };
  for (Body& body : collision::link_bodies(job.machine, rides)) {
    if (job.machine.links[static_cast<size_t>(body.link)].fixture) body.kind = BodyKind::kFixture;
    bodies.push_back(std::move(body));
  }
  bodies.push_back(collision::work_body(job.machine, "the stock", BodyKind::kStock, stock_W));
  return bodies;
}

/// How far apart two of them stand; 0 where they touch or overlap.
double gap(const Job& job, const Body& a, const Body& b) {
  const collision::Encounter pair = collision::encounter(job.machine, a, b);
  const collision::AxisSegment still;
  const collision::Approach found = collision::closest_approach(pair, still);
  return collision::one_holds_other(pair, still.q0) ? 0.0 : found.upper;
}

/// Surfaces that cross may have a distance that is not quite 0 (closest_approach.h: its tolerance).
double overlap(const Job& job, const Body& a, const Body& b) {
  if (gap(job, a, b) > kInsideMm) return 0.0;
  const collision::Encounter pair = collision::encounter(job.machine, a, b);
  const collision::BodyDepth in_a(a), in_b(b);
  return collision::deepest_overlap(pair, in_a, in_b, kinematics::AxisValues::Zero()).depth_mm;
}

SourceLocation where_of(const Job& job, const Body& fixture) {
  for (const machine::Fixture& one : job.scene.fixtures)
    if (one.name == fixture.name) return one.where;
  return {job.scene.file};
}

void check_inside(const Job& job, const Body& fixture, const Body& stock, double error_mm,
                  Diagnostics& diagnostics) {
  const double depth = overlap(job, fixture, stock);
  if (depth <= kInsideMm + error_mm) return;
  const std::string after =
      job.earlier.empty()
          ? ""
          : fmt::format(", as the earlier set-ups have left it ({:.3f} mm are allowed for its drawing)",
                        error_mm);
  diagnostics.error("fixture-in-part", where_of(job, fixture),
                    fmt::format("'{}' stands {:.3f} mm inside the stock{}", fixture.name, depth, after),
                    "move it, or the work: fixture.position_mm, setup.work_origin_mm");
}

/// What no axis parts never comes to touch: said here, or nowhere. Keys may stand in the table's slots.
void tell_in_table(const Job& job, const std::vector<Body>& bodies, Diagnostics& diagnostics) {
  for (const Body& fixture : bodies)
    for (const Body& link : bodies) {
      if (fixture.kind != BodyKind::kFixture || link.kind != BodyKind::kLink) continue;
      const double depth = overlap(job, fixture, link);
      if (depth <= kInsideMm) continue;
      diagnostics.warning("fixture-in-table", where_of(job, fixture),
                          fmt::format("'{}' stands {:.3f} mm inside '{}'", fixture.name, depth, link.name),
                          "move it, unless it is a key in a slot: fixture.position_mm");
    }
}

/// Reached from the table over what touches each other.
std::vector<bool> standing(const Job& job, const std::vector<Body>& bodies, double error_mm) {
  std::vector<bool> stands;
  for (const Body& body : bodies) stands.push_back(body.kind == BodyKind::kLink);
  std::vector<bool> known = stands;
  for (bool more = true; more;) {
    more = false;
    for (size_t i = 0; i < bodies.size(); ++i) {
      for (size_t k = 0; k < bodies.size() && !stands[i]; ++k)
        stands[i] = stands[k] && gap(job, bodies[i], bodies[k]) <= kTouchesMm + error_mm;
      more = more || (stands[i] && !known[i]);
      known[i] = stands[i];
    }
  }
  return stands;
}

void tell_holding(const Job& job, const std::vector<Body>& bodies, const std::vector<bool>& stands,
                  double error_mm, Assumptions& assumptions) {
  const Body& stock = bodies.back();
  const auto tell = [&](std::string value, std::string reason, std::string change) {
    assumptions.push_back({"Holding", std::move(value), std::move(reason), std::move(change)});
  };
  for (const Body& body : bodies) {
    const double depth = body.kind == BodyKind::kLink ? overlap(job, body, stock) : 0.0;
    if (depth > kInsideMm + error_mm)
      tell(fmt::format("the stock stands {:.3f} mm inside '{}'", depth, body.name),
           "the work is clamped too low", "setup.work_origin_mm");
  }
  if (stands.back()) return;
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i + 1 < bodies.size(); ++i)
    if (stands[i]) nearest = std::min(nearest, gap(job, bodies[i], stock));
  tell(fmt::format("nothing touches the stock; {:.3f} mm to what is nearest", nearest),
       "no fixture is described that holds it, and none is looked at",
       "[[fixture]] kind = \"vice\", \"clamps\", \"chuck\" or a mesh");
}

/// Meshes of machines are read in mm: one in metres is no larger than a nut.
void check_machine_size(const Job& job, Diagnostics& diagnostics) {
  constexpr double kSmallestMm = 5.0;
  double size = 0.0;
  for (const machine::Link& link : job.machine.links)
    if (!link.fixture && !link.mesh.triangles.empty())
      size = std::max(size, mesh::bounds(link.mesh).size().maxCoeff());
  if (size == 0.0 || size >= kSmallestMm) return;
  diagnostics.warning("machine-size", {job.machine.file},
                      fmt::format("the largest mesh of the machine's links is {:g} mm long: contacts with it "
                                  "mean nothing if it was drawn in another unit",
                                  size),
                      "machine meshes are in mm: scale a mesh in metres by 1000");
}

}  // namespace

void check_clamping(const Job& job, const HeldStock& stock, Diagnostics& diagnostics,
                    Assumptions& assumptions) {
  check_machine_size(job, diagnostics);
  const std::vector<Body> bodies = bodies_on_table(job, stock.mesh_W);
  const bool table =
      std::any_of(bodies.begin(), bodies.end(), [](const Body& b) { return b.kind == BodyKind::kLink; });
  for (const Body& body : bodies)
    if (body.kind == BodyKind::kFixture) check_inside(job, body, bodies.back(), stock.error_mm, diagnostics);
  if (!table || diagnostics.has_errors()) return;
  tell_in_table(job, bodies, diagnostics);
  const std::vector<bool> stands = standing(job, bodies, stock.error_mm);
  for (size_t i = 0; i + 1 < bodies.size(); ++i) {
    if (stands[i]) continue;
    diagnostics.warning(
        "fixture-floats", where_of(job, bodies[i]),
        fmt::format("'{}' touches neither the table nor anything that stands on it", bodies[i].name),
        "move it: fixture.position_mm; a vice, clamps and a chuck stand on the table by themselves");
  }
  tell_holding(job, bodies, stands, stock.error_mm, assumptions);
}

}  // namespace swarf::sim

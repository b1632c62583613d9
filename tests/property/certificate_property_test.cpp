// The proof's bounds against random jobs: designs, cutters and sweeps at random; at random places of each
// design the material is found by an oracle of its own, and no place may lie beyond what was proven.
//
// The oracle knows a cutter as a body of revolution (its distance is written anew below, from radius, corner
// and flute) and a sweep by its definition, a straight line in the tool's frame. The distance is convex and
// so is its course over the sweep: a ternary search finds its least value.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/rng.h"
#include "base/units.h"
#include "measure/certificate.h"
#include "stock/rays/surface_dexels.h"
#include "stock/sweep/sweep_map.h"
#include "unit/measure/test_surfaces.h"

namespace swarf::measure {
namespace {

/// Everything of a case follows from its seed.
struct RandomJob {
  surface::SurfacePtr design;
  Box box{{-4, -4, -4}, {4, 4, 1.5}};
  cutter::Cutter cutter;
  std::vector<stock::Sweep> sweeps;
  double pitch_mm = 0.5, gouge_limit_mm = 0.1, excess_limit_mm = 0.1;
};

Vec3 leaned(Rng& rng, double most_rad) {
  Vec3 axis = Vec3::UnitZ() + std::tan(most_rad) * rng.uniform() * rng.direction();
  return axis.normalized();
}

RandomJob random_job(uint64_t seed) {
  Rng rng(seed);
  RandomJob job;
  job.design = std::make_shared<Paraboloid>(rng.uniform(0.0, 0.06), rng.uniform(0.0, 0.06), 2.0);
  job.pitch_mm = rng.uniform(0.1, 0.7);
  job.excess_limit_mm = rng.uniform(0.05, 1.0);
  cutter::Cutter& c = job.cutter;
  c.diameter_mm = rng.uniform(2.0, 10.0);
  c.flute_length_mm = 20.0;
  const uint64_t kind = rng.next() % 3;
  c.shape = kind == 0 ? cutter::Shape::kFlat : kind == 1 ? cutter::Shape::kBall : cutter::Shape::kBullNose;
  c.corner_radius_mm = kind == 0 ? 0.0 : (kind == 1 ? 0.5 : rng.uniform(0.1, 0.45)) * c.diameter_mm;
  c.shank_diameter_mm = c.diameter_mm;
  const auto place = [&] {
    const double u = rng.uniform(-0.1, 1.1), v = rng.uniform(-0.1, 1.1);
    return Vec3(job.design->point(u, v) + Vec3(0, 0, rng.uniform(-0.2, 0.4)));
  };
  const auto count = static_cast<uint32_t>(2 + rng.next() % 6);
  Vec3 from = place(), axis = leaned(rng, 0.4);
  for (uint32_t n = 0; n < count; ++n) {
    const Vec3 to = place(), next = rng.next() % 2 == 0 ? axis : leaned(rng, 0.4);
    job.sweeps.push_back({{from, axis}, {to, next}, n});
    from = to;
    axis = next;
  }
  return job;
}

/// Distance of a point of the tool's frame from the flutes, negative inside: never above the true one.
double flute_distance(const Vec3& X, const cutter::Cutter& c) {
  const double R = 0.5 * c.diameter_mm, r = c.corner_radius_mm, rho = X.head<2>().norm();
  const double corner = rho > R - r && X.z() < r ? std::hypot(rho - (R - r), r - X.z()) - r
                                                 : -std::numeric_limits<double>::infinity();
  return std::max({rho - R, -X.z(), X.z() - c.flute_length_mm, corner});
}

double least_distance(const Vec3& p, const stock::SweepMap& map, const cutter::Cutter& cutter) {
  const Vec3 start = map.start(p), way = map.end(p) - start;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 70; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (flute_distance(start + a * way, cutter) < flute_distance(start + b * way, cutter) ? high : low) =
        flute_distance(start + a * way, cutter) < flute_distance(start + b * way, cutter) ? b : a;
  }
  return flute_distance(start + 0.5 * (low + high) * way, cutter);
}

double removed_by(const Vec3& p, const std::vector<stock::SweepMap>& maps, const cutter::Cutter& cutter) {
  double least = std::numeric_limits<double>::infinity();
  for (const stock::SweepMap& map : maps) least = std::min(least, least_distance(p, map, cutter));
  return least;
}

Certificate prove(const RandomJob& job) {
  const stock::CutterSolid solid(job.cutter);
  stock::Stock stock(job.box, 0.4);
  stock.cut(job.sweeps, solid);
  const stock::RayFieldPtr field = stock::rays_on_surface(job.design, job.pitch_mm);
  stock::SurfaceDexels dexels(field, job.box, {});
  dexels.cut(job.sweeps, solid);
  double highest = 0.0;
  for (const double height : dexels.heights_mm()) highest = std::max(highest, height);
  const stock::FreeRange ranges({&field, 1});
  const SweepCutters cutters(solid);
  Progress progress;
  return certify({*field, ranges, job.sweeps, cutters, 0.0, stock, 0.0, job.gouge_limit_mm,
                  job.excess_limit_mm, false, false, job.excess_limit_mm, 0.0, highest, progress});
}

/// What the oracle finds at random places: points that the tool has passed below the design, points of the
/// box that it has not above it. Points within a nanometre of a sweep's surface are left out: rounding
/// decides there.
struct Truth {
  double deepest_mm = 0.0, highest_mm = 0.0;
};
Truth look(const RandomJob& job, uint64_t seed, int places) {
  constexpr double kRounding = 1e-6;
  std::vector<stock::SweepMap> maps;
  for (const stock::Sweep& sweep : job.sweeps) maps.push_back(stock::sweep_map(sweep));
  Rng rng(seed + 1000003);
  Truth truth;
  for (int n = 0; n < places; ++n) {
    const double u = rng.uniform(), v = rng.uniform(), height = rng.uniform(-0.95, 1.2);
    const surface::Derivatives d = job.design->derivatives(u, v);
    const Vec3 p = d.S + height * outward_normal(*job.design, d);
    if ((p.array() < job.box.lower.array()).any() || (p.array() > job.box.upper.array()).any()) continue;
    const double distance = removed_by(p, maps, job.cutter);
    if (distance < -kRounding) truth.deepest_mm = std::max(truth.deepest_mm, -height);
    if (distance > kRounding) truth.highest_mm = std::max(truth.highest_mm, height);
  }
  return truth;
}

/// The limit of gouges lies little above what the oracle has found, so that the proof works where it is
/// tight.
void expect_proven(uint64_t seed, int places) {
  RandomJob job = random_job(seed);
  const Truth truth = look(job, seed, places);
  job.gouge_limit_mm = truth.deepest_mm + Rng(seed + 7).uniform(0.1, 0.2);
  const Certificate proof = prove(job);
  const std::string where = fmt::format("expect_proven({}, {});", seed, places);
  EXPECT_LE(1e3 * truth.deepest_mm, proof.gouge.um) << where;
  EXPECT_LE(1e3 * truth.highest_mm, proof.excess.um) << where;
  EXPECT_LE(proof.gouge_found_um, proof.gouge.um) << where;
  EXPECT_LE(proof.excess_found_um, proof.excess.um) << where;
  EXPECT_LE(proof.scallop.um, proof.excess.um) << where;
}

// SWARF_PROPERTY_CASES=1000 for a long night.
TEST(CertificateProperty, NoPlaceLiesBeyondTheBounds) {
  const char* text = std::getenv("SWARF_PROPERTY_CASES");
  const uint64_t cases = text == nullptr ? 40 : std::strtoull(text, nullptr, 10);
  for (uint64_t seed = 1; seed <= cases; ++seed) {
    expect_proven(seed, 4000);
    if (HasFailure()) break;
  }
}

}  // namespace
}  // namespace swarf::measure

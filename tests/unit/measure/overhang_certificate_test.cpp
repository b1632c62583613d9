// The proof where cutters with short flutes clear a column layer by layer, or leave a roof above a gap. Exact
// heights follow from the sweeps; elsewhere rays far denser than the cells are the oracle.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "base/angles.h"
#include "base/rng.h"
#include "base/units.h"
#include "measure/certificate.h"
#include "mesh/plain_solids.h"
#include "mesh/signed_distance.h"
#include "stock/rays/surface_dexels.h"
#include "surface/analytic.h"

namespace swarf::measure {
namespace {

/// More would be cells that nothing closes.
constexpr size_t kFewCells = 300'000;

struct Undercut {
  stock::RayFieldPtr field;
  Box box{{-10, -5, -5}, {10, 5, 3}};
  stock::CutterSolid cutter{4.0, 1.0};
  double voxel_mm = 0.25;
  std::vector<stock::Sweep> sweeps;
};

void row(Undercut& job, double x, double z, const Vec3& axis = Vec3::UnitZ()) {
  job.sweeps.push_back({{{x, -12, z}, axis}, {{x, 12, z}, axis}, static_cast<uint32_t>(job.sweeps.size())});
}

stock::RayFieldPtr plane_rays(double pitch) {
  return stock::rays_on_surface(
      std::make_shared<surface::PlaneSurface>(Vec3(-9.9, -4.8, 0), Vec3(19.8, 0, 0), Vec3(0, 9.6, 0)), pitch);
}

/// Flutes of 1 mm face a block 3 mm above the plane, but for what stands beyond x = 8: a roof from z = 1 on,
/// passed under from the right, and a neck up to 8.5 that holds it.
Undercut slab() {
  Undercut job;
  job.field = plane_rays(0.4);
  row(job, 12.5, 0.0);
  for (const double z : {2.0, 1.0, 0.0})
    for (double x = -8.0; x <= 4.0; x += 4.0) row(job, x, z);
  row(job, 4.5, 2.0);
  return job;
}

stock::SurfaceDexels rays_of(const Undercut& job, const stock::RayFieldPtr& field) {
  const stock::FreeRange ranges({&field, 1});
  std::vector<double> mm;
  for (size_t n = 0; n < field->size(); ++n) mm.push_back(ranges(field->points[n], field->normals[n]).mm);
  stock::SurfaceDexels dexels(field, job.box, mm);
  dexels.cut(job.sweeps, job.cutter);
  return dexels;
}

/// The highest material on each ray, above gaps too.
std::vector<double> tops_of(const stock::SurfaceDexels& dexels) {
  std::vector<double> tops = dexels.heights_mm();
  dexels.each_above([&](uint32_t n, const stock::MaterialAbove& m) {
    if (m.high - m.low >= stock::kSliver) tops[n] = std::max(tops[n], m.high);
  });
  return tops;
}

double highest_of(const stock::SurfaceDexels& dexels) {
  const std::vector<double> tops = tops_of(dexels);
  return std::max(0.0, *std::max_element(tops.begin(), tops.end()));
}

double area_above(const stock::SurfaceDexels& dexels, double limit_mm) {
  const std::vector<double> tops = tops_of(dexels);
  double area = 0.0;
  for (size_t n = 0; n < tops.size(); ++n)
    if (tops[n] > limit_mm) area += dexels.field().areas_mm2[n];
  return area;
}

double told_area(const Certificate& proof) {
  double area = 0.0;
  for (const Region& region : proof.excesses) area += region.area_mm2;
  return area;
}

Certificate proven(const Undercut& job, double limit_mm) {
  stock::Stock stock(job.box, job.voxel_mm);
  stock.cut(job.sweeps, job.cutter);
  const stock::FreeRange ranges({&job.field, 1});
  const SweepCutters cutters(job.cutter);
  Progress progress;
  return certify({.field = *job.field,
                  .ranges = ranges,
                  .sweeps = job.sweeps,
                  .cutters = cutters,
                  .stock = stock,
                  .excess_limit_mm = limit_mm,
                  .wants_excess = true,
                  .excess_known_mm = highest_of(rays_of(job, job.field)),
                  .progress = progress});
}

/// Highest `top_um`, and as much of the plane under it and what else stands too high as `area_mm2`, within a
/// share: how wide a roof is that many sweeps pass by, the lesser budget tells no closer.
void expect_broken(const Certificate& proof, double top_um, double area_mm2, double share = 0.02) {
  EXPECT_NEAR(proof.excess_found_um, top_um, 0.01);
  EXPECT_GE(proof.excess.um, proof.excess_found_um);
  EXPECT_EQ(proof.open_cells, 0U);
  EXPECT_LT(proof.cells, kFewCells);
  ASSERT_FALSE(proof.excesses.empty());
  EXPECT_NEAR(proof.excesses[0].worst_um, top_um, 0.01);
  EXPECT_NEAR(told_area(proof), area_mm2, share * area_mm2);
}

void expect_kept(const Certificate& proof, double top_um, double limit_mm) {
  EXPECT_LE(proof.excess_found_um, top_um + 0.01);
  EXPECT_GE(proof.excess.um, top_um - 0.01);
  EXPECT_LE(proof.excess.um, um_from_mm(limit_mm) + 1e-6);
  EXPECT_EQ(proof.open_cells, 0U);
  EXPECT_TRUE(proof.excesses.empty());
  EXPECT_LT(proof.cells, kFewCells);
}

// Did not end within minutes: below the flutes of the lowest pass no single sweep covers a column up to air.
TEST(Overhang, ASlabBreaksALimitBelowItsTop) {
  expect_broken(proven(slab(), 0.1), 3000.0, 1.9 * 9.6);
}

TEST(Overhang, ASlabKeepsALimitAboveItsTop) {
  expect_kept(proven(slab(), 3.01), 3000.0, 3.01);
}

// A limit above the gap's 1 mm and below the neck's 2 mm: flutes that pass beside the neck end below the
// limit.
TEST(Overhang, TheAreaOfASlabHoldsTheNeckUnderIt) {
  for (const double limit : {1.0, 1.5, 1.99}) expect_broken(proven(slab(), limit), 3000.0, 1.9 * 9.6, 0.005);
  for (const double limit : {2.01, 2.9}) expect_broken(proven(slab(), limit), 3000.0, 1.4 * 9.6, 0.005);
}

// Its top is milled down to 2.6 mm, less than a voxel below the limit.
TEST(Overhang, AMilledRoofKeepsALimitCloseAboveIt) {
  Undercut job = slab();
  row(job, 8.0, 2.6);
  expect_kept(proven(job, 2.61), 2600.0, 2.61);
  expect_broken(proven(job, 2.4), 2600.0, 1.4 * 9.6);
}

// Layers that end in each other's planes leave nothing: a limit is proven without a roof, too.
TEST(Overhang, LayersOfShortFlutesLeaveNothing) {
  for (const double voxel : {0.25, 0.37}) {
    Undercut job;
    job.voxel_mm = voxel;
    job.field = plane_rays(0.4);
    for (const double z : {2.0, 1.0, 0.0})
      for (double x = -9.0; x <= 9.0; x += 3.0) row(job, x, z);
    expect_kept(proven(job, 0.01), 0.0, 0.01);
  }
}

TEST(Overhang, ATiltedRoof) {
  Undercut job;
  job.field = plane_rays(0.4);
  const double tilt = rad_from_deg(10.0);
  for (const double z : {2.0, 1.0, 0.0})
    for (double x = -8.0; x <= 0.0; x += 4.0) row(job, x, z);
  // Passes under what stands beyond x = 4, leaning: the disc's left rim comes down to z = 0.
  row(job, 8.0 + 4.0 * (std::cos(tilt) - 1.0), 4.0 * std::sin(tilt),
      Vec3(-std::sin(tilt), 0, std::cos(tilt)));
  const Certificate proof = proven(job, 0.1);
  EXPECT_NEAR(proof.excess_found_um, 3000.0, 0.01);
  EXPECT_GE(proof.excess.um, 3000.0 - 0.01);
  EXPECT_LT(proof.cells, kFewCells);
  expect_kept(proven(job, 3.01), 3000.0, 3.01);
}

// Two roofs .2 and .15 mm thick, one above the other, with gaps of .05 mm: all less than a voxel.
TEST(Overhang, TwoThinRoofs) {
  Undercut job;
  job.field = plane_rays(0.4);
  job.cutter = stock::CutterSolid(4.0, 0.05);
  for (int layer = 0; layer < 60; ++layer)
    for (double x = -8.0; x <= 4.0; x += 4.0) row(job, x, 0.05 * layer);
  for (const double z : {0.0, 0.25}) row(job, 12.5, z);
  for (int layer = 9; layer < 60; ++layer) row(job, 9.0, 0.05 * layer);
  expect_broken(proven(job, 0.1), 450.0, 1.9 * 9.6, 0.06);
  expect_kept(proven(job, 0.5), 450.0, 0.5);
}

/// Everything of a case follows from its seed: flutes of .2 to 2 mm, rows at heights that are multiples of
/// their length or any, some leaning, in any order.
Undercut random_job(uint64_t seed) {
  Rng rng(seed);
  Undercut job;
  job.box = {{-4, -4, -2}, {4, 4, rng.uniform(0.5, 2.5)}};
  job.voxel_mm = rng.uniform(0.2, 0.6);
  job.field = stock::rays_on_surface(
      std::make_shared<surface::PlaneSurface>(Vec3(-3, -3, 0), Vec3(6, 0, 0), Vec3(0, 6, 0)),
      rng.uniform(0.3, 1.5));
  const double flute = rng.uniform(0.2, 2.0);
  job.cutter = stock::CutterSolid(rng.uniform(0.5, 3.0), flute);
  const auto count = static_cast<int>(3 + rng.next() % 20);
  for (int n = 0; n < count; ++n) {
    const double z =
        rng.next() % 3 == 0 ? rng.uniform(0.0, 2.0) : flute * static_cast<double>(rng.next() % 5);
    const double lean = rng.next() % 4 == 0 ? rng.uniform(-0.3, 0.3) : 0.0;
    const Vec3 axis(std::sin(lean), 0, std::cos(lean));
    const double x = rng.uniform(-4.0, 4.0), to = rng.next() % 2 == 0 ? x : rng.uniform(-4.0, 4.0);
    // A leaning disc keeps above the plane.
    const double lift = job.cutter.radius * std::abs(std::sin(lean));
    job.sweeps.push_back({{{x, -8, z + lift}, axis}, {{to, 8, z + lift}, axis}, static_cast<uint32_t>(n)});
  }
  return job;
}

/// So many from the first on, unless SWARF_FIRST_OVERHANG and SWARF_RANDOM_OVERHANGS say otherwise.
std::vector<uint64_t> seeds(uint64_t first, size_t count) {
  if (const char* const asked = std::getenv("SWARF_FIRST_OVERHANG"))
    first = std::strtoull(asked, nullptr, 10);
  if (const char* const asked = std::getenv("SWARF_RANDOM_OVERHANGS"))
    count = std::strtoull(asked, nullptr, 10);
  std::vector<uint64_t> all(count);
  std::iota(all.begin(), all.end(), first);
  return all;
}

TEST(Overhang, DenseRaysOfRandomJobsStayWithinTheBounds) {
  for (const uint64_t seed : seeds(1, 4)) {
    const Undercut job = random_job(seed);
    const stock::SurfaceDexels dense = rays_of(job, stock::rays_on_surface(job.field->surface, 0.03));
    const double highest = highest_of(dense);
    Rng rng(seed);
    for (const double limit : {0.05, highest + 0.01, rng.uniform(0.1, 2.0)}) {
      const Certificate proof = proven(job, limit);
      const std::string where =
          fmt::format("SWARF_FIRST_OVERHANG={} SWARF_RANDOM_OVERHANGS=1, limit {} mm, {} cells, {} open",
                      seed, limit, proof.cells, proof.open_cells);
      EXPECT_GE(proof.excess.um, um_from_mm(highest) - 0.01) << where;
      EXPECT_LE(proof.excess_found_um, proof.excess.um) << where;
      EXPECT_LT(proof.cells, 2'000'000U) << where;
      // Rays know an outline of some 20 mm to half their pitch.
      EXPECT_NEAR(told_area(proof), area_above(dense, limit), 0.3) << where;
      const bool proven = proof.open_cells == 0 && proof.excess.um <= um_from_mm(limit);
      const bool broken = proof.excess_found_um > um_from_mm(limit);
      EXPECT_FALSE(proven && (broken || highest > limit)) << where;
      if (!proven && !broken)
        fmt::print("undecided: {}, bound {} um, rays {} um\n", where, proof.excess.um, um_from_mm(highest));
    }
  }
}

/// A slot along Y, from its mouth down: half widths and how deep each of them goes.
struct Slot {
  double mouth = 2.0, undercut = 4.0, roof = -2.0, floor = -3.0;
};

TriMesh slot_mesh(const Slot& slot) {
  TriMesh mesh;
  EXPECT_TRUE(mesh::add_prism(mesh,
                              {{-6, -5},
                               {6, -5},
                               {6, 0},
                               {slot.mouth, 0},
                               {slot.mouth, slot.roof},
                               {slot.undercut, slot.roof},
                               {slot.undercut, slot.floor},
                               {-slot.undercut, slot.floor},
                               {-slot.undercut, slot.roof},
                               {-slot.mouth, slot.roof},
                               {-slot.mouth, 0},
                               {-6, 0}},
                              -2, 2));
  for (auto& p : mesh.positions) p = {p[0], -p[2], p[1]};
  return mesh;
}

/// Flutes of 1 mm as wide as the slot's mouth; `left` stands at one side of the undercut.
Undercut milled_slot(double left) {
  Undercut job;
  job.box = {{-6, -2, -5}, {6, 2, 0}};
  job.cutter = stock::CutterSolid(2.0, 1.0);
  job.field = stock::rays_on_mesh(slot_mesh({}), 0.5);
  row(job, 0.0, -1.0);
  row(job, 0.0, -2.0);
  for (double x = -2.0; x <= 2.0; x += 1.0) row(job, std::min(x, 2.0 - left), -3.0);
  return job;
}

// Columns from its corners and edges run along faces of the stock, its sides across the seam of two flutes,
// where no one sweep clears a cell. Heights of a mesh count while the place is about the nearest
// (kOwnShareLeaning).
TEST(Overhang, AnUndercutSlotOfAMesh) {
  for (const double left : {0.0, 0.4}) {
    Undercut job = milled_slot(left);
    if (left > 0.0) row(job, 0.0, -0.9);
    const Certificate kept = proven(job, 0.5);
    EXPECT_LE(kept.excess_found_um, um_from_mm(left) / stock::kOwnShareLeaning + 0.01);
    EXPECT_GE(kept.excess.um, um_from_mm(left));
    EXPECT_LE(kept.excess.um, 500.0);
    EXPECT_EQ(kept.open_cells, 0U);
    EXPECT_TRUE(kept.excesses.empty());
    EXPECT_LT(kept.cells, kFewCells / 4);
  }
  const Certificate broken = proven(milled_slot(0.4), 0.1);
  EXPECT_GE(broken.excess_found_um, 400.0);
  EXPECT_LE(broken.excess_found_um, 400.0 / stock::kOwnShareLeaning + 0.01);
  EXPECT_GE(broken.excess.um, broken.excess_found_um);
  EXPECT_FALSE(broken.excesses.empty());
}

/// Everything follows from the seed: a slot, flutes that fit into its mouth, and passes of which some may
/// lack.
struct RandomSlot {
  TriMesh mesh;
  Undercut job;
};
RandomSlot random_slot(uint64_t seed) {
  Rng rng(seed);
  Slot slot;
  slot.mouth = rng.uniform(1.0, 2.5);
  slot.undercut = slot.mouth + rng.uniform(0.3, 2.0);
  slot.roof = -rng.uniform(0.5, 2.0);
  slot.floor = slot.roof - rng.uniform(0.4, 1.5);
  RandomSlot random{slot_mesh(slot), {}};
  Undercut& job = random.job;
  job.box = {{-6, -2, -5}, {6, 2, rng.next() % 2 == 0 ? 0.0 : 0.3}};
  if (rng.next() % 3 == 0) job.box.upper.y() = 2.5;
  job.voxel_mm = rng.uniform(0.2, 0.6);
  job.field = stock::rays_on_mesh(random.mesh, rng.uniform(0.3, 0.8));
  const double radius = slot.mouth * (rng.next() % 2 == 0 ? 1.0 : rng.uniform(0.5, 1.0));
  job.cutter = stock::CutterSolid(radius, slot.roof - slot.floor);
  const auto passes = [&](double half_width, double z) {
    const double reach = half_width - radius;
    const int count = 1 + static_cast<int>(2.0 * reach / radius);
    for (int n = 0; n <= count; ++n)
      if (rng.next() % 12 != 0) row(job, reach * (2.0 * n / count - 1.0), z);
  };
  for (double z = slot.floor; z < 0.0; z += job.cutter.height) passes(slot.mouth, z);
  passes(slot.undercut, slot.floor);
  for (double x = -6.0; x <= 6.0; x += radius) row(job, x, 0.0);
  return random;
}

/// Farther from the design than this there is material, by places that no pass reaches: rows along Y of an
/// upright cylinder are boxes.
double farthest_material(const RandomSlot& slot, uint64_t seed) {
  const mesh::SignedDistance design(slot.mesh);
  const Undercut& job = slot.job;
  Rng rng(seed);
  double farthest = 0.0;
  for (int n = 0; n < 20'000; ++n) {
    const Vec3 p(rng.uniform(job.box.lower.x(), job.box.upper.x()),
                 rng.uniform(job.box.lower.y(), job.box.upper.y()), rng.uniform(-4.0, job.box.upper.z()));
    const bool cut = std::any_of(job.sweeps.begin(), job.sweeps.end(), [&](const stock::Sweep& sweep) {
      const Vec3 at = p - sweep.start.tip_W;
      return std::abs(at.x()) <= job.cutter.radius && at.z() >= 0.0 && at.z() <= job.cutter.height;
    });
    if (!cut) farthest = std::max(farthest, design.at(p).distance_mm);
  }
  return farthest;
}

TEST(Overhang, NoPlaceOfMaterialIsFartherFromARandomSlotThanIsProven) {
  int kept = 0;
  for (const uint64_t seed : seeds(3, 2)) {
    const RandomSlot slot = random_slot(seed);
    const double farthest = farthest_material(slot, seed);
    for (const double limit : {0.1, 1.2 * farthest + 0.05}) {
      const Certificate proof = proven(slot.job, limit);
      const std::string where =
          fmt::format("SWARF_FIRST_OVERHANG={} SWARF_RANDOM_OVERHANGS=1, limit {} mm, {} cells, {} open",
                      seed, limit, proof.cells, proof.open_cells);
      EXPECT_GE(proof.excess.um, um_from_mm(farthest)) << where;
      EXPECT_LE(proof.excess_found_um, proof.excess.um) << where;
      if (proof.open_cells == 0 && proof.excess.um <= um_from_mm(limit)) ++kept;
    }
  }
  EXPECT_GE(kept, std::getenv("SWARF_RANDOM_OVERHANGS") != nullptr ? 0 : 2)
      << "a bound that is never close proves nothing";
}

}  // namespace
}  // namespace swarf::measure

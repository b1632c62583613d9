#include "sim/run/prove_part.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/units.h"
#include "proof/gouge_bound.h"
#include "proof/leftover_bound.h"
#include "proof/missing_bound.h"
#include "sim/run/result.h"
#include "sim/run/tile_ranks.h"

namespace swarf::sim {
namespace {

void raise(std::optional<measure::Bound>& bound, const measure::Bound& by) {
  if (!bound || by.um > bound->um) bound = by;
}

/// What rays found beyond a proven bound was no cut of that depth: a leaning ray of a mesh that ran along it.
/// True where what the proof found takes its place.
bool settle(double& value_um, uint32_t& block, double found_um, uint32_t found_block,
            const measure::Bound& bound) {
  if (value_um > bound.um) value_um = 0.0;
  if (found_um <= value_um) return false;
  value_um = found_um;
  block = found_block;
  return true;
}

void take_over(const measure::Certificate& proof, measure::SurfaceMetrics& surface) {
  raise(surface.gouge_bound, proof.gouge);
  raise(surface.excess_bound, proof.excess);
  raise(surface.scallop_bound, proof.scallop);
  surface.unmeasured_area_mm2 += proof.open_area_mm2;
  surface.gouges.insert(surface.gouges.end(), proof.gouges.begin(), proof.gouges.end());
  surface.excesses.insert(surface.excesses.end(), proof.excesses.begin(), proof.excesses.end());
}

/// The worst first, no more than are listed; their number.
size_t keep_worst(std::vector<measure::Region>& regions) {
  std::stable_sort(regions.begin(), regions.end(), [](const measure::Region& a, const measure::Region& b) {
    return a.worst_um > b.worst_um;
  });
  const size_t count = regions.size();
  if (count > measure::kListedRegions) regions.resize(measure::kListedRegions);
  return count;
}

/// What the proof does not see: how far the sweeps stray, and the strip beside curved edges of a CAD file's
/// faces, whose places are no farther from the places that it sees.
double unseen_mm(const MeasuredPath& path, const stock::RayField& field) {
  const bool faces = field.design != nullptr && field.design->under != nullptr;
  return path.rays.error_bound_mm + (faces ? field.design->under->edge_mm : 0.0);
}

std::vector<stock::RayFieldPtr> fields_of(const MeasuredPath& path) {
  std::vector<stock::RayFieldPtr> fields;
  for (const stock::SurfaceDexels& dexels : path.dexels) fields.push_back(dexels.field_ptr());
  return fields;
}

/// Regions that lie wholly beyond a proven bound come from columns that lean.
void drop_beyond(std::vector<measure::Region>& regions, double bound_um) {
  std::erase_if(regions, [&](const measure::Region& region) { return region.worst_um > bound_um; });
}

/// What a proof has found deeper or higher than the rays is a place of its own, of unknown area.
void add_found(std::vector<measure::Region>& regions, const measure::Region& found, double limit_um) {
  if (!(found.worst_um > limit_um)) return;
  const bool known = std::any_of(regions.begin(), regions.end(), [&](const measure::Region& region) {
    return region.worst_um >= found.worst_um * (1.0 - 1e-3);
  });
  if (!known) regions.insert(regions.begin(), found);
}

void take_gouges(const proof::GougeBound& proven, double slack_mm, double limit_um,
                 measure::SurfaceMetrics& surface) {
  surface.gouge_bound = {um_from_mm(proven.bound_mm + slack_mm), proven.place};
  drop_beyond(surface.gouges, surface.gouge_bound->um);
  if (settle(surface.gouge_max_um, surface.gouge_block, um_from_mm(proven.found_mm), proven.sweep,
             *surface.gouge_bound))
    surface.gouge_bottom = proven.bottom;
  add_found(surface.gouges,
            {um_from_mm(proven.found_mm), 0.0, 0.0, proven.foot, proven.sweep, 0, 0, proven.bottom},
            limit_um);
}

/// The block of the listed region that is nearest to a place; kUncut where none is listed.
uint32_t block_near(const std::vector<measure::Region>& regions, const Vec3& place) {
  uint32_t block = stock::kUncut;
  double least = std::numeric_limits<double>::infinity();
  for (const measure::Region& region : regions) {
    const double distance = (region.place - place).norm();
    if (distance >= least) continue;
    least = distance;
    block = region.block;
  }
  return block;
}

void take_leftover(const proof::LeftoverBound& proven, double slack_mm, double limit_um,
                   measure::SurfaceMetrics& surface) {
  surface.excess_bound = {um_from_mm(proven.bound_mm + slack_mm), proven.place};
  surface.unmeasured_area_mm2 += proven.open_area_mm2;
  drop_beyond(surface.excesses, surface.excess_bound->um);
  const uint32_t block = block_near(surface.excesses, proven.foot);
  if (settle(surface.excess_max_um, surface.excess_block, um_from_mm(proven.found_mm), block,
             *surface.excess_bound))
    surface.excess_top = proven.top;
  add_found(surface.excesses, {um_from_mm(proven.found_mm), 0.0, 0.0, proven.foot, block, 0, 0, proven.top},
            limit_um);
}

/// How far a design reaches out of a block: nothing that the block lacks lies deeper below the design, for
/// that far away the design ends.
double out_of_block(const TriMesh& design, const Box& block) {
  double most = 0.0;
  for (const auto& p : design.positions) {
    const Vec3 at(p[0], p[1], p[2]);
    most = std::max({most, (block.lower - at).maxCoeff(), (at - block.upper).maxCoeff()});
  }
  return most;
}

/// Whether the part is of the kind that its sweeps and features prove: a body of not too many facets in a
/// block.
bool is_provable_body(const Job& job, const stock::RawShape& raw, double slack_mm) {
  constexpr size_t kMostFacets = 200'000;
  const AcceptLimits& accept = job.scene.accept;
  const TriMesh* mesh = job.proof.mesh.get();
  if (mesh == nullptr || mesh->triangles.size() > kMostFacets || !raw.is_box()) return false;
  const double gouge_mm = accept.gouge_max_um.value_or(kGougeAllowed) * kMicrometre;
  const double excess_mm = accept.excess_max_um.value_or(kExcessAllowed) * kMicrometre;
  return std::min(gouge_mm, excess_mm) > slack_mm && out_of_block(*mesh, raw.box()) < gouge_mm - slack_mm;
}

bool is_decided(double value_um, const std::optional<measure::Bound>& bound, std::optional<double> limit_um) {
  return !limit_um || value_um > *limit_um || (bound && bound->um <= *limit_um);
}

/// What rays have found is told as the distance to the design: columns that lean beside an edge measure more.
void tell_distances(const proof::SolidDesign& design, measure::SurfaceMetrics& surface) {
  const auto lower = [&](double& value_um, double distance_mm) {
    value_um = std::min(value_um, um_from_mm(std::max(0.0, distance_mm) + design.chord_mm()));
  };
  if (surface.excess_max_um > 0.0)
    lower(surface.excess_max_um, design.distance().at(surface.excess_top).distance_mm);
  if (surface.gouge_max_um > 0.0 && surface.gouge_block != stock::kUncut)
    lower(surface.gouge_max_um, -design.distance().at(surface.gouge_bottom).distance_mm);
}

/// The proof of a design that is a body, by its sweeps and its features. False: what is asked for is not
/// decided.
bool prove_body(const Job& job, Progress& progress, Result& result) {
  MeasuredPath& main = result.main;
  const AcceptLimits& accept = job.scene.accept;
  constexpr double kRounding = 2e-6;  // mm: a touch of both proofs
  const double slack = job.proof.chord_mm + main.rays.error_bound_mm + kRounding;
  const stock::RawShape& raw = result.stock->raw();
  if (!is_provable_body(job, raw, slack)) return false;
  const double gouge_um = accept.gouge_max_um.value_or(kGougeAllowed);
  const double excess_um = accept.excess_max_um.value_or(accept.scallop_max_um.value_or(kExcessAllowed));
  const RayCutters rays = ray_cutters(job, main);
  const measure::SweepCutters cutters(rays.solids, rays.solid_of);
  const proof::SolidDesign design(*job.proof.mesh, job.proof.chord_mm);
  measure::SurfaceMetrics& surface = main.surface;
  tell_distances(design, surface);
  progress.begin("prove", 2.0, "sides");
  proof::GougeBound gouges =
      proof::bound_gouges({design, main.rays.sweeps, cutters, gouge_um * kMicrometre - slack,
                           surface.gouge_max_um * kMicrometre, progress});
  gouges.bound_mm = std::max(gouges.bound_mm, out_of_block(*job.proof.mesh, raw.box()));
  progress.advance(1.0);
  const proof::LeftoverBound leftover = proof::bound_leftover(
      {design, main.rays.sweeps, cutters, *result.stock, result.sweep_bound_mm,
       excess_um * kMicrometre - slack, surface.excess_max_um * kMicrometre, progress, 1.0});
  progress.end();
  if (progress.stop_requested()) return true;
  take_gouges(gouges, slack, gouge_um, surface);
  take_leftover(leftover, slack, excess_um, surface);
  surface.gouge_regions = keep_worst(surface.gouges);
  surface.excess_regions = keep_worst(surface.excesses);
  if (accept.scallop_max_um && surface.excess_bound->um <= *accept.scallop_max_um)
    surface.scallop_bound = surface.excess_bound;
  return is_decided(surface.gouge_max_um, surface.gouge_bound, accept.gouge_max_um) &&
         is_decided(surface.excess_max_um, surface.excess_bound, accept.excess_max_um) &&
         (!accept.scallop_max_um || surface.scallop_bound.has_value());
}

/// What the raw stock lacks within the design, where it is no block: pockets, slits and closed voids of it.
void prove_raw(const Job& job, Progress& progress, Result& result) {
  const stock::RawShape& raw = result.stock->raw();
  if (raw.is_box() || !job.design_mesh) return;
  const bool is_fine = job.proof.mesh != nullptr;
  const double facets_mm = job.design_under ? job.design_under->chord_mm : 0.0;
  const proof::SolidDesign design(is_fine ? *job.proof.mesh : *job.design_mesh,
                                  is_fine ? job.proof.chord_mm : facets_mm);
  measure::SurfaceMetrics& surface = result.main.surface;
  const double limit_mm = job.scene.accept.gouge_max_um.value_or(kGougeAllowed) * kMicrometre;
  progress.begin("prove raw stock", 1.0, "bodies");
  const proof::MissingBound proven = proof::bound_missing(
      {design, raw.mesh_around(), std::max(0.5 * limit_mm, limit_mm - design.chord_mm()), progress});
  progress.end();
  if (progress.stop_requested()) return;
  if (surface.gouge_bound)
    raise(surface.gouge_bound, {um_from_mm(proven.bound_mm + design.chord_mm()), proven.place});
  const double found_um = um_from_mm(proven.found_mm);
  if (found_um > surface.missing_max_um) {
    surface.missing_max_um = found_um;
    surface.missing_place = proven.foot;
  }
  if (!(found_um > surface.gouge_max_um)) return;
  surface.gouge_max_um = found_um;
  surface.gouge_block = stock::kUncut;
  surface.gouge_bottom = proven.place;
  add_found(surface.gouges, {found_um, 0.0, 0.0, proven.foot, stock::kUncut, 0, 0, proven.place},
            um_from_mm(limit_mm));
  surface.gouge_regions = keep_worst(surface.gouges);
}

/// Two proofs of one part: the lesser bound holds, and what is told beyond it was nothing.
void take_lesser(std::optional<measure::Bound>& bound, const std::optional<measure::Bound>& other,
                 double& value_um, std::vector<measure::Region>& regions) {
  if (other && (!bound || other->um < bound->um)) bound = other;
  if (!bound) return;
  value_um = std::min(value_um, bound->um);
  drop_beyond(regions, bound->um);
}

}  // namespace

ProofInputs::ProofInputs(const Job& job, const MeasuredPath& path, const stock::Stock& stock)
    : job_(job),
      path_(path),
      stock_(stock),
      fields_(fields_of(path)),
      ranges_(fields_),
      rays_(ray_cutters(job, path)),
      cutters_(rays_.solids, rays_.solid_of) {}

measure::CertificateInput ProofInputs::of_surface(const KnownOfPart& known, Progress& progress) const {
  const AcceptLimits& accept = job_.scene.accept;
  const stock::RayField& field = *fields_[known.surface];
  return {.field = field,
          .ranges = ranges_,
          .sweeps = path_.rays.sweeps,
          .cutters = cutters_,
          .sweep_bound_mm = unseen_mm(path_, field),
          .stock = stock_,
          .stock_bound_mm = known.stock_bound_mm,
          .gouge_limit_mm = accept.gouge_band_um() * kMicrometre,
          .excess_limit_mm = accept.excess_max_um.value_or(accept.scallop_band_um()) * kMicrometre,
          .wants_excess = accept.excess_max_um.has_value(),
          .wants_scallop = accept.scallop_max_um.has_value(),
          .scallop_limit_mm = accept.scallop_band_um() * kMicrometre,
          .gouge_known_mm = known.gouge_mm,
          .excess_known_mm = known.excess_mm,
          .progress = progress,
          .progress_from = static_cast<double>(known.surface)};
}

bool wants_proof(const Job& job) {
  const AcceptLimits& accept = job.scene.accept;
  // Without a limit there is nothing to decide.
  return job.has_design() && (accept.gouge_max_um || accept.excess_max_um || accept.scallop_max_um);
}

namespace {

/// By sweeps and features where the part is a body, and by the cells of the design where that does not
/// decide.
void prove_design(const Job& job, Ranks* ranks, Progress& progress, Result& result) {
  if (prove_body(job, progress, result)) return;
  MeasuredPath& main = result.main;
  // What the sweeps alone do not decide the cells of the design may.
  const std::optional<measure::Bound> gouge_bound = std::exchange(main.surface.gouge_bound, {}),
                                      excess_bound = std::exchange(main.surface.excess_bound, {});
  main.surface.scallop_bound.reset();
  main.surface.unmeasured_area_mm2 = 0.0;
  progress.begin("prove", static_cast<double>(main.dexels.size()), "surfaces");
  const ProofInputs inputs(job, main, *result.stock);
  if (ranks != nullptr) send_whole_stock(*ranks, *result.stock);
  measure::SurfaceMetrics& surface = main.surface;
  surface.gouges.clear();
  surface.excesses.clear();
  measure::Certificate worst;
  for (size_t i = 0; i < main.dexels.size() && !progress.stop_requested(); ++i) {
    const KnownOfPart known{i, result.sweep_bound_mm, surface.gouge_max_um * kMicrometre,
                            surface.excess_max_um * kMicrometre};
    measure::CertificateInput input = inputs.of_surface(known, progress);
    if (ranks != nullptr) {
      ask_for_proof(*ranks, known);
      input.deal = [&](const DealtWork& work) { deal_roots(*ranks, work); };
    }
    const measure::Certificate proof = measure::certify(input);
    take_over(proof, surface);
    if (proof.gouge_found_um > worst.gouge_found_um) {
      worst.gouge_found_um = proof.gouge_found_um;
      worst.gouge_bottom = proof.gouge_bottom;
      worst.gouge_block = proof.gouge_block;
    }
    if (proof.excess_found_um > worst.excess_found_um) {
      worst.excess_found_um = proof.excess_found_um;
      worst.excess_top = proof.excess_top;
      worst.excess_block = proof.excess_block;
    }
  }
  if (progress.stop_requested()) {
    // Half a proof is none.
    surface.gouge_bound.reset();
    surface.excess_bound.reset();
    surface.scallop_bound.reset();
  } else {
    if (settle(surface.gouge_max_um, surface.gouge_block, worst.gouge_found_um, worst.gouge_block,
               *surface.gouge_bound))
      surface.gouge_bottom = worst.gouge_bottom;
    if (settle(surface.excess_max_um, surface.excess_block, worst.excess_found_um, worst.excess_block,
               *surface.excess_bound))
      surface.excess_top = worst.excess_top;
  }
  take_lesser(surface.gouge_bound, gouge_bound, surface.gouge_max_um, surface.gouges);
  take_lesser(surface.excess_bound, excess_bound, surface.excess_max_um, surface.excesses);
  surface.gouge_regions = keep_worst(surface.gouges);
  surface.excess_regions = keep_worst(surface.excesses);
  progress.end();
}

}  // namespace

void prove_part(const Job& job, Ranks* ranks, Progress& progress, Result& result) {
  MeasuredPath& main = result.main;
  if (main.dexels.empty()) return;
  if (wants_proof(job)) prove_design(job, ranks, progress, result);
  if (!progress.stop_requested()) prove_raw(job, progress, result);
}

}  // namespace swarf::sim

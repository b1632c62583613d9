#include "sim/run/prove_part.h"

#include <algorithm>

#include "base/units.h"
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

void prove_part(const Job& job, Ranks* ranks, Progress& progress, Result& result) {
  MeasuredPath& main = result.main;
  if (main.dexels.empty() || !wants_proof(job)) return;
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
  surface.gouge_regions = keep_worst(surface.gouges);
  surface.excess_regions = keep_worst(surface.excesses);
  progress.end();
}

}  // namespace swarf::sim

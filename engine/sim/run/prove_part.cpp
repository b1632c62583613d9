#include "sim/run/prove_part.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/time_budget.h"
#include "base/units.h"
#include "mesh/mesh_check.h"
#include "proof/gouge_bound.h"
#include "proof/leftover_bound.h"
#include "proof/missing_bound.h"
#include "sim/run/cut_stage.h"
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

/// How far a design reaches out of a convex raw stock: nothing that the stock lacks lies deeper below the
/// design, for that far away the design ends.
double out_of_stock(const TriMesh& design, const stock::RawShape& raw) {
  double most = 0.0;
  for (const auto& p : design.positions) {
    const Vec3 at(p[0], p[1], p[2]);
    most = std::max(most, raw.is_box()
                              ? std::max((raw.box().lower - at).maxCoeff(), (at - raw.box().upper).maxCoeff())
                              : raw.distance_mm(at));
  }
  return most;
}

/// Whether all that the raw stock may lack is known: of a convex one from the design's corners, of one with
/// flat sides from its facets (prove_raw). Flats around a round one stand out by hundredths of a millimetre.
bool knows_what_stock_lacks(const Job& job, const stock::RawShape& raw) {
  const RawSettings& settings = job.scene.stock.raw;
  const bool is_bar = settings.kind == RawKind::kTube && settings.tube.inner_radius_mm == 0.0 &&
                      raw.text() == job.scene.stock.body_W().text();
  if (raw.is_box() || is_bar) return true;
  constexpr double kSame = 1e-7;
  const double volume = raw.volume_mm3();
  return std::abs(mesh::enclosed_volume(raw.mesh_around()) - volume) <= kSame * volume;
}

/// What the proofs of a body do not see: facets stray from faces, sweeps from the motion.
struct Slack {
  double gouge_mm, leftover_mm;
};

/// What is asked of a proof so that its bound and the slack stay within the limit however they are rounded.
double asked_mm(double limit_um, double slack_mm) {
  constexpr double kRounding = 1e-9;
  return limit_um * kMicrometre - slack_mm - kRounding;
}

/// Whether the part is of the kind that its sweeps and features prove: a body of not too many facets in a
/// block.
bool is_provable_body(const Job& job, const stock::RawShape& raw, const Slack& slack) {
  constexpr size_t kMostFacets = 200'000;
  const AcceptLimits& accept = job.scene.accept;
  if (job.proof.mesh == nullptr || job.proof_outside.mesh == nullptr) return false;
  if (job.proof_outside.mesh->triangles.size() > kMostFacets) return false;
  const double gouge_mm = accept.gouge_max_um.value_or(kGougeAllowed) * kMicrometre;
  const double excess_mm = accept.excess_max_um.value_or(kExcessAllowed) * kMicrometre;
  return excess_mm > slack.leftover_mm && knows_what_stock_lacks(job, raw) &&
         out_of_stock(*job.proof.mesh, raw) < gouge_mm - slack.gouge_mm;
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

/// What both proofs of a body ask about.
struct BodyQuestion {
  const Job& job;
  const measure::SweepCutters& cutters;
  const proof::SolidDesign& design;  ///< on the facets of the gouges
  Slack slack;
  Progress& progress;
  Result& result;
};

double allowed_excess_um(const AcceptLimits& accept) {
  return accept.excess_max_um.value_or(accept.scallop_max_um.value_or(kExcessAllowed));
}

/// False: it was ended before it was finished, and proves nothing.
bool prove_gouges(const BodyQuestion& in) {
  measure::SurfaceMetrics& surface = in.result.main.surface;
  const double limit_um = in.job.scene.accept.gouge_max_um.value_or(kGougeAllowed);
  proof::GougeBound gouges = proof::bound_gouges({in.design, in.result.main.rays.sweeps, in.cutters,
                                                  asked_mm(limit_um, in.slack.gouge_mm),
                                                  surface.gouge_max_um * kMicrometre, in.progress});
  if (in.progress.stop_requested()) return false;
  gouges.bound_mm = std::max(gouges.bound_mm, out_of_stock(*in.job.proof.mesh, in.result.stock->raw()));
  take_gouges(gouges, in.slack.gouge_mm, limit_um, surface);
  surface.gouge_regions = keep_worst(surface.gouges);
  return true;
}

/// What was met of it counts, finished or not.
void take_found_leftover(const proof::LeftoverBound& found, double limit_um,
                         measure::SurfaceMetrics& surface) {
  const double found_um = um_from_mm(found.found_mm);
  if (found_um <= surface.excess_max_um) return;
  surface.excess_max_um = found_um;
  surface.excess_block = block_near(surface.excesses, found.foot);
  surface.excess_top = found.top;
  add_found(surface.excesses, {found_um, 0.0, 0.0, found.foot, surface.excess_block, 0, 0, found.top},
            limit_um);
}

/// False as prove_gouges.
bool prove_leftover(const BodyQuestion& in) {
  const Job& job = in.job;
  measure::SurfaceMetrics& surface = in.result.main.surface;
  const double limit_um = allowed_excess_um(job.scene.accept);
  std::optional<proof::SolidDesign> coarser;
  if (job.proof_outside.mesh != job.proof.mesh)
    coarser.emplace(*job.proof_outside.mesh, job.proof_outside.chord_mm);
  const auto left_over = [&](const proof::SolidDesign& facets, double slack_mm) {
    return proof::bound_leftover({facets, in.result.main.rays.sweeps, in.cutters, *in.result.stock,
                                  in.result.sweep_bound_mm, asked_mm(limit_um, slack_mm),
                                  surface.excess_max_um * kMicrometre, in.progress, 1.0});
  };
  double slack_mm = in.slack.leftover_mm;
  proof::LeftoverBound leftover = left_over(coarser ? *coarser : in.design, slack_mm);
  // Between the limit and the limit less the wider slack the finer facets decide.
  if (coarser && um_from_mm(leftover.bound_mm + slack_mm) > limit_um &&
      um_from_mm(leftover.found_mm - slack_mm) <= limit_um) {
    slack_mm = in.slack.gouge_mm;
    leftover = left_over(in.design, slack_mm);
  }
  if (coarser && leftover.found_mm > 0.0) {
    const mesh::SignedPoint seen = in.design.distance().at(leftover.top);
    leftover.found_mm = seen.distance_mm;
    leftover.foot = seen.foot;
  }
  const bool is_finished = !in.progress.stop_requested();
  if (is_finished)
    take_leftover(leftover, slack_mm, limit_um, surface);
  else
    take_found_leftover(leftover, limit_um, surface);
  surface.excess_regions = keep_worst(surface.excesses);
  return is_finished;
}

/// Material that rays have told and that is none: sweeps meet edge to edge there.
void drop_seams(const BodyQuestion& in) {
  measure::SurfaceMetrics& surface = in.result.main.surface;
  std::vector<Vec3> tops{surface.excess_top};
  for (const measure::Region& region : surface.excesses) tops.push_back(region.end);
  const std::vector<uint8_t> stand =
      proof::which_stand({in.design, in.result.main.rays.sweeps, in.cutters, *in.result.stock,
                          in.result.sweep_bound_mm, 1.0, 0.0, in.progress},
                         tops);
  size_t n = 0;
  std::erase_if(surface.excesses, [&](const measure::Region&) { return stand[++n] == 0; });
  if (stand.front() != 0) return;
  surface.excess_max_um = 0.0;
  for (const measure::Region& region : surface.excesses) {
    if (region.worst_um <= surface.excess_max_um) continue;
    surface.excess_max_um = region.worst_um;
    surface.excess_top = region.end;
    surface.excess_block = region.block;
  }
}

/// The proof of a design that is a body, by its sweeps and its features. False: what is asked for is not
/// decided.
bool prove_body(const Job& job, Progress& progress, Result& result) {
  MeasuredPath& main = result.main;
  const AcceptLimits& accept = job.scene.accept;
  constexpr double kRounding = 2e-6;  // mm: a touch of both proofs
  const double strays = main.rays.error_bound_mm + kRounding;
  const Slack slack{job.proof.chord_mm + strays, job.proof_outside.chord_mm + strays};
  if (!is_provable_body(job, result.stock->raw(), slack)) return false;
  const RayCutters rays = ray_cutters(job, main);
  const measure::SweepCutters cutters(rays.solids, rays.solid_of);
  const proof::SolidDesign design(*job.proof.mesh, job.proof.chord_mm);
  measure::SurfaceMetrics& surface = main.surface;
  tell_distances(design, surface);
  const BodyQuestion question{job, cutters, design, slack, progress, result};
  drop_seams(question);
  progress.begin("prove", 2.0, "sides");
  bool is_finished = prove_gouges(question);
  progress.advance(1.0);
  is_finished = is_finished && prove_leftover(question);
  progress.end();
  if (!is_finished) return true;
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

/// Without a limit of its own the excess of a body fails above kExcessAllowed: by material alone.
void look_at_excess(const Job& job, Progress& progress, Result& result) {
  if (job.proof.mesh == nullptr || !(result.main.surface.excess_max_um > kExcessAllowed)) return;
  const RayCutters rays = ray_cutters(job, result.main);
  const measure::SweepCutters cutters(rays.solids, rays.solid_of);
  const proof::SolidDesign design(*job.proof.mesh, job.proof.chord_mm);
  drop_seams({job, cutters, design, {0.0, 0.0}, progress, result});
}

}  // namespace

void prove_part(const Job& job, const CutOptions& options, Progress& progress, Result& result) {
  MeasuredPath& main = result.main;
  if (main.dexels.empty()) return;
  constexpr double kShareBeforePictures = 0.6;
  BudgetProgress limited(progress, options.budget, options.outputs.pictures ? kShareBeforePictures : 1.0);
  if (wants_proof(job))
    prove_design(job, options.ranks, limited, result);
  else
    look_at_excess(job, progress, result);
  // Without it a part that the stock cannot hold would pass; it takes little time.
  if (!progress.stop_requested()) prove_raw(job, progress, result);
}

}  // namespace swarf::sim

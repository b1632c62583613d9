// The extremes of a comparison and the proof that nothing exceeds them.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "measure/deviation_side.h"
#include "measure/piece_bounds.h"

namespace swarf::measure {
namespace {

constexpr size_t kCellsPerTask = 64;
/// Samples that each cell may cost at first, and all the cells of a side that are left may cost together.
constexpr uint32_t kFirstWork = 16;
constexpr uint32_t kMostWork = 1U << 16U;
constexpr uint32_t kAllWork = 1'000'000;
/// And those of them that are to be bound nearly as close as what was found.
constexpr uint32_t kCloseWork = 300'000;
/// How close that is, of what was found, and at least, mm.
constexpr double kCloseShare = 0.005, kCloseGap = 5e-4;
/// A bound on what is beyond its limit anyhow need not be tighter than this share of it.
constexpr double kFailedGap = 2e-3;
/// Cells that the search for the greatest deviation follows, and how often it halves them.
constexpr size_t kBeam = 64;
constexpr int kBeamHalvings = 40;

/// A place inside a cell that is no worse than its centroid by this is not kept, mm.
constexpr double kWorse = 1e-9;
/// Bounds below this are rounding of doubles, mm.
constexpr double kRounding = 1e-11;

using Pair = std::array<double, 2>;  ///< excess, gouge

/// A part of a cell.
struct Piece {
  FlatPiece corners;
  DeviationSample sample;  ///< at its centre
};

Piece piece_of(const DeviationSide& side, uint32_t triangle, const FlatPiece& corners, const Piece& from) {
  return {corners, side.look(triangle, corners.centre(), &from.sample)};
}

/// What is proven of one cell.
struct CellProof {
  Pair bound{0.0, 0.0};  ///< errors included
  std::array<Vec3, 2> bound_place{Vec3::Zero(), Vec3::Zero()};
  Pair value{0.0, 0.0};
  std::array<Vec3, 2> place{Vec3::Zero(), Vec3::Zero()};
  double error = 0.0;  ///< the greatest that was added
  size_t samples = 0;
  bool whole = true;  ///< every piece meets the target or is tight
};

class Prover {
 public:
  Prover(const SampledSide& sampled, const ComparisonInput& input, const Pair& target, const Pair& gap,
         uint32_t work)
      : sampled_(sampled), input_(input), target_(target), gap_(gap), work_(work) {}

  CellProof prove(uint32_t cell) const {
    CellProof proof;
    const uint32_t triangle = sampled_.cells[cell].triangle;
    std::vector<Piece> pieces{{FlatPiece(sampled_.cells.corners(cell)), sampled_.samples[cell]}};
    while (!pieces.empty()) {
      const Piece piece = pieces.back();
      pieces.pop_back();
      if (piece.sample.state != CellState::kMeasured) continue;
      note_value(piece.sample, piece.corners.centre(), proof);
      PieceBounds bounds(sampled_.side, triangle, piece.corners, piece.sample);
      if (settles(triangle, piece, bounds, proof)) continue;
      for (const FlatPiece& part : bounds.parts())
        pieces.push_back(piece_of(sampled_.side, triangle, part, piece));
      proof.samples += 2;
    }
    return proof;
  }

 private:
  static void note_value(const DeviationSample& sample, const Vec3& place, CellProof& proof) {
    for (size_t k = 0; k < 2; ++k) {
      const double value = counted_of(sample, k == 1);
      if (value <= proof.value[k]) continue;
      proof.value[k] = value;
      proof.place[k] = place;
    }
  }

  /// All of the piece lies so near to a rounded edge that the grid answers for it.
  bool is_rounded_off(uint32_t triangle, const Piece& piece, double most) const {
    if (!piece.sample.edge) return false;
    const DeviationSide& side = sampled_.side;
    if (!side.on_design()) return most <= input_.edge + side.own_error(triangle);
    const uint32_t facet = piece.sample.facet;
    const double away = side.opposite().distance_over(facet, piece.corners.moved(side.shift(triangle)));
    return away <= input_.edge + side.opposite().error(facet);
  }

  /// The deviation that counts over a piece is at most this, errors of grid and facets included.
  double counted_bound(uint32_t triangle, const Piece& piece, double most) const {
    return most <= kRounding || is_rounded_off(triangle, piece, most) ? 0.0 : most;
  }

  Pair counted_bounds(uint32_t triangle, const Piece& piece, const PieceBounds& bounds) const {
    const DistanceRange deviation = bounds.deviation();
    const bool no_surface = piece.sample.inside > piece.corners.radius();
    return {no_surface ? 0.0 : counted_bound(triangle, piece, deviation.high),
            counted_bound(triangle, piece, -deviation.low)};
  }

  /// Each sign meets its target, or is as tight as it can be.
  bool meets(const Pair& bound, const Pair& value, double error) const {
    for (size_t k = 0; k < 2; ++k) {
      if (bound[k] > target_[k] && bound[k] - value[k] > gap_[k] + error) return false;
    }
    return true;
  }

  bool settles(uint32_t triangle, const Piece& piece, PieceBounds& bounds, CellProof& proof) const {
    Pair value{counted_of(piece.sample, false), counted_of(piece.sample, true)}, bound{};
    for (const PieceBounds::Step step : PieceBounds::kSteps) {
      bounds.tighten(step);
      bound = counted_bounds(triangle, piece, bounds);
      if (!meets(bound, value, piece.sample.error)) continue;
      note_bound(piece, bound, proof);
      return true;
    }
    const Vec3 corner = bounds.farthest_corner();
    const DeviationSample there = sampled_.side.look(triangle, corner, &piece.sample);
    ++proof.samples;
    note_value(there, corner, proof);
    for (size_t k = 0; k < 2; ++k) value[k] = std::max(value[k], counted_of(there, k == 1));
    const bool met = meets(bound, value, std::max(piece.sample.error, there.error));
    if (!met && proof.samples < work_) return false;
    proof.whole = proof.whole && met;
    note_bound(piece, bound, proof);
    return true;
  }

  static void note_bound(const Piece& piece, const Pair& bound, CellProof& proof) {
    proof.error = std::max(proof.error, piece.sample.error);
    for (size_t k = 0; k < 2; ++k) {
      if (bound[k] <= proof.bound[k]) continue;
      proof.bound[k] = bound[k];
      proof.bound_place[k] = piece.corners.centre();
    }
  }

  const SampledSide& sampled_;
  const ComparisonInput& input_;
  Pair target_, gap_;
  uint32_t work_;
};

/// The cells of the greatest deviation of one sign halved again and again: what their centroids miss.
void climb(SampledSide& sampled, bool gouge) {
  struct Rung {
    double value;
    uint32_t cell;
    Piece piece;
  };
  const auto higher = [](const Rung& a, const Rung& b) { return a.value > b.value; };
  std::vector<std::pair<double, uint32_t>> leaves;
  for (uint32_t c = 0; c < sampled.cells.size(); ++c) {
    const double value = sampled.worst(c, gouge);
    if (value > 0.0) leaves.emplace_back(-value, c);
  }
  const size_t kept = std::min(kBeam, leaves.size());
  std::partial_sort(leaves.begin(), leaves.begin() + static_cast<ptrdiff_t>(kept), leaves.end());
  std::vector<Rung> rungs;
  for (size_t i = 0; i < kept; ++i) {
    const uint32_t c = leaves[i].second;
    rungs.push_back({-leaves[i].first, c, {FlatPiece(sampled.cells.corners(c)), sampled.samples[c]}});
  }
  for (int step = 0; step < kBeamHalvings; ++step) {
    std::vector<Rung> next;
    for (const Rung& rung : rungs) {
      const uint32_t triangle = sampled.cells[rung.cell].triangle;
      for (const FlatPiece& half : halves_of(rung.piece.corners)) {
        const Piece piece = piece_of(sampled.side, triangle, half, rung.piece);
        next.push_back({counted_of(piece.sample, gouge), rung.cell, piece});
      }
    }
    std::stable_sort(next.begin(), next.end(), higher);
    if (next.size() > kBeam) next.erase(next.begin() + kBeam, next.end());
    rungs = std::move(next);
    if (rungs.empty()) return;
    if (rungs.front().value > sampled.worst(rungs.front().cell, gouge)) {
      sampled.findings[gouge ? 1 : 0][rungs.front().cell] = {rungs.front().value,
                                                             rungs.front().piece.corners.centre()};
    }
  }
}

double greatest(const SampledSide& sampled, bool gouge, Vec3& place, double so_far) {
  double most = so_far;
  for (uint32_t c = 0; c < sampled.cells.size(); ++c) {
    const double value = sampled.worst(c, gouge);
    if (value <= most) continue;
    most = value;
    place = sampled.worst_place(c, gouge);
  }
  return most;
}

/// The attempts of the proof: of all cells, and what each leaves open is for the next.
enum class Attempt {
  kTight,   ///< to kProofGap
  kClose,   ///< nearly as close, where that is much nearer than the limit
  kLimits,  ///< to the limits
};

/// The targets and gaps that an attempt aims at.
struct Aim {
  Pair target, gap;
};
Aim aim(const Pair& found, const ComparisonInput& input, Attempt attempt) {
  Aim aim;
  const Pair limits{input.excess, input.gouge};
  for (size_t k = 0; k < 2; ++k) {
    const bool failed = found[k] > limits[k];
    aim.gap[k] = failed ? std::max(kProofGap, kFailedGap * found[k]) : kProofGap;
    const double close = attempt == Attempt::kTight ? 0.0 : std::max(kCloseGap, kCloseShare * found[k]);
    const double tight = found[k] + std::max(aim.gap[k], failed ? 0.0 : close);
    aim.target[k] = !failed && (attempt == Attempt::kLimits || tight > limits[k]) ? limits[k] : tight;
  }
  return aim;
}

/// What is kept of many proofs: the sum of those that are whole, and the others one by one.
struct ProofShare {
  CellProof closed;
  struct Open {
    uint32_t cell;
    CellProof proof;
  };
  std::vector<Open> open;
  struct Worse {
    uint32_t cell;
    size_t kind;  ///< 0: excess, 1: gouge
    double value;
    Vec3 place;
  };
  std::vector<Worse> findings;  ///< places inside cells that are worse than what was known of them

  void close(const CellProof& proof) {
    closed.samples += proof.samples;
    closed.error = std::max(closed.error, proof.error);
    for (size_t k = 0; k < 2; ++k) {
      if (proof.bound[k] <= closed.bound[k]) continue;
      closed.bound[k] = proof.bound[k];
      closed.bound_place[k] = proof.bound_place[k];
    }
  }
  void take(ProofShare share) {
    close(share.closed);
    open.insert(open.end(), share.open.begin(), share.open.end());
    findings.insert(findings.end(), share.findings.begin(), share.findings.end());
  }
};

ProofShare prove_cells(const SampledSide& sampled, const std::vector<uint32_t>& cells,
                       const ComparisonInput& input, const Aim& aim, uint32_t work) {
  const Prover prover(sampled, input, aim.target, aim.gap, work);
  std::vector<ProofShare> shares((cells.size() + kCellsPerTask - 1) / kCellsPerTask);
  parallel_chunks(cells.size(), kCellsPerTask, [&](size_t begin, size_t end) {
    ProofShare& mine = shares[begin / kCellsPerTask];
    for (size_t i = begin; i < end; ++i) {
      const CellProof proof = prover.prove(cells[i]);
      for (size_t k = 0; k < 2; ++k) {
        if (proof.value[k] > sampled.worst(cells[i], k == 1) + kWorse)
          mine.findings.push_back({cells[i], k, proof.value[k], proof.place[k]});
      }
      if (proof.whole) {
        mine.close(proof);
      } else {
        mine.open.push_back({cells[i], proof});
      }
    }
  });
  ProofShare all;
  for (ProofShare& share : shares) all.take(std::move(share));
  return all;
}

class SideProof {
 public:
  SideProof(SampledSide& sampled, const ComparisonInput& input) : sampled_(sampled), input_(input) {}

  void first(const Pair& found) {
    std::vector<uint32_t> cells;
    for (uint32_t c = 0; c < sampled_.cells.size(); ++c) {
      if (sampled_.cells.is_leaf(c) && sampled_.samples[c].state == CellState::kMeasured) cells.push_back(c);
    }
    share_ = prove_cells(sampled_, cells, input_, aim(found, input_, Attempt::kTight), kFirstWork);
    note_findings();
  }
  /// Cells that the attempts before left open, if their bound decides anything; `all_work` of them together.
  void again(const Pair& found, Attempt attempt, uint32_t all_work) {
    // Where each cell has no more work than before, nothing comes closer.
    if (attempt == Attempt::kClose && share_.open.size() * 2 * kFirstWork > all_work) return;
    const Aim goal = aim(found, input_, attempt);
    std::vector<uint32_t> cells;
    for (const ProofShare::Open& open : share_.open) {
      if (open.proof.bound[0] <= goal.target[0] && open.proof.bound[1] <= goal.target[1]) {
        share_.close(open.proof);
      } else {
        cells.push_back(open.cell);
      }
    }
    share_.open.clear();
    if (cells.empty()) return;
    const auto work =
        static_cast<uint32_t>(std::clamp<size_t>(all_work / cells.size(), kFirstWork, kMostWork));
    share_.take(prove_cells(sampled_, cells, input_, goal, work));
    note_findings();
  }
  void add_to(PartComparison& result) {
    for (const ProofShare::Open& open : share_.open) share_.close(open.proof);
    const CellProof& all = share_.closed;
    SideSummary& summary = sampled_.side.on_design() ? result.design : result.stock;
    summary.proof_samples += all.samples;
    result.grid_error_um = std::max(result.grid_error_um, 1e3 * all.error);
    for (size_t k = 0; k < 2; ++k) {
      DeviationExtreme& extreme = k == 0 ? result.excess : result.gouge;
      if (1e3 * all.bound[k] <= extreme.bound_um) continue;
      extreme.bound_um = 1e3 * all.bound[k];
      extreme.bound_place = all.bound_place[k];
    }
  }

 private:
  void note_findings() {
    for (const ProofShare::Worse& worse : share_.findings)
      sampled_.findings[worse.kind][worse.cell] = {worse.value, worse.place};
    share_.findings.clear();
  }

  SampledSide& sampled_;
  const ComparisonInput& input_;
  ProofShare share_;
};

}  // namespace

void prove_extremes(std::array<SampledSide*, 2> sides, const ComparisonInput& input, PartComparison& result) {
  const auto extremes = [&] {
    Pair found{0.0, 0.0};
    for (const SampledSide* side : sides) {
      found[0] = greatest(*side, false, result.excess.place, found[0]);
      found[1] = greatest(*side, true, result.gouge.place, found[1]);
    }
    return found;
  };
  for (SampledSide* side : sides) {
    climb(*side, false);
    climb(*side, true);
  }
  std::array<SideProof, 2> proofs{SideProof(*sides[0], input), SideProof(*sides[1], input)};
  const Pair before = extremes();
  for (SideProof& proof : proofs) proof.first(before);
  const Pair after_first = extremes();
  for (SideProof& proof : proofs) proof.again(after_first, Attempt::kClose, kCloseWork);
  const Pair after_close = extremes();
  for (SideProof& proof : proofs) proof.again(after_close, Attempt::kLimits, kAllWork);
  const Pair found = extremes();
  result.excess.um = 1e3 * found[0];
  result.gouge.um = 1e3 * found[1];
  for (SideProof& proof : proofs) proof.add_to(result);
}

}  // namespace swarf::measure

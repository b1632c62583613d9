// The extremes of a comparison and the proof that nothing exceeds them.
#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "measure/deviation_side.h"
#include "measure/piece_bounds.h"

namespace swarf::measure {
namespace {

constexpr size_t kCellsPerTask = 64;
/// Samples that each cell may cost at first, and all the cells of a side that are left may cost together.
constexpr size_t kFirstWork = 16;
/// What all cells of a side may cost together at first: with more than 300 000 each has less.
constexpr size_t kAllFirstWork = 5'000'000;
constexpr size_t kMostWork = 1U << 16U;
constexpr size_t kAllWork = 1'000'000;
/// And those of them that are to be bound nearly as close as what was found.
constexpr size_t kCloseWork = 300'000;
/// Cells that are left are tried in rounds of so many, those with the greatest bounds first.
constexpr size_t kCellsPerRound = 512;
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

  /// Of an earlier proof of the same cell the lower bounds stay, for both hold.
  void join(const CellProof& earlier) {
    samples += earlier.samples;
    for (size_t k = 0; k < 2; ++k) {
      if (earlier.bound[k] >= bound[k]) continue;
      bound[k] = earlier.bound[k];
      bound_place[k] = earlier.bound_place[k];
    }
  }
};

/// The targets and gaps that an attempt aims at, mm.
struct Aim {
  Pair target, gap;

  /// By how much bounds exceed their targets at most; <= 0: they meet them.
  double excess_of(const Pair& bound) const { return std::max(bound[0] - target[0], bound[1] - target[1]); }
};

/// A piece that is to be cut further.
struct OpenPiece {
  Piece piece;
  Pair bound;
  std::array<FlatPiece, 2> parts;
  double beyond_mm;  ///< by which its bounds exceed the targets
  bool operator<(const OpenPiece& other) const { return beyond_mm < other.beyond_mm; }
};

class Prover {
 public:
  Prover(const SampledSide& sampled, const ComparisonInput& input, const Aim& aim, size_t work)
      : sampled_(sampled), input_(input), aim_(aim), work_(work) {}

  /// Pieces with the greatest bounds are cut first, so what the work allows leaves the least bound.
  CellProof prove(uint32_t cell) const {
    CellProof proof;
    const uint32_t triangle = sampled_.cells[cell].triangle;
    std::vector<OpenPiece> open;
    look_at({FlatPiece(sampled_.cells.corners(cell)), sampled_.samples[cell]}, triangle, open, proof);
    while (!open.empty() && proof.samples < work_) {
      std::pop_heap(open.begin(), open.end());
      const OpenPiece worst = open.back();
      open.pop_back();
      for (const FlatPiece& part : worst.parts)
        look_at(piece_of(sampled_.side, triangle, part, worst.piece), triangle, open, proof);
      proof.samples += 2;
    }
    proof.whole = open.empty();
    for (const OpenPiece& left : open) note_bound(left.piece, left.bound, proof);
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
      if (bound[k] > aim_.target[k] && bound[k] - value[k] > aim_.gap[k] + error) return false;
    }
    return true;
  }

  /// Its bounds are noted once they meet the aim; else it is open.
  void look_at(const Piece& piece, uint32_t triangle, std::vector<OpenPiece>& open, CellProof& proof) const {
    if (piece.sample.state != CellState::kMeasured) return;
    note_value(piece.sample, piece.corners.centre(), proof);
    PieceBounds bounds(sampled_.side, triangle, piece.corners, piece.sample);
    Pair bound{};
    if (settles(triangle, piece, bounds, bound, proof)) {
      note_bound(piece, bound, proof);
      return;
    }
    open.push_back({piece, bound, bounds.parts(), aim_.excess_of(bound)});
    std::push_heap(open.begin(), open.end());
  }

  bool settles(uint32_t triangle, const Piece& piece, PieceBounds& bounds, Pair& bound,
               CellProof& proof) const {
    Pair value{counted_of(piece.sample, false), counted_of(piece.sample, true)};
    for (const PieceBounds::Step step : PieceBounds::kSteps) {
      bounds.tighten(step);
      bound = counted_bounds(triangle, piece, bounds);
      if (meets(bound, value, piece.sample.error)) return true;
    }
    const Vec3 corner = bounds.farthest_corner();
    const DeviationSample there = sampled_.side.look(triangle, corner, &piece.sample);
    ++proof.samples;
    note_value(there, corner, proof);
    for (size_t k = 0; k < 2; ++k) value[k] = std::max(value[k], counted_of(there, k == 1));
    // At a rounded edge the error is the grid's: it makes no bound tight.
    return meets(bound, value, there.edge ? piece.sample.error : std::max(piece.sample.error, there.error));
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
  Aim aim_;
  size_t work_;
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

/// What bounds come to at the samples, errors included: no proof aims below it.
Pair least_bounds(const SampledSide& sampled) {
  Pair least{0.0, 0.0};
  for (size_t c = 0; c < sampled.cells.size(); ++c) {
    const DeviationSample& sample = sampled.samples[c];
    if (!sampled.cells.is_leaf(c) || sample.state != CellState::kMeasured) continue;
    for (size_t k = 0; k < 2; ++k) {
      const bool nothing = (sample.edge && sample.counted == 0.0) || (k == 0 && sample.inside > 0.0);
      if (!nothing) least[k] = std::max(least[k], (k == 0 ? sample.raw : -sample.raw) + sample.error);
    }
  }
  return least;
}

/// `least`: what bounds come to at least.
Aim aim_at(const Pair& found, const Pair& least, const ComparisonInput& input, Attempt attempt) {
  Aim aim;
  const Pair limits{input.excess, input.gouge};
  for (size_t k = 0; k < 2; ++k) {
    const bool failed = found[k] > limits[k];
    aim.gap[k] = failed ? std::max(kProofGap, kFailedGap * found[k]) : kProofGap;
    const double close = attempt == Attempt::kTight ? 0.0 : std::max(kCloseGap, kCloseShare * found[k]);
    const double tight = std::max(least[k], found[k] + std::max(aim.gap[k], failed ? 0.0 : close));
    aim.target[k] = failed ? tight : attempt == Attempt::kLimits ? limits[k] : std::min(tight, limits[k]);
    if (!failed && attempt != Attempt::kLimits && least[k] > limits[k]) aim.target[k] = tight;
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
  /// Those of its open proofs too.
  size_t samples() const {
    size_t sum = closed.samples;
    for (const Open& one : open) sum += one.proof.samples;
    return sum;
  }
  void take(const ProofShare& share) {
    close(share.closed);
    open.insert(open.end(), share.open.begin(), share.open.end());
    findings.insert(findings.end(), share.findings.begin(), share.findings.end());
  }
};

/// `known`: for each of the cells what is proven already; empty: nothing.
ProofShare prove_cells(const SampledSide& sampled, const std::vector<uint32_t>& cells,
                       std::span<const CellProof* const> known, const Prover& prover) {
  const size_t per_task = std::clamp<size_t>(cells.size() / kCellsPerTask, 1, kCellsPerTask);
  std::vector<ProofShare> shares((cells.size() + per_task - 1) / per_task);
  parallel_chunks(cells.size(), per_task, [&](size_t begin, size_t end) {
    ProofShare& mine = shares[begin / per_task];
    for (size_t i = begin; i < end; ++i) {
      CellProof proof = prover.prove(cells[i]);
      if (!known.empty()) proof.join(*known[i]);
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
  for (const ProofShare& share : shares) all.take(share);
  return all;
}

class SideProof {
 public:
  SideProof(SampledSide& sampled, const ComparisonInput& input)
      : sampled_(sampled), input_(input), least_(least_bounds(sampled)) {}

  const Pair& least() const { return least_; }

  void first(const Aim& aim) {
    std::vector<uint32_t> cells;
    for (uint32_t c = 0; c < sampled_.cells.size(); ++c) {
      if (sampled_.cells.is_leaf(c) && sampled_.samples[c].state == CellState::kMeasured) cells.push_back(c);
    }
    const size_t work = std::min(kFirstWork, kAllFirstWork / std::max<size_t>(1, cells.size()));
    share_ = prove_cells(sampled_, cells, {}, Prover(sampled_, input_, aim, work));
    note_findings();
  }

  /// Cells that the attempts before left open, those with the greatest bounds first. What a cell's share of
  /// `all_work` cannot bring below the target is what is proven of the whole side: cells below it are done.
  void again(Aim aim, size_t all_work) {
    std::vector<ProofShare::Open> open = std::move(share_.open);
    share_.open.clear();
    std::sort(open.begin(), open.end(), [&](const ProofShare::Open& a, const ProofShare::Open& b) {
      return std::pair(-aim.excess_of(a.proof.bound), a.cell) <
             std::pair(-aim.excess_of(b.proof.bound), b.cell);
    });
    size_t next = 0, left = all_work;
    while (next < open.size() && left > 0) {
      const size_t end = std::min(open.size(), next + kCellsPerRound);
      const size_t of_round = end == open.size() ? left : left / 2;
      left -= std::min(left, try_again({open.data() + next, end - next}, aim, of_round));
      next = end;
    }
    share_.open.insert(share_.open.end(), open.begin() + static_cast<ptrdiff_t>(next), open.end());
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
  /// Raises the targets to what stays open. Returns the samples that it took.
  size_t try_again(std::span<const ProofShare::Open> open, Aim& aim, size_t work) {
    std::vector<uint32_t> cells;
    std::vector<const CellProof*> known;
    size_t before = 0;
    for (const ProofShare::Open& one : open) {
      if (aim.excess_of(one.proof.bound) <= 0.0) {
        share_.close(one.proof);
        continue;
      }
      cells.push_back(one.cell);
      known.push_back(&one.proof);
      before += one.proof.samples;
    }
    if (cells.empty()) return 0;
    const size_t each = std::clamp(work / cells.size(), kFirstWork, kMostWork);
    const ProofShare share = prove_cells(sampled_, cells, known, Prover(sampled_, input_, aim, each));
    for (const ProofShare::Open& one : share.open) {
      for (size_t k = 0; k < 2; ++k) aim.target[k] = std::max(aim.target[k], one.proof.bound[k]);
    }
    share_.take(share);
    note_findings();
    return share.samples() - before;
  }

  void note_findings() {
    for (const ProofShare::Worse& worse : share_.findings)
      sampled_.findings[worse.kind][worse.cell] = {worse.value, worse.place};
    share_.findings.clear();
  }

  SampledSide& sampled_;
  const ComparisonInput& input_;
  Pair least_;
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
  Pair least{0.0, 0.0};
  for (const SideProof& proof : proofs) {
    for (size_t k = 0; k < 2; ++k) least[k] = std::max(least[k], proof.least()[k]);
  }
  const auto aim_of = [&](Attempt attempt) { return aim_at(extremes(), least, input, attempt); };
  const Aim tight = aim_of(Attempt::kTight);
  for (SideProof& proof : proofs) proof.first(tight);
  const Aim close = aim_of(Attempt::kClose);
  for (SideProof& proof : proofs) proof.again(close, kCloseWork);
  const Aim limits = aim_of(Attempt::kLimits);
  for (SideProof& proof : proofs) proof.again(limits, kAllWork);
  const Pair found = extremes();
  result.excess.um = 1e3 * found[0];
  result.gouge.um = 1e3 * found[1];
  for (SideProof& proof : proofs) proof.add_to(result);
}

}  // namespace swarf::measure

#include "measure/certificate.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/height_bounds.h"
#include "measure/root_message.h"

namespace swarf::measure {
namespace {

/// Looks at a sweep over a cell, in all (a minute or two) and at least for each root.
constexpr size_t kBudget = 150'000'000, kLeastBudget = 10'000;
/// What is left of the budget is shared by the roots that are left, and one may take so many shares.
constexpr size_t kShares = 64;
/// So much is spent on roots that break a limit before each of them gets only the lesser one.
constexpr size_t kBrokenBudget = 10'000'000, kBrokenRoot = 1'500;
constexpr size_t kRoots = 10'000;
constexpr size_t kRootsPerBatch = 256;  // share one budget
constexpr size_t kRootsPerPortion = 4;  // that another process is asked for at once
constexpr double kLeastRoot = 1.0;      // mm
/// Between two steps of the progress bar, about; s.
constexpr double kStep = 0.2;

/// A part that breaks a limit all over has as many as memory notices: none is held twice.
void take_pieces(std::vector<RegionPiece>& from, std::vector<RegionPiece>& to) {
  to.insert(to.end(), from.begin(), from.end());
  from = {};
}

void join(RootResult& part, Certificate& whole, std::vector<RegionPiece>& gouges,
          std::vector<RegionPiece>& excesses) {
  if (um_from_mm(part.gouge) > whole.gouge.um) whole.gouge = {um_from_mm(part.gouge), part.gouge_at};
  if (um_from_mm(part.excess) > whole.excess.um) whole.excess = {um_from_mm(part.excess), part.excess_at};
  if (um_from_mm(part.scallop) > whole.scallop.um)
    whole.scallop = {um_from_mm(part.scallop), part.scallop_at};
  if (um_from_mm(part.gouge_found) > whole.gouge_found_um) {
    whole.gouge_found_um = um_from_mm(part.gouge_found);
    whole.gouge_bottom = part.gouge_bottom;
    whole.gouge_block = part.gouge_block;
  }
  if (um_from_mm(part.excess_found) > whole.excess_found_um) {
    whole.excess_found_um = um_from_mm(part.excess_found);
    whole.excess_top = part.excess_top;
    whole.excess_block = part.excess_block;
  }
  if (um_from_mm(part.above_found) > whole.above_found_um) {
    whole.above_found_um = um_from_mm(part.above_found);
    whole.above_top = part.above_top;
  }
  take_pieces(part.gouges, gouges);
  take_pieces(part.excesses, excesses);
  whole.cells += part.cells;
}

/// Works on a batch in slices of about kStep; how many roots that is hangs on the machine, no result does.
class Slices {
 public:
  explicit Slices(const CertificateInput& input) : input_(input) {}

  /// Calls prove(n) for first <= n < end.
  template <typename Prove>
  void run(size_t first, size_t end, size_t all, const Prove& prove) {
    while (first < end && !input_.progress.stop_requested()) {
      const auto begun = std::chrono::steady_clock::now();
      const size_t count = std::min(slice_, end - first);
      parallel_chunks(count, 1, [&](size_t begin, size_t) { prove(first + begin); });
      first += count;
      input_.progress.advance(input_.progress_from + static_cast<double>(first) / static_cast<double>(all));
      const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
      if (took < 0.5 * kStep) slice_ = std::min(2 * slice_, kRootsPerBatch);
      if (took > kStep) slice_ = std::max(slice_ / 2, size_t{1});
    }
  }

 private:
  const CertificateInput& input_;
  size_t slice_ = 32;
};

/// Roots [first, end) in portions, by whoever helps.
void deal_roots(const CertificateInput& input, const std::vector<RootCell>& roots, const SweepIndex& index,
                const RootRequest& batch, std::vector<RootResult>& parts) {
  const auto portion = [&](size_t n) {
    const size_t first = batch.first + n * kRootsPerPortion;
    return RootRequest{first, std::min(first + kRootsPerPortion, batch.end), batch.budget};
  };
  input.deal({(batch.end - batch.first + kRootsPerPortion - 1) / kRootsPerPortion,
              [&](size_t n) {
                BytesWriter out;
                out.add(portion(n));
                return out.take();
              },
              [&](size_t n, const Bytes& answer) {
                BytesReader in(answer);
                const RootRequest of = portion(n);
                for (size_t root = of.first; root < of.end; ++root) parts[root] = get_result(in);
              },
              [&](size_t n) {
                const RootRequest of = portion(n);
                parallel_chunks(of.end - of.first, 1, [&](size_t k, size_t) {
                  parts[of.first + k] = prove_root(input, index, roots[of.first + k], of.budget);
                });
              }});
}

}  // namespace

double root_size(const stock::RayField& field) {
  double area = 0.0;
  for (const double part : field.areas_mm2) area += part;
  return std::max(kLeastRoot, std::sqrt(2.0 * area / kRoots));
}

double certify_bytes(const stock::RayField& field) {
  constexpr double kGrown = 1.5;  // of a vector that doubles
  return expected_roots(field, root_size(field)) * (kGrown * sizeof(RootCell) + sizeof(RootResult));
}

Certificate certify(const CertificateInput& input) {
  const std::vector<RootCell> roots = root_cells(input.field, root_size(input.field));
  const SweepIndex index(input.sweeps, input.cutters);
  std::vector<RootResult> parts(roots.size());
  size_t spent = 0, broken = 0;
  Slices slices(input);
  for (size_t first = 0; first < roots.size() && !input.progress.stop_requested(); first += kRootsPerBatch) {
    // Known between batches only: the budget of a root does not depend on the number of threads.
    const size_t left = kBudget > spent ? kBudget - spent : 0;
    const size_t share = std::max(kLeastBudget, kShares * left / (roots.size() - first));
    const Budget budget{share, broken > kBrokenBudget ? std::min(share, kBrokenRoot) : share};
    const size_t end = std::min(first + kRootsPerBatch, roots.size());
    if (input.deal) {
      deal_roots(input, roots, index, {first, end, budget}, parts);
      input.progress.advance(input.progress_from +
                             static_cast<double>(end) / static_cast<double>(roots.size()));
    } else {
      slices.run(first, end, roots.size(),
                 [&](size_t n) { parts[n] = prove_root(input, index, roots[n], budget); });
    }
    for (size_t n = first; n < end; ++n) {
      spent += parts[n].work;
      if (parts[n].broken) broken += parts[n].work;
    }
  }
  Certificate whole;
  std::vector<RegionPiece> gouges, excesses;
  size_t gouge_pieces = 0, excess_pieces = 0;
  for (const RootResult& part : parts) {
    gouge_pieces += part.gouges.size();
    excess_pieces += part.excesses.size();
  }
  gouges.reserve(gouge_pieces);
  excesses.reserve(excess_pieces);
  for (RootResult& part : parts) join(part, whole, gouges, excesses);
  const auto settled = [](bool wanted, double found_um, double limit_mm) {
    return wanted ? std::max(found_um * kMicrometre * (1.0 + kGapShare) + kGap, limit_mm) : kNever;
  };
  const double gouge_settled = settled(true, whole.gouge_found_um, input.gouge_limit_mm);
  double excess_settled = settled(input.wants_excess, whole.excess_found_um, input.excess_limit_mm);
  if (whole.above_found_um * kMicrometre > input.excess_limit_mm)
    excess_settled =
        std::max(excess_settled, whole.above_found_um * kMicrometre + above_gap(input.stock.voxel_mm()));
  const double scallop_settled = settled(input.wants_scallop, whole.excess_found_um, input.scallop_limit_mm);
  for (const RootResult& part : parts) {
    for (const RootResult::Open& open : part.open) {
      if (open.depth <= gouge_settled && open.height <= excess_settled && open.skin <= scallop_settled)
        continue;
      whole.open_area_mm2 += open.area;
      ++whole.open_cells;
    }
  }
  // What was measured may lie kTouch beyond what is told from a touch.
  const double untold_um = um_from_mm(input.sweep_bound_mm + kTouch);
  whole.gouge.um = std::max(whole.gouge.um, whole.gouge_found_um) + untold_um;
  whole.excess.um = std::max(whole.excess.um, whole.excess_found_um) + untold_um;
  whole.scallop.um = std::max(whole.scallop.um, whole.excess_found_um) + untold_um;
  if (whole.above_found_um > whole.excess_found_um) {
    whole.excess_found_um = whole.above_found_um;
    whole.excess_top = whole.above_top;
    whole.excess_block = stock::kUncut;
    whole.excess.um = std::max(whole.excess.um, whole.above_found_um + untold_um);
  }
  whole.gouges = join_pieces(gouges);
  whole.excesses = join_pieces(excesses);
  return whole;
}

}  // namespace swarf::measure

#include "measure/certificate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/height_bounds.h"
#include "measure/root_message.h"

namespace swarf::measure {
namespace {

/// Looks at a sweep over a cell, in all (a minute or two) and at least for each root.
constexpr size_t kBudget = 150'000'000, kLeastBudget = 10'000;
/// At first a root may take so many times its share of the budget that is left, and a batch one part of it:
/// what then is left is for the roots for which that did not suffice.
constexpr size_t kShares = 4, kBatchPart = 4;
/// So much is spent on roots that break a limit before each of them gets only the lesser one.
constexpr size_t kBrokenBudget = 10'000'000, kBrokenRoot = 1'500;
constexpr size_t kRoots = 10'000;
constexpr size_t kRootsPerBatch = 256;  // share one budget
constexpr double kLeastRoot = 1.0;      // mm
/// Between two steps of the progress bar, about; s.
constexpr double kStep = 0.2;

void join(const RootResult& part, Certificate& whole) {
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
  whole.cells += part.cells;
}

/// The roots of one surface, and what is proven of them.
class RootProofs {
 public:
  explicit RootProofs(const CertificateInput& input)
      : input_(input),
        roots_(root_cells(input.field, root_size(input.field))),
        index_(input.sweeps, input.cutters),
        results_(roots_.size()) {}

  /// Those for which the budget did not suffice are begun anew with what the others have left of it. The
  /// budget of a root depends on what was spent before its batch: on no number of threads.
  std::vector<RootResult> prove() {
    std::vector<size_t> todo(roots_.size());
    std::iota(todo.begin(), todo.end(), size_t{0});
    for (; !todo.empty() && !input_.progress.stop_requested(); todo = unfinished(todo)) {
      for (size_t first = 0; first < todo.size() && !input_.progress.stop_requested();
           first += kRootsPerBatch) {
        const size_t rest = todo.size() - first;
        const auto batch = std::span(todo).subspan(first, std::min(kRootsPerBatch, rest));
        prove_batch(batch, budget_of(batch.size(), rest));
        for (const size_t n : batch) {
          spent_ += results_[n].work;
          if (results_[n].broken) broken_ += results_[n].work;
        }
      }
    }
    return std::move(results_);
  }

 private:
  static size_t rest_of(size_t budget, size_t spent) { return budget > spent ? budget - spent : 0; }

  /// For each root of a batch, when `rest` are left with them.
  Budget budget_of(size_t batch, size_t rest) {
    const size_t left = rest_of(kBudget, spent_), fair = left / rest;
    const size_t share =
        std::max(kLeastBudget, is_first_ ? std::min(kShares * fair, left / (kBatchPart * batch)) : fair);
    const size_t of_broken = is_first_ ? (broken_ > kBrokenBudget ? kBrokenRoot : share)
                                       : std::max(kBrokenRoot, rest_of(kBrokenBudget, broken_) / rest);
    most_ = {std::max(most_.all, share), std::max(most_.broken, std::min(share, of_broken))};
    return {share, std::min(share, of_broken)};
  }

  /// Those that would get at least twice as much as they had.
  std::vector<size_t> unfinished(const std::vector<size_t>& roots) {
    is_first_ = false;
    std::vector<size_t> left;
    for (const size_t n : roots)
      if (results_[n].cut_short) left.push_back(n);
    const auto worthwhile = [&](size_t n) {
      return results_[n].broken ? rest_of(kBrokenBudget, broken_) >= 2 * most_.broken * left.size()
                                : rest_of(kBudget, spent_) >= 2 * most_.all * left.size();
    };
    std::vector<size_t> again;
    std::copy_if(left.begin(), left.end(), std::back_inserter(again), worthwhile);
    done_ = roots_.size() - again.size();
    return again;
  }

  void prove_batch(std::span<const size_t> batch, const Budget& budget) {
    if (input_.deal) {
      deal(batch, budget);
      tell(batch);
      return;
    }
    // In slices of about kStep; how many roots that is hangs on the machine, no result does.
    for (size_t first = 0; first < batch.size() && !input_.progress.stop_requested();) {
      const auto begun = std::chrono::steady_clock::now();
      const auto slice = batch.subspan(first, std::min(slice_, batch.size() - first));
      prove_here(slice, budget);
      tell(slice);
      first += slice.size();
      const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
      if (took < 0.5 * kStep) slice_ = std::min(2 * slice_, kRootsPerBatch);
      if (took > kStep) slice_ = std::max(slice_ / 2, size_t{1});
    }
  }

  void prove_here(std::span<const size_t> roots, const Budget& budget) {
    parallel_chunks(roots.size(), 1, [&](size_t k, size_t) {
      results_[roots[k]] = prove_root(input_, index_, roots_[roots[k]], budget);
    });
  }

  /// In portions, by whoever helps.
  void deal(std::span<const size_t> batch, const Budget& budget) {
    const auto portion = [&](size_t n) {
      const size_t first = n * kRootsPerRequest;
      return batch.subspan(first, std::min(kRootsPerRequest, batch.size() - first));
    };
    input_.deal({(batch.size() + kRootsPerRequest - 1) / kRootsPerRequest,
                 [&](size_t n, int) {
                   RootRequest request{{}, portion(n).size(), budget};
                   std::copy(portion(n).begin(), portion(n).end(), request.roots.begin());
                   BytesWriter out;
                   out.add(request);
                   return out.take();
                 },
                 [&](size_t n, const Bytes& answer) {
                   BytesReader in(answer);
                   for (const size_t root : portion(n)) results_[root] = get_result(in);
                 },
                 [&](size_t n) { prove_here(portion(n), budget); }});
  }

  /// Those that may be begun anew are not done yet.
  void tell(std::span<const size_t> roots) {
    for (const size_t n : roots) done_ += results_[n].cut_short ? 0 : 1;
    input_.progress.advance(input_.progress_from +
                            static_cast<double>(done_) / static_cast<double>(roots_.size()));
  }

  const CertificateInput& input_;
  std::vector<RootCell> roots_;
  SweepIndex index_;
  std::vector<RootResult> results_;
  size_t spent_ = 0, broken_ = 0, done_ = 0, slice_ = 32;
  Budget most_{0, 0};     ///< that a root had
  bool is_first_ = true;  ///< of the rounds
};

/// Places that break a limit, of all roots.
std::vector<Region> regions_of(const std::vector<RootResult>& parts, RootRegions RootResult::*kind) {
  std::vector<const RootRegions*> roots;
  for (const RootResult& part : parts) roots.push_back(&(part.*kind));
  return join_roots(roots);
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
  const std::vector<RootResult> parts = RootProofs(input).prove();
  Certificate whole;
  for (const RootResult& part : parts) join(part, whole);
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
  whole.gouges = regions_of(parts, &RootResult::gouges);
  whole.excesses = regions_of(parts, &RootResult::excesses);
  return whole;
}

}  // namespace swarf::measure

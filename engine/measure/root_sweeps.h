// The sweeps that matter to a root cell of the proof. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "measure/certificate.h"
#include "measure/design_cell.h"
#include "measure/height_bounds.h"
#include "measure/sweep_index.h"

namespace swarf::measure {

/// Those that may meet the root's columns from the skin up to `reach` over the design, mm; infinite: up to
/// the top of the stock.
std::vector<NearSweep> sweeps_up_to(double reach, const RootCell& root, const CertificateInput& input,
                                    const SweepIndex& index);

/// Their numbers, rising.
std::vector<uint32_t> numbers_up_to(double reach, const RootCell& root, const CertificateInput& input,
                                    const SweepIndex& index);

/// The sweeps of one root. Of most the lowest plane answers for all that is asked: a map is made for the
/// others, when it is asked for. For one thread.
class RootSweeps {
 public:
  RootSweeps() = default;
  RootSweeps(const CertificateInput& input, std::vector<uint32_t> numbers);

  size_t size() const { return numbers_.size(); }
  uint32_t number(size_t n) const { return numbers_[n]; }
  std::span<const uint32_t> numbers() const { return numbers_; }
  /// Stays where it is.
  const NearSweep& operator[](size_t n) const {
    if (places_[n] == kNotMade) make(n);
    return made_[places_[n]];
  }

 private:
  static constexpr uint32_t kNotMade = 0xffffffffu;
  void make(size_t n) const;

  const CertificateInput* input_ = nullptr;
  std::vector<uint32_t> numbers_;
  mutable std::vector<uint32_t> places_;  ///< in made_
  mutable std::vector<NearSweep> made_;   ///< room for all: none moves
};

/// Looks at all sweeps above the root, which may be a thousand times those of a cell: where few of them are
/// of use, they take no more work than twice all other.
class LooksAtAll {
 public:
  bool is_worth_it(size_t work) const {
    constexpr size_t kFirst = 64, kPerSuccess = 16, kShare = 2;
    return looks_ < kFirst + kPerSuccess * successes_ || work_ <= kShare * (work - work_);
  }
  /// One of `sweeps`, whose work is added to `work`.
  void count(size_t sweeps, size_t& work) {
    ++looks_;
    work_ += sweeps;
    work += sweeps;
  }
  void count_success() { ++successes_; }

 private:
  size_t looks_ = 0, successes_ = 0, work_ = 0;
};

}  // namespace swarf::measure

// The sweeps that cut the level set, by number: those of blocks are made from the blocks when they are asked
// for, so that a program of millions of them is not held twice.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "motion/blocks/block_motions.h"
#include "sim/run/job_sweeps.h"

namespace swarf::sim {

/// Which part of a path a sweep stands for.
struct SweepOfBlocks {
  uint32_t element = 0;  ///< the last one of the sweep
  /// So many equal pieces the element is divided into, and which one this is. 0: a straight row of elements
  /// from the one behind that of the sweep before.
  uint32_t pieces = 0, piece = 0;
  bool joined = false;  ///< of a row: it starts where the element before its first one ends
};

class CutSweeps {
 public:
  CutSweeps() = default;
  /// Sweeps that are held as they are.
  explicit CutSweeps(JobSweeps held) : error_bound_mm(held.error_bound_mm), held_(std::move(held)) {}
  /// Sweeps of blocks, made when they are asked for; Sweep::block is their number.
  CutSweeps(const motion::BlockMotions& motions, std::vector<SweepOfBlocks> parts, double bound_mm)
      : error_bound_mm(bound_mm), motions_(motions), parts_(std::move(parts)) {}

  size_t size() const { return parts_.empty() ? held_.sweeps.size() : parts_.size(); }
  stock::Sweep operator[](size_t n) const;
  /// Sweeps [begin, end).
  std::vector<stock::Sweep> part(size_t begin, size_t end) const;
  SweepSource source(size_t n) const;
  /// Sweep::block.
  uint32_t block(size_t n) const { return parts_.empty() ? held_.sweeps[n].block : static_cast<uint32_t>(n); }
  /// By Sweep::block.
  SweepSource source_of(uint32_t block) const {
    return parts_.empty() ? held_.sources[block] : source(block);
  }
  int tool(size_t n) const { return source(n).tool; }
  /// All of them.
  JobSweeps all() const;
  /// Memory that is held.
  size_t bytes() const;

  /// Calls visit(tool, sweeps) for each row of sweeps of one tool in [begin, end).
  template <typename Visit>
  void for_each_tool(size_t begin, size_t end, const Visit& visit) const {
    const std::vector<stock::Sweep> sweeps = part(begin, end);
    sim::for_each_tool(
        sweeps, [&](uint32_t block) { return source_of(block).tool; }, visit);
  }

  /// Greatest distance between the sweeps and the motion they stand for, mm.
  double error_bound_mm = 0.0;

 private:
  stock::Sweep make(size_t n, motion::MotionReader& reader) const;

  JobSweeps held_;
  motion::BlockMotions motions_;
  std::vector<SweepOfBlocks> parts_;
};

/// For the level set, within stock.sweep_tolerance or the given one, mm. Blocks: collinear ones of one feed
/// that keep their axis are merged.
CutSweeps cut_sweeps(const Job& job, const motion::Cycles& cycles, std::optional<double> tolerance_mm = {});

}  // namespace swarf::sim

#include "sim/run/cut_sweeps.h"

namespace swarf::sim {

stock::Sweep CutSweeps::make(size_t n, motion::MotionReader& reader) const {
  const SweepOfBlocks& part = parts_[n];
  const auto block = static_cast<uint32_t>(n);
  if (part.pieces > 0) {
    const motion::BlockMotion& motion = reader.at(part.element);
    const double pieces = part.pieces;
    return {pose_at(motion, part.piece / pieces), pose_at(motion, (part.piece + 1) / pieces), block};
  }
  const size_t first = n > 0 ? parts_[n - 1].element + 1 : 0;
  const ToolPose start = part.joined ? motions_.block_end(first - 1) : reader.at(first).block.from;
  return {start, motions_.block_end(part.element), block};
}

stock::Sweep CutSweeps::operator[](size_t n) const {
  if (parts_.empty()) return held_.sweeps[n];
  motion::MotionReader reader(motions_);
  return make(n, reader);
}

std::vector<stock::Sweep> CutSweeps::part(size_t begin, size_t end) const {
  std::vector<stock::Sweep> sweeps;
  sweeps.reserve(end - begin);
  motion::MotionReader reader(motions_);
  for (size_t n = begin; n < end; ++n) sweeps.push_back(parts_.empty() ? held_.sweeps[n] : make(n, reader));
  return sweeps;
}

SweepSource CutSweeps::source(size_t n) const {
  if (parts_.empty()) return held_.sources[held_.sweeps[n].block];
  const SweepOfBlocks& part = parts_[n];
  const double share = part.pieces > 0 ? static_cast<double>(part.piece + 1) / part.pieces : 1.0;
  return {static_cast<int>(part.element), motions_.tool(part.element), share, std::nullopt};
}

JobSweeps CutSweeps::all() const {
  if (parts_.empty()) return held_;
  JobSweeps all{part(0, size()), {}, error_bound_mm};
  all.sources.reserve(size());
  for (size_t n = 0; n < size(); ++n) all.sources.push_back(source(n));
  return all;
}

size_t CutSweeps::bytes() const {
  return held_.sweeps.capacity() * sizeof(stock::Sweep) + held_.sources.capacity() * sizeof(SweepSource) +
         parts_.capacity() * sizeof(SweepOfBlocks);
}

}  // namespace swarf::sim

// The motions of all blocks of a path by number, made from the packed elements when they are asked for.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/index_iterator.h"
#include "motion/blocks/block_motion.h"

namespace swarf::motion {

/// A row of blocks, of a path or a part of it. Machines must outlive it; copies share what they hold.
class BlockMotions {
 public:
  /// None.
  BlockMotions() = default;
  /// Of a path of blocks. Axis values that the blocks do not give follow by continuity: the branch nearest to
  /// the values before, the first nearest to home; but a block that leaves the pole starts with the outer
  /// axis where it then needs it (pole_turn.h). Throws InputError "unreachable" for a position under the
  /// joint law that the machine has no axis values for.
  /// `by_tool`: the machine with each tool in its spindle (BlockMove::tool), or one for whatever tool.
  BlockMotions(const toolpath::Elements& elements, std::span<const kinematics::MachineModel> by_tool);

  size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  BlockMotion operator[](size_t i) const;
  BlockMotion front() const { return (*this)[0]; }
  BlockMotion back() const { return (*this)[count_ - 1]; }
  auto begin() const { return IndexIterator(*this, 0); }
  auto end() const { return IndexIterator(*this, count_); }
  BlockMotions subspan(size_t first, size_t count) const;

  toolpath::BlockMove block(size_t i) const { return elements_.block(first_ + i); }
  ToolPose block_end(size_t i) const { return elements_.block_end(first_ + i); }
  double feed_mm_s(size_t i) const { return elements_.feed_mm_s(first_ + i); }
  int tool(size_t i) const { return elements_.tool(first_ + i); }
  /// Some machine has a rotary axis.
  bool may_turn() const;
  /// Memory that is held beside the elements.
  size_t bytes() const { return found_ ? found_->capacity() * sizeof(toolpath::AxisSpan) : 0; }

 private:
  toolpath::Elements elements_;
  std::span<const kinematics::MachineModel> by_tool_;
  /// Of all blocks of the path, where not every one gives its own.
  std::shared_ptr<const std::vector<toolpath::AxisSpan>> found_;
  size_t first_ = 0, count_ = 0;
};

inline BlockMotions block_motions(const toolpath::ToolPath& path, const kinematics::MachineModel& machine) {
  return {path.elements, std::span(&machine, 1)};
}

/// Looks motions up, best in their order: the last one is kept.
class MotionReader {
 public:
  explicit MotionReader(BlockMotions motions) : motions_(std::move(motions)) {}
  /// Valid until the next call.
  const BlockMotion& at(size_t i) {
    if (!motion_ || i != at_) motion_ = motions_[i];
    at_ = i;
    return *motion_;
  }
  bool empty() const { return motions_.empty(); }

 private:
  BlockMotions motions_;
  std::optional<BlockMotion> motion_;
  size_t at_ = 0;
};

}  // namespace swarf::motion

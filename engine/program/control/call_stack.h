// Programs that call each other, as every dialect keeps them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace swarf::program::nc {

/// The code of the fault where more programs call each other than the control has levels.
inline constexpr const char* kRecursionLimit = "recursion-limit";

/// What runs, the main program first. `Frame`: what a dialect keeps of a running program.
template <class Frame>
class CallStack {
 public:
  void enter(Frame frame) { frames_.push_back(std::move(frame)); }
  Frame leave() {
    Frame left = std::move(frames_.back());
    frames_.pop_back();
    return left;
  }
  void clear() { frames_.clear(); }
  Frame& top() { return frames_.back(); }
  const Frame& top() const { return frames_.back(); }
  Frame& caller() { return frames_[frames_.size() - 2]; }
  Frame& operator[](size_t level) { return frames_[level]; }
  const Frame& operator[](size_t level) const { return frames_[level]; }
  bool empty() const { return frames_.empty(); }
  size_t size() const { return frames_.size(); }
  /// A called program runs, not the main one.
  bool called() const { return frames_.size() > 1; }
  /// So many calls run already.
  bool full(size_t calls_max) const { return frames_.size() > calls_max; }
  template <class Condition>
  size_t count(Condition holds) const {
    return static_cast<size_t>(std::count_if(frames_.begin(), frames_.end(), holds));
  }

 private:
  std::vector<Frame> frames_;
};

}  // namespace swarf::program::nc

// What the axes do over a program's time as straight lines between keys: for animations.
//
//   q ^        tolerance  /        A line leaves the last key. Every cycle narrows the cone of slopes that
//   pass
//     |     . ' /:       /         within the tolerance of it; as long as the slope to the cycle at hand lies
//     in |   key <  ' .    /          the cone, the key may be there. When none can be any more, the last
//     cycle that |          '  . '/           could becomes the next key. One pass, and no cycle is left out.
//
// The error is proven: no cycle's value is farther from the line between the two keys about it. Keys stand at
// cycles whose number a float holds exactly, and have values that are floats: files lose nothing more. When
// an axis has more than `most` keys (and more than its turns need), its tolerance is doubled and its keys are
// thinned by the same rule; what they are then off by adds to the error.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kinematics/machine_model.h"
#include "motion/tool_sample.h"

namespace swarf::motion {

struct AxisKey {
  uint64_t cycle = 0;
  double q = 0.0;  ///< mm or rad
};

/// Keys of one axis. Neighbours differ by less than `step_most`.
class KeyLine {
 public:
  KeyLine(double tolerance, double step_most, size_t most)
      : tolerance_(tolerance), step_most_(step_most), most_(most) {}
  /// Of the next cycle; numbers ascend.
  void add(uint64_t cycle, double q);
  /// Behind the last one.
  void finish();
  const std::vector<AxisKey>& keys() const { return keys_; }
  /// Proven; NaN before finish().
  double error() const { return error_; }
  /// The farthest that two neighbours are apart.
  double longest_step() const;

 private:
  struct Cone {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  };
  AxisKey end_at(const AxisKey& at) const;
  void see(const AxisKey& at);
  void begin(const AxisKey& key);
  void thin();

  double tolerance_;  ///< of the lines about the cycles since the last thinning
  double step_most_;
  size_t most_;
  std::vector<AxisKey> keys_;
  Cone cone_;
  bool has_end_ = false;
  AxisKey end_;                  ///< could be the next key
  std::vector<AxisKey> behind_;  ///< cycles since then, or since the last key
  double forced_ = 0.0;          ///< greatest error of a line that no cycle could end within the tolerance
  double rounding_ = 0.0;        ///< greatest that a key's value is off
  double thinned_ = 0.0;         ///< that thinning has added
  double error_ = std::numeric_limits<double>::quiet_NaN();
};

/// How far a turn is from an even one at most, rad, where a viewer mixes the quaternions of its two ends and
/// normalises them, as Blender does, instead of turning at one speed, as glTF has it. `turn_rad` < pi.
double mixing_error(double turn_rad);

/// The axes of a machine, and which tool is in the spindle.
class AxisKeys {
 public:
  /// Linear axes begin with `linear_mm`, rotary ones with `rotary_rad`.
  explicit AxisKeys(std::span<const kinematics::Axis> axes, double linear_mm = 0.02, double rotary_rad = 2e-4,
                    size_t most = kMost);
  void add(std::span<const Cycle> window);
  void finish();

  const std::vector<KeyLine>& axes() const { return lines_; }
  /// The first cycle of each tool that comes into the spindle, and its index.
  struct ToolKey {
    uint64_t cycle = 0;
    int tool = 0;
  };
  const std::vector<ToolKey>& tools() const { return tools_; }
  uint64_t first() const { return first_; }
  uint64_t last() const { return last_; }

  /// 16 bytes each in a file: 0.5 MB an axis.
  static constexpr size_t kMost = size_t{1} << 15U;

 private:
  std::vector<KeyLine> lines_;
  std::vector<ToolKey> tools_;
  uint64_t first_ = 0, last_ = 0;
  bool any_ = false;
};

}  // namespace swarf::motion

// The words of Heidenhain motion blocks, and what is said of words that nobody knows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "program/control/target.h"
#include "program/heidenhain/text.h"

namespace swarf::program::nc::heidenhain {

/// A word with a value; `offset` of its letters in the block.
struct Amount {
  double value = 0.0;
  size_t offset = 0;
  bool given = false, incremental = false;
  explicit operator bool() const { return given; }
};

struct MWord {
  int number = 0;
  size_t offset = 0;
  Amount amount;     ///< M140 MB, M128 F
  bool max = false;  ///< M140 MB MAX
  uint8_t axes = 0;  ///< M94 A B C, bit per nc::AxisWord
};

enum class FeedWord { kNone, kValue, kMax, kAuto, kPerRevolution };

/// The words of a motion block.
struct MotionWords {
  std::array<Amount, nc::kAxisWords> axes;
  Amount polar_radius, polar_angle, radius;
  Amount length, angle;  ///< LEN and CCA of APPR and DEP
  std::array<Amount, 3> normal, tool;
  std::optional<nc::Compensation> compensation;
  int sense = 0;  ///< DR+ 1, DR- -1
  FeedWord feed = FeedWord::kNone;
  Amount feed_value;
  std::vector<MWord> functions;
  bool any_linear() const { return axes[0] || axes[1] || axes[2]; }
  bool any_rotary() const { return axes[3] || axes[4] || axes[5]; }
  /// A block after which a modal cycle (M89) drills.
  bool positions() const { return any_linear() || polar_radius || polar_angle; }
  bool has_function(int number) const;
};

/// K1, K2, K3 of each axis (SPL).
using SplineWords = std::array<std::array<Amount, 3>, nc::kAxisWords>;

/// Which words a block may have besides M and F.
enum WordSet : unsigned {
  kAxesAllowed = 1,
  kPolarAllowed = 2,
  kRadiusAllowed = 4,
  kSenseAllowed = 8,
  kCompensationAllowed = 16,
  kVectorsAllowed = 32,
  kFeedAllowed = 64,
  kFunctionsAllowed = 128,
  kMachineAllowed = 256,        ///< M91
  kTcpAllowed = 512,            ///< M128
  kApproachAllowed = 2048,      ///< LEN, CCA
  kCoefficientsAllowed = 1024,  ///< K3X ..: `spline` takes them
};
/// What every motion may have.
inline constexpr unsigned kAlways = kFeedAllowed | kFunctionsAllowed | kCompensationAllowed;

/// Reads to the end of the block. "unknown-word", "unexpected-word", "word-twice", "unsupported-word".
MotionWords read_motion_words(BlockReader& reader, unsigned allowed, SplineWords* spline = nullptr);
/// "unknown-word" with the nearest known one, "unsupported-word" for one that the control knows.
[[noreturn]] void refuse_word(BlockReader& reader, size_t offset, std::string_view word);
}  // namespace swarf::program::nc::heidenhain

// What the blocks of a program do, one row for each, taken from their cycles as they come.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "motion/cycles/cycles.h"

namespace swarf::sim {

/// One element of the path.
struct BlockRow {
  int line = 0;                     ///< of the program
  double t_s = 0.0;                 ///< when the tool comes to the element's end, to a cycle: it never falls
  ToolPose pose;                    ///< of the programmed end, W
  kinematics::AxisValues q;         ///< there, mm and rad
  std::optional<double> feed_mm_s;  ///< greatest commanded feed that is reached; none: over within a cycle
  motion::SampleKind kind = motion::SampleKind::kCutting;
  size_t tool = 0;  ///< index into Scene::tools
};

/// Makes the rows in the order of the path. `cycles` must outlive it.
class BlockRows {
 public:
  BlockRows(const motion::Cycles& cycles, std::function<void(const BlockRow&)> visit)
      : cycles_(cycles), visit_(std::move(visit)) {}
  void add(std::span<const motion::Cycle> window);
  /// After the last window. A motion that was stopped has no row for the element under way.
  void finish();

 private:
  void flush_to(int element, double t_s);
  BlockRow row(int element, double t_s) const;

  const motion::Cycles& cycles_;
  std::function<void(const BlockRow&)> visit_;
  motion::Cycle last_;
  int element_ = 0;          ///< of the next row
  double feed_mm_s_ = -1.0;  ///< greatest of the element under way; below 0: it has no cycle yet
};

/// The rows of a finished motion; cycles that were not kept are made again.
std::vector<BlockRow> block_rows(const motion::Cycles& cycles);

/// Columns of tables, in every format: tip_x_mm, tip_y_mm, tip_z_mm, i, j, k.
inline constexpr std::array<const char*, 6> kPoseColumns{"tip_x_mm", "tip_y_mm", "tip_z_mm", "i", "j", "k"};

/// axis_X_mm, axis_A_deg: never the tip's name in other letters.
std::string axis_column(const kinematics::Axis& axis);

/// In the unit of its column.
double axis_column_value(const kinematics::Axis& axis, double value);

}  // namespace swarf::sim

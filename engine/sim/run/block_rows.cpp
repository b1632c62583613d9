#include "sim/run/block_rows.h"

#include <algorithm>

#include "base/units.h"

namespace swarf::sim {

void BlockRows::add(std::span<const motion::Cycle> window) {
  for (const motion::Cycle& cycle : window) {
    if (cycle.sample.element != element_) flush_to(cycle.sample.element, cycle.sample.t_s);
    feed_mm_s_ = std::max(feed_mm_s_, cycle.sample.feed_mm_s);
    last_ = cycle;
  }
}

/// Rows of all elements before this one, which begins at t_s.
void BlockRows::flush_to(int element, double t_s) {
  for (; element_ < element; ++element_) {
    visit_(row(element_, t_s));
    feed_mm_s_ = -1.0;
  }
}

BlockRow BlockRows::row(int element, double t_s) const {
  BlockRow row{cycles_.elements().line(static_cast<size_t>(element)),
               t_s,
               last_.sample.pose,
               last_.q,
               feed_mm_s_ >= 0.0 ? std::optional<double>(feed_mm_s_) : std::nullopt,
               last_.sample.kind,
               static_cast<size_t>(last_.sample.tool)};
  if (cycles_.motions().empty()) return row;
  const motion::BlockMotion motion = cycles_.motions()[static_cast<size_t>(element)];
  row.pose = motion.block.to;
  row.q = motion.q_to;
  row.kind = is_rapid(motion.block) ? motion::SampleKind::kRapid : motion::SampleKind::kCutting;
  row.tool = static_cast<size_t>(motion.block.tool);
  return row;
}

void BlockRows::finish() {
  if (cycles_.size() > 0 && !cycles_.stopped())
    flush_to(static_cast<int>(cycles_.elements().size()), last_.sample.t_s);
}

std::vector<BlockRow> block_rows(const motion::Cycles& cycles) {
  std::vector<BlockRow> rows;
  BlockRows maker(cycles, [&rows](const BlockRow& row) { rows.push_back(row); });
  motion::CycleReader reader(cycles);
  for (size_t k = 0; k < cycles.size(); ++k) maker.add({&reader.at(k), 1});
  maker.finish();
  return rows;
}

std::string axis_column(const kinematics::Axis& axis) {
  return "axis_" + axis.name + (axis.kind == kinematics::AxisKind::kRotary ? "_deg" : "_mm");
}

double axis_column_value(const kinematics::Axis& axis, double value) {
  return axis.kind == kinematics::AxisKind::kRotary ? deg_from_rad(value) : value;
}

}  // namespace swarf::sim

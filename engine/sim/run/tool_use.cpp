#include "sim/run/tool_use.h"

#include <algorithm>

#include "motion/judged/motion_statistics.h"
#include "sim/run/box_height.h"

namespace swarf::sim {

OperationMeter::OperationMeter(const Job& job, const motion::Cycles& cycles)
    : job_(job), cycles_(cycles), raw_W_(job.scene.stock.box_W) {}

void OperationMeter::add(std::span<const motion::Cycle> window) {
  for (const motion::Cycle& now : window) {
    if (element_ != now.sample.element) {
      element_ = now.sample.element;
      const toolpath::Element element = cycles_.elements()[static_cast<size_t>(element_)];
      const auto* block = std::get_if<toolpath::BlockMove>(&element.what);
      rapid_ = motion::is_rapid_element(element);
      dwells_ = block != nullptr && block->dwell_s > 0.0;
      line_ = cycles_.elements().line(static_cast<size_t>(element_));
    }
    if (operations_.empty() || operations_.back().tool != now.sample.tool)
      operations_.push_back({now.sample.tool, line_});
    see_time(now);
    see_depth(now);
    last_ = now;
  }
}

void OperationMeter::see_time(const motion::Cycle& now) {
  if (!last_) return;
  Operation& own = operations_.back();
  const bool changed = last_->sample.tool != now.sample.tool;
  const bool rests = dwells_ && now.sample.u == 0.0;  // a block's dwell stands at its start
  const double time = now.sample.t_s - last_->sample.t_s;
  (changed || rapid_ ? own.rapid_s : rests ? own.dwell_s : own.feed_s) += time;
  const Vec3 step = now.sample.pose.tip_W - last_->sample.pose.tip_W;
  if (!changed && !rapid_) own.feed_mm += step.norm();
  // No point of the tool within the box's height has gone farther since the last cycle.
  const double turned = (now.sample.pose.axis_W - last_->sample.pose.axis_W).norm();
  see_holder(now, changed ? 0.0 : step.norm() + turned * raw_W_.size().norm());
}

void OperationMeter::see_depth(const motion::Cycle& now) {
  Operation& own = operations_.back();
  if (rapid_ || height_of_box(raw_W_, now.sample.pose) <= own.deepest_mm) return;
  const double radius = job_.scene.tools[static_cast<size_t>(own.tool)].radius();
  const auto height = height_in_cylinder(raw_W_, now.sample.pose, radius);
  own.deepest_mm = std::max(own.deepest_mm, height.value_or(0.0));
}

/// All of the holder's sections, over the motion since the last cycle.
void OperationMeter::see_holder(const motion::Cycle& now, double way_mm) {
  Operation& own = operations_.back();
  const double highest = height_of_box(raw_W_, now.sample.pose) + way_mm;
  double above = 0.0;
  for (const cutter::ToolSection& section : job_.scene.tools[static_cast<size_t>(own.tool)].holder) {
    if (highest - above <= own.stick_out_mm) return;
    const double radius = 0.5 * std::max(section.diameter_mm, section.top_diameter_mm);
    const auto height = height_in_cylinder(raw_W_, now.sample.pose, radius + way_mm);
    if (height) own.stick_out_mm = std::max(own.stick_out_mm, *height + way_mm - above);
    above += section.length_mm;
  }
}

}  // namespace swarf::sim

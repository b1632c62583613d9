// M functions of Heidenhain programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/units.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

using nc::Target;

namespace {

/// M functions of the control whose effect on the path or its time is not executed here.
constexpr int kUnsupported[] = {92, 97, 98, 103, 105, 106, 109, 110, 112, 124, 130, 138, 143, 150, 197};

bool unsupported(int number) {
  return std::find(std::begin(kUnsupported), std::end(kUnsupported), number) != std::end(kUnsupported);
}

/// Executed elsewhere in the block.
bool executed(int number) {
  constexpr int kExecuted[] = {2,   3,   4,   5,   30,  89,  91,  94,  99,  114, 115,
                               116, 117, 126, 127, 128, 129, 136, 137, 140, 144, 145};
  return std::find(std::begin(kExecuted), std::end(kExecuted), number) != std::end(kExecuted);
}

/// M94: whole turns of rotary positions are forgotten; the axis itself stands.
void reduce_display(nc::Control& control, const MWord& word) {
  kinematics::AxisValues shift = control.space.shift();
  const auto position = nc::position(control);
  for (int slot = nc::kA; slot < nc::kAxisWords; ++slot) {
    const int axis = control.space.axis_of(static_cast<nc::AxisWord>(slot));
    const double value = position[static_cast<size_t>(slot)];
    const bool meant = word.axes == 0 || (word.axes >> slot & 1u) != 0;
    if (axis >= 0 && meant && std::isfinite(value)) shift[axis] += kTurn * std::floor(value / kTurn + 1e-12);
  }
  nc::set_shift(control, shift);
}

/// Whether the linear axes end somewhere.
bool ends_of_travel_known(const nc::Control& control) {
  for (int i = 0; i < 3; ++i) {
    const int index = control.space.axis_of(static_cast<nc::AxisWord>(i));
    const kinematics::Axis& axis = control.setup.machine.axes[static_cast<size_t>(index)];
    if (std::isfinite(axis.min) && std::isfinite(axis.max)) return true;
  }
  return false;
}

/// M140 MB50 at F of its block, or rapid.
void retract(nc::Control& control, PathState& path, BlockReader& reader, const MWord& word,
             const MotionWords& words) {
  no_open_corner(path, reader, word.offset);
  if (word.max && !ends_of_travel_known(control)) {
    control.report.without_effect("M140 MB MAX (the machine has no ends of travel)");
    control.report.warn_once("no-end-of-travel", reader.column(word.offset),
                             "M140 MB MAX retracts to the end of travel, and this machine has none: the tool "
                             "stays where it is",
                             "name the machine: --machine, in a scene `machine`");
    return;
  }
  if (!control.path.started) {
    reader.fail("start-unknown", word.offset, "M140 retracts, and the position is not known yet",
                "position all axes before it");
  }
  const bool at_feed = words.feed == FeedWord::kValue && words.feed_value.value > 0.0;
  const Motion motion = at_feed ? Motion::kFeed : Motion::kRapid;
  if (at_feed) set_feed(control, words.feed_value.value, false);
  if (word.max) return retract_by(control, path, std::nullopt, motion);
  if (!(word.amount.value > 0.0))
    reader.fail("out-of-range", word.amount.offset, "M140 MB retracts by a way above zero", "M140 MB50");
  retract_by(control, path, control.modal.mm(word.amount.value), motion);
}

}  // namespace

void functions_before(Executor& executor, BlockReader& reader, const MotionWords& words) {
  for (const MWord& word : words.functions) {
    if (unsupported(word.number) || (word.number >= 200 && word.number <= 204)) {
      reader.fail("unsupported-word", word.offset,
                  fmt::format("M{} is known, but not supported here", word.number),
                  "post the program without it");
    }
  }
  for (const MWord& word : words.functions) {
    switch (word.number) {
      case 3:
      case 13:
        executor.control.modal.spindle = 1;
        break;
      case 4:
      case 14:
        executor.control.modal.spindle = -1;
        break;
      case 94:
        reduce_display(executor.control, word);
        break;
      case 114:
      case 144:
        compensate_heads(executor.control, executor.orientation, reader, word.offset, true);
        break;
      case 116:
      case 117:
        executor.modes.rotary_feed_mm = word.number == 116;
        break;
      case 126:
      case 127:
        executor.modes.shortest = word.number == 126;
        break;
      case 128:
        set_tcpm(executor.control, executor.orientation, true, false, false, false);
        break;
      case 136:
      case 137:
        executor.modes.per_revolution = word.number == 136;
        nc::set_feed_mode(executor.control.modal, executor.modes.per_revolution ? nc::FeedMode::kPerRevolution
                                                                                : nc::FeedMode::kPerMinute);
        break;
      case 140:
        retract(executor.control, executor.path, reader, word, words);
        break;
      default:
        break;
    }
    if (word.number == 13 || word.number == 14) executor.control.report.without_effect("M8");
    if (!executed(word.number) && word.number != 13 && word.number != 14) {
      executor.control.report.without_effect(fmt::format("M{}", word.number));
      executor.control.report.note(fmt::format("M{}", word.number), "");
    }
  }
}

void functions_after(Executor& executor, BlockReader& reader, const std::vector<MWord>& words) {
  for (const MWord& word : words) {
    if (word.number == 5 || word.number == 2 || word.number == 30) executor.control.modal.spindle = 0;
    if (word.number == 129) set_tcpm(executor.control, executor.orientation, false, false, false, false);
    if (word.number == 115 || word.number == 145)
      compensate_heads(executor.control, executor.orientation, reader, word.offset, false);
    if (word.number == 89) executor.drilling.modal_call = true;
    if (word.number == 99) {
      run_cycle(executor, reader, word.offset);
      executor.drilling.modal_call = false;
    }
    if (word.number == 2 || word.number == 30) executor.flow.stop(reader, word.offset);
  }
}

/// Along the tool, by a way or up to the end of the first axis' travel.
void retract_by(nc::Control& control, PathState& path, std::optional<double> way, Motion motion) {
  nc::flush(control);
  const kinematics::MachineModel& machine = control.setup.machine;
  const kinematics::AxisValues& q = control.path.q;
  const ToolPose here = kinematics::forward(machine, q);
  Vec3 direction = linear_columns_W(machine, q).inverse() * here.axis_W;
  direction = direction.unaryExpr([](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; });
  double length = way.value_or(std::numeric_limits<double>::infinity());
  for (int i = 0; i < 3 && !way; ++i) {
    const int index = control.space.axis_of(static_cast<nc::AxisWord>(i));
    const kinematics::Axis& axis = machine.axes[static_cast<size_t>(index)];
    if (direction[i] != 0.0) {
      const double end = direction[i] > 0.0 ? axis.max : axis.min;
      length = std::min(length, std::max(0.0, (end - q[index]) / direction[i]));
    }
  }
  Target target;
  target.column = control.report.place.column;
  for (int i = 0; i < 3; ++i) target.set(i, length * direction[i], true);
  nc::machine_line(control, motion, target);
  path.tangent.reset();
}

}  // namespace swarf::program::nc::heidenhain

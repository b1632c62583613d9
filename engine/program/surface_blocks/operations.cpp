#include "program/surface_blocks/operations.h"

#include <fmt/format.h>

#include "base/units.h"

namespace swarf::program {

Modal modal_after(const CheckedBlock& block, Modal modal, Reporter& reporter) {
  if (block.values.has('T')) modal.selected_tool = block.values.whole('T');
  if (block.m_column[6] > 0) {
    if (modal.selected_tool == 0 && find_word(*block.words, 'T') == nullptr) {
      reporter.error("no-tool", block.line, block.m_column[6],
                     "M6 loads a tool, but no T word has chosen one",
                     "write the tool number before it: T1 M6");
    }
    modal.loaded_tool = modal.selected_tool;
    modal.spindle_on = false;
  }
  modal.speed_rpm = block.values.get('S', modal.speed_rpm);
  if (block.m_column[3] > 0 || block.m_column[4] > 0) modal.spindle_on = true;
  if (block.m_column[5] > 0) modal.spindle_on = false;
  if (block.m_column[4] > 0) {
    reporter.warning("spindle-reversed", block.line, block.m_column[4],
                     "M4 turns the spindle counter-clockwise: right-hand cutters do not cut", "write M3");
  }
  modal.feed_mm_min = block.values.get('F', modal.feed_mm_min);
  return modal;
}

void check_ready_to_cut(const Modal& modal, const CheckedBlock& block, Reporter& reporter) {
  const char* name = name_of(block.action);
  if (modal.feed_mm_min <= 0.0 && find_word(*block.words, 'F') == nullptr) {
    reporter.error("missing-feed", block.line, block.action_column,
                   fmt::format("{} has no feed: no F word here or before", name),
                   "add the feed in mm/min: F3000");
  }
  if (modal.loaded_tool == 0) {
    reporter.error("no-tool", block.line, block.action_column, fmt::format("{} cuts without a tool", name),
                   "load one before it: T1 M6");
  }
  if (!modal.spindle_on || modal.speed_rpm <= 0.0) {
    reporter.error(
        "spindle-stopped", block.line, block.action_column,
        fmt::format("{} cuts while the spindle stands ({}, S {:g} rev/min)", name,
                    modal.spindle_on ? "M3 is on" : "no M3 since the start, M5 or M6", modal.speed_rpm),
        "start it before, after the tool change: S12000 M3");
  }
}

Operation make_operation(const Modal& modal, const CheckedBlock& block, const SurfaceEntry& entry,
                         const Reporter& reporter) {
  const Values& values = block.values;
  Operation operation;
  operation.kind = block.action == Action::kArea      ? OperationKind::kArea
                   : block.action == Action::kIsoPass ? OperationKind::kIsoPass
                                                      : OperationKind::kFlank;
  operation.surface = entry.index;
  operation.start = static_cast<StartBoundary>(values.whole('B'));
  operation.zigzag = values.whole('L') == 1;
  operation.scallop_mm = values.get('E', operation.scallop_mm);
  operation.chord_tolerance_mm = values.get('K', operation.chord_tolerance_mm);
  operation.feed_mm_s = mm_s_from_mm_min(modal.feed_mm_min);
  operation.lead_rad = rad_from_deg(values.get('I', 0.0));
  operation.tilt_rad = rad_from_deg(values.get('J', 0.0));
  operation.iso_v = values.get('V', 0.0);
  operation.tool = modal.loaded_tool;
  operation.spindle_rpm = modal.speed_rpm;
  operation.where = reporter.at(block.line, block.action_column);
  return operation;
}

}  // namespace swarf::program

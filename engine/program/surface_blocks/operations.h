// G06.3, G06.4 and G06.5: what must hold before the cutter may touch a surface.
#pragma once

#include "program/surface_blocks/program.h"
#include "program/surface_blocks/table.h"

namespace swarf::program {

/// What modal words have set.
struct Modal {
  int selected_tool = 0;  ///< T
  int loaded_tool = 0;    ///< T at the last M6
  double speed_rpm = 0.0;
  bool spindle_on = false;
  double feed_mm_min = 0.0;  ///< 0: none yet
};

/// The state after the modal words of a block, in a control's order: tool change (which stops the spindle),
/// speed, spindle, feed. Reports "no-tool" for M6 without T, and "spindle-reversed" (a warning) for M4.
Modal modal_after(const CheckedBlock& block, Modal modal, Reporter& reporter);

/// Reports "missing-feed", "no-tool" and "spindle-stopped" for an operation under these modal words.
void check_ready_to_cut(const Modal& modal, const CheckedBlock& block, Reporter& reporter);

/// The operation of a block that has passed all checks.
Operation make_operation(const Modal& modal, const CheckedBlock& block, const SurfaceEntry& entry,
                         const Reporter& reporter);

}  // namespace swarf::program

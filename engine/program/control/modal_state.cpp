#include "program/control/modal_state.h"

#include <fmt/format.h>

#include "program/move_way.h"

namespace swarf::program::nc {

void set_feed_mode(ModalState& modal, FeedMode mode) {
  if (mode == modal.feed_mode) return;
  modal.feed_mode = mode;
  modal.feed = 0.0;
  modal.feed_fresh = false;
}

void set_feed_in(const Report& report, ModalState& modal, double unit_mm, double value, int column) {
  if (!(value > 0.0)) {
    report.fail("bad-feed", column, fmt::format("F {:g} is not a feed", value),
                "write a feed above zero: F1000");
  }
  modal.feed = value;
  modal.feed_unit_mm = unit_mm;
  modal.feed_fresh = true;
}

void restore_feed(ModalState& modal, FeedMode mode, double feed) {
  modal.feed_mode = mode;
  modal.feed = feed;
  modal.feed_unit_mm = modal.unit_mm;
  modal.feed_fresh = false;
}

void dwell(const Report& report, ModalState& modal, double seconds) {
  if (!(seconds >= 0.0)) {
    report.fail("out-of-range", 0, fmt::format("a dwell of {:g} s", seconds), "write a time of zero or more");
  }
  modal.pending_dwell_s += seconds;
  if (modal.pending_dwell_s > 3600.0 * kHoursMax)
    report.fail("too-many-cycles", 0,
                fmt::format("the program dwells for {:.3g} h here, more than {:g} h",
                            modal.pending_dwell_s / 3600.0, kHoursMax),
                "mend the dwell of this block");
}

}  // namespace swarf::program::nc

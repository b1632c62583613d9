// The modal words of a control that stay from block to block, as plain data.
#pragma once

#include <array>

#include "program/control/report.h"
#include "program/control/target.h"

namespace swarf::program::nc {

/// The radius at which one degree is one mm of arc.
inline constexpr double kDegreePerMm = 57.29577951308232;

struct ModalState {
  double unit_mm = 1.0;     ///< 25.4 in inches
  bool unit_known = false;  ///< the program has said its unit, or the setup says the machine's
  Plane plane = Plane::kXY;
  FeedMode feed_mode = FeedMode::kPerMinute;
  FeedRule feed_rule = FeedRule::kLinearFirst;
  /// Radii at which rotary axes A B C count for F, mm; 180/pi as long as none is set: a degree is a mm.
  std::array<double, 3> feed_radii_mm{kDegreePerMm, kDegreePerMm, kDegreePerMm};
  double feed = 0.0;          ///< as written: units/min and deg/min, units/rev, or 1/min; 0: none
  double feed_unit_mm = 1.0;  ///< of the length in F
  bool feed_fresh = false;    ///< F stood in this block
  double speed_rpm = 0.0;
  int spindle = 0;  ///< +1 clockwise (M3), -1 counter-clockwise (M4), 0 stopped (M5)
  bool exact_stop = false;
  bool exact_stop_once = false;  ///< G9
  double corner_tolerance_mm = 0.0;
  double pending_dwell_s = 0.0;  ///< the next move waits this long before it starts

  bool inches() const { return unit_mm != 1.0; }
  double mm(double program_length) const { return program_length * unit_mm; }
};

/// A modal word that is put back when the scope ends: what a cycle borrows does not outlive it.
template <class T>
class Borrowed {
 public:
  explicit Borrowed(T& word) : word_(word), kept_(word) {}
  ~Borrowed() { word_ = kept_; }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;
  const T& kept() const { return kept_; }

 private:
  T& word_;
  const T kept_;
};

inline void set_inches(ModalState& modal, bool inches) {
  modal.unit_mm = inches ? 25.4 : 1.0;
  modal.unit_known = true;
}
/// A new mode forgets F, as controls do; G93 wants F in each feed block ("missing-feed").
void set_feed_mode(ModalState& modal, FeedMode mode);
/// Where F counts in other units of length than X Y Z do; above 0 ("bad-feed"). It is a speed: a later change
/// of the units leaves it what it is.
void set_feed_in(const Report& report, ModalState& modal, double unit_mm, double value, int column);
inline void set_feed(const Report& report, ModalState& modal, double value, int column) {
  set_feed_in(report, modal, modal.unit_mm, value, column);
}
/// The mode and the F (0: none), in the units that hold; no F of the present block.
void restore_feed(ModalState& modal, FeedMode mode, double feed);
/// G4. Zero or more ("out-of-range").
void dwell(const Report& report, ModalState& modal, double seconds);

}  // namespace swarf::program::nc

// Canned drilling cycles as data: a dialect fills in what its words mean, the control expands them into
// moves.
#pragma once

#include "program/control/target.h"

namespace swarf::program::nc {

/// What the tool does on the way down and at the bottom. All heights are program coordinates along the
/// plane's normal, mm.
///
///   safe ----.........   rapid to the hole at the present height, rapid to `approach`,
///            :       ^   feed (in pecks) to `bottom`, dwell, spindle, then out to `retract`
///   approach +--.    :
///               |feed:
///   bottom      +----+
struct DrillCycle {
  double approach = 0.0;  ///< R plane: where the feed starts
  double bottom = 0.0;
  double retract = 0.0;  ///< where the tool goes at last (G98: the height before the cycle, G99: approach)
  enum class Peck { kNone, kFull, kChipBreak };
  Peck peck = Peck::kNone;
  double peck_mm = 0.0;        ///< depth per peck, above 0 with pecking
  double first_peck_mm = 0.0;  ///< depth of the first one below `approach`; 0: peck_mm
  /// Each peck is smaller than the one before it by this much, down to this much; what is then left is
  /// drilled in pecks of this size, the last two of them alike. 0: all pecks are peck_mm.
  double degression_mm = 0.0;
  double clearance_mm =
      0.0;               ///< kFull: rapid back down to this above the last depth; kChipBreak: retreat by this
  double dwell_s = 0.0;  ///< at the bottom
  double dwell_out_s = 0.0;        ///< with feed_out: at `approach`, on the way out (tapping of Fanuc)
  bool feed_out = false;           ///< out at feed (boring, tapping) to `approach`, then rapid to `retract`
  bool feed_to_retract = false;    ///< with feed_out: at feed up to `retract`
  bool stop_at_bottom = false;     ///< G86: the spindle stops at the bottom, starts again at the top
  bool reverse_at_bottom = false;  ///< G84, G74: tapping, the spindle turns the other way on the way out
  bool manual_out = false;         ///< G88: the spindle stops at the bottom, the tool is drawn out by hand to
                                   ///< `approach`, where the spindle starts again
  double pitch_mm = 0.0;           ///< tapping: mm/rev, the feed is pitch x speed; 0: the programmed feed
  /// Boring bars with one edge pass the bore beside its axis with the spindle stopped at a known angle.
  ///   kFine (G76): at the bottom the spindle stops oriented, rapid by `aside`, rapid to `retract`, back.
  ///   kBack (G87): over the hole the spindle stops oriented, rapid by `aside`, rapid down to `approach`,
  ///                which lies below the face to cut, back; the spindle turns, feed up to `bottom`, dwell,
  ///                (feed down to `approach` where `feed_out` is set,) oriented stop, rapid by `aside`, rapid
  ///                to `retract`, back.
  enum class Bore { kPlain, kFine, kBack };
  Bore bore = Bore::kPlain;
  Vec3 aside = Vec3::Zero();  ///< away from the edge, in the plane, program coordinates, mm
};

}  // namespace swarf::program::nc

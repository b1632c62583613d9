// Names of the codes of RS274/NGC, in tenths of their numbers.
#pragma once

#include "program/letters/codes.h"

namespace swarf::program::nc::linuxcnc {

struct G : IsoG {
  enum : int {
    kCubicSpline = 50,           ///< G5
    kQuadraticSpline = 51,       ///< G5.1
    kNurbsPoint = 52,            ///< G5.2
    kNurbsEnd = 53,              ///< G5.3
    kSetReference = 281,         ///< G28.1
    kSetSecondReference = 301,   ///< G30.1
    kCompensationLeftBy = 411,   ///< G41.1
    kCompensationRightBy = 421,  ///< G42.1
    kLengthBy = 431,             ///< G43.1
    kLengthAdded = 432,          ///< G43.2
    kArcAbsolute = 901,          ///< G90.1
    kShiftClear = 921,           ///< G92.1
    kShiftOff = 922,             ///< G92.2
    kShiftRestore = 923,         ///< G92.3
  };
};

struct M {
  enum : int {
    kEnd = 20,                   ///< M2
    kEndExchange = 300,          ///< M30
    kSaveState = 700,            ///< M70
    kForgetState = 710,          ///< M71
    kRestoreState = 720,         ///< M72
    kSaveAndRestoreState = 730,  ///< M73
    kCall = 980,                 ///< M98
    kReturn = 990,               ///< M99
    kFirstKinematics = 4280,     ///< M428
    kSecondKinematics = 4290,    ///< M429
    kThirdKinematics = 4300,     ///< M430
  };
};

}  // namespace swarf::program::nc::linuxcnc

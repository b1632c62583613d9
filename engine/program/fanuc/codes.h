// Names of the codes of the Fanuc dialect, in tenths of their numbers.
#pragma once

#include "program/letters/codes.h"

namespace swarf::program::nc::fanuc {

struct G : IsoG {
  enum : int {
    kNurbs = 62,                ///< G06.2
    kExactStopOnce = 90,        ///< G09
    kEndSetData = 110,          ///< G11
    kPolarOff = 150,            ///< G15
    kPolarOn = 160,             ///< G16
    kCheckReference = 270,      ///< G27
    kFromReference = 290,       ///< G29
    kTcpRotaries = 434,         ///< G43.4
    kTcpVectors = 435,          ///< G43.5
    kLengthNegative = 440,      ///< G44
    kScaleOff = 500,            ///< G50
    kMirrorOff = 501,           ///< G50.1
    kScaleOn = 510,             ///< G51
    kMirrorOn = 511,            ///< G51.1
    kTiltRotaries = 531,        ///< G53.1
    kTiltAboutTip = 536,        ///< G53.6
    kFurtherOffset = 541,       ///< G54.1
    kMacroCall = 650,           ///< G65
    kModalMacro = 660,          ///< G66
    kModalMacroOff = 670,       ///< G67
    kTurnOn = 680,              ///< G68
    kTiltedPlane = 682,         ///< G68.2
    kPlaneByTool = 683,         ///< G68.3
    kFurtherTiltedPlane = 684,  ///< G68.4
    kTurnOff = 690,             ///< G69
  };
};
/// The code that selects the n-th work offset: G54 is the first.
constexpr int work_offset_code(int n) {
  return 530 + 10 * n;
}
constexpr int work_offset_number(int code) {
  return (code - 530) / 10;
}

struct M {
  enum : int {
    kEnd = 20,                      ///< M02
    kSpindleClockwise = 30,         ///< M03
    kSpindleCounterClockwise = 40,  ///< M04
    kSpindleStop = 50,              ///< M05
    kEndRewind = 300,               ///< M30
    kCallLocal = 970,               ///< M97, of derived dialects: a subprogram from a block number on
    kCall = 980,                    ///< M98
    kReturn = 990,                  ///< M99
    kCallFile = 1980,               ///< M198
  };
};

}  // namespace swarf::program::nc::fanuc

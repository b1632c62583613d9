// Names of the G codes that mean the same in every dialect of ISO words, in tenths of their numbers.
#pragma once

namespace swarf::program::nc {

struct IsoG {
  enum : int {
    kRapid = 0,                 ///< G0
    kStraight = 10,             ///< G1
    kArcClockwise = 20,         ///< G2
    kArcCounterClockwise = 30,  ///< G3
    kDwell = 40,                ///< G4
    kSetData = 100,             ///< G10
    kPlaneXY = 170,             ///< G17
    kPlaneZX = 180,             ///< G18
    kPlaneYZ = 190,             ///< G19
    kInches = 200,              ///< G20
    kMillimetres = 210,         ///< G21
    kToReference = 280,         ///< G28
    kToSecondReference = 300,   ///< G30
    kCompensationOff = 400,     ///< G40
    kCompensationLeft = 410,    ///< G41
    kCompensationRight = 420,   ///< G42
    kLengthOn = 430,            ///< G43
    kLengthOff = 490,           ///< G49
    kLocalShift = 520,          ///< G52
    kMachineCoordinates = 530,  ///< G53
    kExactPath = 610,           ///< G61
    kExactStopPath = 611,       ///< G61.1
    kContinuousPath = 640,      ///< G64
    kDrillChipBreak = 730,      ///< G73
    kTapLeft = 740,             ///< G74
    kFineBore = 760,            ///< G76
    kCycleOff = 800,            ///< G80
    kDrill = 810,               ///< G81
    kDrillDwell = 820,          ///< G82
    kDrillDeep = 830,           ///< G83
    kTap = 840,                 ///< G84
    kBoreFeedOut = 850,         ///< G85
    kBoreStopOut = 860,         ///< G86
    kBackBore = 870,            ///< G87
    kBoreManualOut = 880,       ///< G88
    kBoreDwellOut = 890,        ///< G89
    kAbsolute = 900,            ///< G90
    kIncremental = 910,         ///< G91
    kShift = 920,               ///< G92
    kInverseTime = 930,         ///< G93
    kPerMinute = 940,           ///< G94
    kPerRevolution = 950,       ///< G95
    kRetractToStart = 980,      ///< G98
    kRetractToR = 990,          ///< G99
  };
};

}  // namespace swarf::program::nc

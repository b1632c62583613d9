// The words of the Fanuc dialect as data.
#include "program/fanuc/state.h"

namespace swarf::program::nc::fanuc {
namespace {

constexpr auto kRead = Code::Use::kRead;
constexpr auto kNoEffect = Code::Use::kNoEffect;
constexpr auto kArguments = Code::Use::kArguments;
constexpr auto kUnsupported = Code::Use::kUnsupported;

constexpr Code kGCodes[] = {
    {0, 1},
    {10, 1},
    {20, 1},
    {30, 1},
    {22, 1, kUnsupported, "involute"},
    {23, 1, kUnsupported, "exponential curve"},
    {24, 1, kUnsupported, "arc in space"},
    {32, 1, kUnsupported, "involute"},
    {33, 1, kUnsupported, "exponential curve"},
    {34, 1, kUnsupported, "arc in space"},
    {61, 1, kUnsupported, "spline"},
    {62, 1},
    {40, 0},
    {50, kFree, kNoEffect, "high precision contour control"},
    {51, kFree, kNoEffect, "AI contour control"},
    {71, 0, kUnsupported, "cylindrical interpolation"},
    {80, kFree, kNoEffect, "look-ahead control"},
    {90, 0},
    {100, 0},
    {110, 0},
    {121, 21, kUnsupported, "polar coordinate interpolation"},
    {131, 21, kNoEffect, "polar interpolation off"},
    {150, 17},
    {160, 17},
    {170, 2},
    {180, 2},
    {190, 2},
    {200, 6},
    {210, 6},
    {220, 4, kNoEffect, "stroke check on"},
    {230, 4, kNoEffect, "stroke check off"},
    {270, 0},
    {280, 0},
    {290, 0},
    {300, 0},
    {310, 0, kUnsupported, "skip"},
    {330, 1, kUnsupported, "threading"},
    {400, 7},
    {410, 7},
    {420, 7},
    {412, 7, kUnsupported, "cutter compensation in space"},
    {422, 7, kUnsupported, "cutter compensation in space"},
    {430, 8},
    {434, 8},
    {435, 8},
    {440, 8},
    {490, 8},
    {491, 8, kUnsupported, "another offset cancel"},
    {500, 11},
    {510, 11},
    {501, 18},
    {511, 18},
    {520, 0},
    {530, 0},
    {531, 0},
    {536, 0},
    {540, 14},
    {541, 14},
    {542, 19, kUnsupported, "rotary table dynamic offset"},
    {544, 19, kUnsupported, "workpiece setting error"},
    {550, 14},
    {560, 14},
    {570, 14},
    {580, 14},
    {590, 14},
    {600, 0, kUnsupported,
     "positioning from one side, by a way that parameter 5440 says; G00 ends there too"},
    {610, 15},
    {611, 15},
    {620, 15, kNoEffect, "corner override"},
    {630, 15, kUnsupported, "tapping mode"},
    {640, 15},
    {650, 0, kArguments},
    {660, 12, kArguments},
    {661, 12, kUnsupported, "macro call in each block"},
    {670, 12},
    {680, 16},
    {682, 16},
    {683, 16},
    {684, 16},
    {690, 16},
    {730, 9},
    {740, 9},
    {760, 9},
    {800, 9},
    {810, 9},
    {820, 9},
    {830, 9},
    {840, 9},
    {850, 9},
    {860, 9},
    {870, 9},
    {880, 9},
    {890, 9},
    {900, 3},
    {910, 3},
    {920, 0},
    {930, 5},
    {940, 5},
    {950, 5},
    {960, 13, kUnsupported, "constant surface speed"},
    {970, 13, kRead},
    {980, 10},
    {990, 10},
    {1870, 0, kUnsupported, "smoothness on controls of another maker; Fanuc has G05.1"},
    {3320, 0, kUnsupported, "high precision mode of another maker; Fanuc has G05.1"},
};

constexpr Code kMCodes[] = {
    {0, 0, kNoEffect, "program stop"},
    {10, 0, kNoEffect, "optional stop"},
    {20, 0},
    {300, 0},
    {60, 1},
    {30, 2},
    {40, 2},
    {50, 2},
    {70, kFree, kNoEffect, "coolant"},
    {80, kFree, kNoEffect, "coolant"},
    {90, kFree, kNoEffect, "coolant off"},
    {100, kFree, kNoEffect, "clamp"},
    {110, kFree, kNoEffect, "unclamp"},
    {190, kFree, kNoEffect, "spindle orientation"},
    {290, kFree, kNoEffect, "rigid tapping"},
    {480, kFree, kNoEffect, "override"},
    {490, kFree, kNoEffect, "override"},
    {980, 0},
    {990, 0},
    {1980, 0},
};

static_assert(fits_tables(kGCodes) && fits_tables(kMCodes));
const CodeTable kGTable{kGCodes};
const CodeTable kMTable{kMCodes};

constexpr FunctionWord kFunctions[] = {
    {"ABS", Function::kAbs},  {"ACOS", Function::kAcos}, {"ASIN", Function::kAsin},
    {"COS", Function::kCos},  {"EXP", Function::kExp},   {"FIX", Function::kTruncate},
    {"FUP", Function::kAway}, {"LN", Function::kLn},     {"ROUND", Function::kRound},
    {"SIN", Function::kSin},  {"SQRT", Function::kSqrt}, {"TAN", Function::kTan},
};
constexpr OperatorWord kOperators[] = {
    {"*", Operator::kMultiply, 4},  {"/", Operator::kDivide, 4},     {"AND", Operator::kBitAnd, 4},
    {"MOD", Operator::kModulo, 4},  {"+", Operator::kAdd, 3},        {"-", Operator::kSubtract, 3},
    {"OR", Operator::kBitOr, 3},    {"XOR", Operator::kBitXor, 3},   {"EQ", Operator::kEqual, 2},
    {"NE", Operator::kNotEqual, 2}, {"GT", Operator::kGreater, 2},   {"GE", Operator::kGreaterEqual, 2},
    {"LT", Operator::kLess, 2},     {"LE", Operator::kLessEqual, 2},
};

const LetterSyntax kSyntax{&kGTable, &kMTable, kFanucLetters, false, false, false, false, true};

}  // namespace

constinit const std::span<const Code> kFanucGCodes{kGCodes}, kFanucMCodes{kMCodes};
const FormulaSyntax kFanucFormula{kFunctions, kOperators, false, true, true};
const Rules kFanucRules{&kSyntax, &kFanucFormula};

}  // namespace swarf::program::nc::fanuc

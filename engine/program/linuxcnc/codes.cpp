// The words of RS274/NGC as data: codes with their modal groups, functions, operators.
#include <array>

#include "program/linuxcnc/state.h"

namespace swarf::program::nc::linuxcnc {
namespace {

constexpr auto kRead = Code::Use::kRead;
constexpr auto kNoEffect = Code::Use::kNoEffect;
constexpr auto kUnsupported = Code::Use::kUnsupported;

constexpr Code kGCodes[] = {
    {0, 1},
    {10, 1},
    {20, 1},
    {30, 1},
    {40, 0},
    {50, 1},
    {51, 1},
    {52, 1},
    {53, 1},
    {62, 1, kUnsupported, "NURBS of releases after 2.9; G5.2 is read"},
    {70, 15, kUnsupported, "lathe diameter mode"},
    {80, 15, kNoEffect, "lathe radius mode"},
    {100, 0},
    {121, 0, kUnsupported, "kinematics by number of releases after 2.9; M428, M429 and M430 are read"},
    {131, 0, kUnsupported, "kinematics by number of releases after 2.9; M428, M429 and M430 are read"},
    {170, 2},
    {180, 2},
    {190, 2},
    {171, 2, kUnsupported, "plane of U V W, which no machine here has"},
    {181, 2, kUnsupported, "plane of U V W, which no machine here has"},
    {191, 2, kUnsupported, "plane of U V W, which no machine here has"},
    {200, 6},
    {210, 6},
    {280, 0},
    {281, 0},
    {300, 0},
    {301, 0},
    {330, 1, kUnsupported, "synchronised motion"},
    {331, 1, kUnsupported, "rigid tapping"},
    {382, 1, kUnsupported, "probing"},
    {383, 1, kUnsupported, "probing"},
    {384, 1, kUnsupported, "probing"},
    {385, 1, kUnsupported, "probing"},
    {400, 7},
    {410, 7},
    {420, 7},
    {411, 7},
    {421, 7},
    {430, 8},
    {431, 8},
    {432, 8},
    {490, 8},
    {520, 0},
    {530, 14},
    {540, 12},
    {550, 12},
    {560, 12},
    {570, 12},
    {580, 12},
    {590, 12},
    {591, 12},
    {592, 12},
    {593, 12},
    {610, 13},
    {611, 13},
    {640, 13},
    {700, 1, kUnsupported, "lathe cycle"},
    {710, 1, kUnsupported, "lathe cycle"},
    {720, 1, kUnsupported, "lathe cycle"},
    {730, 1},
    {740, 1},
    {760, 1, kUnsupported, "threading cycle"},
    {800, 1},
    {810, 1},
    {820, 1},
    {830, 1},
    {840, 1},
    {850, 1},
    {860, 1},
    {870, 1},
    {880, 1},
    {890, 1},
    {900, 3},
    {910, 3},
    {901, 4},
    {911, 4},
    {920, 0},
    {921, 0},
    {922, 0},
    {923, 0},
    {930, 5},
    {940, 5},
    {950, 5},
    {960, 16, kUnsupported, "a speed that follows X of a turned part; write G97 S"},
    {970, 16, kRead},
    {980, 10},
    {990, 10},
};

constexpr Code kMCodes[] = {
    {0, 0, kNoEffect, "program pause"},
    {10, 0, kNoEffect, "optional pause"},
    {20, 0},
    {300, 0},
    {600, 0, kNoEffect, "pallet change pause"},
    {60, 1},
    {30, 2},
    {40, 2},
    {50, 2},
    {70, 8, kNoEffect, "mist"},
    {80, 8, kNoEffect, "flood"},
    {90, 8, kNoEffect, "coolant off"},
    {190, 2, kNoEffect, "spindle orientation"},
    {480, 6, kNoEffect, "overrides on"},
    {490, 6, kNoEffect, "overrides off"},
    {500, kFree, kNoEffect, "feed override"},
    {510, kFree, kNoEffect, "speed override"},
    {520, kFree, kNoEffect, "adaptive feed"},
    {530, kFree, kNoEffect, "feed stop"},
    {610, 1},
    {620, kFree, kNoEffect, "output"},
    {630, kFree, kNoEffect, "output"},
    {640, kFree, kNoEffect, "output"},
    {650, kFree, kNoEffect, "output"},
    {660, kFree},
    {670, kFree, kNoEffect, "analog output"},
    {680, kFree, kNoEffect, "analog output"},
    {700, 2},
    {710, 2},
    {720, 2},
    {730, 2},
    {980, 4},
    {990, 4},
    {4280, 5},
    {4290, 5},
    {4300, 5},
};

/// M100 to M199 run programs of the machine's owner.
template <size_t kCount>
constexpr std::array<Code, kCount + 100> with_user_codes(const Code (&own)[kCount]) {
  std::array<Code, kCount + 100> all{};
  for (size_t i = 0; i < kCount; ++i) all[i] = own[i];
  for (int i = 0; i < 100; ++i)
    all[kCount + static_cast<size_t>(i)] = {1000 + 10 * i, kFree, kUnsupported,
                                            "a program of the machine's owner"};
  return all;
}
constexpr auto kAllMCodes = with_user_codes(kMCodes);

static_assert(fits_tables(kGCodes) && fits_tables(kAllMCodes));
const CodeTable kGTable{kGCodes};
const CodeTable kMTable{kAllMCodes};

constexpr FunctionWord kFunctions[] = {
    {"ABS", Function::kAbs}, {"ACOS", Function::kAcos}, {"ASIN", Function::kAsin},
    {"COS", Function::kCos}, {"EXP", Function::kExp},   {"FIX", Function::kFix},
    {"FUP", Function::kFup}, {"LN", Function::kLn},     {"ROUND", Function::kRound},
    {"SIN", Function::kSin}, {"SQRT", Function::kSqrt}, {"TAN", Function::kTan},
};
constexpr OperatorWord kOperators[] = {
    {"**", Operator::kPower, 5},       {"*", Operator::kMultiply, 4},
    {"/", Operator::kDivide, 4},       {"MOD", Operator::kPositiveModulo, 4},
    {"+", Operator::kAdd, 3},          {"-", Operator::kSubtract, 3},
    {"EQ", Operator::kNearlyEqual, 2}, {"NE", Operator::kNotNearlyEqual, 2},
    {"GT", Operator::kGreater, 2},     {"GE", Operator::kGreaterEqual, 2},
    {"LT", Operator::kLess, 2},        {"LE", Operator::kLessEqual, 2},
    {"AND", Operator::kAnd, 1},        {"OR", Operator::kOr, 1},
    {"XOR", Operator::kXor, 1},
};

}  // namespace

const LetterSyntax kLinuxCncSyntax{&kGTable, &kMTable, "ABCDEFGHIJKLMNPQRSTUVWXYZ", true, true, true, true};
const FormulaSyntax kLinuxCncFormula{kFunctions, kOperators, true, false, false};

}  // namespace swarf::program::nc::linuxcnc

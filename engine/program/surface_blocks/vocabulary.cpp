#include "program/surface_blocks/vocabulary.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

namespace swarf::program {
namespace {

constexpr double kAnyHigh = std::numeric_limits<double>::max();
constexpr double kAnyLow = -kAnyHigh;
constexpr double kMaxDegree =
    99.0;  ///< two digits; far beyond what a power basis carries in double precision
constexpr double kMaxLeanDeg = 60.0;  ///< of lead and tilt; beyond it the flank cuts, not the end

constexpr Code kCodes[] = {
    {'G', 10.0, Group::kAction},    {'G', 6.3, Group::kAction},      {'G', 6.4, Group::kAction},
    {'G', 6.5, Group::kAction},     {'G', 17.0, Group::kPlane},      {'G', 21.0, Group::kUnits},
    {'G', 54.0, Group::kOffset},    {'G', 90.0, Group::kDistance},   {'M', 2.0, Group::kProgramEnd},
    {'M', 3.0, Group::kSpindle},    {'M', 4.0, Group::kSpindle},     {'M', 5.0, Group::kSpindle},
    {'M', 6.0, Group::kToolChange}, {'M', 30.0, Group::kProgramEnd},
};

/// Words that NC has, but not these programs.
struct Unsupported {
  char letter;
  double first, last;  ///< of the code numbers; the same when there is one
  const char* meaning;
  const char* fix;
};

constexpr const char* kRemove = "remove it: surface programs do not need it";
constexpr const char* kUseSurfaces =
    "describe the surface with G10 L70 ... L79 and machine it with G06.3, G06.4 or G06.5";
constexpr Unsupported kUnsupported[] = {
    {'G', 0, 0, "rapid move", "remove it: approach, retract and links are planned with the passes"},
    {'G', 1, 3, "line or arc", kUseSurfaces},
    {'G', 4, 4, "dwell", kRemove},
    {'G', 5, 5.1, "path smoothing", kRemove},
    {'G', 6.1, 6.2, "spline or NURBS curve", kUseSurfaces},
    {'G', 9, 9, "exact stop", kRemove},
    {'G', 11, 11, "end of data input", "remove it: each G10 block stands for itself"},
    {'G', 15, 16, "polar coordinates", kRemove},
    {'G', 18, 19, "ZX or YZ plane", "write G17"},
    {'G', 20, 20, "inch units", "write G21 and give all lengths in mm"},
    {'G', 22, 23, "stored stroke check", kRemove},
    {'G', 27, 30, "reference point", kRemove},
    {'G', 31, 31, "probing", kRemove},
    {'G', 33, 33, "thread cutting", kRemove},
    {'G', 40, 42, "cutter radius compensation", "remove it: the cutter's shape is known from the scene"},
    {'G', 43, 44, "tool length compensation",
     "remove it: the tool's length is known from the scene, G06.3 implies TCP"},
    {'G', 43.4, 43.5, "tool centre point control", "remove it: G06.3 to G06.5 imply it"},
    {'G', 49, 49, "tool length compensation", "remove it: the tool's length is known from the scene"},
    {'G', 50, 52, "scaling or local coordinates", kRemove},
    {'G', 53, 53, "machine coordinates", kRemove},
    {'G', 55, 59.3, "work offset other than G54", "write G54"},
    {'G', 61, 64, "path control mode", kRemove},
    {'G', 65, 67, "macro call", kRemove},
    {'G', 68, 69, "rotated coordinates", kRemove},
    {'G', 73, 76, "canned cycle", kUseSurfaces},
    {'G', 80, 89, "canned cycle", kUseSurfaces},
    {'G', 91, 91, "incremental coordinates", "write G90 and absolute coordinates"},
    {'G', 92, 92, "coordinate shift", kRemove},
    {'G', 93, 93, "inverse time feed", "give F in mm/min"},
    {'G', 94, 94, "feed per minute", "remove it: F is always in mm/min"},
    {'G', 95, 95, "feed per revolution", "give F in mm/min"},
    {'G', 96, 97, "constant surface speed", "give S in rev/min"},
    {'G', 98, 99, "return level of canned cycles", kRemove},
    {'M', 0, 1, "program stop", kRemove},
    {'M', 7, 9, "coolant", "remove it: coolant is not simulated"},
    {'M', 19, 19, "oriented spindle stop", "write M5"},
    {'M', 48, 49, "override control", kRemove},
    {'M', 60, 60, "pallet change", kRemove},
    {'M', 98, 99, "subprogram", "write the blocks of the subprogram here"},
};

struct ForeignLetter {
  char letter;
  const char* meaning;
  const char* fix;
};
constexpr ForeignLetter kForeignLetters[] = {
    {'A', "rotary axis", "remove it: the orientation follows from the surface and from lead I and tilt J"},
    {'C', "rotary axis", "remove it: the orientation follows from the surface and from lead I and tilt J"},
    {'H', "tool length offset", "remove it: the tool's length is known from the scene"},
    {'O', "program number", "put it in a comment: (O1234)"},
    {'U', "incremental axis", "parameters are I and J in G10 L71, L72, and V in G06.4"},
    {'W', "incremental axis", "remove it"},
};

constexpr WordRule kModalRules[] = {
    {'N', false, true, 0, kMaxNumber, false, "block number", "", "N10"},
    {'T', false, true, 1, kMaxNumber, false, "tool number", "", "T1"},
    {'S', false, false, 0, 1e6, false, "spindle speed", " rev/min", "S12000"},
    {'F', false, false, 0, 1e6, true, "feed", " mm/min", "F3000"},
};
constexpr WordRule kSurfaceNumber = {'P', true, true, 1, kMaxNumber, false, "surface number", "", "P1"};
constexpr WordRule kOpenRules[] = {
    kSurfaceNumber,
    {'Q', false, true, 1, kMaxDegree, false, "degree in u", "", "Q3"},
    {'R', false, true, 1, kMaxDegree, false, "degree in v", "", "R3"},
};
constexpr WordRule kPowerRules[] = {
    kSurfaceNumber,
    {'I', true, true, 0, kMaxDegree, false, "power of u", "", "I2"},
    {'J', true, true, 0, kMaxDegree, false, "power of v", "", "J1"},
    {'X', false, false, kAnyLow, kAnyHigh, false, "coefficient of x", " mm", "X100"},
    {'Y', false, false, kAnyLow, kAnyHigh, false, "coefficient of y", " mm", "Y80"},
    {'Z', false, false, kAnyLow, kAnyHigh, false, "coefficient of z", " mm", "Z-60"},
};
constexpr WordRule kBezierRules[] = {
    kSurfaceNumber,
    {'I', true, true, 0, kMaxDegree, false, "index along u", "", "I2"},
    {'J', true, true, 0, kMaxDegree, false, "index along v", "", "J1"},
    {'X', true, false, kAnyLow, kAnyHigh, false, "x of the control point", " mm", "X100"},
    {'Y', true, false, kAnyLow, kAnyHigh, false, "y of the control point", " mm", "Y80"},
    {'Z', true, false, kAnyLow, kAnyHigh, false, "z of the control point", " mm", "Z-60"},
};
constexpr WordRule kCloseRules[] = {
    kSurfaceNumber,
    {'D', false, true, -1, 1, false, "sign of Su x Sv pointing out of the material", "", "D1 or D-1"},
};
constexpr WordRule kAreaRules[] = {
    kSurfaceNumber,
    {'B', true, true, 0, 3, false, "start boundary", "", "B0 (0: v=0, 1: v=1, 2: u=0, 3: u=1)"},
    {'E', true, false, 0, kAnyHigh, true, "scallop height", " mm", "E0.010"},
    {'K', true, false, 0, kAnyHigh, true, "chord tolerance", " mm", "K0.001"},
    {'L', false, true, 0, 1, false, "pass pattern", "", "L0 (one-way) or L1 (zigzag)"},
    {'I', false, false, -kMaxLeanDeg, kMaxLeanDeg, false, "lead angle", " deg", "I5"},
    {'J', false, false, -kMaxLeanDeg, kMaxLeanDeg, false, "tilt angle", " deg", "J0"},
};
constexpr WordRule kIsoRules[] = {
    kSurfaceNumber,
    {'V', true, false, 0, 1, false, "parameter v of the pass", "", "V0.5"},
    {'K', false, false, 0, kAnyHigh, true, "chord tolerance", " mm", "K0.001"},
    {'I', false, false, -kMaxLeanDeg, kMaxLeanDeg, false, "lead angle", " deg", "I5"},
    {'J', false, false, -kMaxLeanDeg, kMaxLeanDeg, false, "tilt angle", " deg", "J0"},
};
constexpr WordRule kFlankRules[] = {
    kSurfaceNumber,
    {'K', true, false, 0, kAnyHigh, true, "chord tolerance", " mm", "K0.0001"},
};

const Unsupported* find_unsupported(const Word& word) {
  for (const Unsupported& entry : kUnsupported) {
    const bool end = word.value == entry.first || word.value == entry.last;
    const bool between =
        word.value > entry.first && word.value < entry.last && word.value == std::floor(word.value);
    if (entry.letter == word.letter && (end || between)) return &entry;
  }
  return nullptr;
}

std::string written(const Code& code) {
  return code.number < 10.0 ? fmt::format("{}0{}", code.letter, code.number)
                            : fmt::format("{}{}", code.letter, code.number);
}

std::string nearest_code(const Word& word) {
  std::vector<std::string> names;
  for (const Code& code : kCodes) {
    if (code.letter == word.letter) names.push_back(written(code));
  }
  return nearest_name(fmt::format("{}{}{}", word.letter, word.value < 10.0 ? "0" : "", word.value), names);
}

bool check_code_known(const Word& word, int line, Reporter& reporter) {
  if (find_code(word) != nullptr) return true;
  if (const Unsupported* entry = find_unsupported(word)) {
    reporter.error("unsupported-word", line, word.column,
                   fmt::format("{} ({}) is a known NC word, but surface programs do not have it", word.text,
                               entry->meaning),
                   entry->fix);
    return false;
  }
  const std::string nearest = nearest_code(word);
  const char* all =
      word.letter == 'G' ? "G10, G06.3, G06.4, G06.5, G17, G21, G54, G90" : "M2, M3, M4, M5, M6, M30";
  reporter.error("unknown-word", line, word.column,
                 fmt::format("{} is not a word of surface programs", word.text),
                 nearest.empty() ? fmt::format("known are {}", all)
                                 : fmt::format("did you mean {}? Known are {}", nearest, all));
  return false;
}

}  // namespace

const Code* find_code(const Word& word) {
  for (const Code& code : kCodes) {
    if (word.valid && code.letter == word.letter && code.number == word.value) return &code;
  }
  return nullptr;
}

bool check_known(const Word& word, int line, Reporter& reporter) {
  for (const ForeignLetter& foreign : kForeignLetters) {
    if (foreign.letter != word.letter) continue;
    reporter.error("unknown-word", line, word.column,
                   fmt::format("{} ({}) is not a word of surface programs", word.text, foreign.meaning),
                   foreign.fix);
    return false;
  }
  const bool has_code = word.letter == 'G' || word.letter == 'M';
  return !has_code || (word.valid && check_code_known(word, line, reporter));
}

const char* name_of(Action action) {
  switch (action) {
    case Action::kNone:
      return "a block without G10, G06.3, G06.4 or G06.5";
    case Action::kOpenSurface:
      return "G10 L70";
    case Action::kPowerCoefficient:
      return "G10 L71";
    case Action::kBezierPoint:
      return "G10 L72";
    case Action::kCloseSurface:
      return "G10 L79";
    case Action::kArea:
      return "G06.3";
    case Action::kIsoPass:
      return "G06.4";
    case Action::kFlankPass:
      return "G06.5";
  }
  return "";
}

std::span<const WordRule> rules_of(Action action) {
  switch (action) {
    case Action::kNone:
      return {};
    case Action::kOpenSurface:
      return kOpenRules;
    case Action::kPowerCoefficient:
      return kPowerRules;
    case Action::kBezierPoint:
      return kBezierRules;
    case Action::kCloseSurface:
      return kCloseRules;
    case Action::kArea:
      return kAreaRules;
    case Action::kIsoPass:
      return kIsoRules;
    case Action::kFlankPass:
      return kFlankRules;
  }
  return {};
}

std::span<const WordRule> modal_rules() {
  return kModalRules;
}

std::optional<Action> action_of_data_kind(double number) {
  if (number == 70.0) return Action::kOpenSurface;
  if (number == 71.0) return Action::kPowerCoefficient;
  if (number == 72.0) return Action::kBezierPoint;
  if (number == 79.0) return Action::kCloseSurface;
  return std::nullopt;
}

std::string other_data_kind(double number) {
  if (number == 2.0 || number == 20.0) return "work offset";
  if (number == 1.0 || number == 3.0 || (number >= 10.0 && number <= 13.0)) return "tool table";
  if (number == 50.0) return "control parameters";
  return "";
}

}  // namespace swarf::program

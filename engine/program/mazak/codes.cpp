// Codes and rules of Mazak EIA/ISO as data: what differs from Fanuc's.
#include "program/mazak/words.h"

namespace swarf::program::nc::mazak {
namespace {

using fanuc::G;

constexpr auto kNoEffect = Code::Use::kNoEffect;
constexpr auto kUnsupported = Code::Use::kUnsupported;
constexpr auto kAbsent = Code::Use::kAbsent;

constexpr Code kGCodes[] = {
    // The 30i's that this control has not.
    {22, 1, kAbsent},
    {32, 1, kAbsent},
    {51, 0, kAbsent},
    {80, 0, kAbsent},
    {491, 0, kAbsent},
    {536, 0, kAbsent},
    {1870, 0, kAbsent},
    {3320, 0, kAbsent},
    // Geometry compensation rounds no corner by itself and stops at none: a mode of the path, as G64.
    {611, 15, kNoEffect, "geometry compensation", G::kContinuousPath},
    // Its own.
    {341, 0},
    {350, 0},
    {360, 0},
    {50, kFree, kNoEffect, "high-speed machining"},
    {70, 0, kUnsupported, "interpolation with a virtual axis"},
    {109, 0, kUnsupported, "radius or diameter of turned parts"},
    {120, 0, kUnsupported, "circle cutting: how the tool comes to the circle is not published plainly"},
    {130, 0, kUnsupported, "circle cutting: how the tool comes to the circle is not published plainly"},
    {370, 0, kUnsupported, "probing: tool length"},
    {371, 0, kUnsupported, "holes in a grid: the order of its rows is not published plainly"},
    {380, 0, kUnsupported, "keeps the vector of cutter compensation"},
    {390, 0, kUnsupported, "corner arc of cutter compensation"},
    {401, kFree, kNoEffect, "shaping off"},
    {411, 7, kUnsupported, "shaping"},
    {421, 7, kUnsupported, "shaping"},
    {414, 7, kUnsupported, "cutter compensation in five axes"},
    {424, 7, kUnsupported, "cutter compensation in five axes"},
    {415, 7, kUnsupported, "cutter compensation in five axes"},
    {425, 7, kUnsupported, "cutter compensation in five axes"},
    {431, 8, kUnsupported, "tool length along the tool axis"},
    {450, 0, kUnsupported, "tool position offset"},
    {460, 0, kUnsupported, "tool position offset"},
    {470, 0, kUnsupported, "tool position offset"},
    {480, 0, kUnsupported, "tool position offset"},
    {502, kFree, kNoEffect, "polygonal machining off"},
    {512, 0, kUnsupported, "polygonal machining"},
    {612, 15, kUnsupported, "modal spline"},
    {685, 16, kUnsupported, "conversion of coordinates in space: post the plane as G68.2"},
    {695, 16, kNoEffect, "conversion of coordinates in space off", G::kTurnOff},
    {711, 9, kUnsupported, "chamfering cutter"},
    {721, 9, kUnsupported, "chamfering cutter"},
    {750, 9, kUnsupported, "boring with parameters of the machine"},
    {770, 9, kUnsupported, "back spot facing"},
    {780, 9, kUnsupported, "boring with parameters of the machine"},
    {790, 9, kUnsupported, "boring with parameters of the machine"},
    {842, 9, kUnsupported, "synchronous tapping: post it as G84"},
    {843, 9, kUnsupported, "synchronous tapping: post it as G74"},
    {925, 0, kUnsupported, "turned workpiece coordinate system: post it as G68.2"},
};

constexpr Code kMCodes[] = {
    {290, 0, kAbsent},
    {1980, 0, kAbsent},
    {500, kFree, kNoEffect, "air blast"},
};

static_assert(fits_tables(kGCodes) && fits_tables(kMCodes));
const CodeTable kGTable{fanuc::kFanucGCodes, kGCodes};
const CodeTable kMTable{fanuc::kFanucMCodes, kMCodes};
const LetterSyntax kSyntax{&kGTable, &kMTable, fanuc::kFanucLetters, false, false, false, false, true};

constexpr fanuc::OwnCode kOwn[] = {
    {341, "IJK", bolt_circle},
    {350, "IJK", bolt_line},
    {360, "IJKP", bolt_arc},
};
constexpr std::string_view kListedStatements[] = {"DPRNT", "POPEN", "PCLOS"};

}  // namespace

const fanuc::Rules kRules{
    .syntax = &kSyntax,
    .formula = &fanuc::kFanucFormula,
    .own_codes = kOwn,
    .free_letters = "P",
    .listed_statements = kListedStatements,
    .point_rule = "as with a point; a parameter of the machine may make them 0.1 um",
    .warn_of_pointless = true,
    .repeats = "L",
    .program_digits = 8,
    .counted_calls = false,
    .call_label = 'Q',
    .calls_max = 8,
    .macros_max = 4,
    .variable = variable,
};

}  // namespace swarf::program::nc::mazak

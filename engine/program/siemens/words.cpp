#include "program/siemens/words.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <unordered_map>

#include "program/siemens/lexer.h"

namespace swarf::program::nc::siemens {
namespace {

struct Entry {
  const char* name;
  VocabularyWord word;
};

constexpr VocabularyWord modal(Group group, int code) {
  return {Meaning::kModal, group, code, ""};
}

constexpr Entry kModalWords[] = {
    {"G0", modal(Group::kMotion, kG0)},
    {"G1", modal(Group::kMotion, kG1)},
    {"G2", modal(Group::kMotion, kG2)},
    {"G3", modal(Group::kMotion, kG3)},
    {"CIP", modal(Group::kMotion, kCip)},
    {"CT", modal(Group::kMotion, kCt)},
    {"POLY", modal(Group::kMotion, kPoly)},
    {"G4", modal(Group::kNoMotion, kG4)},
    {"G74", modal(Group::kNoMotion, kG74)},
    {"G75", modal(Group::kNoMotion, kG75)},
    {"G110", modal(Group::kNoMotion, kG110)},
    {"G111", modal(Group::kNoMotion, kG111)},
    {"G112", modal(Group::kNoMotion, kG112)},
    {"G17", modal(Group::kPlane, kG17)},
    {"G18", modal(Group::kPlane, kG18)},
    {"G19", modal(Group::kPlane, kG19)},
    {"G40", modal(Group::kCutter, kG40)},
    {"G41", modal(Group::kCutter, kG41)},
    {"G42", modal(Group::kCutter, kG42)},
    {"G53", modal(Group::kSuppress, 0)},
    {"G153", modal(Group::kSuppress, 1)},
    {"SUPA", modal(Group::kSuppress, 2)},
    {"G9", modal(Group::kExact, 0)},
    {"G60", modal(Group::kCorner, kG60)},
    {"G64", modal(Group::kCorner, kG64)},
    {"G641", modal(Group::kCorner, kG641)},
    {"G642", modal(Group::kCorner, kG642)},
    {"G643", modal(Group::kCorner, kG642)},
    {"G644", modal(Group::kCorner, kG642)},
    {"G645", modal(Group::kCorner, kG642)},
    {"G70", modal(Group::kUnits, kG70)},
    {"G71", modal(Group::kUnits, kG71)},
    {"G700", modal(Group::kUnits, kG700)},
    {"G710", modal(Group::kUnits, kG710)},
    {"G90", modal(Group::kMeasure, kG90)},
    {"G91", modal(Group::kMeasure, kG91)},
    {"G93", modal(Group::kFeed, kG93)},
    {"G94", modal(Group::kFeed, kG94)},
    {"G95", modal(Group::kFeed, kG95)},
    {"ORIWKS", modal(Group::kReference, kOriWks)},
    {"ORIMKS", modal(Group::kReference, kOriMks)},
    {"ORIVECT", modal(Group::kOrientation, kOriVect)},
    {"ORIPLANE", modal(Group::kOrientation, kOriVect)},
    {"ORIAXES", modal(Group::kOrientation, kOriAxes)},
    {"ORIEULER", modal(Group::kAngles, kOriEuler)},
    {"ORIRPY", modal(Group::kAngles, kOriRpy)},
    {"SPATH", modal(Group::kPathReference, kSpath)},
    {"UPATH", modal(Group::kPathReference, kUpath)},
    {"PO", {Meaning::kPolynomial, Group::kNone, 0, ""}},
    {"TRANS", {Meaning::kFrame, Group::kNone, kTrans, ""}},
    {"ATRANS", {Meaning::kFrame, Group::kNone, kATrans, ""}},
    {"ROT", {Meaning::kFrame, Group::kNone, kRot, ""}},
    {"AROT", {Meaning::kFrame, Group::kNone, kARot, ""}},
    {"SCALE", {Meaning::kFrame, Group::kNone, kScale, ""}},
    {"ASCALE", {Meaning::kFrame, Group::kNone, kAScale, ""}},
    {"MIRROR", {Meaning::kFrame, Group::kNone, kMirror, ""}},
    {"AMIRROR", {Meaning::kFrame, Group::kNone, kAMirror, ""}},
    {"TRAORI", {Meaning::kTransform, Group::kNone, kTraori, ""}},
    {"TRAFOOF", {Meaning::kTransform, Group::kNone, kTrafoof, ""}},
    {"FGROUP", {Meaning::kFeedGroup, Group::kNone, 0, ""}},
    {"FGREF", {Meaning::kFeedGroup, Group::kNone, 1, ""}},
    {"RET", {Meaning::kEnd, Group::kNone, 0, ""}},
};

/// Dynamics, compressors, measuring and messages: they change times, not the programmed geometry.
constexpr const char* kNotedWords[] = {
    "G601",     "G602",   "G603",    "G62",      "G621",     "G97",       "G290",       "G450",
    "NORM",     "FNORM",  "FLIN",    "FCUB",     "CFC",      "CFTCP",     "CFIN",       "BRISK",
    "SOFT",     "DRIVE",  "FFWON",   "FFWOF",    "COMPOF",   "COMPON",    "COMPCURV",   "COMPCAD",
    "COMPSURF", "STOPRE", "DYNNORM", "DYNPOS",   "DYNROUGH", "DYNFINISH", "DYNSEMIFIN", "DYNPREC",
    "ORISON",   "ORISOF", "CPRECON", "CPRECOF",  "FIFOCTRL", "STARTFIFO", "STOPFIFO",   "WALIMON",
    "WALIMOF",  "DIAMOF", "CUT2D",   "RTLION",   "SBLOF",    "SBLON",     "DISPLOF",    "DISPLON",
    "CDOF",     "CDOF2",  "CDON",    "FENDNORM", "PAROTOF",  "TOROTOF",   "NEWCONF",    "G451",
    "KONT",     "KONTC",  "KONTT"};

constexpr const char* kNotedCalls[] = {"MSG",   "POLYPATH", "WORKPIECE", "GROUP_BEGIN", "GROUP_END", "SETMS",
                                       "WAITM", "WAITMC",   "WAITE",     "SETM",        "CLEARM"};

/// Limits of dynamics of one axis: ACC[X]=50.
constexpr const char* kNotedIndexed[] = {"ACC",      "VELOLIM",  "JERKLIM", "ACCLIMA",
                                         "VELOLIMA", "JERKLIMA", "ATOL"};

constexpr const char* kCycles[] = {"CYCLE81",  "CYCLE82",  "CYCLE83",  "CYCLE84",  "CYCLE85", "CYCLE86",
                                   "CYCLE800", "CYCLE832", "CYCLE801", "HOLES1",   "HOLES2",  "POCKET3",
                                   "POCKET4",  "SLOT1",    "SLOT2",    "LONGHOLE", "CYCLE61", "CYCLE71",
                                   "CYCLE76",  "CYCLE77",  "CYCLE72",  "POCKET1",  "POCKET2"};

constexpr const char* kAddresses[] = {
    "X",  "Y",  "Z",  "A",    "B",    "C",   "I",    "J",    "K",       "X1",  "Y1",   "Z1",   "A1",   "B1",
    "C1", "I1", "J1", "K1",   "A2",   "B2",  "C2",   "A3",   "B3",      "C3",  "CR",   "AR",   "F",    "S",
    "T",  "D",  "H",  "M",    "G",    "P",   "TURN", "ADIS", "ADISPOS", "RPL", "CTOL", "OTOL", "SPOS", "N",
    "PL", "AP", "RP", "OFFN", "LIMS", "RND", "RNDM", "CHF",  "CHR",     "FRC", "FRCM", "ANG"};

constexpr const char* kFlowWords[] = {
    "IF",      "ELSE",    "ENDIF",  "WHILE", "ENDWHILE", "FOR",     "ENDFOR",  "LOOP",  "ENDLOOP",
    "REPEAT",  "REPEATB", "UNTIL",  "GOTO",  "GOTOF",    "GOTOB",   "GOTOC",   "CASE",  "OF",
    "DEFAULT", "TO",      "DEF",    "PROC",  "EXTERN",   "CALL",    "EXTCALL", "MCALL", "REAL",
    "INT",     "BOOL",    "STRING", "CHAR",  "AXIS",     "FRAME",   "SET",     "REP",   "VAR",
    "AC",      "IC",      "DC",     "ACP",   "ACN",      "ENDLABEL"};

struct Refused {
  const char* advice;
  std::vector<const char*> names;
};

const std::vector<Refused>& refused_words() {
  static const std::vector<Refused> words = {
      {"the control spaces the knots of its splines by a rule that it does not publish: post the curve as "
       "POLY, "
       "G1, G2 and G3 blocks",
       {"ASPLINE", "BSPLINE", "CSPLINE", "SPLINEPATH", "BAUTO", "BNAT", "BTAN", "EAUTO", "ENAT", "ETAN", "PW",
        "SD"}},
      {"post the curve as POLY, G1, G2 and G3 blocks", {"INVCW", "INVCCW"}},
      {"threads are cut with CYCLE84", {"G33", "G34", "G35", "G63", "G331", "G332"}},
      {"write the blocks of the approach",
       {"G140", "G141", "G142", "G143", "G147", "G148", "G247", "G248", "G347", "G348", "G340", "G341",
        "DISR", "DISCL"}},
      {"TRANS and AROT are supported",
       {"G58",      "G59",     "ROTS",   "AROTS",    "CROTS",    "TOFRAME", "TOFRAMEZ", "TOFRAMEX",
        "TOFRAMEY", "TOROT",   "TOROTX", "TOROTY",   "TOROTZ",   "PAROT",   "CTRANS",   "CROT",
        "CSCALE",   "CMIRROR", "CRPL",   "MEAFRAME", "PRESETON", "GEOAX"}},
      {"TRAORI is supported", {"TRANSMIT", "TRACYL", "TRAANG", "TRACON", "TCARR", "TCOABS", "TCOFR"}},
      {"give the orientation with rotary axes, A3= B3= C3= or A2= B2= C2=",
       {"LEAD",     "TILT",      "ORIRPY2",  "ORIPATH",  "ORIPATHS", "ORIVIRT1", "ORIVIRT2", "ORICURVE",
        "ORICONCW", "ORICONCCW", "ORICONIO", "ORICONTO", "ORIROTA",  "ORIROTR",  "ORIROTT",  "ORIROTC",
        "THETA",    "A4",        "B4",       "C4",       "A5",       "B5",       "C5",       "A6",
        "B6",       "C6",        "A7",       "B7",       "C7",       "NUT",      "ORID",     "ORIS"}},
      {"constant cutting speed belongs to turning: write G97 and the speed S with M3 or M4",
       {"G96", "G961", "G962", "G971", "G972", "G973", "G25", "G26"}},
      {"outer corners are rounded (G450)",
       {"CUT3DC", "CUT3DF", "CUT3DFS", "CUT3DFF", "CUT3DCC", "CUT2DF", "G461", "G462"}},
      {"the feed is given with F under G93, G94 or G95", {"FB", "FZ", "FPO", "FL", "OVR", "OVRA"}},
      {"the machine file says how rapid moves run", {"RTLIOF"}},
      {"position rotary axes with G0", {"POS", "POSA", "SPOSA", "FA", "IPTRLOCK", "FXS", "FXST", "FXSW"}},
      {"the cycle has to be written as blocks",
       {"CYCLE60",  "CYCLE62", "CYCLE63", "CYCLE64",  "CYCLE70",  "CYCLE73",  "CYCLE74",  "CYCLE75",
        "CYCLE78",  "CYCLE79", "CYCLE87", "CYCLE88",  "CYCLE89",  "CYCLE90",  "CYCLE840", "CYCLE802",
        "CYCLE899", "CYCLE95", "CYCLE97", "CYCLE951", "CYCLE977", "CYCLE978", "CYCLE996"}},
      {"the program is run in the dialect of Siemens", {"G291"}},
      {"synchronised actions are not simulated", {"WHEN", "WHENEVER", "EVERY", "DO", "ID", "IDS", "CANCEL"}},
      {"axes U V W are not simulated", {"U", "V", "W", "Q"}},
      {"measuring and couplings are not simulated",
       {"MEAS",  "MEAW",   "MEASA",  "TRAILON", "TRAILOF", "LEADON", "LEADOF",
        "TANG",  "TANGON", "TANGOF", "COUPON",  "COUPOF",  "INIT",   "START",
        "SETAL", "SETINT", "ASUP",   "SAVE",    "GETT",    "SETTA",  "DELT"}},
      {"oblique plunging belongs to grinding", {"G7", "G5"}},
  };
  return words;
}

using Table = std::map<std::string, VocabularyWord, std::less<>>;

const Table& table() {
  static const Table words = [] {
    Table all;
    for (const Entry& entry : kModalWords) all.emplace(entry.name, entry.word);
    const auto add = [&](const auto& names, Meaning meaning) {
      for (const char* name : names) all.emplace(name, VocabularyWord{meaning, Group::kNone, 0, ""});
    };
    add(kNotedWords, Meaning::kNoted);
    add(kNotedCalls, Meaning::kCall);
    add(kNotedIndexed, Meaning::kNotedIndex);
    add(kCycles, Meaning::kCycle);
    add(kAddresses, Meaning::kAddress);
    add(kFlowWords, Meaning::kFlow);
    for (const Refused& refused : refused_words()) {
      for (const char* name : refused.names) {
        all.emplace(name, VocabularyWord{Meaning::kUnsupported, Group::kNone, 0, refused.advice});
      }
    }
    all.emplace("G500", modal(Group::kOffset, 0));
    for (int n = 54; n <= 57; ++n) all.emplace(fmt::format("G{}", n), modal(Group::kOffset, n - 53));
    for (int n = 505; n <= 599; ++n) all.emplace(fmt::format("G{}", n), modal(Group::kOffset, n - 500));
    return all;
  }();
  return words;
}

}  // namespace

namespace {

/// A letter, or a letter and a digit: the addresses of most blocks. -1: another name.
int short_name(std::string_view name) {
  constexpr int kSuffixes = 11;  // none, 0 to 9
  if (name.empty() || name.size() > 2 || name[0] < 'A' || name[0] > 'Z') return -1;
  if (name.size() == 1) return kSuffixes * (name[0] - 'A');
  return is_digit(name[1]) ? kSuffixes * (name[0] - 'A') + 1 + (name[1] - '0') : -1;
}

}  // namespace

const VocabularyWord* find_word(std::string_view name) {
  using Short = std::array<const VocabularyWord*, size_t{26} * 11>;
  static const Short addresses = [] {
    Short all{};
    for (const auto& [word, meaning] : table()) {
      if (const int at = short_name(word); at >= 0) all[static_cast<size_t>(at)] = &meaning;
    }
    return all;
  }();
  if (const int at = short_name(name); at >= 0) return addresses[static_cast<size_t>(at)];
  static const std::unordered_map<std::string_view, const VocabularyWord*> words = [] {
    std::unordered_map<std::string_view, const VocabularyWord*> all;
    for (const auto& [word, meaning] : table()) all.emplace(word, &meaning);
    return all;
  }();
  const auto found = words.find(name);
  return found == words.end() ? nullptr : found->second;
}

const VocabularyWord* find_g(int number) {
  static const std::array<const VocabularyWord*, 1000> by_number = [] {
    std::array<const VocabularyWord*, 1000> all{};
    for (size_t n = 0; n < all.size(); ++n) all[n] = find_word(fmt::format("G{}", n));
    return all;
  }();
  return number >= 0 && number < 1000 ? by_number[static_cast<size_t>(number)] : nullptr;
}

const std::vector<std::string>& word_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, word] : table()) all.push_back(name);
    return all;
  }();
  return names;
}

}  // namespace swarf::program::nc::siemens

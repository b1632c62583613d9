// The vocabulary of Siemens 840D: what each word does, or that it is known and not supported.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace swarf::program::nc::siemens {

/// Words of one group exclude each other in a block and replace each other from block to block.
enum class Group {
  kMotion,         ///< G0 G1 G2 G3 CIP CT POLY
  kNoMotion,       ///< G4 G74 G75 G110 G111 G112
  kPlane,          ///< G17 G18 G19
  kCutter,         ///< G40 G41 G42
  kOffset,         ///< G500 G54 ... G599
  kSuppress,       ///< G53 G153 SUPA
  kCorner,         ///< G60 G64 G641 G642 ...
  kExact,          ///< G9
  kUnits,          ///< G70 G71 G700 G710
  kMeasure,        ///< G90 G91
  kFeed,           ///< G93 G94 G95
  kReference,      ///< ORIWKS ORIMKS
  kOrientation,    ///< ORIVECT ORIPLANE ORIAXES
  kAngles,         ///< ORIEULER ORIRPY
  kPathReference,  ///< SPATH UPATH
  kNone,           ///< not a member of a group
};

enum class Meaning {
  kModal,        ///< `code` of `group`
  kNoted,        ///< no effect on the geometry
  kFrame,        ///< TRANS ... MIRROR
  kTransform,    ///< TRAORI TRAFOOF
  kCycle,        ///< CYCLE81 ...: a call with arguments
  kCall,         ///< a call with arguments that has no effect on the geometry: MSG(...)
  kEnd,          ///< RET
  kNotedIndex,   ///< ACC[X]=50: no effect on the geometry
  kFeedGroup,    ///< FGROUP(X,Y,Z), FGREF[B]=50
  kAddress,      ///< CR= TURN= A3=: a value follows
  kPolynomial,   ///< PO: PO[X]=(...) or X=PO(...)
  kFlow,         ///< IF, DEF ...: belongs to the flow of the program
  kUnsupported,  ///< known, and refused
};

enum Code {
  kG0,
  kG1,
  kG2,
  kG3,
  kCip,
  kCt,
  kPoly,
  kG4,
  kG74,
  kG75,
  kG110,
  kG111,
  kG112,
  kG17,
  kG18,
  kG19,
  kG40,
  kG41,
  kG42,
  kG60,
  kG64,
  kG641,
  kG642,
  kG70,
  kG71,
  kG700,
  kG710,
  kG90,
  kG91,
  kG93,
  kG94,
  kG95,
  kOriWks,
  kOriMks,
  kOriVect,
  kOriAxes,
  kOriEuler,
  kOriRpy,
  kSpath,
  kUpath,
  kTrans,
  kATrans,
  kRot,
  kARot,
  kScale,
  kAScale,
  kMirror,
  kAMirror,
  kTraori,
  kTrafoof,
};

struct VocabularyWord {
  Meaning meaning = Meaning::kUnsupported;
  Group group = Group::kNone;
  int code = 0;
  const char* advice = "";  ///< for kUnsupported
};

/// Null: nobody knows this name (in capitals).
const VocabularyWord* find_word(std::string_view name);
/// The word of G and this number; null when there is none.
const VocabularyWord* find_g(int number);
/// Every name, for the nearest one.
const std::vector<std::string>& word_names();

}  // namespace swarf::program::nc::siemens

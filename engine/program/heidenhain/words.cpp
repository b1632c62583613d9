// The words of motion blocks, and what is said of words that nobody knows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/heidenhain/words.h"

namespace swarf::program::nc::heidenhain {
namespace {

const std::vector<std::string>& known_words() {
  static const std::vector<std::string> words{
      "BEGIN",   "END",     "BLK",    "FORM",     "TOOL",  "DEF",   "CALL",  "L",       "LN",      "CC",
      "C",       "CR",      "CT",     "CP",       "LP",    "SPL",   "CHF",   "RND",     "FN",      "LBL",
      "PGM",     "CYCL",    "PLANE",  "STOP",     "X",     "Y",     "Z",     "A",       "B",       "C",
      "IX",      "IY",      "IZ",     "IA",       "IB",    "IC",    "PR",    "PA",      "IPR",     "IPA",
      "DR",      "R",       "RL",     "RR",       "F",     "FMAX",  "FAUTO", "FU",      "M",       "S",
      "NX",      "NY",      "NZ",     "TX",       "TY",    "TZ",    "DL",    "REP",     "GOTO",    "Q",
      "QL",      "QR",      "QS",     "FUNCTION", "TCPM",  "TRANS", "DATUM", "SPATIAL", "EULER",   "VECTOR",
      "POINTS",  "RELATIV", "RESET",  "MOVE",     "TURN",  "STAY",  "DIST",  "SEQ",     "APPR",    "DEP",
      "LEN",     "CCA",     "MIRROR", "ROTATION", "SCALE", "SCL",   "ROT",   "IROT",    "PATTERN", "SEL",
      "SELECTED"};
  return words;
}

/// Words of the control that are not executed here.
const std::vector<std::string>& unsupported_words() {
  static const std::vector<std::string> words{
      "U",      "V",   "W",       "IU",       "IV",    "IW",   "FZ",      "FL",      "FLT",  "FC",      "FCT",
      "FPOL",   "CTP", "CONTOUR", "POLARKIN", "OPEN",  "READ", "WRITE",   "DECLARE", "COMP", "SECTION", "OEM",
      "PRESET", "NC",  "FSELECT", "IF",       "WHILE", "FOR",  "TABDATA", "ICC",     "TRY"};
  return words;
}

bool contains(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The index of an axis word without its I, -1 for other words.
int axis_index(std::string_view word) {
  const size_t at =
      word.size() == 1 ? std::string_view(nc::kAxisLetters).find(word[0]) : std::string_view::npos;
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

class WordReader {
 public:
  WordReader(BlockReader& reader, unsigned allowed, MotionWords& words, SplineWords* spline)
      : reader_(reader), allowed_(allowed), words_(words), spline_(spline) {}

  void read() {
    while (!reader_.done()) one();
  }

 private:
  void need(unsigned set, size_t start, std::string_view word) const {
    if ((allowed_ & set) != 0) return;
    reader_.fail("unexpected-word", start, fmt::format("{} does not belong to this block", word),
                 "take it out");
  }
  void once(bool given, size_t start, std::string_view word) const {
    if (!given) return;
    reader_.fail("word-twice", start, fmt::format("{} stands twice in this block", word), "keep one of them");
  }
  void amount(Amount& into, bool incremental, size_t start, std::string_view word) {
    once(into.given, start, word);
    into = {reader_.value(), start, true, incremental};
  }

  void one() {
    const size_t start = reader_.offset();
    const std::string_view word = reader_.take_letters();
    if (word.empty()) {
      reader_.fail("unexpected-character", start, fmt::format("'{}' starts no word", reader_.peek()),
                   "write words of letters and numbers: X+10");
    }
    const bool incremental = word.size() > 1 && word[0] == 'I';
    const std::string_view plain = incremental ? word.substr(1) : word;
    const int axis = axis_index(plain);
    if (axis >= 0) {
      need(kAxesAllowed, start, word);
      return amount(words_.axes[static_cast<size_t>(axis)], incremental, start, word);
    }
    if (plain == "PR" || plain == "PA") {
      need(kPolarAllowed, start, word);
      return amount(plain == "PR" ? words_.polar_radius : words_.polar_angle, incremental, start, word);
    }
    if (word == "R" || word == "RL" || word == "RR") return radius_word(word, start);
    if (word == "LEN" || word == "CCA") {
      need(kApproachAllowed, start, word);
      return amount(word == "LEN" ? words_.length : words_.angle, false, start, word);
    }
    if (word == "DR") return sense(start);
    if (word == "K") return coefficient(start);
    if (word.size() == 2 && (word[0] == 'N' || word[0] == 'T') && axis_index(word.substr(1)) >= 0 &&
        axis_index(word.substr(1)) < 3) {
      need(kVectorsAllowed, start, word);
      auto& vector = word[0] == 'N' ? words_.normal : words_.tool;
      return amount(vector[static_cast<size_t>(axis_index(word.substr(1)))], false, start, word);
    }
    if (word[0] == 'F' && feed(word, start)) return;
    if (word == "M" || word == "MAX") return function(word, start);
    refuse_word(reader_, start, word);
  }

  /// K3X-4.688E-002: letters, a digit, a letter, and a number that may have an exponent.
  void coefficient(size_t start) {
    need(kCoefficientsAllowed, start, "K");
    const char power = reader_.peek();
    const int axis = axis_index(std::string(1, reader_.peek_after(1)));
    if (power < '1' || power > '3' || axis < 0)
      reader_.fail("unknown-word", start, "K is written with 1, 2 or 3 and its axis", "K3X+0.5");
    reader_.skip();
    reader_.skip();
    Amount& into = (*spline_)[static_cast<size_t>(axis)][static_cast<size_t>(power - '1')];
    amount(into, false, start, fmt::format("K{}{}", power, nc::kAxisLetters[axis]));
    if (reader_.take("E")) into.value *= std::pow(10.0, static_cast<double>(reader_.whole_value(-255, 255)));
    if (!std::isfinite(into.value))
      reader_.fail("out-of-range", start, "this coefficient is no finite number", "correct its exponent");
  }

  void radius_word(std::string_view word, size_t start) {
    if (word != "R") {
      need(kCompensationAllowed, start, word);
      once(words_.compensation.has_value(), start, word);
      words_.compensation = word == "RL" ? nc::Compensation::kLeft : nc::Compensation::kRight;
      return;
    }
    const bool zero = reader_.peek() == '0' && (reader_.peek_after(1) < '0' || reader_.peek_after(1) > '9') &&
                      reader_.peek_after(1) != '.' && reader_.peek_after(1) != ',';
    if (zero && (allowed_ & kCompensationAllowed) != 0) {
      once(words_.compensation.has_value(), start, "R0");
      words_.compensation = nc::Compensation::kOff;
      reader_.skip();
      return;
    }
    if ((allowed_ & kRadiusAllowed) == 0 && (allowed_ & kCompensationAllowed) != 0) {
      reader_.fail("unsupported-word", start, "R+ and R- (paraxial compensation) are not supported",
                   "write RL, RR or R0");
    }
    need(kRadiusAllowed, start, word);
    amount(words_.radius, false, start, word);
  }

  void sense(size_t start) {
    need(kSenseAllowed, start, "DR");
    once(words_.sense != 0, start, "DR");
    if (reader_.take_char('+')) {
      words_.sense = 1;
    } else if (reader_.take_char('-')) {
      words_.sense = -1;
    } else {
      reader_.fail("missing-word", start, "DR has no sign", "DR+ turns counter-clockwise, DR- clockwise");
    }
  }

  bool feed(std::string_view word, size_t start) {
    FeedWord kind = FeedWord::kNone;
    if (word == "F") kind = FeedWord::kValue;
    if (word == "FMAX") kind = FeedWord::kMax;
    if (word == "FAUTO") kind = FeedWord::kAuto;
    if (word == "FU") kind = FeedWord::kPerRevolution;
    if (kind == FeedWord::kNone) return false;
    need(kFeedAllowed, start, word);
    once(words_.feed != FeedWord::kNone, start, word);
    if (word == "F" && reader_.take("MAX")) kind = FeedWord::kMax;
    if (word == "F" && reader_.take("AUTO")) kind = FeedWord::kAuto;
    words_.feed = kind;
    words_.feed_value.offset = start;
    if (kind == FeedWord::kValue || kind == FeedWord::kPerRevolution)
      words_.feed_value = {reader_.value(), start, true, false};
    return true;
  }

  void function(std::string_view word, size_t start) {
    if (word != "M") refuse_word(reader_, start, word);
    need(kFunctionsAllowed, start, word);
    MWord function;
    function.offset = start;
    function.number = static_cast<int>(reader_.whole_number(9999));
    once(words_.has_function(function.number), start, fmt::format("M{}", function.number));
    if (function.number == 91) need(kMachineAllowed, start, "M91");
    if (function.number == 128) need(kTcpAllowed, start, "M128");
    if (function.number == 128 && reader_.letters() == "F") {
      const size_t at = (reader_.done(), reader_.offset());
      reader_.take_letters();
      if (!reader_.take("MAX")) function.amount = {reader_.value(), at, true, false};
    } else if (function.number == 128) {
      reader_.take("FMAX");
    }
    if (function.number == 118) {  // X1 Y1: how far the handwheel may lead
      for (int i = 0; i < nc::kAxisWords; ++i) {
        if (reader_.take(std::string_view(nc::kAxisLetters).substr(static_cast<size_t>(i), 1)))
          reader_.value();
      }
    }
    if (function.number == 120 && reader_.take("LA")) reader_.value();
    if (function.number == 140) retraction(function);
    if (function.number == 94) {
      for (int slot = 3; slot < nc::kAxisWords; ++slot) {
        const std::string_view axis = std::string_view(nc::kAxisLetters).substr(static_cast<size_t>(slot), 1);
        if (reader_.take(axis)) function.axes = static_cast<uint8_t>(function.axes | (1u << slot));
      }
    }
    words_.functions.push_back(function);
  }

  void retraction(MWord& function) {
    reader_.done();
    const size_t at = reader_.offset();
    if (!reader_.take("MB")) {
      if (reader_.take("MBMAX")) {
        function.max = true;
        return;
      }
      reader_.fail("missing-word", at, "M140 wants MB here", "M140 MB MAX, or M140 MB50");
    }
    function.max = reader_.take("MAX");
    if (!function.max) function.amount = {reader_.value(), at, true, false};
  }

  BlockReader& reader_;
  unsigned allowed_;
  MotionWords& words_;
  SplineWords* spline_;
};

}  // namespace

bool MotionWords::has_function(int number) const {
  return std::any_of(functions.begin(), functions.end(),
                     [&](const MWord& one) { return one.number == number; });
}

MotionWords read_motion_words(BlockReader& reader, unsigned allowed, SplineWords* spline) {
  MotionWords words;
  WordReader(reader, allowed, words, spline).read();
  return words;
}

void refuse_word(BlockReader& reader, size_t offset, std::string_view word) {
  if (contains(unsupported_words(), word)) {
    reader.fail("unsupported-word", offset,
                fmt::format("{} is a word of this control, but not supported here", word),
                word == "IF" || word == "WHILE" || word == "FOR" ? "FN 9 to FN 12 jump to labels"
                                                                 : "post the program without it");
  }
  if (contains(known_words(), word)) {
    reader.fail("unexpected-word", offset, fmt::format("{} does not stand in this place", word),
                "correct the block");
  }
  const std::string near = nearest_name(word, known_words());
  reader.fail("unknown-word", offset, fmt::format("{} is no word of this control", word),
              near.empty() ? "correct the word, or take it out" : fmt::format("did you mean {}?", near));
}

}  // namespace swarf::program::nc::heidenhain

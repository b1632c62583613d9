#include "program/siemens/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/siemens/block_calls.h"
#include "program/siemens/flow.h"

namespace swarf::program::nc::siemens {
namespace {

constexpr std::string_view kCentreNames = "IJK";

/// One value of a block and where it goes.
class BlockReader {
 public:
  BlockReader(TokenReader& reader, Variables& variables, BlockWords& words)
      : reader_(reader), variables_(variables), words_(words) {}

  void run() {
    while (!reader_.done()) item();
    check_block(words_, machine_axis_, reader_.line());
  }

 private:
  void item() {
    const Token& token = reader_.peek();
    if (token.kind == TokenKind::kAddress) {
      address(token);
      return;
    }
    if (token.kind == TokenKind::kName) {
      if (!assign(reader_, variables_)) name(token);
      return;
    }
    fail("bad-block", token.offset, fmt::format("'{}' does not begin a word", token.text),
         "a block has words (X10), assignments (X=R1) and calls (CYCLE832())");
  }

  /// X10, G1, M3 ...
  void address(const Token& token) {
    reader_.next();
    const Value value = token.whole ? Value::integer(token.number) : Value::real(token.number);
    if (token.letter == 'G') {
      g_word(value, token.offset, token.text);
    } else {
      put(std::string(1, token.letter), value, Way::kModal, token);
    }
  }

  void g_word(const Value& value, size_t offset, std::string_view text) {
    const bool whole = value.number == std::floor(value.number) && value.number >= 0 && value.number < 1000;
    const VocabularyWord* word = whole ? find_g(static_cast<int>(value.number)) : nullptr;
    if (word == nullptr) {
      fail("unknown-word", offset, fmt::format("{} is not a G word of this control", text),
           "G0 to G3, G17 to G19, G40 to G42, G54 to G57, G60, G64, G90 to G95 are examples");
    }
    vocabulary(*word, fmt::format("G{:.0f}", value.number), offset);
  }

  /// A word of the language, or an address before '='.
  void name(const Token& token) {
    const VocabularyWord* word = find_word(token.name);
    if (word != nullptr && word->meaning == Meaning::kAddress) {
      reader_.next();
      assigned(token);
      return;
    }
    if (word == nullptr && extended(token)) return;
    if (word == nullptr) unknown(token);
    reader_.next();
    if (word->meaning == Meaning::kPolynomial) {
      polynomial(token);
    } else {
      vocabulary(*word, token.name, token.offset);
    }
  }

  /// PO[X]=(...), PO[]=(...).
  void polynomial(const Token& po) {
    reader_.expect("[", "PO");
    if (reader_.skip("]")) {
      reader_.expect("=", "PO[]");
      if (words_.divisor) twice(po);
      words_.divisor = read_coefficients(reader_, variables_, po.offset, words_.divisor_end);
      return;
    }
    const Token axis = reader_.peek();
    const size_t index = axis.name.size() == 1 ? kAxisNames.find(axis.name[0]) : std::string_view::npos;
    if (index == std::string_view::npos) {
      fail("unsupported-word", axis.offset,
           fmt::format("PO[{}] is not supported: polynomials are read for X Y Z A B C", axis.text),
           "give the orientation with PO of the rotary axes under ORIAXES, or as A3= B3= C3= without "
           "polynomial");
    }
    reader_.next();
    reader_.expect("]", "the axis of PO");
    reader_.expect("=", "PO[X]");
    polynomial_of(axis, index, po.offset);
  }

  void polynomial_of(const Token& axis, size_t index, size_t offset) {
    if (words_.axes[index]) twice(axis);
    double end = 0.0;
    words_.polynomials[index] = read_coefficients(reader_, variables_, offset, end);
    coordinate(words_.axes[index], end, Way::kModal, axis, index >= 3);
  }

  /// S1=500, M1=3, T1="D8": the spindle 1 is the one that there is.
  bool extended(const Token& token) {
    const bool first = token.name.size() == 2 && token.name[1] == '1' &&
                       std::string_view("SMT").find(token.name[0]) != std::string_view::npos;
    if (first) {
      Token plain = token;
      plain.name.resize(1);
      reader_.next();
      assigned(plain);
      return true;
    }
    const bool letter_and_number =
        token.name.size() > 1 && token.name.find_first_not_of("0123456789", 1) == std::string::npos;
    if (!letter_and_number || !reader_.peek(1).symbol("=")) return false;
    if (std::string_view("SMTHDF").find(token.name[0]) == std::string_view::npos) return false;
    if (token.name[0] == 'M' || token.name[0] == 'H') {
      reader_.next();
      reader_.next();
      const double value = evaluate_number(reader_, variables_);
      words_.noted.push_back({fmt::format("{}={:g}", token.name, value), token.offset});
      return true;
    }
    fail("unsupported-word", token.offset,
         fmt::format("{} belongs to another spindle or tool holder", token.name),
         "only spindle 1 is simulated");
  }

  [[noreturn]] void unknown(const Token& token) {
    std::vector<std::string> known = word_names();
    for (const std::string& variable : variables_.names()) known.push_back(variable);
    const std::string near = nearest_name(token.name, known);
    const bool single = token.text.size() == 1;
    fail("unknown-word", token.offset,
         single ? fmt::format("{} is not an address of this control, or its number is missing", token.text)
                : fmt::format("{} is neither a word that is read nor a variable", token.text),
         near.empty() ? "declare variables with DEF REAL NAME" : fmt::format("did you mean {}?", near));
  }

  void assigned(const Token& token) {
    if (!reader_.skip("=")) {
      fail("bad-number", token.offset, fmt::format("{} has no number", token.text),
           fmt::format("write {}=10", token.name));
    }
    if (const size_t axis = token.name.size() == 1 ? kAxisNames.find(token.name[0]) : std::string_view::npos;
        axis != std::string_view::npos && reader_.skip("PO")) {
      polynomial_of(token, axis, token.offset);
      return;
    }
    Way way = Way::kModal;
    const size_t offset = reader_.offset();
    if (reader_.peek().kind == TokenKind::kName && reader_.peek(1).symbol("(")) {
      static constexpr std::pair<std::string_view, Way> kWays[] = {{"AC", Way::kAbsolute},
                                                                   {"IC", Way::kIncremental},
                                                                   {"DC", Way::kShortest},
                                                                   {"ACP", Way::kPositive},
                                                                   {"ACN", Way::kNegative}};
      for (const auto& [word, meaning] : kWays) {
        if (reader_.peek().name == word) way = meaning;
      }
    }
    if (way != Way::kModal) reader_.next();
    const Value value = evaluate(reader_, variables_);
    if (same(token.name, "G")) {
      g_word(converted(value, Type::kReal, reader_.line(), offset), token.offset, token.text);
    } else {
      put(token.name, value, way, token);
    }
  }

  void put(const std::string& name, const Value& value, Way way, const Token& token) {
    const size_t offset = token.offset;
    if (same(name, "T")) {
      tool(value, offset);
      return;
    }
    const double number = value.type == Type::kReal
                              ? value.number
                              : converted(value, Type::kReal, reader_.line(), offset).number;
    if (name.size() == 1) {
      if (const size_t axis = kAxisNames.find(name[0]); axis != std::string_view::npos)
        return coordinate(words_.axes[axis], number, way, token, axis >= 3);
      if (const size_t centre = kCentreNames.find(name[0]); centre != std::string_view::npos)
        return coordinate(words_.centre[centre], number, way, token, false);
    }
    if (name.size() == 2 && name[1] == '1' && kCentreNames.find(name[0]) != std::string_view::npos) {
      coordinate(words_.between[kCentreNames.find(name[0])], number, way, token, false);
      return;
    }
    if (name.size() == 2 && name[1] == '1' && kAxisNames.find(name[0]) != std::string_view::npos) {
      const size_t axis = kAxisNames.find(name[0]);
      coordinate(words_.axes[axis], number, way, token, axis >= 3);
      if (machine_axis_ == nullptr) machine_axis_ = &words_.axes[axis];
      return;
    }
    if (same(name, "AP") || same(name, "RP")) {
      coordinate(name[0] == 'A' ? words_.polar_angle : words_.polar_radius, number, way, token, false);
      return;
    }
    if (way != Way::kModal) {
      fail("words-conflict", offset, fmt::format("{} takes no AC, IC, DC, ACP or ACN", name),
           fmt::format("write {}=10", name));
    }
    plain(name, number, token);
  }

  void plain(const std::string& name, double number, const Token& token) {
    if (name.size() == 2 && (name[1] == '2' || name[1] == '3') && name[0] >= 'A' && name[0] <= 'C') {
      auto& vector = name[1] == '2' ? words_.angles : words_.vector;
      return once(vector[static_cast<size_t>(name[0] - 'A')], number, token);
    }
    using Plain = std::pair<std::string_view, Amount BlockNumbers::*>;
    static constexpr std::array<Plain, 18> kPlain = {{{"CR", &BlockNumbers::radius},
                                                      {"AR", &BlockNumbers::opening},
                                                      {"TURN", &BlockNumbers::turns},
                                                      {"F", &BlockNumbers::feed},
                                                      {"S", &BlockNumbers::speed},
                                                      {"D", &BlockNumbers::cutting_edge},
                                                      {"ADIS", &BlockNumbers::rounding},
                                                      {"RPL", &BlockNumbers::plane_turn},
                                                      {"CTOL", &BlockNumbers::contour},
                                                      {"PL", &BlockNumbers::interval},
                                                      {"OFFN", &BlockNumbers::allowance},
                                                      {"RND", &BlockNumbers::round},
                                                      {"CHF", &BlockNumbers::chamfer},
                                                      {"CHR", &BlockNumbers::chamfer_leg},
                                                      {"RNDM", &BlockNumbers::round_all},
                                                      {"FRC", &BlockNumbers::corner_feed},
                                                      {"FRCM", &BlockNumbers::corner_feed_all},
                                                      {"ANG", &BlockNumbers::angle}}};
    for (const auto& [word, member] : kPlain) {
      if (same(name, word)) {
        once(words_.*member, number, token);
        return;
      }
    }
    if (same(name, "M")) {
      words_.functions.push_back({whole(number, token), token.offset, true});
    } else if (name == "H" || name == "SPOS" || name == "OTOL" || name == "ADISPOS" || name == "LIMS") {
      words_.noted.push_back(
          {fmt::format("{}{:g}", name.size() == 1 ? name : name + "=", number), token.offset});
    } else {
      refused_letter(name, token);
    }
  }

  [[noreturn]] void refused_letter(const std::string& name, const Token& token) {
    const VocabularyWord* word = find_word(name);
    if (word != nullptr && word->meaning == Meaning::kUnsupported) {
      fail("unsupported-word", token.offset, fmt::format("{} is known and not supported", name),
           word->advice);
    }
    if (name == "N") {
      fail("bad-block", token.offset, "the block number does not stand at the start of its block",
           "write N100 first");
    }
    fail("unknown-word", token.offset, fmt::format("{} does not belong into this block", token.text),
         "the addresses of motions are X Y Z A B C, I J K, CR= TURN=, F S T D M H");
  }

  void coordinate(Coordinate& to, double number, Way way, const Token& token, bool rotary) {
    if (to) twice(token);
    if (!rotary && way != Way::kModal && way != Way::kAbsolute && way != Way::kIncremental) {
      fail("words-conflict", token.offset,
           fmt::format("{} is no rotary axis: it takes AC and IC", token.text),
           "DC, ACP and ACN are for rotary axes");
    }
    to.value = number;
    to.way = way;
    to.offset = token.offset;
    to.given = true;
  }

  void once(Amount& to, double number, const Token& token) {
    if (to) twice(token);
    to = {number, token.offset, true};
  }

  [[noreturn]] void twice(const Token& token) {
    fail("word-twice", token.offset,
         fmt::format("{} stands twice in this block",
                     token.kind == TokenKind::kAddress ? std::string(1, token.letter) : token.name),
         "a block has each address once");
  }

  double whole(double number, const Token& token) {
    if (number != std::floor(number) || number < 0 || number > 99999999) {
      fail("not-whole-number", token.offset, fmt::format("{} takes a whole number", token.text.substr(0, 1)),
           "write M8");
    }
    return number;
  }

  void tool(const Value& value, size_t offset) {
    ToolCall& tool = words_.tool;
    if (tool.given)
      fail("word-twice", offset, "T stands twice in this block", "a block has each address once");
    tool.given = true;
    tool.offset = offset;
    tool.by_name = value.type == Type::kString;
    tool.name = value.text;
    if (tool.by_name) return;
    if (value.number != std::floor(value.number) || value.number < 0 || value.number > 99999999) {
      fail("not-whole-number", offset, "T takes a whole number or a name", "write T5 or T=\"NAME\"");
    }
    tool.number = static_cast<int>(value.number);
  }

  void vocabulary(const VocabularyWord& word, const std::string& name, size_t offset) {
    switch (word.meaning) {
      case Meaning::kModal:
        code(word, name, offset);
        return;
      case Meaning::kNoted:
        words_.noted.push_back({name, offset});
        return;
      case Meaning::kFrame:
        alone(words_.frame, word.code, name, offset);
        words_.frame_offset = offset;
        return;
      case Meaning::kTransform:
        alone(words_.transform, word.code, name, offset);
        words_.other_offset = offset;
        transform_number();
        return;
      case Meaning::kCycle:
      case Meaning::kCall:
        read_call(reader_, variables_, words_, name, offset);
        return;
      case Meaning::kEnd:
        words_.ends_program = true;
        return;
      case Meaning::kFeedGroup:
        if (word.code == 0) {
          read_feed_group(reader_, words_, name, offset);
        } else {
          read_feed_radius(reader_, variables_, words_, name, offset);
        }
        return;
      case Meaning::kNotedIndex:
        read_noted_index(reader_, variables_, words_, name, offset);
        return;
      case Meaning::kUnsupported:
        fail("unsupported-word", offset, fmt::format("{} is known and not supported", name), word.advice);
      case Meaning::kAddress:
      case Meaning::kPolynomial:
      case Meaning::kFlow:
        if (name == "MCALL") return;
        fail("bad-block", offset, fmt::format("{} stands at the start of a block", name),
             "write it in a block of its own");
    }
  }

  void alone(std::optional<int>& to, int what, const std::string& name, size_t offset) {
    if (words_.frame || words_.transform) {
      fail("modal-conflict", offset,
           fmt::format("{} is the second frame or transformation of this block", name),
           "write each in a block of its own");
    }
    to = what;
  }

  /// TRAORI, TRAORI(1): the first transformation is the one of the machine.
  void transform_number() {
    if (!reader_.skip("(")) return;
    const size_t offset = reader_.offset();
    if (!reader_.peek().symbol(")") && evaluate_number(reader_, variables_) != 1.0) {
      fail("unsupported-word", offset, "only the first transformation is simulated", "write TRAORI");
    }
    reader_.expect(")", "TRAORI(1");
  }

  void code(const VocabularyWord& word, const std::string& name, size_t offset) {
    const bool motion = word.group == Group::kMotion || word.group == Group::kNoMotion;
    for (const auto& [group, other] : words_.codes) {
      const bool other_motion = group == Group::kMotion || group == Group::kNoMotion;
      if (motion && other_motion) {
        fail("two-motion-words", offset, fmt::format("{} is the second motion of this block", name),
             "a block has one of G0 G1 G2 G3 CIP CT POLY G4 G74 G75 G110 G111 G112");
      }
      if (group == word.group) {
        fail("modal-conflict", offset, fmt::format("{} belongs to the same group as a word before it", name),
             "a block has one word of each group");
      }
    }
    if (word.group == Group::kMotion) words_.motion = word.code;
    if (motion) words_.motion_offset = offset;
    words_.codes.emplace_back(word.group, word.code);
  }

  [[noreturn]] void fail(std::string code, size_t offset, std::string text, std::string fix) const {
    refuse(reader_.line(), offset, std::move(code), std::move(text), std::move(fix));
  }

  TokenReader& reader_;
  Variables& variables_;
  BlockWords& words_;
  const Coordinate* machine_axis_ = nullptr;  ///< the first one that is named as such (X1=)
};

}  // namespace

void read_block(TokenReader& reader, Variables& variables, BlockWords& words) {
  BlockReader(reader, variables, words).run();
}

}  // namespace swarf::program::nc::siemens

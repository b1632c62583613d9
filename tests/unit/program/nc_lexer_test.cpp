#include "program/surface_blocks/lexer.h"

#include <fmt/format.h>

#include "unit/program/support.h"

namespace swarf::program {
namespace {

struct Lexed {
  Block block;
  Diagnostics diagnostics;
};

Lexed lex(std::string_view line) {
  Lexed lexed;
  Reporter reporter(lexed.diagnostics, "test.nc");
  lexed.block = lex_line(line, 7, reporter);
  return lexed;
}

/// "letter=value@column" of each word.
std::string spelled(const Lexed& lexed) {
  std::string text;
  for (const Word& w : lexed.block.words) {
    if (!text.empty()) text += ' ';
    text += w.valid ? fmt::format("{}={}@{}", w.letter, w.value, w.column)
                    : fmt::format("{}=?@{}", w.letter, w.column);
  }
  return text;
}

TEST(NcLexer, ReadsNumbersInEverySpelling) {
  const Lexed lexed = lex("N10 x-50. Y+.5 z00.250 I 7 j-0 F1200.0");
  EXPECT_EQ(spelled(lexed), "N=10@1 X=-50@5 Y=0.5@11 Z=0.25@16 I=7@24 J=-0@28 F=1200@32");
  EXPECT_TRUE(lexed.diagnostics.list().empty());
  EXPECT_EQ(lexed.block.words[4].text, "I 7");
}

TEST(NcLexer, NeedsNoSpaceBetweenWords) {
  EXPECT_EQ(spelled(lex("N1G10L70P1Q2R2")), "N=1@1 G=10@3 L=70@6 P=1@9 Q=2@11 R=2@13");
  EXPECT_EQ(spelled(lex("P1B0E0.01K.001")), "P=1@1 B=0@3 E=0.01@5 K=0.001@10");
}

TEST(NcLexer, LeavesOutComments) {
  EXPECT_EQ(spelled(lex("(a ; b) G17 (c)G21;G90 (")), "G=17@9 G=21@16");
  EXPECT_TRUE(lex("; only a comment").block.words.empty());
}

TEST(NcLexer, CountsColumnsInCharacters) {
  EXPECT_EQ(spelled(lex("(Größe) X1")), "X=1@9");
}

TEST(NcLexer, TellsAnExponentFromTheWordE) {
  const Lexed exponent = lex("X1E5 Y2");
  EXPECT_EQ(spelled(exponent), "X=?@1 Y=2@6");
  EXPECT_EQ(places(exponent.diagnostics), std::vector<std::string>{"bad-number 7:1"});
  EXPECT_EQ(spelled(lex("X1 E5")), "X=1@1 E=5@4");
  EXPECT_EQ(spelled(lex("X1E.5")), "X=1@1 E=0.5@3");
  EXPECT_EQ(spelled(lex("X1.e-5")), "X=?@1");
}

TEST(NcLexer, RefusesWhatIsNoNumber) {
  for (const char* line :
       {"X1..2", "X.", "X-", "X+", "X+-1", "X-+1", "X++1", "X1-2", "X1.2.3", "XNaN", "X -inf", "XInfinity"}) {
    const Lexed lexed = lex(line);
    ASSERT_FALSE(lexed.block.words.empty()) << line;
    EXPECT_FALSE(lexed.block.words[0].valid) << line;
    ASSERT_FALSE(lexed.diagnostics.list().empty()) << line;
    EXPECT_EQ(places(lexed.diagnostics)[0], "bad-number 7:1") << line;
  }
}

TEST(NcLexer, RefusesNumbersThatFloatingPointCannotHold) {
  const std::string huge = "X1" + std::string(400, '0');
  const std::string tiny = "X." + std::string(400, '0') + "1";
  EXPECT_EQ(places(lex(huge).diagnostics), std::vector<std::string>{"bad-number 7:1"});
  EXPECT_EQ(places(lex(tiny).diagnostics), std::vector<std::string>{"bad-number 7:1"});
}

TEST(NcLexer, KeepsTheOtherWordsOfABadLine) {
  const Lexed lexed = lex("G10 ? L7x P1");
  EXPECT_EQ(spelled(lexed), "G=10@1 L=7@7 X=?@9 P=1@11");
  EXPECT_EQ(places(lexed.diagnostics),
            (std::vector<std::string>{"unexpected-character 7:5", "bad-number 7:9"}));
}

TEST(NcLexer, NamesControlCharacters) {
  const Lexed lexed = lex("G17 \x1b");
  ASSERT_EQ(lexed.diagnostics.list().size(), 1U);
  EXPECT_NE(lexed.diagnostics.list()[0].text.find("0x1B"), std::string::npos) << all_text(lexed.diagnostics);
}

TEST(NcLexer, KnowsTheTapeMark) {
  EXPECT_TRUE(lex(" % (tape)").block.percent);
  EXPECT_TRUE(lex(" % (tape)").diagnostics.list().empty());
  EXPECT_EQ(places(lex("%1").diagnostics), std::vector<std::string>{"bad-number 7:2"});
}

TEST(SourceText, SplitsLinesAtEveryLineEnd) {
  const std::vector<std::string_view> lines = {"a", "b", "", "c"};
  EXPECT_EQ(split_lines("a\r\nb\n\nc"), lines);
  EXPECT_EQ(split_lines("\xEF\xBB\xBF"
                        "a\rb\r\rc\r"),
            lines);
  EXPECT_TRUE(split_lines("").empty());
}

TEST(SourceText, KnowsUtf8) {
  EXPECT_EQ(utf8_length("a", 0), 1);
  EXPECT_EQ(utf8_length("\xC3\xBC", 0), 2);
  EXPECT_EQ(utf8_length("\xE2\x82\xAC", 0), 3);
  EXPECT_EQ(utf8_length("\xF0\x9F\x94\xA7", 0), 4);
  // Overlong, surrogate, beyond U+10FFFF, cut off, stray continuation, Latin-1.
  for (const char* bytes :
       {"\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x80", "\xFCr"}) {
    EXPECT_EQ(utf8_length(bytes, 0), 0);
  }
}

}  // namespace
}  // namespace swarf::program

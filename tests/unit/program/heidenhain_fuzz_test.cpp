// Mutated and truncated Heidenhain programs: a diagnostic with its place or a clean run, never a fault, never
// a position that is not a number.
#include <algorithm>

#include "unit/program/heidenhain_support.h"
#include "unit/program/mutate.h"

namespace swarf::program::heidenhain_fuzz_test {
namespace {

const char* const kProgram =
    "0 BEGIN PGM FUZZ MM\n1 BLK FORM 0.1 Z X+0 Y+0 Z-20\n2 BLK FORM 0.2 X+100 Y+100 Z+0\n"
    "3 TOOL CALL \"END10\" Z S3000 F500 DR+0.1\n4 L X+0 Y+0 Z+50 A+0 C+0 R0 FMAX M3\n5 Q1 = 3 + SIN(30) * 2\n"
    "LBL 1\nL X-20 FMAX\nL X+0 RL F500\nL Y+20\nRND R3 F200\nL X+40\nCHF 2\nL Y+0\nL X+60 R0\nFN 1: Q2 = +Q1 "
    "+ +1\n"
    "FN 12: IF +Q2 LT +3 GOTO LBL 1\nCALL LBL 2 REP 2\nLBL 2\nCC X+0 Y+0\nLP PR+20 PA+0\nCP IPA+450 IZ-3 "
    "DR+\n"
    "C X+20 Y+0 DR-\nCR X+0 Y+20 R+20 DR+\nCT X+10 Y+30\nSPL X+5 Y+30 K3X+0 K2X+0 K1X+5 K3Y+0 K2Y+0 K1Y+0\n"
    "CYCL DEF 200 DRILLING ~\n  Q200=2 ;CLEARANCE ~\n  Q201=-9 ~\n  Q206=+150 ~\n  Q202=+4 ~\n  Q203=+0\n"
    "L X+5 FMAX M99\nCYCL DEF 7.0 D\nCYCL DEF 7.1 X+5\nCYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+30\n"
    "PLANE SPATIAL SPA+20 SPB+0 SPC+40 TURN FMAX SEQ-\nL X+1 Y+2 Z+30 FMAX\nCYCL CALL M3\nPLANE RESET TURN "
    "FMAX\n"
    "CYCL DEF 32.0 T\nCYCL DEF 32.1 T0.05\nM128\nL X+10 A-20 C+30 F500\nLN X+1 Y+2 Z+30 TX+0 TY+0.6 "
    "TZ+0.8\nM129\n"
    "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nL A-10 F100\nFUNCTION RESET TCPM\nL Z+100 FMAX M91\nM140 "
    "MB5\n"
    "TRANS ROTATION RESET\nTRANS DATUM RESET\nM126\nPLANE AXIAL A-20 C+30 MOVE DIST20 F900\nPLANE RESET TURN "
    "MB5 FMAX\nM116\nL C+10 F100\nM117\n"
    "TOOL DEF 2 L+50 R+5\nL X-30 Y+0 Z+5 A+0 C+0 FMAX\nTRANS MIRROR AXIS X\nTRANS ROTATION ROT+10\nTRANS "
    "SCALE "
    "SCL1.5\nAPPR LCT X+0 Y+0 Z-1 R5 RL F200\nL Y+20\nDEP CT CCA90 R8 Z+9\nCC X+0 Y+0\nAPPR PLN PR+20 PA+0 "
    "LEN9 RR\nL "
    "Y+30\n"
    "DEP LT LEN3\nTRANS SCALE RESET\nCYCL DEF 26.0 S\nCYCL DEF 26.1 X1.5 CCX+3\nL X+3\nCYCL DEF 26.0 S\nCYCL "
    "DEF "
    "26.1 X1\nPATTERN DEF ROW1 (X+1 Y+2 D+4 NUM3 ROT+30 Z+1) ~\n CIRC1 (X+1 Y+1 D9 START+0 NUM4 Z+0)\nCYCL "
    "CALL PAT "
    "FMAX\nTRANS MIRROR RESET\nCYCL DEF 208 B Q200=2 Q201=-4 Q206=300 Q334=2.5 Q203=0 Q335=14 Q351=1\nCYCL "
    "CALL\n"
    "CYCL DEF 221 P Q225=1 Q226=2 Q237=3 Q238=4 Q242=2 Q243=2 Q224=5 Q200=2 Q203=0 Q204=9 Q301=0\n"
    "L Z+100 FMAX M91\nM140 MB5\nSTOP M5\nL M30\nEND PGM FUZZ MM\n";

NcRun run_limited(const std::string& text) {
  ControlSetup setup = free_five_axis_setup();
  setup.moves_max = 2000;
  return run_text(text, Dialect::kHeidenhain, setup);
}

void expect_sound(const std::string& text) {
  NcRun run;
  ASSERT_NO_THROW(run = run_limited(text)) << "program:\n" << text;
  const long lines =
      std::count(text.begin(), text.end(), '\n') + std::count(text.begin(), text.end(), '\r') + 1;
  for (const Diagnostic& one : run.diagnostics.list()) {
    ASSERT_FALSE(one.code.empty() || one.text.empty()) << "program:\n" << text;
    ASSERT_TRUE(one.where.line >= 0 && one.where.line <= lines && one.where.column >= 0) << "program:\n"
                                                                                         << text;
  }
  for (const NcMove& move : run.moves()) {
    ASSERT_TRUE(move.q_to.allFinite() && move.to.tip_W.allFinite() && std::isfinite(move.duration_s))
        << "a move of line " << move.line << " is not finite, program:\n"
        << text;
  }
}

TEST(HeidenhainFuzz, TheProgramItselfRuns) {
  const NcRun run = run_limited(kProgram);
  EXPECT_EQ(run.first_error(), "") << run.text();
  ASSERT_GT(run.moves().size(), 40u);
  EXPECT_NEAR((run.moves().back().to.tip_W - run.moves().back().from.tip_W).norm(), 5.0, 1e-9);  // M140 MB5
}

TEST(HeidenhainFuzz, TruncatedProgramsAreRefusedOrRun) {
  const std::string text = kProgram;
  for (size_t length = 1; length < text.size(); length += 3) {
    expect_sound(text.substr(0, length));
    if (HasFatalFailure()) return;
  }
}

TEST(HeidenhainFuzz, MutatedProgramsAreRefusedOrRun) {
  const std::string original = kProgram;
  const std::string pool = "0123456789.,-+=()~;\"*/^%XYZABCIJKRLMTDFSNPQE \n\t\xC3\xA4$#";
  Rng rng(640);
  for (int round = 0; round < 2000; ++round) {
    std::string text = original;
    for (size_t n = 1 + rng.next() % 4; n > 0 && !text.empty(); --n) mutate(text, pool, rng);
    expect_sound(text);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace swarf::program::heidenhain_fuzz_test

// Mutated and truncated programs of Siemens 840D: a diagnostic with its place or a clean run, never a fault,
// never a position that is not a number.
#include <cmath>

#include "unit/program/mutate.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens {
namespace {

const char* const kProgram =
    "N10 DEF REAL _HOME=600., _TOL=.02\nN20 DEF INT _N\nN30 DEF STRING[16] _NAME=\"MILL10\"\nG40 G17 G710 "
    "G94 G90 G60\n"
    "CYCLE800()\nT=_NAME\nM6\nMSG(\"ROUGH\")\nSUPA G0 Z=_HOME D0\nCYCLE832(_TOL,1,1)\nTRAORI\nG54\nTRANS X10 "
    "Y20\nAROT Y30.\n"
    "G0 X0 Y0 Z300 B30 C0 S5000 M3 D1\nG1 Z290 F500\nG2 X10 Y10 I10 J0\nG3 X0 Y20 Z285 CR=10 TURN=1\n"
    "G1\nFOR _N=1 TO 3\nIF _N==2\nX=R5+_N\nELSE\nY=IC(2)*SIN(30)\nENDIF\nENDFOR\nCIP X10 Y20 I1=5 J1=25\nCT "
    "X20 "
    "Y10\n"
    "G1 A3=0 B3=.5 C3=1 X5\nPOLY PO[X]=(8,1,2) PO[Z]=(285,.5,0,1,2) PL=2 A3=0 C3=1\nX=PO(5,1) PO[]=(2,1)\n"
    "UPATH PO[Y]=(9,3)\nG1\nTRAFOOF\nTRANS\nWHILE R5<3\nR5=R5+1\nENDWHILE\nMCALL "
    "CYCLE83(300,280,2,270,,,5,0,0,0,1,1)\nX5 Y5\nMCALL\n"
    "G111 X1 Y2\nG0 AP=30 RP=10\nG3 AP=IC(30) F100\nMIRROR X0\nASCALE X2 Y2 Z1\nG1 X3 "
    "Z=150+$P_TOOLL[1]\nSCALE\n"
    "G1 X10 F100 RND=2\nY30 CHR=1 FRC=50\nRNDM=1 X20\nX30 Y40\nX40 ANG=30 CHF=.5\nRNDM=0 FRCM=0 "
    "Y0\nCYCLE83(300,280,2,"
    "270,,,5,1,0,0,1,1)\n"
    "FGROUP(X,Y,Z,B,C)\nFGREF[B]=50\nMCALL CYCLE82(300,280,2,270)\nHOLES2(0,0,20,0,0,3)\nMCALL\n"
    "$P_UIFR[2,X,TR]=$AA_IM[X]\nG505 G0 Z300\nG54\nFGROUP()\n"
    "CYCLE800(1,\"TC\",0,57,0,0,200,10,20,30,0,0,0,1)\nG0 X1 Y1 Z5\nG4 F1\nAGAIN: R5=R5+1\nIF R5<6 GOTOB "
    "AGAIN\n"
    "REPEAT AGAIN P=2\nM5\nM30\n";

void expect_sound(const std::string& text) {
  ControlSetup setup = setup_of(spinner());
  setup.moves_max = 20'000;
  Ran ran;
  const std::string path = written(text, "siemens_fuzz.mpf");
  ASSERT_NO_THROW(run_file(path, setup, ran)) << "--- of the program\n" << text;
  std::remove(path.c_str());
  for (const Diagnostic& d : ran.diagnostics.list()) {
    EXPECT_FALSE(d.code.empty() || d.text.empty()) << text;
    EXPECT_TRUE(d.where.line >= 0 && d.where.column >= 0) << text;
  }
  for (const NcMove& move : ran.moves) {
    ASSERT_TRUE(move.q_to.allFinite() && move.to.tip_W.allFinite() && std::isfinite(move.duration_s))
        << "a move of line " << move.line << " is not finite\n"
        << text;
  }
}

TEST(SiemensFuzz, TheProgramItselfRuns) {
  run_clean("R5=0\n" + std::string(kProgram));
}

TEST(SiemensFuzz, TruncatedProgramsAreRefusedOrRun) {
  const std::string text = "R5=0\n" + std::string(kProgram);
  for (size_t length = 1; length < text.size(); length += 3) expect_sound(text.substr(0, length));
}

TEST(SiemensFuzz, MutatedProgramsAreRefusedOrRun) {
  const std::string original = "R5=0\n" + std::string(kProgram);
  const std::string pool = "0123456789.-+=()[],:;\"'/*XYZABCIJKRGMTDFS_<> \n\t\xC3\xA4$%";
  Rng rng(840);
  for (int round = 0; round < 1500; ++round) {
    std::string text = original;
    for (size_t n = 1 + rng.next() % 4; n > 0 && !text.empty(); --n) mutate(text, pool, rng);
    expect_sound(text);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace swarf::program::nc::siemens

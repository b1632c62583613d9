// Formulas, variables and the flow of Siemens 840D programs against values worked out by hand.
#include <cmath>

#include "program/siemens/expression.h"
#include "support/scratch.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens {
namespace {

Value value_of(const std::string& formula) {
  const std::string file = "formula";
  std::vector<Token> tokens;
  const LineRef line{&file, 1, formula};
  lex(line, tokens);
  TokenReader reader(line, tokens);
  Scope scope;
  Variables variables;
  variables.enter(scope);
  Variable array;
  array.sizes = {2, 3};
  variables.declare("_GRID", array, line, 0).values[5] = Value::real(42.0);
  variables.set_parameter(7.0, Value::real(-2.5), line, 0);
  const Value value = evaluate(reader, variables);
  EXPECT_TRUE(reader.done()) << formula << " is read only to byte " << reader.offset();
  return value;
}

TEST(SiemensFormula, FollowsThePrioritiesOfTheControl) {
  const std::pair<const char*, double> cases[] = {
      {"2+3*4", 14},         {"(2+3)*4", 20},      {"-2+5", 3},          {"2*-3", -6},
      {"7-2-1", 4},          {"24/4/2", 3},        {"3/4", 0.75},        {"3 DIV 4", 0},
      {"17 DIV 5", 3},       {"-17 DIV 5", -3},    {"17 MOD 5", 2},      {"R7*2", -5},
      {"R[3+4]", -2.5},      {"_GRID[1,2]", 42},   {"_grid[1,2]+1", 43}, {"6 B_AND 3", 2},
      {"6 B_OR 3", 7},       {"6 B_XOR 3", 5},     {"B_NOT 0", -1},      {"'HFF'", 255},
      {"'B101'+1", 6},       {"1.5EX-3", 0.0015},  {"1.5EX3", 1500},     {"1==1", 1},
      {"1<>1", 0},           {"NOT 1", 0},         {"NOT (1==2)", 1},    {"(1<2) AND (2<1)", 0},
      {"(1<2) OR (2<1)", 1}, {"TRUE XOR TRUE", 0}, {"2+1==3", 1},        {"1+1>=2", 1},
      {"0.1+0.2==0.3", 1},   {"0.1+0.2<=0.3", 1},  {"0.1+0.2>0.3", 0}};
  for (const auto& [formula, expected] : cases)
    EXPECT_DOUBLE_EQ(value_of(formula).number, expected) << formula;
}

TEST(SiemensFormula, HasTheFunctionsOfTheControlInDegrees) {
  const std::pair<const char*, double> cases[] = {
      {"SIN(30)", 0.5},  {"COS(60)", 0.5},     {"SIN(180)", 0},      {"COS(90)", 0},
      {"COS(-180)", -1}, {"TAN(45)", 1},       {"SIN(-30)", -0.5},   {"ASIN(0.5)", 30},
      {"ACOS(-1)", 180}, {"ATAN2(1,-1)", 135}, {"ATAN2(-1,0)", -90}, {"SQRT(2)*SQRT(2)", 2},
      {"ABS(-3)", 3},    {"POT(3)", 9},        {"TRUNC(-2.7)", -2},  {"ROUND(2.5)", 3},
      {"LN(EXP(2))", 2}, {"MINVAL(3,-1)", -1}, {"MAXVAL(3,-1)", 3},  {"BOUND(0,10,12)", 10}};
  for (const auto& [formula, expected] : cases)
    EXPECT_NEAR(value_of(formula).number, expected, 1e-12) << formula;
  EXPECT_EQ(value_of("COS(90)").number, 0.0);  // exactly
  EXPECT_NEAR(value_of("ATAN2(30.5,80.1)").number, 180.0 / kPi * std::atan(30.5 / 80.1), 1e-12);
}

TEST(SiemensFormula, JoinsAndComparesTexts) {
  EXPECT_EQ(value_of("\"A\"<<5<<\"B\"").text, "A5B");
  EXPECT_EQ(value_of("\"A\"==\"A\"").number, 1.0);
  EXPECT_EQ(value_of("\"A\"<>\"A\"").number, 0.0);
}

TEST(SiemensFormula, TypesAreThoseOfTheControl) {
  EXPECT_EQ(value_of("2*3").type, Type::kInt);
  EXPECT_EQ(value_of("6/3").type, Type::kReal);
  EXPECT_EQ(value_of("2.0*3").type, Type::kReal);
  EXPECT_EQ(value_of("1<2").type, Type::kBool);
}

/// The X positions that a program goes to.
std::vector<double> xs(const std::string& text) {
  std::vector<double> found;
  for (const NcMove& move : run_clean(text).moves) found.push_back(move.to.tip_W.x());
  return found;
}
using Xs = std::vector<double>;

TEST(SiemensFlow, AssignsSeveralVariablesInABlockAndUsesThemInAddresses) {
  EXPECT_EQ(
      xs("DEF REAL _A, _B=2.5\nDEF INT _N=2.6\nR1=4 R2=R1*2 _A=R2+_B\nG0 X=_A\nX=_N\nX=R1 R1=1\nX=R1\nM30\n"),
      (Xs{10.5, 3, 4, 1}));
}

TEST(SiemensFlow, ArraysAreFilledByListsAndByRep) {
  EXPECT_EQ(xs("DEF REAL _A[4]=SET(1,2)\nDEF REAL _B[2,2]=REP(7)\n_B[1,0]=9\n_A=(5,6,8)\nG0 "
               "X=_A[0]\nX=_A[2]\nX=_A[3]\n"
               "X=_B[0,1]\nX=_B[1,0]\nM30\n"),
            (Xs{5, 8, 0 + 0.0, 7, 9}));
}

TEST(SiemensFlow, LoopsRunAsOftenAsTheySay) {
  EXPECT_EQ(xs("DEF INT _N\nG0\nFOR _N=2 TO 4\nX=_N\nENDFOR\nX=_N*10\nM30\n"), (Xs{2, 3, 4, 50}));
  EXPECT_EQ(xs("DEF INT _N\nG0\nFOR _N=2 TO 1\nX=_N\nENDFOR\nX9\nM30\n"), (Xs{9}));
  EXPECT_EQ(xs("G0\nFOR R1=2 TO 4\nX=R1\nENDFOR\nX=R1*10\nM30\n"), (Xs{2, 3, 4, 50}));
  EXPECT_EQ(xs("DEF REAL _N\nG0\nFOR _N=1.6 TO 3.9\nX=_N\n_N=_N+0.2\nENDFOR\nX=_N\nM30\n"), (Xs{2, 3, 4}));
  EXPECT_EQ(xs("R1=1\nG0\nWHILE R1<8\nX=R1\nR1=R1*2\nENDWHILE\nM30\n"), (Xs{1, 2, 4}));
  EXPECT_EQ(xs("R1=5\nG0\nREPEAT\nX=R1\nR1=R1+1\nUNTIL R1>6\nM30\n"), (Xs{5, 6}));
  EXPECT_EQ(xs("R1=1\nG0\nLOOP\nX=R1\nR1=R1+1\nIF R1==4 GOTOF OUT\nENDLOOP\nOUT: X0\nM30\n"),
            (Xs{1, 2, 3, 0}));
}

TEST(SiemensFlow, BranchesAndJumps) {
  const std::string branch = "G0\nIF R1==1\nX1\nIF R1==2\nX99\nELSE\nX11\nENDIF\nELSE\nX2\nENDIF\nX3\nM30\n";
  EXPECT_EQ(xs("R1=1\n" + branch), (Xs{1, 11, 3}));
  EXPECT_EQ(xs("R1=2\n" + branch), (Xs{2, 3}));
  EXPECT_EQ(xs("N10 G0 X1\nN20 GOTOF N40\nN30 X2\nN040 X3\nM30\n"), (Xs{1, 3}));
  EXPECT_EQ(xs("R1=0\nG0\nHERE: R1=R1+1 X=R1\nIF R1<3 GOTOB HERE\nM30\n"), (Xs{1, 2, 3}));
  EXPECT_EQ(xs("G0\nCASE 2 OF 1 GOTOF ONE 2 GOTOF TWO DEFAULT GOTOF NONE\nONE: X1\nTWO: X2\nNONE: X9\nM30\n"),
            (Xs{2, 9}));
  EXPECT_EQ(xs("G0 X1\nGOTOC NOWHERE\nX2\nM30\n"), (Xs{1, 2}));
}

TEST(SiemensFlow, PartsAreRepeated) {
  EXPECT_EQ(xs("G91 G0\nPART: X1\nX2\nREPEAT PART P=2\nM30\n"), (Xs{1, 3, 4, 6, 7, 9}));
  EXPECT_EQ(xs("G91 G0\nFIRST: X1\nLAST: X2\nX10\nREPEAT FIRST LAST P=1\nM30\n"), (Xs{1, 3, 13, 14, 16}));
  EXPECT_EQ(xs("G91 G0\nONE: X1\nX5\nREPEATB ONE P=3\nM30\n"), (Xs{1, 6, 7, 8, 9}));
}

TEST(SiemensFlow, SubprogramsHaveTheirOwnVariablesAndHandValuesBack) {
  const std::string folder = test::scratch_text();
  const auto file = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder + "/" + name) << text;
  };
  file("siemens_double.spf",
       "%_N_DOUBLE_SPF\nN1 PROC SIEMENS_DOUBLE(REAL _A, VAR REAL _OUT)\nDEF REAL "
       "_LOCAL\n_LOCAL=_A*2\n_OUT=_LOCAL\nX=_LOCAL\nM17\nX999\n");
  file("L4712.SPF", "X=R1\nR1=R1+1\nRET\n");
  EXPECT_EQ(xs("DEF REAL _LOCAL=5, _BACK\nG0\nSIEMENS_DOUBLE(_LOCAL,_BACK)\nX=_BACK+_LOCAL\nM30\n"),
            (Xs{10, 15}));
  EXPECT_EQ(xs("R1=1 G0\nL4712 P3\nX50\nCALL \"L4712\"\nM30\n"), (Xs{1, 2, 3, 50, 4}));
  EXPECT_EQ(xs("R1=7 G0\nMCALL L4712\nX20\nX30\nMCALL\nX40\nM30\n"), (Xs{20, 7, 30, 8, 40}));
  std::remove((folder + "/siemens_double.spf").c_str());
  std::remove((folder + "/L4712.SPF").c_str());
}

}  // namespace
}  // namespace swarf::program::nc::siemens

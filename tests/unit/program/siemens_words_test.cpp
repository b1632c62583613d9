// Poles, mirrored and scaled frames, patterns, feed groups and system variables of Siemens 840D against
// closed forms.
#include <fmt/format.h>

#include <cmath>

#include "base/rng.h"
#include "support/scratch.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens::siemens_words_test {
namespace {

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const std::string& what) {
  EXPECT_LE((a - b).norm(), tolerance) << what << ": " << a.transpose() << " instead of " << b.transpose();
}

Vec3 end_of(const std::string& text) {
  const Ran ran = run_clean(text + "\nM30\n");
  return ran.moves.empty() ? Vec3(Vec3::Constant(std::nan(""))) : ran.moves.back().to.tip_W;
}

TEST(SiemensPolar, EndsLieOnTheirCircleAboutThePole) {
  const double c30 = 10.0 * std::cos(kPi / 6.0), s30 = 5.0;
  const struct {
    const char* blocks;
    Vec3 end;
  } cases[] = {
      {"G111 X10 Y20\nG0 AP=30 RP=10", {10 + c30, 20 + s30, 300}},
      {"G0 RP=10 AP=30 Z290", {c30, s30, 290}},  // without a pole: the zero of the workpiece
      {"G111 X10 Y20\nG0 AP=30 RP=10\nAP=90", {10, 30, 300}},
      {"G111 X10 Y20\nG0 AP=30 RP=10\nAP=IC(60)", {10, 30, 300}},
      {"G111 X10 Y20\nG0 AP=30 RP=10\nG91 AP=IC(60) Z-5", {10, 30, 295}},
      {"G111 X10 Y20\nG0 AP=90 RP=10\nRP=4", {10, 24, 300}},
      {"G0 X3 Y4\nG110 X1 Y2\nG0 AP=0 RP=5", {9, 6, 300}},
      {"G91\nG110 X1 Y2\nG90 G0 AP=0 RP=5", {6, 2, 300}},
      {"G111 X10 Y20\nG112 Y5\nG0 AP=180 RP=2", {8, 25, 300}},
      {"G111 X10 Y20\nG112 AP=90 RP=5\nG0 AP=180 RP=2", {8, 25, 300}},
      {"G111 AP=0 RP=7\nG0 AP=90 RP=1", {7, 1, 300}},
      {"TRANS X100\nG111 X10\nG0 AP=0 RP=1", {111, 0, 300}},
      {"G18 G111 Z300 X5\nG0 AP=90 RP=2", {7, 0, 300}},  // the angle counts from Z
      {"G18 G111 Z300 X5\nG0 AP=0 RP=2", {5, 0, 302}},
      {"G700 G111 X1\nG0 AP=90 RP=1", {25.4, 25.4, 300}},
      {"MIRROR X0\nG111 X10\nG0 AP=30 RP=10", {-10 - c30, s30, 300}},
  };
  for (const auto& one : cases)
    expect_near(end_of(std::string("G0 X0 Y0 Z300\n") + one.blocks), one.end, 1e-9, one.blocks);
}

TEST(SiemensPolar, ThePoleIsTheCentreOfArcs) {
  const Ran ran = run_clean("G0 X20 Y0 Z300\nG111 X10 Y0\nG3 AP=90 RP=10 F500\nM30\n");
  const NcMove& move = ran.moves.back();
  ASSERT_TRUE(move.arc);
  expect_near(move.arc->centre_W, Vec3(10, 0, 300), 1e-9, "centre");
  expect_near(move.arc->normal_W, Vec3(0, 0, 1), 1e-12, "normal");
  expect_near(move.to.tip_W, Vec3(10, 10, 300), 1e-9, "end");
}

TEST(SiemensShape, MirrorsAndScalesAddUpInTheirOrder) {
  const struct {
    const char* frame;
    Vec3 end;  ///< of X1 Y2 Z150
  } cases[] = {
      {"MIRROR X0", {-1, 2, 150}},
      {"MIRROR X0 Y0", {-1, -2, 150}},
      {"TRANS X10 Y20\nAMIRROR X0", {9, 22, 150}},
      {"MIRROR X0\nATRANS X10", {-11, 2, 150}},
      {"AMIRROR X0\nAMIRROR X0", {1, 2, 150}},
      {"MIRROR X0\nMIRROR X0", {-1, 2, 150}},
      {"MIRROR X0\nTRANS X1", {2, 2, 150}},
      {"MIRROR X0\nAROT Z90", {2, 1, 150}},
      {"ROT Z90\nAMIRROR X0", {-2, -1, 150}},
      {"MIRROR X0\nMIRROR", {1, 2, 150}},
      {"SCALE X2 Y3", {2, 6, 150}},
      {"TRANS X10\nASCALE X2", {12, 2, 150}},
      {"SCALE X2 Y2\nATRANS X5", {12, 4, 150}},
      {"SCALE X2 Y2 Z2\nAROT Z90", {-4, 2, 300}},
      {"SCALE X2\nASCALE X3 Z2", {6, 2, 300}},
      {"SCALE X2\nSCALE", {1, 2, 150}},
      {"SCALE X2 Y2 Z2\nAMIRROR Y0\nAROT Z90", {-4, -2, 300}},
      {"G700 SCALE X2\nG71", {2, 2, 150}},
  };
  for (const auto& one : cases)
    expect_near(end_of(std::string("G0 Z300\n") + one.frame + "\nG0 X1 Y2 Z150"), one.end, 1e-9, one.frame);
}

/// The same blocks, mirrored: every tip, circle and tool axis is the mirror image, cutter compensation too.
TEST(SiemensShape, AMirroredProgramIsTheMirrorImage) {
  const std::string body =
      "G0 X20 Y5 Z300\nG91 G1 X5 F900\nG90 G3 X15 Y15 I-5 J5\nG2 X30 Y15 CR=8\nG2 X40 Y15 AR=100\nCIP X50 "
      "Y20 "
      "I1=45 J1=22 Z295\nCT X60 Y20\nPOLY PO[X]=(70,3) PO[Y]=(10,2,1)\nG1 X0 Y-10\nG111 X0 Y0\nG2 AP=45 "
      "RP=10\n"
      "G0 X-30 Y-30\nT=\"MILL10\" M6\nG41 G1 X0 Y0 Z290\nY50\nG2 X20 Y70 I20 J0\nG1 X60\nG40 X80 Y90\n";
  const Ran plain = run_clean(body + "M30\n");
  for (const char* axis : {"X", "Y"}) {
    const Ran mirrored = run_clean(fmt::format("MIRROR {}0\n{}M30\n", axis, body));
    Vec3 sign(1, 1, 1);
    sign[axis[0] - 'X'] = -1.0;
    ASSERT_EQ(plain.moves.size(), mirrored.moves.size()) << axis;
    for (size_t n = 0; n < plain.moves.size(); ++n) {
      const NcMove &one = plain.moves[n], &other = mirrored.moves[n];
      if (one.line == 13) continue;  // the tool change is no move of the frame
      expect_near(other.to.tip_W, sign.cwiseProduct(one.to.tip_W), 1e-9, fmt::format("line {}", one.line));
      if (one.line != 14) {  // leads in from where the tool is changed
        EXPECT_NEAR(other.duration_s, one.duration_s, 1e-9) << one.line;
      }
      ASSERT_EQ(other.arc.has_value(), one.arc.has_value());
      if (!one.arc) continue;
      expect_near(other.arc->normal_W, -sign.cwiseProduct(one.arc->normal_W), 1e-9, "normal");
    }
  }
}

TEST(SiemensShape, AScaledProgramIsLargerAndItsVectorsStay) {
  const std::string body =
      "G0 X10 Y5 Z100\nG1 X15 F900\nG3 X10 Y10 I-5 J0\nG2 X20 Y10 CR=8\nPOLY PO[X]=(30,3) PO[Y]=(10,2,1)\n"
      "G111 X30 Y0\nG2 AP=0 RP=10\n";
  const Ran scaled = run_clean("G0 Z300\nSCALE X3 Y3 Z3\n" + body + "M30\n");
  const NcMove& last = scaled.moves.back();
  ASSERT_TRUE(last.arc);
  expect_near(last.arc->centre_W, Vec3(90, 0, 300), 1e-9, "centre");
  expect_near(last.to.tip_W, Vec3(120, 0, 300), 1e-9, "end");
  const Ran turned = run_clean(
      "TRAORI\nORIWKS\nG0 X0 Y0 Z300\nSCALE X2 Y2 Z2\nAMIRROR X0\nG1 X5 Z150 A3=1 B3=2 C3=3 F500\nM30\n");
  expect_near(turned.moves.back().to.axis_W, Vec3(-1, 2, 3).normalized(), 1e-9, "vector");
  expect_near(turned.moves.back().to.tip_W, Vec3(-10, 0, 300), 1e-8, "tip");
}

/// Bottoms of the holes in their order, without Z.
std::vector<Vec3> holes(const std::string& text) {
  std::vector<Vec3> all;
  for (const NcMove& move :
       run_clean("F200\nG0 X0 Y0 Z300\nMCALL CYCLE81(290,250,2,240)\n" + text + "\nM30\n").moves) {
    if (!move.rapid) all.push_back(move.to.tip_W - Vec3(0, 0, 240));
  }
  return all;
}

void expect_holes(const std::vector<Vec3>& found, const std::vector<Vec3>& expected, const char* what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (size_t n = 0; n < found.size(); ++n) expect_near(found[n], expected[n], 1e-9, what);
}

TEST(SiemensPatterns, RowsCirclesAndGrids) {
  expect_holes(holes("HOLES1(10,5,90,2,10,3)\nMCALL"), {{10, 7, 0}, {10, 17, 0}, {10, 27, 0}}, "a row");
  expect_holes(holes("HOLES1(-30,0,0,0,10,3)\nMCALL"), {{-10, 0, 0}, {-20, 0, 0}, {-30, 0, 0}},
               "a row from its nearer end");
  expect_holes(holes("HOLES2(50,0,10,90,0,4)\nMCALL"), {{50, 10, 0}, {40, 0, 0}, {50, -10, 0}, {60, 0, 0}},
               "a full circle");
  expect_holes(holes("HOLES2(50,0,10,0,30,2)\nMCALL"), {{60, 0, 0}, {50 + 10 * std::cos(kPi / 6), 5, 0}},
               "a part of a circle");
  expect_holes(holes("CYCLE801(10,10,0,20,30,3,2)\nMCALL"),
               {{10, 10, 0}, {30, 10, 0}, {50, 10, 0}, {50, 40, 0}, {30, 40, 0}, {10, 40, 0}}, "a grid");
  expect_holes(holes("CYCLE801(-30,-40,0,20,30,2,2)\nMCALL"),
               {{-10, -10, 0}, {-30, -10, 0}, {-30, -40, 0}, {-10, -40, 0}},
               "a grid from its nearest corner");
  expect_holes(holes("MIRROR X0\nHOLES1(10,5,90,2,10,2)\nMCALL"), {{-10, 7, 0}, {-10, 17, 0}}, "mirrored");
  const Ran none = run_clean("G0 X0 Y0 Z300\nHOLES1(10,0,0,0,10,3)\nM30\n");
  EXPECT_EQ(none.moves.size(), 4U) << "without MCALL the places are passed";
}

double seconds(const std::string& text) {
  double time = 0.0;
  for (const NcMove& move : run_clean("G0 X0 Y0 Z300 B0 C0\n" + text + "\nM30\n").moves)
    time += move.duration_s;
  return time;
}

TEST(SiemensFeed, FgroupAndFgrefSayWhatFeedMeans) {
  EXPECT_NEAR(seconds("G1 X30 B40 F600"), 3.0, 1e-9);
  EXPECT_NEAR(seconds("FGROUP(X,Y,Z)\nG1 X30 B40 F600"), 3.0, 1e-9);
  EXPECT_NEAR(seconds("FGROUP(X,Y,Z,B,C)\nG1 X30 B40 F600"), 5.0, 1e-9);
  EXPECT_NEAR(seconds("FGROUP(X,Y,Z,B,C)\nFGROUP()\nG1 X30 B40 F600"), 3.0, 1e-9);
  // At twice the radius of 57.296 mm, 20 degrees are 40 mm.
  EXPECT_NEAR(seconds("FGROUP(X,Y,Z,B,C)\nFGREF[B]=360/$PI\nG1 X30 B20 F600"), 5.0, 1e-9);
  EXPECT_NEAR(seconds("FGREF[B]=360/$PI\nG1 B20 F600"), 4.0, 1e-9);
}

TEST(SiemensCutterAllowance, OffnWidensTheCutter) {
  for (const auto& [word, off] :
       {std::pair{"OFFN=1.5", 6.5}, std::pair{"OFFN=-2", 3.0}, std::pair{"", 5.0}}) {
    const Ran ran = run_clean(fmt::format(
        "T=\"MILL10\" M6\nG0 X-20 Y-20 Z200\nG41 {} G1 X0 Y0 F500\nY50\nX50\nG40 X80 Y60\nM30\n", word));
    bool beside = false;
    for (const NcMove& move : ran.moves) {
      const bool up = move.to.tip_W.y() > move.from.tip_W.y() + 30.0;
      beside = beside || (up && std::abs(move.to.tip_W.x() + off) < 1e-9);
    }
    EXPECT_TRUE(beside) << word;
  }
}

TEST(SiemensSystem, OffsetsAreReadAndHoldFromTheNextG54On) {
  expect_near(end_of("$P_UIFR[1,X,TR]=$P_UIFR[1,X,TR]+10\nG0 X1 Y2 Z300"), {1, 2, 300}, 1e-12, "not yet");
  expect_near(end_of("$P_UIFR[1,X,TR]=$P_UIFR[1,X,TR]+10\nG54\nG0 X1 Y2 Z300"), {11, 2, 300}, 1e-12, "G54");
  expect_near(end_of("$P_UIFR[2,Y,TR]=$P_UIFR[1,Y,TR]-3\nG55\nG0 X1 Y2 Z300"), {1, -1, 300}, 1e-12, "G55");
  expect_near(end_of("$P_UIFR[1,X,FI]=0\nG505\nG0 X=$P_UIFRNUM Y2 Z300"), {5, 2, 300}, 1e-12, "number");
  const std::string whole =
      "$P_UIFR[2]=CTRANS(X,$P_UIFR[1,X,TR]+10,Y,20,Z,$P_UIFR[1,Z,TR])\nG55\nG0 X1 Y2 Z300";
  const Ran written = run_clean(whole + "\nM30\n");
  EXPECT_NEAR(written.moves.back().to.tip_W.x(), 11.0, 1e-12);
  EXPECT_NEAR(written.moves.back().q_to[1], 22.0, 1e-12) << "machine coordinates of the offset";
  EXPECT_NEAR(written.moves.back().to.tip_W.z(), 300.0, 1e-12);
  const Ran turned = run_clean("$P_UIFR[1,C,TR]=30\nG54\nG0 C10\nM30\n");
  EXPECT_NEAR(deg_from_rad(turned.moves.back().q_to[4]), 40.0, 1e-9);
}

TEST(SiemensSystem, PositionsAndToolsAreThoseOfTheControl) {
  const std::string at = "TRANS X10 Y20\nG0 X1 Y2 Z300\n";
  expect_near(end_of(at + "G0 X=$P_EP[X]+1 Y=$AA_IW[Y] Z=$AA_IW[Z]-10"), {12, 22, 290}, 1e-9, "workpiece");
  expect_near(end_of(at + "R1=$AA_IM[X] R2=$AA_IM[X1]\nTRANS\nG0 X=R1+R2"), {22, 22, 300}, 1e-9, "machine");
  expect_near(end_of("G0 Z300 B30\nR1=$AA_IW[B]\nG0 X=R1 B0"), {30, 0, 300}, 1e-9, "rotary");
  expect_near(end_of("MIRROR X0\nG0 X5 Y0 Z300\nG0 Y=$AA_IW[X]"), {-5, 5, 300}, 1e-9, "mirrored");
  const std::string tool = "T=1 M6\nG0 X0 Y0 Z200\n";
  const auto x_of = [&](const std::string& value) { return end_of(tool + "G0 X=" + value).x(); };
  EXPECT_NEAR(x_of("$P_TOOLR"), 5.0, 1e-12);
  EXPECT_NEAR(x_of("$P_TOOLL[1]"), 120.0, 1e-12);
  EXPECT_NEAR(x_of("$P_TOOLNO*10+$P_TOOL"), 11.0, 1e-12);
  EXPECT_NEAR(x_of("$TC_DP6[2,1]*100+$TC_DP3[2,1]"), 350.0, 1e-12);
  expect_near(end_of("G0 X0 Y0 Z300\nIF $P_SEARCH OR $P_ISTEST GOTOF _END\nG0 X5\n_END: G0 Y1"), {5, 1, 300},
              1e-12, "the program runs on the machine");
}

TEST(SiemensSwivel, SolidAnglesTurnAboutZThenY) {
  Rng rng(64);
  for (int round = 0; round < 20; ++round) {
    const double a = std::round(-170.0 + 340.0 * rng.uniform()), b = std::round(90.0 * rng.uniform());
    const Mat3 R = (Eigen::AngleAxisd(rad_from_deg(a), Vec3::UnitZ()) *
                    Eigen::AngleAxisd(rad_from_deg(b), Vec3::UnitY()))
                       .toRotationMatrix();
    const std::string text =
        fmt::format("CYCLE800(0,\"TC\",0,64,1,2,200,{},{},0,0,0,0,1)\nG0 X7 Y8 Z9", a, b);
    expect_near(end_of(text), Vec3(1, 2, 200) + R * Vec3(7, 8, 9), 1e-8, text);
  }
}

TEST(SiemensFlow, M30OfACalledProgramReturns) {
  const std::string folder = test::scratch_text();
  std::ofstream(folder + "/SIEMENS_PART.mpf") << "G0 X5\nM30\n";
  expect_near(end_of("G0 X0 Y0 Z300\nSIEMENS_PART\nG0 Y7"), {5, 7, 300}, 1e-12, "back in the main program");
  std::remove((folder + "/SIEMENS_PART.mpf").c_str());
}

TEST(SiemensFlow, APatternDoesNotCallAProgramOnceForAll) {
  const std::string file = test::scratch_text() + "/SIEMENS_HOLE.spf";
  std::ofstream(file) << "G1 Z=IC(-5) F100\nG0 Z=IC(5)\nM17\n";
  const Ran ran = run_text("G0 X0 Y0 Z300\nMCALL SIEMENS_HOLE\nHOLES1(0,0,0,10,20,3)\nMCALL\nM30\n");
  std::remove(file.c_str());
  EXPECT_EQ(errors_of(ran.diagnostics), std::vector<std::string>{"unsupported-word 3:1"});
}

TEST(SiemensFlow, ExtcallFindsTheProgramBesideTheCaller) {
  const std::string file = test::scratch_text() + "/SIEMENS_EXT.SPF";
  std::ofstream(file) << "G0 X=IC(3)\nM17\n";
  expect_near(
      end_of("G0 X0 Y0 Z300\nEXTCALL(\"/_N_WKS_DIR/_N_A_WPD/SIEMENS_EXT.SPF\")\nEXTCALL \"SIEMENS_EXT\"\n"
             "CALL \"_N_SIEMENS_EXT_SPF\""),
      {9, 0, 300}, 1e-12, "three calls");
  std::remove(file.c_str());
}

/// ORIWKS ORIMKS and ORIVECT ORIAXES are two groups; the second one says how orientations turn.
TEST(SiemensTraoriGroups, OriaxesHoldsBesideOriwks) {
  const struct {
    const char* words;
    BlockLaw law;
    bool warns;
  } cases[] = {{"ORIWKS ORIAXES", BlockLaw::kTcpAxes, true},  {"ORIAXES\nORIWKS", BlockLaw::kTcpAxes, true},
               {"ORIWKS ORIVECT", BlockLaw::kTcp, false},     {"ORIMKS", BlockLaw::kTcpAxes, false},
               {"ORIMKS ORIAXES", BlockLaw::kTcpAxes, false}, {"ORIWKS", BlockLaw::kTcp, false},
               {"ORIMKS\nORIVECT", BlockLaw::kTcp, true}};
  for (const auto& one : cases) {
    const Ran ran =
        run_clean(std::string("TRAORI\n") + one.words + "\nG0 X0 Y0 Z300 B0 C0\nG1 X5 B10 C5 F500\nM30\n");
    EXPECT_EQ(ran.moves.back().law, one.law) << one.words;
    EXPECT_EQ(all_text(ran.diagnostics).find("orientation-words") != std::string::npos, one.warns)
        << one.words;
  }
}

TEST(SiemensDrillingDepths, DepthsAndDwellsInBothStyles) {
  std::vector<double> depths;
  for (const NcMove& move :
       run_clean("F200\nG0 X0 Y0 Z300\nCYCLE83(290,250,2,230,,,8,0,0,0,1,1)\nM30\n").moves) {
    if (!move.rapid) depths.push_back(move.to.tip_W.z());
  }
  ASSERT_EQ(depths.size(), 3U);
  EXPECT_NEAR(depths[0], 242.0, 1e-9) << "the first depth counts from the reference plane";
  EXPECT_NEAR(depths[1], 234.0, 1e-9);
  EXPECT_NEAR(depths[2], 230.0, 1e-9);
  const auto bottom = [](const std::string& cycle) {
    double lowest = 1e9, dwell = 0.0;
    for (const NcMove& move : run_clean("F200\nG0 X0 Y0 Z300\n" + cycle + "\nM30\n").moves) {
      lowest = std::min(lowest, move.to.tip_W.z());
      dwell += move.dwell_s;
    }
    return Vec2(lowest, dwell);
  };
  EXPECT_EQ(bottom("CYCLE81(290,250,2,,20,0.6,0,1,11)"), Vec2(230, 0.6));
  EXPECT_EQ(bottom("CYCLE82(290,250,2,240,,0.5,0,1,12)"), Vec2(240, 0.5));
  EXPECT_EQ(bottom("CYCLE82(290,250,2,240,25,0,0,1,11)"), Vec2(225, 0));
  EXPECT_EQ(bottom("CYCLE82(290,250,2,240,25,0,0,1,12)"), Vec2(240, 0));
}

TEST(SiemensSwivel, RetractsAlongTheToolToTheEndOfTravel) {
  const Ran ran = run_clean("G0 X10 Y10 Z300\nCYCLE800(4,\"\",0,57,0,0,200,0,30,0,0,0,0,1)\nM30\n");
  ASSERT_EQ(ran.moves.size(), 3U);
  EXPECT_EQ(ran.moves[1].q_to[2], 610.0);
  EXPECT_EQ(ran.moves[1].q_to[0], 10.0);
}

TEST(SiemensWords, RulesOfContoursMatterUnderCompensationOnly) {
  EXPECT_EQ(run_clean("G153 G0 G17 G90 G40 G60 G451 G601 CFC NORM\nNEWCONF\nG0 X1\nM30\n").moves.size(), 1U);
  for (const char* word : {"G451", "KONT", "KONTC"}) {
    const Ran ran = run_text(fmt::format("{}\nG41 G1 X10 Y10 F100\nM30\n", word));
    ASSERT_FALSE(errors_of(ran.diagnostics).empty()) << word;
    EXPECT_NE(errors_of(ran.diagnostics)[0].find("unsupported-word"), std::string::npos)
        << errors_of(ran.diagnostics)[0];
  }
  const Ran back = run_text("G451 KONT\nG450 NORM\nG41 G1 X10 Y10 F100\nM30\n");
  ASSERT_FALSE(errors_of(back.diagnostics).empty());  // no tool is in the spindle
  EXPECT_NE(errors_of(back.diagnostics)[0].find("compensation-no-tool"), std::string::npos);
}

TEST(SiemensWords, Cycle832TakesItsTypesByName) {
  for (const char* type : {"_ROUGH", "_SEMIFIN", "_FINISH", "_ORI_FINISH"}) {
    const Ran ran = run_clean(fmt::format("CYCLE832(0.03,{},1)\nG1 X1 F100\nM30\n", type));
    EXPECT_EQ(ran.moves.back().corner_tolerance_mm, 0.03) << type;
  }
  EXPECT_EQ(run_clean("CYCLE832(0,_OFF,1)\nG1 X1 F100\nM30\n").moves.back().corner_tolerance_mm, 0.0);
}

TEST(SiemensWords, RemediesNameTheWordsOfTheControl) {
  const Ran ran = run_clean("T=\"MILL10\" M6\nD0\nG0 X0 Y0 Z400\nG1 X1 F100\nM30\n");
  EXPECT_NE(all_text(ran.diagnostics).find("switch it on before the cut (D1)"), std::string::npos)
      << all_text(ran.diagnostics);
}

TEST(SiemensWords, SettingsWithoutEffectAreListed) {
  const Ran ran = run_clean("SETMS(1)\nACC[X]=50 LIMS=5000\nWAITM(1,1,2)\nG0 X1 MSG(\"GO\")\nM30\n");
  EXPECT_EQ(ran.summary.functions,
            (std::vector<std::string>{"SETMS", "ACC[X]=50", "LIMS=5000", "WAITM", "MSG"}));
  EXPECT_EQ(ran.moves.size(), 1U);
}

/// Ends of the feed moves down, as depths below the reference plane.
std::vector<double> peck_depths(const Ran& ran) {
  std::vector<double> depths;
  for (const NcMove& move : ran.moves)
    if (!move.rapid) depths.push_back(250.0 - move.to.tip_W.z());
  return depths;
}

/// DAM 2 behind a first depth of 6: 6, then 4, then 2 as long as more than 4 are left, then two alike.
TEST(SiemensDegression, PecksShrinkToDamAndTheLastTwoAreAlike) {
  const auto depths = [](const char* depth) {
    return peck_depths(
        run_clean(fmt::format("F200\nG0 X0 Y0 Z300\nCYCLE83(290,250,2,{},,,6,2,0,0,1,0)\nM30\n", depth)));
  };
  EXPECT_EQ(depths("229"), (std::vector<double>{6, 10, 12, 14, 16, 18, 19.5, 21}));
  EXPECT_EQ(depths("230"), (std::vector<double>{6, 10, 12, 14, 16, 18, 20}));
  EXPECT_EQ(depths("238.5"), (std::vector<double>{6, 10, 11.5}));
  EXPECT_EQ(depths("245"), (std::vector<double>{5}));
}

TEST(SiemensDegression, APeckThatTheBottomCutsShortIsTold) {
  const Ran ran = run_text("F200\nG0 X0 Y0 Z300\nCYCLE83(290,250,2,231,,,5,0.5,0,0,1,1)\nM30\n");
  EXPECT_EQ(peck_depths(ran), (std::vector<double>{5, 9.5, 13.5, 17, 19}));
  ASSERT_EQ(ran.diagnostics.list().size(), 1u);
  EXPECT_EQ(ran.diagnostics.list()[0].code, "last-peck");
  const Ran exact = run_clean("F200\nG0 X0 Y0 Z300\nCYCLE83(290,250,2,230,,,5,0.5,0,0,1,1)\nM30\n");
  EXPECT_EQ(exact.diagnostics.list().size(), 0u) << "5 + 4.5 + 4 + 3.5 + 3";
}

}  // namespace
}  // namespace swarf::program::nc::siemens::siemens_words_test

// CL data in the forms of NX, Creo, CATIA, Mastercam and SolidWorks CAM (tests/data/programs/cl/good): every
// move against its place.
#include <cmath>
#include <numbers>

#include "program/cl/cycle.h"
#include "program/cl/writer.h"
#include "unit/program/cl_support.h"

namespace swarf::program {
namespace {

constexpr double kPi = std::numbers::pi;

ClProgram read_good(const std::string& file, const ClOptions& options = {}) {
  Diagnostics warnings;
  ClProgram program = load_cl(project_file("tests/data/programs/cl/good/" + file), &warnings, options);
  EXPECT_TRUE(warnings.list().empty()) << all_text(warnings);
  return program;
}

/// One expected move: 'r' rapid, 'f' feed, 'a' arc counter-clockwise about +Z, 'c' clockwise.
struct Expected {
  char kind;
  double x, y, z;
};

void expect_moves(const ClProgram& p, const std::vector<Expected>& expected) {
  ASSERT_EQ(p.moves.size(), expected.size()) << write_cl(p);
  for (size_t i = 0; i < expected.size(); ++i) {
    const Move& move = p.moves[i];
    SCOPED_TRACE("move " + std::to_string(i) + ", line " + std::to_string(move.line));
    expect_tip(move.to.tip_W, expected[i].x, expected[i].y, expected[i].z);
    const char kind = move.feed_mm_s == 0.0          ? 'r'
                      : !move.arc                    ? 'f'
                      : move.arc->normal_W.z() > 0.0 ? 'a'
                                                     : 'c';
    EXPECT_EQ(kind, expected[i].kind);
  }
}

TEST(ClWriters, ArcsOfIso4343AndSystemsByMatrix) {
  const ClProgram p = read_good("autodesk.apt");
  expect_moves(p, {{'a', 0, 10, 5},   // 90 degrees
                   {'c', -10, 0, 5},  // 270 degrees the other way
                   {'a', -10, 0, 1},  // a helix of a turn and a quarter: 4 of 5 mm in the whole turn
                   {'a', 0, -10, 0},
                   {'f', 100, 5, 0}});  // 5 along the X of a system that is turned by 90 degrees
}

TEST(ClWriters, DeepHolesOfNxAndTheirChanges) {
  const ClProgram p = read_good("nx_deep_holes.cls");
  const double gap = kPeckGap;
  std::vector<Expected> expected;
  const auto hole = [&](double x, double depth, double out) {
    expected.push_back({'r', x, 0, -47});  // CLEAR,3 above the hole at -50 of W
    expected.push_back({'f', x, 0, -70});
    expected.push_back({'r', x, 0, -47});
    expected.push_back({'r', x, 0, -70 + gap});
    expected.push_back({'f', x, 0, -50 - depth});
    expected.push_back({'r', x, 0, out});
  };
  hole(10, 36, 30);  // AUTO: back to the height before the cycle
  hole(20, 38.5, 30);
  hole(30, 36, -42);  // RTRCTO,8
  expect_moves(p, expected);
}

TEST(ClWriters, HelicesAndCyclesOfNx) {
  const ClProgram p = read_good("nx_helix.cls");
  EXPECT_EQ(p.writer, ClWriter::kNx);
  EXPECT_EQ(p.writer_reason, "TOOL PATH on line 1");
  expect_moves(p,
               {{'r', 5, 0, 10},  // three turns down to 4, clockwise about -Z: counter-clockwise from above
                {'a', 5, 0, 8},
                {'a', 5, 0, 6},
                {'a', 5, 0, 4},
                {'a', 5, 0, 3.2},  // one turn and a quarter down to 3
                {'a', 0, 5, 3},
                {'r', 20, 0, 3},  // RTRCTO,AUTO: back to the height before the cycle, which is 3
                {'f', 20, 0, -8},
                {'r', 20, 0, 3},
                {'r', 30, 0, 1},
                {'f', 30, 0, -10},
                {'r', 30, 0, 3},
                {'r', 40, 0, 3},
                {'f', 40, 0, -8},
                {'r', 40, 0, 6},
                {'r', 0, 0, 50}});
  ASSERT_EQ(p.tools.size(), 2U);
  EXPECT_EQ(p.tools[1].number, 3);
  EXPECT_EQ(p.cutters[0].tool, 1) << "TLDATA holds for the motion that follows";
}

TEST(ClWriters, CreosArcsRunCounterClockwise) {
  const ClProgram p = read_good("creo_pocket.ncl.1");
  EXPECT_EQ(p.writer, ClWriter::kCreo);
  expect_moves(p, {{'f', 10, 0, 0},
                   {'f', 20, 0, 0},
                   {'a', 25, 5, 0},
                   {'a', 15, 5, 0},  // by way of two points: one arc
                   {'f', 15, -20, 0},
                   {'a', 15, -20, 1.5},  // one turn of a helix
                   {'c', 10, -25, 1.5},  // TLON, clockwise by its INDIRV
                   {'r', 10, -25, 20},
                   {'r', 60, 0, 5},  // CLEAR 5, then 3 further down in rapid
                   {'r', 60, 0, 2},
                   {'f', 60, 0, -8},
                   {'r', 60, 0, 15},
                   {'r', 70, 0, 2},  // fixed form: depth 9, clearance 2, step 5
                   {'f', 70, 0, -5},
                   {'r', 70, 0, 2},
                   {'r', 70, 0, -4.5},
                   {'f', 70, 0, -9},
                   {'r', 70, 0, 2}});
  ASSERT_EQ(p.cutters.size(), 1U);
  EXPECT_EQ(p.cutters[0].parameters, std::vector<double>{12.0}) << "from a comment of Creo's";
  EXPECT_EQ(p.tools[static_cast<size_t>(p.cutters[0].tool)].number, 2);
  ASSERT_EQ(p.remarks.size(), 1U) << "CUTCOM_GEOMETRY_TYPE says what its points are";
  // The other way round the same circle is 90 degrees more of it.
  ClOptions clockwise;
  clockwise.circle_clockwise = true;
  EXPECT_THROW(read_good("creo_pocket.ncl.1", clockwise), InputError) << "the points of the arc contradict";
}

TEST(ClWriters, ArcsOfCatiaInThreePlanes) {
  const ClProgram p = read_good("catia_arcs.aptsource");
  EXPECT_EQ(p.writer, ClWriter::kCatia);
  ASSERT_EQ(p.moves.size(), 7U) << write_cl(p);
  expect_tip(p.moves[1].to.tip_W, 0, 10, 5);
  EXPECT_EQ(p.moves[1].arc->normal_W, Vec3(0, 0, 1)) << "INDIRV along +Y at (10, 0)";
  expect_tip(p.moves[2].to.tip_W, -10, 0, 5);
  EXPECT_EQ(p.moves[2].arc->normal_W, Vec3(0, 0, -1)) << "INDIRV along +X at (0, 10): three quarters";
  expect_tip(p.moves[3].to.tip_W, -20, 0, 15);
  expect_tip(p.moves[3].arc->centre_W, -20, 0, 5);
  EXPECT_EQ(p.moves[3].arc->normal_W, Vec3(0, -1, 0)) << "upwards from +X of the centre";
  EXPECT_NEAR(p.moves[4].dwell_s, 0.3, 1e-15) << "30 turns at 6000 rev/min";
  expect_tip(p.moves[4].to.tip_W, -20, 0, 25);
  // The second system: its Z is -Y of the first, its zero at (100, 0, 0).
  expect_tip(p.moves[5].to.tip_W, 101, -3, 2);
  EXPECT_LT((p.moves[5].to.axis_W - Vec3(0, -1, 0)).norm(), 1e-15);
  EXPECT_LT((p.moves[6].to.axis_W - Vec3(0, -0.8, 0.6)).norm(), 1e-15);
  EXPECT_EQ(p.cutters[0].parameters, (std::vector<double>{10, 1, 4, 1, 0, 0, 50}));
  EXPECT_EQ(p.tools[static_cast<size_t>(p.cutters[0].tool)].number, 1) << "CUTTER stands before LOADTL";
}

TEST(ClWriters, Mastercam) {
  const ClProgram p = read_good("mastercam.apt");
  EXPECT_EQ(p.writer, ClWriter::kMastercam);
  expect_moves(p, {{'f', 0, 0, 1}, {'a', 6, 6, 1}});
  EXPECT_EQ(p.tools[0].number, 4);
}

TEST(ClWriters, SolidWorksCam) {
  const std::string file = project_file("scenes/cl_camworks_plate/plate.clt");
  try {
    load_cl(file);
    FAIL() << "nothing says how its CIRCLE turns";
  } catch (const InputError& error) {
    EXPECT_EQ(places(error.diagnostics).front(), "circle-sense 19:1");
  }
  const ClProgram p = load_cl(file, nullptr, as_nx());
  EXPECT_EQ(p.writer, ClWriter::kCamWorks);
  EXPECT_EQ(p.moves.size(), 13U) << write_cl(p);
  EXPECT_EQ(p.cutters[0].parameters, (std::vector<double>{10, 0}));
}

TEST(ClWriters, EachIsWrittenAgain) {
  for (const char* file : {"nx_helix.cls", "creo_pocket.ncl.1", "catia_arcs.aptsource", "mastercam.apt"}) {
    SCOPED_TRACE(file);
    const ClProgram p = read_good(file);
    ClOptions options;
    options.cutcom = ClPoints::kCentre;
    const ClProgram q = read_cl_clean(write_cl(p), options);
    ASSERT_EQ(q.moves.size(), p.moves.size());
    for (size_t i = 0; i < p.moves.size(); ++i) {
      EXPECT_EQ(p.moves[i].to.tip_W, q.moves[i].to.tip_W) << i;
      ASSERT_EQ(p.moves[i].arc.has_value(), q.moves[i].arc.has_value()) << i;
      if (!p.moves[i].arc) continue;
      EXPECT_LT((p.moves[i].arc->normal_W - q.moves[i].arc->normal_W).norm(), 1e-15) << i;
    }
    EXPECT_EQ(q.writer, ClWriter::kSwarf);
  }
}

TEST(ClWriters, WhatCreoAndNxMeanByTheSameCircle) {
  const std::string arc = "FEDRAT/9\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n";
  const auto normal = [&](const std::string& head) {
    return read_cl_clean(head + arc, {}).moves[0].arc->normal_W.z();
  };
  EXPECT_EQ(normal("TOOL PATH/A,TOOL,B\n"), -1.0);
  EXPECT_EQ(normal("PPRINT/APTCL-SPEC,MAKINO-FF,1\n"), -1.0);
  EXPECT_EQ(normal("$$*         Pro/CLfile  Version 2.0\n"), 1.0);
  EXPECT_EQ(first_place(arc, {}), "circle-sense 3:1");
  EXPECT_EQ(read_cl_clean("FEDRAT/9\nGOTO/10,0,0\nINDIRV/0,1,0\nCIRCLE/0,0,0,0,0,-1,10\nGOTO/0,10,0\n", {})
                .moves[0]
                .arc->normal_W.z(),
            1.0)
      << "INDIRV tells";
  EXPECT_EQ(read_cl_clean("FEDRAT/9\nGOTO/10,0,0\nINDIRP/10,-3,0\nCIRCLE/0,0,0,0,0,-1,10\nGOTO/0,10,0\n", {})
                .moves[0]
                .arc->normal_W.z(),
            -1.0);
}

TEST(ClWriters, OriginIsSubtractedAndTransIsAdded) {
  const ClProgram p = read_cl_clean(
      "ORIGIN/1,2,3\nFEDRAT/9\nGOTO/10,10,10\nTRANS/0,0,5\nGOTO/10,10,10\nGODLTA/1,0,0\nORIGIN/0,0,0\n"
      "GOTO/10,10,10\nTRACUT/NOMORE\n");
  expect_tip(p.start.tip_W, 9, 8, 7);
  expect_moves(p, {{'f', 9, 8, 12}, {'f', 10, 8, 12}, {'f', 10, 10, 15}});
  EXPECT_EQ(p.remarks.size(), 3U);
}

TEST(ClWriters, HomePlanesAndAxes) {
  const ClProgram p = read_cl_clean(
      "FROM/0,0,100\nFEDRAT/60\nCLEARP/XYPLAN,50\nGOTO/10,0,5\nRETRCT\nMULTAX/ON\nTLAXIS/0,0.6,0.8\n"
      "GOTO/0,0,2\nRETRCT\nGODLTA/0,0,-1,0,0,1\nGOHOME\n");
  expect_moves(p, {{'f', 10, 0, 5},
                   {'r', 10, 0, 50},
                   {'f', 0, 0, 2},
                   {'r', 0, 36, 50},
                   {'f', 0, 36, 49},
                   {'r', 0, 0, 100}});
  EXPECT_LT((p.moves[2].to.axis_W - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(p.moves[4].to.axis_W, Vec3(0, 0, 1));
}

TEST(ClWriters, FeedsOfAllUnits) {
  const auto feed = [](const std::string& words, const std::string& units = "UNITS/MM\n") {
    return read_cl_clean(units + "SPINDL/600,RPM,CCLW,RANGE,2\nFEDRAT/" + words +
                         "\nGOTO/0,0,0\nGOTO/1,0,0\n")
               .moves[0]
               .feed_mm_s *
           60.0;
  };
  EXPECT_NEAR(feed("250,MMPM"), 250.0, 1e-12);
  EXPECT_NEAR(feed("MMPM,250"), 250.0, 1e-12);
  EXPECT_NEAR(feed("0.1,MMPR"), 60.0, 1e-12);
  EXPECT_NEAR(feed("10,IPM"), 254.0, 1e-12);
  EXPECT_NEAR(feed("0.01,IPR"), 152.4, 1e-12);
  EXPECT_NEAR(feed("1,FPM"), 304.8, 1e-12);
  EXPECT_NEAR(feed("0.001,FPR"), 182.88, 1e-12);
  EXPECT_NEAR(feed("10", "UNITS/INCHES\n"), 254.0, 1e-12);
  EXPECT_NEAR(feed("250,MMPM", "UNITS/INCHES\n"), 250.0, 1e-12);
}

TEST(ClWriters, WordsThatAreOnlyNoted) {
  const ClProgram p = read_cl_clean(
      "FEDRAT/9\nGOTO/0,0,0\nINTOL/0.03\nOUTTOL/0\nTOLER/.01\nOPSKIP/ON\nLEADER/50\nAUXFUN/8\nCOOLNT/MIST\n"
      "COOLNT/THRU,HIGH\nMODE/MILL\nDISPLY/ON\nSEQNO/10,INCR,5\nTOOLNO/1,MILL,,$\n2,,NOTE\nTPRINT/a, b\nEND\n"
      "GOTO/1,0,0\nFINI\n");
  ASSERT_EQ(p.notes.size(), 14U);
  EXPECT_EQ(p.notes[0].text, "0.03");
  EXPECT_EQ(p.notes[11].text, "1,MILL,,2,,NOTE");
}

/// Random arcs of CATIA: the sense and the crossing that the writer would choose lead to the end.
TEST(ClWriters, RandomArcsOfCatia) {
  for (int i = 0; i < 720; ++i) {
    const double from = 0.37 * i, sweep = 1.0 + 0.49 * i, r = 3.0 + 0.05 * i;
    const bool clockwise = i % 2 == 0;
    const auto at = [&](double deg) {
      return Vec3(5.0 + r * std::cos(deg * kPi / 180.0), -7.0 + r * std::sin(deg * kPi / 180.0), 2.0);
    };
    const Vec3 a = at(from), b = at(clockwise ? from - sweep : from + sweep);
    Vec3 tangent = Vec3::UnitZ().cross(a - Vec3(5, -7, 2)).normalized();
    if (clockwise) tangent = -tangent;
    if (sweep >= 359.0 || std::abs(sweep - 180.0) < 0.3) continue;
    char text[600];
    std::snprintf(text, sizeof text,
                  "FEDRAT/9\nGOTO/%.6f,%.6f,%.6f\nINDIRV/%.5f,%.5f,%.5f\nTLON,GOFWD/ (CIRCLE/ 5.00000, "
                  "-7.00000, 2.00000,$\n%.6f),ON,%s(LINE/5,-7,2,$\n%.6f,%.6f,%.6f)\n",
                  a.x(), a.y(), a.z(), tangent.x(), tangent.y(), tangent.z(), r,
                  sweep > 180.0 ? "2,INTOF," : "", b.x(), b.y(), b.z());
    const ClProgram p = read_cl_clean(text);
    ASSERT_EQ(p.moves.size(), 1U) << text;
    EXPECT_EQ(p.moves[0].arc->normal_W.z(), clockwise ? -1.0 : 1.0) << text;
    EXPECT_LT((p.moves[0].to.tip_W - b).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace swarf::program

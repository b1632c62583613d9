// CL data in the words of SolidWorks CAM.
#include "unit/program/cl_support.h"

namespace swarf::program {
namespace {

const std::string kSolidWorksHead =
    "PARTNO/PLATE\nUNIT/MM\nTRNTYP/WORLD,0.,0.,0.\nCSYS/1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.\n"
    "SETUP/START,1\nINSERT/Stock Size X100. Y60. Z20.\nLOAD/TOOL,3\nCSI_SET_FLUTE_LENGTH/22.\n"
    "CSI_SET_EXTENSION_LENGTH/40.\nCUTTER/10.,0.,5.,0.,0.,0.,22.\nSPINDL/RPM,6000,CLW\nRAPID/\nGOTO/"
    ".0,.0,20.\n";

TEST(ClSolidWorks, HeadAndMovesWithoutMultax) {
  const ClProgram program = read_cl_clean(kSolidWorksHead +
                                          "FEDRAT/300.,MMPM\nGOTO/.0,.0,5.,0.,0.,1.\nGOTO/10.,.0,5.\n"
                                          "SETUP/END,1\nFINI\n");
  EXPECT_EQ(program.writer, ClWriter::kCamWorks);
  EXPECT_EQ(program.writer_reason, "TRNTYP on line 3");
  ASSERT_EQ(program.moves.size(), 2u);
  expect_tip(program.moves[1].to.tip_W, 10.0, 0.0, 5.0);
  ASSERT_EQ(program.tools.size(), 1u);
  EXPECT_EQ(program.tools[0].number, 3);
  EXPECT_TRUE(program.remarks.empty()) << "the system is the identity";
}

/// Its radius is the distance of the place before it; the sense is still the user's to say.
TEST(ClSolidWorks, CircleWithoutARadiusBeginsWhereTheToolStands) {
  const std::string arc =
      "FEDRAT/300.,MMPM\nGOTO/10.,0.,5.\nCIRCLE/0.,0.,5.,0.,0.,1.\nGOTO/0.,10.,5.\nFINI\n";
  ClOptions options;
  options.circle_clockwise = false;
  const ClProgram program = read_cl_clean(kSolidWorksHead + arc, options);
  ASSERT_EQ(program.moves.size(), 2u);
  ASSERT_TRUE(program.moves[1].arc.has_value());
  expect_tip(program.moves[1].arc->centre_W, 0.0, 0.0, 5.0);
  EXPECT_NEAR(program.moves[1].arc->normal_W.z(), 1.0, 1e-12);
  EXPECT_EQ(first_place(kSolidWorksHead + arc, ClOptions()).substr(0, 12), "circle-sense");
  // Where it begins is what the radius is measured from: an end off that circle is refused as ever.
  EXPECT_EQ(
      first_place(kSolidWorksHead +
                      "FEDRAT/300.,MMPM\nGOTO/10.,0.,5.\nCIRCLE/0.,0.,5.,0.,0.,1.\nGOTO/0.,11.,5.\nFINI\n",
                  options)
          .substr(0, 7),
      "bad-arc");
  EXPECT_EQ(
      first_place("UNIT/MM\nFEDRAT/300.,MMPM\nCIRCLE/0.,0.,5.,0.,0.,1.\nGOTO/0.,10.,5.\nGOTO/1.,1.,1.\n",
                  options)
          .substr(0, 11),
      "no-position");
}

TEST(ClSolidWorks, PecksOfAFirstAndOfFurtherDepths) {
  const ClProgram program =
      read_cl_clean(kSolidWorksHead +
                    "CYCLE/INIT\nCYCLE/"
                    "DEEP,FEDTO,-20.,STPECK,8.,SUBPECK,5.,MMPM,150.,RAPTO,2.,RTRCTO,20.\nGOTO/10.,10.,0.\n"
                    "CYCLE/OFF\nCYCLE/CLEAR\nRAPID/\nGOTO/0.,0.,20.\nFINI\n");
  std::vector<double> bottoms;
  for (const auto& move : program.moves) {
    if (move.feed_mm_s > 0.0) bottoms.push_back(move.to.tip_W.z());
  }
  EXPECT_EQ(bottoms, (std::vector<double>{-8.0, -13.0, -18.0, -20.0}));
  EXPECT_EQ(first_place(kSolidWorksHead + "CYCLE/DEEP,FEDTO,-20.,STPECK,8.,SUBPECK,5.,MMPM,150.,RAPTO,2.\n"
                                          "GOTO/10.,10.,0.\nCYCLE/CLEAR\nFINI\n")
                .substr(0, 9),
            "bad-cycle");
}

/// Which way its CSYS maps nobody documents: one system is where positions count from, two are refused.
TEST(ClSolidWorks, OneSystemIsTakenASecondOneRefused) {
  const ClProgram program = read_cl_clean(
      "UNIT/MM\nTRNTYP/WORLD,0.,0.,0.\nCSYS/0.,-1.,0.,50.,1.,0.,0.,0.,0.,0.,1.,10.\nFEDRAT/100.,MMPM\n"
      "GOTO/0.,0.,5.\nGOTO/10.,0.,5.\nCSYS/0.,-1.,0.,50.,1.,0.,0.,0.,0.,0.,1.,10.\nGOTO/20.,0.,5.\nFINI\n");
  EXPECT_EQ(program.remarks,
            (std::vector<std::string>{
                "CSYS: positions are taken as written, in the coordinate system of SolidWorks CAM"}));
  expect_tip(program.moves.back().to.tip_W, 20.0, 0.0, 5.0);
  EXPECT_EQ(first_place("UNIT/MM\nCSYS/1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.\nFEDRAT/100.,MMPM\nGOTO/0.,0.,5.\n"
                        "CSYS/1.,0.,0.,9.,0.,1.,0.,0.,0.,0.,1.,0.\nGOTO/20.,0.,5.\nFINI\n"),
            "unsupported-word 5:1");
}

}  // namespace
}  // namespace swarf::program

// Mirror images, rotations and scalings of Heidenhain programs against their matrices.
#include <fmt/format.h>

#include "base/rng.h"
#include "unit/program/heidenhain_support.h"

namespace swarf::program::heidenhain_frame_test {
namespace {

Mat3 about_z(double deg) {
  return Eigen::AngleAxisd(rad_from_deg(deg), Vec3::UnitZ()).toRotationMatrix();
}

void expect_at(const NcMove& move, const Vec3& expected, const std::string& text = "") {
  EXPECT_NEAR((move.to.tip_W - expected).norm(), 0.0, 1e-9)
      << move.to.tip_W.transpose() << "  not  " << expected.transpose() << "\n"
      << text;
}

// p = shift + M Rz S u, for random values of each, by cycles and by TRANS, with lines, arcs and polar words.
TEST(HeidenhainFrame, ShiftMirrorRotationAndScaleInTheirOrder) {
  Rng rng(8);
  const auto random = [&](double size) {
    return size * (2.0 * static_cast<double>(rng.next() % 10000) / 1e4 - 1.0);
  };
  for (int round = 0; round < 60; ++round) {
    const Vec3 shift(random(50), random(50), random(20));
    const bool mirror_x = rng.next() % 2 == 0, mirror_y = rng.next() % 2 == 0, trans = rng.next() % 2 == 0;
    const double turn = std::round(random(180)), scale = 0.5 + static_cast<double>(rng.next() % 1000) / 500.0;
    const std::string axes = std::string(mirror_x ? " X" : "") + (mirror_y ? " Y" : "");
    std::string text = fmt::format("CYCL DEF 7.0 D\nCYCL DEF 7.1 X{:+.9f} Y{:+.9f} Z{:+.9f}\n", shift.x(),
                                   shift.y(), shift.z());
    if (trans) {
      if (!axes.empty()) text += "TRANS MIRROR AXIS" + axes + "\n";
      text += fmt::format("TRANS ROTATION ROT{:+}\nTRANS SCALE SCL{}\n", turn, scale);
    } else {
      text += fmt::format(
          "CYCL DEF 8.0 M\nCYCL DEF 8.1{}\nCYCL DEF 10.0 R\nCYCL DEF 10.1 ROT{:+}\nCYCL DEF 11.0 "
          "S\nCYCL DEF 11.1 SCL {}\n",
          axes, turn, scale);
    }
    text +=
        "L X+10 Y+5 Z+2 F600\nL IX+3 IY-4\nCC X+13 Y+11\nC X+23 Y+11 DR+\nCR X+13 Y+21 R+10 DR-\nLP PR+20 "
        "PA+30\nCP IPA+90 IZ-1 DR+\nCT X+40 Y+3\n";
    const Mat3 A = Vec3(mirror_x ? -1 : 1, mirror_y ? -1 : 1, 1).asDiagonal() * about_z(turn) *
                   (scale * Mat3::Identity());
    const auto at = [&](double x, double y, double z) { return Vec3(shift + A * Vec3(x, y, z)); };
    const NcRun run = klartext_clean(text);
    ASSERT_EQ(run.moves().size(), 7u) << text;
    const double side = mirror_x == mirror_y ? 1.0 : -1.0;
    expect_at(run.moves()[0], at(10, 5, 2), text);
    expect_at(run.moves()[1], at(13, 1, 2), text);
    expect_at(run.moves()[2], at(23, 11, 2), text);
    EXPECT_NEAR((run.moves()[2].arc->centre_W - at(13, 11, 2)).norm(), 0.0, 1e-9) << text;
    EXPECT_NEAR(run.moves()[2].arc->normal_W.z(), side, 1e-12) << text;
    EXPECT_NEAR(run.moves()[2].duration_s * 10.0, 0.5 * kPi * 10.0 * scale, 1e-9) << text;
    expect_at(run.moves()[3], at(13, 21, 2), text);
    EXPECT_NEAR(run.moves()[3].arc->normal_W.z(), -side, 1e-12) << text;
    EXPECT_NEAR(run.moves()[3].duration_s * 10.0, 0.5 * kPi * 10.0 * scale, 1e-9) << text;
    const double c = std::sqrt(0.75) * 20.0;
    expect_at(run.moves()[4], at(13 + c, 21, 2), text);
    expect_at(run.moves()[5], at(3, 11 + c, 1), text);
    EXPECT_NEAR(run.moves()[5].arc->normal_W.z(), side, 1e-12) << text;
    expect_at(run.moves()[6], at(40, 3, 1), text);
  }
}

TEST(HeidenhainFrame, AxisScalesAboutTheirCentre) {
  const NcRun run = klartext_clean(
      "CYCL DEF 26.0 AXIS SCALING\nCYCL DEF 26.1 X1.4 Y0.6 CCX+15 CCY+20\nL X+25 Y+30 F600\nL IX+10 IY+10 "
      "IZ+1\n"
      "CYCL DEF 26.0 AXIS SCALING\nCYCL DEF 26.1 X1 Y1\nL X+25 Y+30 Z+0\n");
  ASSERT_EQ(run.moves().size(), 3u);
  expect_tip(run.moves()[0], 15 + 1.4 * 10, 20 + 0.6 * 10, 0);
  expect_tip(run.moves()[1], 15 + 1.4 * 20, 20 + 0.6 * 20, 1);
  expect_tip(run.moves()[2], 25, 30, 0);
}

// A mirrored contour has the cutter on the other side of the travel: the part is the mirror image.
TEST(HeidenhainFrame, MirroredContoursKeepTheirSideOfThePart) {
  const std::string contour =
      "APPR LCT X+10 Y+0 R5 RL F300\nL X+10 Y+20\nRND R3\nL X+30 Y+20\nCR X+40 Y+10 R+10 DR-\nDEP CT CCA90 "
      "R6\n";
  const std::string head = "TOOL CALL 1 Z S1000\n";
  const NcRun plain = klartext_clean(head + "L X+0 Y-30 FMAX\n" + contour);
  for (const std::string axis : {"X", "Y", "X Y"}) {
    const NcRun run =
        klartext_clean(head + "CYCL DEF 8.0 M\nCYCL DEF 8.1 " + axis + "\nL X+0 Y-30 FMAX\n" + contour);
    ASSERT_EQ(run.moves().size(), plain.moves().size()) << axis;
    const Vec3 factor(axis[0] == 'X' ? -1 : 1, axis.back() == 'Y' ? -1 : 1, 1);
    for (size_t i = 0; i < run.moves().size(); ++i) {
      expect_at(run.moves()[i], factor.cwiseProduct(plain.moves()[i].to.tip_W), axis);
      EXPECT_EQ(run.moves()[i].arc.has_value(), plain.moves()[i].arc.has_value());
      if (!run.moves()[i].arc) continue;
      EXPECT_NEAR(run.moves()[i].arc->normal_W.z(),
                  factor.x() * factor.y() * plain.moves()[i].arc->normal_W.z(), 1e-12);
    }
  }
}

// Scaling changes the lengths of cycles too; within a tilted plane, about its datum.
TEST(HeidenhainFrame, ScaledCyclesInATiltedPlane) {
  const NcRun run = klartext_clean(
      "TOOL CALL 2 Z S1000\nPLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX\nTRANS DATUM AXIS X+100\nTRANS MIRROR "
      "AXIS X\n"
      "TRANS SCALE SCL2\nCYCL DEF 200 D Q200=2 Q201=-12 Q206=150 Q202=5 Q203=+3 Q204=10\nL X+10 Y+20 Z+50 "
      "FMAX M3\n"
      "CYCL CALL\n",
      free_five_axis_setup());
  const Mat3 R = Eigen::AngleAxisd(rad_from_deg(30), Vec3::UnitY()).toRotationMatrix();
  double lowest = 1e9, highest = -1e9;
  for (const NcMove& move : run.moves()) {
    if (move.rapid) continue;
    const Vec3 p = R.transpose() * move.to.tip_W;
    EXPECT_NEAR(p.x(), 100 - 20, 1e-9);
    EXPECT_NEAR(p.y(), 40, 1e-9);
    lowest = std::min(lowest, p.z());
    highest = std::max(highest, p.z());
  }
  EXPECT_NEAR(lowest, 2 * (3 - 12), 1e-9);
  EXPECT_NEAR(highest, 2 * (3 - 5), 1e-9);
  EXPECT_NEAR((R.transpose() * run.moves().back().to.tip_W).z(), 2 * 13, 1e-9);
}

}  // namespace
}  // namespace swarf::program::heidenhain_frame_test

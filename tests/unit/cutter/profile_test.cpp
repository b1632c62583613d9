// Outlines: closed-form volumes by Pappus, tangency, what set_profile derives.
#include "cutter/profile.h"

#include <gtest/gtest.h>

#include "shapes.h"

namespace swarf::cutter::profile_test {
namespace {

using namespace test;

double cylinder(double radius, double height) {
  return kPi * radius * radius * height;
}

double frustum(double low, double high, double height) {
  return kPi / 3.0 * height * (low * low + low * high + high * high);
}

/// A quarter disc of radius r, its centre at e from the axis, turned: area times the way of its centroid.
double quarter_torus(double e, double r) {
  return 2.0 * kPi * (0.25 * kPi * r * r) * (e + 4.0 * r / (3.0 * kPi));
}

/// Between bottom line, flank and the corner circle: two right triangles less a sector, each by Pappus.
double apt_volume(const AptForm& a) {
  const double radius = 0.5 * a.d, turn = 0.5 * kPi - a.alpha - a.beta, z = radius * std::tan(a.alpha);
  const Vec2 crossing(radius, z), bottom(std::cos(a.alpha), std::sin(a.alpha)),
      flank(std::sin(a.beta), std::cos(a.beta));
  const double length = a.r * std::tan(0.5 * turn);
  const Vec2 on_bottom = crossing - length * bottom, on_flank = crossing + length * flank;
  const Vec2 centre = on_bottom + a.r * Vec2(-bottom.y(), bottom.x());
  const double triangle = 0.5 * a.r * length, sector = 0.5 * turn * a.r * a.r;
  const double kite = triangle * (crossing + on_bottom + centre).x() / 3.0 +
                      triangle * (crossing + on_flank + centre).x() / 3.0;
  const double out = (crossing - centre).normalized().x();
  const double arm = turn > 0.0 ? 4.0 * a.r * std::sin(0.5 * turn) / (3.0 * turn) : 0.0;
  const double corner = 2.0 * kPi * (kite - sector * (centre.x() + arm * out));
  const double top = radius + (a.h - z) * std::tan(a.beta);
  return frustum(0.0, radius, z) + frustum(radius, top, a.h - z) - corner;
}

struct Volume {
  const char* name;
  Cutter cutter;
  double expected;
};

void PrintTo(const Volume& one, std::ostream* out) {
  *out << one.name;
}

std::vector<Volume> volumes() {
  const double beta = rad_from_deg(5.0), tangent = 2.0 * (1.0 - std::sin(beta)), waist = 2.0 * std::cos(beta);
  const Cutter dovetail = apt(16, 0.5, 0, -30, 10), general = apt(10, 2, 10, 20, 25);
  const double fillet = kPi * (25 - 9) * 2.0 - 2.0 * kPi * kPi * (5.0 - 8.0 / (3.0 * kPi));
  return {
      {"flat", of_shape(Shape::kFlat, 10, 0, 25), cylinder(5, 25)},
      {"ball", of_shape(Shape::kBall, 10, 0, 25), 2.0 / 3.0 * kPi * 125 + cylinder(5, 20)},
      {"bull_nose", of_shape(Shape::kBullNose, 10, 2, 25),
       cylinder(3, 2) + quarter_torus(3, 2) + cylinder(5, 23)},
      {"taper_flat", taper(6, 0, 10, 20), frustum(3, 3 + 20 * std::tan(rad_from_deg(10)), 20)},
      {"taper_ball", taper(4, 2, 5, 30),
       kPi * tangent * tangent * (6 - tangent) / 3 +
           frustum(waist, waist + (30 - tangent) * std::tan(beta), 30 - tangent)},
      {"drill", drill(8, 118, 40),
       cylinder(4, 4 / std::tan(rad_from_deg(59))) / 3 + cylinder(4, 40 - 4 / std::tan(rad_from_deg(59)))},
      {"chamfer", chamfer(10, 2, 90, 12), frustum(1, 5, 4) + cylinder(5, 8)},
      {"chamfer_without_cylinder", chamfer(10, 0, 90, 5), cylinder(5, 5) / 3},
      {"woodruff", woodruff(20, 0, 4), cylinder(10, 4)},
      {"woodruff_rounded", woodruff(20, 1.5, 4),
       2 * (cylinder(8.5, 1.5) + quarter_torus(8.5, 1.5)) + cylinder(10, 1)},
      {"apt", general, apt_volume(*apt_form(general))},
      {"dovetail", dovetail, apt_volume(*apt_form(dovetail))},
      {"stepped", stepped(), cylinder(3, 2) / 3 + cylinder(3, 8) + cylinder(5, 20)},
      {"lollipop", lollipop(),
       4.0 / 3.0 * kPi * 64 - kPi * std::pow(4 - std::sqrt(12.0), 2) * (8 + std::sqrt(12.0)) / 3 +
           cylinder(2, 16 - std::sqrt(12.0))},
      {"toothed", toothed(), 6 * frustum(4, 5, 1) + cylinder(4, 3)},
      {"flared", flared(), cylinder(3, 12) + fillet + cylinder(5, 8)}};
}

class Volumes : public testing::TestWithParam<Volume> {};

/// Volume under the zero level of the pieces: discs of the radius at which F changes sign, summed with points
/// that crowd at the outline's corners, where the radius has its square roots.
double integrated(const Cutter& cutter) {
  const std::vector<ConvexPiece> pieces = cutting_pieces(cutter);
  const auto radius = [&](double z) {
    double low = 0.0, high = 2.0 * greatest_radius(outline(cutter));
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (union_distance(pieces, {middle, z}) <= 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  constexpr int kSlices = 600;
  double volume = 0.0;
  for (const OutlineElement& e : outline(cutter)) {
    const double height = e.to.y() - e.from.y();
    for (int i = 0; i < kSlices && height > 0.0; ++i) {
      const double angle = kPi * (i + 0.5) / kSlices;
      const double z = e.from.y() + 0.5 * height * (1.0 - std::cos(angle));
      volume += cylinder(radius(z), 0.5 * height * std::sin(angle) * kPi / kSlices);
    }
  }
  return volume;
}

TEST_P(Volumes, ArePappus) {
  const auto& [name, cutter, expected] = GetParam();
  ASSERT_TRUE(validate(cutter).empty()) << validate(cutter)[0].text;
  const double excess = integrated(cutter) - expected;
  // Chords of hollow arcs leave a little more, nowhere thicker than chord_error_mm.
  const double area = 2.0 * kPi * greatest_radius(outline(cutter)) * cutter.flute_length_mm;
  EXPECT_GT(excess, -2e-5 * expected);
  EXPECT_LT(excess, 2e-5 * expected + chord_error_mm(cutter) * area);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Volumes, testing::ValuesIn(volumes()),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Apt, CornerCircleTouchesBottomLineAndFlank) {
  Rng rng(20260727);
  int checked = 0;
  for (int i = 0; i < 2000; ++i) {
    AptForm form{rng.uniform(1, 20), 0.0, rad_from_deg(rng.uniform(0, 70)),
                 rad_from_deg(rng.uniform(-60, 70)), 50.0};
    if (form.alpha + form.beta > rad_from_deg(88)) continue;
    form.r = rng.uniform() * form.largest_corner_radius();
    ++checked;
    const Vec2 centre = form.corner_centre(), crossing(0.5 * form.d, 0.5 * form.d * std::tan(form.alpha));
    const Vec2 bottom(std::sin(form.alpha), -std::cos(form.alpha)),
        flank(std::cos(form.beta), -std::sin(form.beta));
    SCOPED_TRACE(fmt::format("d {} r {} alpha {} beta {}", form.d, form.r, form.alpha, form.beta));
    const double size = form.r + form.d;
    EXPECT_NEAR(bottom.dot(centre), -form.r, 1e-12 * size);
    EXPECT_NEAR(flank.dot(centre - crossing), -form.r, 1e-11 * size);
    EXPECT_NEAR((form.bottom_end() - centre).norm(), form.r, 1e-12 * size);
    EXPECT_GE(form.bottom_end().x(), -1e-9 * size) << "the circle ends before the axis";
    EXPECT_LE(form.bottom_end().y(), form.flank_start().y() + 1e-12);
  }
  EXPECT_GT(checked, 1500);
}

TEST(Apt, TheLargestCornerIsTheBall) {
  AptForm form{10, 0, 0, 0, 25};
  EXPECT_NEAR(form.largest_corner_radius(), 5.0, 1e-14);
  form.beta = rad_from_deg(10);
  form.r = form.largest_corner_radius();
  EXPECT_NEAR(form.corner_centre().x(), 0.0, 1e-14) << "a ball on a cone";
  EXPECT_NEAR(form.corner_centre().y(), form.r, 1e-14);
}

TEST(Taper, TheDiameterIsThatOfTheEnd) {
  // e + r = D/2, f = r, whatever the taper; with r = D/2 it is a ball of that diameter.
  for (const double corner : {0.5, 1.0, 2.0}) {
    const AptForm form = *apt_form(taper(4, corner, 7, 30));
    EXPECT_NEAR(form.corner_centre().x(), 2.0 - corner, 1e-14);
    EXPECT_NEAR(form.corner_centre().y(), corner, 1e-14);
  }
}

TEST(Outline, ElementsMeetAndRise) {
  for (const Named& one : every_shape()) {
    SCOPED_TRACE(one.name);
    const std::vector<OutlineElement> elements = outline(one.cutter);
    Vec2 last = Vec2::Zero();
    for (const OutlineElement& e : elements) {
      EXPECT_EQ((e.from - last).norm(), 0.0);
      EXPECT_GE(e.to.y(), e.from.y() - 1e-12);
      if (!e.is_line()) {
        EXPECT_NEAR((e.from - e.centre).norm(), std::abs(e.radius), 1e-9);
        EXPECT_NEAR((e.to - e.centre).norm(), std::abs(e.radius), 1e-9);
      }
      last = e.to;
    }
    EXPECT_NEAR(last.y(), one.cutter.flute_length_mm, 1e-12);
  }
}

TEST(Outline, ProfilesKnowTheirSize) {
  const Cutter ball = lollipop();
  EXPECT_NEAR(ball.diameter_mm, 8.0, 1e-12);
  EXPECT_EQ(ball.flute_length_mm, 20.0);
  // The widest place of a barrel lies inside its arc.
  const Cutter barrel = profile({{{0, 0}}, {{3, 0}}, {{3, 20}, 60.0}});
  EXPECT_NEAR(barrel.radius(), 3.0 + 60.0 - std::sqrt(3600.0 - 100.0), 1e-12);
}

TEST(Outline, SamplesStayWithinTheTolerance) {
  for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
    const std::vector<OutlineElement> elements = outline(of_shape(Shape::kBall, 10, 0, 25));
    const std::vector<Vec2> points = sample_outline(elements, tolerance);
    double worst = 0.0;
    for (size_t i = 0; i + 1 < points.size(); ++i) {
      if (points[i + 1].y() > 5.0) continue;
      EXPECT_NEAR((points[i] - Vec2(0, 5)).norm(), 5.0, 1e-12);
      worst = std::max(worst, 5.0 - (0.5 * (points[i] + points[i + 1]) - Vec2(0, 5)).norm());
    }
    EXPECT_LE(worst, tolerance * 1.000001);
    EXPECT_GT(worst, 0.3 * tolerance) << "not finer than asked for";
  }
}

}  // namespace
}  // namespace swarf::cutter::profile_test

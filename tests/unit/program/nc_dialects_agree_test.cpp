// One random job written for four controls: every reader must give the same moves.
#include <fmt/format.h>

#include <functional>

#include "base/rng.h"
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

enum class Kind { kRapid, kLine, kArc, kDwell, kFiveAxis };

struct Step {
  Kind kind = Kind::kRapid;
  Vec3 to = Vec3::Zero();
  Vec2 centre = Vec2::Zero();  ///< of arcs in XY
  bool clockwise = false;
  double a_deg = 0.0, c_deg = 0.0;  ///< of five-axis lines
  double feed_mm_min = 0.0, dwell_s = 0.0;
};

double rounded(double value) {
  return std::round(value * 1e4) * 1e-4;
}

Vec3 random_point(Rng& rng) {
  return {rounded(100.0 * rng.uniform(-1.0)), rounded(80.0 * rng.uniform(-1.0)),
          rounded(50.0 * rng.uniform())};
}

/// To the start of an arc, then round it; the end may lie higher (a helix).
void add_arc(Rng& rng, bool helix, std::vector<Step>& job) {
  const Vec2 centre(rounded(50.0 * rng.uniform(-1.0)), rounded(50.0 * rng.uniform(-1.0)));
  const double radius = 2.0 + 30.0 * rng.uniform(), start = kPi * rng.uniform(-1.0);
  const double angle = (0.05 + 1.9 * rng.uniform()) * kPi * (rng.uniform() < 0.5 ? -1.0 : 1.0);
  const auto at = [&](double turn, double z) {
    return Vec3(rounded(centre.x() + radius * std::cos(turn)), rounded(centre.y() + radius * std::sin(turn)),
                z);
  };
  const double feed = 100.0 + std::round(3000.0 * rng.uniform()), z = rounded(30.0 * rng.uniform());
  job.push_back({.kind = Kind::kLine, .to = at(start, z), .feed_mm_min = feed});
  Step arc{.kind = Kind::kArc, .to = at(start + angle, helix ? z + 2.5 : z), .feed_mm_min = feed};
  arc.centre = centre;
  arc.clockwise = angle < 0.0;
  job.push_back(arc);
}

std::vector<Step> random_job(Rng& rng, bool five_axes) {
  std::vector<Step> job;
  while (job.size() < 30) {
    const double feed = 100.0 + std::round(3000.0 * rng.uniform());
    switch (static_cast<int>(5.0 * rng.uniform())) {
      case 0:
        job.push_back({.kind = Kind::kRapid, .to = random_point(rng)});
        break;
      case 1:
        job.push_back({.kind = Kind::kLine, .to = random_point(rng), .feed_mm_min = feed});
        break;
      case 2:
        if (!five_axes) add_arc(rng, false, job);
        break;
      case 3:
        job.push_back({.kind = Kind::kDwell, .dwell_s = 0.5});
        job.push_back({.kind = Kind::kLine, .to = random_point(rng), .feed_mm_min = feed});
        break;
      default:
        if (!five_axes) break;
        Step turn{.kind = Kind::kFiveAxis, .to = random_point(rng), .feed_mm_min = feed};
        turn.a_deg = rounded(80.0 * rng.uniform(-1.0));
        turn.c_deg = rounded(170.0 * rng.uniform(-1.0));
        job.push_back(turn);
    }
  }
  return job;
}

using Writer = std::function<std::string(const Step&, const Vec3& from)>;

/// I J of the centre from the start of the arc, as LinuxCNC, Fanuc and 840D have it.
std::string letters(const Step& step, const Vec3& from, const char* dwell) {
  const std::string point = fmt::format("X{:.4f} Y{:.4f} Z{:.4f}", step.to.x(), step.to.y(), step.to.z());
  switch (step.kind) {
    case Kind::kRapid:
      return "G0 " + point;
    case Kind::kLine:
      return fmt::format("G1 {} F{:.1f}", point, step.feed_mm_min);
    case Kind::kArc:
      return fmt::format("{} {} I{:.4f} J{:.4f} F{:.1f}", step.clockwise ? "G2" : "G3", point,
                         step.centre.x() - from.x(), step.centre.y() - from.y(), step.feed_mm_min);
    case Kind::kDwell:
      return fmt::format("G4 {}{:.3f}", dwell, step.dwell_s);
    case Kind::kFiveAxis:
      return fmt::format("G1 {} A{:.4f} C{:.4f} F{:.1f}", point, step.a_deg, step.c_deg, step.feed_mm_min);
  }
  return "";
}

std::string klartext(const Step& step) {
  const std::string point = fmt::format("X{:+.4f} Y{:+.4f} Z{:+.4f}", step.to.x(), step.to.y(), step.to.z());
  switch (step.kind) {
    case Kind::kRapid:
      return "L " + point + " R0 FMAX";
    case Kind::kLine:
      return fmt::format("L {} R0 F{:.1f}", point, step.feed_mm_min);
    case Kind::kArc:
      return fmt::format("CC X{:+.4f} Y{:+.4f}\nC X{:+.4f} Y{:+.4f} DR{} F{:.1f}", step.centre.x(),
                         step.centre.y(), step.to.x(), step.to.y(), step.clockwise ? "-" : "+",
                         step.feed_mm_min);
    case Kind::kDwell:
      return fmt::format("CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL {:.3f}", step.dwell_s);
    case Kind::kFiveAxis:
      return fmt::format("L {} A{:+.4f} C{:+.4f} R0 F{:.1f}", point, step.a_deg, step.c_deg,
                         step.feed_mm_min);
  }
  return "";
}

struct Control {
  Dialect dialect;
  const char *head, *five_axes, *tail;
  Writer write;
};

const std::vector<Control>& controls() {
  static const std::vector<Control> all{
      {Dialect::kLinuxCnc, "G21 G90 G94 G17 G40 G49 G54 G61\nT2 M6\nG43 H2\nS4000 M3\n", "M428\n", "M2\n",
       [](const Step& step, const Vec3& from) { return letters(step, from, "P"); }},
      {Dialect::kFanuc, "%\nO0001\nG21 G90 G94 G17 G40 G49 G54 G61\nT2 M06\nG43 H2\nS4000 M03\n",
       "G43.4 H2\n", "M30\n%\n", [](const Step& step, const Vec3& from) { return letters(step, from, "X"); }},
      {Dialect::kSiemens, "G71 G90 G94 G17 G40 G54 G60\nT=2 M6\nD1\nS4000 M3\n", "TRAORI\nORIAXES\n", "M30\n",
       [](const Step& step, const Vec3& from) { return letters(step, from, "F"); }},
      {Dialect::kHeidenhain, "BEGIN PGM TEST MM\nTOOL CALL 2 Z S4000\nCYCL DEF 247 Q339=+1\nM3\n", "M128\n",
       "END PGM TEST MM\n", [](const Step& step, const Vec3&) { return klartext(step); }}};
  return all;
}

std::string program_of(const Control& control, const std::vector<Step>& job, bool five_axes) {
  std::string text = control.head;
  if (five_axes) text += control.five_axes;
  Vec3 at = Vec3::Zero();
  for (const Step& step : job) {
    text += control.write(step, at) + "\n";
    if (step.kind != Kind::kDwell) at = step.to;
  }
  return text + control.tail;
}

/// Moves that go somewhere.
std::vector<NcMove> travelled(const NcRun& run) {
  std::vector<NcMove> moves;
  for (const NcMove& move : run.moves()) {
    if (move.q_from != move.q_to || move.dwell_s > 0.0) moves.push_back(move);
  }
  return moves;
}

void expect_same(const std::vector<NcMove>& ours, const std::vector<NcMove>& first) {
  ASSERT_EQ(ours.size(), first.size());
  for (size_t i = 0; i < ours.size(); ++i) {
    const NcMove &a = ours[i], &b = first[i];
    SCOPED_TRACE(fmt::format("move {}, line {}", i, a.line));
    EXPECT_LT((a.q_to - b.q_to).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((a.to.tip_W - b.to.tip_W).norm(), 1e-9);
    EXPECT_LT((a.to.axis_W - b.to.axis_W).norm(), 1e-12);
    EXPECT_EQ(a.rapid, b.rapid);
    EXPECT_NEAR(a.duration_s, b.duration_s, 1e-9 * (1.0 + b.duration_s));
    EXPECT_EQ(a.dwell_s, b.dwell_s);
    EXPECT_EQ(a.spindle_rpm, b.spindle_rpm);
    EXPECT_EQ(a.tool, b.tool);
    if (!a.rapid) {
      EXPECT_STREQ(law_name(a.law), law_name(b.law));
    }
    ASSERT_EQ(a.arc.has_value(), b.arc.has_value());
    if (!a.arc) continue;
    EXPECT_LT((a.arc->centre_W - b.arc->centre_W).norm(), 1e-9);
    EXPECT_LT((a.arc->normal_W - b.arc->normal_W).norm(), 1e-12);
  }
}

void expect_all_agree(bool five_axes) {
  ControlSetup setup = five_axes ? five_axis_setup() : three_axis_setup();
  AxisValues offset = AxisValues::Zero();
  offset.head<3>() << 10.0, -20.0, 30.0;
  setup.work_offsets[1] = offset;
  setup.start->z() = 300.0;
  Rng rng(five_axes ? 92 : 91);
  for (int n = 0; n < 40 && !testing::Test::HasFailure(); ++n) {
    const std::vector<Step> job = random_job(rng, five_axes);
    std::vector<NcMove> first;
    for (const Control& control : controls()) {
      const std::string text = program_of(control, job, five_axes);
      SCOPED_TRACE(fmt::format("job {} for {}:\n{}", n, dialect_name(control.dialect), text));
      const NcRun run = run_text(text, control.dialect, setup);
      ASSERT_EQ(run.first_error(), "") << run.text();
      if (first.empty()) {
        first = travelled(run);
        ASSERT_GE(first.size(), 20U);
      } else {
        expect_same(travelled(run), first);
      }
      if (testing::Test::HasFailure()) break;
    }
  }
}

TEST(NcDialects, AgreeOnLinesArcsAndDwells) {
  expect_all_agree(false);
}

TEST(NcDialects, AgreeUnderToolTipControl) {
  expect_all_agree(true);
}

}  // namespace
}  // namespace swarf::program

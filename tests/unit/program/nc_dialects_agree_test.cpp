// One random job written for four controls: every reader must give the same moves.
#include <fmt/format.h>

#include <functional>

#include "base/rng.h"
#include "unit/program/nc_support.h"

namespace swarf::program::nc_dialects_agree_test {
namespace {

enum class Kind { kRapid, kLine, kArc, kDwell, kFiveAxis, kTurn, kHole };

struct Step {
  Kind kind = Kind::kRapid;
  Vec3 to = Vec3::Zero();
  Vec2 centre = Vec2::Zero();  ///< of arcs in XY
  bool clockwise = false;
  double a_deg = 0.0, c_deg = 0.0;  ///< of five-axis lines; c_deg: of the frame about its zero (kTurn)
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

constexpr double kLevel = 60.0, kAbove = 2.0, kDepth = -12.5;  // of the holes, mm

void add_hole(Rng& rng, std::vector<Step>& job) {
  Step above{.kind = Kind::kRapid, .to = random_point(rng)};
  above.to.z() = kLevel;
  Step hole{.kind = Kind::kHole, .to = random_point(rng), .feed_mm_min = 150.0};
  hole.to.z() = kLevel;  // where the tool stands after it
  job.push_back(above);
  job.push_back(hole);
}

std::vector<Step> random_job(Rng& rng, bool five_axes) {
  std::vector<Step> job;
  while (job.size() < 30) {
    const double feed = 100.0 + std::round(3000.0 * rng.uniform());
    switch (static_cast<int>(7.0 * rng.uniform())) {
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
      case 4:
        if (!five_axes) add_hole(rng, job);
        break;
      case 5:
        if (!five_axes) job.push_back({.kind = Kind::kTurn, .c_deg = rounded(80.0 * rng.uniform(-1.0))});
        if (!five_axes) job.push_back({.kind = Kind::kRapid, .to = random_point(rng)});
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

/// What the three controls of letters write each in its own way.
struct Words {
  const char* dwell;
  const char* turn;  ///< with a place for the angle
  bool cycle81;
};

std::string drilling(const Step& step, const Words& words) {
  if (words.cycle81)
    return fmt::format("F{:.1f}\nG0 X{:.4f} Y{:.4f}\nCYCLE81({},0,{},{})", step.feed_mm_min, step.to.x(),
                       step.to.y(), kLevel, kAbove, kDepth);
  return fmt::format("G98 G81 X{:.4f} Y{:.4f} Z{} R{} F{:.1f}\nG80", step.to.x(), step.to.y(), kDepth, kAbove,
                     step.feed_mm_min);
}

/// I J of the centre from the start of the arc, as LinuxCNC, Fanuc and 840D have it.
std::string letters(const Step& step, const Vec3& from, const Words& words) {
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
      return fmt::format("G4 {}{:.3f}", words.dwell, step.dwell_s);
    case Kind::kTurn:
      return fmt::format(fmt::runtime(words.turn), step.c_deg);
    case Kind::kHole:
      return drilling(step, words);
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
    case Kind::kTurn:
      return fmt::format("CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT{:+.4f}", step.c_deg);
    case Kind::kHole:
      return fmt::format(
          "CYCL DEF 200 DRILLING Q200=+{} Q201={} Q206=+{:.1f} Q202=+50 Q210=+0 Q203=+0 Q204=+{} Q211=+0\n"
          "L X{:+.4f} Y{:+.4f} R0 FMAX M99",
          kAbove, kDepth, step.feed_mm_min, kLevel, step.to.x(), step.to.y());
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
       [](const Step& step, const Vec3& from) {
         return letters(step, from, {"P", "G10 L2 P1 R{:.4f}", false});
       }},
      {Dialect::kFanuc, "%\nO0001\nG21 G90 G94 G17 G40 G49 G54 G61\nT2 M06\nG43 H2\nS4000 M03\n",
       "G43.4 H2\n", "M30\n%\n",
       [](const Step& step, const Vec3& from) {
         return letters(step, from, {"X", "G69\nG68 X0 Y0 R{:.4f}", false});
       }},
      {Dialect::kSiemens, "G71 G90 G94 G17 G40 G54 G60\nT=2 M6\nD1\nS4000 M3\n", "TRAORI\nORIAXES\n", "M30\n",
       [](const Step& step, const Vec3& from) {
         return letters(step, from, {"F", "ROT RPL={:.4f}", true});
       }},
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
    if (step.kind != Kind::kDwell && step.kind != Kind::kTurn) at = step.to;
  }
  return text + control.tail;
}

/// Moves that go somewhere; rapids along the tool that follow each other are one.
std::vector<NcMove> travelled(const NcRun& run) {
  std::vector<NcMove> moves;
  for (const NcMove& move : run.moves()) {
    if (move.q_from == move.q_to && move.dwell_s == 0.0) continue;
    const auto lifts = [](const NcMove& one) {
      const Vec3 way = one.to.tip_W - one.from.tip_W;
      return one.rapid && one.dwell_s == 0.0 && way.z() > 0.0 && way.head<2>().norm() < 1e-12;
    };
    if (!moves.empty() && lifts(moves.back()) && lifts(move)) {
      moves.back().q_to = move.q_to;
      moves.back().to = move.to;
    } else {
      moves.push_back(move);
    }
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

/// A contour with the cutter beside it, of lines and arcs by radius. It is entered and left along its first
/// and last piece: there the controls' rules for the way in and out are the same.
struct ContourPiece {
  Vec2 to = Vec2::Zero();
  double radius = 0.0;  ///< of an arc; 0: a line
  bool clockwise = false;
};

struct ContourJob {
  Vec2 from = Vec2::Zero(), out = Vec2::Zero();
  std::vector<ContourPiece> pieces;
  bool left = true;
};

ContourJob random_contour(Rng& rng) {
  ContourJob job;
  job.left = rng.uniform() < 0.5;
  const int count = 4 + static_cast<int>(3.0 * rng.uniform());
  const double sense = rng.uniform() < 0.5 ? -1.0 : 1.0;
  for (int i = 0; i < count; ++i) {
    const double angle = sense * 2.0 * kPi * (i + 0.3 * rng.uniform()) / count,
                 radius = 40.0 + 30.0 * rng.uniform();
    ContourPiece piece{{rounded(radius * std::cos(angle)), rounded(radius * std::sin(angle))}};
    if (i > 1 && i + 1 < count && rng.uniform() < 0.4) {
      piece.radius = rounded((0.6 + rng.uniform()) * (piece.to - job.pieces.back().to).norm());
      piece.clockwise = rng.uniform() < 0.5;
    }
    job.pieces.push_back(piece);
  }
  // Exactly in line, four decimals or not.
  const auto beyond = [](const Vec2& end, const Vec2& before) { return Vec2(2.0 * end - before); };
  job.from = beyond(job.pieces[0].to, job.pieces[1].to);
  job.out = beyond(job.pieces[job.pieces.size() - 1].to, job.pieces[job.pieces.size() - 2].to);
  return job;
}

/// The smallest turn at a corner, rad: up to 0.05 LinuxCNC takes it for none.
double smallest_corner(const ContourJob& job) {
  double least = kPi, heading = 0.0;
  Vec2 at = job.from;
  for (const ContourPiece& piece : job.pieces) {
    const Vec2 chord = piece.to - at;
    const double half = piece.radius > 0.0 ? std::asin(0.5 * chord.norm() / piece.radius) : 0.0;
    const double along = std::atan2(chord.y(), chord.x()), turn = piece.clockwise ? -half : half;
    const double corner = std::abs(std::remainder(along - turn - heading, 2.0 * kPi));
    if (&piece > &job.pieces[1])
      least = std::min(least, corner);  // the way in and the first piece are in line
    heading = along + turn;
    at = piece.to;
  }
  return least;
}

std::string contour_of(const Control& control, const ContourJob& job) {
  const bool klartext = control.dialect == Dialect::kHeidenhain;
  const auto point = [&](const Vec2& p) {
    return klartext ? fmt::format("X{:+.4f} Y{:+.4f}", p.x(), p.y())
                    : fmt::format("X{:.4f} Y{:.4f}", p.x(), p.y());
  };
  std::string text = control.head;
  text += klartext ? "L " + point(job.from) + " Z+0 R0 FMAX\n" : "G0 " + point(job.from) + " Z0\n";
  bool first = true;
  for (const ContourPiece& piece : job.pieces) {
    const char* side = !first     ? ""
                       : klartext ? (job.left ? " RL F500" : " RR F500")
                       : job.left ? "G41 "
                                  : "G42 ";
    const char* edge = first && !klartext && control.dialect != Dialect::kSiemens ? " D2" : "";
    if (piece.radius == 0.0)
      text += klartext ? fmt::format("L {}{}\n", point(piece.to), side)
                       : fmt::format("{}G1 {}{} F500\n", side, point(piece.to), edge);
    else if (klartext)
      text +=
          fmt::format("CR {} R{:+.4f} DR{}\n", point(piece.to), piece.radius, piece.clockwise ? "-" : "+");
    else
      text += fmt::format("{} {} {}{:.4f}\n", piece.clockwise ? "G2" : "G3", point(piece.to),
                          control.dialect == Dialect::kSiemens ? "CR=" : "R", piece.radius);
    first = false;
  }
  text += klartext ? "L " + point(job.out) + " R0\n" : "G40 G1 " + point(job.out) + "\n";
  return text + control.tail;
}

TEST(NcDialects, AgreeOnCompensatedContours) {
  ControlSetup setup = three_axis_setup();
  Rng rng(93);
  int refused = 0;
  for (int n = 0; n < 200 && !testing::Test::HasFailure(); ++n) {
    const ContourJob job = random_contour(rng);
    if (smallest_corner(job) < 0.06) continue;
    std::vector<NcMove> first;
    std::string error;
    for (const Control& control : controls()) {
      const std::string text = contour_of(control, job);
      SCOPED_TRACE(fmt::format("contour {} for {}:\n{}", n, dialect_name(control.dialect), text));
      const NcRun run = run_text(text, control.dialect, setup);
      const std::string code = run.first_error().substr(0, run.first_error().find(' '));
      if (first.empty() && error.empty()) {
        error = code;
        first = travelled(run);
        refused += code.empty() ? 0 : 1;
      }
      EXPECT_EQ(code, error) << run.text();
      if (code.empty()) expect_same(travelled(run), first);
      if (testing::Test::HasFailure()) break;
    }
  }
  EXPECT_LT(refused, 60);
}

TEST(NcDialects, AgreeOnLinesArcsAndDwells) {
  expect_all_agree(false);
}

TEST(NcDialects, AgreeUnderToolTipControl) {
  expect_all_agree(true);
}

}  // namespace
}  // namespace swarf::program::nc_dialects_agree_test

#include "program/cl/writer.h"

#include <algorithm>

#include "base/rng.h"
#include "unit/program/cl_support.h"

namespace swarf::program::cl_writer_test {
namespace {

void expect_same_tool(const ClProgram& a, int in_a, const ClProgram& b, int in_b) {
  ASSERT_EQ(in_a < 0, in_b < 0);
  if (in_a < 0) return;
  EXPECT_EQ(a.tools[static_cast<size_t>(in_a)].number, b.tools[static_cast<size_t>(in_b)].number);
  EXPECT_EQ(a.tools[static_cast<size_t>(in_a)].name, b.tools[static_cast<size_t>(in_b)].name);
}

/// Unit vectors are normalised when they are read, which may change the last bits of all three.
constexpr double kAxisRounding = 5e-16;

void expect_round_trip(const ClProgram& p) {
  const std::string text = write_cl(p);
  ClOptions options;
  options.cutcom = ClPoints::kCentre;  // CUTCOM is written where the points are the centre
  const ClProgram q = read_cl_clean(text, options);
  ASSERT_EQ(q.moves.size(), p.moves.size()) << text;
  EXPECT_EQ(q.start.tip_W, p.start.tip_W);
  for (size_t i = 0; i < p.moves.size(); ++i) {
    const Move &a = p.moves[i], &b = q.moves[i];
    ASSERT_EQ(a.to.tip_W, b.to.tip_W) << "move " << i << " of\n" << text;
    ASSERT_LE((a.to.axis_W - b.to.axis_W).norm(), kAxisRounding) << "move " << i << " of\n" << text;
    ASSERT_EQ(a.arc.has_value(), b.arc.has_value());
    if (a.arc) {
      ASSERT_EQ(a.arc->centre_W, b.arc->centre_W);
      ASSERT_LE((a.arc->normal_W - b.arc->normal_W).norm(), kAxisRounding);
    }
    ASSERT_NEAR(a.feed_mm_s, b.feed_mm_s, 1e-15 * a.feed_mm_s) << text;
    ASSERT_EQ(a.spindle_rpm, b.spindle_rpm);
    ASSERT_EQ(a.dwell_s, b.dwell_s);
    expect_same_tool(p, a.tool, q, b.tool);
  }
  const auto kept = [](const ClProgram& program) {
    return std::count_if(program.notes.begin(), program.notes.end(),
                         [](const ClNote& note) { return note.word != "TOOL PATH"; });
  };
  EXPECT_EQ(kept(p), kept(q));
}

std::string random_statement(Rng& rng) {
  const auto number = [&] { return std::to_string(rng.uniform(-200.0, 200.0)); };
  const Vec3 axis = Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.2, 1)).normalized();
  const auto vector = [](const Vec3& v) {
    return std::to_string(v.x()) + "," + std::to_string(v.y()) + "," + std::to_string(v.z());
  };
  switch (rng.next() % 12) {
    case 0:
      return "RAPID\n";
    case 1:
      return "FEDRAT/" + std::to_string(rng.uniform(1.0, 5000.0)) + ",MMPM\n";
    case 2:
      return "SPINDL/RPM," + std::to_string(rng.next() % 20000 + 1) + (rng.next() % 2 ? ",CLW\n" : ",CCLW\n");
    case 3:
      return "LOADTL/" + std::to_string(1 + rng.next() % 4) + "\n";
    case 4:
      return "TOOL PATH/A,TOOL,MILL " + std::to_string(rng.next() % 3) + "\n";
    case 5:
      return "DELAY/" + std::to_string(rng.uniform(0.0, 2.0)) + "\nPPRINT/note\n";
    case 6: {
      const double x = rng.uniform(-50, 50), r = rng.uniform(1, 30);
      return "CYCLE/OFF\nGOTO/" + std::to_string(x + r) + ",0,5\nCIRCLE/" + std::to_string(x) +
             ",0,5,0,0,1," + std::to_string(r) + "\nGOTO/" + std::to_string(x - r) + ",0,5\n";
    }
    case 7:
      return rng.next() % 2 ? "CUTCOM/LEFT,1\n" : "CUTCOM/OFF\n";
    case 8: {
      const double x = rng.uniform(-50, 50), r = rng.uniform(1, 30), down = rng.uniform(0.1, 4);
      return "CYCLE/OFF\nGOTO/" + std::to_string(x + r) + ",0,5\nCIRCLE/" + std::to_string(x) +
             ",0,5,0,0,1," + std::to_string(r) + ",TIMES," + std::to_string(1 + rng.next() % 3) + "\nGOTO/" +
             std::to_string(x + r) + ",0," + std::to_string(5 - down) + "\n";
    }
    case 9:
      return "CYCLE/DEEP,DEPTH,9,CLEAR,2,STEP,4,MMPM,120\n";
    default:
      return "GOTO/" + number() + "," + number() + "," + number() + "," + vector(axis) + "\n";
  }
}

TEST(ClWriter, RoundTripOfRandomPrograms) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    Rng rng(seed);
    std::string text = "UNITS/MM\nMULTAX/ON\nFEDRAT/500,MMPM\nGOTO/0,0,100,0,0,1\nMSYS/1,2,3,0,1,0,0,0,1\n";
    for (int i = 0; i < 40; ++i) {
      std::string statement = random_statement(rng);
      // RAPID before an arc is refused, and so is an arc inside a cycle.
      if (statement.starts_with("CYCLE/OFF") && text.ends_with("RAPID\n"))
        statement = "FEDRAT/9\nGOTO/1,1,1\n" + statement;
      text += statement;
    }
    text += "CYCLE/OFF\nGOTO/0,0,100\n";
    Diagnostics diagnostics;
    ClOptions options = as_nx();
    options.cutcom = ClPoints::kCentre;
    const ClProgram program = parse_cl(text, "test.cl", diagnostics, options);
    ASSERT_TRUE(diagnostics.list().empty()) << all_text(diagnostics) << "--- of\n" << text;
    expect_round_trip(program);
    if (testing::Test::HasFailure()) FAIL() << "seed " << seed << ":\n" << text;
  }
}

struct RealProgram {
  const char* file;
  size_t moves, arcs;
  int statements;
  const char* tool;  ///< name, or number
  double end[3];
};
void PrintTo(const RealProgram& real, std::ostream* out) {
  *out << real.file;
}

class RealCl : public testing::TestWithParam<RealProgram> {};

/// Numbers counted in the files by grep: GOTO statements less the first, CIRCLE statements, all statements.
TEST_P(RealCl, IsReadToItsLastWordAndWrittenAgain) {
  const RealProgram& real = GetParam();
  const ClProgram p = load_cl(project_file(std::string("assets/programs/stepnode/") + real.file));
  EXPECT_EQ(p.moves.size(), real.moves);
  const auto arcs =
      std::count_if(p.moves.begin(), p.moves.end(), [](const Move& m) { return m.arc.has_value(); });
  EXPECT_EQ(static_cast<size_t>(arcs), real.arcs);
  EXPECT_EQ(p.statements, real.statements);
  ASSERT_EQ(p.tools.size(), 1U);
  EXPECT_EQ(p.tools[0].name.empty() ? std::to_string(p.tools[0].number) : p.tools[0].name, real.tool);
  EXPECT_EQ(p.moves.back().to.tip_W, Vec3(real.end[0], real.end[1], real.end[2]));
  expect_round_trip(p);
}
INSTANTIATE_TEST_SUITE_P(
    Files, RealCl,
    testing::Values(RealProgram{"simple_block.cls", 103, 33, 205, "MILL-20MM", {87.6601, -14.0265, 15}},
                    RealProgram{"coremill.cls", 3129, 614, 4492, "MILL", {190.3129, 145.7082, 30}},
                    RealProgram{"Plane_1.cldata", 205, 29, 323, "45", {0, 0, 50}}));

}  // namespace
}  // namespace swarf::program::cl_writer_test

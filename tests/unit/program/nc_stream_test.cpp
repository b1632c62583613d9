// Programs are streamed: what a line costs is time, not memory. Every operator new of this executable is
// counted, in every build; the peak of the program itself is held where no sanitizer adds its own.
#include <fmt/format.h>
#include <sys/resource.h>

#include "program/cl/program.h"
#include "support/counted_new.h"
#include "support/program_run.h"
#include "support/scratch.h"
#include "unit/program/nc_support.h"

namespace swarf::program::nc_stream_test {
namespace {

struct Counter final : NcSink {
  bool move(const NcMove& /*move*/) override {
    ++moves;
    return true;
  }
  long moves = 0;
};

struct Allocated {
  long times, bytes;
  Allocated operator-(const Allocated& other) const { return {times - other.times, bytes - other.bytes}; }
};

Allocated allocated_so_far() {
  return {allocations, allocated_bytes};
}

struct Kind {
  Dialect dialect;
  const char* head;
  std::string (*row)(int);
  const char* end = "M30\n";
};

std::string plain_row(int i) {
  return fmt::format("G1 X{:.3f} Y{:.3f} Z{:.3f} F500 (row {})\n", 0.1 * (i % 100), 0.2 * (i % 77),
                     0.01 * (i % 31), i);
}
std::string plain_siemens_row(int i) {
  return fmt::format("N{} G1 X{:.3f} Y={:.3f}+R1 F500 ; row\n", i, 0.1 * (i % 100), 0.2 * (i % 77));
}
std::string formula_row(int i) {
  return fmt::format("G1 X[#31*cos[{}]] Y[#31*sin[{}]] A[{}/10] C#31 F500\n", i % 360, i % 360, i % 50);
}
std::string rotary_row(int i) {
  return fmt::format("G1 X{:.3f} A{:.2f} C{:.2f} F500\n", 0.1 * (i % 100), 0.1 * (i % 300), 0.1 * (i % 700));
}
std::string vector_row(int i) {
  return fmt::format("G1 X{:.3f} A3={:.3f} B3=.25 C3=1 F500\n", 0.1 * (i % 100), 0.01 * (i % 50));
}
std::string klartext_row(int i) {
  return fmt::format("{} L X{:+.3f} Y{:+.3f} IZ+0,125 R0 F500\n", i, 0.1 * (i % 100), 0.2 * (i % 77));
}
std::string klartext_arc_row(int i) {
  return i % 2 == 0 ? "CC X+5 Y+0\n" : "C X+10 Y+0 DR+ F500\nCR X+0 Y+0 R+5 DR-\n";
}
std::string klartext_rotary_row(int i) {
  return fmt::format("L X{:+.3f} A{:+.2f} C{:+.2f} F500\n", 0.1 * (i % 100), 0.1 * (i % 300),
                     0.1 * (i % 700));
}
std::string klartext_vector_row(int i) {
  return fmt::format("LN X{:+.3f} TX+0 TY{} TZ+0.8 F500\n", 0.1 * (i % 100), i % 2 == 0 ? "+0.6" : "-0.6");
}
std::string klartext_formula_row(int i) {
  return i % 2 == 0 ? fmt::format("Q5 = Q31 * SIN {} + ( Q1 - 2 ) ^ 2\n", i % 360) : "L X+Q5 IY-Q1 F500\n";
}
std::string arc_row(int i) {
  return i % 2 == 0 ? "G2 X10 Y0 I5 J0 F500\n" : "G3 X0 Y0 R5 F500\n";
}

const Kind kKinds[] = {
    {Dialect::kLinuxCnc, "G21 G90\n", plain_row},
    {Dialect::kLinuxCnc, "G0 X0 Y0\n", arc_row},
    {Dialect::kLinuxCnc, "#31=5\nM428\n", formula_row},
    {Dialect::kFanuc, "G21 G90\n", plain_row},
    {Dialect::kFanuc, "T1 M06\nG43.4 H1\n", rotary_row},
    {Dialect::kSiemens, "G710 G90\nR1=2\n", plain_siemens_row},
    {Dialect::kSiemens, "TRAORI\nORIAXES\n", rotary_row},
    {Dialect::kSiemens, "TRAORI\nORIVECT\n", vector_row},
    {Dialect::kHeidenhain, "BEGIN PGM A MM\n", klartext_row, "END PGM A MM\n"},
    {Dialect::kHeidenhain, "BEGIN PGM A MM\n", klartext_arc_row, "END PGM A MM\n"},
    {Dialect::kHeidenhain, "BEGIN PGM A MM\nM128\n", klartext_rotary_row, "END PGM A MM\n"},
    {Dialect::kHeidenhain, "BEGIN PGM A MM\nM128\n", klartext_vector_row, "END PGM A MM\n"},
    {Dialect::kHeidenhain, "BEGIN PGM A MM\nQ31 = 5\nQ1 = 1\n", klartext_formula_row, "END PGM A MM\n"},
};

TEST(NcStream, LinesAllocateNothing) {
  const ControlSetup setup = five_axis_setup();
  for (const Kind& kind : kKinds) {
    const auto allocated = [&](int rows) {
      std::string text = kind.head;
      for (int i = 0; i < rows; ++i) text += kind.row(i);
      const auto path = test::scratch_folder() / "swarf_nc_stream.txt";
      std::ofstream(path) << text << kind.end;
      Counter counter;
      Diagnostics diagnostics;
      const Allocated before = allocated_so_far();
      run_nc(path.string(), kind.dialect, setup, counter, diagnostics);
      const Allocated during = allocated_so_far() - before;
      EXPECT_FALSE(diagnostics.has_errors()) << format(diagnostics.list().front());
      EXPECT_GE(counter.moves, rows / 2 - 1);
      return during;
    };
    const Allocated few = allocated(3000), many = allocated(9000);
    EXPECT_GT(few.times, 0);  // the counter counts
    // A Siemens source notes the place of each 64th line: a vector that grows.
    EXPECT_LE(many.times - few.times, 4) << dialect_name(kind.dialect) << ": " << kind.row(1);
    EXPECT_LE(many.bytes - few.bytes, 8192) << dialect_name(kind.dialect) << ": " << kind.row(1);
  }
}

struct ClCounter final : ClSink {
  void move(const Move& move) override {
    ++moves;
    way += (move.to.tip_W - move.from.tip_W).norm();
  }
  void note(ClNote /*note*/) override { ++notes; }
  long moves = 0, notes = 0;
  double way = 0.0;
};

TEST(NcStream, ClLinesAllocateNothing) {
  const auto path = (test::scratch_folder() / "swarf_cl_stream.cls").string();
  const auto allocated = [&](int rows, bool arcs) {
    {
      std::ofstream file(path);
      file << "TOOL PATH/A,TOOL,B\nMULTAX/ON\nFEDRAT/500,MMPM\nGOTO/5,0,0,0,0,1\n";
      for (int i = 0; i < rows; ++i) {
        if (arcs)
          file << fmt::format("PAINT/COLOR,31\nCIRCLE/0,0,0,0,0,{},5\nGOTO/{},0,0\n", i % 2 ? 1 : -1,
                              i % 2 ? 5 : -5);
        else
          file << fmt::format("GOTO/{:.6f},{:.6f},-123.{:06},0.6000000,0.0000000,0.8000000\n",
                              0.1 * (i % 977), 0.2 * (i % 77), i % 1000000);
      }
    }
    ClCounter counter;
    Diagnostics diagnostics;
    const Allocated before = allocated_so_far();
    const ClProgram program = stream_cl(path, counter, diagnostics);
    const Allocated during = allocated_so_far() - before;
    EXPECT_FALSE(diagnostics.has_errors()) << format(diagnostics.list().front());
    EXPECT_EQ(counter.moves, rows);
    EXPECT_EQ(program.motions, rows);
    EXPECT_TRUE(program.moves.empty());
    return during;
  };
  for (const bool arcs : {false, true}) {
    const Allocated few = allocated(3000, arcs), many = allocated(9000, arcs);
    EXPECT_GT(few.times, 0);  // the counter counts
    EXPECT_LE(many.times - few.times, 4) << arcs;
    EXPECT_LE(many.bytes - few.bytes, 8192) << arcs;
  }
  std::filesystem::remove(path);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kPeakIsOurs = false;  // the sanitizer's shadow and quarantine are in it
#else
constexpr bool kPeakIsOurs = true;
#endif

/// Peak memory of all programs started so far, MB.
double children_peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

TEST(NcStream, LongProgramsNeedNoMoreMemory) {
  const auto folder = test::fresh_folder("nc_stream");
  for (const char* name : {"long.ngc", "long.mpf", "long.h"}) {
    const bool klartext = std::string(name) == "long.h";
    const auto check = [&](int lines) {
      {
        std::ofstream out(folder / name, std::ios::binary);
        out << (klartext ? "BEGIN PGM A MM\nL X+0 Y+0 Z+20 FMAX\nL Z+0 F2000\n"
                         : "G90\nG0 X0 Y0 Z20\nG1 Z0 F2000\n");
        for (int i = 0; i < lines; ++i)
          out << fmt::format("{}X{:.3f} Y{:.3f} ; a row\n", klartext ? "L " : "", 0.1 * (i % 100),
                             0.2 * (i % 77));
        out << (klartext ? "END PGM A MM\n" : "M30\n");
      }
      const test::ProgramRun run = test::run_swarf(fmt::format("check --home {}", (folder / name).string()));
      EXPECT_EQ(run.exit_code, 0) << run.output;
      EXPECT_NE(run.output.find(fmt::format("{} lines", lines + 4)), std::string::npos) << run.output;
      return children_peak_mb();
    };
    const double small = check(1000), large = check(400'000);  // 9 MB of text
    if (!kPeakIsOurs) continue;
    EXPECT_LT(large, 300.0) << name;
    EXPECT_LT(large - small, 4.0) << name;
  }
  std::filesystem::remove_all(folder);
}

TEST(NcStream, LineOfHundredMegabytesIsRefusedAndNotKept) {
  const auto folder = test::fresh_folder("nc_long_line");
  const std::pair<const char*, Dialect> files[] = {{"one.ngc", Dialect::kLinuxCnc},
                                                   {"one.nc", Dialect::kFanuc},
                                                   {"one.mpf", Dialect::kSiemens},
                                                   {"one.h", Dialect::kHeidenhain}};
  for (const auto& [name, dialect] : files) {
    {
      std::ofstream out(folder / name, std::ios::binary);
      out << (std::string(name) == "one.h" ? "BEGIN PGM A MM\n" : "G0 X1\n");
      const std::string piece(1 << 20, '1');
      for (int i = 0; i < 100; ++i) out << piece;
    }
    const test::ProgramRun run = test::run_swarf(
        fmt::format("check --home --dialect {} {}", dialect_name(dialect), (folder / name).string()));
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find(std::string(name) + ":2:1: error: this line is longer than 65536"),
              std::string::npos)
        << run.output;
    if (kPeakIsOurs) {
      EXPECT_LT(children_peak_mb(), 100.0);
    }
    const Allocated before = allocated_so_far();
    Counter counter;
    Diagnostics diagnostics;
    run_nc((folder / name).string(), dialect, three_axis_setup(), counter, diagnostics);
    EXPECT_TRUE(diagnostics.has_errors());
    EXPECT_LT((allocated_so_far() - before).bytes, 4 << 20) << name;
    std::filesystem::remove(folder / name);
  }
}

// CR, LF, CR LF and a byte order mark are the same program in every dialect, also where the window ends.
TEST(NcStream, LineEndsAndByteOrderMark) {
  for (const Dialect dialect : {Dialect::kLinuxCnc, Dialect::kFanuc, Dialect::kSiemens}) {
    std::string text;
    for (int i = 0; i < 12'000; ++i)
      text += fmt::format("G0 X{}.5 Y{}\n", i % 1000, i % 7);  // over one window
    const NcRun plain = run_text(text + "M30", dialect, three_axis_setup());
    ASSERT_EQ(plain.text(), "");
    for (const std::string end : {"\r\n", "\r"}) {
      std::string other = "\xEF\xBB\xBF";
      for (const char c : text) other += c == '\n' ? end : std::string(1, c);
      const NcRun run = run_text(other + "M30", dialect, three_axis_setup());
      ASSERT_EQ(run.text(), "");
      EXPECT_EQ(run.summary.lines, plain.summary.lines);
      ASSERT_EQ(run.moves().size(), plain.moves().size());
      for (size_t i = 0; i < plain.moves().size(); ++i) {
        ASSERT_EQ(run.moves()[i].line, plain.moves()[i].line);
        ASSERT_EQ(run.moves()[i].q_to, plain.moves()[i].q_to);
      }
    }
  }
}

// A subprogram at the very beginning, behind a byte order mark, is found from below.
TEST(NcStream, JumpsGoToPlacesFarFromTheWindow) {
  std::string filler;
  for (int i = 0; i < 20'000; ++i) filler += "(a comment that fills the file)\n";
  const std::string mark = "\xEF\xBB\xBF";
  const NcRun linux_run = run_text(
      mark + "o100 sub\nG91 G0 X1\no100 endsub\n" + filler + "o100 call\n" + filler + "o100 call\nM2\n",
      Dialect::kLinuxCnc, three_axis_setup());
  ASSERT_EQ(linux_run.text(), "");
  EXPECT_EQ(linux_run.moves().size(), 2u);
  std::replace(filler.begin(), filler.end(), '(', ';');
  const NcRun siemens_run =
      run_text(mark + "R1=0\nGOTOF LATER\nEARLY: G91 G0 X1\nR1=R1+1\nIF R1>1 GOTOF AWAY\n" + filler +
                   "LATER: GOTOB EARLY\n" + filler + "AWAY: G0 X5\nM30\n",
               Dialect::kSiemens, three_axis_setup());
  ASSERT_EQ(siemens_run.text(), "");
  ASSERT_EQ(siemens_run.moves().size(), 3u);
  EXPECT_EQ(siemens_run.moves()[2].line, 5 + 20'000 + 1 + 20'000 + 1);
}

}  // namespace
}  // namespace swarf::program::nc_stream_test

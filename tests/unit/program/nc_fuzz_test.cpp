// Mutated and truncated programs of LinuxCNC and Fanuc: a diagnostic with its place or a clean run, never a
// fault, never a position that is not a number. SWARF_FUZZ_ROUNDS and SWARF_FUZZ_SEED change how much and
// what.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "program/source_text.h"
#include "unit/program/mutate.h"
#include "unit/program/nc_support.h"

namespace swarf::program::nc_fuzz_test {
namespace {

namespace fs = std::filesystem;

/// Something of every kind of word, so that mutations come near all of them.
const char* const kLinuxCnc =
    "%\n(a program) ; of everything\nN10 G21 G17 G90 G91.1 G94 G40 G49 G80 G54 G64 P0.01 Q0.02\n"
    "#<_depth>=[-2.5*[1+3 MOD 2]] #<step>=0.5 #31=7 #32=[atan[1]/[-1]+sin[30]**2]\n"
    "o<hole> sub\n#5=[#1+#2]\nG0 X#1 Y#2\nG1 Z#<_depth> F[100+#31]\no<hole> return [#5]\no<hole> endsub\n"
    "T2 M6 G43 H2\nS1000 M3\nM8\nG0 X0 Y0 Z50 A0 C0\no<hole> call [10] [20]\no100 if [#<_value> GT 29]\nG0 "
    "Z50\n"
    "o100 elseif [EXISTS[#<step>]]\nG0 Z60\no100 else\nG0 Z70\no100 endif\no101 while [#31 GT "
    "4]\n#31=[#31-1]\n"
    "o102 if [#31 EQ 5]\no101 continue\no102 endif\nG1 X[#31*#<step>]\no101 endwhile\no103 repeat [2]\nG91 "
    "G1 X1\n"
    "G0 @5 ^30\n^60\nG91 ^10\nG90\n"
    "o103 endrepeat\nG90\no104 do\n#33=[exists[#<n>]+1]\no104 while [#33 LT 1]\nG0 X0 Y0 Z40\nG2 X10 Y10 I5 "
    "J5 F200\nG3 X0 "
    "Y0 R-9 Z40\n"
    "G18 G2 X5 Z45 I5 K0 P2\nG17\nT1 M6\nG41 D1 G1 X40 Y0\nX60\nY30\nG40 X80\nG10 L2 P2 X1 Y2 Z3 R10\nG55 G0 "
    "X0 Y0\n"
    "G10 L20 P3 X5\nG92 X3\nG92.2\nG92.3\nG92.1\nG52 X1\nG52 X0\nG28.1\nG28 Z60\nG54\nG99 G83 X1 Y1 Z-3 R2 "
    "Q1.5 F100\n"
    "X3 L2\nG98 G73 X5 Z-3 R2 Q1\nG82 X6 Z-1 R2 P.1\nG80\nG93 G1 X1 F10\nG95 M3 X2 F.1\nG94 F100\nG53 G0 "
    "Z5\nG49\nM428\n"
    "G1 X5 A10 C20 F500\nM430\nM429\nG4 P.5\nG20 X.1\nG21\nG61 X5\nM98 P7 L2\n/G0 X1\n(MSG, done)\n"
    "G0 X0 Y0\nG5 I0 J3 P0 Q-3 X1 Y1 F100\nP0 Q-3 X2 Y2\nG5.1 X3 I1 J1\nG5.2 P1 L3\nX1 Y2 P.5\nX3 Y1\nG5.3\n"
    "M70\nG20 G91 F3\nM72\nM71\nG10 L1 P2 Z50 R5\nG10 L10 P2 Z60\nG10 L11 P2 Z3\nM66 P0 L3 Q5\nM61 Q1\nS100 "
    "M3\n"
    "G87 X1 Y1 Z-9 R2 I1 J1 K-3\nG88 X2 Z-3 R2 P.1\nG84 X3 Z-3 R2\nG80 M68 E3 Q1\n(DEBUG, %.2f#31 of "
    "#<step>)\nM5 "
    "M9\nM2\no7\nG0 X1\nM99\n";

const char* const kFanuc =
    "%\nO1234 (EVERYTHING)\nG13.1 G15 G50.1 G22\nN10 G21 G17 G90 G94 G40 G49 G80 "
    "G54\n#100=2.5*[1+3]\n#101=SQRT[#100]+ATAN[1]/[1]\n"
    "IF [#1 EQ #0] THEN #102=3\nIF [#100 LT 5] GOTO 10\nWHILE [#102 GT 0] DO1\n#102=#102-1\nG01 X[#102*2] "
    "F200\nEND1\n"
    "T2 M06\nS1000 M03\nG05.1 Q1\nG43 H2 G00 X0 Y0 Z50\nG02 X10 Y10 I5 J5 F200\nG03 X0 Y0 R-9 Z40\nG18 G02 "
    "X5 Z45 I5 K0\n"
    "G17\nG01 X30. Z50. F200\nY20. ,R2.\nX0. ,C1.\nY0\n"
    "G41 D1 G01 X40 Y0 Z50\nX60\nY30\nG40 X80\nG10 L2 P2 X1 Y2 Z3\nG10 L20 P3 X5\nG54.1 P3 G00 X0 "
    "Y0\nG54\nG52 X1\n"
    "G52 X0\nG92 X3 Y0\nG91 G28 Z0\nG90 G30 P2 X5\nG53 G00 Z5\nG99 G83 X1 Y1 Z-3 R2 Q1.5 F100\nX3 K2\nG98 "
    "G73 X5 Z-3 R2 Q1\n"
    "G82 X6 Z-1 R2 P100\nG80\nG93 G01 X1 F10\nG94 F100\nG68 X0 Y0 R30\nG01 X5\nG69\nG68.2 X1 Y2 Z3 I10 J20 "
    "K30\nG53.1\n"
    "G00 X1 Y1 Z5\nG69\nG43.4 H2\nG01 X5 A10 C20 F500\nG49\nG43.5 H2\nG01 X6 I.1 J.2 K1 F500\nG49\nG01 X10 "
    "Y0 Z50\n"
    "G06.2 P3 K0 X10 Y0 Z50 R1\nK0 X10 Y10 R.707\nK0 X0 Y10 R1\nK1\nK1\nK1\nG04 P500\nG04 X.5\n"
    "G98 G76 X5 Z-3 R2 Q.2 P100 F50\nG80\nG87 X6 Z2 R-3 I.1 J.2\nG88 X7 Z-1 R2\nG80\nG66 P3\nG00 X5\nG67\n"
    "G51.1 X1\nG00 X2\nG50.1 X0\nG51 X0 Y0 Z0 P2.\nG02 X3 Y1 R9\nG50\nG16\nG00 X5 Y30\nG15\nG10 L10 P9 "
    "R40\nG10 L13 P9 R2\n#104=#11009+#4001\n#105=#0\nG68.2 P1 Q123 X1 Y2 Z3 I10 J20 K30\nG53.6 H2\nG68.4 X1 "
    "I5\nG69\nG68.3 X0 Y0 Z0 R5\nG69\nG68.2 P2 Q0 R3\nG68.2 P2 Q1 X0 Y0 Z0\nG68.2 P2 Q2 X1 Y0 Z0\nG68.2 P2 "
    "Q3 X0 Y1 Z0\nG69\nG68.2 P3 Q1 X0 Y0 Z0 I1 J0 K0\nG68.2 P3 Q2 I0 J0 K1\nG69\nG28 X5\nG29 X6\nG65 P2000 "
    "A1 I1 J2 K3 I4 "
    "B2 X3 L2\n"
    "M98 P0020003\nN99 M98 P3\n/G00 X1\nM05 M09\nM30\nO2000\nG00 X[#1+#2] Y#24\nM99\nO0003\nG91 G00 X1\nG90 "
    "M99\n%\n";

struct Language {
  Dialect dialect;
  const char* program;
  const char* folder;
};
const Language kLanguages[] = {{Dialect::kLinuxCnc, kLinuxCnc, "linuxcnc"},
                               {Dialect::kFanuc, kFanuc, "fanuc"}};

ControlSetup fuzz_setup() {
  ControlSetup setup = five_axis_setup();
  setup.machine.tool_change = AxisValues::Zero();
  setup.kinematics_switch.m430 = Kinematics::kTcp;
  setup.moves_max = 2000;
  return setup;
}

void expect_sound(const std::string& text, const Language& language, const ControlSetup& setup) {
  const auto ready = [&] {
    return fmt::format("--- of the {} program\n{}", dialect_name(language.dialect), text);
  };
  NcRun run;
  ASSERT_NO_THROW(run = run_text(text, language.dialect, setup)) << ready();
  const long lines =
      std::count(text.begin(), text.end(), '\n') + std::count(text.begin(), text.end(), '\r') + 1;
  for (const Diagnostic& one : run.diagnostics.list()) {
    ASSERT_FALSE(one.code.empty() || one.text.empty()) << ready();
    ASSERT_TRUE(one.where.line >= 0 && one.where.line <= lines && one.where.column >= 0)
        << format(one) << ready();
  }
  for (const NcMove& move : run.moves()) {
    ASSERT_TRUE(move.q_to.allFinite() && move.to.tip_W.allFinite() && move.to.axis_W.allFinite() &&
                std::isfinite(move.duration_s) && move.duration_s >= 0.0)
        << "a move of line " << move.line << " is not finite\n"
        << ready();
  }
}

long from_environment(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atol(text);
}

TEST(NcFuzz, TheProgramsThemselvesRun) {
  for (const Language& language : kLanguages) {
    const NcRun run = run_text(language.program, language.dialect, fuzz_setup());
    EXPECT_EQ(run.first_error(), "") << run.text();
    EXPECT_GT(run.moves().size(), 50u);
  }
}

TEST(NcFuzz, TruncatedProgramsAreRefusedOrRun) {
  const ControlSetup setup = fuzz_setup();
  for (const Language& language : kLanguages) {
    const std::string text = language.program;
    for (size_t length = 1; length < text.size(); length += 3) {
      expect_sound(text.substr(0, length), language, setup);
      if (HasFatalFailure()) return;
    }
  }
}

std::vector<std::string> seeds_of(const Language& language) {
  const fs::path folder = fs::path(SWARF_SOURCE_DIR) / "tests/data/programs/nc" / language.folder / "bad";
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> seeds;
  for (const fs::path& file : files) {
    seeds.push_back(read_file(file.string()));
    seeds.emplace_back(language.program);  // as often as all the others together
  }
  return seeds;
}

const std::string kPool = "0123456789.-+#[]()<>=GMXYZABCIJKRFSTDHLPQON \n\r\t%;/*&owhileifcall_\x01\xC3\xA4$";

TEST(NcFuzz, MutatedProgramsAreRefusedOrRun) {
  const ControlSetup setup = fuzz_setup();
  const long rounds = from_environment("SWARF_FUZZ_ROUNDS", 1000);
  Rng rng(static_cast<uint64_t>(from_environment("SWARF_FUZZ_SEED", 20261121)));
  for (const Language& language : kLanguages) {
    const std::vector<std::string> seeds = seeds_of(language);
    for (long round = 0; round < rounds; ++round) {
      std::string text = seeds[rng.next() % seeds.size()];
      for (size_t n = 1 + rng.next() % 5; n > 0 && !text.empty(); --n) mutate(text, kPool, rng);
      expect_sound(text, language, setup);
      if (HasFatalFailure()) return;
    }
  }
}

}  // namespace
}  // namespace swarf::program::nc_fuzz_test

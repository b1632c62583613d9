// Speed of the NC interpreter: lines per second from the file to the sink, poses by forward kinematics
// included.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "machine/machine_scene.h"
#include "program/cl/program.h"
#include "program/nc_program.h"

namespace swarf::program {
namespace {

constexpr int kLines = 200'000;

/// Adds up what it gets, so that nothing can be left out.
class Counter final : public NcSink {
 public:
  bool move(const NcMove& move) override {
    ++moves;
    way += (move.to.tip_W - move.from.tip_W).norm();
    return true;
  }
  long moves = 0;
  double way = 0.0;
};

std::string written(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / name;
  std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

/// A zigzag finishing program as CAM writes it: modal words, three decimals.
std::string three_axis_program(int lines) {
  std::string text = "G90 G94\nG0 X0 Y0 Z20\nG1 Z0 F2000\n";
  for (int i = 0; i < lines - 4; ++i) {
    const double x = 0.25 * (i % 400), y = 0.3 * (i / 400);
    text += fmt::format("X{:.3f} Y{:.3f} Z{:.3f}\n", (i / 400) % 2 == 0 ? x : 100.0 - x, y,
                        5.0 * std::sin(0.07 * x) * std::cos(0.05 * y));
  }
  return text + "M2\n";
}

/// TCP blocks whose words are formulas of parameters.
std::string five_axis_program(int lines) {
  std::string text = "G21 G90 G94\n#<r>=40 #<lead>=5 #1=12.5\nG0 X0 Y0 Z20 A0 B0\nM428\nG1 F2000\n";
  for (int i = 0; i < lines - 6; ++i) {
    const double angle = 0.05 * i;
    text += fmt::format("X[#<r>*cos[{:.3f}]] Y[#<r>*sin[{:.3f}]] Z[#1+{:.4f}] A[{:.4f}-#<lead>] B{:.4f}\n",
                        angle, angle, 5.0 * std::sin(0.01 * i), 20.0 + 10.0 * std::sin(0.003 * i),
                        30.0 * std::sin(0.002 * i));
  }
  return text + "M2\n";
}

/// Rows of a TCP finishing pass: X Y Z and both rotary words, modal feed.
std::string rotary_rows(int rows) {
  std::string text;
  for (int i = 0; i < rows; ++i) {
    text += fmt::format("X{:.4f} Y{:.4f} Z{:.4f} A{:.4f} B{:.4f}\n", 40.0 * std::cos(0.01 * i),
                        40.0 * std::sin(0.01 * i), 5.0 * std::sin(0.003 * i),
                        20.0 + 10.0 * std::sin(0.003 * i), 30.0 * std::sin(0.002 * i));
  }
  return text;
}

std::string fanuc_program(int lines) {
  return "O1000\nG21 G90 G94\nG00 X0 Y0 Z20 A0 B0\nG43.4 H1\nG01 F2000\n" + rotary_rows(lines - 7) +
         "G49\nM30\n";
}

std::string siemens_program(int lines) {
  return "G17 G710 G90 G94\nG0 X0 Y0 Z20 A0 B0\nTRAORI\nORIAXES\nG1 F2000\n" + rotary_rows(lines - 7) +
         "TRAFOOF\nM30\n";
}

/// Tool vectors, as CAM posts them for 840D.
std::string siemens_vector_program(int lines) {
  std::string text = "G17 G710 G90 G94\nG0 X0 Y0 Z20 A0 B0\nTRAORI\nORIWKS\nG1 F2000\n";
  for (int i = 0; i < lines - 7; ++i) {
    text += fmt::format("N{} X{:.4f} Y{:.4f} Z{:.4f} A3={:.6f} B3={:.6f} C3={:.6f}\n", 10 * i,
                        40.0 * std::cos(0.01 * i), 40.0 * std::sin(0.01 * i), 5.0 * std::sin(0.003 * i),
                        0.3 * std::sin(0.003 * i), 0.3 * std::cos(0.002 * i), 0.9);
  }
  return text + "TRAFOOF\nM30\n";
}

std::string klartext_header() {
  return "0 BEGIN PGM BENCH MM\n1 TOOL CALL 1 Z S12000 F2000\n2 L X+0 Y+0 Z+20 A+0 B+0 R0 FMAX M3\n";
}

/// The zigzag as a post-processor writes it in conversational: numbered blocks, signed words.
std::string klartext_program(int lines) {
  std::string text = klartext_header() + "3 L Z+0 F2000\n";
  for (int i = 0; i < lines - 6; ++i) {
    const double x = 0.25 * (i % 400), y = 0.3 * (i / 400);
    text += fmt::format("{} L X{:+.3f} Y{:+.3f} Z{:+.3f}\n", i + 4, (i / 400) % 2 == 0 ? x : 100.0 - x, y,
                        5.0 * std::sin(0.07 * x) * std::cos(0.05 * y));
  }
  return text + "L M30\nEND PGM BENCH MM\n";
}

/// M128 with rotary words.
std::string klartext_tcpm_program(int lines) {
  std::string text = klartext_header() + "3 L Z+10 F2000 M128\n";
  for (int i = 0; i < lines - 6; ++i) {
    text += fmt::format("{} L X{:+.4f} Y{:+.4f} Z{:+.4f} A{:+.4f} B{:+.4f}\n", i + 4,
                        40.0 * std::cos(0.01 * i), 40.0 * std::sin(0.01 * i), 5.0 * std::sin(0.003 * i),
                        20.0 + 10.0 * std::sin(0.003 * i), 30.0 * std::sin(0.002 * i));
  }
  return text + "M129\nEND PGM BENCH MM\n";
}

/// Formulas of Q parameters, each in a block of its own before the move that uses it.
std::string klartext_formula_program(int lines) {
  std::string text = klartext_header() + "Q1 = +40\nL Z+10 F2000\n";
  for (int i = 0; i < lines - 6; i += 3) {
    text += fmt::format("Q2 = Q1 * COS {:.3f}\nFN 1: Q3 = +Q1 + {:+.3f}\nL X+Q2 Y+Q3\n", 0.05 * i,
                        0.01 * (i % 99));
  }
  return text + "END PGM BENCH MM\n";
}

ControlSetup setup(const std::string& machine) {
  ControlSetup one;
  one.machine =
      machine::load_machine(std::string(SWARF_SOURCE_DIR) + "/assets/machines/" + machine + "/machine.toml")
          .model;
  one.start = kinematics::AxisValues::Zero();
  one.tools = {{1, "MILL10", 0.0, 10.0, 0.0}};
  return one;
}

/// One program through the interpreter: lines per second, file to sink.
void run(benchmark::State& state, Dialect dialect, const std::string& name, const std::string& text,
         int moves = kLines - 10) {
  const std::string path = written(name, text);
  const ControlSetup control = setup("lin_koren_xyzab");
  for (auto step : state) {
    Counter counter;
    Diagnostics diagnostics;
    run_nc(path, dialect, control, counter, diagnostics);
    diagnostics.throw_if_errors();
    if (counter.moves < moves) state.SkipWithError("moves are missing");
    benchmark::DoNotOptimize(counter.way);
  }
  state.SetItemsProcessed(state.iterations() * kLines);
  std::filesystem::remove(path);
}

void linuxcnc_three_axes(benchmark::State& state) {
  run(state, Dialect::kLinuxCnc, "swarf_bench_3.ngc", three_axis_program(kLines));
}
BENCHMARK(linuxcnc_three_axes)->Unit(benchmark::kMillisecond);

void linuxcnc_five_axes_formulas(benchmark::State& state) {
  run(state, Dialect::kLinuxCnc, "swarf_bench_5.ngc", five_axis_program(kLines));
}
BENCHMARK(linuxcnc_five_axes_formulas)->Unit(benchmark::kMillisecond);

void fanuc_three_axes(benchmark::State& state) {
  run(state, Dialect::kFanuc, "swarf_bench_3.nc", three_axis_program(kLines));
}
BENCHMARK(fanuc_three_axes)->Unit(benchmark::kMillisecond);

void fanuc_tcp_rotaries(benchmark::State& state) {
  run(state, Dialect::kFanuc, "swarf_bench_5.nc", fanuc_program(kLines));
}
BENCHMARK(fanuc_tcp_rotaries)->Unit(benchmark::kMillisecond);

void siemens_three_axes(benchmark::State& state) {
  run(state, Dialect::kSiemens, "swarf_bench_3.mpf", three_axis_program(kLines));
}
BENCHMARK(siemens_three_axes)->Unit(benchmark::kMillisecond);

void siemens_tcp_rotaries(benchmark::State& state) {
  run(state, Dialect::kSiemens, "swarf_bench_5.mpf", siemens_program(kLines));
}
BENCHMARK(siemens_tcp_rotaries)->Unit(benchmark::kMillisecond);

void siemens_tcp_vectors(benchmark::State& state) {
  run(state, Dialect::kSiemens, "swarf_bench_v.mpf", siemens_vector_program(kLines));
}
BENCHMARK(siemens_tcp_vectors)->Unit(benchmark::kMillisecond);

void heidenhain_three_axes(benchmark::State& state) {
  run(state, Dialect::kHeidenhain, "swarf_bench_3.h", klartext_program(kLines));
}
BENCHMARK(heidenhain_three_axes)->Unit(benchmark::kMillisecond);

void heidenhain_tcp_rotaries(benchmark::State& state) {
  run(state, Dialect::kHeidenhain, "swarf_bench_5.h", klartext_tcpm_program(kLines));
}
BENCHMARK(heidenhain_tcp_rotaries)->Unit(benchmark::kMillisecond);

/// A third of the lines move.
void heidenhain_formulas(benchmark::State& state) {
  run(state, Dialect::kHeidenhain, "swarf_bench_q.h", klartext_formula_program(kLines), kLines / 3 - 10);
}
BENCHMARK(heidenhain_formulas)->Unit(benchmark::kMillisecond);

/// Adds up what it gets, so that nothing can be left out.
class ClCounter final : public ClSink {
 public:
  void move(const Move& move) override { way += (move.to.tip_W - move.from.tip_W).norm(); }
  void note(ClNote /*note*/) override {}
  double way = 0.0;
};

/// Positions as CAM systems write them; `axes`: with tool axes, under MULTAX.
void read_cl(benchmark::State& state, bool axes) {
  std::string text = "TOOL PATH/FINISH,TOOL,BALL\nFEDRAT/MMPM,2000\n";
  text += axes ? "MULTAX/ON\nGOTO/0,0,20,0,0,1\n" : "GOTO/0,0,20\n";
  for (int i = 0; i < kLines; ++i) {
    const double lean = 0.2 + 0.1 * std::sin(0.003 * i);
    text += fmt::format("GOTO/{:.4f},{:.4f},{:.4f}", 40.0 * std::cos(0.01 * i), 40.0 * std::sin(0.01 * i),
                        5.0 * std::sin(0.003 * i));
    text += axes ? fmt::format(",{:.7f},0.0000000,{:.7f}\n", std::sin(lean), std::cos(lean)) : "\n";
  }
  const std::string path = written("swarf_bench.cls", text);
  for (auto step : state) {
    ClCounter counter;
    Diagnostics diagnostics;
    const ClProgram program = stream_cl(path, counter, diagnostics);
    diagnostics.throw_if_errors();
    if (program.motions != kLines) state.SkipWithError("moves are missing");
    benchmark::DoNotOptimize(counter.way);
  }
  state.SetItemsProcessed(state.iterations() * kLines);
  std::filesystem::remove(path);
}

void cl_positions(benchmark::State& state) {
  read_cl(state, false);
}
BENCHMARK(cl_positions)->Unit(benchmark::kMillisecond);

void cl_positions_and_axes(benchmark::State& state) {
  read_cl(state, true);
}
BENCHMARK(cl_positions_and_axes)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swarf::program

BENCHMARK_MAIN();

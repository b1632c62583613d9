// Speed of the NC interpreter: lines per second from the file to the sink, poses by forward kinematics
// included.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "machine/machine_scene.h"
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
  std::string text = "G21 G90 G94\nG0 X0 Y0 Z20\nG1 Z0 F2000\n";
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

ControlSetup setup(const std::string& machine) {
  ControlSetup one;
  one.machine =
      machine::load_machine(std::string(SWARF_SOURCE_DIR) + "/assets/machines/" + machine + "/machine.toml")
          .model;
  one.start = kinematics::AxisValues::Zero();
  return one;
}

void run(benchmark::State& state, const std::string& path, const ControlSetup& control, int lines) {
  for (auto step : state) {
    Counter counter;
    Diagnostics diagnostics;
    run_nc(path, Dialect::kLinuxCnc, control, counter, diagnostics);
    diagnostics.throw_if_errors();
    if (counter.moves < lines - 10) state.SkipWithError("moves are missing");
    benchmark::DoNotOptimize(counter.way);
  }
  state.SetItemsProcessed(state.iterations() * lines);
}

void three_axes(benchmark::State& state) {
  run(state, written("swarf_bench_3.ngc", three_axis_program(kLines)), setup("lin_koren_xyzab"), kLines);
}
BENCHMARK(three_axes)->Unit(benchmark::kMillisecond);

void five_axes_formulas(benchmark::State& state) {
  run(state, written("swarf_bench_5.ngc", five_axis_program(kLines)), setup("lin_koren_xyzab"), kLines);
}
BENCHMARK(five_axes_formulas)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swarf::program

BENCHMARK_MAIN();

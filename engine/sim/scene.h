// The scene: one job as the user describes it in scene.toml, checked and with every default filled in.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/frames.h"
#include "cutter/cutter.h"
#include "machine/machine_scene.h"
#include "motion/interpolator.h"
#include "program/program.h"
#include "toolpath/tool_path.h"

namespace swarf::sim {

struct StockSettings {
  Box box_W;                         ///< mm
  double voxel_mm = 0.2;             ///< smaller: finer solid, memory grows with the square
  double sweep_tolerance_mm = 1e-3;  ///< ticks are merged into sweeps that stay this close to them
  double max_memory_mb = 0.0;        ///< 0: 80 % of the memory that is free when the run starts
};

struct AcceptLimits {
  double scallop_max_um = 10.5;
  double gouge_max_um = 1.0;
  int collisions = 0;  ///< of shank and holder with the stock
};

struct MovieSettings {
  double seconds = 10.0;
  std::array<int, 2> size{1280, 720};
  int fps = 30;
  int samples = 1;        ///< per pixel, 1 or 4: 4 smooths edges and takes twice as long
  double voxel_mm = 0.8;  ///< of the stock that the movie shows; it is not measured
};

struct StillSettings {
  std::array<int, 2> size{1280, 720};
  int samples = 16;  ///< rays per pixel: more is smoother and slower
};

struct Scene {
  std::string file;  ///< scene.toml
  std::string name;  ///< of its folder
  std::string title;
  std::string machine_file, program_file;
  cutter::Cutter cutter;
  StockSettings stock;
  double dexel_pitch_mm = 0.2;  ///< grid of measuring rays on the design; cusps are refined between them
  toolpath::PlanOptions toolpath;
  bool compare_planners = true;              ///< plan, interpolate and measure the other planners too
  std::optional<double> chord_tolerance_mm;  ///< replaces the program's K
  motion::MotionOptions motion;
  AcceptLimits accept;
  MovieSettings movie;
  StillSettings stills;
};

/// Everything that a run needs, loaded and checked; nothing has been written yet.
struct Job {
  Scene scene;
  machine::MachineScene machine;
  program::Program program;
  std::vector<Diagnostic> warnings;
};

/// Reads scene.toml; `overrides` are "key=value" in TOML. Paths in it are relative to its folder.
/// Problems go to `diagnostics`.
Scene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                 Diagnostics& diagnostics);

/// Loads scene, machine and program and checks them against each other (tool numbers, memory, chord
/// tolerance). Throws InputError with everything that is wrong.
Job load_job(const std::string& path, const std::vector<std::string>& overrides);

}  // namespace swarf::sim

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "sim/scene.h"
#include "stock/stock.h"

namespace swarf::sim {
namespace {

constexpr double kMegabyte = 1024.0 * 1024.0;
constexpr double kShareOfFreeMemory = 0.8;

/// Free memory of the machine in MB, as the kernel estimates it; infinity where it does not say.
double available_memory_mb() {
  std::ifstream meminfo("/proc/meminfo");
  std::string name, unit;
  double kilobytes = 0.0;
  while (meminfo >> name >> kilobytes) {
    std::getline(meminfo, unit);
    if (name == "MemAvailable:") return kilobytes / 1024.0;
  }
  return std::numeric_limits<double>::infinity();
}

/// The smallest voxel, to two digits, whose estimate fits.
double voxel_that_fits(const Box& box, double voxel, double limit_mb) {
  double fitting = voxel;
  while (static_cast<double>(stock::Stock::memory_estimate(box, fitting)) / kMegabyte > limit_mb)
    fitting *= 1.05;
  const double digit = std::pow(10.0, std::floor(std::log10(fitting)) - 1.0);
  return std::ceil(fitting / digit) * digit;
}

void check_memory(const Scene& scene, Diagnostics& diagnostics) {
  const double limit = scene.stock.max_memory_mb > 0.0 ? scene.stock.max_memory_mb
                                                       : kShareOfFreeMemory * available_memory_mb();
  const double need =
      static_cast<double>(stock::Stock::memory_estimate(scene.stock.box_W, scene.stock.voxel_mm)) / kMegabyte;
  if (need <= limit) return;
  diagnostics.error("out-of-memory", {scene.file},
                    fmt::format("stock.voxel_mm = {:g} needs about {:.0f} MB, {:.0f} MB may be used",
                                scene.stock.voxel_mm, need, limit),
                    fmt::format("voxel_mm = {:g} fits; or raise stock.max_memory_mb",
                                voxel_that_fits(scene.stock.box_W, scene.stock.voxel_mm, limit)));
}

void check_tools(const Job& job, Diagnostics& diagnostics) {
  for (const program::Operation& operation : job.program.operations) {
    if (operation.tool == job.scene.cutter.number) continue;
    diagnostics.error(
        "unknown-tool", operation.where,
        fmt::format("the block uses T{}, the scene describes T{} only", operation.tool,
                    job.scene.cutter.number),
        fmt::format("call T{} or set cutter.number = {}", job.scene.cutter.number, operation.tool));
    return;
  }
}

template <typename Load>
void collect(Diagnostics& diagnostics, Load load) {
  try {
    load();
  } catch (const InputError& error) {
    diagnostics.append(error.diagnostics);
  }
}

}  // namespace

Job load_job(const std::string& path, const std::vector<std::string>& overrides) {
  Diagnostics diagnostics;
  Job job;
  job.scene = load_scene(path, overrides, diagnostics);
  diagnostics.throw_if_errors();
  // A user mends all files at once: what is wrong with one does not hide what is wrong with the other.
  collect(diagnostics, [&] { job.machine = machine::load_machine(job.scene.machine_file); });
  Diagnostics warnings;
  collect(diagnostics, [&] { job.program = program::load_program(job.scene.program_file, &warnings); });
  diagnostics.throw_if_errors();
  diagnostics.append(warnings);
  check_tools(job, diagnostics);
  check_memory(job.scene, diagnostics);
  diagnostics.throw_if_errors();
  job.warnings = diagnostics.list();
  return job;
}

}  // namespace swarf::sim

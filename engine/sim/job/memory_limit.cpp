#include "sim/job/memory_limit.h"

#include <fstream>
#include <limits>
#include <string>

namespace swarf::sim {
namespace {

constexpr double kShareOfFreeMemory = 0.8;

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

}  // namespace

double memory_limit_mb(const Scene& scene) {
  return scene.stock.max_memory_mb > 0.0 ? scene.stock.max_memory_mb
                                         : kShareOfFreeMemory * available_memory_mb();
}

}  // namespace swarf::sim

// Simulates a scene and prints what its checks say: example SCENE.toml
#include <cstdio>
#include <exception>

#include "sim/simulation.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::puts("example SCENE.toml"), 2;
  try {
    const swarf::sim::Job job = swarf::sim::load_job(argv[1], {});
    swarf::Progress silent;
    const swarf::sim::Result result = swarf::sim::simulate(job, {}, silent);
    for (const swarf::sim::Check& check : result.checks)
      std::printf("%s: %s\n", check.name.c_str(), swarf::sim::outcome_name(check.outcome));
    std::printf("removed %.1f mm3\n", result.volume_removed_mm3);
    return swarf::sim::passes(result) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

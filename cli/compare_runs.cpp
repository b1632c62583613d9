#include "cli/compare_runs.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "reports/run_output.h"

namespace swarf::cli {
namespace {

/// Rays of one design that was written and read again stand on the same points, mm.
constexpr double kSameRay = 1e-9;

struct Difference {
  size_t rays = 0, beyond = 0;  ///< all; those beyond the limit
  double worst_um = 0.0;
  Vec3 place = Vec3::Zero();  ///< of the worst
};

bool same_rays(const stock::RayField& a, const stock::RayField& b) {
  if (a.points.size() != b.points.size()) return false;
  for (size_t i = 0; i < a.points.size(); ++i) {
    if ((a.points[i] - b.points[i]).norm() > kSameRay || (a.normals[i] - b.normals[i]).norm() > kSameRay)
      return false;
  }
  return true;
}

void compare_surface(const stock::SurfaceDexels& a, const stock::SurfaceDexels& b, double limit_um,
                     Difference& difference) {
  for (size_t i = 0; i < a.points().size(); ++i) {
    const double apart_um = um_from_mm(std::abs(a.heights_mm()[i] - b.heights_mm()[i]));
    ++difference.rays;
    if (apart_um > limit_um) ++difference.beyond;
    if (apart_um <= difference.worst_um) continue;
    difference.worst_um = apart_um;
    difference.place = a.points()[i];
  }
}

Difference compare_rays(const reports::StoredRun& a, const reports::StoredRun& b, double limit_um) {
  if (a.dexels.empty() || b.dexels.empty()) {
    throw InputError("no-rays", {(a.dexels.empty() ? a : b).job.scene.file},
                     "this run has no measuring rays: its scene has no design, or it was stopped",
                     "give both scenes the same [design] and run them to their end");
  }
  Difference difference;
  bool same = a.dexels.size() == b.dexels.size();
  for (size_t i = 0; same && i < a.dexels.size(); ++i) {
    same = same_rays(a.dexels[i].field(), b.dexels[i].field());
    if (same) compare_surface(a.dexels[i], b.dexels[i], limit_um, difference);
  }
  if (!same) {
    throw InputError("other-rays", {b.job.scene.file}, "the two runs were measured on different rays",
                     "give both scenes the same [design] with the same pitch_mm");
  }
  return difference;
}

}  // namespace

int compare_runs(const std::string& a, const std::string& b, double limit_um, bool json) {
  for (const std::string& folder : {a, b}) print_diagnostics(reports::remarks_on_run(folder));
  const reports::StoredRun run_a = reports::read_run(a), run_b = reports::read_run(b);
  const Difference difference = compare_rays(run_a, run_b, limit_um);
  const bool holds = difference.beyond == 0;
  if (json) {
    const Vec3& p = difference.place;
    fmt::print("{}\n", nlohmann::ordered_json{{"schema", 1},
                                              {"verdict", holds ? "pass" : "findings"},
                                              {"rays",
                                               {{"compared", difference.rays},
                                                {"difference_max_um", difference.worst_um},
                                                {"place_mm", {p.x(), p.y(), p.z()}},
                                                {"limit_um", limit_um},
                                                {"beyond_limit", difference.beyond}}}}
                           .dump(2));
    return holds ? kPass : kFindings;
  }
  const auto machine = [](const reports::StoredRun& run) { return run.job.machine.model.name; };
  fmt::print("{} ({}) against {} ({})\n", a, machine(run_a), b, machine(run_b));
  print_table(
      {{"rays", fmt::format("{} compared", difference.rays)},
       {"difference", fmt::format("{:.4f} um at most, at ({:.3f}, {:.3f}, {:.3f}) mm", difference.worst_um,
                                  difference.place.x(), difference.place.y(), difference.place.z())},
       {"limit", fmt::format("{} rays differ by more than {:g} um", difference.beyond, limit_um)}});
  fmt::print("  {}\n", holds ? "PASS" : "FINDINGS");
  return holds ? kPass : kFindings;
}

}  // namespace swarf::cli

#include "sim/run/design_rays.h"

#include "stock/rays/free_ranges.h"

namespace swarf::sim {

stock::RayFieldPtr mesh_rays(const Job& job) {
  if (!job.design_mesh) return nullptr;
  return stock::rays_on_mesh(*job.design_mesh, job.scene.design.pitch_mm, stock::kCrease, job.design_under);
}

std::vector<stock::RayFieldPtr> design_rays(const Job& job, const stock::RayFieldPtr& made) {
  const double pitch = job.scene.design.pitch_mm;
  std::vector<stock::RayFieldPtr> fields;
  for (const surface::SurfacePtr& surface : job.design)
    fields.push_back(stock::rays_on_surface(surface, pitch));
  if (job.design_mesh) fields.push_back(made ? made : mesh_rays(job));
  return fields;
}

std::vector<stock::SurfaceDexels> design_dexels(const Job& job,
                                                const std::vector<stock::RayFieldPtr>& fields) {
  std::vector<stock::SurfaceDexels> dexels;
  for (size_t i = 0; i < fields.size(); ++i) {
    dexels.emplace_back(fields[i], job.scene.stock.body_W(), stock::free_ranges(fields, i));
  }
  return dexels;
}

}  // namespace swarf::sim

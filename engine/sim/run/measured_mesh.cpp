#include "sim/run/measured_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/design_projection.h"
#include "measure/seen_surface.h"
#include "sim/run/ray_cutters.h"

namespace swarf::sim {
namespace {

/// Vertices of the level set's mesh lie within half a voxel of the true surface, cusps included.
constexpr double kReachVoxels = 0.6;
/// A facet that the bottom of a flat end has left turns no farther from the design.
constexpr double kFaceCosine = 0.8;

Vec3 as_vec3(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

/// The tool's axis in each cycle of planned passes. Blocks are sweeps, not cycles, and mostly cut with the
/// flank.
std::vector<Vec3> axes_of(const MeasuredPart& part) {
  std::vector<Vec3> axes;
  if (!part.set_normals || !normals_need_cycles(part.job)) return axes;
  axes.reserve(part.cycles.size());
  motion::CycleReader reader(part.cycles);
  for (size_t k = 0; k < part.cycles.size(); ++k) axes.push_back(reader.at(k).sample.pose.axis_W);
  return axes;
}

/// Some ray's material ends farther from the design than a vertex may be off, or hangs above a gap.
bool has_walls(const stock::SurfaceDexels& dexels, double slack_mm) {
  const auto& heights = dexels.heights_mm();
  bool found =
      std::any_of(heights.begin(), heights.end(), [&](double height) { return std::abs(height) > slack_mm; });
  dexels.each_above([&](uint32_t, const stock::MaterialAbove&) { found = true; });
  return found;
}

}  // namespace

bool colours_need_sweeps(const Job& job, const std::vector<stock::SurfaceDexels>& dexels, double voxel_mm) {
  return job.design_mesh != nullptr || std::any_of(dexels.begin(), dexels.end(), [&](const auto& one) {
           return has_walls(one, kReachVoxels * voxel_mm);
         });
}

bool normals_need_cycles(const Job& job) {
  // Sweeps of driven passes are pieces of cycles: what they leave keeps the mesh's own normals.
  return job.scene.stock.cut_by == CutBy::kPasses && job.driven == nullptr;
}

struct MeshMeasure::Tools {
  explicit Tools(const MeasuredPart& of) : part(of), axes(axes_of(of)) {
    if (part.rays != nullptr) cutters = ray_cutters(part.job, *part.rays, part.carried);
    for (const stock::SurfaceDexels& dexels : part.dexels)
      if (dexels.field().surface != nullptr)
        seen.push_back(std::make_unique<measure::SeenSurface>(dexels, kReachVoxels * part.voxel_mm));
      else
        seen.push_back(nullptr);
  }

  void by_rays(size_t n, TriMesh& mesh) const;
  /// Calls visit(input) with what vertices near these rays are measured with, unless there is nothing to cut
  /// by.
  template <typename Visit>
  void with_own_rays(const stock::SurfaceDexels& dexels, const Visit& visit) const {
    if (!cutters) return;
    const auto cut = [&](stock::SurfaceDexels& own) {
      for_each_tool(
          part.rays->sweeps, [&](uint32_t block) { return cutters->solid_of[block]; },
          [&](size_t solid, std::span<const stock::Sweep> sweeps) {
            own.cut(sweeps, cutters->solids[solid]);
          });
    };
    visit(measure::VertexRayInput{dexels.field(), part.job.scene.stock.body_W(), kReachVoxels * part.voxel_mm,
                                  cut});
  }

  const MeasuredPart part;
  const std::vector<Vec3> axes;
  std::optional<RayCutters> cutters;
  std::vector<std::unique_ptr<measure::SeenSurface>> seen;  ///< by design surface; null: a mesh
};

void MeshMeasure::Tools::by_rays(size_t n, TriMesh& mesh) const {
  const stock::SurfaceDexels& dexels = part.dexels[n];
  const measure::SeenSurface& surface = *seen[n];
  std::vector<uint8_t> off_face(mesh.positions.size(), 0);
  parallel_chunks(mesh.positions.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto here = surface.at(as_vec3(mesh.positions[i]), as_vec3(mesh.normals[i]));
      if (!here) continue;
      const auto deviation = static_cast<float>(um_from_mm(here->deviation_mm));
      // Where two surfaces of the design see one point, the worse of both.
      if (!(std::abs(deviation) < std::abs(mesh.deviation_um[i]))) {
        mesh.deviation_um[i] = deviation;
        off_face[i] = here->on_face ? 0 : 1;
      }
      const measure::Foot& foot = here->foot;
      const uint32_t block = measure::block_at(dexels, foot.u, foot.v);
      // Sweeps of the job come first and are its cycles; those behind them are of earlier set-ups.
      if (!here->on_face || block >= axes.size()) continue;
      // The bottom of a flat end left this facet, so the tool's axis is its exact normal.
      const Vec3& axis = axes[block];
      if (axis.dot(foot.normal) < kFaceCosine) continue;
      mesh.normals[i] = {static_cast<float>(axis.x()), static_cast<float>(axis.y()),
                         static_cast<float>(axis.z())};
    }
  });
  std::vector<uint32_t> vertices;
  for (uint32_t i = 0; i < off_face.size(); ++i)
    if (off_face[i] != 0) vertices.push_back(i);
  if (vertices.empty()) return;
  with_own_rays(dexels, [&](const measure::VertexRayInput& input) {
    measure::deviation_by_vertex_rays(input, surface, vertices, mesh);
  });
}

MeshMeasure::MeshMeasure(const MeasuredPart& part) : tools_(std::make_unique<Tools>(part)) {}

MeshMeasure::~MeshMeasure() = default;

void MeshMeasure::measure(TriMesh& mesh) const {
  mesh.deviation_um.assign(mesh.positions.size(), std::numeric_limits<float>::quiet_NaN());
  for (size_t n = 0; n < tools_->seen.size(); ++n) {
    if (tools_->seen[n] != nullptr)
      tools_->by_rays(n, mesh);
    else
      tools_->with_own_rays(tools_->part.dexels[n], [&](const measure::VertexRayInput& input) {
        measure::deviation_by_vertex_rays(input, mesh);
      });
  }
}

void measure_mesh(const MeasuredPart& part, TriMesh& mesh) {
  MeshMeasure(part).measure(mesh);
}

}  // namespace swarf::sim

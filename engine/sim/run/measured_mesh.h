// The finished part's mesh with what measuring rays say of each vertex.
#pragma once

#include <memory>
#include <vector>

#include "measure/vertex_rays.h"
#include "mesh/tri_mesh.h"
#include "motion/cycles/cycles.h"
#include "sim/job/scene.h"
#include "sim/run/carried_cuts.h"
#include "sim/run/job_sweeps.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::sim {

/// What a mesh is measured with. Borrowed.
struct MeasuredPart {
  const Job& job;
  const motion::Cycles& cycles;  ///< may be empty unless normals_need_cycles(job) and set_normals
  const std::vector<stock::SurfaceDexels>& dexels;
  const CarriedCuts& carried;
  const JobSweeps* rays = nullptr;  ///< all_ray_sweeps(); may be null unless colours_need_sweeps()
  double voxel_mm = 0.0;            ///< of the stock that the mesh comes from
  bool set_normals = true;
};

/// Vertices over a design of facets or CAD faces get rays of their own, which the sweeps cut: without sweeps
/// none is measured. Over a parametric design those on walls and above gaps do, which then have the mesh's
/// error.
bool colours_need_sweeps(const Job& job, const std::vector<stock::SurfaceDexels>& dexels, double voxel_mm);

/// Cusps of planned passes get their normals from the tool axis of each cycle, where sweeps are cycles.
bool normals_need_cycles(const Job& job);

/// Measures meshes of one part; what that takes is made once.
class MeshMeasure {
 public:
  explicit MeshMeasure(const MeasuredPart& part);
  ~MeshMeasure();
  MeshMeasure(const MeshMeasure&) = delete;
  MeshMeasure& operator=(const MeshMeasure&) = delete;

  /// Sets TriMesh::deviation_um (um; NaN where no ray has seen the vertex), and the normals of facets that
  /// the bottom of a flat end left on planned passes to the tool's axis. The mesh has normals.
  void measure(TriMesh& mesh) const;

 private:
  struct Tools;
  std::unique_ptr<Tools> tools_;
};

/// The same of one mesh.
void measure_mesh(const MeasuredPart& part, TriMesh& mesh);

}  // namespace swarf::sim

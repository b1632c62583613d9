// A still that is cut open: its camera, and what is written on it.
#pragma once

#include <string>
#include <vector>

#include "mesh/tri_mesh.h"
#include "render/draw_list.h"
#include "render/lettering.h"
#include "reports/machine_view.h"
#include "sim/job/section_keys.h"

namespace swarf::reports {

/// The plane that is drawn where this one is asked for: moved by a twentieth of the voxel to the side that is
/// kept. A wall in the very plane is then either cut or taken away, all of it, whatever its vertices are
/// rounded by; so is one that stands proud in the middle of a block (CutAlong::kProudVoxels).
sim::SectionPlane off_walls(const sim::SectionPlane& plane, double voxel_mm);

/// How a part is cut open and looked at.
struct SectionView {
  sim::SectionPlane asked;  ///< its normal on the side of the eye: what stands there is taken away
  sim::SectionPlane plane;  ///< off_walls() of it
  render::Camera
      camera;  ///< of all that is kept; its target lies in the plane, so that scales are right there
};

/// `camera`: a name or a direction (camera_direction); "": straight on, from where the normal points to.
/// Throws InputError at `where`: "section-misses" for a plane that the part does not reach, "section-edge-on"
/// where the camera does not see the face of the cut.
SectionView section_view(const FinishedRun& run, const TriMesh& part, const sim::SectionPlane& plane,
                         const SourceLocation& where, const std::string& camera, double vertical_fov_rad,
                         double aspect);

/// Cuts open what the list of a machine says is sectioned, towards its camera, with the outline of the design
/// in the plane. X_MW: pose of the stock; `camera`: the name of the list's. What a legend
/// tells of the lines. Throws InputError at `where` as section_view().
std::vector<render::Strokes> open_machine(const FinishedRun& run, const Pose& X_MW,
                                          const sim::SectionPlane& section, const SourceLocation& where,
                                          const std::string& camera, render::DrawList& list);

/// What of the lines lies on the side that the section keeps.
std::vector<render::DrawLine> kept_lines(const std::vector<render::DrawLine>& lines,
                                         const sim::SectionPlane& plane);

/// The outlines of part and design in the plane, and with `labels` a legend, a scale bar, and of the
/// measuring rays beside the plane the lowest and the highest with their values, left of `right_px`; their
/// deviations stand on the design as lines, made longer by a factor that the legend names.
void draw_section(const FinishedRun& run, const TriMesh& part, const SectionView& view, bool labels,
                  double right_px, render::Image& image);

}  // namespace swarf::reports

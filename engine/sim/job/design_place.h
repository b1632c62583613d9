// Whether a design lies where the stock is. That a mesh lies in the box of the stock mesh/mesh_check.h says.
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// The place of a design that is farthest from the raw stock, of those that were looked at: the corners of 16
/// by 16 cells of each surface, the vertices of a mesh.
struct DesignBeyond {
  double mm = 0.0;  ///< 0: all of them lie in the stock
  Vec3 place = Vec3::Zero();
};
DesignBeyond design_beyond(const Job& job);

/// A place of the design outside the raw stock lacks material that no cut has taken. Error
/// "design-outside-stock": all of a parametric design lies there, proven by its bends, and nothing could be
/// measured. Warning "design-beyond-stock": some of it does (design_beyond). Both say in which units and by
/// which offset the two would meet.
void check_design_place(const Job& job, Diagnostics& diagnostics);

/// Warning "limit-below-facets": a limit that a right part may break against the facets of its curved faces,
/// with the place where they lie farthest off.
void check_facet_chord(const Job& job, const TriMesh& mesh, Diagnostics& diagnostics);

/// "X 0.000 to 40.000, Y .. mm".
std::string spoken_box(const Box& box);

}  // namespace swarf::sim

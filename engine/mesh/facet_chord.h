// How far curved faces lie from the facets that an STL file has for them, estimated from the facets.
#pragma once

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

struct FacetChord {
  double mm = 0.0;            ///< 0: no curved faces are recognised
  Vec3 place = Vec3::Zero();  ///< on the mesh, where it is largest
};

/// Facets in one plane are a strip. Strips whose planes meet at up to 30 degrees, two or more such edges to
/// each, eight or more strips together, are taken for a curved face. A circular arc through both edges of a
/// strip of width w that is turned by the angle a from the next strip stands off it by w / 2 tan(a / 4). An
/// estimate: a part may really have such flats.
FacetChord estimate_facet_chord(const TriMesh& mesh);

}  // namespace swarf::mesh

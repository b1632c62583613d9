// A cut through meshes as a drawing.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/tri_mesh.h"

namespace swarf::reports {

/// The lines in which the facets meet a plane.
std::vector<std::array<Vec3, 2>> section_pieces(const TriMesh& mesh, const Vec3& point, const Vec3& normal);

/// One of the meshes that a section goes through.
struct SectionMesh {
  const TriMesh* mesh = nullptr;
  const char* css_class = "series s0";
};

/// A plane and the window of it that is drawn: `right` and `up` are unit vectors in the plane.
struct SectionPlane {
  Vec3 centre = Vec3::Zero(), right = Vec3::UnitX(), up = Vec3::UnitZ();
  double half_width_mm = 1.0, half_height_mm = 1.0;
};

/// <svg> with the lines in which the meshes meet the plane, both axes of one scale, a ring about the centre
/// and a bar of a round length with its value.
std::string section_svg(const std::vector<SectionMesh>& meshes, const SectionPlane& plane);

}  // namespace swarf::reports

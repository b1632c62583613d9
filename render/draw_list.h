// What is to be drawn, without saying how: the plain border between the engine and the renderers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/frames.h"
#include "mesh/mesh_enclosed.h"
#include "mesh/tri_mesh.h"

namespace swarf::render {

using Rgb = std::array<float, 3>;  ///< linear, 0..1

struct Material {
  Rgb colour{0.7F, 0.7F, 0.7F};  ///< ignored where the mesh has vertex colours
  float metalness = 0.0F;
  float roughness = 0.6F;
};

/// A mesh at a pose; the mesh is borrowed and must outlive the list.
struct DrawItem {
  const TriMesh* mesh = nullptr;
  Pose X_world = Pose::Identity();  ///< from the mesh's frame to the drawing's frame
  Material material;
  bool dynamic =
      false;  ///< true: the mesh changes between frames; false: renderers may keep it by its address
  /// Not 0: no two meshes that are ever drawn have the same, so that renderers need not look for changes.
  uint64_t revision = 0;
  bool sectioned = false;  ///< cut open by DrawList::section; a closed body
  /// Of the mesh, borrowed like it; may be null. Renderers may leave out what it says cannot be seen.
  const mesh::Enclosed* enclosed = nullptr;
  bool outside_only = false;  ///< part of a closed surface: the backs of its triangles are never seen
};

struct DrawLine {
  std::vector<Vec3> points;  ///< polyline in the drawing's frame
  Rgb colour{1.0F, 0.2F, 0.1F};
  float width_px = 1.5F;
  std::string name = "lines";  ///< what it shows; lines of one name and colour are one object in files
};

/// Perspective camera; `up` need not be orthogonal to the view.
struct Camera {
  Vec3 eye{300, -300, 250};
  Vec3 target = Vec3::Zero();
  Vec3 up = Vec3::UnitZ();
  double vertical_fov_rad = 0.6;
};

/// What lies on the side that the normal points to is taken away.
struct SectionPlane {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< drawing's frame; unit
};

/// Of the material where a section goes through it.
inline constexpr Rgb kCutFace{0.62F, 0.24F, 0.10F};

struct DrawList {
  Camera camera;
  std::optional<SectionPlane> section;  ///< of the sectioned items
  std::vector<DrawItem> items;
  std::vector<DrawLine> lines;
};

/// 8-bit sRGB, rows from the top, 4 bytes a pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

}  // namespace swarf::render

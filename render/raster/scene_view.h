// Where the lights stand and how deep the scene is: everything a frame needs beside the items.
#pragma once

#include "render/draw_list.h"

namespace swarf::render {

struct SceneView {
  Eigen::Matrix4d clip_from_world;
  /// The key light's parallel projection of what lies between it and the places that the picture can show.
  Eigen::Matrix4d light_clip_from_world;
  int shadow_columns = 2, shadow_rows = 2;  ///< texels of its map, square ones
  double shadow_texel_mm = 1.0;
  Vec3 key, fill, rim;  ///< unit vectors towards the lights
  /// Of the picture: at distance 1 along `forward`, right and up reach its edges.
  Vec3 right, up, forward;
  double near = 1.0, far = 2.0;  ///< planes of clip_from_world, mm from the eye
  Vec3 ground_centre;
  double ground_radius = 1.0;
};

/// `bounds` holds every item of the scene in the drawing's frame.
SceneView scene_view(const Camera& camera, const Box& bounds, double aspect);

/// False only where nothing of a box at a pose lies within the sides of clip space: where all of its corners
/// are beyond one of them.
bool may_lie_within(const Eigen::Matrix4d& clip_from_world, const Box& box, const Pose& X_world);

/// Whether the eye, or a place of the picture's near plane, may lie in a body of the item that encloses
/// triangles: what is within shows then.
bool is_looked_into(const SceneView& view, const Vec3& eye, const DrawItem& item);

/// Of the horizontal plane at this height, 1 / distance along `forward`, 1/mm: x and y of the picture (-1..1)
/// times the first two plus the third. Not above 0 where the picture does not see the plane, everywhere where
/// it sees it edge on.
Vec3 nearness_of_level(const SceneView& view, const Vec3& eye, double height);

/// Grows `bounds` by a box at a pose.
void extend(Box& bounds, const Box& box, const Pose& X_world);

}  // namespace swarf::render

// Still pictures by ray tracing: a studio with a soft key light, strip lights and a floor that takes shadows.
#pragma once

#include <memory>

#include "base/frames.h"
#include "render/draw_list.h"

namespace swarf::render {

struct RayTree;

/// Directions are in the drawing's frame, Z up. Radiances are linear; a white diffuse surface that faces the
/// key light under the default sky comes out just below white.
struct StillOptions {
  int width = 1280, height = 720;
  int samples_per_pixel = 24;  ///< at most
  /// Each pixel takes as many samples as bring the standard error of its brightness below this, of 255, as if
  /// they were independent; how far they spread is estimated from the first ones of the pixel and of those
  /// around it. They are a lattice, so that the error is less in fact, except where an edge would take more
  /// than `samples_per_pixel`. 0: all samples everywhere.
  double noise = 0.0;
  bool transparent = false;  ///< nothing behind the drawing, no floor and no shadow on it
  uint32_t seed = 1;         ///< same seed, same picture, for any number of threads

  Vec3 key_light_direction{-0.45, -0.55,
                           0.70};      ///< from the subject to the light; low over a surface: raking light
  double key_light_radius_rad = 0.10;  ///< angular radius of the key light; larger: softer shadows
  double key_light_strength = 0.75;    ///< irradiance / pi on a surface that faces it
  double sky_strength = 0.40;          ///< radiance of the sky; its occlusion is the ambient occlusion

  /// A bank of strip lights overhead, seen in reflections. A scallop's ridge turns the reflection by twice
  /// the kink of the normal (a few degrees); strips of about that width along the passes make every ridge a
  /// stripe.
  Vec3 strip_direction{1, 0, 0};   ///< along the strips; choose the direction of the passes
  double strip_period_deg = 11.0;  ///< angle from strip to strip, seen from the subject
  double strip_strength = 1.2;     ///< radiance of a strip; 0: none

  bool floor = true;  ///< catch shadows on a plane through the lowest point of the drawing
  Rgb backdrop_top{0.30F, 0.32F, 0.35F};
  Rgb backdrop_bottom{0.72F, 0.73F, 0.74F};
  double exposure = 1.0;

  /// Of drawings that differ by light, camera, colours and lines only, all but the first take the tree of
  /// their triangles from here (RayScene). Null: each makes its own.
  std::shared_ptr<const RayTree>* kept_tree = nullptr;
};

/// Renders the list. Meshes without normals are shaded flat; lines become round tubes of their width in
/// pixels, lit a little and without shadows of their own. Linear values up to 0.6 keep their colour exactly,
/// brighter ones roll off. Deterministic; parallel over tiles.
Image render_still(const DrawList& list, const StillOptions& options = {});

}  // namespace swarf::render

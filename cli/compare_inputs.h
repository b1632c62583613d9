// What swarf compare compares: the stock and the design as meshes, checked, with what is known of their
// errors.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/signed_distance.h"
#include "sim/job/scene.h"
#include "stock/rays/ray_field.h"

namespace swarf::cli {

struct ComparedStock {
  std::shared_ptr<const mesh::SignedDistance> mesh;
  double voxel_mm = 0.0;      ///< 0: a mesh file
  std::vector<double> error;  ///< per vertex of the mesh, mm; empty for mesh files
  std::vector<uint8_t> edge;  ///< per vertex: rounded by the grid; empty for mesh files

  double greatest_error_mm() const {
    return error.empty() ? 0.0 : *std::max_element(error.begin(), error.end());
  }
};

struct ComparedDesign {
  std::shared_ptr<const mesh::SignedDistance> mesh;
  bool open = false;                               ///< patches of parametric surfaces
  double error_mm = 0.0;                           ///< by which the facets stray from the surfaces
  std::vector<double> errors;                      ///< the same per facet of the mesh; empty: it for all
  std::optional<sim::AcceptLimits> accept;         ///< of a scene
  bool grid = false;                               ///< an earlier stock, as its grid shows it
  double voxel_mm = 0.0, grid_error_mm = 0.0;      ///< of that grid; the error away from sharp edges
  std::shared_ptr<const stock::DesignMesh> faces;  ///< of a CAD file: the surfaces over coarse facets
};

/// A stock of a run (.vdb), or a closed mesh. Throws InputError for anything else, and for meshes that are
/// open, not manifold, inside out or cross themselves.
ComparedStock load_stock(const std::string& file);

/// A scene, a program of surface blocks, a CAD file, an earlier stock, or a mesh of the same quality.
/// `pitch_mm`: of the facets that stand for parametric surfaces.
ComparedDesign load_design(const std::string& file, double pitch_mm);

/// Throws InputError when the boxes do not meet ("boxes-apart"), or one is the other in another unit
/// ("looks-like-inches", "looks-like-metres",
/// "looks-like-centimetres").
void check_boxes(const ComparedStock& stock, const ComparedDesign& design, const std::string& stock_file,
                 const std::string& design_file);

}  // namespace swarf::cli

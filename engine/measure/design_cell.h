// The design in cells: triangles whose columns along the normals tile what lies above and below it. Internal
// to this folder.
//
// A cell has three corners (p_k, n_k): places of the design and the directions of their columns. The place at
// barycentric l and height s stands at S(l) + s n(l). It lies within
//   flatness + |s| turn    of    sum_k l_k (p_k + s n_k),
// so whatever holds for a ball of that radius about the sum holds for the design (theory 8). For a surface
// whose Suu, Suv, Svv stay within a, b, c of a mean second derivative M, Taylor's formula at the corners
// gives
//   S(l) = sum l_k p_k - 1/2 sum over pairs l_j l_k M(x_j - x_k) + e,
//   |e| <= stray = 1/2 max over l of sum over pairs l_j l_k q_jk,   q = (a + b) du^2 + (b + c) dv^2 of edge
//   jk,
// because sum l_k q(x_k - x) = sum over pairs l_j l_k q(x_j - x_k) for a quadratic form q; that maximum is
// the squared radius of the least circle around the triangle in the metric q. Flatness is the same with |M| +
// q. So the cell is a quadratic patch but for the stray: it lies in the hull of its corners and of three
// places beside the middles of its sides (Bezier), where the columns' directions are the means of the
// corners'.
#pragma once

#include <array>
#include <vector>

#include "base/frames.h"
#include "stock/rays/ray_field.h"
#include "surface/surface.h"
#include "surface/under_facets.h"

namespace swarf::measure {

struct CellCorner {
  Vec3 point, normal;  ///< W, mm; unit, out of the material
  Vec2 uv = Vec2::Zero();
};

/// A side of a cell that stands for a piece of a curved edge: the places [from, to] along it, or back.
/// Divided, the cell's corner comes to the middle place; until then the strip between edge and side belongs
/// to the cell, or lies beyond the design.
struct EdgePiece {
  const surface::EdgePlaces* places = nullptr;  ///< null: a side within the face, or straight
  size_t from = 0, to = 0;

  bool is_divided() const { return places != nullptr && (from > to ? from - to : to - from) > 1; }
  EdgePiece first_half() const {
    return is_divided() ? EdgePiece{places, from, (from + to) / 2} : EdgePiece{};
  }
  EdgePiece second_half() const {
    return is_divided() ? EdgePiece{places, (from + to) / 2, to} : EdgePiece{};
  }
};
using CellEdges = std::array<EdgePiece, 3>;  ///< side k, from corner k to the next

/// What bounds the design between the corners of every cell of a patch.
struct PatchBounds {
  surface::SurfacePtr surface;        ///< null: flat facets with interpolated normals
  surface::BendBounds bends;          ///< mm
  double turn_u = 0.0, turn_v = 0.0;  ///< |dn/du|, |dn/dv| at most
  double most_u = 0.0, most_v = 0.0;  ///< |Su|, |Sv| at most, mm
  double edge_chord_mm = 0.0;         ///< of columns that fan out from an edge, which strays from its chord
};

struct DesignCell {
  std::array<CellCorner, 3> corners;
  double flatness_mm = 0.0, turn = 0.0;
  double stray_mm = 0.0;  ///< <= flatness_mm
  double strip_mm = 0.0;  ///< of both: how far the edges beside the cell leave its sides
  std::array<Vec3, 3> bends{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< M of the side from corner k, mm

  bool is_curved() const { return flatness_mm > stray_mm; }
  Vec3 centroid() const { return (corners[0].point + corners[1].point + corners[2].point) / 3.0; }
  Vec3 mean_normal() const {
    return (corners[0].normal + corners[1].normal + corners[2].normal).normalized();
  }
  /// The middle control point of the side from corner k to the next; its normal is not of length 1.
  CellCorner side(size_t k) const;
  /// From the centroid to the farthest corner, mm.
  double radius() const;
  double longest_edge() const;
  double area_mm2() const;
};

/// Greatest value over barycentric l of l_0 l_1 q01 + l_1 l_2 q12 + l_2 l_0 q20, all q >= 0.
double most_over_pairs(double q01, double q12, double q20);

DesignCell make_cell(const std::array<CellCorner, 3>& corners, const PatchBounds& bounds,
                     const CellEdges& edges = {});

/// Half way between two corners of a cell, or along the edge between them.
CellCorner middle(const CellCorner& a, const CellCorner& b, const PatchBounds& bounds,
                  const EdgePiece& edge = {});

/// The place of a cell with these barycentric coordinates.
CellCorner place_in(const DesignCell& cell, const Vec3& barycentric, const PatchBounds& bounds);

struct RootCell {
  DesignCell cell;
  PatchBounds bounds;
  CellEdges edges = {};
  bool looks_up = true;    ///< answers for material above the design
  bool looks_down = true;  ///< answers for cuts below it
};

/// Cells of about `size_mm` that cover the whole design of the field: parameter rectangles halved along a
/// diagonal; facets divided, or the parts of the surfaces over them. Sharp edges of a mesh get cells without
/// area, whose normals fan out from one side to the other, and so do the corners where they meet: no place
/// near a closed mesh lies between two columns.
std::vector<RootCell> root_cells(const stock::RayField& field, double size_mm);

/// About how many those of a field will be, without making them.
double expected_roots(const stock::RayField& field, double size_mm);

}  // namespace swarf::measure

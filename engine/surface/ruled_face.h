// Faces of CAD files that are ruled: the proof by the control net, and the face as a surface linear in v.
//
//      P_i0 ---o---o--- P_in     The rows of control points across the rulings. Where the point of column j
//      stands in P_10 ---o---o--- P_1n     every row at the same share a_j of the way from the first to the
//      last, each point of P_00 ---o---o--- P_0n     the surface lies on the line between its two edges, for
//      it is a mean of such points
//                                with weights that do not sum up differently in other rows. What the control
//                                points are away from there bounds what the surface is away.
#pragma once

#include <array>
#include <optional>

#include "surface/face.h"
#include "surface/nurbs.h"

namespace swarf::surface {

/// Along which parameter the rulings run.
enum class RulingDirection { kV, kU };

/// How far no place of the surface is from the line between both ends of its ruling. Infinity: weights that
/// differ from row to row in another ratio, which this does not decide.
double ruled_departure_bound(const NurbsSurface& surface, RulingDirection direction);

/// The same met at places of a grid: a lower bound, for what is told.
double ruled_departure_seen(const NurbsSurface& surface, RulingDirection direction);

/// Rounding of a file's digits, mm: below this a face counts as ruled.
inline constexpr double kRuledWithin = 1e-6;

/// Both parameters of [0,1]^2 inside a face's own.
struct RuledPart {
  SurfacePtr surface;
  RulingDirection direction = RulingDirection::kV;
  Vec2 low = Vec2::Zero(), high = Vec2::Ones();  ///< (u, v) of the face: the rectangle that its loop encloses
  bool exchanged = false;                        ///< guide curve 0 is the other edge
};

/// S(u,v) = (1-v) C0(u) + v C1(u) between two edges of the part. The places are those of a ruled face; the
/// parameter along a ruling is even, whatever the face's weights make of it.
SurfacePtr ruled_between(const RuledPart& part);

/// The rectangle that the face's outer loop encloses to 1e-6 of its sides, and nothing else; none: it is
/// trimmed otherwise.
std::optional<std::array<Vec2, 2>> rectangle_of(const Face& face);

}  // namespace swarf::surface

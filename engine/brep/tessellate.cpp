#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/check.h"
#include "brep/facet_chord.h"
#include "brep/facet_estimate.h"
#include "brep/occt_shape.h"
#include "brep/straight_lines.h"
#include "surface/nurbs.h"

namespace swarf::brep {
namespace {

struct Made {
  std::vector<Vec3> points;
  std::vector<std::array<uint32_t, 3>> triangles;
  double chord_mm = 0.0;   ///< from each place of a facet to the place of the face with its parameters
  double strays_mm = 0.0;  ///< from a facet to its face
  bool proven = true;
  surface::UnderFacets under;
  double edge_mm = 0.0;
  size_t across_creases = 0;
};

/// Nothing but rounding is left of the bends of a plane; mm.
constexpr double kPlane = 1e-10;

bool is_plane(const surface::Surface& surface) {
  const surface::BendBounds b = surface.bend_bounds(Vec2::Zero(), Vec2::Ones());
  return std::max({b.uu.most(), b.uv.most(), b.vv.most()}) <= kPlane;
}

/// In the square of a part of the face.
Vec2 in_part(const surface::NurbsPart& part, const Vec2& uv) {
  return (uv - part.low).cwiseQuotient(part.high - part.low);
}

/// The smooth part of the face that holds a facet, and where; `uv` of the whole square.
surface::FacetOnSurface place_under(const MeshedFace& face, int first_part, const std::array<Vec2, 3>& uv) {
  constexpr double kOnBorder = 1e-9;
  for (size_t i = 0; i < face.parts.size(); ++i) {
    const surface::NurbsPart& part = face.parts[i];
    surface::FacetOnSurface on;
    bool holds = true;
    for (size_t k = 0; k < 3; ++k) {
      const Vec2 own = in_part(part, uv[k]);
      holds = holds && own.minCoeff() >= -kOnBorder && own.maxCoeff() <= 1.0 + kOnBorder;
      on.uv[k] = own.cwiseMax(Vec2::Zero()).cwiseMin(Vec2::Ones());
    }
    if (!holds) continue;
    on.surface = first_part + static_cast<int>(i);
    return on;
  }
  return {};
}

/// One side of a facet that ends on an edge.
struct EdgeSide {
  double chord_mm = 0.0;         ///< how far the edge strays from the side
  std::array<double, 2> t{};     ///< of the edge's curves
  Handle(Geom_Curve) curve;      ///< in space
  Handle(Geom2d_Curve) in_face;  ///< in the face's parameters
};
/// By the facets' nodes at its ends, as the edge runs.
using EdgeSides = std::map<std::array<int, 2>, EdgeSide>;

constexpr int kQuarters = 4;

double chord_of(const Geom_Curve& curve, const std::array<double, 2>& t) {
  const auto at = [&](int i) {
    const gp_Pnt p = curve.Value(t[0] + (t[1] - t[0]) * i / kQuarters);
    return Vec3(p.X(), p.Y(), p.Z());
  };
  double most = 0.0;
  for (int i = 1; i < kQuarters; ++i) most = std::max(most, to_segment(at(i), at(0), at(kQuarters)));
  return most;
}

EdgeSides sides_on_edges(const TopoDS_Face& face, const Handle(Poly_Triangulation) & facets,
                         const TopLoc_Location& at) {
  EdgeSides found;
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(it.Current());
    const Handle(Poly_PolygonOnTriangulation) nodes = BRep_Tool::PolygonOnTriangulation(edge, facets, at);
    double first, last;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    const Handle(Geom2d_Curve) in_face = BRep_Tool::CurveOnSurface(edge, face, first, last);
    if (nodes.IsNull() || curve.IsNull() || in_face.IsNull() || !nodes->HasParameters()) continue;
    for (int i = 1; i < nodes->NbNodes(); ++i) {
      EdgeSide side{0.0, {nodes->Parameter(i), nodes->Parameter(i + 1)}, curve, in_face};
      side.chord_mm = chord_of(*curve, side.t);
      found[{nodes->Node(i), nodes->Node(i + 1)}] = std::move(side);
    }
  }
  return found;
}

/// How far the surface over a straight piece of parameters lies from the edge beside it, at its quarters.
double off_edge(const EdgeSide& side, const std::array<double, 2>& t, const surface::Surface& surface,
                const std::array<Vec2, 2>& uv) {
  std::array<Vec3, kQuarters + 1> on;
  for (size_t i = 0; i <= kQuarters; ++i) {
    const gp_Pnt p = side.curve->Value(t[0] + (t[1] - t[0]) * static_cast<double>(i) / kQuarters);
    on[i] = Vec3(p.X(), p.Y(), p.Z());
  }
  double most = 0.0;
  for (size_t i = 0; i <= kQuarters; ++i) {
    const Vec2 place = uv[0] + static_cast<double>(i) / kQuarters * (uv[1] - uv[0]);
    const Vec3 over = surface.point(std::clamp(place.x(), 0.0, 1.0), std::clamp(place.y(), 0.0, 1.0));
    double beside = to_segment(over, on[0], on[1]);
    for (size_t k = 1; k < kQuarters; ++k) beside = std::min(beside, to_segment(over, on[k], on[k + 1]));
    most = std::max(most, beside);
  }
  return most;
}

/// Places along the edge so many that what lies straight between two of them is the edge, to the chord of
/// loops; with fewer than three the side itself is. What is left is told.
surface::EdgePlaces places_along(const EdgeSide& side, const MeshedFace& face, const surface::NurbsPart& part,
                                 double& left_mm) {
  constexpr int kMostParts = 256;
  const auto place = [&](double t) {
    const gp_Pnt2d uv = side.in_face->Value(t);
    return in_part(part, (Vec2(uv.X(), uv.Y()) - face.low).cwiseQuotient(face.high - face.low))
        .cwiseMax(Vec2::Zero())
        .cwiseMin(Vec2::Ones())
        .eval();
  };
  surface::EdgePlaces places;
  for (int parts = 1;; parts *= 2) {
    const auto t = [&](int i) { return side.t[0] + (side.t[1] - side.t[0]) * i / parts; };
    places.clear();
    for (int i = 0; i <= parts; ++i) places.push_back(place(t(i)));
    left_mm = 0.0;
    for (int i = 0; i < parts; ++i)
      left_mm =
          std::max(left_mm, off_edge(side, {t(i), t(i + 1)}, *part.surface,
                                     {places[static_cast<size_t>(i)], places[static_cast<size_t>(i) + 1]}));
    if (left_mm <= surface::kLoopChord || parts >= kMostParts) return places;
  }
}

/// What is known of the edges under a facet's sides goes to it; `nodes` of its corners.
void take_sides(const EdgeSides& sides, const std::array<int, 3>& nodes, const MeshedFace& face,
                int first_part, surface::FacetOnSurface& on, Made& made) {
  for (size_t k = 0; k < 3; ++k) {
    const int from = nodes[k], to = nodes[(k + 1) % 3];
    auto side = sides.find({from, to});
    const bool backwards = side == sides.end();
    if (backwards) side = sides.find({to, from});
    if (side == sides.end()) continue;
    on.chords_mm[k] = side->second.chord_mm;
    const bool is_curved = on.surface != surface::FacetOnSurface::kNone &&
                           made.under.is_plane[static_cast<size_t>(on.surface)] == 0;
    if (!is_curved) {
      made.edge_mm = std::max(made.edge_mm, side->second.chord_mm);
      continue;
    }
    double left_mm = 0.0;
    surface::EdgePlaces places =
        places_along(side->second, face, face.parts[static_cast<size_t>(on.surface - first_part)], left_mm);
    made.edge_mm = std::max(made.edge_mm, left_mm);
    if (backwards) std::reverse(places.begin(), places.end());
    if (places.size() < 3) continue;
    // Across the seam of a closed surface an edge has two curves; those beside it run straight.
    constexpr double kSame = 1e-6;
    if ((places.front() - on.uv[k]).norm() > kSame || (places.back() - on.uv[(k + 1) % 3]).norm() > kSame) {
      made.edge_mm = std::max(made.edge_mm, on.chords_mm[k]);
      continue;
    }
    places.front() = on.uv[k];
    places.back() = on.uv[(k + 1) % 3];
    on.edges[k] = static_cast<int>(made.under.edges.size());
    made.under.edges.push_back(std::move(places));
  }
}

/// Facets of one face; vertices with the same place become one by weld().
void add_facets(const TopoDS_Face& face, const MeshedFace& meshed, double enough_mm, Made& made) {
  TopLoc_Location at;
  const Handle(Poly_Triangulation) facets = BRep_Tool::Triangulation(face, at);
  if (facets.IsNull())
    throw InputError("cad-surface", {}, "a face could not be divided into facets", "export the part again");
  const auto first = static_cast<uint32_t>(made.points.size());
  made.proven = made.proven && !meshed.creased() && facets->HasUVNodes();
  const auto first_part = static_cast<int>(made.under.surfaces.size());
  for (const surface::NurbsPart& part : meshed.parts) {
    made.under.surfaces.push_back(part.surface);
    made.under.is_plane.push_back(is_plane(*part.surface) ? 1 : 0);
  }
  std::vector<Vec2> places;
  for (int i = 1; i <= facets->NbNodes(); ++i) {
    const gp_Pnt p = facets->Node(i).Transformed(at.Transformation());
    made.points.emplace_back(p.X(), p.Y(), p.Z());
    if (!facets->HasUVNodes()) continue;
    const gp_Pnt2d uv = facets->UVNode(i);
    places.emplace_back((Vec2(uv.X(), uv.Y()) - meshed.low).cwiseQuotient(meshed.high - meshed.low));
  }
  const EdgeSides sides = sides_on_edges(face, facets, at);
  const std::optional<int> along = straight_lines(*meshed.whole);
  for (int i = 1; i <= facets->NbTriangles(); ++i) {
    int a, b, c;
    facets->Triangle(i).Get(a, b, c);
    if (face.Orientation() == TopAbs_REVERSED) std::swap(b, c);
    const auto at_node = [](int n) { return static_cast<size_t>(n - 1); };
    surface::FacetOnSurface on;
    if (!places.empty()) {
      const std::array<Vec2, 3> uv{places[at_node(a)], places[at_node(b)], places[at_node(c)]};
      on = place_under(meshed, first_part, uv);
      take_sides(sides, {a, b, c}, meshed, first_part, on, made);
      const std::array<Vec3, 3> facet{made.points[first + at_node(a)], made.points[first + at_node(b)],
                                      made.points[first + at_node(c)]};
      if (!meshed.creased()) {
        const double chord = distance_bound(*meshed.whole, uv, facet, enough_mm, 0);
        made.chord_mm = std::max(made.chord_mm, chord);
        const double strays =
            along && chord > enough_mm ? straight_bound(*meshed.whole, *along, uv, facet) : chord;
        made.strays_mm = std::max(made.strays_mm, std::min(strays, chord));
      }
    }
    made.across_creases += on.surface == surface::FacetOnSurface::kNone ? 1 : 0;
    made.under.facets.push_back(on);
    const auto number = [&](int n) { return first + static_cast<uint32_t>(n - 1); };
    made.triangles.push_back({number(a), number(b), number(c)});
  }
}

bool is_developable(const MeshedFace& face) {
  return !face.creased() && (is_plane(*face.whole) || straight_lines(*face.whole));
}

/// Developable faces need no vertices within them: their facets run from edge to edge.
enum class Which { kDevelopable, kOthers };

/// Appends the facets of those faces; false: there are others.
bool add_facets_of(const TopoDS_Shape& shape, Which which, double asked_mm, double edge_mm, double chord_mm,
                   bool closed_only, Made& made) {
  BRepTools::Clean(shape);
  constexpr double kMostAngle = 0.35;  // rad between neighbours: nothing but looks hangs on it
  IMeshTools_Parameters asked;
  asked.Deflection = std::min(asked_mm, edge_mm);  // of edges
  asked.DeflectionInterior = asked_mm;
  asked.Angle = asked.AngleInterior = kMostAngle;
  asked.InternalVerticesMode = asked.ControlSurfaceDeflection = which == Which::kOthers;
  const BRepMesh_IncrementalMesh mesher(shape, asked);
  bool all = true;
  const auto add = [&](const TopoDS_Shape& of) {
    for (TopExp_Explorer it(of, TopAbs_FACE); it.More(); it.Next()) {
      const MeshedFace meshed = meshed_face(TopoDS::Face(it.Current()));
      const bool wanted = is_developable(meshed) == (which == Which::kDevelopable);
      if (wanted) add_facets(TopoDS::Face(it.Current()), meshed, chord_mm, made);
      all = all && wanted;
    }
  };
  TopExp_Explorer body(shape, TopAbs_SOLID);
  for (; closed_only && body.More(); body.Next()) add(body.Current());
  if (!closed_only) add(shape);
  return all;
}

/// The library divides edges the same whichever faces are divided after them.
Made facets_of(const TopoDS_Shape& shape, double asked_mm, double edge_mm, double chord_mm,
               bool closed_only) {
  Made made;
  if (!add_facets_of(shape, Which::kDevelopable, asked_mm, edge_mm, chord_mm, closed_only, made))
    add_facets_of(shape, Which::kOthers, asked_mm, edge_mm, chord_mm, closed_only, made);
  return made;
}

}  // namespace

Facets tessellate(const Model& model, double chord_mm, bool closed_only, double edge_mm) {
  SWARF_CHECK(chord_mm > 0.0 && edge_mm > 0.0 && model.shape != nullptr, "a shape and a chord above 0");
  require_facets_fit(model, chord_mm, std::min(chord_mm, edge_mm));
  const QuietSession session;
  Made made;
  guarded(model.file, [&] {
    // The library keeps the chord at a few places of each facet; the proof sees all of it.
    constexpr int kMostTries = 4;
    double asked = 0.5 * chord_mm, last_mm = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMostTries; ++i) {
      made = facets_of(model.shape->nurbs, asked, edge_mm, chord_mm, closed_only);
      // What does not come nearer by finer facets is a fault of the file, such as an edge beside its face.
      constexpr double kNoNearer = 0.95;
      const bool is_stuck = made.strays_mm > kNoNearer * last_mm;
      if (made.strays_mm <= chord_mm || is_stuck) break;
      last_mm = made.strays_mm;
      asked *= std::clamp(0.7 * chord_mm / made.strays_mm, 0.3, 0.9);
    }
  });
  Facets facets;
  double farthest = 0.0;
  for (const Vec3& p : made.points) {
    farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
    facets.mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  facets.mesh.triangles = std::move(made.triangles);
  constexpr double kFloatStep = 0x1.0p-24 * 1.7320508;  // half a step in each of three coordinates
  facets.chord_mm = made.chord_mm + kFloatStep * farthest;
  facets.proven = made.proven;
  facets.across_creases = made.across_creases;
  made.under.chord_mm = facets.chord_mm;
  made.under.edge_mm = made.edge_mm;
  facets.under = std::make_shared<surface::UnderFacets>(std::move(made.under));
  return facets;
}

}  // namespace swarf::brep

// The library's shape as plain faces.
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "brep/occt_shape.h"
#include "surface/nurbs.h"

namespace swarf::brep {
namespace {

Vec3 vec(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}

/// Where two edges of a wire leave more than this between them the loop is told to be open, mm.
constexpr double kMostGap = 0.01;

std::vector<double> knots_of(const TColStd_Array1OfReal& sequence) {
  std::vector<double> knots;
  for (int i = sequence.Lower(); i <= sequence.Upper(); ++i) knots.push_back(sequence(i));
  return knots;
}

/// The surface without periods, cut open where the face begins; `low` and `high` are its parameters as the
/// curves of the face count them.
struct OpenSurface {
  Handle(Geom_BSplineSurface) spline;
  Vec2 low, high;
};

constexpr double kSameParameter = 1e-9;

/// Cuts a periodic u open at `from`; where the domain begins afterwards.
double open_u(Geom_BSplineSurface& spline, double from) {
  double low, high, v0, v1;
  spline.Bounds(low, high, v0, v1);
  const double period = high - low, at = from - std::floor((from - low) / period) * period;
  if (at - low > kSameParameter * period && high - at > kSameParameter * period) {
    spline.InsertUKnot(at, 1, kSameParameter * period, false);
    for (int i = spline.FirstUKnotIndex(); i <= spline.LastUKnotIndex(); ++i) {
      if (std::abs(spline.UKnot(i) - at) <= kSameParameter * period) {
        spline.SetUOrigin(i);
        break;
      }
    }
  }
  spline.SetUNotPeriodic();
  spline.Bounds(low, high, v0, v1);
  return low + std::round((from - low) / period) * period;
}

OpenSurface plain_surface(const TopoDS_Face& face) {
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  OpenSurface open;
  open.spline = Handle(Geom_BSplineSurface)::DownCast(GeomConvert::SurfaceToBSplineSurface(surface)->Copy());
  double u0, u1, v0, v1;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  const bool turns_u = open.spline->IsUPeriodic(), turns_v = open.spline->IsVPeriodic();
  const double from_u = turns_u ? open_u(*open.spline, u0) : 0.0;
  if (turns_v) open.spline->ExchangeUV();
  const double from_v = turns_v ? open_u(*open.spline, v0) : 0.0;
  if (turns_v) open.spline->ExchangeUV();
  open.spline->Bounds(open.low.x(), open.high.x(), open.low.y(), open.high.y());
  const Vec2 size = open.high - open.low;
  if (turns_u) open.low.x() = from_u;
  if (turns_v) open.low.y() = from_v;
  open.high = open.low + size;
  return open;
}

surface::NurbsData data_of(const Handle(Geom_BSplineSurface) & s, bool reversed) {
  surface::NurbsData data;
  data.degree_u = s->UDegree();
  data.degree_v = s->VDegree();
  data.knots_u = knots_of(s->UKnotSequence());
  data.knots_v = knots_of(s->VKnotSequence());
  data.outward_sign = reversed ? -1 : 1;
  const bool rational = s->IsURational() || s->IsVRational();
  for (int i = 1; i <= s->NbUPoles(); ++i) {
    for (int j = 1; j <= s->NbVPoles(); ++j) {
      data.poles.push_back(vec(s->Pole(i, j)));
      if (rational) data.weights.push_back(s->Weight(i, j));
    }
  }
  return data;
}

/// The unit square's place of the library's parameters.
struct Square {
  Vec2 low, high;
  Vec2 at(const gp_Pnt2d& p) const { return (Vec2(p.X(), p.Y()) - low).cwiseQuotient(high - low); }
};

/// Appends the places after `a` up to `b` of a curve in the parameters: halved until its quarters lie within
/// the chord of the segment, seen on the surface.
struct CurveInFace {
  const Geom2d_Curve& curve;
  const Square& square;
  const surface::Surface& surface;
  double chord_mm;

  Vec2 at(double t) const { return square.at(curve.Value(t)); }
  /// Distance on the surface of two places near each other, to the first order.
  double apart(const Vec2& p, const Vec2& q) const {
    const surface::Derivatives d =
        surface.derivatives(std::clamp(p.x(), 0.0, 1.0), std::clamp(p.y(), 0.0, 1.0));
    return (d.Su * (q.x() - p.x()) + d.Sv * (q.y() - p.y())).norm();
  }
  void append(double a, double b, int depth, std::vector<Vec2>& places) const {
    const Vec2 from = at(a), to = at(b);
    double stray = 0.0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const Vec2 on = at(a + share * (b - a)), way = to - from;
      const double length2 = way.squaredNorm();
      const double along = length2 > 0.0 ? std::clamp((on - from).dot(way) / length2, 0.0, 1.0) : 0.0;
      stray = std::max(stray, apart(on, from + along * way));
    }
    constexpr int kDeepest = 14;
    if (stray > chord_mm && depth < kDeepest) {
      append(a, 0.5 * (a + b), depth + 1, places);
      append(0.5 * (a + b), b, depth + 1, places);
    } else {
      places.push_back(to);
    }
  }
};

/// Places where the pieces of a curve meet.
std::vector<double> stops_of(const Handle(Geom2d_Curve) & curve, double first, double last) {
  Handle(Geom2d_Curve) basis = curve;
  if (const auto trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve)) basis = trimmed->BasisCurve();
  std::vector<double> stops{first};
  if (const auto spline = Handle(Geom2d_BSplineCurve)::DownCast(basis)) {
    for (int i = spline->FirstUKnotIndex(); i <= spline->LastUKnotIndex(); ++i) {
      const double knot = spline->Knot(i);
      if (knot > first + 1e-12 && knot < last - 1e-12) stops.push_back(knot);
    }
  }
  stops.push_back(last);
  return stops;
}

std::vector<Vec2> piece_of(const TopoDS_Edge& edge, const TopoDS_Face& face, const Square& square,
                           const surface::Surface& surface) {
  double first, last;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (curve.IsNull()) return {};
  const CurveInFace in{*curve, square, surface, surface::kLoopChord};
  std::vector<Vec2> places{in.at(first)};
  const std::vector<double> stops = stops_of(curve, first, last);
  for (size_t i = 0; i + 1 < stops.size(); ++i) in.append(stops[i], stops[i + 1], 0, places);
  if (edge.Orientation() == TopAbs_REVERSED) std::reverse(places.begin(), places.end());
  return places;
}

std::string called(const surface::Face& face) {
  return fmt::format("face {}{}", face.number, face.name.empty() ? "" : " '" + face.name + "'");
}

[[noreturn]] void refuse_face(const Model& model, const surface::Face& face, const std::string& text) {
  throw InputError("cad-surface", {model.file}, called(face) + ": " + text,
                   "export the part again with surfaces of a lower degree and closed loops");
}

/// Loops in the unit square of the whole surface.
void take_loops(const TopoDS_Face& face, const Square& square, const surface::Surface& whole, Model& model,
                surface::Face& plain) {
  for (TopoDS_Iterator it(face.Oriented(TopAbs_FORWARD)); it.More(); it.Next()) {
    if (it.Value().ShapeType() != TopAbs_WIRE) continue;
    const TopoDS_Wire wire = TopoDS::Wire(it.Value());
    size_t edges = 0;
    for (TopExp_Explorer e(wire, TopAbs_EDGE); e.More(); e.Next()) ++edges;
    std::vector<std::vector<Vec2>> pieces;
    size_t met = 0;
    for (BRepTools_WireExplorer e(wire, TopoDS::Face(face.Oriented(TopAbs_FORWARD))); e.More();
         e.Next(), ++met) {
      std::vector<Vec2> piece =
          piece_of(e.Current(), TopoDS::Face(face.Oriented(TopAbs_FORWARD)), square, whole);
      if (piece.size() < 2) refuse_face(model, plain, "an edge has no curve on its surface");
      pieces.push_back(std::move(piece));
    }
    if (met != edges || pieces.empty())
      refuse_face(model, plain, fmt::format("a loop of {} edges hangs together for {} of them", edges, met));
    surface::TrimLoop loop;
    const surface::LoopGap gap = surface::join_loop(whole, pieces, loop);
    if (gap.gap_mm > kMostGap) {
      refuse_face(model, plain,
                  fmt::format("a loop does not close: {:.4g} mm are missing at ({:.6g}, {:.6g}, {:.6g}) mm",
                              gap.gap_mm, gap.place.x(), gap.place.y(), gap.place.z()));
    }
    if (loop.size() >= 3) plain.loops.push_back(std::move(loop));
  }
  plain.chord_mm = surface::kLoopChord;
  if (!surface::orient_loops(plain.loops)) {
    model.warnings.push_back({"cad-loops",
                              Severity::kWarning,
                              {model.file},
                              called(plain) + ": a loop begins outside the outer one",
                              "check the face"});
  }
}

/// The square's border itself: nothing is trimmed.
bool is_square(const std::vector<surface::TrimLoop>& loops) {
  constexpr double kSame = 1e-9;
  if (loops.size() != 1) return false;
  double area = 0.0;
  for (size_t i = 0; i < loops[0].size(); ++i) {
    const Vec2 &a = loops[0][i], &b = loops[0][(i + 1) % loops[0].size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    for (const double x : {a.x(), a.y()}) {
      if (x < -kSame || x > 1.0 + kSame) return false;
    }
  }
  return std::abs(area - 1.0) < kSame;
}

/// Vertices of every loop within the part's own unit square.
std::vector<surface::TrimLoop> loops_within(const std::vector<surface::TrimLoop>& loops, const Vec2& low,
                                            const Vec2& high) {
  std::vector<surface::TrimLoop> own = loops;
  for (surface::TrimLoop& loop : own) {
    for (Vec2& place : loop) place = (place - low).cwiseQuotient(high - low);
  }
  return own;
}

/// Appends the face's smooth parts.
void take_face(const TopoDS_Face& face, const std::string& name, Model& model) {
  surface::Face plain;
  plain.number = ++model.face_count;
  plain.name = name;
  const OpenSurface open = plain_surface(face);
  const surface::NurbsData data = data_of(open.spline, face.Orientation() == TopAbs_REVERSED);
  const std::vector<std::string> problems = surface::nurbs_problems(data);
  if (!problems.empty()) refuse_face(model, plain, problems.front());
  const Square square{open.low, open.high};
  const std::vector<surface::NurbsPart> parts = surface::smooth_parts(data);
  // The loops' chords are measured on the whole surface, creases and all: only places and slopes are asked.
  const surface::NurbsSurface whole = surface::NurbsSurface::with_creases(data);
  take_loops(face, square, whole, model, plain);
  if (is_square(plain.loops)) plain.loops.clear();
  for (const surface::NurbsPart& part : parts) {
    surface::Face one = plain;
    one.surface = part.surface;
    one.loops = loops_within(plain.loops, part.low, part.high);
    const bool outside =
        parts.size() > 1 && surface::FaceDomain(one).classify({0, 0}, {1, 1}) == surface::Region::kOutside;
    if (!outside) model.faces.push_back(std::move(one));
  }
}

Edge edge_of(const TopoDS_Edge& edge) {
  Edge plain;
  plain.tolerance_mm = BRep_Tool::Tolerance(edge);
  plain.chord_mm = surface::kLoopChord;
  const BRepAdaptor_Curve curve(edge);
  const std::function<void(double, double, int)> append = [&](double a, double b, int depth) {
    const Vec3 from = vec(curve.Value(a)), to = vec(curve.Value(b)), way = to - from;
    double stray = 0.0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const Vec3 off = vec(curve.Value(a + share * (b - a))) - from;
      const double length2 = way.squaredNorm();
      const double along = length2 > 0.0 ? std::clamp(off.dot(way) / length2, 0.0, 1.0) : 0.0;
      stray = std::max(stray, (off - along * way).norm());
    }
    constexpr int kDeepest = 14;
    if ((stray > plain.chord_mm || depth < 1) && depth < kDeepest) {
      append(a, 0.5 * (a + b), depth + 1);
      append(0.5 * (a + b), b, depth + 1);
    } else {
      plain.points.push_back(to);
    }
  };
  plain.points.push_back(vec(curve.Value(curve.FirstParameter())));
  append(curve.FirstParameter(), curve.LastParameter(), 0);
  return plain;
}

/// How far the places of the faces that share an edge lie apart along it, the widest of some places.
void measure_gap(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces, Edge& plain) {
  constexpr int kPlaces = 16;
  for (const TopoDS_Shape& a : faces) {
    for (const TopoDS_Shape& b : faces) {
      if (a.IsSame(b)) break;
      double low, high, unused;
      const TopoDS_Face &one = TopoDS::Face(a), &other = TopoDS::Face(b);
      const Handle(Geom2d_Curve) on_one = BRep_Tool::CurveOnSurface(edge, one, low, high);
      const Handle(Geom2d_Curve) on_other = BRep_Tool::CurveOnSurface(edge, other, unused, unused);
      if (on_one.IsNull() || on_other.IsNull()) continue;
      const BRepAdaptor_Surface surface_one(one, false), surface_other(other, false);
      for (int i = 0; i <= kPlaces; ++i) {
        const double t = low + (high - low) * i / kPlaces;
        const gp_Pnt2d p = on_one->Value(t), q = on_other->Value(t);
        const Vec3 at = vec(surface_one.Value(p.X(), p.Y()));
        const double gap = (vec(surface_other.Value(q.X(), q.Y())) - at).norm();
        if (gap > plain.gap_mm) plain.gap_mm = gap, plain.gap_at = at;
      }
    }
  }
}

void take_edges(const TopoDS_Shape& shape, Model& model) {
  TopTools_IndexedDataMapOfShapeListOfShape edges;
  TopTools_IndexedMapOfShape vertices;
  TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_EDGE, TopAbs_FACE, edges);
  TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(edges.FindKey(i));
    if (BRep_Tool::Degenerated(edge)) continue;
    model.edges.push_back(edge_of(edge));
    measure_gap(edge, edges(i), model.edges.back());
    model.edge_tolerance_mm = std::max(model.edge_tolerance_mm, model.edges.back().tolerance_mm);
  }
  for (int i = 1; i <= vertices.Extent(); ++i)
    model.vertices.push_back(vec(BRep_Tool::Pnt(TopoDS::Vertex(vertices(i)))));
}

/// Area and volume by our own quadrature; a closed body that is inside out is turned.
void measure_solid(Model& model, Solid& solid) {
  surface::FaceMeasure sum;
  for (const size_t n : solid.faces) {
    const surface::FaceMeasure one = surface::measure_face(model.faces[n]);
    sum.area_mm2 += one.area_mm2;
    sum.flux_mm3 += one.flux_mm3;
  }
  solid.area_mm2 = sum.area_mm2;
  solid.volume_mm3 = solid.closed ? sum.flux_mm3 : 0.0;
  if (solid.volume_mm3 >= 0.0) return;
  solid.volume_mm3 = -solid.volume_mm3;
  for (const size_t n : solid.faces) {
    const auto& nurbs = static_cast<const surface::NurbsSurface&>(*model.faces[n].surface);
    model.faces[n].surface = std::make_shared<surface::NurbsSurface>(nurbs.grid(), -nurbs.outward_sign());
  }
  model.warnings.push_back(
      {"cad-turned",
       Severity::kWarning,
       {model.file},
       fmt::format("the body '{}' is inside out in the file: its faces were turned", solid.name),
       ""});
}

/// A solid, a shell or a loose face of the shape as it was read, its faces as they were converted.
void take_body(const TopoDS_Shape& body, BRepBuilderAPI_NurbsConvert& convert, const NameOf& name_of,
               Model& model) {
  Solid solid;
  solid.name = name_of(body);
  solid.closed =
      body.ShapeType() == TopAbs_SOLID || (body.ShapeType() == TopAbs_SHELL && BRep_Tool::IsClosed(body));
  for (TopExp_Explorer it(body, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face face = TopoDS::Face(it.Current());
    if (GeomAdaptor_Surface(BRep_Tool::Surface(face)).GetType() == GeomAbs_OffsetSurface) {
      model.warnings.push_back(
          {"cad-approximated",
           Severity::kWarning,
           {model.file},
           fmt::format("face {} is an offset surface: it is approximated by a NURBS", model.face_count + 1),
           ""});
    }
    const TopoDS_Shape converted = convert.ModifiedShape(face);
    const size_t before = model.faces.size();
    take_face(TopoDS::Face(converted.Oriented(face.Orientation())), name_of(face), model);
    for (size_t n = before; n < model.faces.size(); ++n) solid.faces.push_back(n);
  }
  if (solid.faces.empty()) return;
  measure_solid(model, solid);
  model.solids.push_back(std::move(solid));
}

}  // namespace

MeshedFace meshed_face(const TopoDS_Face& face) {
  const OpenSurface open = plain_surface(face);
  const surface::NurbsData data = data_of(open.spline, face.Orientation() == TopAbs_REVERSED);
  return {std::make_shared<surface::NurbsSurface>(surface::NurbsSurface::with_creases(data)),
          surface::smooth_parts(data), open.low, open.high};
}

void take_shape(const TopoDS_Shape& shape, const NameOf& name_of, Model& model) {
  BRepBuilderAPI_NurbsConvert convert(shape);
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next())
    take_body(it.Current(), convert, name_of, model);
  for (TopExp_Explorer it(shape, TopAbs_SHELL, TopAbs_SOLID); it.More(); it.Next())
    take_body(it.Current(), convert, name_of, model);
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next())
    take_body(it.Current(), convert, name_of, model);
  if (model.faces.empty()) {
    throw InputError("cad-empty", {model.file},
                     "the file holds no faces: points and curves alone, or nothing",
                     "export the part as a solid or as surfaces, not as a wireframe");
  }
  auto kept = std::make_shared<Shape>();
  kept->nurbs = convert.Shape();
  take_edges(kept->nurbs, model);
  model.shape = kept;
}

}  // namespace swarf::brep

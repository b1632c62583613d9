#include "nurbs_edge_part.h"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "brep/model.h"

namespace swarf::position {
namespace {

constexpr int kSpans = 3;
constexpr std::array<double, 10> kKnots{0, 0, 0, 0, 1, 2, 3, 3, 3, 3};

std::array<double, 4> bernstein(double t) {
  const double s = 1.0 - t;
  return {s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t};
}

/// Greatest |second| and |first| derivative of a cubic from its poles, over a parameter of length 1.
template <typename Poles>
std::pair<double, double> most_derivatives(const Poles& pole) {
  double first = 0.0, second = 0.0;
  for (size_t i = 0; i + 1 < 4; ++i) first = std::max(first, 3.0 * std::abs(pole(i + 1) - pole(i)));
  for (size_t i = 0; i + 2 < 4; ++i)
    second = std::max(second, 6.0 * std::abs(pole(i + 2) - 2.0 * pole(i + 1) + pole(i)));
  return {first, second};
}

TopoDS_Shape prism_over(const TopoDS_Wire& outline, double height) {
  const TopoDS_Face face =
      BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, NurbsEdgePart::kFloor), gp::DZ()), outline);
  return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, height)).Shape();
}

}  // namespace

std::array<double, 6> NurbsEdgePart::side_abscissae() {
  std::array<double, 6> x{};
  for (size_t i = 0; i < 6; ++i)
    x[i] = kHalf * (2.0 * (kKnots[i + 1] + kKnots[i + 2] + kKnots[i + 3]) / (3.0 * kSpans) - 1.0);
  return x;
}

double NurbsEdgePart::top(double x, double y) const {
  const auto a = bernstein(0.5 * (x / kTopHalf + 1.0)), b = bernstein(0.5 * (y / kTopHalf + 1.0));
  double z = 0.0;
  for (size_t i = 0; i < 4; ++i)
    for (size_t k = 0; k < 4; ++k) z += a[i] * b[k] * top_poles[i][k];
  return z;
}

/// De Boor's algorithm.
double NurbsEdgePart::side(double x) const {
  const double t = std::clamp(0.5 * kSpans * (x / kHalf + 1.0), 0.0, double(kSpans));
  const size_t span = 3 + static_cast<size_t>(std::clamp(std::floor(t), 0.0, kSpans - 1.0));
  std::array<double, 4> d{};
  for (size_t k = 0; k < 4; ++k) d[k] = side_poles[span - 3 + k];
  for (size_t r = 1; r < 4; ++r)
    for (size_t k = 3; k >= r; --k) {
      const size_t i = span - 3 + k;
      const double share = (t - kKnots[i]) / (kKnots[i + 4 - r] - kKnots[i]);
      d[k] = (1.0 - share) * d[k - 1] + share * d[k];
    }
  return d[3];
}

double NurbsEdgePart::most_side_slope() const {
  const auto x = side_abscissae();
  double most = 0.0;
  for (size_t i = 0; i < 5; ++i)
    most = std::max(most, std::abs(side_poles[i + 1] - side_poles[i]) / (x[i + 1] - x[i]));
  return most;
}

surface::Region NurbsEdgePart::part_of_top(const Vec2& low, const Vec2& high) const {
  const Vec2 a = kHalf * (2.0 * low - Vec2::Ones()), b = kHalf * (2.0 * high - Vec2::Ones());
  const Vec2 middle = 0.5 * (a + b), half = 0.5 * (b - a);
  const double beyond = middle.y() - side(middle.x()), reach = half.y() + most_side_slope() * half.x();
  if (beyond > reach) return surface::Region::kOutside;
  // In the ellipse's own measure, where it is a circle of radius 1.
  const Vec2 size(kHoleWide, kHoleHigh), hole(kHoleX, kHoleY);
  const double from_hole = (middle - hole).cwiseQuotient(size).norm(), wide = half.cwiseQuotient(size).norm();
  if (from_hole + wide < 1.0) return surface::Region::kOutside;
  return beyond <= -reach && from_hole - wide >= 1.0 ? surface::Region::kInside : surface::Region::kCrossing;
}

std::vector<Sheet> NurbsEdgePart::sheets() const {
  // Derivatives of the top by x and y, from rows and columns of its poles.
  double first = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  const double scale = 1.0 / (2.0 * kTopHalf);
  for (size_t i = 0; i < 4; ++i) {
    const auto [fu, fuu] = most_derivatives([&](size_t k) { return top_poles[k][i]; });
    const auto [fv, fvv] = most_derivatives([&](size_t k) { return top_poles[i][k]; });
    first = std::max(first, scale * std::max(fu, fv));
    xx = std::max(xx, scale * scale * fuu);
    yy = std::max(yy, scale * scale * fvv);
    for (size_t k = 0; i < 3 && k < 3; ++k)
      xy = std::max(xy, scale * scale * 9.0 *
                            std::abs(top_poles[i + 1][k + 1] - top_poles[i][k + 1] - top_poles[i + 1][k] +
                                     top_poles[i][k]));
  }
  const double bend = std::sqrt(xx * xx + 2.0 * xy * xy + yy * yy), rise = std::sqrt(2.0) * first;
  /// |(p, top(p))''| of a plane curve p with |p'| and |p''| at most these.
  const auto lifted = [&](double speed, double turn) { return turn + bend * speed * speed + rise * turn; };
  double side_bend = 0.0;
  const auto x = side_abscissae();
  for (size_t i = 0; i + 2 < 6; ++i) {
    // Second differences of the poles over the knots (Piegl & Tiller, eq. 3.8), by x.
    const double s0 = (side_poles[i + 1] - side_poles[i]) / (x[i + 1] - x[i]),
                 s1 = (side_poles[i + 2] - side_poles[i + 1]) / (x[i + 2] - x[i + 1]);
    const double knots = 2.0 * kHalf / kSpans * (kKnots[i + 4] - kKnots[i + 2]);
    side_bend = std::max(side_bend, 2.0 * std::abs(s1 - s0) / knots);
  }
  const double wide = 2.0 * kHalf, speed = wide * std::hypot(1.0, most_side_slope());
  const auto down = [this](const Vec2& p, double v) {
    return Vec3(p.x(), p.y(), kFloor + v * (top(p.x(), p.y()) - kFloor));
  };
  Sheet face{[this](double u, double v) {
               const double px = kHalf * (2.0 * u - 1.0), py = kHalf * (2.0 * v - 1.0);
               return Vec3(px, py, top(px, py));
             },
             wide * wide * xx, wide * wide * yy,
             [this](const Vec2& low, const Vec2& high) { return part_of_top(low, high); }};
  Sheet wall{[this, down](double u, double v) {
               const double px = kHalf * (2.0 * u - 1.0);
               return down({px, side(px)}, v);
             },
             lifted(speed, wide * wide * side_bend), 0.0};
  Sheet hole{[down](double u, double v) {
               const double turn = 2.0 * kPi * u;
               return down({kHoleX + kHoleWide * std::cos(turn), kHoleY + kHoleHigh * std::sin(turn)}, v);
             },
             4.0 * kPi * kPi * lifted(kHoleWide, kHoleWide), 0.0};
  // lifted() takes both as lengths: with the turn's 2 pi before it, |p'|^2 and |p''| have the same factor.
  return {face, wall, hole};
}

std::vector<surface::Face> NurbsEdgePart::faces_from_step() const {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const auto x = side_abscissae();
  TColgp_Array1OfPnt poles(1, 6);
  for (size_t i = 0; i < 6; ++i) poles(static_cast<int>(i) + 1) = gp_Pnt(x[i], side_poles[i], kFloor);
  TColStd_Array1OfReal knots(1, 4);
  TColStd_Array1OfInteger times(1, 4);
  for (int i = 1; i <= 4; ++i) {
    knots(i) = i - 1;
    times(i) = i == 1 || i == 4 ? 4 : 1;
  }
  const Handle(Geom_BSplineCurve) curve = new Geom_BSplineCurve(poles, knots, times, 3);
  const gp_Pnt left = poles(1), right = poles(6), low_left(-kHalf, -kHalf, kFloor),
               low_right(kHalf, -kHalf, kFloor);
  BRepBuilderAPI_MakeWire outline(BRepBuilderAPI_MakeEdge(curve), BRepBuilderAPI_MakeEdge(right, low_right),
                                  BRepBuilderAPI_MakeEdge(low_right, low_left),
                                  BRepBuilderAPI_MakeEdge(low_left, left));
  const Handle(Geom_Ellipse) ellipse =
      new Geom_Ellipse(gp_Ax2(gp_Pnt(kHoleX, kHoleY, kFloor), gp::DZ(), gp::DX()), kHoleWide, kHoleHigh);
  const BRepBuilderAPI_MakeWire hole(BRepBuilderAPI_MakeEdge(GeomConvert::CurveToBSplineCurve(ellipse)));

  TColgp_Array2OfPnt grid(1, 4, 1, 4);
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k)
      grid(i + 1, k + 1) = gp_Pnt(kTopHalf * (2.0 * i / 3.0 - 1.0), kTopHalf * (2.0 * k / 3.0 - 1.0),
                                  top_poles[static_cast<size_t>(i)][static_cast<size_t>(k)]);
  const TopoDS_Face top_face = BRepBuilderAPI_MakeFace(new Geom_BezierSurface(grid), 1e-7);
  const TopoDS_Shape below_top = BRepPrimAPI_MakePrism(top_face, gp_Vec(0, 0, 3.0 * kFloor)).Shape();
  constexpr double kAboveAll = 30.0;
  const TopoDS_Shape column = BRepAlgoAPI_Cut(prism_over(outline.Wire(), kAboveAll),
                                              prism_over(BRepBuilderAPI_MakeWire(hole).Wire(), kAboveAll))
                                  .Shape();
  const TopoDS_Shape part = BRepAlgoAPI_Common(column, below_top).Shape();

  const std::string path =
      (std::filesystem::temp_directory_path() / ("swarf_nurbs_edge_" + std::to_string(::getpid()) + ".stp"))
          .string();
  STEPControl_Writer writer;
  const bool written = writer.Transfer(part, STEPControl_AsIs) == IFSelect_RetDone &&
                       writer.Write(path.c_str()) == IFSelect_RetDone;
  std::vector<surface::Face> faces;
  if (written) faces = brep::read_step(path).faces;
  std::filesystem::remove(path);
  return faces;
}

}  // namespace swarf::position

// Writes mould.stp: a mould of NURBS faces. Two bicubic patches that go on smoothly across X = 0 make a wavy
// ground; a boss with a wall of 30 deg draft stands on it, whose foot is trimmed out of both and whose top is
// a crowned patch. Built by `ninja make_mould`, run as `make_mould mould.stp`.
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include <cstdio>

namespace {

/// A bicubic patch of one span over [x0, x1] x [y0, y1] by the heights of its 16 poles, which lie evenly.
TopoDS_Face bicubic(double x0, double x1, double y0, double y1, const double (&heights)[4][4]) {
  TColgp_Array2OfPnt poles(1, 4, 1, 4);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      poles(i + 1, j + 1) = gp_Pnt(x0 + (x1 - x0) * i / 3, y0 + (y1 - y0) * j / 3, heights[i][j]);
  }
  TColStd_Array1OfReal knots(1, 2);
  TColStd_Array1OfInteger times(1, 2);
  knots(1) = 0;
  knots(2) = 1;
  times(1) = times(2) = 4;
  const Handle(Geom_BSplineSurface) surface =
      new Geom_BSplineSurface(poles, knots, knots, times, times, 3, 3);
  return BRepBuilderAPI_MakeFace(surface, 1e-7).Face();
}

TopoDS_Shape below(const TopoDS_Face& face) {
  return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, -30)).Shape();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: make_mould FILE.stp\n"), 2;
  // Across X = 0 the two patches share a row of poles, and the rows beside it lie in one line with it.
  const double left[4][4] = {{0, 0, 0, 0}, {0, 1.2, 0.6, 0}, {0, 1.6, 0.2, 0}, {0, 1.0, 0.4, 0}};
  const double right[4][4] = {{0, 1.0, 0.4, 0}, {0, 0.4, 0.6, 0}, {0, 0.3, 1.4, 0}, {0, 0, 0, 0}};
  const double crown[4][4] = {{5, 5.5, 5.5, 5}, {5.5, 7, 7, 5.5}, {5.5, 7, 7, 5.5}, {5, 5.5, 5.5, 5}};
  const TopoDS_Shape ground =
      BRepAlgoAPI_Fuse(below(bicubic(-21, 0, -15, 15, left)), below(bicubic(0, 21, -15, 15, right))).Shape();
  const TopoDS_Shape cone =
      BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(2, 1, -4), gp::DZ()), 11.0, 2.3397459621556145, 15.0).Shape();
  const TopoDS_Shape boss = BRepAlgoAPI_Common(cone, below(bicubic(-10, 14, -11, 13, crown))).Shape();
  const TopoDS_Shape whole = BRepAlgoAPI_Fuse(ground, boss).Shape();
  const TopoDS_Shape part =
      BRepAlgoAPI_Common(whole, BRepPrimAPI_MakeBox(gp_Pnt(-21, -15, -10), gp_Pnt(21, 15, 20))).Shape();
  STEPControl_Writer writer;
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetCVal("write.step.product.name", "kato_mould");
  if (writer.Transfer(part, STEPControl_ManifoldSolidBrep) != IFSelect_RetDone) return 1;
  return writer.Write(argv[1]) == IFSelect_RetDone ? 0 : 1;
}

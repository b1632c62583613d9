#include "brep/write_step.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRep_Builder.hxx>
#include <Geom_Plane.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_StepModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/file.h"
#include "brep/occt_shape.h"
#include "mesh/mesh_shells.h"
#include "mesh/mesh_slivers.h"

namespace swarf::brep {
namespace {

constexpr double kSliver = 1e-6;     // mm; ten times the library's tolerance
constexpr double kTolerance = 1e-7;  // mm; the library's own

gp_Pnt point_of(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

/// Faces that share their vertices and edges.
class ShellBuilder {
 public:
  explicit ShellBuilder(const mesh::WeldedMesh& mesh) : mesh_(mesh), vertices_(mesh.points.size()) {}

  TopoDS_Shell shell(const std::vector<uint32_t>& facets) {
    TopoDS_Shell shell;
    builder_.MakeShell(shell);
    for (const uint32_t facet : facets) builder_.Add(shell, face(mesh_.triangles[facet]));
    shell.Closed(true);
    return shell;
  }

 private:
  TopoDS_Face face(const std::array<uint32_t, 3>& triangle) {
    const Vec3& a = mesh_.points[triangle[0]];
    Vec3 normal = (mesh_.points[triangle[1]] - a).cross(mesh_.points[triangle[2]] - a);
    // What no flip could help lies on a line; any plane through it will do.
    if (normal.norm() < 1e-300) normal = (mesh_.points[triangle[1]] - a).unitOrthogonal();
    TopoDS_Face face;
    const gp_Dir up(normal.x(), normal.y(), normal.z());
    builder_.MakeFace(face, new Geom_Plane(gp_Pln(point_of(a), up)), kTolerance);
    TopoDS_Wire wire;
    builder_.MakeWire(wire);
    for (size_t k = 0; k < 3; ++k) builder_.Add(wire, edge(triangle[k], triangle[(k + 1) % 3]));
    wire.Closed(true);
    builder_.Add(face, wire);
    return face;
  }

  TopoDS_Edge edge(uint32_t from, uint32_t to) {
    TopoDS_Edge& kept = edges_[std::minmax(from, to)];
    if (kept.IsNull())
      kept = BRepBuilderAPI_MakeEdge(vertex(std::min(from, to)), vertex(std::max(from, to))).Edge();
    return from < to ? kept : TopoDS::Edge(kept.Reversed());
  }

  TopoDS_Vertex vertex(uint32_t number) {
    TopoDS_Vertex& kept = vertices_[number];
    if (kept.IsNull()) builder_.MakeVertex(kept, point_of(mesh_.points[number]), kTolerance);
    return kept;
  }

  const mesh::WeldedMesh& mesh_;
  BRep_Builder builder_;
  std::vector<TopoDS_Vertex> vertices_;
  std::map<std::pair<uint32_t, uint32_t>, TopoDS_Edge> edges_;
};

struct Body {
  TopoDS_Solid solid;
  /// It has cavities, which the library writes with edges only, in four times the bytes.
  bool hollow = false;
};

/// Vertices stay as they are: where sheets touch, each has its own.
mesh::WeldedMesh as_joined(const TriMesh& mesh) {
  mesh::WeldedMesh joined;
  for (const auto& p : mesh.positions) joined.points.emplace_back(p[0], p[1], p[2]);
  joined.triangles = mesh.triangles;
  return joined;
}

double volume_of(const mesh::WeldedMesh& mesh, const mesh::Shell& shell) {
  const Vec3 middle = shell.box.centre();
  double six = 0.0;
  for (const uint32_t facet : shell.facets) {
    const std::array<Vec3, 3> c = mesh::corners_of(mesh, facet);
    six += (c[0] - middle).dot((c[1] - middle).cross(c[2] - middle));
  }
  return six / 6.0;
}

/// The body that a cavity lies in: the smallest that winds around it; null: none.
size_t body_around(const mesh::WeldedMesh& mesh, const std::vector<mesh::Shell>& shells,
                   const std::vector<double>& volumes, size_t cavity) {
  const Vec3 place = mesh::corners_of(mesh, shells[cavity].facets.front())[0];
  size_t found = shells.size();
  for (size_t i = 0; i < shells.size(); ++i) {
    if (volumes[i] <= 0.0 || !mesh::holds(shells[i].box, place)) continue;
    if (mesh::winding(mesh, shells[i], place) < 0.5) continue;
    if (found == shells.size() || volumes[i] < volumes[found]) found = i;
  }
  return found;
}

std::vector<Body> bodies_of(const mesh::WeldedMesh& mesh, const std::string& path) {
  std::vector<mesh::Shell> shells = mesh::shells_of(mesh, mesh::facets_across(mesh.triangles));
  // Where a wall has been thinned to nothing a sheet is left, both of its sides in one place.
  shells.erase(std::remove_if(shells.begin(), shells.end(),
                              [&](const mesh::Shell& shell) {
                                return std::abs(volume_of(mesh, shell)) <=
                                       kSliver * shell.box.size().squaredNorm();
                              }),
               shells.end());
  std::vector<double> volumes;
  for (const mesh::Shell& shell : shells) volumes.push_back(volume_of(mesh, shell));
  ShellBuilder shell_builder(mesh);
  BRep_Builder builder;
  std::vector<Body> bodies(shells.size());
  for (size_t i = 0; i < shells.size(); ++i) {
    if (volumes[i] <= 0.0) continue;
    builder.MakeSolid(bodies[i].solid);
    builder.Add(bodies[i].solid, shell_builder.shell(shells[i].facets));
  }
  for (size_t i = 0; i < shells.size(); ++i) {
    if (volumes[i] > 0.0) continue;
    const size_t around = body_around(mesh, shells, volumes, i);
    if (around == shells.size())
      throw InputError("step-not-closed", {path}, "a shell of the mesh encloses no material",
                       "report this with the run's folder");
    builder.Add(bodies[around].solid, shell_builder.shell(shells[i].facets));
    bodies[around].hollow = true;
  }
  bodies.erase(
      std::remove_if(bodies.begin(), bodies.end(), [](const Body& body) { return body.solid.IsNull(); }),
      bodies.end());
  if (bodies.empty())
    throw InputError("step-empty", {path}, "there is no material to write",
                     "see what the run has left of the stock");
  return bodies;
}

/// The library numbers the products of a process, and would say the hour: files of one part are the same.
void set_header(STEPControl_Writer& writer, const std::string& name) {
  const Handle(StepData_StepModel) model = writer.Model();
  APIHeaderSection_MakeHeader header(model);
  const auto text = [](const std::string& words) { return new TCollection_HAsciiString(words.c_str()); };
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto product = Handle(StepBasic_Product)::DownCast(model->Value(i));
    if (product.IsNull()) continue;
    product->SetId(text(name));
    product->SetName(text(name));
  }
  header.SetName(text(name));
  header.SetDescriptionValue(1, text("finished part, plane triangles"));
  header.SetTimeStamp(text(""));
  header.SetOriginatingSystem(text("swarf"));
  header.SetAuthorValue(1, text(""));
  header.SetOrganizationValue(1, text(""));
}

}  // namespace

void write_step(const std::string& path, const TriMesh& mesh, const std::string& name) {
  if (mesh.triangles.size() > kMostStepTriangles)
    throw InputError("step-too-large", {path},
                     fmt::format("{} triangles are more than the {} that a STEP file is written with",
                                 mesh.triangles.size(), kMostStepTriangles),
                     "allow a larger error (swarf export --error-um), or write --stl or --3mf");
  mesh::WeldedMesh joined = as_joined(mesh);
  mesh::flip_slivers(joined, kSliver);
  NewFile file(path, {"cannot-write-file", "the STEP file cannot be written"});
  QuietSession session;
  guarded(path, [&] {
    STEPControl_Writer writer;
    Interface_Static::SetCVal("write.step.schema", "AP214IS");
    Interface_Static::SetCVal("write.step.unit", "MM");
    for (const Body& body : bodies_of(joined, path)) {
      const auto form = body.hollow ? STEPControl_AsIs : STEPControl_FacetedBrep;
      if (writer.Transfer(body.solid, form) != IFSelect_RetDone)
        file.refuse("the library does not take the mesh: " + session.said());
    }
    set_header(writer, name);
    if (writer.Write(file.temporary().c_str()) != IFSelect_RetDone) file.refuse(session.said());
  });
  file.move_into_place();
}

}  // namespace swarf::brep

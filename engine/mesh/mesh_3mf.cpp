#include "mesh/mesh_3mf.h"

#include <Model/COM/NMR_DLLInterfaces.h>

#include <memory>
#include <vector>

#include "base/check.h"
#include "base/diagnostics.h"

namespace swarf::mesh {
namespace {

struct Release {
  void operator()(NMR::PLib3MFBase* object) const { NMR::lib3mf_release(object); }
};
using Held = std::unique_ptr<NMR::PLib3MFBase, Release>;

void require_3mf(LIB3MFRESULT result, const std::string& path, const char* what) {
  if (result == LIB3MF_OK) return;
  throw InputError("mesh-format", {path},
                   std::string("lib3mf cannot ") + what + ": error " + std::to_string(result),
                   "write .stl, .obj or .ply instead");
}

std::vector<NMR::MODELMESHVERTEX> vertices_of(const TriMesh& mesh) {
  std::vector<NMR::MODELMESHVERTEX> vertices;
  vertices.reserve(mesh.positions.size());
  for (const auto& p : mesh.positions) vertices.push_back({{p[0], p[1], p[2]}});
  return vertices;
}

std::vector<NMR::MODELMESHTRIANGLE> triangles_of(const TriMesh& mesh) {
  std::vector<NMR::MODELMESHTRIANGLE> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.push_back({{t[0], t[1], t[2]}});
  return triangles;
}

}  // namespace

std::string bytes_3mf(const TriMesh& mesh, const std::string& path) {
  using namespace NMR;
  const auto require = [&](LIB3MFRESULT result, const char* what) { require_3mf(result, path, what); };
  PLib3MFModel* model = nullptr;
  require(lib3mf_createmodel(&model), "start");
  const Held held_model(model);
  require(lib3mf_model_setunit(model, MODELUNIT_MILLIMETER), "set the unit");
  PLib3MFModelMeshObject* object = nullptr;
  require(lib3mf_model_addmeshobject(model, &object), "add an object");
  const Held held_object(object);
  std::vector<NMR::MODELMESHVERTEX> vertices = vertices_of(mesh);
  std::vector<NMR::MODELMESHTRIANGLE> triangles = triangles_of(mesh);
  require(lib3mf_meshobject_setgeometry(object, vertices.data(), static_cast<DWORD>(vertices.size()),
                                        triangles.data(), static_cast<DWORD>(triangles.size())),
          "take the mesh");
  require(lib3mf_object_setnameutf8(object, "finished part"), "name the object");
  PLib3MFModelBuildItem* item = nullptr;
  require(lib3mf_model_addbuilditem(model, object, nullptr, &item), "place the object");
  const Held held_item(item);
  PLib3MFModelWriter* writer = nullptr;
  require(lib3mf_model_querywriter(model, "3mf", &writer), "write 3MF");
  const Held held_writer(writer);
  ULONG64 size = 0;
  require(lib3mf_writer_getstreamsize(writer, &size), "measure the file");
  std::string bytes(size, '\0');
  require(lib3mf_writer_writetobuffer(writer, reinterpret_cast<BYTE*>(bytes.data()), size), "write the file");
  return bytes;
}

}  // namespace swarf::mesh

// read_3mf(): build items and components of a 3MF package.
#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <utility>

#include "base/frames.h"
#include "mesh/mesh_3mf.h"
#include "mesh/mesh_source.h"

namespace swarf::mesh {
namespace {

struct Release3mf {
  void operator()(NMR::PLib3MFBase* object) const { NMR::lib3mf_release(object); }
};
using Held3mf = std::unique_ptr<NMR::PLib3MFBase, Release3mf>;
/// Components within components: no program writes more, and a file that says so is one to be refused.
constexpr int kDeepest = 32;

class Reader3mf {
 public:
  explicit Reader3mf(const std::string& path) : path_(path) {}

  TriMesh read() {
    using namespace NMR;
    PLib3MFModel* model = nullptr;
    require(lib3mf_createmodel(&model));
    const Held3mf held(model);
    PLib3MFModelReader* reader = nullptr;
    require(lib3mf_model_queryreader(model, "3mf", &reader));
    const Held3mf held_reader(reader);
    require(lib3mf_reader_readfromfileutf8(reader, path_.c_str()));
    const Eigen::Affine3d to_mm(Eigen::Scaling(unit_of(model)));
    PLib3MFModelBuildItemIterator* items = nullptr;
    require(lib3mf_model_getbuilditems(model, &items));
    const Held3mf held_items(items);
    BOOL more = 0;
    for (require(lib3mf_builditemiterator_movenext(items, &more)); more != 0;
         require(lib3mf_builditemiterator_movenext(items, &more))) {
      PLib3MFModelBuildItem* item = nullptr;
      require(lib3mf_builditemiterator_getcurrent(items, &item));
      const Held3mf held_item(item);
      MODELTRANSFORM place{};
      require(lib3mf_builditem_getobjecttransform(item, &place));
      PLib3MFModelObjectResource* object = nullptr;
      require(lib3mf_builditem_getobjectresource(item, &object));
      const Held3mf held_object(object);
      add(object, to_mm * pose_of(place), 0);
    }
    return std::move(mesh_);
  }

 private:
  void require(LIB3MFRESULT result) const {
    if (result == LIB3MF_OK) return;
    refuse_mesh({path_}, fmt::format("the file is no 3MF package that can be read (lib3mf: error {:#x})",
                                     static_cast<unsigned>(result)));
  }

  double unit_of(NMR::PLib3MFModel* model) const {
    // MICROMETER, MILLIMETER, CENTIMETER, INCH, FOOT, METER
    static constexpr std::array kUnits{1e-3, 1.0, 10.0, 25.4, 304.8, 1000.0};
    DWORD unit = 0;
    require(NMR::lib3mf_model_getunit(model, &unit));
    if (unit >= kUnits.size()) refuse_mesh({path_}, fmt::format("the 3MF package has the unit {}", unit));
    return kUnits.at(unit);
  }

  static Eigen::Affine3d pose_of(const NMR::MODELTRANSFORM& place) {
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) pose(row, column) = place.m_fFields[row][column];
    return pose;
  }

  void add(NMR::PLib3MFModelObjectResource* object, const Eigen::Affine3d& place, int depth) {
    using namespace NMR;
    if (depth > kDeepest) refuse_mesh({path_}, "components stand in components without end");
    BOOL is_mesh = 0;
    require(lib3mf_object_ismeshobject(object, &is_mesh));
    if (is_mesh != 0) return add_mesh(object, place);
    DWORD count = 0;
    require(lib3mf_componentsobject_getcomponentcount(object, &count));
    for (DWORD i = 0; i < count; ++i) {
      PLib3MFModelComponent* component = nullptr;
      require(lib3mf_componentsobject_getcomponent(object, i, &component));
      const Held3mf held(component);
      MODELTRANSFORM own{};
      require(lib3mf_component_gettransform(component, &own));
      PLib3MFModelObjectResource* inner = nullptr;
      require(lib3mf_component_getobjectresource(component, &inner));
      const Held3mf held_inner(inner);
      add(inner, place * pose_of(own), depth + 1);
    }
  }

  void add_mesh(NMR::PLib3MFModelMeshObject* object, const Eigen::Affine3d& place) {
    using namespace NMR;
    DWORD corners = 0, facets = 0;
    require(lib3mf_meshobject_getvertexcount(object, &corners));
    require(lib3mf_meshobject_gettrianglecount(object, &facets));
    if (facets == 0) return;
    std::vector<MODELMESHVERTEX> vertices(corners);
    std::vector<MODELMESHTRIANGLE> triangles(facets);
    require(lib3mf_meshobject_getvertices(object, vertices.data(), corners, nullptr));
    require(lib3mf_meshobject_gettriangleindices(object, triangles.data(), facets, nullptr));
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (const MODELMESHVERTEX& v : vertices) {
      const Vec3 at = place * Vec3(v.m_fPosition[0], v.m_fPosition[1], v.m_fPosition[2]);
      const Eigen::Vector3f p = at.cast<float>();
      mesh_.positions.push_back({p.x(), p.y(), p.z()});
      if (!within_bounds(mesh_.positions.back()))
        refuse_mesh({path_}, fmt::format("a vertex is not finite, or beyond {:g} mm", kFarthest));
    }
    const bool mirrored = place.linear().determinant() < 0.0;
    for (const MODELMESHTRIANGLE& t : triangles) {
      for (const DWORD index : t.m_nIndices)
        if (index >= corners) refuse_mesh({path_}, "a facet names a vertex that is not there");
      std::array<uint32_t, 3> facet{first + t.m_nIndices[0], first + t.m_nIndices[1],
                                    first + t.m_nIndices[2]};
      if (mirrored) std::swap(facet[1], facet[2]);
      mesh_.triangles.push_back(facet);
    }
  }

  const std::string& path_;
  TriMesh mesh_;
};

}  // namespace

TriMesh read_3mf(const std::string& path) {
  return Reader3mf(path).read();
}

}  // namespace swarf::mesh

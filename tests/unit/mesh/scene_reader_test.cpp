// Meshes of scenes: a box of 10 x 20 x 30 mm comes in from every format with its size, its place and its
// outside outside, whatever unit and axis the file counts in.
#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/diagnostics.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "mesh/scene_reader.h"
#include "support/scratch.h"
#include "support/solids.h"

namespace swarf::mesh {
namespace {

namespace fs = std::filesystem;

const Vec3 kLower(1.0, 2.0, 3.0), kSize(10.0, 20.0, 30.0);

TriMesh box_mesh() {
  return test::towers({kLower.x(), kLower.x() + kSize.x()}, {kLower.y(), kLower.y() + kSize.y()}, kLower.z(),
                      [](int, int) { return kLower.z() + kSize.z(); });
}

class SceneReader : public testing::Test {
 protected:
  SceneReader() { fs::create_directories(folder_); }
  ~SceneReader() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string with(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }
  static std::string text_of(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  /// Closed, turned outward, and where it should be, within rounding of floats.
  static void expect_box(const TriMesh& mesh, double slack = 1e-5) {
    EXPECT_EQ(mesh.triangles.size(), 12U);
    EXPECT_EQ(mesh.positions.size(), 8U) << "equal corners are one";
    const Box box = bounds(mesh);
    EXPECT_LT((box.lower - kLower).norm(), slack) << box.lower.transpose();
    EXPECT_LT((box.size() - kSize).norm(), slack) << box.size().transpose();
    EXPECT_NEAR(enclosed_volume(mesh), kSize.prod(), 1e3 * slack) << "its outside is outside";
    Diagnostics diagnostics;
    check_design_mesh(mesh, "box", nullptr, diagnostics, "box");
    EXPECT_FALSE(diagnostics.has_errors());
  }
  std::string refusal(const std::string& path) const {
    try {
      load_mesh(path);
    } catch (const InputError& error) {
      const Diagnostic& first = error.diagnostics.list().at(0);
      EXPECT_EQ(first.code, "mesh-unreadable");
      EXPECT_EQ(first.where.file, path);
      EXPECT_FALSE(first.fix.empty());
      return first.text;
    }
    return "";
  }

 private:
  fs::path folder_ = test::scratch_folder() / "scene_reader";
};

/// Corners and facets of the box, corners in other units and axes.
template <typename Corner, typename Facet>
void each(const Corner& corner, const Facet& facet) {
  const TriMesh box = box_mesh();
  for (const auto& p : box.positions) corner(Vec3(p[0], p[1], p[2]));
  for (const auto& t : box.triangles) facet(t);
}

TEST_F(SceneReader, Off) {
  std::string corners, facets;
  int many = 0;
  each([&](const Vec3& p) { corners += fmt::format("{} {} {}\n", p.x(), p.y(), p.z()), ++many; },
       [&](const auto& t) { facets += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]); });
  expect_box(load_mesh(with("box.off", fmt::format("OFF\n{} 12 0\n{}{}", many, corners, facets))));
}

TEST_F(SceneReader, AmfInEachUnit) {
  for (const auto& [unit, millimetres] :
       {std::pair{"millimeter", 1.0}, {"inch", 25.4}, {"feet", 304.8}, {"meter", 1000.0}, {"micron", 1e-3}}) {
    std::string corners, facets;
    each(
        [&, scale = millimetres](const Vec3& p) {
          corners += fmt::format("<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>\n",
                                 p.x() / scale, p.y() / scale, p.z() / scale);
        },
        [&](const auto& t) {
          facets += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>\n", t[0], t[1], t[2]);
        });
    const std::string head = "<?xml version=\"1.0\"?>\n<amf ";
    const std::string body = ">\n<object id=\"0\"><mesh><vertices>\n" + corners + "</vertices><volume>\n" +
                             facets + "</volume></mesh></object>\n</amf>\n";
    SCOPED_TRACE(unit);
    expect_box(load_mesh(with("box.amf", head + "unit=\"" + unit + "\" version=\"1.1\"" + body)), 1e-4);
    EXPECT_NE(refusal(with("odd.amf", head + "unit='furlong'" + body)).find("furlong"), std::string::npos);
  }
}

/// In inches, Z up, at a node that moves it and mirrors it in X.
TEST_F(SceneReader, ColladaWithUnitUpAxisAndAMirroredNode) {
  std::string numbers, indices;
  int many = 0;
  each(
      [&](const Vec3& p) {
        numbers += fmt::format("{} {} {} ", (5.0 - p.x()) / 25.4, p.y() / 25.4, (p.z() - 7.0) / 25.4);
        ++many;
      },
      [&](const auto& t) { indices += fmt::format("{} {} {} ", t[0], t[2], t[1]); });
  const std::string text = fmt::format(
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="box"><mesh><source id="p"><float_array id="a" count="{0}">{1}</float_array>
<technique_common><accessor source="#a" count="{2}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{3}</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">
<matrix>-1 0 0 {4} 0 1 0 0 0 0 1 {5} 0 0 0 1</matrix><instance_geometry url="#box"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)",
      3 * many, numbers, many, indices, 5.0 / 25.4, 7.0 / 25.4);
  expect_box(load_mesh(with("box.dae", text)));
}

/// A glTF of one mesh: metres, Y up, moved by its node.
std::string glb(const std::string& more = "") {
  std::string binary;
  uint32_t corners = 0;
  each(
      [&](const Vec3& p) {
        // What is Z here is Y there, and Y is -Z.
        for (const double value : {p.x() - 4.0, p.z(), -p.y()}) {
          const auto metres = static_cast<float>(1e-3 * value);
          binary.append(reinterpret_cast<const char*>(&metres), sizeof metres);
        }
        ++corners;
      },
      [&](const auto& t) { binary.append(reinterpret_cast<const char*>(t.data()), sizeof t); });
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}}{0},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,)"
      R"("translation":[0.004,0,0]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},)"
      R"("indices":1}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":{1},"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5125,"count":36,"type":"SCALAR"}}],"bufferViews":[{{"buffer":0,)"
      R"("byteLength":{2}}},{{"buffer":0,"byteOffset":{2},"byteLength":144}}],"buffers":[{{"byteLength":{3}}}]}})",
      more, corners, 12 * corners, binary.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  const auto put = [&](uint32_t value) { bytes.append(reinterpret_cast<const char*>(&value), 4); };
  put(2), put(static_cast<uint32_t>(28 + json.size() + binary.size())),
      put(static_cast<uint32_t>(json.size()));
  bytes += "JSON" + json;
  put(static_cast<uint32_t>(binary.size()));
  return bytes + std::string("BIN\0", 4) + binary;
}

TEST_F(SceneReader, GltfInMetresWithYUp) {
  expect_box(load_mesh(with("box.glb", glb())));
}

TEST_F(SceneReader, GltfOfQuantisedOrCompressedNumbersIsRefused) {
  const std::string text =
      refusal(with("box.glb", glb(R"(,"extensionsRequired":["KHR_mesh_quantization"])")));
  EXPECT_NE(text.find("KHR_mesh_quantization"), std::string::npos) << text;
}

TEST_F(SceneReader, GltfWithItsNumbersElsewhereIsRefused) {
  const std::string text = refusal(
      with("box.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"box.bin","byteLength":8}]})"));
  EXPECT_NE(text.find("another file"), std::string::npos) << text;
}

TEST_F(SceneReader, ThreeMfAsWrittenAndInInches) {
  save_mesh(file("box.3mf"), box_mesh());
  expect_box(load_mesh(file("box.3mf")));
  // In inches, at half the place, moved by its build item.
  NMR::PLib3MFModel* model = nullptr;
  ASSERT_EQ(NMR::lib3mf_createmodel(&model), LIB3MF_OK);
  ASSERT_EQ(NMR::lib3mf_model_setunit(model, NMR::MODELUNIT_INCH), LIB3MF_OK);
  NMR::PLib3MFModelMeshObject* object = nullptr;
  ASSERT_EQ(NMR::lib3mf_model_addmeshobject(model, &object), LIB3MF_OK);
  std::vector<NMR::MODELMESHVERTEX> corners;
  std::vector<NMR::MODELMESHTRIANGLE> facets;
  each(
      [&](const Vec3& p) {
        corners.push_back({{static_cast<float>((p.x() - 4.0) / 25.4), static_cast<float>(p.y() / 25.4),
                            static_cast<float>(p.z() / 25.4)}});
      },
      [&](const auto& t) {
        facets.push_back({{t[0], t[1], t[2]}});
      });
  // As save_mesh() leaves it: its corners are one where they are equal, which 3MF asks for.
  ASSERT_EQ(NMR::lib3mf_meshobject_setgeometry(object, corners.data(), static_cast<DWORD>(corners.size()),
                                               facets.data(), static_cast<DWORD>(facets.size())),
            LIB3MF_OK);
  NMR::MODELTRANSFORM moved{};
  for (int k = 0; k < 3; ++k) moved.m_fFields[k][k] = 1.0F;
  moved.m_fFields[0][3] = static_cast<float>(4.0 / 25.4);
  NMR::PLib3MFModelBuildItem* item = nullptr;
  ASSERT_EQ(NMR::lib3mf_model_addbuilditem(model, object, &moved, &item), LIB3MF_OK);
  NMR::PLib3MFModelWriter* writer = nullptr;
  ASSERT_EQ(NMR::lib3mf_model_querywriter(model, "3mf", &writer), LIB3MF_OK);
  ASSERT_EQ(NMR::lib3mf_writer_writetofileutf8(writer, file("inch.3mf").c_str()), LIB3MF_OK);
  for (auto* held : {static_cast<NMR::PLib3MFBase*>(writer), static_cast<NMR::PLib3MFBase*>(item),
                     static_cast<NMR::PLib3MFBase*>(object), static_cast<NMR::PLib3MFBase*>(model)})
    NMR::lib3mf_release(held);
  expect_box(load_mesh(file("inch.3mf")), 1e-4);  // the file has six decimals of an inch
}

/// As assimp itself writes it, counted in centimetres, then with the unit of the file changed to inches.
TEST_F(SceneReader, FbxByItsUnit) {
  save_mesh(file("box.obj"), box_mesh());
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(file("box.obj"), 0);
  ASSERT_NE(scene, nullptr);
  Assimp::Exporter exporter;
  ASSERT_EQ(exporter.Export(scene, "fbxa", file("box.fbx")), aiReturn_SUCCESS) << exporter.GetErrorString();
  const std::string text = text_of(file("box.fbx"));
  const Box box = bounds(load_mesh(file("box.fbx")));
  const std::string key = "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",";
  const size_t at = text.find(key);
  ASSERT_NE(at, std::string::npos);
  const size_t end = text.find('\n', at);
  const double centimetres = std::stod(text.substr(at + key.size(), end - at));
  const std::string inches = text.substr(0, at) + key + "2.54" + text.substr(end);
  const Box turned = bounds(load_mesh(with("inch.fbx", inches)));
  // Y is up in the file: what was Y is Z here, what was Z is -Y.
  const Vec3 size(kSize.x(), kSize.z(), kSize.y());
  EXPECT_LT((box.size() - 10.0 * centimetres * size).norm(), 1e-3) << box.size().transpose();
  EXPECT_LT((turned.size() - 25.4 * size).norm(), 1e-2) << turned.size().transpose();
}

TEST_F(SceneReader, DamagedFilesAreRefused) {
  const std::string whole = glb();
  for (const char* ending : {"glb", "gltf", "dae", "fbx", "3mf", "amf", "off"}) {
    SCOPED_TRACE(ending);
    EXPECT_NE(refusal(with(std::string("empty.") + ending, "")), "");
    EXPECT_NE(refusal(with(std::string("text.") + ending, "not a mesh\n")), "");
    EXPECT_NE(refusal(with(std::string("other.") + ending, std::string(300, '\x7f'))), "");
  }
  for (size_t length = 4; length < whole.size(); length += 37)
    EXPECT_NE(refusal(with("cut.glb", whole.substr(0, length))), "") << length;
}

TEST_F(SceneReader, EndingsAreNamedAndStepIsNone) {
  EXPECT_TRUE(is_scene_ending(".glb"));
  EXPECT_FALSE(is_scene_ending(".step") || is_scene_ending(".stl"));
  EXPECT_NE(scene_endings().find(".3mf"), std::string::npos);
}

}  // namespace
}  // namespace swarf::mesh

// Our glTF as another library reads it: assimp finds the same nodes under the same names, the same triangles,
// and in metres with Y up the same places.
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <limits>

#include "render/gltf/gltf_writer.h"
#include "support/solids.h"

namespace swarf::render {
namespace {

/// Of all meshes below a node, in the file's frame.
struct Read {
  size_t triangles = 0;
  aiVector3D lower{std::numeric_limits<float>::max()}, upper{std::numeric_limits<float>::lowest()};
};

void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, Read& read) {
  const aiMatrix4x4 place = parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    read.triangles += mesh.mNumFaces;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = place * mesh.mVertices[v];
      for (unsigned k = 0; k < 3; ++k) {
        read.lower[k] = std::min(read.lower[k], p[k]);
        read.upper[k] = std::max(read.upper[k], p[k]);
      }
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add(scene, *node.mChildren[i], place, read);
}

TEST(GltfAssimp, ReadsWhatWasWritten) {
  const TriMesh table = test::block({-50, -40, -10}, {50, 40, 0}),
                work = test::block({0, 0, 0}, {10, 20, 30});
  Pose moved = Pose::Identity();
  moved.translation() = Vec3(5, -7, 0);
  GltfScene scene;
  scene.nodes = {{"table X", &table, {}, -1, {}, {}}, {"the work, \"clamped\"", &work, {}, 0, {}, {moved}}};
  const std::string bytes = glb_bytes(scene, GltfEncoding::kFloat);
  Assimp::Importer importer;
  const aiScene* const read = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "glb");
  ASSERT_NE(read, nullptr) << importer.GetErrorString();
  const aiNode* const parent = read->mRootNode->FindNode("table X");
  const aiNode* const child = read->mRootNode->FindNode("the work, \"clamped\"");
  ASSERT_TRUE(parent != nullptr && child != nullptr);
  EXPECT_EQ(child->mParent, parent);
  Read all;
  add(*read, *read->mRootNode, aiMatrix4x4(), all);
  EXPECT_EQ(all.triangles, table.triangles.size() + work.triangles.size());
  // Z is Y there, Y is -Z; metres.
  const aiVector3D lower(-0.05F, -0.01F, -0.04F), upper(0.05F, 0.03F, 0.04F);
  EXPECT_LT((all.lower - lower).Length(), 1e-7F);
  EXPECT_LT((all.upper - upper).Length(), 1e-7F);
}

}  // namespace
}  // namespace swarf::render

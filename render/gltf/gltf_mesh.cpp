#include "render/gltf/gltf_mesh.h"

#include <algorithm>
#include <cmath>

#include "mesh/mesh_ops.h"
#include "render/figures/colour.h"

namespace swarf::render {
namespace {

constexpr int kVertices = TINYGLTF_TARGET_ARRAY_BUFFER;

/// The normal at unit length, as the format demands; interpolation and float rounding leave it near that.
Vec3 unit_normal(const std::array<float, 3>& normal) {
  const Vec3 n(normal[0], normal[1], normal[2]);
  return n.squaredNorm() > 0.0 ? Vec3(n.normalized()) : Vec3::UnitZ();
}

/// sRGB bytes to linear bytes.
std::vector<std::array<uint8_t, 4>> linear_colours(const std::vector<std::array<uint8_t, 4>>& colours) {
  std::vector<std::array<uint8_t, 4>> out(colours.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const Rgb linear = linear_from_srgb8(colours[i]);
    for (size_t k = 0; k < 3; ++k) out[i][k] = static_cast<uint8_t>(std::lround(255.0F * linear[k]));
    out[i][3] = colours[i][3];
  }
  return out;
}

Box bounds_of_points(std::span<const std::array<float, 3>> points) {
  TriMesh mesh;
  mesh.positions.assign(points.begin(), points.end());
  return mesh::bounds(mesh);
}

}  // namespace

tinygltf::Value extras_value(const GltfExtras& extras) {
  tinygltf::Value::Object object;
  for (const auto& [key, value] : extras)
    object[key] = std::visit([](const auto& v) { return tinygltf::Value(v); }, value);
  return tinygltf::Value(object);
}

std::optional<PositionGrid> GltfMeshes::grid_of(const Box& box) {
  if (!quantised_) return std::nullopt;
  const PositionGrid grid(box);
  position_error_mm_ = std::max(position_error_mm_, grid.error_mm());
  return grid;
}

int GltfMeshes::positions(std::span<const std::array<float, 3>> points,
                          const std::optional<PositionGrid>& grid) {
  if (!grid) return buffer_.floats<3>(points, true, kVertices);
  std::vector<std::array<uint16_t, 4>> steps;
  steps.reserve(points.size());
  for (const std::array<float, 3>& point : points) {
    const std::array<uint16_t, 3> at = grid->at(point);
    steps.push_back({at[0], at[1], at[2], 0});
  }
  return buffer_.grid_positions(steps);
}

int GltfMeshes::normals(const std::vector<std::array<float, 3>>& normals) {
  if (!quantised_) {
    std::vector<std::array<float, 3>> units;
    units.reserve(normals.size());
    for (const auto& normal : normals) {
      const Eigen::Vector3f n = unit_normal(normal).cast<float>();
      units.push_back({n.x(), n.y(), n.z()});
    }
    return buffer_.floats<3>(units, false, kVertices);
  }
  constexpr double kOne = 32767.0;  // of a normalised signed short
  std::vector<std::array<int16_t, 4>> shorts;
  shorts.reserve(normals.size());
  for (const auto& normal : normals) {
    const Vec3 n = kOne * unit_normal(normal);
    const auto rounded = [](double value) { return static_cast<int16_t>(std::lround(value)); };
    shorts.push_back({rounded(n.x()), rounded(n.y()), rounded(n.z()), 0});
  }
  return buffer_.short_normals(shorts);
}

void GltfMeshes::add_deviation(const TriMesh& mesh, tinygltf::Primitive& primitive) {
  const std::vector<float>& values = mesh.deviation_um;
  const std::optional<double> step = quantised_ ? scalar_step(values) : std::nullopt;
  if (!step) {
    const auto* scalars = reinterpret_cast<const std::array<float, 1>*>(values.data());
    primitive.attributes["_DEVIATION_UM"] =
        buffer_.floats<1>(std::span(scalars, values.size()), false, kVertices);
    return;
  }
  std::vector<std::array<int16_t, 2>> steps;
  steps.reserve(values.size());
  for (const float value : values) steps.push_back({static_cast<int16_t>(std::lround(value / *step)), 0});
  primitive.attributes["_DEVIATION"] = buffer_.short_scalars(steps);
  primitive.extras = extras_value({{"deviation_um_per_unit", *step}});
}

tinygltf::Primitive GltfMeshes::triangles(const TriMesh& mesh, const std::optional<PositionGrid>& grid) {
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = positions(mesh.positions, grid);
  if (!mesh.normals.empty()) primitive.attributes["NORMAL"] = normals(mesh.normals);
  if (!mesh.colours.empty()) primitive.attributes["COLOR_0"] = buffer_.colours(linear_colours(mesh.colours));
  if (!mesh.deviation_um.empty()) add_deviation(mesh, primitive);
  const std::span indices(mesh.triangles.front().data(), 3 * mesh.triangles.size());
  primitive.indices = buffer_.indices(indices, mesh.positions.size());
  return primitive;
}

int GltfMeshes::add_mesh(const std::string& name, tinygltf::Primitive primitive) {
  tinygltf::Mesh mesh;
  mesh.name = name;
  mesh.primitives.push_back(std::move(primitive));
  model_.meshes.push_back(std::move(mesh));
  return static_cast<int>(model_.meshes.size()) - 1;
}

GltfMeshes::Placed GltfMeshes::of_node(const GltfNode& node) {
  if (node.mesh == nullptr || node.mesh->triangles.empty()) return {};
  const Material& m = node.material;
  const auto [place, is_new] = meshes_.try_emplace({node.mesh, m.colour, m.metalness, m.roughness});
  if (!is_new) return place->second;
  TriMesh ordered;
  const TriMesh* mesh = node.mesh;
  if (quantised_) {  // neighbours beside each other: what compresses well and draws fast
    ordered = *node.mesh;
    mesh::order_for_display(ordered);
    mesh = &ordered;
  }
  Placed placed;
  placed.grid = grid_of(node.grid.value_or(mesh::bounds(*mesh)));
  tinygltf::Primitive primitive = triangles(*mesh, placed.grid);
  primitive.material = material_of(node.name, m, !mesh->colours.empty());
  placed.mesh = add_mesh(node.name, std::move(primitive));
  place->second = placed;
  return placed;
}

int GltfMeshes::material_of(const std::string& name, const Material& material, bool vertex_colours) {
  tinygltf::Material out;
  out.name = name;
  const Rgb base = vertex_colours ? Rgb{1.0F, 1.0F, 1.0F} : material.colour;
  out.pbrMetallicRoughness.baseColorFactor = {base[0], base[1], base[2], 1.0};
  out.pbrMetallicRoughness.metallicFactor = material.metalness;
  out.pbrMetallicRoughness.roughnessFactor = material.roughness;
  out.doubleSided = true;  // an open surface is seen from behind too
  model_.materials.push_back(std::move(out));
  return static_cast<int>(model_.materials.size()) - 1;
}

int GltfMeshes::unlit_material(const std::string& name, const Rgb& colour) {
  tinygltf::Material material;
  material.name = name;
  material.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1.0};
  material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
  model_.materials.push_back(std::move(material));
  return static_cast<int>(model_.materials.size()) - 1;
}

GltfMeshes::Placed GltfMeshes::of_lines(const std::string& name, const Rgb& colour, const LineGroup& group) {
  const std::optional<PositionGrid> grid = grid_of(bounds_of_points(group.points));
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_LINE;
  primitive.attributes["POSITION"] = positions(group.points, grid);
  primitive.indices = buffer_.indices(group.segments, group.points.size());
  primitive.material = unlit_material(name, colour);
  return {add_mesh(name, std::move(primitive)), grid};
}

GltfMeshes::Placed GltfMeshes::of_path(const GltfPath& path) {
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_LINE_STRIP;
  primitive.attributes["POSITION"] = positions(path.points, std::nullopt);
  if (!path.colours.empty()) primitive.attributes["COLOR_0"] = buffer_.colours(linear_colours(path.colours));
  for (const auto& [name, values] : path.numbers) {
    const auto* scalars = reinterpret_cast<const std::array<float, 1>*>(values.data());
    primitive.attributes[name] = buffer_.floats<1>(std::span(scalars, values.size()), false, kVertices);
  }
  primitive.material = unlit_material(path.name, {1.0F, 1.0F, 1.0F});
  return {add_mesh(path.name, std::move(primitive)), std::nullopt};
}

}  // namespace swarf::render

#include "render/gltf/gltf_buffer.h"

#include <algorithm>
#include <limits>

namespace swarf::render {

int GltfBuffer::add(const void* data, size_t bytes, size_t count, int component, int type, int target) {
  constexpr size_t kAlignment = 4;
  std::vector<unsigned char>& buffer = model_.buffers[0].data;
  buffer.resize((buffer.size() + kAlignment - 1) / kAlignment * kAlignment);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = buffer.size();
  view.byteLength = bytes;
  view.target = target;
  const auto* first = static_cast<const unsigned char*>(data);
  buffer.insert(buffer.end(), first, first + bytes);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model_.bufferViews.size());
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count;
  model_.bufferViews.push_back(std::move(view));
  model_.accessors.push_back(std::move(accessor));
  return static_cast<int>(model_.accessors.size()) - 1;
}

int GltfBuffer::add_padded(const void* data, size_t bytes, size_t count, int component, int type) {
  const int accessor = add(data, bytes, count, component, type, TINYGLTF_TARGET_ARRAY_BUFFER);
  model_.bufferViews.back().byteStride = bytes / count;
  return accessor;
}

template <typename Number>
void GltfBuffer::set_bounds(int accessor, const Number* values, size_t count, size_t components,
                            size_t stride) {
  tinygltf::Accessor& target = model_.accessors[static_cast<size_t>(accessor)];
  target.minValues.assign(components, std::numeric_limits<double>::infinity());
  target.maxValues.assign(components, -std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < count; ++i) {
    for (size_t k = 0; k < components; ++k) {
      const auto value = static_cast<double>(values[i * stride + k]);
      target.minValues[k] = std::min(target.minValues[k], value);
      target.maxValues[k] = std::max(target.maxValues[k], value);
    }
  }
}

void GltfBuffer::set_bounds(int accessor, const float* values, size_t count, size_t components) {
  set_bounds(accessor, values, count, components, components);
}

int GltfBuffer::grid_positions(std::span<const std::array<uint16_t, 4>> values) {
  const int accessor = add_padded(values.data(), values.size_bytes(), values.size(),
                                  TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC3);
  set_bounds(accessor, values.front().data(), values.size(), 3, 4);
  return accessor;
}

int GltfBuffer::short_normals(std::span<const std::array<int16_t, 4>> values) {
  const int accessor = add_padded(values.data(), values.size_bytes(), values.size(),
                                  TINYGLTF_COMPONENT_TYPE_SHORT, TINYGLTF_TYPE_VEC3);
  model_.accessors[static_cast<size_t>(accessor)].normalized = true;
  return accessor;
}

int GltfBuffer::short_scalars(std::span<const std::array<int16_t, 2>> values) {
  return add_padded(values.data(), values.size_bytes(), values.size(), TINYGLTF_COMPONENT_TYPE_SHORT,
                    TINYGLTF_TYPE_SCALAR);
}

int GltfBuffer::colours(std::span<const std::array<uint8_t, 4>> values) {
  const int accessor =
      add(values.data(), values.size_bytes(), values.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
          TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER);
  model_.accessors[accessor].normalized = true;
  return accessor;
}

int GltfBuffer::indices(std::span<const uint32_t> values, size_t vertices) {
  // The largest 16-bit value is reserved for primitive restart.
  if (vertices >= std::numeric_limits<uint16_t>::max()) {
    return add(values.data(), values.size_bytes(), values.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
               TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  }
  std::vector<uint16_t> narrow(values.begin(), values.end());
  return add(narrow.data(), narrow.size() * sizeof(uint16_t), narrow.size(),
             TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR,
             TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
}

}  // namespace swarf::render

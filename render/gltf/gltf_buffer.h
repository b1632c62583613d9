// The one binary buffer of a .glb and the accessors into it.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <span>
#include <vector>

namespace swarf::render {

/// Appends arrays to buffer 0 of a model, each at a multiple of four bytes with a view and an accessor of its
/// own.
class GltfBuffer {
 public:
  explicit GltfBuffer(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

  /// Vectors of N floats; `bounds`: write min and max (positions and animation times need them).
  template <size_t N>
  int floats(std::span<const std::array<float, N>> values, bool bounds, int target) {
    const int accessor = add(values.data(), values.size_bytes(), values.size(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                             kTypes[N], target);
    if (bounds) set_bounds(accessor, values.front().data(), values.size(), N);
    return accessor;
  }
  /// Positions on a grid: three numbers and one of padding, since vertices stand at multiples of four bytes.
  int grid_positions(std::span<const std::array<uint16_t, 4>> values);
  /// Unit vectors as normalised 16-bit numbers, padded as positions are.
  int short_normals(std::span<const std::array<int16_t, 4>> values);
  /// Scalars of 16 bits, padded to four bytes.
  int short_scalars(std::span<const std::array<int16_t, 2>> values);
  /// Normalised 8-bit colours.
  int colours(std::span<const std::array<uint8_t, 4>> values);
  /// Indices as 16 bits when all vertices fit, else as 32.
  int indices(std::span<const uint32_t> values, size_t vertices);

 private:
  static constexpr std::array<int, 5> kTypes{0, TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3,
                                             TINYGLTF_TYPE_VEC4};
  int add(const void* data, size_t bytes, size_t count, int component, int type, int target);
  /// Vertices that take more bytes than their numbers.
  int add_padded(const void* data, size_t bytes, size_t count, int component, int type);
  template <typename Number>
  void set_bounds(int accessor, const Number* values, size_t count, size_t components, size_t stride);
  void set_bounds(int accessor, const float* values, size_t count, size_t components);

  tinygltf::Model& model_;
};

}  // namespace swarf::render

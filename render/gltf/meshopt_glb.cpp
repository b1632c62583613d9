#include "render/gltf/meshopt_glb.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/check.h"

namespace swarf::render {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kExtension = "EXT_meshopt_compression";
constexpr int kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125;

/// Header and two chunks: JSON, then the binary buffer. Each is padded to four bytes.
struct Container {
  Json json;
  std::string binary;
};

uint32_t word_at(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

constexpr size_t kHeader = 12, kChunkHeader = 8;
constexpr uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

Container read_container(const std::string& glb) {
  SWARF_CHECK(glb.size() > kHeader + kChunkHeader && word_at(glb, 0) == kMagic, "no .glb");
  const size_t length = word_at(glb, kHeader);
  Container out;
  out.json = Json::parse(glb.substr(kHeader + kChunkHeader, length));
  const size_t next = kHeader + kChunkHeader + length;
  if (next + kChunkHeader <= glb.size()) out.binary = glb.substr(next + kChunkHeader, word_at(glb, next));
  return out;
}

void append_word(std::string& bytes, size_t value) {
  const auto word = static_cast<uint32_t>(value);
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

void pad(std::string& bytes, char with) {
  while (bytes.size() % 4 != 0) bytes += with;
}

std::string write_container(Container container) {
  std::string json = container.json.dump();
  pad(json, ' ');
  pad(container.binary, '\0');
  std::string out;
  append_word(out, kMagic);
  append_word(out, 2);
  append_word(out, kHeader + 2 * kChunkHeader + json.size() + container.binary.size());
  append_word(out, json.size());
  append_word(out, kJsonChunk);
  out += json;
  append_word(out, container.binary.size());
  append_word(out, kBinaryChunk);
  return out + container.binary;
}

enum class Mode { kAttributes, kTriangles, kIndices };
constexpr std::array<const char*, 3> kModeNames{"ATTRIBUTES", "TRIANGLES", "INDICES"};

/// By accessor.
std::vector<Mode> modes_of(const Json& json) {
  std::vector<Mode> modes(json.at("accessors").size(), Mode::kAttributes);
  if (!json.contains("meshes")) return modes;
  constexpr int kTriangles = 4;
  for (const Json& mesh : json.at("meshes"))
    for (const Json& primitive : mesh.at("primitives"))
      if (primitive.contains("indices"))
        modes[primitive.at("indices").get<size_t>()] =
            primitive.value("mode", kTriangles) == kTriangles ? Mode::kTriangles : Mode::kIndices;
  return modes;
}

size_t components_of(const std::string& type) {
  return type == "SCALAR" ? 1 : static_cast<size_t>(type.back() - '0');
}

std::string encoded_indices(const std::string& raw, size_t count, size_t size, bool triangles) {
  std::vector<uint32_t> indices(count);
  for (size_t i = 0; i < count; ++i) std::memcpy(&indices[i], raw.data() + i * size, size);
  uint32_t last = 0;
  for (const uint32_t index : indices) last = std::max(last, index);
  const size_t vertices = size_t{last} + 1;
  std::vector<unsigned char> out(triangles ? meshopt_encodeIndexBufferBound(count, vertices)
                                           : meshopt_encodeIndexSequenceBound(count, vertices));
  out.resize(triangles ? meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), count)
                       : meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), count));
  return {out.begin(), out.end()};
}

std::string encoded_vertices(const std::string& raw, size_t count, size_t stride) {
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), raw.data(), count, stride));
  return {out.begin(), out.end()};
}

/// Normalised shorts, four to a vertex, as the octahedral filter wants them.
std::string octahedral(const std::string& raw, size_t count) {
  constexpr float kOne = 32767.0F;
  std::vector<int16_t> shorts(4 * count);
  std::memcpy(shorts.data(), raw.data(), shorts.size() * sizeof(int16_t));
  std::vector<float> floats(shorts.begin(), shorts.end());
  for (float& value : floats) value /= kOne;
  std::string out(4 * count * sizeof(int16_t), '\0');
  meshopt_encodeFilterOct(out.data(), count, 4 * sizeof(int16_t), kNormalBits, floats.data());
  return out;
}

/// Rewrites one buffer view, which has one accessor, and appends its encoded bytes.
void encode_view(Json& view, const Json& accessor, Mode mode, const std::string& binary,
                 std::string& encoded) {
  const auto offset = view.value("byteOffset", size_t{0}), length = view.at("byteLength").get<size_t>();
  const auto count = accessor.at("count").get<size_t>();
  const int component = accessor.at("componentType").get<int>();
  const std::string raw = binary.substr(offset, length);
  const size_t stride = view.value("byteStride", length / count);
  Json told{{"buffer", 0}, {"byteOffset", encoded.size()}};
  std::string bytes;
  if (mode == Mode::kAttributes) {
    const bool normals = component == kShort && accessor.value("normalized", false) &&
                         components_of(accessor.at("type").get<std::string>()) == 3;
    bytes = encoded_vertices(normals ? octahedral(raw, count) : raw, count, stride);
    if (normals) told["filter"] = "OCTAHEDRAL";
  } else {
    SWARF_CHECK(component == kUnsignedShort || component == kUnsignedInt, "indices of another type");
    bytes = encoded_indices(raw, count, stride, mode == Mode::kTriangles);
  }
  told["byteLength"] = bytes.size();
  told["byteStride"] = stride;
  told["mode"] = kModeNames.at(static_cast<size_t>(mode));
  told["count"] = count;
  view["buffer"] = 1;
  view["extensions"][kExtension] = std::move(told);
  encoded += bytes;
  pad(encoded, '\0');
}

/// What the extension's readers know; of the whole process, so that it is set once.
void choose_versions() {
  static const bool chosen = [] {
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
    return true;
  }();
  static_cast<void>(chosen);
}

}  // namespace

std::string meshopt_compressed(const std::string& glb) {
  Container container = read_container(glb);
  Json& json = container.json;
  if (!json.contains("accessors") || json.at("accessors").empty()) return glb;
  choose_versions();
  const std::vector<Mode> modes = modes_of(json);
  std::string encoded;
  const Json& accessors = json.at("accessors");
  for (size_t i = 0; i < accessors.size(); ++i) {
    const Json accessor = accessors.at(i);
    encode_view(json.at("bufferViews").at(accessor.at("bufferView").get<size_t>()), accessor, modes[i],
                container.binary, encoded);
  }
  Json fallback{{"byteLength", container.binary.size()}};
  fallback["extensions"][kExtension]["fallback"] = true;
  json["buffers"] = Json::array({Json{{"byteLength", encoded.size()}}, std::move(fallback)});
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) json[list].push_back(kExtension);
  container.binary = std::move(encoded);
  return write_container(std::move(container));
}

}  // namespace swarf::render

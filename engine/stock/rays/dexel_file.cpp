// Files of surface dexels: a header, heights, blocks, material above gaps, and a checksum of it all.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "base/file.h"
#include "base/hash.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::stock {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMagic = 0x32737961726677ULL;  // "wfrays2"

struct Header {
  uint64_t magic, rays, above, design;
  double pitch_mm, chord_mm;
};

/// Material above a gap, by the place of its ray in RayField::order.
struct StoredAbove {
  uint64_t place;
  double low, high;
  uint32_t low_block, high_block;
};

/// Identifies the design and the rays on it: equal points and normals, equal hash.
uint64_t design_hash(const RayField& field) {
  Hash hash;
  for (const auto* vectors : {&field.points, &field.normals}) {
    for (const Vec3& v : *vectors) {
      for (int a = 0; a < 3; ++a) hash.add(v[a]);
    }
  }
  return hash.value();
}

/// What a file holds.
struct Content {
  Header header{};
  std::vector<double> heights;
  std::vector<uint32_t> blocks;
  std::vector<StoredAbove> above;

  uint64_t checksum() const {
    Hash hash;
    for (const uint64_t word : {header.rays, header.above, header.design}) hash.add(word);
    hash.add(header.pitch_mm);
    hash.add(header.chord_mm);
    for (const double height : heights) hash.add(height);
    for (const uint32_t block : blocks) hash.add(uint64_t{block});
    for (const StoredAbove& m : above) {
      hash.add(m.place);
      hash.add(m.low);
      hash.add(m.high);
      hash.add(uint64_t{m.low_block} << 32U | m.high_block);
    }
    return hash.value();
  }
};

template <class T>
std::string_view bytes_of(const T* data, size_t count) {
  return {reinterpret_cast<const char*>(data), count * sizeof(T)};
}
template <class T>
void get(std::istream& in, T* data, size_t count) {
  in.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
}

[[noreturn]] void refuse(const std::string& code, const std::string& path, const std::string& text) {
  throw InputError(code, {path, 0, 0}, text, "run the scene again to write it");
}

Header read_header(std::istream& in, const std::string& path) {
  if (!in) refuse("rays-file-unreadable", path, "the file of surface rays cannot be read");
  Header header{};
  get(in, &header, 1);
  if (!in || header.magic != kMagic) refuse("rays-file-damaged", path, "this is no file of surface rays");
  std::error_code error;
  const uint64_t size = fs::file_size(path, error);
  constexpr uint64_t kRay = sizeof(double) + sizeof(uint32_t);
  const bool sane = header.rays <= size / kRay && header.above <= size / sizeof(StoredAbove) &&
                    header.pitch_mm > 0.0 && header.chord_mm >= 0.0;
  const uint64_t needed =
      sizeof(Header) + header.rays * kRay + header.above * sizeof(StoredAbove) + sizeof(uint64_t);
  if (!sane || error || size != needed) {
    refuse("rays-file-damaged", path, fmt::format("the file of surface rays is cut off at {} bytes", size));
  }
  return header;
}

Content read_content(const std::string& path) {
  refuse_special_file(path);
  std::ifstream in(path, std::ios::binary);
  Content content{read_header(in, path), {}, {}, {}};
  content.heights.resize(content.header.rays);
  content.blocks.resize(content.header.rays);
  content.above.resize(content.header.above);
  uint64_t sum = 0;
  get(in, content.heights.data(), content.heights.size());
  get(in, content.blocks.data(), content.blocks.size());
  get(in, content.above.data(), content.above.size());
  get(in, &sum, 1);
  if (!in || sum != content.checksum()) {
    refuse("rays-file-damaged", path, "the checksum of the surface rays does not match their content");
  }
  return content;
}

/// The intervals by tile. What the checksum has passed was written by save(): order and range hold.
std::vector<std::vector<MaterialAbove>> by_tile(const std::vector<StoredAbove>& above,
                                                const RayField& field) {
  std::vector<std::vector<MaterialAbove>> tiles(field.tiles.size());
  size_t tile = 0;
  for (const StoredAbove& m : above) {
    while (m.place >= field.tiles[tile].begin + field.tiles[tile].count) ++tile;
    const auto ray = static_cast<uint32_t>(m.place - field.tiles[tile].begin);
    tiles[tile].push_back({ray, m.low_block, m.high_block, m.low, m.high});
  }
  return tiles;
}

}  // namespace

void SurfaceDexels::save(const std::string& path) const {
  Content content{{kMagic, heights_.size(), 0, design_hash(*field_), field_->pitch_mm, field_->chord_mm},
                  heights_,
                  blocks_,
                  {}};
  for (size_t tile = 0; tile < above_.size(); ++tile) {
    for (const MaterialAbove& m : above_[tile]) {
      content.above.push_back(
          {uint64_t{field_->tiles[tile].begin} + m.ray, m.low, m.high, m.low_block, m.high_block});
    }
  }
  content.header.above = content.above.size();
  const uint64_t sum = content.checksum();
  NewFile file(path, {"rays-file-unwritable", "the file of surface rays cannot be written"});
  file.write(bytes_of(&content.header, 1));
  file.write(bytes_of(content.heights.data(), content.heights.size()));
  file.write(bytes_of(content.blocks.data(), content.blocks.size()));
  file.write(bytes_of(content.above.data(), content.above.size()));
  file.write(bytes_of(&sum, 1));
  file.move_into_place();
}

SurfaceDexels SurfaceDexels::load(const std::string& path, const surface::SurfacePtr& surface) {
  const Header header = read_content(path).header;
  if (!(header.chord_mm > 0.0)) refuse("rays-file-other-surface", path, "the rays were measured on a mesh");
  return load(path, rays_on_surface(surface, header.pitch_mm, header.chord_mm));
}

SurfaceDexels SurfaceDexels::load(const std::string& path, RayFieldPtr field) {
  Content content = read_content(path);
  if (content.header.rays != field->size() || design_hash(*field) != content.header.design) {
    refuse("rays-file-other-surface", path, "the rays were measured on another design");
  }
  SurfaceDexels dexels(std::move(field));
  dexels.heights_ = std::move(content.heights);
  dexels.blocks_ = std::move(content.blocks);
  dexels.above_ = by_tile(content.above, *dexels.field_);
  return dexels;
}

}  // namespace swarf::stock

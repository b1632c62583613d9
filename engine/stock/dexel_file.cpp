// Files of surface dexels: a header, heights, blocks, and a checksum of it all.
#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/diagnostics.h"
#include "base/hash.h"
#include "stock/surface_dexels.h"

namespace swarf::stock {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMagic = 0x31737961726677ULL;  // "wfrays1"
/// A grid larger than this on a side comes from a damaged file.
constexpr uint64_t kMostRays = 1u << 20;

struct Header {
  uint64_t magic, nu, nv, surface;
};

/// Identifies the surface and the grid on it: equal points and normals, equal hash.
uint64_t surface_hash(const SurfaceDexels& dexels) {
  Hash hash;
  for (const auto* vectors : {&dexels.points(), &dexels.normals()}) {
    for (const Vec3& v : *vectors) {
      for (int a = 0; a < 3; ++a) hash.add(v[a]);
    }
  }
  return hash.value();
}

uint64_t checksum(const std::vector<double>& heights, const std::vector<uint32_t>& blocks) {
  Hash hash;
  for (const double height : heights) hash.add(height);
  for (const uint32_t block : blocks) hash.add(uint64_t{block});
  return hash.value();
}

template <class T>
void put(std::ostream& out, const T* data, size_t count) {
  out.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
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
  const bool sane = header.nu >= 2 && header.nv >= 2 && header.nu <= kMostRays && header.nv <= kMostRays;
  const uint64_t needed =
      sizeof(Header) + header.nu * header.nv * (sizeof(double) + sizeof(uint32_t)) + sizeof(uint64_t);
  if (!sane || error || size != needed) {
    refuse("rays-file-damaged", path, fmt::format("the file of surface rays is cut off at {} bytes", size));
  }
  return header;
}

}  // namespace

void SurfaceDexels::save(const std::string& path) const {
  const std::string temporary = path + ".part";
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  const Header header{kMagic, static_cast<uint64_t>(nu_), static_cast<uint64_t>(nv_), surface_hash(*this)};
  const uint64_t sum = checksum(heights_, blocks_);
  put(out, &header, 1);
  put(out, heights_.data(), heights_.size());
  put(out, blocks_.data(), blocks_.size());
  put(out, &sum, 1);
  out.close();
  std::error_code error;
  if (out) fs::rename(temporary, path, error);
  if (!out || error) {
    throw InputError("rays-file-unwritable", {path, 0, 0}, "the file of surface rays cannot be written",
                     "check that the folder exists, may be written and has space");
  }
}

SurfaceDexels SurfaceDexels::load(const std::string& path, surface::SurfacePtr surface) {
  std::ifstream in(path, std::ios::binary);
  const Header header = read_header(in, path);
  SurfaceDexels dexels(std::move(surface), static_cast<int>(header.nu), static_cast<int>(header.nv));
  if (surface_hash(dexels) != header.surface) {
    refuse("rays-file-other-surface", path, "the rays were measured on another surface");
  }
  uint64_t sum = 0;
  get(in, dexels.heights_.data(), dexels.heights_.size());
  get(in, dexels.blocks_.data(), dexels.blocks_.size());
  get(in, &sum, 1);
  if (!in || sum != checksum(dexels.heights_, dexels.blocks_)) {
    refuse("rays-file-damaged", path, "the checksum of the surface rays does not match their content");
  }
  dexels.refresh_highest();
  return dexels;
}

}  // namespace swarf::stock

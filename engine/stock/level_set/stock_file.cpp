// Stock files: an OpenVDB file that other programs can open, with sixteen bytes after its end that they
// ignore: a mark and a checksum of everything before. A file that is cut off or damaged is recognised by them
// before any of it is interpreted.
#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/Stream.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/file.h"
#include "base/hash.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr char kMark[] = "SWARFVDB";
constexpr size_t kMarkBytes = 8;
constexpr size_t kTrailerBytes = kMarkBytes + sizeof(uint64_t);
constexpr char kFormatKey[] = "swarf_stock_format";
constexpr char kFormat[] = "1";
constexpr char kBoxLowerKey[] = "swarf_box_lower_mm";
constexpr char kBoxUpperKey[] = "swarf_box_upper_mm";
constexpr char kRoundingKey[] = "swarf_rounding_mm";
constexpr char kRawKey[] = "swarf_raw_stock";  // of other shapes than a box

[[noreturn]] void refuse_stock(const std::string& code, const std::string& path, const std::string& text,
                               const std::string& fix) {
  throw InputError(code, {path, 0, 0}, text, fix);
}

std::string read_bytes(const std::string& path) {
  return read_all(
      path, {"stock-file-unreadable", "the stock file cannot be read", "name a file written by swarf run"});
}

/// Refuses a file without swarf's trailer and says what it is. OpenVDB does not get to read it: its reader
/// trusts lengths that a damaged file may hold. The texts looked for stand uncompressed in an OpenVDB file.
[[noreturn]] void refuse_unmarked(const std::string& path, const std::string& bytes) {
  const auto holds = [&](std::string_view text) { return bytes.find(text) != std::string::npos; };
  constexpr std::string_view kOpenVdbMagic{" BDV\0\0\0\0", 8};
  const size_t begun = std::min(bytes.size(), kOpenVdbMagic.size());
  if (bytes.compare(0, begun, kOpenVdbMagic.substr(0, begun)) != 0) {
    refuse_stock("stock-file-foreign", path, "this is not an OpenVDB file",
                 "name a stock.vdb written by swarf run");
  }
  // The grid's transform ("UniformScaleMap", "AffineMap", ...) follows all of its metadata.
  if (holds(kFormatKey) || !holds("Map")) {
    refuse_stock("stock-file-incomplete", path,
                 fmt::format("the file of {} bytes does not end as swarf ends its stock files", bytes.size()),
                 "it was cut off, or another program saved it again: run the scene again to write it");
  }
  if (!holds("level set")) {
    refuse_stock(
        "stock-not-level-set", path,
        holds("fog volume") ? "the file holds a fog volume, not a level set" : "the file holds no level set",
        "name a stock.vdb written by swarf run");
  }
  refuse_stock("stock-file-foreign", path,
               "the level set was written by another program: its box is not known",
               "name a stock.vdb written by swarf run");
}

/// The OpenVDB part of a file whose trailer is whole.
std::string verified_bytes(const std::string& path) {
  std::string bytes = read_bytes(path);
  if (bytes.empty()) {
    refuse_stock("stock-file-empty", path, "the stock file is empty", "run the scene again to write it");
  }
  const bool marked = bytes.size() > kTrailerBytes &&
                      bytes.compare(bytes.size() - kTrailerBytes, kMarkBytes, kMark, kMarkBytes) == 0;
  if (!marked) refuse_unmarked(path, bytes);
  uint64_t expected = 0;
  std::memcpy(&expected, bytes.data() + bytes.size() - sizeof(expected), sizeof(expected));
  bytes.resize(bytes.size() - kTrailerBytes);
  if (checksum(bytes) != expected) {
    refuse_stock("stock-file-damaged", path, "the checksum of the stock file does not match its content",
                 "run the scene again to write it");
  }
  return bytes;
}

openvdb::FloatGrid::Ptr parse_grid(const std::string& path, const std::string& bytes) {
  empty_grid(1.0);  // registers the grid types
  openvdb::GridPtrVecPtr grids;
  try {
    std::istringstream in(bytes);
    openvdb::io::Stream stream(in, /*delayLoad=*/false);
    grids = stream.getGrids();
    if (!in) throw std::runtime_error("it ends before its grid does");
  } catch (const std::exception& error) {  // OpenVDB's own, and those of the memory that it asks for
    refuse_stock("stock-file-damaged", path, fmt::format("OpenVDB cannot read the file: {}", error.what()),
                 "run the scene again to write it");
  }
  const auto grid = grids && grids->size() == 1 ? openvdb::gridPtrCast<openvdb::FloatGrid>(grids->front())
                                                : openvdb::FloatGrid::Ptr();
  if (!grid || grid->getGridClass() != openvdb::GRID_LEVEL_SET ||
      !grid->getMetadata<openvdb::Vec3DMetadata>(kBoxLowerKey) ||
      !grid->getMetadata<openvdb::Vec3DMetadata>(kBoxUpperKey)) {
    refuse_stock("stock-not-level-set", path, "the file holds no single level set with a stock box",
                 "use a stock.vdb written by swarf run");
  }
  return grid;
}

Vec3 metadata_vector(const openvdb::FloatGrid& grid, const char* key) {
  const openvdb::Vec3d v = grid.metaValue<openvdb::Vec3d>(key);
  return {v.x(), v.y(), v.z()};
}

/// Files written before the rounding was kept: what kernels that did not shorten long sweeps rounded, eight
/// times half the spacing of floats at the length of the stock or of a retract from it.
double rounding_read(const LevelSet& set) {
  if (set.grid->getMetadata<openvdb::DoubleMetadata>(kRoundingKey))
    return set.grid->metaValue<double>(kRoundingKey);
  constexpr double kRoundings = 8.0, kHalfSpacing = 6e-8, kLeastLength = 50.0;
  return kRoundings * kHalfSpacing * std::max(kLeastLength, set.box.size().norm());
}

/// Fills the map from the tree's leaves and tile signs.
void attach_map(LevelSet& set) {
  set.map = empty_map(set.box, set.voxel);
  size_t found = 0;
  for (size_t n = 0; n < set.map.size(); ++n) {
    const openvdb::Coord origin = set.map.origin(n);
    set.map.leaves[n] = set.grid->tree().probeLeaf(origin);
    const bool solid = set.grid->tree().getValue(origin) < 0.0F;
    set.map.states[n] = set.map.leaves[n] ? LeafState::kLeaf : solid ? LeafState::kSolid : LeafState::kAir;
    found += set.map.leaves[n] ? 1 : 0;
  }
  SWARF_CHECK(found == set.grid->tree().leafCount(), "a level set has leaves outside its box");
}

void add_metadata(openvdb::FloatGrid& grid, const LevelSet& set, const StockMetadata& metadata) {
  for (const auto& [key, text] : metadata) grid.insertMeta(key, openvdb::StringMetadata(text));
  const auto vector = [](const Vec3& v) { return openvdb::Vec3DMetadata({v.x(), v.y(), v.z()}); };
  grid.insertMeta(kFormatKey, openvdb::StringMetadata(kFormat));
  grid.insertMeta(kBoxLowerKey, vector(set.box.lower));
  grid.insertMeta(kBoxUpperKey, vector(set.box.upper));
  grid.insertMeta(kRoundingKey, openvdb::DoubleMetadata(set.rounding_mm));
  if (!set.raw || !set.raw->is_box())
    grid.insertMeta(kRawKey, openvdb::StringMetadata(set.raw ? set.raw->text() : "of a file"));
}

/// A level set on its way to a file. Equal stocks are equal files: -0 equals 0, and which of the two stands
/// depends on the order of the cuts. Leaves that are on the disk come through memory one by one.
class WrittenGrid final : public openvdb::FloatGrid {
 public:
  WrittenGrid(const LevelSet& set, const StockMetadata& metadata)
      : openvdb::FloatGrid(set.grid->treePtr()), set_(set) {
    for (auto one = set.grid->beginMeta(); one != set.grid->endMeta(); ++one)
      insertMeta(one->first, *one->second);
    setTransform(set.grid->transformPtr());
    add_metadata(*this, set, metadata);
    addStatsMetadata();
  }

  /// As if all leaves were in memory: it is written.
  openvdb::Index64 memUsage() const override {
    return openvdb::FloatGrid::memUsage() +
           (set_.spilled ? set_.spilled->file.slots() * kLeafVoxels * sizeof(float) : 0);
  }
  void writeBuffers(std::ostream& out) const override {
    for (auto leaf = tree().cbeginLeaf(); leaf; ++leaf) {
      const openvdb::Coord place = (leaf->origin() >> 3) - set_.map.lower;
      const float* values = set_.values(set_.map.index(place.x(), place.y(), place.z()));
      LeafNode written(leaf->origin(), 0.0F);
      written.setValueMask(leaf->getValueMask());
      for (int n = 0; n < kLeafVoxels; ++n) written.buffer().data()[n] = values[n] + 0.0F;
      written.writeBuffers(out, saveFloatAsHalf());
    }
  }

 private:
  const LevelSet& set_;
};

/// A file as openvdb::io::File writes it, into our own: a full disk is seen by our own writer, while
/// OpenVDB's does not say that it has taken the end of a file. What is left out is the table by which a
/// reader could put off reading: it compresses every leaf once more, where it would be in memory.
class StreamArchive : public openvdb::io::Archive {
 public:
  void write_whole(std::ostream& out, const openvdb::GridBase& grid) const {
    auto settings = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(out, settings, /*transfer=*/false);
    openvdb::io::setDataCompression(out, compression());
    writeHeader(out, /*seekable=*/true);
    openvdb::MetaMap().writeMeta(out);
    const int32_t grids = 1;
    out.write(reinterpret_cast<const char*>(&grids), sizeof(grids));
    write_grid(out, grid);
    openvdb::io::clearStreamMetadataPtr(out);
  }

 private:
  void write_grid(std::ostream& out, const openvdb::GridBase& grid) const {
    openvdb::io::GridDescriptor places(grid.getName(), grid.type(), grid.saveFloatAsHalf());
    places.writeHeader(out);
    const std::streamoff places_at = out.tellp();
    places.writeStreamPos(out);  // once more when they are known
    places.setGridPos(out.tellp());
    setGridCompression(out, grid);
    grid.writeMeta(out);
    grid.writeTransform(out);
    grid.writeTopology(out);
    places.setBlockPos(out.tellp());
    grid.writeBuffers(out);
    places.setEndPos(out.tellp());
    out.seekp(places_at);
    places.writeStreamPos(out);
    places.seekToEnd(out);
  }
};

constexpr FileFault kUnwritable{"stock-file-unwritable", "the stock file cannot be written"};

uint64_t file_checksum(const NewFile& file) {
  Checksum sum(std::filesystem::file_size(file.temporary()));
  read_in_pieces(file.temporary(), kUnwritable, [&](std::string_view piece) { sum.add(piece); });
  return sum.value();
}

/// OpenVDB names each file it writes by a random UUID. Ours is made from the content, so that equal stocks
/// are equal files; it stands behind magic number, three version numbers and a flag.
constexpr std::streamoff kUuidAt = 8 + 3 * 4 + 1;
constexpr size_t kUuidLetters = 36;

void write_uuid(std::fstream& file, const std::string& uuid) {
  file.seekp(kUuidAt);
  file << uuid << std::flush;
}

void name_by_content(const NewFile& file) {
  std::fstream content(file.temporary(), std::ios::in | std::ios::out | std::ios::binary);
  std::string before(kUuidLetters, '\0');
  content.seekg(kUuidAt);
  content.read(before.data(), kUuidLetters);
  SWARF_CHECK(!content || (before[8] == '-' && before[23] == '-'),
              "OpenVDB has changed where the UUID of a file stands");
  write_uuid(content, std::string(kUuidLetters, '0'));
  const uint64_t first = file_checksum(file);
  Hash second;
  second.add(first);
  const std::string digits = fmt::format("{:016x}{:016x}", first, second.value());
  // Version 8 of RFC 9562 is the writer's own.
  write_uuid(content, fmt::format("{}-{}-8{}-8{}-{}", digits.substr(0, 8), digits.substr(8, 4),
                                  digits.substr(13, 3), digits.substr(17, 3), digits.substr(20, 12)));
  if (!content) file.refuse(std::strerror(errno));
}

}  // namespace

void write_level_set(const LevelSet& set, const std::string& path, const StockMetadata& metadata) {
  NewFile file(path, kUnwritable);
  const WrittenGrid grid(set, metadata);
  std::ofstream out(file.temporary(), std::ios::binary);
  StreamArchive().write_whole(out, grid);
  out.close();
  if (!out) file.refuse(std::strerror(errno));
  name_by_content(file);
  // Mark and checksum stand at the end.
  const uint64_t sum = file_checksum(file);
  std::ofstream end(file.temporary(), std::ios::binary | std::ios::app);
  end.write(kMark, kMarkBytes);
  end.write(reinterpret_cast<const char*>(&sum), sizeof(sum));
  end.close();
  if (!end) file.refuse(std::strerror(errno));
  file.move_into_place();
}

LevelSet read_level_set(const std::string& path, StockMetadata& metadata) {
  LevelSet set;
  set.grid = parse_grid(path, verified_bytes(path));
  for (auto meta = set.grid->beginMeta(); meta != set.grid->endMeta(); ++meta) {
    if (meta->second->typeName() == openvdb::StringMetadata::staticTypeName()) {
      metadata[meta->first] = meta->second->str();
    }
  }
  set.voxel = set.grid->voxelSize().x();
  set.box = {metadata_vector(*set.grid, kBoxLowerKey), metadata_vector(*set.grid, kBoxUpperKey)};
  if (!set.grid->getMetadata<openvdb::StringMetadata>(kRawKey)) set.raw = RawShape::of_box(set.box);
  set.rounding_mm = rounding_read(set);
  attach_map(set);
  return set;
}

LevelSet deep_copy(const LevelSet& original) {
  LevelSet set;
  set.box = original.box;
  set.raw = original.raw;
  set.voxel = original.voxel;
  set.grid = original.grid->deepCopy();
  set.statistics = original.statistics;
  set.rounding_mm = original.rounding_mm;
  attach_map(set);
  set.map.floors = original.map.floors;
  for (size_t n = 0; n < set.map.size(); ++n)
    if (original.is_spilled(n))
      std::copy_n(original.values(n), kLeafVoxels, set.map.leaves[n]->buffer().data());
  return set;
}

}  // namespace swarf::stock

#include "mesh/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "mesh/mesh_source.h"
#include "mesh/ply_header.h"
#include "mesh/polygon.h"

namespace swarf::mesh {
namespace {

/// The values of the body, one after the other.
class PlyBody {
 public:
  virtual ~PlyBody() = default;
  /// Finite or not; every value of the type.
  virtual double value(PlyType type) = 0;
  virtual void end_item() = 0;
  /// Refuses what follows the last item.
  virtual void end() = 0;
  /// True when `count` values of the type can still follow.
  virtual bool has_room(uint64_t count, PlyType type) const = 0;
  [[noreturn]] virtual void refuse(const std::string& text) const = 0;
};

double lowest(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
      return std::numeric_limits<int8_t>::min();
    case PlyType::kInt16:
      return std::numeric_limits<int16_t>::min();
    case PlyType::kInt32:
      return std::numeric_limits<int32_t>::min();
    default:
      return 0.0;
  }
}

double highest(PlyType type) {
  return std::exp2(8.0 * static_cast<double>(ply_bytes(type))) - 1.0 + lowest(type);
}

/// Each item on a line of its own.
class TextBody final : public PlyBody {
 public:
  TextBody(const std::string& path, std::string_view bytes, const PlyHeader& header)
      : text_(path, bytes), size_(bytes.size()) {
    while (text_.at() < header.end) text_.skip_line();
  }

  double value(PlyType type) override {
    if (!started_) start_line();
    const double number = text_.number("a value");
    const bool whole = is_whole_number(type);
    if (whole && !(number == std::floor(number) && number >= lowest(type) && number <= highest(type)))
      text_.refuse("this is no whole number of the type that the header names");
    return number;
  }

  void end_item() override {
    const std::string_view rest = text_.word_in_line();
    if (!rest.empty()) text_.refuse(fmt::format("'{}' is too much in this line", shown(rest)));
    text_.skip_line();
    started_ = false;
  }

  void end() override {
    const std::string_view rest = text_.word();
    if (!rest.empty()) text_.refuse("more stands here than the header announces");
  }

  bool has_room(uint64_t count, PlyType /*type*/) const override { return count <= size_ - text_.at(); }
  void refuse(const std::string& text) const override { text_.refuse(text); }

 private:
  /// Over empty lines, to where the next item starts.
  void start_line() {
    started_ = true;
    MeshText ahead = text_;
    for (;;) {
      if (!ahead.word_in_line().empty()) return;
      const size_t before = ahead.at();
      ahead.skip_line();
      if (ahead.at() == before) text_.refuse("the file ends before everything that its header announces");
      text_ = ahead;
    }
  }

  MeshText text_;
  size_t size_;
  bool started_ = false;
};

class BinaryBody final : public PlyBody {
 public:
  BinaryBody(std::string path, std::string_view bytes, const PlyHeader& header)
      : path_(std::move(path)),
        bytes_(bytes),
        at_(header.end),
        swapped_((header.format == PlyFormat::kBigEndian) != (std::endian::native == std::endian::big)) {}

  double value(PlyType type) override {
    if (!has_room(1, type)) refuse("the file ends before everything that its header announces");
    last_ = at_;
    switch (type) {
      case PlyType::kInt8:
        return take<int8_t>();
      case PlyType::kUint8:
        return take<uint8_t>();
      case PlyType::kInt16:
        return take<int16_t>();
      case PlyType::kUint16:
        return take<uint16_t>();
      case PlyType::kInt32:
        return take<int32_t>();
      case PlyType::kUint32:
        return take<uint32_t>();
      case PlyType::kFloat:
        return double{take<float>()};
      case PlyType::kDouble:
        return take<double>();
    }
    return 0.0;
  }

  void end_item() override {}

  void end() override {
    // Some programs end every file with a line feed.
    const size_t rest = bytes_.find_first_not_of("\r\n", at_);
    last_ = at_;
    if (rest != bytes_.npos)
      refuse(fmt::format("{} bytes more than the header announces", bytes_.size() - at_));
  }

  bool has_room(uint64_t count, PlyType type) const override {
    return count <= (bytes_.size() - at_) / ply_bytes(type);
  }
  void refuse(const std::string& text) const override {
    refuse_mesh({path_}, fmt::format("byte {}: {}", last_, text));
  }

 private:
  template <typename T>
  T take() {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  std::string path_;
  std::string_view bytes_;
  size_t at_, last_ = 0;  ///< the next value, and the one read last
  bool swapped_;
};

/// What a property of the vertices is to us.
enum Role : size_t { kX, kY, kZ, kNx, kNy, kNz, kRed, kGreen, kBlue, kAlpha, kRoles };
constexpr std::array<const char*, kRoles> kRoleNames{"x",  "y",   "z",     "nx",   "ny",
                                                     "nz", "red", "green", "blue", "alpha"};

class PlyReader {
 public:
  PlyReader(std::string path, std::string_view bytes)
      : path_(std::move(path)), header_(read_ply_header(path_, bytes)) {
    if (header_.format == PlyFormat::kAscii) {
      body_ = std::make_unique<TextBody>(path_, bytes, header_);
    } else {
      body_ = std::make_unique<BinaryBody>(path_, bytes, header_);
    }
  }

  TriMesh run() {
    vertices_ = element("vertex").count;
    if (vertices_ > std::numeric_limits<uint32_t>::max()) refuse_mesh({path_}, "too many vertices");
    element("face");
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        skip(element);
      }
    }
    body_->end();
    split_faces();
    return std::move(mesh_);
  }

 private:
  const PlyElement& element(const std::string& name) const {
    for (const PlyElement& one : header_.elements) {
      if (one.name == name) return one;
    }
    refuse_mesh({path_, header_.lines}, fmt::format("the header has no element '{}'", name),
                "export the surface as triangles or polygons: strips and points are not read");
  }

  /// Reads one property; what a list held is forgotten.
  double read(const PlyProperty& property) {
    if (!property.is_list) return body_->value(property.type);
    const uint64_t count = list_length(property);
    for (uint64_t i = 0; i < count; ++i) body_->value(property.type);
    return 0.0;
  }

  uint64_t list_length(const PlyProperty& property) {
    const double count = body_->value(property.count_type);
    if (count < 0.0 || !body_->has_room(static_cast<uint64_t>(count), property.type))
      body_->refuse(fmt::format("a list of {:g} values cannot stand in the rest of the file", count));
    return static_cast<uint64_t>(count);
  }

  void skip(const PlyElement& element) {
    for (uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) read(property);
      body_->end_item();
    }
  }

  static size_t role_of(const PlyProperty& property) {
    const auto* found = std::find(kRoleNames.begin(), kRoleNames.end(), property.name);
    return property.is_list ? size_t{kRoles} : static_cast<size_t>(found - kRoleNames.begin());
  }

  float coordinate(size_t role, double value) const {
    const std::string fault = coordinate_fault(kRoleNames.at(role), value);
    if (!fault.empty()) body_->refuse(fault);
    return static_cast<float>(value);
  }

  uint8_t colour(PlyType type, double value) const {
    if (!std::isfinite(value)) body_->refuse("a colour is not finite");
    const double unit = is_whole_number(type) ? value / highest(type) : value;
    return static_cast<uint8_t>(std::lround(255.0 * std::clamp(unit, 0.0, 1.0)));
  }

  void read_vertices(const PlyElement& element) {
    std::array<bool, kRoles + 1> has{};
    for (const PlyProperty& property : element.properties) has.at(role_of(property)) = true;
    if (!has[kX] || !has[kY] || !has[kZ])
      refuse_mesh({path_, element.line, 1}, "the vertices have no x, y and z");
    const bool normals = has[kNx] && has[kNy] && has[kNz], colours = has[kRed] && has[kGreen] && has[kBlue];
    for (uint64_t i = 0; i < element.count; ++i) {
      std::array<float, kRoles> v{};
      std::array<uint8_t, 4> rgba{0, 0, 0, 255};
      for (const PlyProperty& property : element.properties) {
        const size_t role = role_of(property);
        const double value = read(property);
        if (role < kRed) v.at(role) = coordinate(role, value);
        if (role >= kRed && role < kRoles) rgba.at(role - kRed) = colour(property.type, value);
      }
      body_->end_item();
      mesh_.positions.push_back({v[kX], v[kY], v[kZ]});
      if (normals) mesh_.normals.push_back({v[kNx], v[kNy], v[kNz]});
      if (colours) mesh_.colours.push_back(rgba);
    }
  }

  static bool is_face_list(const PlyProperty& property) {
    return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  void read_faces(const PlyElement& element) {
    const bool known = std::any_of(element.properties.begin(), element.properties.end(), is_face_list);
    if (!known) refuse_mesh({path_, element.line, 1}, "the faces have no list 'vertex_indices'");
    for (uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        if (is_face_list(property)) {
          read_face(property);
        } else {
          read(property);
        }
      }
      body_->end_item();
    }
  }

  void read_face(const PlyProperty& property) {
    const uint64_t count = list_length(property);
    if (count < 3 || count > kMostCorners)
      body_->refuse(fmt::format("a face of {} corners, not 3 to {}", count, kMostCorners));
    face_ends_.push_back(face_corners_.size() + count);
    for (uint64_t i = 0; i < count; ++i) {
      const double index = body_->value(property.type);
      if (!(index >= 0.0 && index < static_cast<double>(vertices_) && index == std::floor(index))) {
        body_->refuse(fmt::format("vertex {:.0f} is not there: the file has vertices 0 to {}", index,
                                  static_cast<int64_t>(vertices_) - 1));
      }
      face_corners_.push_back(static_cast<uint32_t>(index));
    }
  }

  /// Faces may stand before the vertices, so they are split when all is read.
  void split_faces() {
    size_t begin = 0;
    for (size_t face = 0; face < face_ends_.size(); ++face) {
      const std::span<const uint32_t> corners{&face_corners_[begin], face_ends_[face] - begin};
      if (!append_polygon(corners, mesh_.positions, mesh_.triangles))
        refuse_mesh({path_}, fmt::format("face {} of {} corners crosses itself", face + 1, corners.size()),
                    "export triangles, or mend the face");
      begin = face_ends_[face];
    }
  }

  std::string path_;
  PlyHeader header_;
  std::unique_ptr<PlyBody> body_;
  uint64_t vertices_ = 0;
  TriMesh mesh_;
  std::vector<uint32_t> face_corners_;
  std::vector<size_t> face_ends_;
};

}  // namespace

TriMesh read_ply(const std::string& path) {
  const std::string bytes = read_mesh_file(path);
  return PlyReader(path, bytes).run();
}

}  // namespace swarf::mesh

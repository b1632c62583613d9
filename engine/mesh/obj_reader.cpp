#include "mesh/obj_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "mesh/mesh_source.h"
#include "mesh/polygon.h"

namespace swarf::mesh {
namespace {

/// Keywords whose lines say nothing about the shape.
constexpr std::array<std::string_view, 19> kIgnored{
    "vt",  "vp",         "g",         "o",      "s",      "mg",    "usemtl",   "mtllib",   "p",           "l",
    "lod", "shadow_obj", "trace_obj", "maplib", "usemap", "bevel", "c_interp", "d_interp", "texture_name"};
/// Free-form geometry: a mesh without it would lack a part of the surface.
constexpr std::array<std::string_view, 17> kFreeForm{"cstype", "deg",  "bmat",  "step",  "curv", "curv2",
                                                     "surf",   "parm", "trim",  "hole",  "scrv", "sp",
                                                     "end",    "con",  "ctech", "stech", "call"};

template <size_t N>
bool is_one_of(std::string_view word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view bytes) : text_(path, bytes) {}

  TriMesh run() {
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      if (word.front() != '#') read_line(word);
      text_.skip_line();
    }
    return finished();
  }

 private:
  void read_line(std::string_view word) {
    if (word == "v") return read_vertex();
    if (word == "vn") return read_normal();
    if (word == "f" || word == "fo") return read_face();
    if (is_one_of(word, kIgnored)) return skip_words();
    if (is_one_of(word, kFreeForm)) {
      text_.refuse(fmt::format("'{}' belongs to free-form geometry, which is not read", shown(word)),
                   "export the surface as triangles");
    }
    text_.refuse(fmt::format("'{}' is no word of an OBJ file", shown(word)));
  }

  /// The next word of the statement, which a backslash carries on to the next line.
  std::string_view word_of_statement() {
    for (;;) {
      const std::string_view word = text_.word_in_line();
      if (word != "\\") return word;
      if (!text_.word_in_line().empty()) text_.refuse("'\\' must be the last word of its line");
      text_.skip_line();
    }
  }

  void skip_words() {
    while (!word_of_statement().empty()) continue;
  }

  void end_line() {
    const std::string_view rest = text_.word_in_line();
    if (!rest.empty() && rest.front() != '#')
      text_.refuse(fmt::format("'{}' is too much in this line", shown(rest)));
  }

  /// x y z, with w, red green blue, or both behind them.
  void read_vertex() {
    const float x = text_.coordinate("x"), y = text_.coordinate("y"), z = text_.coordinate("z");
    std::array<double, 4> more{};
    size_t count = 0;
    for (; count < more.size() && has_more(); ++count) more.at(count) = text_.number("a value");
    end_line();
    positions_.push_back({x, y, z});
    if (count < 3) return;
    std::array<uint8_t, 4> rgba{0, 0, 0, 255};
    for (size_t i = 0; i < 3; ++i) {
      const double part = more.at(count - 3 + i);
      if (!std::isfinite(part)) text_.refuse("a colour is not finite");
      rgba.at(i) = static_cast<uint8_t>(std::lround(255.0 * std::clamp(part, 0.0, 1.0)));
    }
    colours_.push_back(rgba);
  }

  bool has_more() const {
    MeshText ahead = text_;
    const std::string_view word = ahead.word_in_line();
    return !word.empty() && word.front() != '#';
  }

  void read_normal() {
    std::array<float, 3> normal{};
    for (float& part : normal) part = text_.coordinate("a normal");
    end_line();
    normals_.push_back(normal);
  }

  /// An index of OBJ: from 1, or counted back from the last; none when the field is empty.
  std::optional<uint32_t> index(std::string_view field, size_t count, std::string_view what) const {
    if (field.empty()) return {};
    int64_t number = 0;
    const auto [stop, failure] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (failure != std::errc() || stop != field.data() + field.size())
      text_.refuse(fmt::format("'{}' is no number of a {}", shown(field), what));
    const int64_t place = number > 0 ? number - 1 : static_cast<int64_t>(count) + number;
    if (number == 0 || place < 0 || place >= static_cast<int64_t>(count))
      text_.refuse(fmt::format("{} {} is not there: {} stand before this line", what, number, count));
    return static_cast<uint32_t>(place);
  }

  /// "v", "v/t", "v//n" or "v/t/n".
  void read_corner(std::string_view word) {
    std::array<std::string_view, 3> fields{};
    size_t used = 0;
    for (std::string_view rest = word;; ++used) {
      if (used == fields.size()) text_.refuse(fmt::format("'{}' is no corner of a face", shown(word)));
      const size_t slash = rest.find('/');
      fields.at(used) = rest.substr(0, slash);
      if (slash == rest.npos) break;
      rest.remove_prefix(slash + 1);
    }
    const auto position = index(fields[0], positions_.size(), "vertex");
    if (!position) text_.refuse(fmt::format("'{}' names no vertex", shown(word)));
    corners_.push_back(*position);
    const auto normal = index(fields[2], normals_.size(), "normal");
    corner_normals_.push_back(normal.value_or(kNone));
    all_normals_ = all_normals_ && normal;
  }

  void read_face() {
    const size_t begin = corners_.size();
    for (std::string_view word = word_of_statement(); !word.empty() && word.front() != '#';
         word = word_of_statement()) {
      read_corner(word);
      if (corners_.size() - begin > kMostCorners)
        text_.refuse(fmt::format("a face of more than {} corners", kMostCorners), "export triangles");
    }
    if (corners_.size() - begin < 3)
      text_.refuse(fmt::format("a face of {} corners", corners_.size() - begin));
    // The corners' own numbers stand for the corners, so that each keeps its normal.
    const auto count = static_cast<uint32_t>(corners_.size() - begin);
    std::vector<std::array<float, 3>> places;
    std::vector<uint32_t> numbers(count);
    for (uint32_t i = 0; i < count; ++i) {
      places.push_back(positions_[corners_[begin + i]]);
      numbers[i] = i;
    }
    std::vector<std::array<uint32_t, 3>> triangles;
    if (!append_polygon(numbers, places, triangles))
      text_.refuse(fmt::format("this face of {} corners crosses itself", count), "export triangles");
    for (const auto& t : triangles) {
      for (const uint32_t i : t) split_.push_back(begin + i);
    }
  }

  /// A vertex for each pair of position and normal that a corner uses.
  TriMesh finished() {
    TriMesh mesh;
    const bool normals = all_normals_ && !normals_.empty(), colours = colours_.size() == positions_.size();
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> vertices;
    std::array<uint32_t, 3> triangle{};
    for (size_t i = 0; i < split_.size(); ++i) {
      const uint32_t p = corners_[split_[i]], n = normals ? corner_normals_[split_[i]] : kNone;
      const auto [found, fresh] = vertices.try_emplace({p, n}, static_cast<uint32_t>(mesh.positions.size()));
      if (fresh) {
        mesh.positions.push_back(positions_[p]);
        if (normals) mesh.normals.push_back(normals_[n]);
        if (colours) mesh.colours.push_back(colours_[p]);
      }
      triangle.at(i % 3) = found->second;
      if (i % 3 == 2) mesh.triangles.push_back(triangle);
    }
    return mesh;
  }

  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  MeshText text_;
  std::vector<std::array<float, 3>> positions_, normals_;
  std::vector<std::array<uint8_t, 4>> colours_;
  std::vector<uint32_t> corners_, corner_normals_;  ///< of all faces
  std::vector<size_t> split_;                       ///< the corners of the triangles, three by three
  bool all_normals_ = true;
};

}  // namespace

TriMesh read_obj(const std::string& path) {
  const std::string bytes = read_mesh_file(path);
  return ObjReader(path, bytes).run();
}

}  // namespace swarf::mesh

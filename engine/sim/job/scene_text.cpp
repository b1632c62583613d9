#include "sim/job/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "brep/model.h"
#include "mesh/scene_reader.h"

namespace swarf::sim {
namespace {

std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const size_t comma = std::min(text.find(','), text.size());
    std::string_view word = text.substr(0, comma);
    while (!word.empty() && (word.front() == ' ' || word.front() == '+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [next, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure != std::errc() || next != word.data() + word.size() || !std::isfinite(value)) return {};
    numbers.push_back(value);
    if (comma == text.size()) return numbers;
    text.remove_prefix(comma + 1);
  }
}

std::string triple(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

/// The setup as a person without a scene means it: the work stands on the table, the tool was touched off.
std::string setup_text(const JobFlags& flags) {
  std::string text = "\n[setup]\n";
  text += fmt::format("work_origin_mm = {}\n", flags.origin_M ? triple(*flags.origin_M) : "\"on_table\"");
  if (!flags.tracut.empty()) text += fmt::format("tracut = \"{}\"\n", flags.tracut);
  if (!flags.units.empty()) text += fmt::format("units = \"{}\"\n", flags.units);
  if (flags.cl_data) return text;
  text += "without_length = \"tip\"\n";
  if (flags.start_tool > 0) text += fmt::format("start_tool = {}\n", flags.start_tool);
  if (flags.t_changes_tool) text += "t_changes_tool = true\n";
  if (!flags.slot_ends.empty()) text += fmt::format("slot_ends = \"{}\"\n", flags.slot_ends);
  return text;
}

std::string stock_text(const JobFlags& flags) {
  std::string text = "\n[stock]\n";
  if (!flags.stock_keys.empty())
    text += flags.stock_keys;
  else
    text += flags.stock_W ? fmt::format("box_mm = [{}, {}]\n", triple(flags.stock_W->lower),
                                        triple(flags.stock_W->upper))
                          : "box_mm = \"auto\"\n";
  return text + (flags.voxel_mm ? fmt::format("voxel_mm = {}\n", *flags.voxel_mm) : "voxel_mm = \"auto\"\n");
}

}  // namespace

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < ' ') {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string scene_text(const JobFlags& flags) {
  const std::string name = std::filesystem::path(flags.program_file).filename().string();
  std::string text = "title = " + toml_string(name) + "\n";
  text += (flags.cl_data ? "cl = " : "nc = ") + toml_string(flags.program_file) + "\n";
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) text += fmt::format("{} = {}\n", key, toml_string(value));
  };
  add("dialect", flags.dialect);
  add("machine", flags.machine);
  add("tools", flags.tools);
  add("tool_table", flags.tool_table);
  text += setup_text(flags) + stock_text(flags);
  if (!flags.design.empty())
    text += fmt::format("\n[design]\n{} = {}\n", brep::is_cad_file(flags.design) ? "step" : "mesh",
                        toml_string(flags.design));
  // A first look: one picture, in seconds.
  text += "\n[movie]\nseconds = 0\n\n[stills]\nkinds = [\"part\"]\nsize = [960, 540]\nsamples = 6\n";
  return text;
}

Box parse_stock(const std::string& text) {
  const std::optional<std::vector<double>> n = numbers_of(text);
  const char* const example = "--stock 0,0,-10,40,30,0: the lower corner, then the upper one, mm";
  if (!n || n->size() != 6)
    throw InputError("bad-stock", {"--stock " + text}, "these are not six numbers", example);
  const Vec3 a((*n)[0], (*n)[1], (*n)[2]), b((*n)[3], (*n)[4], (*n)[5]);
  const Vec3 low = a.cwiseMin(b), high = a.cwiseMax(b), size = high - low;
  if (!(size.minCoeff() > 0.0))
    throw InputError("bad-stock", {"--stock " + text},
                     fmt::format("the block would be {:g} x {:g} x {:g} mm", size.x(), size.y(), size.z()),
                     example);
  if (a != low)
    throw InputError(
        "bad-stock", {"--stock " + text}, "the second corner lies below the first",
        fmt::format("--stock {},{},{},{},{},{}", low.x(), low.y(), low.z(), high.x(), high.y(), high.z()));
  return {low, high};
}

void take_stock(const std::string& text, JobFlags& flags) {
  std::string ending = std::filesystem::path(text).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".stl" || ending == ".ply" || ending == ".obj" || mesh::is_scene_ending(ending)) {
    flags.stock_keys = "mesh = " + toml_string(text) + "\n";
    return;
  }
  const size_t comma = std::min(text.find(','), text.size());
  const std::string word = text.substr(0, comma);
  if (word != "cyl" && word != "tube") {
    flags.stock_W = parse_stock(text);
    return;
  }
  const size_t count = word == "tube" ? 3 : 2;
  const auto n = comma < text.size() ? numbers_of(std::string_view(text).substr(comma + 1)) : std::nullopt;
  if (!n || n->size() != count)
    throw InputError("bad-stock", {"--stock " + text},
                     fmt::format("'{}' is not followed by {} numbers", word, count),
                     word == "tube" ? "--stock tube,60,30,40: outer and inner diameter, length, mm"
                                    : "--stock cyl,60,40: diameter and length, mm");
  const double length = n->back();
  flags.stock_keys =
      fmt::format("{} = {{ diameter_mm = {}, {}length_mm = {}, base_mm = [0, 0, {}] }}\n",
                  word == "tube" ? "tube" : "cylinder", n->front(),
                  count == 3 ? fmt::format("inner_diameter_mm = {}, ", (*n)[1]) : "", length, -length);
}

Vec3 parse_vector(const std::string& flag, const std::string& text) {
  const std::optional<std::vector<double>> n = numbers_of(text);
  if (!n || n->size() != 3)
    throw InputError("bad-option", {flag + " " + text}, "these are not three numbers",
                     "write " + flag + " 0,0,160 (mm)");
  return {(*n)[0], (*n)[1], (*n)[2]};
}

}  // namespace swarf::sim

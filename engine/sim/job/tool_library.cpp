#include "sim/job/tool_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/units.h"
#include "program/source_text.h"
#include "sim/job/p21_items.h"

namespace swarf::sim {
namespace {

namespace fs = std::filesystem;
using cutter::Cutter;
using cutter::Shape;
using nlohmann::json;

constexpr double kLibraryInch = 25.4;

/// What keeps one tool of many from being used; the others are.
struct Lacking : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

json load_json(const std::string& path) {
  json value = json::parse(program::read_file(path), nullptr, false);
  if (value.is_object()) return value;
  throw InputError("bad-tool-library", {path}, "this is no JSON object",
                   "export the library again: Fusion writes .json, FreeCAD .fctl and .fctb");
}

std::optional<double> number_at(const json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object.at(key).is_number()) return std::nullopt;
  const double value = object.at(key).get<double>();
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

std::string text_at(const json& object, const char* key) {
  return object.is_object() && object.contains(key) && object.at(key).is_string()
             ? object.at(key).get<std::string>()
             : "";
}

const json& part_of(const json& object, const char* key) {
  static const json nothing = json::object();
  return object.is_object() && object.contains(key) ? object.at(key) : nothing;
}

// ---- Fusion

double unit_of(const json& object) {
  const std::string unit = text_at(object, "unit");
  if (unit == "millimeters") return 1.0;
  if (unit == "inches") return kLibraryInch;
  throw Lacking(unit.empty() ? "it has no unit (\"unit\": \"millimeters\" or \"inches\")"
                             : fmt::format("its unit '{}' is neither millimeters nor inches", unit));
}

struct ShapeName {
  const char* name;
  Shape shape;
};
constexpr std::array<ShapeName, 9> kFusionTypes{{{"flat end mill", Shape::kFlat},
                                                 {"slot mill", Shape::kFlat},
                                                 {"face mill", Shape::kFlat},
                                                 {"reamer", Shape::kFlat},
                                                 {"bull nose end mill", Shape::kBullNose},
                                                 {"ball end mill", Shape::kBall},
                                                 {"drill", Shape::kDrill},
                                                 {"spot drill", Shape::kDrill},
                                                 {"chamfer mill", Shape::kChamfer}}};

Shape fusion_shape(const std::string& type) {
  for (const ShapeName& one : kFusionTypes) {
    if (type == one.name) return one.shape;
  }
  throw Lacking(fmt::format("its type '{}' is not known here", type));
}

/// A bull nose without a radius is flat, one of half its diameter a ball.
void settle_corner(Cutter& c, double radius) {
  if (c.shape == Shape::kBall) radius = c.radius();
  if (c.shape == Shape::kFlat && radius > 0.0) c.shape = Shape::kBullNose;
  if (c.shape == Shape::kBullNose && radius == 0.0) c.shape = Shape::kFlat;
  if (c.shape == Shape::kBullNose && radius >= c.radius()) c.shape = Shape::kBall;
  if (c.shape == Shape::kFlat || c.shape == Shape::kBall || c.shape == Shape::kBullNose)
    c.corner_radius_mm = radius;
}

std::vector<cutter::ToolSection> fusion_holder(const json& tool) {
  std::vector<cutter::ToolSection> sections;
  const json& holder = part_of(tool, "holder");
  const json& segments = part_of(holder, "segments");
  if (!segments.is_array()) return {};
  const double unit = unit_of(holder);
  for (const json& segment : segments) {
    const auto low = number_at(segment, "lower-diameter"), high = number_at(segment, "upper-diameter"),
               height = number_at(segment, "height");
    if (low && high && height && *low > 0.0 && *high > 0.0 && *height > 0.0)
      sections.push_back({unit * *low, unit * *high, unit * *height});
  }
  return sections;
}

double above_zero(const std::optional<double>& value, const char* what) {
  if (!value) throw Lacking(fmt::format("it has no {}", what));
  if (!(*value > 0.0)) throw Lacking(fmt::format("its {} is {:g}", what, *value));
  return *value;
}

/// Nothing above the edges but the shank: as thin as they are.
void without_holder(Cutter& c) {
  c.holder = {{c.diameter_mm, c.diameter_mm, 1.0}};
}

Cutter fusion_tool(const json& tool) {
  const json& geometry = part_of(tool, "geometry");
  const double unit = unit_of(tool);
  Cutter c;
  c.shape = fusion_shape(text_at(tool, "type"));
  c.diameter_mm = unit * above_zero(number_at(geometry, "DC"), "diameter (geometry.DC)");
  settle_corner(c, unit * number_at(geometry, "RE").value_or(0.0));
  if (c.shape == Shape::kDrill)
    c.point_angle_rad = rad_from_deg(above_zero(number_at(geometry, "SIG"), "point angle (geometry.SIG)"));
  if (c.shape == Shape::kChamfer) {
    c.point_angle_rad =
        2.0 * rad_from_deg(above_zero(number_at(geometry, "TA"), "taper angle (geometry.TA)"));
    c.tip_diameter_mm = unit * number_at(geometry, "tip-diameter").value_or(0.0);
  }
  c.length_mm = unit * above_zero(number_at(geometry, "LB"), "length below the holder (geometry.LB)");
  const double flutes = number_at(geometry, "LCF").value_or(c.length_mm / unit);
  c.flute_length_mm = std::min(unit * flutes, c.length_mm);
  c.shank_diameter_mm = unit * number_at(geometry, "SFDM").value_or(c.diameter_mm / unit);
  c.holder = fusion_holder(tool);
  if (c.holder.empty()) without_holder(c);
  return c;
}

// ---- FreeCAD

/// "5.0000 mm" in mm, "0.25 in" and "0.25\"" too; degrees as degrees.
std::optional<double> quantity(const json& parameters, const char* key) {
  if (const auto plain = number_at(parameters, key)) return plain;
  const std::string text = text_at(parameters, key);
  double value = 0.0;
  const auto [next, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || !std::isfinite(value)) return std::nullopt;
  std::string_view unit(next, static_cast<size_t>(text.data() + text.size() - next));
  while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
  if (unit == "mm" || unit == "\xc2\xb0" || unit == "deg") return value;
  if (unit == "in" || unit == "\"") return value * kLibraryInch;
  if (unit == "cm") return value * 10.0;
  throw Lacking(unit.empty() ? fmt::format("its {} has no unit ('{}')", key, text)
                             : fmt::format("the unit '{}' of its {} is not known", unit, key));
}

constexpr std::array<ShapeName, 6> kFreeCadShapes{{{"endmill", Shape::kFlat},
                                                   {"ballend", Shape::kBall},
                                                   {"bullnose", Shape::kBullNose},
                                                   {"torus", Shape::kBullNose},
                                                   {"drill", Shape::kDrill},
                                                   {"chamfer", Shape::kChamfer}}};

Shape freecad_shape(const json& bit) {
  const std::string name = lower_case(fs::path(text_at(bit, "shape")).stem().string());
  for (const ShapeName& one : kFreeCadShapes) {
    if (name == one.name) return one.shape;
  }
  throw Lacking(fmt::format("its shape '{}' is not known here", name));
}

Cutter freecad_tool(const json& bit) {
  const json& p = part_of(bit, "parameter");
  Cutter c;
  c.shape = freecad_shape(bit);
  c.diameter_mm = above_zero(quantity(p, "Diameter"), "Diameter");
  const auto flat = quantity(p, "FlatRadius"), torus = quantity(p, "TorusRadius");
  settle_corner(c, c.shape == Shape::kBullNose ? above_zero(flat ? flat : torus, "FlatRadius") : 0.0);
  if (c.shape == Shape::kDrill)
    c.point_angle_rad = rad_from_deg(above_zero(quantity(p, "TipAngle"), "TipAngle"));
  if (c.shape == Shape::kChamfer) {
    c.point_angle_rad = rad_from_deg(above_zero(quantity(p, "CuttingEdgeAngle"), "CuttingEdgeAngle"));
    c.tip_diameter_mm = quantity(p, "TipDiameter").value_or(0.0);
  }
  c.length_mm = above_zero(quantity(p, "Length"), "Length");
  c.flute_length_mm = std::min(quantity(p, "CuttingEdgeHeight").value_or(c.length_mm), c.length_mm);
  c.shank_diameter_mm = quantity(p, "ShankDiameter").value_or(c.diameter_mm);
  without_holder(c);
  return c;
}

// ---- ISO 13399

/// A length in mm or an angle in degrees; none where the item has no such property.
std::optional<double> p21_value(const P21Item& item, const char* symbol, bool angle = false) {
  const auto found = item.values.find(symbol);
  if (found == item.values.end()) return std::nullopt;
  const P21Value& value = found->second;
  if (value.contradicts) throw Lacking(fmt::format("it has two values of {}", symbol));
  const std::string unit = lower_case(value.unit);
  if (angle && (unit == "deg" || unit == "degree" || unit == "\xc2\xb0")) return value.value;
  if (angle && (unit == "rad" || unit == "radian")) return deg_from_rad(value.value);
  if (!angle && (unit == "mm" || unit == "millimetre")) return value.value;
  if (!angle && (unit == "inch" || unit == "in")) return value.value * kLibraryInch;
  throw Lacking(unit.empty() ? fmt::format("its {} has no unit", symbol)
                             : fmt::format("the unit '{}' of its {} is not known", value.unit, symbol));
}

std::optional<double> first_p21_value(const P21Item& item, std::initializer_list<const char*> symbols) {
  for (const char* symbol : symbols) {
    if (const auto value = p21_value(item, symbol)) return value;
  }
  return std::nullopt;
}

/// What the properties say of forms that these few do not describe.
void refuse_p21_forms(const P21Item& item) {
  for (const char* thread : {"TDZ", "TP", "THFT"}) {
    if (item.values.count(thread) > 0) throw Lacking(fmt::format("it cuts threads ({})", thread));
  }
  const auto lead = p21_value(item, "KAPR", true);
  const bool drill = item.values.count("SIG") > 0;
  if (lead && *lead != 90.0 && !drill)
    throw Lacking(fmt::format("its edges lean (KAPR {:g} deg), and the form of its end is not given", *lead));
  const auto widest = p21_value(item, "DCX");
  if (widest && *widest != p21_value(item, "DC"))
    throw Lacking("DC and DCX differ, and the form between them is not given");
}

Cutter p21_tool(const P21Item& item, std::string& assumed) {
  refuse_p21_forms(item);
  Cutter c;
  c.diameter_mm = above_zero(p21_value(item, "DC"), "cutting diameter (DC)");
  const auto point = p21_value(item, "SIG", true), corner = p21_value(item, "RE");
  if (point) {
    c.shape = Shape::kDrill;
    c.point_angle_rad = rad_from_deg(*point);
  } else {
    settle_corner(c, corner.value_or(0.0));
    if (!corner) assumed = "it has neither RE nor SIG: its end is taken as flat";
  }
  const auto stands_out = p21_value(item, "LPR");
  c.length_mm =
      above_zero(stands_out ? stands_out : first_p21_value(item, {"LF", "OAL"}), "length (LPR, LF or OAL)");
  if (!stands_out)
    assumed += fmt::format("{}it has no LPR: all of its {:g} mm stand out of the holder",
                           assumed.empty() ? "" : "; ", c.length_mm);
  c.flute_length_mm =
      std::min(above_zero(first_p21_value(item, {"APMX", "LCF", "LU"}), "cutting length (APMX, LCF or LU)"),
               c.length_mm);
  c.shank_diameter_mm = c.diameter_mm;
  if (const auto shank = first_p21_value(item, {"DCONMS", "DMM"})) c.shank_diameter_mm = *shank;
  if (const auto body = p21_value(item, "BDX")) c.shank_diameter_mm = std::max(c.shank_diameter_mm, *body);
  without_holder(c);
  return c;
}

// ---- both

struct Library {
  const std::string& path;
  std::map<int, std::string>& incomplete;
  std::vector<Cutter> tools;
  std::map<int, std::string> known;  ///< by number, what stands there under it

  template <typename Read>
  void add(int number, const std::string& what, Read read) {
    if (number <= 0) return;
    const auto [first, fresh] = known.emplace(number, what);
    if (!fresh) {
      std::erase_if(tools, [&](const Cutter& tool) { return tool.number == number; });
      incomplete[number] = fmt::format("{}: {} and {} have this number both", path, first->second, what);
      return;
    }
    try {
      Cutter c = read();
      c.number = number;
      const std::vector<cutter::Problem> problems = cutter::validate(c);
      if (!problems.empty()) throw Lacking(problems.front().text);
      tools.push_back(std::move(c));
    } catch (const Lacking& lack) {
      incomplete.emplace(number, fmt::format("{}: {}: {}", path, what, lack.what()));
    }
  }
};

int whole(const std::optional<double>& number) {
  constexpr double kLargest = 1e9;
  return number && *number >= 1.0 && *number <= kLargest && *number == std::floor(*number)
             ? static_cast<int>(*number)
             : 0;
}

void read_fusion(const json& root, Library& library) {
  const json& data = part_of(root, "data");
  if (!data.is_array())
    throw InputError("bad-tool-library", {library.path}, "the file has no list of tools (\"data\")",
                     "export it from the tool library of Fusion or HSM as JSON");
  for (size_t i = 0; i < data.size(); ++i) {
    const json& tool = data[i];
    const std::string type = text_at(tool, "type");
    if (type == "holder" || type == "probe") continue;
    const std::string name = text_at(tool, "description");
    library.add(whole(number_at(part_of(tool, "post-process"), "number")),
                fmt::format("data[{}]{}", i, name.empty() ? "" : " (" + name + ")"),
                [&] { return fusion_tool(tool); });
  }
}

/// Beside the library, or where FreeCAD keeps its bits; "" where it is not.
std::string bit_file(const std::string& library, const std::string& name) {
  const fs::path folder = fs::path(library).parent_path();
  for (const fs::path& place : {folder / name, folder / ".." / "Bit" / name, folder / "Bit" / name}) {
    if (fs::is_regular_file(place)) return place.lexically_normal().string();
  }
  return "";
}

void read_freecad_library(const json& root, Library& library) {
  const json& tools = part_of(root, "tools");
  if (!tools.is_array())
    throw InputError("bad-tool-library", {library.path}, "the file has no list of tools (\"tools\")",
                     "name the .fctl that FreeCAD keeps, or a .fctb");
  for (const json& tool : tools) {
    const std::string name = text_at(tool, "path");
    library.add(whole(number_at(tool, "nr")), name, [&] {
      const std::string file = bit_file(library.path, name);
      if (file.empty()) throw Lacking("its bit is neither beside the library nor in ../Bit");
      return freecad_tool(load_json(file));
    });
  }
}

/// "984327-1" as a tool's name; "" where it could not be one.
std::string p21_name(const std::string& id) {
  const bool number = std::all_of(id.begin(), id.end(), ::isdigit);
  const bool good = std::all_of(id.begin(), id.end(),
                                [](unsigned char c) { return c >= ' ' && c < 0x7f && c != ',' && c != '"'; });
  return number || !good ? "" : id;
}

/// A tool is what has a cutting diameter; inserts and holders have none.
void read_p21(Library& library, std::map<int, std::string>& assumed) {
  P21Items found = read_p21_items(library.path);
  const auto has = [](const P21Item& item, const char* symbol) { return item.values.count(symbol) > 0; };
  const bool inserts = std::any_of(found.items.begin(), found.items.end(),
                                   [&](const P21Item& item) { return !has(item, "DC") && has(item, "RE"); });
  std::erase_if(found.items, [&](const P21Item& item) { return !has(item, "DC"); });
  if (found.items.empty()) {
    const std::string codes = fmt::format("{}", fmt::join(found.codes, ", "));
    throw InputError("bad-tool-library", {library.path},
                     codes.empty()
                         ? "no item of the file has a cutting diameter (DC)"
                         : "its properties have codes alone and no symbols (DC, RE, APMX ..): " + codes,
                     "write the tool as [[tool]] in a .toml: diameter_mm is its DC, corner_radius_mm RE, "
                     "flute_length_mm APMX, length_mm LPR");
  }
  int number = 0;
  for (const P21Item& item : found.items) {
    library.add(++number, item.id.empty() ? fmt::format("line {}", item.line) : item.id, [&] {
      std::string taken;
      if (inserts && !has(item, "RE"))
        throw Lacking("its corner is that of an insert, another item of the file");
      Cutter c = p21_tool(item, taken);
      c.name = p21_name(item.id);
      if (!taken.empty()) assumed.emplace(number, taken);
      return c;
    });
  }
}

}  // namespace

bool is_tool_library(const std::string& path) {
  const std::string ending = lower_case(fs::path(path).extension().string());
  return ending == ".json" || ending == ".fctl" || ending == ".fctb" || ending == ".p21";
}

std::vector<Cutter> read_tool_library(const std::string& path, std::map<int, std::string>& incomplete,
                                      std::map<int, std::string>& assumed) {
  const std::string ending = lower_case(fs::path(path).extension().string());
  Library library{path, incomplete, {}, {}};
  if (ending == ".p21") {
    read_p21(library, assumed);
    return std::move(library.tools);
  }
  const json root = load_json(path);
  if (ending == ".json") read_fusion(root, library);
  if (ending == ".fctl") read_freecad_library(root, library);
  if (ending == ".fctb")
    library.add(1, fs::path(path).filename().string(), [&] { return freecad_tool(root); });
  return std::move(library.tools);
}

std::vector<std::pair<std::string, std::string>> tool_library_parts(const std::string& path) {
  std::vector<std::pair<std::string, std::string>> parts;
  if (lower_case(fs::path(path).extension().string()) != ".fctl") return parts;
  const json library = load_json(path);
  for (const json& tool : part_of(library, "tools")) {
    const std::string name = text_at(tool, "path");
    const std::string file = bit_file(path, name);
    if (!file.empty()) parts.emplace_back(name, file);
  }
  return parts;
}

}  // namespace swarf::sim

#include "sim/job/tool_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>

#include "program/source_text.h"
#include "sim/job/cutter_keys.h"
#include "sim/job/tool_library.h"
#include "sim/job/tool_words.h"

namespace swarf::sim {
namespace {

using cutter::Cutter;

/// Lengths and diameters of two descriptions of one tool agree within this, mm.
constexpr double kSame = 1e-3;

struct Described {
  Cutter cutter;
  SourceLocation where;
};

/// The words of one line of a .tbl, by letter.
class TblLine {
 public:
  /// `incomplete`: what a line lacks is kept there, to be told where the tool is called; null: it is an
  /// error.
  TblLine(std::string_view text, SourceLocation where, Diagnostics& diagnostics, IncompleteTools* incomplete)
      : where_(std::move(where)), diagnostics_(diagnostics), incomplete_(incomplete) {
    const size_t semicolon = std::min(text.find(';'), text.size());
    comment_ = text.substr(std::min(semicolon + 1, text.size()));
    std::transform(comment_.begin(), comment_.end(), comment_.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    read_words(text.substr(0, semicolon));
  }

  bool good() const { return good_; }
  bool empty() const { return words_.empty(); }

  /// T0 is no tool: the spindle is empty.
  bool none() { return incomplete_ != nullptr && words_.count('T') != 0 && words_['T'] == 0.0; }

  /// T, Z and D as a cutter; the rest must be zero.
  Described tool() {
    read_number();
    for (const char letter : {'T', 'Z', 'D'}) {
      if (words_.count(letter) != 0) continue;
      lack("missing-tool-word", fmt::format("the tool has no word {}", letter),
           "T is its number, Z its length from the gauge line to the tip, D its diameter (mm)");
    }
    for (const char letter : {'X', 'Y', 'A', 'B', 'C', 'U', 'V', 'W'}) {
      if (words_.count(letter) == 0 || words_[letter] == 0.0) continue;
      lack("unsupported-tool-offset", fmt::format("the tool has an offset {}{:g}", letter, words_[letter]),
           "only lengths along the tool axis (Z) are known");
    }
    for (const char letter : {'Z', 'D'}) {
      if (words_.count(letter) == 0 || words_[letter] > 0.0) continue;
      lack("bad-tool-line", fmt::format("{} is {:g} mm", letter, words_[letter]), "give it above 0");
    }
    Cutter c;
    c.number = number_ > 0 ? number_ : 1;
    c.diameter_mm = words_['D'];
    c.shape = comment_.find("ball") != std::string::npos ? cutter::Shape::kBall : cutter::Shape::kFlat;
    if (c.shape == cutter::Shape::kBall) c.corner_radius_mm = c.radius();
    c.shank_diameter_mm = c.diameter_mm;
    c.gauge_length_mm = c.flute_length_mm = c.length_mm = words_['Z'];
    c.holder = {{c.diameter_mm, c.diameter_mm, 1.0}};
    return {c, where_};
  }

 private:
  void read_number() {
    if (words_.count('T') == 0) return;
    constexpr double kLargestNumber = 1e9;
    const double number = words_['T'];
    if (number >= 1.0 && number <= kLargestNumber && number == std::floor(number))
      number_ = static_cast<int>(number);
    else
      fail("bad-tool-line", fmt::format("T{:g} is no tool number", number), "a whole number above 0");
  }

  void read_words(std::string_view text) {
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    const auto skip = [&] {
      while (at < end && std::isspace(static_cast<unsigned char>(*at)) != 0) ++at;
    };
    for (skip(); at < end && good_; skip()) {
      where_.column = static_cast<int>(at - text.data()) + 1;
      const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(*at)));
      if (std::string_view("TPXYZABCUVWDIJQ").find(letter) == std::string_view::npos) {
        fail("bad-tool-line", fmt::format("'{}' is no word of a tool table", *at),
             "T, P, X, Y, Z, A, B, C, U, V, W, D, I, J, Q and a number each; a comment follows a semicolon");
        return;
      }
      if (++at < end && *at == '+') ++at;
      double value = 0.0;
      const auto [next, failure] = std::from_chars(at, end, value);
      if (failure != std::errc() || !std::isfinite(value)) {
        fail("bad-tool-line", fmt::format("{} has no number", letter), "write it as Z81.5");
        return;
      }
      if (!words_.emplace(letter, value).second) {
        fail("bad-tool-line", fmt::format("{} stands twice in one line", letter), "one line for each tool");
      }
      at = next;
    }
    where_.column = 1;
  }

  void fail(const char* code, const std::string& text, const char* fix) {
    good_ = false;
    diagnostics_.error(code, where_, text, fix);
  }

  /// The line is one of a table, and its tool cannot be used.
  void lack(const char* code, const std::string& text, const char* fix) {
    if (incomplete_ == nullptr || number_ == 0) return fail(code, text, fix);
    incomplete_->emplace(number_, fmt::format("{}:{}: {}", where_.file, where_.line, text));
    good_ = false;
  }

  SourceLocation where_;
  Diagnostics& diagnostics_;
  IncompleteTools* incomplete_;
  std::string comment_;
  std::map<char, double> words_;
  int number_ = 0;  ///< of T; 0: none that could be called
  bool good_ = true;
};

void warn_of_shape(const Described& tool, Diagnostics& diagnostics) {
  const Cutter& c = tool.cutter;
  diagnostics.warning(
      "tool-shape-assumed", tool.where,
      fmt::format("{} is taken as a {} end of D {:g} mm with flutes all of its {:g} mm: a .tbl says no more, "
                  "and its shank and holder are not checked",
                  cutter::call_name(c), cutter::shape_name(c.shape), c.diameter_mm, c.length_mm),
      fmt::format("describe it: [[tool]] number = {}", c.number));
}

std::vector<Described> read_tbl_lines(const std::string& path, Diagnostics& diagnostics,
                                      IncompleteTools* incomplete) {
  const std::string text = program::read_file(path);
  std::vector<Described> tools;
  int number = 0;
  for (const std::string_view line : program::split_lines(text)) {
    TblLine words(line, {path, ++number, 1}, diagnostics, incomplete);
    if (!words.good() || words.empty() || words.none()) continue;
    Described tool = words.tool();
    if (words.good()) tools.push_back(std::move(tool));
  }
  if (tools.empty() && !diagnostics.has_errors() && (incomplete == nullptr || incomplete->empty())) {
    diagnostics.error("no-tools", {path}, "the tool table has no tool", "one line for each: T1 P1 Z81.5 D8");
  }
  return tools;
}

/// Names end up in CSV files and program texts.
void check_name(const Described& tool, Diagnostics& diagnostics) {
  const std::string& name = tool.cutter.name;
  const bool good = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return c >= ' ' && c != ',' && c != '"' && c != 0x7f;
  });
  if (tool.cutter.number == 0 && name.empty()) {
    diagnostics.error("tool-unnamed", tool.where, "the tool has neither a number nor a name",
                      "number = 1, or name = \"MILL_10\" as the program calls it");
  } else if (!good || (!name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) != 0 &&
                       std::all_of(name.begin(), name.end(), ::isdigit))) {
    diagnostics.error("bad-tool-name", tool.where, fmt::format("'{}' cannot be a tool's name", name),
                      "letters, digits, blanks and signs but no comma or quotation mark, and not a number");
  }
}

void check_twice(const std::vector<Described>& tools, Diagnostics& diagnostics) {
  for (size_t i = 0; i < tools.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const Cutter &a = tools[i].cutter, &b = tools[k].cutter;
      const bool number = a.number > 0 && a.number == b.number;
      if (!number && (a.name.empty() || a.name != b.name)) continue;
      diagnostics.error(
          "tool-twice", tools[i].where,
          tools[i].where.line == tools[k].where.line && tools[i].where.file == tools[k].where.file
              ? fmt::format("{} is described twice", cutter::call_name(a))
              : fmt::format("{} is described at {}:{} already", cutter::call_name(a), tools[k].where.file,
                            tools[k].where.line),
          "give each tool a number or a name of its own");
    }
  }
}

std::vector<Described> read_entries(ConfigTable& table) {
  std::vector<Described> tools;
  for (ConfigTable& entry : table.tables("tool")) tools.push_back({read_tool(entry), entry.where()});
  return tools;
}

/// Adds the tools of a .tbl to those that TOML describes.
void join_tbl(std::vector<Described>& tools, const std::vector<Described>& measured, Diagnostics& diagnostics,
              IncompleteTools* incomplete) {
  check_twice(measured, diagnostics);
  // A tool that a [[tool]] describes needs no line.
  for (const Described& tool : tools) {
    if (incomplete == nullptr || incomplete->count(tool.cutter.number) == 0) continue;
    diagnostics.warning("tool-line-incomplete", tool.where,
                        fmt::format("{} is taken as described here; its line in the table is left out, {}",
                                    cutter::call_name(tool.cutter), incomplete->at(tool.cutter.number)),
                        "complete the line, or take it out");
    incomplete->erase(tool.cutter.number);
  }
  for (const Described& line : measured) {
    const auto same = std::find_if(tools.begin(), tools.end(), [&](const Described& tool) {
      return tool.cutter.number == line.cutter.number;
    });
    if (same == tools.end()) {
      const std::vector<cutter::Problem> problems = cutter::validate(line.cutter);
      if (!problems.empty() && incomplete != nullptr) {
        incomplete->emplace(line.cutter.number, fmt::format("{}:{}: {}", line.where.file, line.where.line,
                                                            problems.front().text));
        continue;
      }
      for (const cutter::Problem& problem : problems) {
        diagnostics.error("bad-tool-line", line.where, problem.text,
                          "mend Z or D, or describe the tool: [[tool]] number and shape");
      }
      warn_of_shape(line, diagnostics);
      tools.push_back(line);
      continue;
    }
    Cutter& ours = same->cutter;
    const double length = *line.cutter.gauge_length_mm;
    const bool lengths = !ours.gauge_length_mm || std::abs(*ours.gauge_length_mm - length) <= kSame;
    if (!lengths || std::abs(ours.diameter_mm - line.cutter.diameter_mm) > kSame) {
      diagnostics.error("tool-contradiction", same->where,
                        fmt::format("{} has D {:g} mm and length {:g} mm, {}:{} says D {:g} and Z {:g}",
                                    cutter::call_name(ours), ours.diameter_mm, cutter::gauge_length(ours),
                                    line.where.file, line.where.line, line.cutter.diameter_mm, length),
                        "mend one of the two; gauge_length_mm may be left out here");
    }
    ours.gauge_length_mm = length;
  }
}

/// Without `incomplete` a warning names each tool that cannot be used.
void add_library(std::vector<Described>& tools, const std::string& file, Diagnostics& diagnostics,
                 IncompleteTools* incomplete) {
  IncompleteTools lacking, assumed;
  try {
    for (Cutter& tool : read_tool_library(file, lacking, assumed)) tools.push_back({std::move(tool), {file}});
  } catch (const InputError& error) {
    diagnostics.append(error.diagnostics);
  }
  for (const auto& [number, what] : assumed)
    diagnostics.warning("tool-shape-assumed", {file}, fmt::format("T{}: {}", number, what),
                        "describe it as [[tool]] if it is otherwise");
  for (const auto& [number, reason] : lacking) {
    if (incomplete != nullptr) {
      incomplete->emplace(number, reason);
    } else {
      diagnostics.warning("tool-left-out", {file}, fmt::format("T{} cannot be used, {}", number, reason),
                          "complete it in the library, or describe it as [[tool]]");
    }
  }
}

/// Appends what a table file describes.
void add_table(std::vector<Described>& tools, const std::string& table_file, Diagnostics& diagnostics,
               IncompleteTools* incomplete) {
  if (std::filesystem::path(table_file).extension() == ".tbl") {
    join_tbl(tools, read_tbl_lines(table_file, diagnostics, incomplete), diagnostics, incomplete);
    return;
  }
  if (is_tool_library(table_file)) return add_library(tools, table_file, diagnostics, incomplete);
  ConfigTable table = ConfigTable::load(table_file, {}, diagnostics);
  for (Described& tool : read_entries(table)) tools.push_back(std::move(tool));
  table.finish();
}

/// Names and numbers checked.
std::vector<Cutter> cutters_of(std::vector<Described>& tools, Diagnostics& diagnostics) {
  for (const Described& tool : tools) check_name(tool, diagnostics);
  check_twice(tools, diagnostics);
  std::vector<Cutter> cutters;
  for (Described& tool : tools) cutters.push_back(std::move(tool.cutter));
  return cutters;
}

/// The scene's `tools`.
std::vector<Cutter> read_word_tools(ConfigTable& scene, const std::string& table_file,
                                    Diagnostics& diagnostics) {
  const SourceLocation where = scene.where("tools");
  const std::string list = scene.text("tools");
  if (scene.has("cutter") || scene.has("tool") || !table_file.empty())
    scene.error("two-tool-sets", "tools", "the scene has `tools` beside [cutter], [[tool]] or tool_table",
                "keep one of them");
  std::vector<Described> tools;
  for (Cutter& tool : read_tool_words(list, where, diagnostics)) tools.push_back({std::move(tool), where});
  if (tools.empty()) return {Cutter{}};
  if (tools.size() == 1 && tools[0].cutter.number == 0 && tools[0].cutter.name.empty())
    return {std::move(tools[0].cutter)};
  return cutters_of(tools, diagnostics);
}

Cutter read_only_cutter(ConfigTable& scene) {
  if (scene.has("cutter")) return read_cutter(scene.table("cutter"));
  scene.error("missing-key", "tools", "the scene has no tool",
              "--tool 6 is a flat end of 6 mm, --tools T1=6,T2=ball4,T3=drill5 are several; in a scene "
              "tools = \"T1=6,T2=ball4\", or each as [[tool]], one as [cutter], a file as tool_table");
  return {};
}

}  // namespace

std::vector<Cutter> read_tools(ConfigTable& scene, const std::string& table_file, Diagnostics& diagnostics,
                               IncompleteTools* incomplete) {
  if (scene.has("tools")) return read_word_tools(scene, table_file, diagnostics);
  if (!scene.has("tool") && table_file.empty()) return {read_only_cutter(scene)};
  if (scene.has("cutter")) {
    scene.error("two-tool-sets", "cutter", "the scene has [cutter] beside [[tool]] or tool_table",
                "describe every tool as [[tool]]");
    read_cutter(scene.table("cutter"));
  }
  std::vector<Described> tools = read_entries(scene);
  if (!table_file.empty()) add_table(tools, table_file, diagnostics, incomplete);
  if (tools.empty() && !diagnostics.has_errors() && (incomplete == nullptr || incomplete->empty())) {
    diagnostics.error("no-tools", {table_file}, "the table has no tool with a number",
                      "give its tools numbers, or describe them: [[tool]] number and shape");
  }
  return cutters_of(tools, diagnostics);
}

std::vector<Cutter> read_tool_table(const std::string& table_file, Diagnostics& diagnostics,
                                    IncompleteTools* incomplete) {
  std::vector<Described> tools;
  add_table(tools, table_file, diagnostics, incomplete);
  if (tools.empty() && !diagnostics.has_errors() && (incomplete == nullptr || incomplete->empty())) {
    diagnostics.error("no-tools", {table_file, 0, 0}, "the table has no tool", "describe at least one");
  }
  return cutters_of(tools, diagnostics);
}

int tool_index(const std::vector<Cutter>& tools, int number, const std::string& name) {
  for (size_t i = 0; i < tools.size(); ++i) {
    if (number > 0 ? tools[i].number == number : tools[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

std::string list_tools(const std::vector<Cutter>& tools) {
  std::string list;
  for (const Cutter& tool : tools) list += (list.empty() ? "" : ", ") + cutter::call_name(tool);
  return list;
}

}  // namespace swarf::sim

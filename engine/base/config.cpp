#include "base/config.h"
#include "base/file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>
#include <utility>

namespace swarf {
namespace {

constexpr double kInchMm = 25.4;

/// A key that counts in mm, spelt in inches: box_mm is box_in, speed_max_mm_min is speed_max_in_min. "" for
/// other keys.
std::string inch_key(const std::string& key) {
  const size_t at = key.rfind("_mm");
  if (at == std::string::npos || (at + 3 < key.size() && key[at + 3] != '_')) return "";
  return key.substr(0, at) + "_in" + key.substr(at + 3);
}

/// A value with the key that it stands under; null: absent.
struct Written {
  const toml::node* node = nullptr;
  std::string key;
  double unit = 1.0;  ///< of a number as written, in the unit of the key that was asked for

  /// An array of finite numbers, and of nothing else.
  std::optional<std::vector<double>> row(const toml::node* array) const {
    if (array == nullptr || !array->is_array()) return {};
    std::vector<double> numbers;
    for (const toml::node& item : *array->as_array()) {
      const std::optional<double> number = item.is_number() ? item.value<double>() : std::nullopt;
      if (!number || !std::isfinite(*number)) return {};
      numbers.push_back(unit * *number);
    }
    return numbers;
  }
  /// An array of rows of as many numbers as a Point has; empty where it is anything else.
  template <typename Point>
  std::vector<Point> points() const {
    std::vector<Point> found;
    if (node == nullptr || !node->is_array()) return {};
    for (const toml::node& item : *node->as_array()) {
      const std::optional<std::vector<double>> numbers = row(&item);
      if (!numbers || numbers->size() != static_cast<size_t>(Point::RowsAtCompileTime)) return {};
      found.emplace_back(Eigen::Map<const Point>(numbers->data()));
    }
    return found;
  }
};

}  // namespace

struct ConfigTable::Node {
  std::shared_ptr<toml::table> root;   ///< keeps `table` alive
  const toml::table* table = nullptr;  ///< null: absent, reads as empty
  std::string name;                    ///< dotted, for messages: "stock."
  std::string file;
  SourceLocation place;
  Diagnostics* diagnostics = nullptr;
  std::set<std::string> known;
  std::vector<std::shared_ptr<Node>> children;

  /// The value of this key, or of its spelling in inches.
  Written written(const std::string& key) const {
    if (table == nullptr) return {nullptr, key};
    const toml::node* as_asked = table->get(key);
    const std::string inches = inch_key(key);
    if (as_asked != nullptr || inches.empty() || table->get(inches) == nullptr) return {as_asked, key};
    return {table->get(inches), inches, kInchMm};
  }
  Written find(const std::string& key) {
    known.insert(key);
    return written(key);
  }
  /// The known key that this one is in another unit; "": none.
  std::string known_in_mm(const std::string& inches) const {
    const auto is = [&](const std::string& one) { return inch_key(one) == inches; };
    const auto found = std::find_if(known.begin(), known.end(), is);
    return found == known.end() ? "" : *found;
  }
  /// Reports a key that nobody asked for, and one that stands in two units.
  void judge(const toml::key& key) const;
};

namespace {

SourceLocation location(const std::string& file, const toml::source_region& source) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

Range in_unit(double unit, const Range& range) {
  return {range.low / unit, range.high / unit, range.low_open};
}

std::string bounds_text(const Range& range) {
  const bool has_low = std::isfinite(range.low);
  const bool has_high = std::isfinite(range.high);
  if (has_low && has_high) return fmt::format("from {:g} to {:g}", range.low, range.high);
  if (has_low && range.low_open) return fmt::format("above {:g}", range.low);
  if (has_low) return fmt::format("{:g} or more", range.low);
  if (has_high) return fmt::format("at most {:g}", range.high);
  return "a finite number";
}

bool inside(double value, const Range& range) {
  return std::isfinite(value) && value >= range.low && value <= range.high &&
         !(range.low_open && value == range.low);
}

/// The spelling of a key in its other unit, mm or inches; "": it has none.
std::string other_unit(const toml::table& table, const std::string& key) {
  if (const std::string inches = inch_key(key); !inches.empty()) return inches;
  for (const auto& [one, value] : table) {
    if (inch_key(std::string(one.str())) == key) return std::string(one.str());
  }
  return "";
}

/// The table of that name, made where there is none; "tool[1]": the second [[tool]], which there must be.
/// Null: no table.
toml::table* table_to_set(toml::table& table, const std::string& name) {
  const auto bracket = name.find('[');
  if (bracket == std::string::npos) {
    if (!table.contains(name)) table.insert(name, toml::table{});
    return table.get(name)->as_table();
  }
  size_t index = 0;
  const char* const end = name.data() + name.size();
  const auto [next, failure] = std::from_chars(name.data() + bracket + 1, end, index);
  const toml::node* const rows = table.get(name.substr(0, bracket));
  const bool said =
      failure == std::errc() && next + 1 == end && *next == ']' && rows != nullptr && rows->is_array();
  toml::array* const array = said ? table.get(name.substr(0, bracket))->as_array() : nullptr;
  return array == nullptr || index >= array->size() ? nullptr : array->get(index)->as_table();
}

/// The value of an override: as in a file, a number without a digit before its point, or a bare word.
toml::table parse_override(const std::string& value) {
  try {
    return toml::parse(fmt::format("value = {}", value));
  } catch (const toml::parse_error&) {
    double number = 0.0;
    const char* const end = value.data() + value.size();
    const auto [stop, failure] = std::from_chars(value.data(), end, number);
    if (failure == std::errc() && stop == end) return toml::table{{"value", number}};
    return toml::table{{"value", value}};
  }
}

/// The last override of a key wins, whatever stood in the file, in mm or in inches.
void apply_override(toml::table& root, const std::string& text, Diagnostics& diagnostics) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    diagnostics.error("bad-override", {"--set"}, fmt::format("'{}' is not of the form key=value", text),
                      "write for example --set stock.voxel_mm=0.1");
    return;
  }
  const toml::table parsed = parse_override(text.substr(equals + 1));
  toml::table* table = &root;
  std::string path = text.substr(0, equals);
  for (auto dot = path.find('.'); dot != std::string::npos; dot = path.find('.')) {
    const std::string head = path.substr(0, dot);
    path = path.substr(dot + 1);
    table = table_to_set(*table, head);
    if (table == nullptr) {
      diagnostics.error(
          "bad-override", {"--set"}, fmt::format("'{}' in '{}' is not a table", head, text),
          "name a key inside a table of the scene; of the second [[tool]]: tool[1].diameter_mm");
      return;
    }
  }
  table->erase(other_unit(*table, path));
  table->insert_or_assign(path, *parsed.get("value"));
}

bool holds(const std::vector<std::string>& names, const std::string& key) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return name == key || inch_key(name) == key; });
}

/// Moved, not copied: a copy of a node does not know its place in the file.
void move_key(toml::table& from, const std::string& key, toml::table& to) {
  const toml::table::iterator found = from.find(key);
  const toml::key placed = found->first;
  to.erase(other_unit(to, key));
  to.erase(key);
  found->second.visit([&](auto& value) { to.insert_or_assign(placed, std::move(value)); });
  from.erase(found);
}

std::vector<std::string> keys_of(const toml::table& table) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : table) keys.emplace_back(key.str());
  return keys;
}

/// What stands in `over` has no other of its group below it.
void clear_groups(toml::table& root, const toml::table& over, const ConfigOverlay& overlay) {
  for (const std::vector<std::string>& group : overlay.instead) {
    const bool said = std::any_of(group.begin(), group.end(),
                                  [&](const std::string& key) { return over.get(key) != nullptr; });
    if (!said) continue;
    for (const std::string& key : group) root.erase(key);
  }
}

void lay_over(toml::table& root, const ConfigOverlay& overlay) {
  toml::array* const list = root.get(overlay.list) != nullptr ? root.get(overlay.list)->as_array() : nullptr;
  toml::table* const over =
      list != nullptr && overlay.index < list->size() ? list->get(overlay.index)->as_table() : nullptr;
  if (over == nullptr) return;
  clear_groups(root, *over, overlay);
  toml::table own;
  for (const std::string& key : keys_of(*over)) {
    toml::table* const inner = over->get(key)->as_table();
    toml::table* const below = root.get(key) != nullptr ? root.get(key)->as_table() : nullptr;
    if (key == overlay.list || holds(overlay.own, key)) {
      move_key(*over, key, own);
    } else if (inner != nullptr && below != nullptr && holds(overlay.joined, key)) {
      for (const std::string& one : keys_of(*inner)) move_key(*inner, one, *below);
    } else {
      move_key(*over, key, root);
    }
  }
  root.insert_or_assign(overlay.list, std::move(own));
}

/// Of the list itself, before one of it is laid over the root.
bool is_for_list(const std::string& override_text, const ConfigOverlay& overlay) {
  return override_text.starts_with(overlay.list + "[");
}

std::optional<std::string> read_file(const std::string& path, Diagnostics& diagnostics) {
  refuse_special_file(path);
  // A folder opens like a file and cannot be read.
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    diagnostics.error("file-not-found", {path}, "this is a folder", "name a TOML file: scene.toml in it");
    return {};
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    diagnostics.error("file-not-found", {path}, "the file cannot be opened",
                      "check the path and its spelling");
    return {};
  }
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    diagnostics.error("empty-file", {path}, "the file is empty",
                      "write the scene or machine into it, or name another file");
    return {};
  }
  const auto nul = text.find('\0');
  if (nul != std::string::npos) {
    diagnostics.error("not-text", {path}, fmt::format("byte {} is NUL: this is not a text file", nul + 1),
                      "name a TOML file (UTF-8 text)");
    return {};
  }
  return text;
}

}  // namespace

void ConfigTable::Node::judge(const toml::key& key) const {
  const std::string written(key.str());
  if (known.count(written) > 0) return;
  // The key itself is what is misspelt, so its place is shown, not its value's.
  const toml::source_region& source = key.source();
  const SourceLocation at = source.begin ? location(file, source) : SourceLocation{"--set " + name + written};
  if (const std::string in_mm = known_in_mm(written); !in_mm.empty()) {
    if (table->get(in_mm) != nullptr)
      diagnostics->error("two-units", at,
                         fmt::format("both '{}{}' and '{}{}' are given", name, in_mm, name, written),
                         "keep one of them");
    return;
  }
  std::vector<std::string> names(known.begin(), known.end());
  const std::string listed = fmt::format("known here: {}", fmt::join(names, ", "));
  for (const std::string& one : known) {
    if (!inch_key(one).empty()) names.push_back(inch_key(one));
  }
  const std::string near = nearest_name(written, names);
  diagnostics->error("unknown-key", at, fmt::format("nothing is called '{}{}'", name, written),
                     near.empty() ? listed : fmt::format("did you mean '{}'?", near));
}

ConfigTable::ConfigTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}

ConfigTable ConfigTable::load(const std::string& path, const std::vector<std::string>& overrides,
                              Diagnostics& diagnostics, const ConfigOverlay* overlay) {
  const std::optional<std::string> text = read_file(path, diagnostics);
  if (text) return parse(*text, path, overrides, diagnostics, overlay);
  auto empty = std::make_shared<Node>();
  empty->file = path;
  empty->place = {path};
  empty->diagnostics = &diagnostics;
  return ConfigTable(std::move(empty));
}

ConfigTable ConfigTable::parse(const std::string& text, const std::string& name,
                               const std::vector<std::string>& overrides, Diagnostics& diagnostics,
                               const ConfigOverlay* overlay) {
  auto node = std::make_shared<Node>();
  node->file = name;
  node->place = {name};
  node->diagnostics = &diagnostics;
  try {
    node->root = std::make_shared<toml::table>(toml::parse(text, name));
  } catch (const toml::parse_error& failure) {
    diagnostics.error("toml-syntax", location(name, failure.source()), std::string(failure.description()),
                      "mend the TOML syntax at this place");
    return ConfigTable(std::move(node));
  }
  for (const std::string& one : overrides) {
    if (overlay != nullptr && is_for_list(one, *overlay)) apply_override(*node->root, one, diagnostics);
  }
  if (overlay != nullptr) lay_over(*node->root, *overlay);
  for (const std::string& one : overrides) {
    if (overlay == nullptr || !is_for_list(one, *overlay)) apply_override(*node->root, one, diagnostics);
  }
  node->table = node->root.get();
  return ConfigTable(std::move(node));
}

bool ConfigTable::has(const std::string& key) const {
  return node_->find(key).node != nullptr;
}

bool ConfigTable::is_text(const std::string& key) const {
  const toml::node* value = node_->find(key).node;
  return value != nullptr && value->is_string();
}

bool ConfigTable::is_list(const std::string& key) const {
  const toml::node* value = node_->find(key).node;
  return value != nullptr && value->is_array();
}

SourceLocation ConfigTable::where() const {
  return node_->place;
}

SourceLocation ConfigTable::where(const std::string& key) const {
  const Written value = node_->written(key);
  if (value.node == nullptr) return node_->place;
  if (!value.node->source().begin) return {"--set " + node_->name + value.key};
  return location(node_->file, value.node->source());
}

std::vector<std::string> ConfigTable::keys() const {
  std::vector<std::string> names;
  if (node_->table == nullptr) return names;
  for (const auto& [key, value] : *node_->table) names.emplace_back(key.str());
  return names;
}

void ConfigTable::error(const std::string& code, const std::string& key, const std::string& text,
                        const std::string& fix) {
  node_->diagnostics->error(code, where(key), text, fix);
}

double ConfigTable::number(const std::string& key, Range range, std::optional<double> fallback) {
  const Written value = node_->find(key);
  if (value.node == nullptr) {
    if (!fallback)
      error("missing-key", key, fmt::format("'{}{}' is missing", node_->name, key),
            fmt::format("add {} = a number {}", key, bounds_text(range)));
    return fallback.value_or(0.0);
  }
  const std::string bounds = bounds_text(in_unit(value.unit, range));
  const std::optional<double> found = value.node->value<double>();
  if (!value.node->is_number() || !found) {
    error("wrong-type", key, fmt::format("'{}{}' must be a number", node_->name, value.key),
          fmt::format("write {} = a number {}", value.key, bounds));
    return fallback.value_or(0.0);
  }
  if (!inside(value.unit * *found, range)) {
    error("out-of-range", key, fmt::format("'{}{}' is {:g}", node_->name, value.key, *found),
          fmt::format("it must be {}", bounds));
    return fallback.value_or(0.0);
  }
  return value.unit * *found;
}

int ConfigTable::integer(const std::string& key, int low, int high, std::optional<int> fallback) {
  const double value = number(key, {static_cast<double>(low), static_cast<double>(high)},
                              fallback ? std::optional<double>(*fallback) : std::nullopt);
  if (value != std::floor(value)) {
    error("wrong-type", key, fmt::format("'{}{}' is {:g}", node_->name, key, value),
          "it must be a whole number");
  }
  return static_cast<int>(value);
}

bool ConfigTable::boolean(const std::string& key, std::optional<bool> fallback) {
  const toml::node* value = node_->find(key).node;
  if (value != nullptr && value->is_boolean()) return *value->value<bool>();
  if (value != nullptr || !fallback) {
    error(value == nullptr ? "missing-key" : "wrong-type", key,
          fmt::format("'{}{}' must be true or false", node_->name, key),
          fmt::format("write {} = true or false", key));
  }
  return fallback.value_or(false);
}

std::string ConfigTable::text(const std::string& key, const std::optional<std::string>& fallback) {
  const toml::node* value = node_->find(key).node;
  if (value != nullptr && value->is_string()) return *value->value<std::string>();
  if (value != nullptr || !fallback) {
    error(value == nullptr ? "missing-key" : "wrong-type", key,
          fmt::format("'{}{}' {}", node_->name, key,
                      value == nullptr ? "is missing" : "must be a text in quotes"),
          fmt::format("write {} = \"...\"", key));
  }
  return fallback.value_or("");
}

std::string ConfigTable::choice(const std::string& key, const std::vector<std::string>& words,
                                const std::optional<std::string>& fallback) {
  const std::string word = text(key, fallback);
  for (const std::string& candidate : words) {
    if (word == candidate) return word;
  }
  if (has(key)) {
    const std::string near = nearest_name(word, words);
    error("unknown-choice", key, fmt::format("'{}{}' is \"{}\"", node_->name, key, word),
          (near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near)) +
              fmt::format("it must be one of: {}", fmt::join(words, ", ")));
  }
  return fallback.value_or(words.front());
}

std::vector<std::string> ConfigTable::choices(const std::string& key, const std::vector<std::string>& words,
                                              const std::vector<std::string>& fallback) {
  const toml::node* value = node_->find(key).node;
  if (value == nullptr) return fallback;
  std::vector<std::string> found;
  bool right = value->is_array();
  for (size_t i = 0; right && i < value->as_array()->size(); ++i) {
    found.push_back(value->as_array()->at(i).value_or(std::string()));
    right = std::find(words.begin(), words.end(), found.back()) != words.end();
  }
  if (right) return found;
  error("unknown-choice", key, fmt::format("'{}{}' must be an array of known words", node_->name, key),
        fmt::format("write {} = [\"{}\"]", key, fmt::join(words, "\", \"")));
  return fallback;
}

std::vector<std::string> ConfigTable::texts(const std::string& key,
                                            const std::vector<std::string>& fallback) {
  const toml::node* value = node_->find(key).node;
  if (value == nullptr) return fallback;
  std::vector<std::string> found;
  bool right = value->is_array();
  for (size_t i = 0; right && i < value->as_array()->size(); ++i) {
    const toml::node& one = *value->as_array()->get(i);
    right = one.is_string();
    if (right) found.push_back(one.as_string()->get());
  }
  if (right) return found;
  error("wrong-type", key, fmt::format("'{}{}' must be an array of texts", node_->name, key),
        fmt::format("write {} = [\"a\", \"b\"]", key));
  return fallback;
}

std::vector<double> ConfigTable::numbers(const std::string& key, size_t count,
                                         const std::optional<std::vector<double>>& fallback) {
  const Written value = node_->find(key);
  const std::vector<double> otherwise = fallback.value_or(std::vector<double>(count, 0.0));
  if (value.node == nullptr && fallback) return otherwise;
  const std::optional<std::vector<double>> found = value.row(value.node);
  if (found && found->size() == count) return *found;
  error(value.node == nullptr ? "missing-key" : "wrong-type", key,
        fmt::format("'{}{}' must be an array of {} finite numbers", node_->name, value.key, count),
        fmt::format("write {} = [{}]", value.key, count == 2 ? "a, b" : "a, b, c"));
  return otherwise;
}

std::vector<Vec3> ConfigTable::points(const std::string& key) {
  const Written value = node_->find(key);
  const std::vector<Vec3> found = value.points<Vec3>();
  if (!found.empty()) return found;
  error(value.node == nullptr ? "missing-key" : "wrong-type", key,
        fmt::format("'{}{}' must be an array of rows of three finite numbers", node_->name, value.key),
        fmt::format("write {} = [[x, y, z], [x, y, z]]", value.key));
  return {};
}

std::vector<Vec2> ConfigTable::flat_points(const std::string& key) {
  const Written value = node_->find(key);
  const std::vector<Vec2> found = value.points<Vec2>();
  if (!found.empty()) return found;
  error(value.node == nullptr ? "missing-key" : "wrong-type", key,
        fmt::format("'{}{}' must be an array of rows of two finite numbers", node_->name, value.key),
        fmt::format("write {} = [[x, y], [x, y]]", value.key));
  return {};
}

Box ConfigTable::box(const std::string& key) {
  const Written value = node_->find(key);
  const std::vector<Vec3> found = value.points<Vec3>();
  if (found.size() != 2) {
    error(value.node == nullptr ? "missing-key" : "wrong-type", key,
          fmt::format("'{}{}' must be two corners in {}", node_->name, value.key,
                      value.key == key ? "mm" : "inches"),
          fmt::format("write {} = [[x0, y0, z0], [x1, y1, z1]]", value.key));
    return {Vec3::Zero(), Vec3::Ones()};
  }
  const Box box{found[0], found[1]};
  if (!(box.size().minCoeff() > 0.0)) {
    error("out-of-range", key,
          fmt::format("'{}{}' has size {:g} x {:g} x {:g} mm", node_->name, value.key, box.size().x(),
                      box.size().y(), box.size().z()),
          "the first corner must lie below the second in x, y and z");
    return {Vec3::Zero(), Vec3::Ones()};
  }
  return box;
}

ConfigTable ConfigTable::table(const std::string& key) {
  auto child = std::make_shared<Node>();
  child->root = node_->root;
  child->name = node_->name + key + ".";
  child->file = node_->file;
  child->diagnostics = node_->diagnostics;
  child->place = where(key);
  const toml::node* value = node_->find(key).node;
  if (value != nullptr) {
    child->table = value->as_table();
    if (child->table == nullptr) {
      error("wrong-type", key, fmt::format("'{}{}' must be a table", node_->name, key),
            fmt::format("write [{}{}]", node_->name, key));
    }
  }
  node_->children.push_back(child);
  return ConfigTable(std::move(child));
}

std::vector<ConfigTable> ConfigTable::tables(const std::string& key) {
  std::vector<ConfigTable> list;
  const toml::node* value = node_->find(key).node;
  if (value == nullptr) return list;
  const toml::array* array = value->as_array();
  if (array == nullptr) {
    error("wrong-type", key, fmt::format("'{}{}' must be an array of tables", node_->name, key),
          fmt::format("write [[{}{}]]", node_->name, key));
    return list;
  }
  for (const toml::node& item : *array) {
    auto child = std::make_shared<Node>();
    child->root = node_->root;
    child->name = fmt::format("{}{}[{}].", node_->name, key, list.size());
    child->file = node_->file;
    child->diagnostics = node_->diagnostics;
    child->place = location(node_->file, item.source());
    child->table = item.as_table();
    if (child->table == nullptr) {
      node_->diagnostics->error("wrong-type", child->place,
                                fmt::format("an entry of '{}{}' is not a table", node_->name, key),
                                fmt::format("write [[{}{}]]", node_->name, key));
    }
    node_->children.push_back(child);
    list.push_back(ConfigTable(std::move(child)));
  }
  return list;
}

void ConfigTable::finish() {
  if (node_->table != nullptr) {
    for (const auto& [key, value] : *node_->table) node_->judge(key);
  }
  for (const auto& child : node_->children) ConfigTable(child).finish();
}

}  // namespace swarf

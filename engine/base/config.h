// Typed reading of TOML files with a diagnostic for everything that is wrong: syntax, type, range, a missing
// key, and every key that nobody asked for (with the nearest known one). A length whose key counts in mm may
// stand there in inches: `_in` in the key's place of `_mm` (diameter_in, box_in, speed_max_in_min); asked for
// and given is always mm. Both in one table are the error "two-units".
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/frames.h"

namespace swarf {

/// Bounds of a number; the message states them with the unit that the key's name ends in.
struct Range {
  double low = -std::numeric_limits<double>::infinity();  ///< in the unit of the key
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;  ///< the value must be above `low`, not equal to it
};
inline constexpr Range kAboveZero{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range kZeroOrMore{0.0, std::numeric_limits<double>::infinity(), false};

/// One of the tables [[list]] of a file, to be laid over its root: what stands in it takes the place of what
/// the root says. Overrides that begin with "list[" are applied before, all others after.
struct ConfigOverlay {
  std::string list;
  size_t index = 0;
  std::vector<std::string> own;  ///< keys that do not go to the root, but to a table [list] there
  /// Keys of which a file has one: what is laid over removes the others of its group from the root.
  std::vector<std::vector<std::string>> instead;
  std::vector<std::string> joined;  ///< tables that are laid over key by key; others are replaced whole
};

/// One table of a TOML file. The keys that are read are the keys that are known; finish() reports the others.
class ConfigTable {
 public:
  /// Parses a whole file; each override is "dotted.key=value" with a TOML value (bare words are strings).
  /// Syntax errors, unreadable and empty files go to `diagnostics`, and the table is then empty.
  /// `overlay`: ignored where its list is not there.
  static ConfigTable load(const std::string& path, const std::vector<std::string>& overrides,
                          Diagnostics& diagnostics, const ConfigOverlay* overlay = nullptr);

  /// The same of a text that stands in no file; messages call it `name`.
  static ConfigTable parse(const std::string& text, const std::string& name,
                           const std::vector<std::string>& overrides, Diagnostics& diagnostics,
                           const ConfigOverlay* overlay = nullptr);

  bool has(const std::string& key) const;              ///< whether the key stands in this table
  bool is_text(const std::string& key) const;          ///< there, and in quotes
  bool is_list(const std::string& key) const;          ///< there, and an array
  SourceLocation where(const std::string& key) const;  ///< of the value, or of this table when it is absent
  SourceLocation where() const;                        ///< of this table
  std::vector<std::string> keys() const;               ///< all that stand in it, known or not

  /// With a default the key is optional; without one its absence is an error (and 0, "" or {} is returned).
  double number(const std::string& key, Range range, std::optional<double> fallback = {});
  /// A whole number from `low` to `high`.
  int integer(const std::string& key, int low, int high, std::optional<int> fallback = {});
  bool boolean(const std::string& key, std::optional<bool> fallback = {});
  std::string text(const std::string& key, const std::optional<std::string>& fallback = {});
  /// One of the given words.
  std::string choice(const std::string& key, const std::vector<std::string>& words,
                     const std::optional<std::string>& fallback = {});
  /// An array of such words.
  std::vector<std::string> choices(const std::string& key, const std::vector<std::string>& words,
                                   const std::vector<std::string>& fallback);
  /// An array of texts, whatever they are.
  std::vector<std::string> texts(const std::string& key, const std::vector<std::string>& fallback);
  /// A list of exactly `count` finite numbers.
  std::vector<double> numbers(const std::string& key, size_t count,
                              const std::optional<std::vector<double>>& fallback = {});
  /// [[x,y,z], ...] of at least one row; empty after a complaint.
  std::vector<Vec3> points(const std::string& key);
  /// The same of [[x,y], ...].
  std::vector<Vec2> flat_points(const std::string& key);
  /// [[x,y,z],[x,y,z]] with lower < upper in each direction.
  Box box(const std::string& key);

  /// A sub-table; absent ones read as empty, so that their defaults apply.
  ConfigTable table(const std::string& key);
  /// An array of tables ([[key]]).
  std::vector<ConfigTable> tables(const std::string& key);
  /// Reports every key of this table and of the sub-tables handed out that was never asked for.
  void finish();

  /// Adds an error that the reader has found, at the key's place.
  void error(const std::string& code, const std::string& key, const std::string& text,
             const std::string& fix);

 private:
  struct Node;
  explicit ConfigTable(std::shared_ptr<Node> node);
  std::shared_ptr<Node> node_;
};

}  // namespace swarf

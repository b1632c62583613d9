// What is wrong with the user's input: file, line, column, what is wrong, what would be right.
//
// Loaders collect every diagnostic they can find, then stop: a user mends a file once, not once per error.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace swarf {

struct SourceLocation {
  std::string file;
  int line = 0;    ///< 1-based; 0: the whole file
  int column = 0;  ///< 1-based; 0: the whole line
};

enum class Severity { kNote, kWarning, kError };

struct Diagnostic {
  std::string code;  ///< stable, kebab-case: "unknown-word"
  Severity severity = Severity::kError;
  SourceLocation where;
  std::string text;  ///< what is wrong, with units
  std::string fix;   ///< what would be right; may be empty for notes
};

/// "file:line:column: error: text [code]", then the fix on a line of its own.
std::string format(const Diagnostic& diagnostic);

class Diagnostics {
 public:
  void error(std::string code, SourceLocation where, std::string text, std::string fix);
  void warning(std::string code, SourceLocation where, std::string text, std::string fix = "");
  void note(std::string code, SourceLocation where, std::string text);
  void append(const Diagnostics& others);

  bool has_errors() const { return errors_ > 0; }
  const std::vector<Diagnostic>& list() const { return list_; }
  /// Throws InputError when there is an error among them.
  void throw_if_errors() const;

 private:
  std::vector<Diagnostic> list_;
  int errors_ = 0;
};

/// The input cannot be used; the program prints the diagnostics and exits with 2.
struct InputError : std::runtime_error {
  explicit InputError(Diagnostics found);
  /// One error in one place.
  InputError(std::string code, SourceLocation where, std::string text, std::string fix);
  Diagnostics diagnostics;
};

/// The candidate closest to `word` by edit distance, or "" when none is near enough to be meant.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace swarf

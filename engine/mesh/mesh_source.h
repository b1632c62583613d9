// What the readers of mesh files share: the bytes, the words of a text with their places, the bounds of a
// number, and the refusal that names file, line and column, or the byte.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/diagnostics.h"

namespace swarf::mesh {

/// Largest |x|, |y|, |z| of a vertex, mm: a kilometre, where a float still steps by 0.06 mm. Products of
/// three such lengths stay far inside float, so no library behind the readers ever meets an overflow.
inline constexpr float kFarthest = 1e6F;
/// Larger files are refused before they are read: 85 million facets of binary STL.
inline constexpr uint64_t kLargestFile = uint64_t{4} << 30U;

inline constexpr const char* kExportAgain = "export the mesh again: STL, PLY or OBJ in mm";

/// Throws InputError "mesh-unreadable".
[[noreturn]] void refuse_mesh(const SourceLocation& where, const std::string& text,
                              const std::string& fix = kExportAgain);

/// The whole file. Refuses what is missing, no regular file, or larger than kLargestFile.
std::string read_mesh_file(const std::string& path);

/// True when every coordinate is finite and within kFarthest.
bool within_bounds(const std::array<float, 3>& position);

/// "" when `value` (e.g. "the x of a vertex") is finite and within kFarthest; else what is wrong with it.
std::string coordinate_fault(std::string_view value, double number);

/// The words of a text file. Lines end at LF, CR LF or CR; a mark of byte order at the start is skipped.
class MeshText {
 public:
  MeshText(std::string path, std::string_view text);

  /// The next word, on this line or a later one; "" at the end of the text.
  std::string_view word();
  /// The next word of this line; "" at its end.
  std::string_view word_in_line();
  /// On to the start of the next line.
  void skip_line();
  /// Bytes from the start of the text to the place after the last word.
  size_t at() const { return at_; }

  /// The next word of this line as a number; `what` names it in the refusal. May be NaN or infinite.
  double number(std::string_view what);
  /// As number(), within kFarthest: a length in mm.
  float coordinate(std::string_view what);

  SourceLocation where() const;  ///< of the last word
  [[noreturn]] void refuse(const std::string& text, const std::string& fix = kExportAgain) const;

 private:
  bool at_line_end() const { return at_ >= text_.size() || text_[at_] == '\n' || text_[at_] == '\r'; }
  void skip_blanks();

  std::string path_;
  std::string_view text_;
  size_t at_ = 0, word_at_ = 0, line_at_ = 0;
  int line_ = 1;
};

/// A whole word as a number, a sign in front allowed; false when it is none. Too small for a double: 0; too
/// large: infinite.
bool parse_number(std::string_view word, double& value);

/// The start of a word as it may stand in a message: printable, not longer than a line.
std::string shown(std::string_view word);

}  // namespace swarf::mesh

// A program file line by line, in little memory: jumps go back to marks in the file.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "program/control/control.h"

namespace swarf::program::nc {

/// No line of a program is longer; a longer one is refused before it is kept.
inline constexpr size_t kMaxLine = 65536;

class LineSource {
 public:
  /// Place of a line: to be read again after a jump.
  struct Mark {
    uint64_t offset = 0;
    long line = 0;  ///< number of the line before it
  };
  /// Throws InputError: "file-not-found", "file-unreadable", "empty-file". `path` as given.
  explicit LineSource(const std::string& path);
  /// The same, with its index in NcSummary::files.
  LineSource(const std::string& path, Control& control);
  /// The next line without its end (LF, CR LF or CR), valid until the next call; false at the end of the
  /// file. Marks of a transfer (ETX, XON, ..) at a line's ends are left out, as is NUL before the first line
  /// and behind the last one; other bytes that no text has are refused ("not-text"), as are lines over
  /// kMaxLine
  /// ("line-too-long"); both throw InputError.
  bool next(std::string_view& line);
  long line_number() const { return line_; }  ///< of the line given last, 1-based
  int file() const { return file_; }          ///< index into NcSummary::files
  const std::string& path() const { return path_; }
  Mark mark() const { return {base_ + at_, line_}; }  ///< of the next line
  /// Of the line given last.
  Mark line_mark() const { return last_mark_; }
  void seek(const Mark& mark);

 private:
  bool fill();
  void refuse_bytes(std::string_view line) const;
  std::string path_;
  std::ifstream stream_;
  std::vector<char> buffer_;
  size_t at_ = 0, end_ = 0;  ///< unread part of the buffer
  uint64_t base_ = 0;        ///< file offset of buffer_[0]
  uint64_t begin_ = 0;       ///< of the first line: behind a byte order mark
  long line_ = 0;
  Mark last_mark_;
  int file_ = 0;
  bool last_ = false;
};

/// 1-based column of the character at byte `offset` (UTF-8 sequences count as one).
int column_at(std::string_view line, size_t offset);

/// The file that a subprogram call names: next to the program, then in ControlSetup::subprogram_folders, with
/// each of the given endings ("" too), the name as written, then in small letters. "" when there is none.
std::string find_subprogram(const std::string& program_path, const ControlSetup& setup,
                            const std::string& name, const std::vector<std::string>& endings);

}  // namespace swarf::program::nc

// Files as wholes: read at once, replaced at once or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "base/hash.h"

namespace swarf {

/// Throws InputError "no-regular-file" for what is there but is no file with an end: a device, a pipe, a
/// socket. Opening or reading those may wait for ever. A missing file and a folder are left to the reader,
/// which knows what ought to be there.
void refuse_special_file(const std::string& path);

/// How a file that cannot be read or written is told.
struct FileFault {
  const char* code;  ///< stable, kebab-case: "record-unwritable"
  const char* text;  ///< "the record cannot be written"; the system's reason is added
  const char* fix = "check that the folder exists, may be written and has space";
};

/// The whole content. Throws InputError: "no-regular-file", or the fault with the system's reason.
std::string read_all(const std::string& path, const FileFault& fault);

/// The same in pieces of kFilePiece bytes, of which the last may be shorter, for files that are not held
/// whole.
void read_in_pieces(const std::string& path, const FileFault& fault,
                    const std::function<void(std::string_view)>& visit);
/// Bytes; a multiple of eight, so that words lie in one piece.
inline constexpr size_t kFilePiece = size_t{1} << 18U;

/// Of the bytes of a file: their number, then words of eight, the last filled with zeros.
uint64_t checksum(std::string_view bytes);
/// The same of a file that is not held whole: pieces of a multiple of eight bytes, but for the last.
class Checksum {
 public:
  explicit Checksum(uint64_t bytes) { hash_.add(bytes); }  ///< in all
  void add(std::string_view piece);
  uint64_t value() const { return hash_.value(); }

 private:
  Hash hash_;
};

/// A file on its way to a path. It is written beside the target, under a name that no other process has, and
/// takes the target's place when it is whole and on the disk: whoever reads the target, after a power failure
/// too, finds the old content or the new one. A link stays a link; what it points to is replaced. The mode of
/// a file that is replaced stays.
class NewFile {
 public:
  /// Throws InputError with the fault when nothing may be written there: the folder is missing or read-only,
  /// a folder or a device stands in the file's place, the file itself is write-protected.
  NewFile(std::string path, const FileFault& fault);
  /// Removes what has not been moved into place.
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Where the content is to be written; ends like the target, since some writers go by the ending.
  const std::string& temporary() const { return temporary_; }
  void write(std::string_view bytes) const;
  /// Throws the fault when the content does not reach the disk or the target cannot be replaced.
  void move_into_place();
  /// Throws the fault: what a library says of its own writing.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  void create();
  void keep_mode_of_target() const;

  std::string path_, target_, temporary_;  ///< as given; behind links; beside the target
  FileFault fault_;
  int descriptor_ = -1;
};

/// Writes a whole file by way of NewFile.
void replace_file(const std::string& path, std::string_view bytes, const FileFault& fault);

}  // namespace swarf

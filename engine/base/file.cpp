#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/diagnostics.h"

namespace swarf {
namespace {

namespace fs = std::filesystem;

/// What the path names, if it is neither a file, nor a folder, nor missing.
const char* special_kind(fs::file_type type) {
  switch (type) {
    case fs::file_type::character:
      return "a device";
    case fs::file_type::block:
      return "a disk";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    default:
      return nullptr;
  }
}

[[noreturn]] void refuse_file(const std::string& path, const FileFault& fault, const std::string& reason) {
  throw InputError(fault.code, {path}, fmt::format("{}: {}", fault.text, reason), fault.fix);
}

/// The path that opening would lead to, which need not exist.
fs::path behind_links(fs::path path) {
  constexpr int kLinksMax = 40;  // as Linux follows them
  std::error_code none;
  for (int i = 0; i < kLinksMax && fs::is_symlink(path, none); ++i)
    path = path.parent_path() / fs::read_symlink(path, none);
  return path;
}

/// Why no file may take the place of what stands there, or "".
std::string in_the_way(const fs::path& target) {
  std::error_code error;
  const fs::file_type type = fs::status(target, error).type();
  if (type == fs::file_type::not_found) return "";
  if (type == fs::file_type::directory) return "a folder stands in its place";
  if (const char* kind = special_kind(type)) return fmt::format("this is {}, no file", kind);
  if (error) return error.message();
  return access(target.c_str(), W_OK) == 0 ? "" : std::strerror(errno);
}

}  // namespace

void refuse_special_file(const std::string& path) {
  std::error_code ignored;
  const char* kind = special_kind(fs::status(path, ignored).type());
  if (kind == nullptr) return;
  throw InputError("no-regular-file", {path}, fmt::format("this is {}, no file", kind),
                   "name a file; what a pipe brings must be saved first");
}

void read_in_pieces(const std::string& path, const FileFault& fault,
                    const std::function<void(std::string_view)>& visit) {
  refuse_special_file(path);
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) refuse_file(path, fault, "this is a folder");
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse_file(path, fault, std::strerror(errno));
  std::string piece(kFilePiece, '\0');
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    if (in.gcount() > 0) visit(std::string_view(piece).substr(0, static_cast<size_t>(in.gcount())));
  }
  if (in.bad()) refuse_file(path, fault, std::strerror(errno));
}

std::string read_all(const std::string& path, const FileFault& fault) {
  std::string bytes;
  read_in_pieces(path, fault, [&](std::string_view piece) { bytes.append(piece); });
  return bytes;
}

void Checksum::add(std::string_view piece) {
  for (size_t at = 0; at < piece.size(); at += sizeof(uint64_t)) {
    uint64_t word = 0;
    std::memcpy(&word, piece.data() + at, std::min(sizeof(word), piece.size() - at));
    hash_.add(word);
  }
}

uint64_t checksum(std::string_view bytes) {
  Checksum sum(bytes.size());
  sum.add(bytes);
  return sum.value();
}

NewFile::NewFile(std::string path, const FileFault& fault)
    : path_(std::move(path)), target_(behind_links(path_).string()), fault_(fault) {
  if (const std::string reason = in_the_way(target_); !reason.empty()) refuse(reason);
  create();
  keep_mode_of_target();
}

NewFile::~NewFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  unlink(temporary_.c_str());
}

/// The number of a process may come again, on another machine of the network at the same time.
void NewFile::create() {
  const fs::path target(target_);
  const std::string stem = target.stem().string(), ending = target.extension().string();
  constexpr int kTries = 100;
  constexpr mode_t kAllowedByUmask = 0666;
  for (int n = 0; descriptor_ < 0 && n < kTries; ++n) {
    temporary_ = (target.parent_path() / fmt::format("{}.part{}-{}{}", stem, getpid(), n, ending)).string();
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kAllowedByUmask);
    if (descriptor_ < 0 && errno != EEXIST) refuse(std::strerror(errno));
  }
  if (descriptor_ < 0) refuse("files that runs before have left stand beside it");
}

void NewFile::keep_mode_of_target() const {
  constexpr mode_t kPermissions = 0777;
  struct stat old {};
  // A file system without modes, such as FAT, refuses: then there is none to keep.
  if (stat(target_.c_str(), &old) == 0) fchmod(descriptor_, old.st_mode & kPermissions);
}

void NewFile::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse(std::strerror(errno));
    bytes.remove_prefix(static_cast<size_t>(written));
  }
}

void NewFile::move_into_place() {
  // A full disk may show only here. EINVAL: a file system that keeps nothing on a disk.
  if (fsync(descriptor_) != 0 && errno != EINVAL) refuse(std::strerror(errno));
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) refuse(std::strerror(errno));
  close(std::exchange(descriptor_, -1));
}

void NewFile::refuse(const std::string& reason) const {
  refuse_file(path_, fault_, reason);
}

void replace_file(const std::string& path, std::string_view bytes, const FileFault& fault) {
  NewFile file(path, fault);
  file.write(bytes);
  file.move_into_place();
}

}  // namespace swarf

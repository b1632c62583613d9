#include "program/letters/line_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "base/file.h"
#include "program/source_text.h"

namespace swarf::program::nc {
namespace {

constexpr size_t kBuffer = size_t{1} << 18;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// False for bytes that stand in no program text: control characters other than tab and form feed.
bool is_text(unsigned char byte) {
  return (byte >= 0x20) | (byte == '\t') | (byte == '\f');
}

/// Marks of a transfer (start and end of text, end of transmission, reader on and off, the old end of a
/// file): controls pass over them.
bool is_transfer_mark(char c) {
  constexpr std::string_view kMarks("\x02\x03\x04\x11\x12\x13\x14\x1A", 8);
  return kMarks.find(c) != std::string_view::npos;
}

/// The line without marks of a transfer at its ends. NUL belongs to them only where tapes and blocks of a
/// disk are filled up with it: before the first line and behind the last one. Elsewhere something is lost.
std::string_view without_marks(std::string_view line, bool first, bool last) {
  const auto mark = [](char c, bool filled) { return is_transfer_mark(c) || (filled && c == '\0'); };
  while (!line.empty() && mark(line.front(), first)) line.remove_prefix(1);
  while (!line.empty() && mark(line.back(), last)) line.remove_suffix(1);
  return line;
}

bool all_text(std::string_view line) {
  // Eight bytes at once: bytes from 0x20 on keep their top bit when 0x20 is taken off (0x80 + byte), and
  // bytes from 0x80 on have it. The few that are left are looked at one by one.
  constexpr uint64_t kTops = 0x8080808080808080u, kSpaces = 0x2020202020202020u;
  const auto good = [&](size_t from, size_t to) {
    return std::all_of(line.data() + from, line.data() + to,
                       [](char c) { return is_text(static_cast<unsigned char>(c)); });
  };
  size_t at = 0;
  for (; at + sizeof(uint64_t) <= line.size(); at += sizeof(uint64_t)) {
    uint64_t bytes = 0;
    std::memcpy(&bytes, line.data() + at, sizeof bytes);
    const bool low = (~((bytes | kTops) - kSpaces) & ~bytes & kTops) != 0;
    if (low && !good(at, at + sizeof bytes)) return false;
  }
  return good(at, line.size());
}

}  // namespace

LineSource::LineSource(const std::string& path, Control& control) : LineSource(path) {
  file_ = control.report.enter_file(path);
}

LineSource::LineSource(const std::string& path) : path_(path) {
  refuse_special_file(path);
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw InputError("file-not-found", {path, 0, 0}, "there is no such file",
                     "check the path of the program");
  }
  stream_.open(path, std::ios::binary);
  if (status.type() != std::filesystem::file_type::regular || !stream_) {
    throw InputError("file-unreadable", {path, 0, 0}, "this is not a file that can be read",
                     "give the path of a program file that you may read");
  }
  buffer_.resize(kBuffer);
  if (!fill()) {
    throw InputError("empty-file", {path, 0, 0}, "the program is empty", "give a file with NC blocks");
  }
  if (std::string_view(buffer_.data(), end_).starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  begin_ = at_;
}

bool LineSource::fill() {
  if (last_) return false;
  std::memmove(buffer_.data(), buffer_.data() + at_, end_ - at_);
  base_ += at_;
  end_ -= at_;
  at_ = 0;
  stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
  const auto got = static_cast<size_t>(stream_.gcount());
  end_ += got;
  last_ = !stream_;
  return got > 0;
}

void LineSource::refuse_bytes(std::string_view line) const {
  const auto found =
      std::find_if(line.begin(), line.end(), [](char c) { return !is_text(static_cast<unsigned char>(c)); });
  const auto bad = static_cast<size_t>(found - line.begin());
  throw InputError("not-text", {path_, static_cast<int>(line_), column_at(line, bad)},
                   fmt::format("byte 0x{:02X} stands here: this is not text",
                               static_cast<unsigned>(static_cast<unsigned char>(line[bad]))),
                   "save the program as plain text");
}

bool LineSource::next(std::string_view& line) {
  // No line is longer than the window, so that neither a long one nor a file of lone CR is read on and on.
  const auto line_in_window = [&] {
    const std::string_view window(buffer_.data() + at_, std::min(end_ - at_, kMaxLine + 1));
    const auto* feed = static_cast<const char*>(std::memchr(window.data(), '\n', window.size()));
    const std::string_view before =
        feed == nullptr ? window : window.substr(0, static_cast<size_t>(feed - window.data()));
    const auto* lone = static_cast<const char*>(std::memchr(before.data(), '\r', before.size()));
    return lone == nullptr ? before : before.substr(0, static_cast<size_t>(lone - before.data()));
  };
  line = line_in_window();
  // Two more bytes must be there to tell CR LF from CR.
  if (at_ + line.size() + 2 > end_ && fill()) line = line_in_window();
  if (at_ == end_) return false;
  last_mark_ = mark();
  ++line_;
  if (line.size() > kMaxLine) {
    throw InputError("line-too-long", {path_, static_cast<int>(line_), 1},
                     fmt::format("this line is longer than {} characters", kMaxLine),
                     "no NC program has such lines: check the file");
  }
  at_ += line.size();
  const bool returned = at_ < end_ && buffer_[at_] == '\r';
  if (at_ < end_) ++at_;
  if (returned && at_ < end_ && buffer_[at_] == '\n') ++at_;
  if (!all_text(line)) {
    const std::string_view whole = line;
    line = without_marks(line, line_ == 1, last_ && at_ == end_);
    if (!all_text(line)) refuse_bytes(whole);
  }
  return true;
}

void LineSource::seek(const Mark& mark) {
  line_ = mark.line;
  const uint64_t offset = std::max(mark.offset, begin_);
  if (offset >= base_ && offset <= base_ + end_) {
    at_ = static_cast<size_t>(offset - base_);
    return;
  }
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(offset));
  base_ = offset;
  at_ = end_ = 0;
  last_ = false;
  fill();
}

int column_at(std::string_view line, size_t offset) {
  int column = 1;
  for (size_t at = 0; at < std::min(offset, line.size()); ++column) {
    const int length = utf8_length(line, at);
    at += length > 0 ? static_cast<size_t>(length) : 1;
  }
  return column;
}

std::string find_subprogram(const std::string& program_path, const ControlSetup& setup,
                            const std::string& name, const std::vector<std::string>& endings) {
  std::vector<std::filesystem::path> folders{std::filesystem::path(program_path).parent_path()};
  folders.insert(folders.end(), setup.subprogram_folders.begin(), setup.subprogram_folders.end());
  std::string small = name;
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) {
    return c < 0x80 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c);
  });
  for (const auto& folder : folders) {
    for (const std::string& ending : endings) {
      for (const std::string& stem : {name, small}) {
        const std::filesystem::path candidate = folder / (stem + ending);
        std::error_code problem;
        if (std::filesystem::is_regular_file(candidate, problem)) return candidate.string();
      }
    }
  }
  return "";
}

}  // namespace swarf::program::nc

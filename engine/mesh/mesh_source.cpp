#include "mesh/mesh_source.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/file.h"

namespace swarf::mesh {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr size_t kShownLetters = 40;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

}  // namespace

void refuse_mesh(const SourceLocation& where, const std::string& text, const std::string& fix) {
  throw InputError("mesh-unreadable", where, text, fix);
}

std::string read_mesh_file(const std::string& path) {
  refuse_special_file(path);
  std::error_code error;
  const uintmax_t size = fs::is_regular_file(path, error) ? fs::file_size(path, error) : 0;
  std::ifstream file(path, std::ios::binary);
  if (error || !file || !fs::is_regular_file(path, error)) {
    throw InputError("mesh-not-found", {path}, "the mesh file cannot be opened",
                     "check the path and its spelling");
  }
  if (size > kLargestFile) {
    refuse_mesh({path},
                fmt::format("the file has {} bytes, more than the {} that are read", size, kLargestFile),
                "make the mesh coarser");
  }
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (file.gcount() != static_cast<std::streamsize>(size)) {
    refuse_mesh({path}, fmt::format("only {} of {} bytes can be read", file.gcount(), size),
                "check the disk that the file is on");
  }
  return bytes;
}

bool within_bounds(const std::array<float, 3>& position) {
  // Written so that NaN fails.
  return std::abs(position[0]) <= kFarthest && std::abs(position[1]) <= kFarthest &&
         std::abs(position[2]) <= kFarthest;
}

std::string coordinate_fault(std::string_view value, double number) {
  if (std::abs(number) <= double{kFarthest}) return "";
  if (!std::isfinite(number)) return fmt::format("{} is not finite", value);
  return fmt::format("{} is {:g} mm, beyond the {:g} mm that a mesh may reach", value, number, kFarthest);
}

bool parse_number(std::string_view word, double& value) {
  const char* begin = word.data();
  const char* const end = begin + word.size();
  if (begin != end && *begin == '+' && !(word.size() > 1 && word[1] == '-')) ++begin;
  const auto [stop, failure] = std::from_chars(begin, end, value);
  if (stop != end || begin == end) return false;
  if (failure == std::errc::result_out_of_range)
    value = std::strtod(std::string(begin, end).c_str(), nullptr);
  return failure == std::errc() || failure == std::errc::result_out_of_range;
}

std::string shown(std::string_view word) {
  std::string text;
  for (const char c : word.substr(0, kShownLetters)) text += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > kShownLetters ? text + "..." : text;
}

MeshText::MeshText(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {
  if (text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) at_ = kByteOrderMark.size();
}

void MeshText::skip_blanks() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
}

void MeshText::skip_line() {
  while (!at_line_end()) ++at_;
  if (at_ >= text_.size()) return;
  at_ += text_.substr(at_, 2) == "\r\n" ? 2 : 1;
  line_at_ = word_at_ = at_;
  ++line_;
}

std::string_view MeshText::word_in_line() {
  skip_blanks();
  word_at_ = at_;
  while (!at_line_end() && !is_blank(text_[at_])) ++at_;
  return text_.substr(word_at_, at_ - word_at_);
}

std::string_view MeshText::word() {
  for (;;) {
    const std::string_view found = word_in_line();
    if (!found.empty() || at_ >= text_.size()) return found;
    skip_line();
  }
}

double MeshText::number(std::string_view what) {
  const std::string_view found = word_in_line();
  double value = 0.0;
  if (found.empty()) refuse(fmt::format("the line ends where {} should stand", what));
  if (!parse_number(found, value)) refuse(fmt::format("'{}' is no number for {}", shown(found), what));
  return value;
}

float MeshText::coordinate(std::string_view what) {
  const double value = number(what);
  const std::string fault = coordinate_fault(what, value);
  if (!fault.empty()) refuse(fault);
  return static_cast<float>(value);
}

SourceLocation MeshText::where() const {
  return {path_, line_, static_cast<int>(word_at_ - line_at_) + 1};
}

void MeshText::refuse(const std::string& text, const std::string& fix) const {
  refuse_mesh(where(), text, fix);
}

}  // namespace swarf::mesh

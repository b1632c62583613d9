#include "reports/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/diagnostics.h"
#include "render/image_io.h"

namespace swarf::reports {

std::string escape(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t taken = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < taken ? static_cast<uint8_t>(bytes[i + k]) : 0U);
    for (size_t k = 0; k < 4; ++k) out += k <= taken ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes;
  if (std::filesystem::is_regular_file(path)) bytes.assign(std::istreambuf_iterator<char>(in), {});
  if (!in || bytes.empty()) {
    throw InputError("file-unreadable", {path},
                     "the report needs this file, which is missing, empty or not readable",
                     "run the stage that writes it, or leave it out of the report");
  }
  return bytes;
}

std::string script_safe(std::string_view script) {
  std::string out;
  out.reserve(script.size());
  for (size_t i = 0; i < script.size(); ++i) {
    out += script[i];
    const std::string_view rest = script.substr(i);
    // Inside strings, templates and regular expressions the added backslash changes nothing.
    if (rest.starts_with("</script") || rest.starts_with("<!--")) out += '\\';
  }
  return out;
}

PixelSize png_size(std::string_view png, const std::string& path) {
  static constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  if (png.size() < 24 || !png.starts_with(kSignature) || png.substr(12, 4) != "IHDR") {
    throw InputError("not-png", {path}, "this file is not a PNG picture", "give the path of a PNG file");
  }
  const auto big_endian = [&](size_t at) {
    uint32_t value = 0;
    for (size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<uint8_t>(png[at + k]);
    return static_cast<int>(value);
  };
  return {big_endian(16), big_endian(20)};
}

PagePicture page_picture(const std::string& path) {
  const std::string png = read_file(path);
  const PixelSize size = png_size(png, path);
  const std::string small = render::webp(render::load_png(path), render::kPageQuality);
  const bool smaller = small.size() < png.size();
  return {size,
          (smaller ? "data:image/webp;base64," : "data:image/png;base64,") + base64(smaller ? small : png)};
}

std::string embedded_picture(const std::string& path, const std::string& alt) {
  const auto [size, url] = page_picture(path);
  return fmt::format(R"(<img src="{}" width="{}" height="{}" alt="{}">)", url, size.width, size.height,
                     escape(alt));
}

}  // namespace swarf::reports

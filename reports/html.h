// The few pieces of HTML that every section needs: escaping, base64, files as data.
#pragma once

#include <string>
#include <string_view>

namespace swarf::reports {

/// Text made safe between tags and inside quoted attributes: & < > " ' become entities.
std::string escape(std::string_view text);

/// RFC 4648 section 4, with padding, without line breaks.
std::string base64(std::string_view bytes);

/// A whole file. Throws InputError ("file-unreadable") when it cannot be read.
std::string read_file(const std::string& path);

/// A script that may stand inside <script>: "</script" and "<!--" would end or alter it.
std::string script_safe(std::string_view script);

struct PixelSize {
  int width = 0, height = 0;
};
/// From the header of a PNG. Throws InputError ("not-png"), which names `path`, when it is none.
PixelSize png_size(std::string_view png, const std::string& path);

/// A picture as it stands in a page, its size stated, so that the page does not jump while it loads.
struct PagePicture {
  PixelSize size;
  std::string data_url;  ///< WebP of render::kPageQuality, or the file itself where that is smaller
};
/// Throws InputError when the file is missing or no PNG.
PagePicture page_picture(const std::string& path);

/// <img> with the picture inside.
std::string embedded_picture(const std::string& path, const std::string& alt);

}  // namespace swarf::reports

#include "render/image_io.h"

#include <png.h>
#include <webp/encode.h>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/file.h"

namespace swarf::render {
namespace {

png_image header(const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGBA;
  png.flags = PNG_IMAGE_FLAG_FAST;  // half the time for a file some per cent larger
  return png;
}

}  // namespace

void save_png(const Image& image, const std::string& path) {
  SWARF_CHECK(image.rgba.size() == size_t{4} * image.width * image.height, "pixels do not fill the picture");
  NewFile file(path, {"image-write", "the picture cannot be written"});
  png_image png = header(image);
  if (png_image_write_to_file(&png, file.temporary().c_str(), 0, image.rgba.data(), 0, nullptr) == 0)
    file.refuse(png.message);
  file.move_into_place();
}

Image load_png(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  Image image;
  bool read = png_image_begin_read_from_file(&png, path.c_str()) != 0;
  if (read) {
    png.format = PNG_FORMAT_RGBA;
    image.width = static_cast<int>(png.width);
    image.height = static_cast<int>(png.height);
    image.rgba.resize(PNG_IMAGE_SIZE(png));
    read = png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr) != 0;
  }
  const std::string reason = png.message;
  png_image_free(&png);
  if (!read) throw InputError("image-read", {path}, "no PNG picture: " + reason, "give a PNG file");
  return image;
}

std::string webp(const Image& image, float quality) {
  SWARF_CHECK(image.rgba.size() == size_t{4} * image.width * image.height, "pixels do not fill the picture");
  WebPConfig config;
  WebPPicture picture;
  SWARF_CHECK(WebPConfigPreset(&config, WEBP_PRESET_PICTURE, quality) != 0 && WebPPictureInit(&picture) != 0,
              "another version of libwebp than it was compiled for");
  config.use_sharp_yuv = 1;  // coloured bands keep their edges
  picture.width = image.width;
  picture.height = image.height;
  WebPMemoryWriter out;
  WebPMemoryWriterInit(&out);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &out;
  const bool made = WebPPictureImportRGBA(&picture, image.rgba.data(), 4 * image.width) != 0 &&
                    WebPEncode(&config, &picture) != 0;
  const int reason = picture.error_code;
  std::string bytes(reinterpret_cast<const char*>(out.mem), made ? out.size : 0);
  WebPPictureFree(&picture);
  WebPMemoryWriterClear(&out);
  SWARF_CHECK(made, "libwebp cannot encode the picture: reason " + std::to_string(reason));
  return bytes;
}

}  // namespace swarf::render

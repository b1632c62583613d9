#include "reports/html.h"

#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "temporary_folder.h"

namespace swarf::reports {
namespace {

TEST(Html, EscapesWhatWouldBecomeMarkup) {
  EXPECT_EQ(escape("<b a=\"1\" c='2'>R&D</b>"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;R&amp;D&lt;/b&gt;");
  EXPECT_EQ(escape("10 µm ≤ 10.5 µm"), "10 µm ≤ 10.5 µm");
}

TEST(Html, Base64AgreesWithRfc4648) {
  const std::pair<const char*, const char*> oracles[] = {
      {"", ""},
      {"f", "Zg=="},
      {"fo", "Zm8="},
      {"foo", "Zm9v"},
      {"foob", "Zm9vYg=="},
      {"fooba", "Zm9vYmE="},
      {"foobar", "Zm9vYmFy"},
  };
  for (const auto& [plain, coded] : oracles) EXPECT_EQ(base64(plain), coded);
  EXPECT_EQ(base64(std::string("\x00\xff\xfe\x80", 4)), "AP/+gA==");
}

TEST(Html, ScriptCannotEndItsElement) {
  EXPECT_EQ(script_safe("a='</script>'+'<!--'+(1<2)"), "a='<\\/script>'+'<\\!--'+(1<2)");
}

TEST(Html, MissingAndEmptyFilesAreNamed) {
  const TemporaryFolder folder("swarf_html");
  const std::string paths[] = {folder.file("none.png"), folder.write("empty.png", ""),
                               folder.path().string()};
  for (const std::string& path : paths) {
    try {
      read_file(path);
      FAIL() << path << " was read";
    } catch (const InputError& error) {
      ASSERT_EQ(error.diagnostics.list().size(), 1U);
      EXPECT_EQ(error.diagnostics.list()[0].code, "file-unreadable");
      EXPECT_EQ(error.diagnostics.list()[0].where.file, path);
    }
  }
}

TEST(Html, PngStatesItsSize) {
  const std::string header("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\x05\0\0\0\x02\xd0", 24);
  const PixelSize size = png_size(header, "a.png");
  EXPECT_EQ(size.width, 1280);
  EXPECT_EQ(size.height, 720);
  for (size_t length = 0; length < header.size(); ++length) {
    EXPECT_THROW(png_size(header.substr(0, length), "a.png"), InputError) << length << " bytes";
  }
}

}  // namespace
}  // namespace swarf::reports

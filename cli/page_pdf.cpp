#include "cli/page_pdf.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/diagnostics.h"
#include "base/file.h"
#include "cli/shell_text.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

bool runs(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

/// "" where there is none.
std::string chromium() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (runs(std::string("command -v ") + name)) return name;
  return "";
}

/// For the browser's profile; gone when it is done.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& beside) {
    std::string name = beside + ".XXXXXX";
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

void require_chromium() {
  if (!chromium().empty()) return;
  throw InputError(
      "no-chromium", {"--pdf"}, "there is no chromium here, which prints the page",
      "install it (Debian: apt-get install chromium), or leave --pdf out: report.html prints from "
      "any browser");
}

void write_page_pdf(const std::string& page, const std::string& pdf) {
  NewFile file(pdf, {"pdf-write", "the PDF cannot be written"});
  const ScratchFolder scratch((fs::temp_directory_path() / "swarf_pdf").string());
  std::vector<std::string> words{chromium(),
                                 "--headless",
                                 "--disable-gpu",
                                 "--user-data-dir=" + scratch.path(),
                                 "--no-pdf-header-footer",  // the page numbers are the page's own
                                 "--print-to-pdf=" + fs::absolute(file.temporary()).string()};
  // The page is our own and may load nothing; for root Chromium has no sandbox.
  if (geteuid() == 0) words.emplace_back("--no-sandbox");
  words.push_back("file://" + fs::absolute(page).string());
  const bool done = runs(shell_text(words));
  std::error_code none;
  if (!done || fs::file_size(file.temporary(), none) == 0 || none) file.refuse("chromium printed nothing");
  file.move_into_place();
}

}  // namespace swarf::cli

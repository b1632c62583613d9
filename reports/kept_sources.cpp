#include "reports/kept_sources.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/hash.h"
#include "reports/pending_folder.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;
using SourcesJson = nlohmann::json;

constexpr FileFault kUnreadable{"file-unreadable", "this cannot be read"};

/// Of the whole content, in pieces: castings may have gigabytes.
std::string checksum_text(const std::string& file) {
  Hash hash;
  read_in_pieces(file, kUnreadable, [&](std::string_view piece) { hash.add(checksum(piece)); });
  return hash.text();
}

/// Path to checksum.
using Sources = std::map<std::string, std::string>;

Sources read_sources(const fs::path& list) {
  const SourcesJson text = SourcesJson::parse(read_all(list.string(), kUnreadable), nullptr, false);
  Sources sources;
  if (!text.is_object()) return sources;
  for (const auto& [file, sum] : text.items())
    if (sum.is_string()) sources[file] = sum.get<std::string>();
  return sources;
}

/// "": nothing.
std::string change_in(const fs::path& list) {
  const Sources sources = read_sources(list);
  if (sources.empty()) return list.string() + " is broken";
  for (const auto& [file, sum] : sources) {
    if (!fs::is_regular_file(file)) return file + " is gone";
    if (checksum_text(file) != sum) return file + " has changed";
  }
  return "";
}

}  // namespace

void add_sources(const fs::path& input, const std::vector<fs::path>& files) {
  const fs::path list = input / kSourcesFile;
  Sources sources = fs::exists(list) ? read_sources(list) : Sources{};
  for (const fs::path& file : files) {
    const std::string whole = fs::absolute(file).string();  // ".." after a link is not what stands before it
    sources[whole] = checksum_text(whole);
  }
  write_text(list.string(),
             SourcesJson(sources).dump(2, ' ', false, SourcesJson::error_handler_t::replace) + "\n");
}

std::string changed_source(const fs::path& run_folder) {
  std::error_code problem;
  size_t lists = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(run_folder, problem)) {
    // An earlier run that was kept as an input has been compared as a whole, by its copy's sources.
    if (entry.path().filename() != kSourcesFile ||
        entry.path().string().find("earlier_run") != std::string::npos)
      continue;
    ++lists;
    if (const std::string change = change_in(entry.path()); !change.empty()) return change;
  }
  return lists > 0 ? "" : "what it was made from is not known";
}

}  // namespace swarf::reports

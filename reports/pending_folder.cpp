#include "reports/pending_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <system_error>

#include "base/diagnostics.h"

namespace swarf::reports {

namespace fs = std::filesystem;

PendingFolder::PendingFolder(const std::string& target)
    : target_(fs::absolute(target).lexically_normal()),
      pending_(target_.string() + fmt::format(".part{}", getpid())) {
  fs::remove_all(pending_);
  fs::create_directories(pending_);
}

PendingFolder::~PendingFolder() {
  std::error_code ignored;
  fs::remove_all(pending_, ignored);
}

std::string PendingFolder::file(const std::string& name) const {
  return (pending_ / name).string();
}

void PendingFolder::move_into_place() {
  const fs::path old = target_.string() + fmt::format(".old{}", getpid());
  if (fs::exists(target_)) fs::rename(target_, old);
  fs::rename(pending_, target_);
  fs::remove_all(old);
}

void check_output_folder(const std::string& folder, const std::string& mark) {
  if (!fs::exists(folder) || (fs::is_directory(folder) && fs::is_empty(folder))) return;
  if (fs::is_directory(folder) && fs::exists(fs::path(folder) / mark)) return;
  throw InputError("output-in-the-way", {folder},
                   "this exists and is not an earlier result of swarf, so it will not be replaced",
                   "name another folder with -o, or remove it yourself");
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", path));
}

}  // namespace swarf::reports

#include "post/shipped.h"

#include <algorithm>
#include <filesystem>

#include "machine/shipped.h"

namespace swarf::post {
namespace {

namespace fs = std::filesystem;

/// Beside the machines.
fs::path folder() {
  const fs::path machines = machine::shipped_folder();
  return machines.empty() ? fs::path() : machines.parent_path() / "posts";
}

}  // namespace

std::vector<std::string> shipped_posts() {
  std::vector<std::string> names;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder(), problem)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string shipped_list() {
  std::string list;
  for (const std::string& name : shipped_posts()) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::string post_file(const std::string& written) {
  if (written.find('/') != std::string::npos || written.ends_with(".toml")) return written;
  for (const std::string& name : shipped_posts()) {
    if (name == written) return (folder() / (name + ".toml")).string();
  }
  return "";
}

}  // namespace swarf::post

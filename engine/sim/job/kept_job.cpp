#include "sim/job/kept_job.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/file.h"

namespace swarf::sim {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

bool are_texts(const json& list) {
  return list.is_array() &&
         std::all_of(list.begin(), list.end(), [](const json& value) { return value.is_string(); });
}

bool is_manifest(const json& read) {
  if (!read.is_object() || !read.contains("overrides") || !are_texts(read.at("overrides"))) return false;
  if (read.contains("scene") && !read.at("scene").is_string()) return false;
  if (!read.contains("earlier_overrides")) return true;
  const json& earlier = read.at("earlier_overrides");
  return earlier.is_array() && std::all_of(earlier.begin(), earlier.end(), are_texts);
}

json manifest_of(const fs::path& root) {
  refuse_special_file((root / kRunMark).string());
  std::ifstream file(root / kRunMark);
  if (!file) {
    throw InputError("not-a-run", {root.string()},
                     "there is no run.json: this is not the folder of a finished run",
                     "name the folder that 'swarf run ... -o DIR' wrote");
  }
  json read = json::parse(file, nullptr, false);
  if (!is_manifest(read))
    throw InputError("not-a-run", {(root / kRunMark).string()}, "this file is broken", "run the scene again");
  return read;
}

}  // namespace

Job load_kept_job(const std::string& folder, const std::vector<std::string>& overrides) {
  const fs::path root(folder);
  const json manifest = manifest_of(root);
  const std::string scene = (root / "input" / "scene.toml").string();
  auto own = manifest.at("overrides").get<std::vector<std::string>>();
  own.insert(own.end(), overrides.begin(), overrides.end());
  Job job;
  if (manifest.contains("earlier_overrides")) {
    auto all = manifest.at("earlier_overrides").get<std::vector<std::vector<std::string>>>();
    all.push_back(own);
    job = *load_setups(scene, all).back();
  } else {
    job = load_job(scene, own);
  }
  job.scene.name = manifest.value("scene", job.scene.name);
  return job;
}

}  // namespace swarf::sim

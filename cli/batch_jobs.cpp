#include "cli/batch_jobs.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "base/config.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

/// The files that a pattern matches, sorted; a path without *, ? and [ is itself.
std::vector<std::string> matches(const fs::path& pattern) {
  if (pattern.string().find_first_of("*?[") == std::string::npos) return {pattern.string()};
  glob_t found{};
  const int result = glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> files;
  for (size_t i = 0; result == 0 && i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  globfree(&found);
  return files;
}

/// scenes/dome/scene.toml: "dome"; part.nc: "part". As `swarf run` names its results.
std::string name_of(const fs::path& file) {
  if (file.extension() != ".toml" || file.stem() != "scene") return file.stem().string();
  return fs::absolute(file).lexically_normal().parent_path().filename().string();
}

/// A folder of that name can stand in the results, beside files of batch's own.
bool is_folder_name(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-' || c == '+' || c == '.';
  };
  return !name.empty() && name.front() != '.' && name.front() != '-' &&
         std::all_of(name.begin(), name.end(), plain);
}

/// What batch gives each run itself.
void refuse_own_words(ConfigTable& table, const std::vector<std::string>& arguments) {
  for (const std::string& word : arguments) {
    const std::string option = word.substr(0, word.find('='));
    for (const char* own : {"-o", "--output", "--junit", "--json", "--open", "--help", "-h"})
      if (option == own || (own[1] != '-' && option.starts_with(own) && !option.starts_with("--")))
        table.error("own-option", "arguments", fmt::format("{} is given to each run by swarf batch", own),
                    "leave it out; -o and --junit of swarf batch are for all jobs");
  }
}

class Reader {
 public:
  explicit Reader(const std::string& path) : home_(fs::path(path).parent_path()) {}

  void read(ConfigTable& table, const std::vector<std::string>& common, Diagnostics& told) {
    const std::string file = table.text("file");
    const std::string name = table.text("name", "");
    std::vector<std::string> arguments = common;
    const std::vector<std::string> own = table.texts("arguments", {});
    refuse_own_words(table, own);
    arguments.insert(arguments.end(), own.begin(), own.end());
    if (file.empty()) return;
    const fs::path pattern = fs::path(file).is_absolute() ? fs::path(file) : home_ / file;
    const std::vector<std::string> files = matches(pattern);
    if (files.empty())
      table.error("no-match", "file", fmt::format("no file matches {}", pattern.string()),
                  "patterns are relative to this file: *, ? and [..]");
    if (!name.empty() && files.size() > 1)
      table.error("one-name", "name", fmt::format("{} files match, and one name is given", files.size()),
                  "leave name out: each job is named by its file");
    for (const std::string& one : files)
      add({name.empty() ? name_of(one) : name, one, arguments}, table.where("file"), told);
  }

  std::vector<BatchJob> jobs;

 private:
  void add(BatchJob job, const SourceLocation& where, Diagnostics& told) {
    if (!is_folder_name(job.name))
      told.error("job-name", where,
                 fmt::format("'{}' ({}) cannot be the name of a folder of results", job.name, job.file),
                 "give the job a name of letters, digits, '_', '-', '+' and '.'");
    const auto [first, fresh] = first_.emplace(job.name, job.file);
    if (!fresh)
      told.error("same-name", where,
                 fmt::format("two jobs are called '{}': {} and {}", job.name, first->second, job.file),
                 "give one of them a name");
    jobs.push_back(std::move(job));
  }

  fs::path home_;
  std::map<std::string, std::string> first_;
};

}  // namespace

Batch load_batch(const std::string& path) {
  Diagnostics told;
  ConfigTable root = ConfigTable::load(path, {}, told);
  told.throw_if_errors();
  Batch batch{root.text("title", fs::path(path).stem().string()), {}};
  const std::vector<std::string> common = root.texts("arguments", {});
  refuse_own_words(root, common);
  Reader reader(path);
  std::vector<ConfigTable> tables = root.tables("job");
  for (ConfigTable& table : tables) reader.read(table, common, told);
  root.finish();
  if (tables.empty())
    told.error("no-jobs", {path}, "there is no [[job]] in it",
               "write [[job]] and file = \"part/scene.toml\"");
  told.throw_if_errors();
  batch.jobs = std::move(reader.jobs);
  return batch;
}

}  // namespace swarf::cli

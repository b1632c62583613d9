#include "reports/pending_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <system_error>

#include "base/diagnostics.h"
#include "base/file.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCheckPlace = "check that the folder exists, may be written and has space";

[[noreturn]] void refuse_write(const std::string& path, const std::string& reason,
                               const std::string& fix = kCheckPlace) {
  throw InputError("cannot-write", {path}, fmt::format("this cannot be written: {}", reason), fix);
}

[[noreturn]] void refuse_place(const std::string& path, const std::string& reason, const std::string& fix) {
  throw InputError("output-in-the-way", {path}, reason, fix);
}

/// Absolute, without "." and "..", and without a slash at its end.
fs::path clean(const std::string& target) {
  fs::path path = fs::absolute(target).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

/// Names in a folder of results that swarf itself has given.
bool is_ours(const std::string& name) {
  constexpr std::array<std::string_view, 21> kNames{
      "run.json",      "input",         "trajectory.csv", "blocks.csv",    "stock.vdb",     "part.glb",
      "part.stl",      "machine.glb",   "movie.mp4",      "report.html",   "report.pdf",    "metrics.json",
      "run.record",    "findings.json", "deviation.ply",  "deviation.png", "deviation.glb", "motion.places",
      "trajectory.h5", "setups.json",   "posted.nc"};
  const auto is_between = [&](std::string_view start, std::string_view end) {
    return name.size() > start.size() + end.size() &&
           std::string_view(name).substr(0, start.size()) == start &&
           std::string_view(name).substr(name.size() - end.size()) == end;
  };
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() || is_between("still_", ".png") ||
         is_between("place_", ".png") || is_between("surface_", ".rays") ||
         is_between("stock_after_", ".vdb");
}

/// "1_first_side": the results of one of several set-ups.
bool is_of_setup(const fs::path& entry) {
  const std::string name = entry.filename().string();
  const size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  return digits > 0 && digits < name.size() && name[digits] == '_' && fs::exists(entry / "run.json");
}

/// What others have put beside an earlier result goes on lying beside the new one.
void keep_foreign_files(const fs::path& old, const fs::path& target) {
  for (const fs::directory_entry& entry : fs::directory_iterator(old)) {
    const fs::path name = entry.path().filename();
    std::error_code ignored;
    if (!is_ours(name.string()) && !is_of_setup(entry.path()) &&
        !fs::exists(fs::symlink_status(target / name)))
      fs::rename(entry.path(), target / name, ignored);
  }
}

/// Exchanges two folders in one step, so that no moment has neither; false where the system cannot.
bool exchange(const fs::path& a, const fs::path& b) {
  return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

/// The nearest folder above that exists already.
fs::path existing_above(fs::path path) {
  while (!fs::exists(path) && path.has_parent_path() && path != path.parent_path()) path = path.parent_path();
  return path;
}

bool is_mount_point(const fs::path& folder) {
  struct stat inside {
  }, outside{};
  return stat(folder.c_str(), &inside) == 0 && stat(folder.parent_path().c_str(), &outside) == 0 &&
         inside.st_dev != outside.st_dev;
}

/// Results replace a folder: one that cannot be renamed, or in which the user stands, cannot be replaced.
void check_can_be_replaced(const fs::path& folder) {
  const fs::path here = fs::current_path().lexically_proximate(fs::canonical(folder));
  if (here == "." || (*here.begin() != ".." && here.is_relative())) {
    refuse_place(folder.string(), "results replace their folder whole, and this is the current one",
                 "name a new folder with -o, for example -o results");
  }
  if (is_mount_point(folder)) {
    refuse_place(
        folder.string(), "results replace their folder whole, and a file system is mounted here",
        fmt::format("name a folder inside it with -o, for example {}", (folder / "results").string()));
  }
}

void check_room(const fs::path& folder, double bytes) {
  std::error_code error;
  const fs::space_info space = fs::space(existing_above(folder), error);
  constexpr double kMegabyte = 1e6;
  if (error || static_cast<double>(space.available) >= bytes) return;
  refuse_write(folder.string(),
               fmt::format("the results need about {:.1f} MB, the disk has {:.1f} MB left", bytes / kMegabyte,
                           static_cast<double>(space.available) / kMegabyte),
               "free space, or name a place on another disk with -o");
}

}  // namespace

PendingFolder::PendingFolder(const std::string& target)
    : target_(clean(target)), pending_(target_.string() + fmt::format(".part{}", getpid())) {
  std::error_code error;
  fs::remove_all(pending_, error);
  if (!error) fs::create_directories(pending_, error);
  if (error) refuse_write(target_.string(), error.message());
}

PendingFolder::~PendingFolder() {
  std::error_code ignored;
  fs::remove_all(pending_, ignored);
}

std::string PendingFolder::file(const std::string& name) const {
  return (pending_ / name).string();
}

void PendingFolder::move_into_place() {
  std::error_code error;
  if (!fs::exists(target_)) {
    fs::rename(pending_, target_, error);
    if (error) refuse_write(target_.string(), error.message());
    return;
  }
  fs::path old = pending_;  // after the exchange
  if (!exchange(pending_, target_)) {
    old = target_.string() + fmt::format(".old{}", getpid());
    fs::rename(target_, old, error);
    if (!error) fs::rename(pending_, target_, error);
    if (error) {
      std::error_code ignored;
      if (!fs::exists(target_)) fs::rename(old, target_, ignored);
      refuse_write(target_.string(), error.message());
    }
  }
  keep_foreign_files(old, target_);
  fs::remove_all(old, error);
}

std::string PendingFolder::keep_incomplete() {
  fs::path place = target_.string() + ".incomplete";
  for (int i = 2; fs::exists(fs::symlink_status(place)); ++i)
    place = target_.string() + fmt::format(".incomplete{}", i);
  fs::rename(pending_, place);
  return place.string();
}

void check_output_folder(const std::string& folder, const std::string& mark, double bytes) {
  const fs::path target = clean(folder);
  if (fs::exists(fs::symlink_status(target))) {
    const bool empty = fs::is_directory(target) && fs::is_empty(target);
    if (!empty && !(fs::is_directory(target) && fs::exists(target / mark)))
      refuse_place(folder, "this exists and is not an earlier result of swarf, so it will not be replaced",
                   "name another folder with -o, or remove it yourself");
    check_can_be_replaced(target);
  }
  check_room(target, bytes);
  const PendingFolder trial(folder);
  write_text(trial.file("trial"), "trial");
}

void check_output_file(const std::string& path) {
  if (path.empty()) return;
  if (fs::is_directory(path)) refuse_write(path, "a folder stands in its place", "name a file");
  const std::string trial = path + fmt::format(".trial{}", getpid());
  const int file = open(trial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) refuse_write(path, std::strerror(errno));
  close(file);
  unlink(trial.c_str());
}

void write_text(const std::string& path, const std::string& text) {
  replace_file(path, text, {"cannot-write", "this cannot be written"});
}

}  // namespace swarf::reports

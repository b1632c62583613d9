#include "machine/shipped.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace swarf::machine {
namespace {

namespace fs = std::filesystem;

/// The file that holds this very code: the program, or the library that another program has loaded.
fs::path own_file() {
  Dl_info info{};
  link_map* map = nullptr;
  const bool known = dladdr1(reinterpret_cast<const void*>(&own_file), &info, reinterpret_cast<void**>(&map),
                             RTLD_DL_LINKMAP) != 0;
  std::error_code problem;
  // The program itself has no name there.
  if (known && map->l_name != nullptr && *map->l_name != '\0') return fs::canonical(map->l_name, problem);
  return fs::read_symlink("/proc/self/exe", problem);
}

/// Empty where no folder above the program holds machines.
fs::path find_folder() {
  std::error_code problem;
  const fs::path program = own_file();
  constexpr std::array<const char*, 2> kPlaces{"share/swarf/assets/machines", "assets/machines"};
  for (fs::path at = program.parent_path(); !at.empty(); at = at.parent_path()) {
    for (const char* place : kPlaces) {
      if (fs::is_directory(at / place, problem)) return at / place;
    }
    if (at == at.parent_path()) break;
  }
  return {};
}

bool is_path(const std::string& written) {
  return written.find('/') != std::string::npos || written.ends_with(".toml");
}

}  // namespace

std::string shipped_folder() {
  return find_folder().string();
}

std::vector<ShippedMachine> shipped_machines() {
  std::vector<ShippedMachine> machines;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(find_folder(), problem)) {
    const fs::path file = entry.path() / "machine.toml";
    if (fs::exists(file, problem)) machines.push_back({entry.path().filename().string(), file.string()});
  }
  std::sort(machines.begin(), machines.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return machines;
}

std::string machine_file(const std::string& written) {
  if (is_path(written)) return written;
  for (const ShippedMachine& machine : shipped_machines()) {
    if (machine.name == written) return machine.file;
  }
  return "";
}

}  // namespace swarf::machine

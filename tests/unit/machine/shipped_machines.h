// The machines of assets/machines.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "machine/machine_scene.h"

namespace swarf::machine {

inline std::string shipped_file(const std::string& name) {
  return SWARF_SOURCE_DIR "/assets/machines/" + name + "/machine.toml";
}

/// Names of the folders, sorted.
inline std::vector<std::string> shipped_machines() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SWARF_SOURCE_DIR "/assets/machines")) {
    const std::string name = entry.path().filename().string();
    if (std::filesystem::exists(shipped_file(name))) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Read once each: the meshes take longer than most tests.
inline const MachineScene& shipped_scene(const std::string& name) {
  static std::map<std::string, MachineScene> read;
  const auto found = read.find(name);
  return found != read.end() ? found->second
                             : read.emplace(name, load_machine(shipped_file(name))).first->second;
}

inline const kinematics::MachineModel& shipped_machine(const std::string& name) {
  return shipped_scene(name).model;
}

}  // namespace swarf::machine

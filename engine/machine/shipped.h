// The machines that come with the program: folders with a machine.toml.
#pragma once

#include <string>
#include <vector>

namespace swarf::machine {

struct ShippedMachine {
  std::string name;  ///< of its folder: "mill_3axis"
  std::string file;  ///< its machine.toml
};

/// share/swarf/assets/machines or assets/machines in the nearest folder above the running program, or above
/// the library with this code, that has one; "" where there is none.
std::string shipped_folder();

/// All machines of that folder by name.
std::vector<ShippedMachine> shipped_machines();

/// The file that a scene or a flag means: `written` itself where it is a path (it has a slash or ends in
/// .toml), else the shipped machine of that name; "" where none is called so.
std::string machine_file(const std::string& written);

}  // namespace swarf::machine

#include "sim/job/set_ups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace swarf::sim {
namespace {

constexpr const char* kSetup = "setup";

/// Keys of [stock] that say what the material is.
const std::vector<std::string> kForms{"box_mm", "cylinder", "tube", "outline", "mesh", "from_run"};

/// What lies in the work frame of one set-up cannot be said for all of them.
void check_root(ConfigTable& root) {
  for (const char* key : {"design", "fixture"}) {
    if (!root.has(key)) continue;
    root.error(
        "whose-frame", key,
        fmt::format("'{}' stands outside of the [[setup]] tables, each of which has a work frame of its "
                    "own",
                    key),
        fmt::format("write it into the set-up that it belongs to: [setup.{}] behind its [[setup]]{}", key,
                    key == std::string("fixture") ? ", [[setup.fixture]]" : ""));
  }
}

void check_later(ConfigTable& setup, size_t number) {
  if (!setup.has("stock")) return;
  ConfigTable stock = setup.table("stock");
  for (const std::string& form : kForms) {
    if (!stock.has(form)) continue;
    stock.error("two-stocks", form,
                fmt::format("set-up {} names a raw stock of its own: it begins with what the one before has "
                            "left",
                            number),
                "leave it out; how the part lies now is its part_pose");
  }
}

}  // namespace

ConfigOverlay setup_overlay(size_t index) {
  return {kSetup,
          index,
          {"name", "part_pose", "work_origin_mm", "work_rotation_deg", "start", "units", "start_tool",
           "start_tool_name", "t_changes_tool", "slot_ends", "without_length", "offsets"},
          {{"program", "cl", "nc"}, {"tool", "tools", "tool_table", "cutter"}},
          {"stock", "accept", "interpolator", "toolpath", "movie", "stills", "output", "report"}};
}

size_t count_setups(const std::string& path, const std::vector<std::string>& overrides) {
  Diagnostics diagnostics;
  std::vector<std::string> of_list;
  for (const std::string& one : overrides)
    if (one.starts_with(std::string(kSetup) + "[")) of_list.push_back(one);
  ConfigTable root = ConfigTable::load(path, of_list, diagnostics);
  diagnostics.throw_if_errors();
  if (!root.is_list(kSetup)) return 0;
  std::vector<ConfigTable> setups = root.tables(kSetup);
  if (setups.empty())
    root.error("no-set-ups", kSetup, "the list of set-ups is empty",
               "write [[setup]] tables, or one table [setup]");
  check_root(root);
  for (size_t i = 1; i < setups.size(); ++i) check_later(setups[i], i + 1);
  diagnostics.throw_if_errors();
  return setups.size();
}

std::string setup_folder(const Scene& scene) {
  std::string name;
  for (const char c : scene.setup.name.empty() ? std::string("setup") : scene.setup.name) {
    const auto letter = static_cast<unsigned char>(c);
    name += std::isalnum(letter) != 0 || c == '.' || c == '-' ? static_cast<char>(std::tolower(letter)) : '_';
  }
  return fmt::format("{}_{}", scene.setup.number, name);
}

std::vector<EarlierSetup> setups_up_to(std::shared_ptr<const Job> last, const Pose& X_WL,
                                       const std::string& stock_file) {
  std::vector<EarlierSetup> list = last->earlier;
  for (EarlierSetup& one : list) one.X_WE = X_WL * one.X_WE;
  list.push_back({std::move(last), X_WL, stock_file});
  if (!stock_file.empty())
    for (EarlierSetup& one : list) one.other_run = true;
  return list;
}

}  // namespace swarf::sim

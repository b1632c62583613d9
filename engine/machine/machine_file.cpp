#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/config.h"
#include "kinematics/model_check.h"
#include "machine/axis_table.h"
#include "machine/machine_scene.h"
#include "mesh/mesh_io.h"

namespace swarf::machine {
namespace {

namespace fs = std::filesystem;
using kinematics::Axis;

/// A [[link]] as it stands in the file; names are resolved when all are known.
struct LinkEntry {
  ConfigTable table;
  std::string name, parent, axis, mesh, mount;
  Link link;
};

LinkEntry read_link(ConfigTable table) {
  LinkEntry entry{
      table, table.text("name"), table.text("parent", ""), table.text("axis", ""), table.text("mesh", ""), "",
      {}};
  if (table.has("mount")) entry.mount = table.choice("mount", {"work", "tool"});
  const Vec3 colour = read_vec3(table, "colour", std::vector<double>{0.7, 0.7, 0.7});
  if (colour.minCoeff() < 0.0 || colour.maxCoeff() > 1.0) {
    table.error("out-of-range", "colour",
                fmt::format("the colour is [{:g}, {:g}, {:g}]", colour.x(), colour.y(), colour.z()),
                "each of red, green and blue (linear) must be from 0 to 1");
  }
  entry.link.name = entry.name;
  for (int i = 0; i < 3; ++i) entry.link.colour[static_cast<size_t>(i)] = static_cast<float>(colour[i]);
  entry.link.metalness = static_cast<float>(table.number("metalness", {0.0, 1.0}, 0.0));
  entry.link.roughness = static_cast<float>(table.number("roughness", {0.0, 1.0}, 0.6));
  return entry;
}

class MachineReader {
 public:
  MachineReader(const std::string& path, Diagnostics& diagnostics)
      : path_(path), diagnostics_(diagnostics), root_(ConfigTable::load(path, {}, diagnostics)) {}

  MachineScene read() {
    if (diagnostics_.has_errors()) return {};
    scene_.file = path_;
    scene_.model.name = root_.text("name");
    read_axes();
    read_links();
    ConfigTable work = root_.table("work");
    scene_.model.X_MW.translation() = read_vec3(work, "origin_mm");
    read_tool(root_, scene_.model);
    read_rapid(root_, scene_.model);
    if (root_.has("tool_change_s")) scene_.tool_change_s = root_.number("tool_change_s", {0.0, 3600.0});
    if (root_.has("units"))
      scene_.program_unit_mm = root_.choice("units", {"mm", "inch"}) == "inch" ? 25.4 : 1.0;
    root_.finish();
    if (!diagnostics_.has_errors()) resolve_links();
    if (!diagnostics_.has_errors()) make_chains();
    if (!diagnostics_.has_errors()) scene_.assumed_dynamics = set_usual_dynamics(scene_.model.axes);
    if (!diagnostics_.has_errors()) check_kinematics();
    if (!diagnostics_.has_errors()) load_meshes();
    return std::move(scene_);
  }

 private:
  void read_axes() {
    for (ConfigTable& table : root_.tables("axis")) {
      const Axis axis = read_axis(table);
      if (axis_index(axis.name) >= 0) {
        table.error("axis-twice", "name", fmt::format("axis {} is described twice", axis.name),
                    "give each axis a letter of its own");
      }
      scene_.model.axes.push_back(axis);
      axis_tables_.push_back(table);
      written_sides_.push_back(table.has("side") ? table.choice("side", {"table", "head"}) : "");
    }
    if (!root_.has("axis")) {
      root_.error("missing-key", "axis", "the machine has no axes", "describe them in [[axis]] tables");
    }
    if (scene_.model.axes.size() > static_cast<size_t>(kinematics::kMaxAxes)) {
      root_.error("too-many-axes", "axis", fmt::format("the machine has {} axes", scene_.model.axes.size()),
                  "at most three linear and two rotary axes");
    }
  }

  void read_links() {
    for (const ConfigTable& table : root_.tables("link")) {
      LinkEntry entry = read_link(table);
      if (entry.name.empty() && entry.table.has("name")) {
        entry.table.error("out-of-range", "name", "the link has an empty name", "give it a name");
      } else if (!entry.name.empty() && entry_index(entry.name) >= 0) {
        entry.table.error("link-twice", "name", fmt::format("a second link is called '{}'", entry.name),
                          "give each link a name of its own");
      }
      entries_.push_back(std::move(entry));
    }
  }

  int axis_index(const std::string& name) const {
    const auto& axes = scene_.model.axes;
    const auto found =
        std::find_if(axes.begin(), axes.end(), [&](const Axis& axis) { return axis.name == name; });
    return found == axes.end() ? -1 : static_cast<int>(found - axes.begin());
  }

  int entry_index(const std::string& name) const {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [&](const LinkEntry& e) { return e.name == name; });
    return found == entries_.end() ? -1 : static_cast<int>(found - entries_.begin());
  }

  std::vector<std::string> link_names() const {
    std::vector<std::string> names;
    for (const LinkEntry& entry : entries_) names.push_back(entry.name);
    return names;
  }

  /// Parents before children, names turned into indices.
  void resolve_links() {
    std::map<int, int> place;  // entry -> link
    for (size_t i = 0; i < entries_.size(); ++i) place_link(static_cast<int>(i), place);
    for (size_t i = 0; i < scene_.model.axes.size() && !diagnostics_.has_errors(); ++i) {
      const bool carried = std::any_of(scene_.links.begin(), scene_.links.end(),
                                       [&](const Link& l) { return l.axis == static_cast<int>(i); });
      if (!carried) {
        axis_tables_[i].error("axis-without-link", "name",
                              fmt::format("axis {} moves no link", scene_.model.axes[i].name),
                              "name it as the axis of a [[link]]");
      }
    }
  }

  /// -1: the floor, or a name that no link has.
  int parent_of(int entry) const {
    const std::string& parent = entries_[static_cast<size_t>(entry)].parent;
    return parent.empty() ? -1 : entry_index(parent);
  }

  /// False, with a diagnostic, when the way up ends or turns back at this entry.
  bool can_go_on(int at, const std::vector<int>& way) {
    LinkEntry& entry = entries_[static_cast<size_t>(at)];
    const auto again = std::find(way.begin(), way.end(), at);
    if (again != way.end()) {
      std::string names;
      for (auto it = again; it != way.end(); ++it) names += entries_[static_cast<size_t>(*it)].name + " -> ";
      entry.table.error("chain-cycle", "parent",
                        fmt::format("the links stand on each other in a circle: {}{}", names, entry.name),
                        "one of them must stand on the floor or on a link outside the circle");
      return false;
    }
    if (entry.parent.empty() || parent_of(at) >= 0) return true;
    const std::string near = nearest_name(entry.parent, link_names());
    entry.table.error("unknown-parent", "parent",
                      fmt::format("link '{}' stands on '{}', which is no link", entry.name, entry.parent),
                      near.empty() ? "name another link, or leave the key out for the floor"
                                   : fmt::format("did you mean '{}'?", near));
    return false;
  }

  void place_link(int entry_number, std::map<int, int>& place) {
    // Walk up until a link that is placed (or the floor), then place the way down.
    std::vector<int> way;
    for (int at = entry_number; at >= 0 && place.count(at) == 0; at = parent_of(at)) {
      if (broken_.count(at) == 0 && !can_go_on(at, way)) broken_.insert(at);
      way.push_back(at);
      if (broken_.count(at) > 0) {
        broken_.insert(way.begin(), way.end());
        return;
      }
    }
    for (auto it = way.rbegin(); it != way.rend(); ++it) {
      LinkEntry& entry = entries_[static_cast<size_t>(*it)];
      entry.link.parent = entry.parent.empty() ? -1 : place.at(parent_of(*it));
      place[*it] = static_cast<int>(scene_.links.size());
      add_link(*it);
    }
  }

  void add_link(int entry_number) {
    LinkEntry& entry = entries_[static_cast<size_t>(entry_number)];
    if (!entry.axis.empty()) {
      entry.link.axis = axis_index(entry.axis);
      if (entry.link.axis < 0) {
        entry.table.error(
            "unknown-axis", "axis",
            fmt::format("link '{}' moves with axis '{}', which is not described", entry.name, entry.axis),
            "describe it in an [[axis]] table or name another");
      }
    }
    const int index = static_cast<int>(scene_.links.size());
    if (entry.mount == "work") set_mount(scene_.work_link, index, entry);
    if (entry.mount == "tool") set_mount(scene_.tool_link, index, entry);
    scene_.links.push_back(entry.link);
    placed_entries_.push_back(entry_number);
  }

  static void set_mount(int& mount, int index, LinkEntry& entry) {
    if (mount >= 0)
      entry.table.error("mount-twice", "mount",
                        fmt::format("link '{}' is a second {} mount", entry.name, entry.mount), "keep one");
    mount = index;
  }

  void make_chains() {
    for (const auto& [mount, name] :
         {std::pair{scene_.work_link, "work"}, std::pair{scene_.tool_link, "tool"}}) {
      if (mount < 0)
        root_.error("no-mount", "link", fmt::format("no link carries the {}", name),
                    fmt::format("add mount = \"{}\" to a [[link]]", name));
    }
    if (diagnostics_.has_errors()) return;
    scene_.model.table_chain = chain_of(scene_.work_link, kinematics::Side::kTable);
    scene_.model.head_chain = chain_of(scene_.tool_link, kinematics::Side::kHead);
  }

  /// Axes from the floor to the mount; their side follows from it.
  std::vector<int> chain_of(int mount, kinematics::Side side) {
    std::vector<int> chain;
    for (int link = mount; link >= 0; link = scene_.links[static_cast<size_t>(link)].parent) {
      const int axis = scene_.links[static_cast<size_t>(link)].axis;
      if (axis < 0) continue;
      scene_.model.axes[static_cast<size_t>(axis)].side = side;
      chain.push_back(axis);
      const std::string found = side == kinematics::Side::kTable ? "table" : "head";
      const std::string& written = written_sides_[static_cast<size_t>(axis)];
      if (!written.empty() && written != found) {
        axis_tables_[static_cast<size_t>(axis)].error(
            "wrong-side", "side",
            fmt::format("axis {} says side = \"{}\", but its link is on the way to the {}",
                        scene_.model.axes[static_cast<size_t>(axis)].name, written,
                        side == kinematics::Side::kTable ? "work" : "tool"),
            fmt::format("write \"{}\", or move the axis to another link", found));
      }
    }
    std::reverse(chain.begin(), chain.end());
    return chain;
  }

  void check_kinematics() {
    for (const kinematics::ModelProblem& problem : kinematics::check_model(scene_.model)) {
      if (problem.axis >= 0) {
        axis_tables_[static_cast<size_t>(problem.axis)].error(problem.code, "name", problem.text,
                                                              problem.fix);
      } else {
        root_.error(problem.code, "axis", problem.text, problem.fix);
      }
    }
  }

  void load_meshes() {
    for (size_t i = 0; i < scene_.links.size(); ++i) {
      LinkEntry& entry = entries_[static_cast<size_t>(placed_entries_[i])];
      if (entry.mesh.empty()) continue;
      const fs::path file = fs::path(path_).parent_path() / entry.mesh;
      try {
        scene_.links[i].mesh = mesh::load_mesh(file.string());
      } catch (const InputError& error) {
        const Diagnostic& first = error.diagnostics.list().front();
        std::string place = first.where.file;
        if (first.where.line > 0) place += fmt::format(":{}:{}", first.where.line, first.where.column);
        entry.table.error(first.code, "mesh", fmt::format("{}: {}", place, first.text), first.fix);
      }
    }
  }

  std::string path_;
  Diagnostics& diagnostics_;
  ConfigTable root_;
  MachineScene scene_;
  std::vector<LinkEntry> entries_;
  std::vector<ConfigTable> axis_tables_;
  std::vector<std::string> written_sides_;  ///< per axis; "": not written
  std::vector<int> placed_entries_;         ///< link -> entry
  std::set<int> broken_;                    ///< entries whose way to the floor is broken, reported already
};

}  // namespace

MachineScene load_machine(const std::string& path) {
  Diagnostics diagnostics;
  MachineScene scene = MachineReader(path, diagnostics).read();
  diagnostics.throw_if_errors();
  return scene;
}

}  // namespace swarf::machine

#include "reports/kept_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "base/config.h"
#include "base/file.h"
#include "reports/kept_sources.h"
#include "sim/job/fixture_keys.h"
#include "sim/job/kept_job.h"
#include "sim/job/tool_library.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;

/// The files that have been copied, in order.
using Copied = std::vector<fs::path>;

void keep_copy(const fs::path& from, const fs::path& to, Copied& copied) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (!error) fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  if (error) {
    throw InputError("cannot-copy", {from.string()},
                     fmt::format("the file cannot be kept with the results: {}", error.message()),
                     "check that it may be read and that the disk has space");
  }
  copied.push_back(from);
}

std::string text_of(const fs::path& path) {
  refuse_special_file(path.string());
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A TOML text; the path may hold what has a meaning there.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// The file's own name where every program can write it down, else `otherwise` with its ending.
fs::path plain_name(const fs::path& file, const std::string& otherwise) {
  const std::string name = file.filename().string();
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
  return plain ? fs::path(name) : fs::path(otherwise);
}

/// The meshes as machine.toml names them, each once.
std::vector<std::string> mesh_names(const std::string& machine_file) {
  Diagnostics ignored;  // the file has been read before
  ConfigTable root = ConfigTable::load(machine_file, {}, ignored);
  std::vector<std::string> names;
  for (ConfigTable& link : root.tables("link")) {
    const std::string name = link.text("mesh", "");
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

/// The most folders above its start that a relative path visits.
int folders_above(const fs::path& path) {
  int depth = 0, least = 0;
  for (const fs::path& part : path) {
    if (part == "..") {
      least = std::min(least, --depth);
    } else if (part != ".") {
      ++depth;
    }
  }
  return -least;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Below input/machine, so deep that every relative mesh lies below it too; returns machine.toml's place.
fs::path keep_machine(const fs::path& input, const std::string& machine_file, Copied& copied) {
  const std::vector<std::string> meshes = mesh_names(machine_file);
  int above = 0;
  for (const std::string& mesh : meshes) {
    if (!fs::path(mesh).is_absolute()) above = std::max(above, folders_above(mesh));
  }
  fs::path place = "machine";
  for (int i = 0; i < above; ++i) place /= fmt::format("below_{}", i + 1);
  const fs::path folder = fs::path(machine_file).parent_path();
  std::string text = text_of(machine_file);
  for (size_t i = 0; i < meshes.size(); ++i) {
    fs::path mesh = meshes[i];
    if (mesh.is_absolute()) {
      mesh = fmt::format("kept_{}{}", i, mesh.extension().string());
      replace_all(text, "\"" + meshes[i] + "\"", "\"" + mesh.string() + "\"");
      replace_all(text, "'" + meshes[i] + "'", "\"" + mesh.string() + "\"");
      keep_copy(meshes[i], input / place / mesh, copied);
    } else {
      keep_copy(folder / mesh, input / place / mesh, copied);
    }
  }
  place /= fs::path(machine_file).filename();
  fs::create_directories((input / place).parent_path());
  write_text((input / place).string(), text);
  copied.emplace_back(machine_file);
  return place;
}

/// What the run has found for the scene: another computer's memory gives another voxel.
void add_what_was_open(const sim::StockSettings& stock, std::vector<std::string>& overrides) {
  const Vec3 &low = stock.box_W.lower, &high = stock.box_W.upper;
  if (stock.auto_box)
    overrides.push_back(fmt::format("stock.box_mm=[[{}, {}, {}], [{}, {}, {}]]", low.x(), low.y(), low.z(),
                                    high.x(), high.y(), high.z()));
  if (stock.auto_voxel) overrides.push_back(fmt::format("stock.voxel_mm={}", stock.voxel_mm));
}

constexpr const char* kProgramFolder = "program";

/// The folder below input/ for what belongs to one of several set-ups before the run's own.
std::string setup_place(const sim::Job& job) {
  return fmt::format("setup_{}", job.scene.setup.number);
}

/// Another run that the stock comes from: all that its job is made of again, and what says how far it was
/// cut.
void keep_run(const fs::path& run, const fs::path& to, Copied& copied) {
  fs::create_directories(to);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(run / "input"))
    if (entry.is_regular_file())
      keep_copy(entry.path(), to / "input" / fs::relative(entry.path(), run / "input"), copied);
  for (const char* name : {sim::kRunMark, "stock.vdb"}) keep_copy(run / name, to / name, copied);
}

/// Copies what one job names into input/`inside`; returns the overrides that point there.
std::vector<std::string> keep_job(const fs::path& input, const fs::path& inside, const sim::Job& job,
                                  const std::vector<std::string>& overrides, Copied& copied) {
  std::vector<std::string> all = overrides;
  const auto say = [&](const std::string& key, const fs::path& place) {
    all.push_back(fmt::format("{}={}", key, quoted((inside / place).string())));
  };
  const auto keep = [&](const std::string& key, const std::string& file, const fs::path& place) {
    if (file.empty()) return;
    keep_copy(file, input / inside / place, copied);
    say(key, place);
  };
  const auto beside = [](const std::string& file, const std::string& name) {
    return fs::path(name + fs::path(file).extension().string());
  };
  const sim::Scene& scene = job.scene;
  add_what_was_open(scene.stock, all);
  say("machine", keep_machine(input / inside, scene.machine_file, copied));
  // A design that is milled by the flank without a program: the scene says it all.
  if (scene.program_file != scene.file)
    keep(scene.program_key, scene.program_file,
         fs::path(kProgramFolder) / plain_name(scene.program_file, "program"));
  keep("tool_table", scene.tool_table_file, beside(scene.tool_table_file, "tools"));
  for (const auto& [name, file] : scene.tool_table_file.empty()
                                      ? std::vector<std::pair<std::string, std::string>>{}
                                      : sim::tool_library_parts(scene.tool_table_file))
    keep_copy(file, input / inside / fs::path(name).filename(), copied);
  const sim::RawSettings& raw = scene.stock.raw;
  if (raw.kind == sim::RawKind::kRun) {
    keep_run(raw.file, input / inside / "earlier_run", copied);
    say("stock.from_run", "earlier_run");
  } else if (!raw.file.empty()) {
    keep("stock." + raw.key, raw.file, beside(raw.file, "stock"));
  }
  if (scene.design.kind == sim::DesignKind::kSurface)
    keep("design.surface", scene.design.surface_file, beside(scene.design.surface_file, "design"));
  // A file that drives is the design too, and is kept as what drives.
  const bool drives = scene.driven && (scene.driven->mesh || scene.driven->step);
  if (!drives &&
      (scene.design.kind == sim::DesignKind::kMesh || scene.design.kind == sim::DesignKind::kRuledFaces))
    keep("design." + scene.design.mesh_key, scene.design.mesh_file, beside(scene.design.mesh_file, "design"));
  keep("report.logo", scene.report.logo_file, beside(scene.report.logo_file, "logo"));
  for (size_t i = 0; i < scene.fixtures.size(); ++i) {
    machine::Fixture fixture = scene.fixtures[i];
    const std::string* const file = sim::mesh_file_of(fixture);
    if (file == nullptr) continue;
    const std::string number = std::to_string(i);
    keep("fixture[" + number + "].mesh", *file, beside(*file, "fixture_" + number));
  }
  return all;
}

void keep_programs(const fs::path& kept, const sim::Job& job, const std::vector<std::string>& called,
                   Copied& copied) {
  const fs::path home = fs::path(job.scene.program_file).parent_path();
  for (const std::string& file : called) {
    const fs::path seen = fs::path(file).lexically_proximate(home);
    const bool below = !seen.is_absolute() && folders_above(seen) == 0;
    const fs::path place = kept / (below ? seen : seen.filename());
    if (!fs::exists(place)) keep_copy(file, place, copied);
  }
}

}  // namespace

KeptInputs keep_inputs(const PendingFolder& folder, const sim::Job& job,
                       const std::vector<std::string>& overrides) {
  const fs::path input = folder.file("input");
  fs::create_directories(input);
  Copied copied;
  if (job.scene.text.empty()) {
    keep_copy(job.scene.file, input / "scene.toml", copied);
  } else {
    write_text((input / "scene.toml").string(), job.scene.text);
  }
  KeptInputs kept{keep_job(input, "", job, overrides, copied), {}};
  if (job.scene.setup.number > 0) {
    kept.earlier.emplace();
    for (const sim::EarlierSetup& earlier : job.earlier)
      if (!earlier.other_run)
        kept.earlier->push_back(keep_job(input, setup_place(*earlier.job), *earlier.job, overrides, copied));
  }
  add_sources(input, copied);
  return kept;
}

void keep_called_programs(const PendingFolder& folder, const sim::Job& job,
                          const std::vector<std::string>& called,
                          const std::vector<std::vector<std::string>>& called_earlier) {
  const fs::path input = folder.file("input");
  Copied copied;
  keep_programs(input / kProgramFolder, job, called, copied);
  for (size_t i = 0; i < called_earlier.size(); ++i) {
    const sim::EarlierSetup& earlier = job.earlier[i];
    if (!earlier.other_run)
      keep_programs(input / setup_place(*earlier.job) / kProgramFolder, *earlier.job, called_earlier[i],
                    copied);
  }
  add_sources(input, copied);
}

}  // namespace swarf::reports

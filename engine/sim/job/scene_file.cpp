#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "base/config.h"
#include "base/units.h"
#include "machine/shipped.h"
#include "program/dialects.h"
#include "sim/job/fixture_keys.h"
#include "sim/job/open_job.h"
#include "sim/job/scene.h"
#include "sim/job/set_ups.h"
#include "sim/job/tool_table.h"

namespace swarf::sim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGenericMachine = "mill_3axis";

/// As for meshes: a kilometre from the origin of the work, mm.
constexpr double kFarthest = 1e6;

/// False where the key is not there or says "auto".
bool is_said(ConfigTable& table, const char* key) {
  if (table.is_text(key)) return table.choice(key, {"auto"}) != "auto";
  return table.has(key);
}

StockSettings read_stock(ConfigTable table, const std::vector<cutter::Cutter>& tools, bool blocks,
                         Diagnostics& diagnostics) {
  StockSettings stock;
  stock.raw = read_raw(table);
  const bool box = stock.raw.kind == RawKind::kBox;
  stock.auto_box = box && blocks && !is_said(table, "box_mm");
  // Any other shape is loaded with the job: a file may lie behind it.
  stock.box_W = stock.auto_box || !box ? Box{Vec3::Zero(), Vec3::Ones()} : table.box("box_mm");
  if (std::max(stock.box_W.lower.cwiseAbs().maxCoeff(), stock.box_W.upper.cwiseAbs().maxCoeff()) >
      kFarthest) {
    table.error("out-of-range", "box_mm", "the stock reaches too far from the origin of the work",
                fmt::format("every number must be from {:g} to {:g} mm", -kFarthest, kFarthest));
    stock.box_W = {Vec3::Zero(), Vec3::Ones()};
  }
  stock.auto_voxel = blocks && !is_said(table, "voxel_mm");
  stock.voxel_where = table.where("voxel_mm");
  if (!stock.auto_voxel) stock.voxel_mm = table.number("voxel_mm", kAboveZero);
  if (box && !stock.auto_box && !stock.auto_voxel) check_voxel(stock, tools, diagnostics);
  stock.sweep_tolerance_mm = table.number("sweep_tolerance_um", kAboveZero, 1.0) * kMicrometre;
  if (!blocks)
    stock.cut_by = CutBy::kPasses;
  else if (table.choice("cut_by", {"blocks", "cycles"}, "blocks") == "cycles")
    stock.cut_by = CutBy::kCycles;
  stock.max_memory_mb = table.number("max_memory_mb", kZeroOrMore, 0.0);
  return stock;
}

toolpath::Planner planner_from(const std::string& word) {
  if (word == "lin_koren") return toolpath::Planner::kLinKoren;
  if (word == "isoparametric") return toolpath::Planner::kIsoparametric;
  return toolpath::Planner::kConstantScallop;
}

void read_toolpath(ConfigTable table, Scene& scene) {
  toolpath::PlanOptions& options = scene.toolpath;
  options.planner = planner_from(
      table.choice("planner", {"constant_scallop", "lin_koren", "isoparametric"}, "constant_scallop"));
  scene.compare_planners = table.boolean("compare", true);
  options.safe_distance_mm = table.number("safe_distance_mm", kAboveZero, options.safe_distance_mm);
  options.overrun_mm = table.number("overrun_mm", kZeroOrMore, options.overrun_mm);
  options.rapid_clearance_mm = table.number("rapid_clearance_mm", kAboveZero, options.rapid_clearance_mm);
}

void read_period_and_limits(ConfigTable& table, motion::MotionOptions& options) {
  options.period_s = table.number("period_ms", {0.01, 100.0}, options.period_s * 1e3) * 1e-3;
  options.path_acceleration_max =
      table.number("path_acceleration_max_mm_s2", kAboveZero, options.path_acceleration_max);
  options.path_jerk_max = table.number("path_jerk_max_mm_s3", kAboveZero, options.path_jerk_max);
}

/// An NC program says itself what the tool does between two positions.
void read_block_interpolator(ConfigTable table, Scene& scene) {
  if (scene.kind == ProgramKind::kNc && !scene.post) return read_period_and_limits(table, scene.motion);
  const std::string mode = table.choice("mode", {"tcp", "joint", "ends"}, "tcp");
  scene.block_law = mode == "joint"  ? toolpath::BlockLaw::kJoint
                    : mode == "ends" ? toolpath::BlockLaw::kEnds
                                     : toolpath::BlockLaw::kTcp;
  scene.linearise_tolerance_mm = table.number("linearise_tolerance_um", kAboveZero, 10.0) * kMicrometre;
  read_period_and_limits(table, scene.motion);
}

/// The tolerance of its chords is a key of [driven]; that of corners counts where CAM blocks are compared.
void read_driven_interpolator(ConfigTable table, Scene& scene) {
  motion::MotionOptions& options = scene.motion;
  options.corner_tolerance_mm =
      table.number("corner_tolerance_um", kAboveZero, um_from_mm(options.corner_tolerance_mm)) * kMicrometre;
  read_period_and_limits(table, options);
}

void read_interpolator(ConfigTable table, Scene& scene) {
  motion::MotionOptions& options = scene.motion;
  const std::string mode = table.choice("mode", {"surface", "taylor1", "offline"}, "surface");
  options.mode = mode == "taylor1"   ? motion::Mode::kTaylor1
                 : mode == "offline" ? motion::Mode::kOffline
                                     : motion::Mode::kSurface;
  const std::string orientation = table.choice(
      "offline_orientation", {"constant", "linear_in_u", "linear_along_chord"}, "linear_along_chord");
  options.orientation = orientation == "constant"      ? motion::OfflineOrientation::kConstant
                        : orientation == "linear_in_u" ? motion::OfflineOrientation::kLinearInU
                                                       : motion::OfflineOrientation::kLinearAlongChord;
  options.look_ahead = table.boolean("offline_look_ahead", options.look_ahead);
  if (table.has("chord_tolerance_um")) {
    scene.chord_tolerance_mm = table.number("chord_tolerance_um", kAboveZero, 1.0) * kMicrometre;
  }
  read_period_and_limits(table, options);
}

void read_pictures(ConfigTable& root, Scene& scene) {
  scene.movie = read_movie(root.table("movie"));
  scene.stills = read_stills(root.table("stills"));
}

OutputSettings read_output(ConfigTable table) {
  OutputSettings output;
  const std::string format = table.choice("trajectory", {"none", "csv", "h5"}, "none");
  if (format != "none") output.trajectory = format == "csv" ? TrajectoryFormat::kCsv : TrajectoryFormat::kH5;
  if (table.has("budget_s")) output.budget_s = table.number("budget_s", kAboveZero, 1.0);
  return output;
}

/// A name as every file of the results can hold it: what is not UTF-8 (folders of other systems) becomes '?'.
std::string utf8_only(const std::string& name) {
  std::string text;
  for (size_t at = 0; at < name.size();) {
    const auto byte = [&](size_t i) {
      return at + i < name.size() ? static_cast<unsigned char>(name[at + i]) : 0U;
    };
    const size_t length = byte(0) < 0x80                      ? 1
                          : byte(0) >= 0xc2 && byte(0) < 0xe0 ? 2
                          : byte(0) >= 0xe0 && byte(0) < 0xf0 ? 3
                                                              : 4;
    bool good = byte(0) < 0x80 || (byte(0) >= 0xc2 && byte(0) < 0xf5);
    for (size_t i = 1; i < length; ++i) good = good && (byte(i) & 0xc0U) == 0x80U;
    // Forms that are too long, halves of surrogate pairs, and numbers beyond the last letter.
    if (byte(0) == 0xe0 && byte(1) < 0xa0) good = false;
    if (byte(0) == 0xed && byte(1) >= 0xa0) good = false;
    if (byte(0) == 0xf0 && byte(1) < 0x90) good = false;
    if (byte(0) == 0xf4 && byte(1) >= 0x90) good = false;
    text += good ? name.substr(at, length) : "?";
    at += good ? length : 1;
  }
  return text;
}

/// A path in the scene, made relative to the scene's folder.
std::string beside(const std::string& scene_file, const std::string& path) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  return (fs::path(scene_file).parent_path() / path).lexically_normal().string();
}

/// Surfaces: scenes of surface blocks have defaults; where the program brings its blocks only the limits that
/// are given count. What no tool and no axis may do counts everywhere.
void read_accept(ConfigTable table, bool blocks, AcceptLimits& accept) {
  if (!blocks || table.has("scallop_max_um")) {
    accept.scallop_max_um = table.number("scallop_max_um", kAboveZero, 10.5);
  }
  if (table.has("excess_max_um")) accept.excess_max_um = table.number("excess_max_um", kAboveZero, 1.0);
  accept.roughing = table.boolean("roughing", false);
  if (accept.roughing && accept.excess_max_um)
    throw InputError("accept-contradiction", table.where("roughing"),
                     "roughing leaves material, and excess_max_um limits it", "write one of the two");
  if (!blocks || table.has("gouge_max_um"))
    accept.gouge_max_um = table.number("gouge_max_um", kAboveZero, 1.0);
  const auto count = [&](const char* key) { return table.integer(key, 0, 1000000, 0); };
  accept.collisions = count("collisions");
  accept.rapids_in_material = count("rapids_in_material");
  accept.spindle_wrong = count("spindle_wrong");
  accept.machine_parts = count("machine_parts");
  accept.travel = count("travel");
  accept.axis_speed = count("axis_speed");
}

/// What M428 to M430 mean, for LinuxCNC alone.
program::KinematicsSwitch read_kinematics_switch(ConfigTable table) {
  program::KinematicsSwitch kinematics;
  const std::vector<std::string> names{"identity", "tcp"};  // order of Kinematics
  const auto read = [&](const char* key, std::optional<program::Kinematics>& value) {
    if (!table.has(key)) return;
    value = table.choice(key, names) == names[1] ? program::Kinematics::kTcp : program::Kinematics::kIdentity;
  };
  read("start", kinematics.start);
  read("m428", kinematics.m428);
  read("m429", kinematics.m429);
  read("m430", kinematics.m430);
  return kinematics;
}

/// { M68 = "clamp C", "CYCL DEF 392" = "tuning" }.
program::BuilderWords read_builder_words(ConfigTable table) {
  program::BuilderWords words;
  for (const std::string& key : table.keys()) {
    const std::string word = program::builder_word(key);
    if (!word.empty())
      words[word] = table.text(key);
    else
      table.error("bad-key", key, fmt::format("'{}' is no word of a machine's builder", key),
                  "write M68, \"CYCL DEF 392\" or the name of a program");
  }
  return words;
}

/// { 500 = 3.5, R1 = 2 }.
program::Presets read_presets(ConfigTable table) {
  program::Presets presets;
  for (const std::string& key : table.keys())
    presets[program::preset_name(key)] = {table.number(key, {}), table.where(key)};
  return presets;
}

/// What swarf post has written of the CL data stands for them.
void take_written(std::optional<ConfigTable>& post, Scene& scene) {
  if (scene.kind != ProgramKind::kCl || !post) return;
  const std::string written = post->text("written", "");
  if (written.empty()) return;
  scene.kind = ProgramKind::kNc;
  scene.program_key = "post.written";
  scene.program_file = beside(scene.file, written);
}

/// [driven]: the part is its own program.
void read_scene_driven(ConfigTable& root, const char* first, Scene& scene) {
  if (first != nullptr)
    root.error("two-programs", first,
               fmt::format("the scene has a [driven] part and names a '{}' file", first),
               "keep one of program, cl, nc and [driven]");
  scene.kind = ProgramKind::kDriven;
  scene.driven = read_driven(root.table("driven"));
  scene.program_key = scene.driven->mesh        ? "driven.mesh"
                      : scene.driven->step      ? "driven.step"
                      : scene.driven->by_design ? "driven.by_design"
                                                : "driven.surface";
  scene.driven->file = beside(scene.file, scene.driven->file);
  scene.program_file = scene.driven->by_design ? scene.file : scene.driven->file;
}

/// [flank]: the design is milled along its rulings; with a `program` its G06.5 say which surfaces, and how
/// fast.
void read_scene_flank(ConfigTable& root, const char* first, Scene& scene) {
  const bool by_program = scene.kind == ProgramKind::kSurfaceBlocks && root.has("program");
  if (first != nullptr && !by_program)
    root.error("two-programs", first, fmt::format("the scene has [flank] and names a '{}' file", first),
               "keep one of program (of G06.5), cl, nc, [driven] and [flank]");
  scene.kind = ProgramKind::kFlank;
  scene.flank = read_flank(root.table("flank"), by_program);
  if (by_program) return;
  scene.program_key = "flank";
  scene.program_file = scene.file;
}

/// `program`, `cl`, `nc`, [driven] or [flank], exactly one of them.
void read_program(ConfigTable& root, std::optional<ConfigTable>& post, Scene& scene) {
  const std::array<std::pair<const char*, ProgramKind>, 3> kinds{
      {{"cl", ProgramKind::kCl}, {"nc", ProgramKind::kNc}, {"program", ProgramKind::kSurfaceBlocks}}};
  const char* first = nullptr;
  for (const auto& [key, kind] : kinds) {
    if (!root.has(key)) continue;
    const std::string file = root.text(key);
    if (first != nullptr) {
      root.error("two-programs", first, fmt::format("the scene names a '{}' and a '{}' file", key, first),
                 "keep one of program, cl and nc");
      continue;
    }
    first = key;
    scene.kind = kind;
    scene.program_key = key;
    scene.program_file = beside(scene.file, file);
  }
  if (first == nullptr && root.has("driven") && root.has("flank")) first = "driven";
  const bool surfaces = first != nullptr && scene.kind == ProgramKind::kSurfaceBlocks;
  if (root.has("flank") || (surfaces && program::mills_by_flank(scene.program_file)))
    return read_scene_flank(root, first, scene);
  if (root.has("driven")) return read_scene_driven(root, first, scene);
  if (first == nullptr) root.text("program");  // reports that it is missing
  take_written(post, scene);
  if (scene.kind != ProgramKind::kNc) return;
  if (root.has("dialect")) {
    scene.dialect = program::dialect_of(root.choice("dialect", program::dialect_names()));
  }
  // Of another dialect the key stays unread, and is reported as unknown.
  if (scene.dialect.value_or(program::Dialect::kLinuxCnc) == program::Dialect::kLinuxCnc &&
      root.has("kinematics_switch"))
    scene.kinematics_switch = read_kinematics_switch(root.table("kinematics_switch"));
  if (root.has("parameters")) scene.presets = read_presets(root.table("parameters"));
  if (root.has("builder_words")) scene.builder_words = read_builder_words(root.table("builder_words"));
}

/// What a CL file leaves open.
void read_cl_keys(ConfigTable& root, Scene& scene) {
  if (scene.kind != ProgramKind::kCl) return;
  program::ClOptions& options = scene.cl_options;
  if (root.has("cutcom")) {
    const bool centre = root.choice("cutcom", {"centre", "contour"}) == "centre";
    options.cutcom = centre ? program::ClPoints::kCentre : program::ClPoints::kContour;
  }
  if (root.has("cl_circle"))
    options.circle_clockwise = root.choice("cl_circle", {"clockwise", "counter_clockwise"}) == "clockwise";
  for (const cutter::Cutter& tool : scene.tools)
    options.tools.push_back({tool.number, tool.name, 0.5 * tool.diameter_mm});
}

/// Surface blocks are planned for one cutter.
void read_scene_tools(ConfigTable& root, Scene& scene, Diagnostics& diagnostics) {
  scene.tool_table_file = beside(scene.file, root.text("tool_table", ""));
  scene.tools = read_tools(root, scene.tool_table_file, diagnostics,
                           scene.kind == ProgramKind::kNc ? &scene.incomplete_tools : nullptr);
  scene.tools_in_words = root.has("tools");
  const bool planned = scene.kind == ProgramKind::kSurfaceBlocks || scene.kind == ProgramKind::kDriven ||
                       scene.kind == ProgramKind::kFlank;
  const bool chosen = scene.flank && scene.flank->best_tool;
  if (!planned || chosen || scene.tools.size() == 1) return;
  root.error(
      "planner-needs-one-tool", "tool",
      fmt::format("a path is planned for one cutter, the scene has {}", scene.tools.size()),
      "describe one, or run a program that brings its own tool positions; flank.tool = \"best\" chooses");
}

/// A program of blocks without a machine is for the generic mill.
void read_machine(ConfigTable& root, Scene& scene) {
  scene.machine_assumed =
      scene.kind != ProgramKind::kSurfaceBlocks && scene.kind != ProgramKind::kFlank && !root.has("machine");
  const std::string written = root.text(
      "machine", scene.machine_assumed ? std::optional<std::string>(kGenericMachine) : std::nullopt);
  if (written.empty()) return;
  const std::string file = machine::machine_file(written);
  if (!file.empty()) {
    scene.machine_file = file == written ? beside(scene.file, written) : file;
    return;
  }
  std::vector<std::string> names;
  for (const machine::ShippedMachine& one : machine::shipped_machines()) names.push_back(one.name);
  const std::string near = nearest_name(written, names);
  root.error("unknown-machine", "machine", fmt::format("no machine is called '{}'", written),
             (near.empty() ? "" : fmt::format("did you mean '{}'? ", near)) +
                 "a machine.toml, or a name that 'swarf machines' lists");
}

/// Of scenes with CL data.
void read_scene_post(ConfigTable& root, const ConfigTable& post, Scene& scene) {
  scene.post = read_post(post, scene.tools.size());
  if (!root.has("cl"))
    root.error("post-needs-cl", "post", "only CL data become an NC program, and the scene names none",
               "write cl = \"part.cls\", or take [post] out");
  for (size_t i = 0; i < scene.post->extended_mm.size() && i < scene.tools.size(); ++i) {
    scene.tools[i].length_mm += scene.post->extended_mm[i];
    if (scene.tools[i].gauge_length_mm) *scene.tools[i].gauge_length_mm += scene.post->extended_mm[i];
  }
}

/// What the set-ups before this one have left.
void begin_with_earlier(StockSettings& stock) {
  stock.raw = {};
  stock.raw.kind = RawKind::kSetups;
  stock.auto_box = false;
}

/// Paths that are planned have no text whose unit or TRACUT could be left open.
void refuse_program_keys(ConfigTable& table, const Scene& scene) {
  if (scene.kind == ProgramKind::kNc || scene.kind == ProgramKind::kCl) return;
  const auto refuse = [&](bool given, const char* key) {
    if (given)
      table.error("unused-key", key,
                  fmt::format("'setup.{}' says what an NC program or CL data leaves open", key),
                  "take it out: a planned path is in mm");
  };
  refuse(scene.setup.unit_mm.has_value(), "units");
  refuse(scene.setup.tracut.has_value(), "tracut");
}

/// `setup`: as load_scene's.
void read_scene(ConfigTable& root, Scene& scene, Diagnostics& diagnostics, int setup = 0) {
  const std::string& path = scene.file;
  scene.title = utf8_only(root.text("title", scene.name));
  std::optional<ConfigTable> post;
  if (root.has("post")) post = root.table("post");
  read_program(root, post, scene);
  read_machine(root, scene);
  read_scene_tools(root, scene, diagnostics);
  if (post) read_scene_post(root, *post, scene);
  read_cl_keys(root, scene);
  ConfigTable setup_keys = root.table("setup");
  scene.setup = read_setup(setup_keys, scene.kind == ProgramKind::kNc, setup);
  scene.cl_options.tracut = scene.setup.tracut;
  scene.cl_options.unit_mm = scene.setup.unit_mm;
  refuse_program_keys(setup_keys, scene);
  if (setup > 0)
    scene.title += fmt::format(", set-up {}{}", setup,
                               scene.setup.name.empty() ? "" : ": " + utf8_only(scene.setup.name));
  const bool blocks =
      scene.kind != ProgramKind::kSurfaceBlocks && !scene.driven;  // they say nothing of stock
  scene.stock = read_stock(root.table("stock"), scene.tools, blocks, diagnostics);
  // As a CAM system would have written it.
  if (scene.driven && scene.driven->plan.cam_tolerance_mm > 0.0) scene.stock.cut_by = CutBy::kBlocks;
  if (setup > 1) begin_with_earlier(scene.stock);
  scene.fixtures = read_fixtures(root);
  for (machine::Fixture& fixture : scene.fixtures)
    if (std::string* const file = mesh_file_of(fixture)) *file = beside(path, *file);
  scene.stock.raw.file = beside(path, scene.stock.raw.file);
  const bool own_surfaces = scene.flank && scene.program_key == "program";
  const bool by_design = scene.driven && scene.driven->by_design;
  scene.design = read_design(root.table("design"), (blocks && !own_surfaces) || by_design);
  scene.design.surface_file = beside(path, scene.design.surface_file);
  scene.design.mesh_file = beside(path, scene.design.mesh_file);
  if (blocks) {
    read_block_interpolator(root.table("interpolator"), scene);
  } else if (scene.driven) {
    read_driven_interpolator(root.table("interpolator"), scene);
  } else {
    read_toolpath(root.table("toolpath"), scene);
    read_interpolator(root.table("interpolator"), scene);
  }
  read_accept(root.table("accept"), blocks || scene.driven, scene.accept);
  scene.contact_pairs = read_contact_pairs(root);
  read_pictures(root, scene);
  scene.output = read_output(root.table("output"));
  scene.report = read_report(root.table("report"));
  scene.report.logo_file = beside(path, scene.report.logo_file);
  root.finish();
  scene.toolpath.stock_top_mm = scene.stock.box_W.upper.z();
}

void refuse_several(const ConfigTable& root) {
  if (!root.is_list("setup")) return;
  ConfigTable(root).error(
      "several-set-ups", "setup", "the scene has several set-ups, and one is asked for here",
      "swarf run and swarf check take them all; each leaves a folder of its own, which stands "
      "for it");
}

}  // namespace

Scene load_scene(const std::string& path, const std::vector<std::string>& overrides, Diagnostics& diagnostics,
                 int setup) {
  Scene scene;
  scene.file = path;
  scene.name = utf8_only(fs::absolute(path).parent_path().filename().string());
  const ConfigOverlay overlay = setup_overlay(static_cast<size_t>(std::max(setup, 1)) - 1);
  ConfigTable root = ConfigTable::load(path, overrides, diagnostics, setup > 0 ? &overlay : nullptr);
  if (setup == 0) refuse_several(root);
  if (!diagnostics.has_errors()) read_scene(root, scene, diagnostics, setup);
  return scene;
}

Scene load_scene(const SceneText& text, const std::vector<std::string>& overrides, Diagnostics& diagnostics) {
  Scene scene;
  scene.file = text.name;
  scene.text = text.toml;
  ConfigTable root = ConfigTable::parse(text.toml, text.name, overrides, diagnostics);
  refuse_several(root);
  if (!diagnostics.has_errors()) read_scene(root, scene, diagnostics);
  scene.name = utf8_only(fs::path(scene.program_file).stem().string());
  return scene;
}
}  // namespace swarf::sim

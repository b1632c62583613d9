// The scene: one job as the user describes it in scene.toml, checked and with every default filled in.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/frames.h"
#include "cutter/cutter.h"
#include "machine/fixture.h"
#include "machine/machine_scene.h"
#include "mesh/tri_mesh.h"
#include "motion/interpolator.h"
#include "program/cl/program.h"
#include "program/nc_program.h"
#include "program/surface_blocks/program.h"
#include "sim/job/assumption.h"
#include "sim/job/contact_keys.h"
#include "sim/job/design_keys.h"
#include "sim/job/driven_keys.h"
#include "sim/job/flank_keys.h"
#include "sim/job/movie_keys.h"
#include "sim/job/post_keys.h"
#include "sim/job/report_keys.h"
#include "sim/job/setup_keys.h"
#include "sim/job/still_keys.h"
#include "sim/job/stock_keys.h"
#include "surface/face.h"
#include "surface/under_facets.h"
#include "toolpath/tool_path.h"

namespace swarf::sim {

/// What cuts stock and measuring rays.
enum class CutBy {
  kBlocks,  ///< the motions that the program's blocks ask for
  kCycles,  ///< the control's cycles of these blocks: with rounded corners, chords and dog-legs
  kPasses,  ///< the poses that the interpolator makes on planned passes: there are no blocks
};

struct StockSettings {
  Box box_W;  ///< mm; around the raw stock
  RawSettings raw;
  std::optional<stock::RawShape> shape;  ///< what raw means, once it is loaded; none: the box
  bool auto_box = false;                 ///< left open: the program's path gives it (open_job.h)
  double voxel_mm = 0.2;                 ///< smaller: finer solid, memory grows with the square
  bool auto_voxel = false;               ///< left open: box and tools give it
  SourceLocation voxel_where;
  double sweep_tolerance_mm = 1e-3;  ///< ticks are merged into sweeps that stay this close to them
  CutBy cut_by = CutBy::kBlocks;
  double max_memory_mb = 0.0;  ///< 0: 80 % of the memory that is free when the run starts

  stock::RawShape body_W() const { return shape ? *shape : stock::RawShape::of_box(box_W); }
};

/// Limits of the surface that are not given do not count; scenes of surface blocks have 10.5 and 1 by
/// default. The counts hold for every job: above 0 only where the scene writes so.
/// Of a gouge, and of leftover material, where [accept] has no limit of them, um: no finish and no facets are
/// so coarse.
inline constexpr double kGougeAllowed = 100.0, kExcessAllowed = 100.0;

struct AcceptLimits {
  std::optional<double> scallop_max_um;
  std::optional<double> gouge_max_um;
  std::optional<double> excess_max_um;  ///< material anywhere above the design, ridges included
  int collisions = 0;                   ///< of neck, shank and holder with the stock
  int rapids_in_material = 0;           ///< rapid moves that remove material
  int spindle_wrong = 0;                ///< cuts with the spindle stopped or turning the wrong way
  int machine_parts = 0;                ///< contacts of links, fixtures and tools with each other
  int travel = 0;                       ///< moves beyond the travel of an axis, or out of the machine's reach
  int axis_speed = 0;                   ///< moves faster than an axis

  /// Band of the share within tolerance and of the colour scale where the scene gives no limit, um.
  double scallop_band_um() const { return scallop_max_um.value_or(10.0); }
  double gouge_band_um() const { return gouge_max_um.value_or(1.0); }
};

/// Whether each control cycle is written, and how (sim/run/recorder.h).
enum class TrajectoryFormat { kNone, kCsv, kH5 };

/// What a run writes besides what it always does.
struct OutputSettings {
  TrajectoryFormat trajectory = TrajectoryFormat::kNone;
};

/// What the scene's program is. Only sim/job asks (tests/lint/rooms.py); what follows from it is data:
/// cut_by, Job::program and Job::cl, JobPath::nc, and whether a path holds blocks or passes.
enum class ProgramKind {
  kSurfaceBlocks,  ///< `program`: surfaces and areas; the tool path is planned
  kCl,             ///< `cl`: CL data
  kNc,             ///< `nc`: a part program as a control reads it
  kDriven,         ///< [driven]: the part's own surface
  kFlank,          ///< [flank]: a ruled design, milled by the flank; or a `program` of G06.5
};

struct Scene {
  std::string file;  ///< scene.toml
  std::string text;  ///< of a scene that stands in no file (SceneText); else ""
  std::string name;  ///< of its folder
  std::string title;
  std::string machine_file;
  bool machine_assumed = false;  ///< the scene names none
  bool tools_in_words = false;   ///< `tools` (tool_words.h)
  Assumptions assumptions;       ///< what it leaves open, and what is taken for it
  std::string program_file;
  std::string program_key = "program";  ///< that names it in scene.toml: program, cl or nc
  ProgramKind kind = ProgramKind::kSurfaceBlocks;
  toolpath::BlockLaw block_law = toolpath::BlockLaw::kTcp;  ///< CL: interpolator.mode
  program::ClOptions cl_options;            ///< CL: cutcom, cl_circle, and the radii of `tools`
  double linearise_tolerance_mm = 0.01;     ///< of the pieces that blocks near the pole would need (joint)
  std::optional<program::Dialect> dialect;  ///< NC; none: recognised from the text
  program::KinematicsSwitch kinematics_switch;  ///< NC, LinuxCNC's M428 to M430
  program::BuilderWords builder_words;          ///< NC
  program::Presets presets;                     ///< NC, `parameters`
  SetupSettings setup;
  std::optional<DrivenSettings> driven;  ///< of ProgramKind::kDriven
  std::optional<FlankSettings> flank;    ///< of ProgramKind::kFlank
  std::optional<PostSettings> post;      ///< CL: the program that is written for the machine is what runs
  std::string tool_table_file;           ///< `tool_table`; "": none
  std::map<int, std::string>
      incomplete_tools;  ///< of the .tbl: number, place and reason; told where one is called
  /// What BlockMove::tool and ToolSample::tool count in. Surface blocks: one.
  std::vector<cutter::Cutter> tools{cutter::Cutter{}};
  StockSettings stock;
  std::vector<machine::Fixture> fixtures;  ///< what holds it; links of Job::machine once it is loaded
  std::vector<ContactPair> contact_pairs;
  DesignSettings design;
  toolpath::PlanOptions toolpath;
  bool compare_planners = true;              ///< plan, interpolate and measure the other planners too
  std::optional<double> chord_tolerance_mm;  ///< replaces the program's K
  motion::MotionOptions motion;
  AcceptLimits accept;
  MovieSettings movie;
  StillSettings stills;
  OutputSettings output;
  ReportSettings report;
};

struct Job;

/// A set-up that the part has been through before this one.
struct EarlierSetup {
  std::shared_ptr<const Job> job;
  Pose X_WE;               ///< from its work frame to this one's
  std::string stock_file;  ///< that its run has left, where stock.from_run names it; else ""
  bool other_run = false;  ///< it stands in the scene of that run or of one before it, not in this one
};

/// One tool that a flank job might have taken.
struct FlankTool {
  std::string name;
  std::string refused;      ///< why not; "": it can mill the design
  flank::WorstError worst;  ///< of all surfaces, in the deepest passes
  bool used = false;
};

/// How the passes of a flank job were moved to keep off the fixtures (flank_clearance.h), mm.
struct FlankClearance {
  double asked_mm = 0.0;
  double before_mm = 0.0;    ///< least gap without a move, proven; at most what was asked
  std::string before_parts;  ///< between which; "": nothing came nearer
  double slide_mm = 0.0, lift_low_mm = 0.0, lift_high_mm = 0.0;
};

/// Everything that a run needs, loaded and checked; nothing has been written yet.
/// The design as a closed mesh that the proof of the part takes for it.
struct ProofFacets {
  std::shared_ptr<const TriMesh> mesh;  ///< null: the design is no body, or too large for so fine facets
  double chord_mm = 0.0;                ///< the design's faces lie no farther from the facets; 0: they are it
};

struct Job {
  Scene scene;
  machine::MachineScene machine;
  program::Program program;                            ///< of surface blocks; empty for other jobs
  std::optional<program::ClProgram> cl;                ///< of CL jobs
  std::shared_ptr<const toolpath::DrivenPart> driven;  ///< of a part driven by its surface: what drives it
  /// Of flank jobs: for each surface of the design, or each G06.5, its passes in depth.
  std::vector<flank::FlankPass> flank;
  double flank_seconds = 0.0;  ///< that planning them took
  std::optional<FlankClearance> flank_clearance;
  std::vector<FlankTool> flank_tools;  ///< of flank.tool = "best": the scene's tools in their order
  std::vector<surface::SurfacePtr>
      design;  ///< what the part is measured against; may be empty for jobs of blocks
  std::vector<surface::Face>
      driven_faces;  ///< of the CAD file that drives; its design_mesh are facets of them
  std::shared_ptr<const TriMesh> design_mesh;  ///< or a closed mesh with normals; null without one
  surface::UnderFacetsPtr design_under;        ///< of a CAD file: the faces over the facets of that mesh
  ProofFacets proof;                           ///< the same body as the proof takes it

  /// In the order in which they cut; the stock begins with what they have left of the body in Scene::stock.
  std::vector<EarlierSetup> earlier;

  bool has_design() const { return !design.empty() || design_mesh != nullptr; }
  std::vector<Diagnostic> warnings;
};

/// A scene that stands in no file; messages call it `name`, its paths are those of the current folder.
struct SceneText {
  std::string toml, name;
};

/// Reads scene.toml; `overrides` are "key=value" in TOML. Paths in it are relative to its folder.
/// Problems go to `diagnostics`.
/// `setup`: which of several [[setup]], from 1 on; 0: the scene has one ("several-set-ups" where it has
/// more).
Scene load_scene(const std::string& path, const std::vector<std::string>& overrides, Diagnostics& diagnostics,
                 int setup = 0);
Scene load_scene(const SceneText& text, const std::vector<std::string>& overrides, Diagnostics& diagnostics);

/// Scene::tools by ClProgram::tools; -1: the scene lacks it.
std::vector<int> cl_tools(const Job& job);

/// The machine with each tool of the scene in its spindle.
std::vector<kinematics::MachineModel> machines_by_tool(const Job& job);

/// Loads scene, machine, program and design and checks them against each other (tool numbers, CUTTER words,
/// memory, chord tolerance). What the scene leaves open is filled in (open_job.h). Throws InputError with
/// everything that is wrong.
Job load_job(const std::string& path, const std::vector<std::string>& overrides);
Job load_job(const SceneText& text, const std::vector<std::string>& overrides);

/// How many [[setup]] the scene has; 0: it is of one. Throws InputError with what is wrong with the list:
/// "no-set-ups", "two-stocks", "whose-frame".
size_t count_setups(const std::string& path, const std::vector<std::string>& overrides);
/// The first of them in order, one for each list of overrides. Those that begin with "setup[1]." are of the
/// second table as the file has it; any other replaces the key in the set-up that it is given for.
std::vector<std::shared_ptr<const Job>> load_setups(const std::string& path,
                                                    const std::vector<std::vector<std::string>>& overrides);

}  // namespace swarf::sim

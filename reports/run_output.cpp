#include "reports/run_output.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "reports/part_view.h"
#include "reports/pending_folder.h"
#include "reports/pictures.h"
#include "reports/report_writer.h"
#include "reports/run_report.h"
#include "sim/design_rays.h"
#include "sim/recorder.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 3> kProgramKeys{"program", "cl", "nc"};  // order of ProgramKind
constexpr double kPartGlbError = 2e-3;  // mm; a fifth of a usual scallop, far below a pixel

/// Copies of the inputs, so that the folder can be rendered and exported on its own.
void keep_inputs(const PendingFolder& folder, const sim::Job& job, const OutputOptions& options) {
  const fs::path input = folder.file("input");
  fs::create_directories(input);
  fs::copy_file(job.scene.file, input / "scene.toml");
  const std::string program =
      "program" + (job.scene.has_blocks() ? fs::path(job.scene.program_file).extension().string() : ".nc");
  fs::copy_file(job.scene.program_file, input / program);
  fs::copy(fs::path(job.scene.machine_file).parent_path(), input / "machine", fs::copy_options::recursive);
  std::vector<std::string> overrides = options.overrides;
  overrides.push_back(
      fmt::format("machine=\"machine/{}\"", fs::path(job.scene.machine_file).filename().string()));
  overrides.push_back(
      fmt::format("{}=\"{}\"", kProgramKeys.at(static_cast<size_t>(job.scene.kind)), program));
  if (!job.scene.tool_table_file.empty()) {
    const std::string table = "tools" + fs::path(job.scene.tool_table_file).extension().string();
    fs::copy_file(job.scene.tool_table_file, input / table);
    overrides.push_back(fmt::format("tool_table=\"{}\"", table));
  }
  if (job.scene.design.kind == sim::DesignKind::kSurface) {
    fs::copy_file(job.scene.design.surface_file, input / "design.nc");
    overrides.push_back("design.surface=\"design.nc\"");
  }
  if (job.scene.design.kind == sim::DesignKind::kMesh) {
    const std::string mesh = "design" + fs::path(job.scene.design.mesh_file).extension().string();
    fs::copy_file(job.scene.design.mesh_file, input / mesh);
    overrides.push_back(fmt::format("design.mesh=\"{}\"", mesh));
  }
  const nlohmann::ordered_json manifest{{"swarf", SWARF_VERSION},
                                        {"scene", job.scene.name},
                                        {"program", fs::path(job.scene.program_file).filename()},
                                        {"overrides", overrides}};
  write_text(folder.file("run.json"), manifest.dump(2) + "\n");
}

void write_pictures(const PendingFolder& folder, const FinishedRun& run, const TriMesh& part,
                    Progress& progress, RunFiles& files, RenderStatistics& statistics) {
  struct Picture {
    StillKind kind;
    const char* file;
    const char* camera;
    const char* caption;
  };
  std::vector<Picture> pictures{
      {StillKind::kMachine, "still_machine.png", "machine", "The machine near the middle of the program."},
      {StillKind::kPart, "still_part.png", "iso",
       run.job.scene.has_blocks()
           ? "The finished part."
           : "The finished part: strip lights break at each ridge, so every band is one pass."},
      {StillKind::kFan, "still_fan.png", "iso", "Paths and tool axes (Lin & Koren, Fig. 13)."}};
  if (!run.dexels.empty()) {
    pictures.insert(pictures.begin() + 2, {StillKind::kDeviation, "still_deviation.png", "iso",
                                           "Deviation from the design, from the measuring rays."});
  }
  progress.begin("stills", static_cast<double>(pictures.size()), "pictures");
  for (const Picture& picture : pictures) {
    if (progress.stop_requested()) break;
    make_still(run, part, picture.kind, picture.camera, folder.file(picture.file));
    files.stills.push_back({folder.file(picture.file), picture.caption});
    progress.advance(static_cast<double>(files.stills.size()));
  }
  progress.end();
  if (run.job.scene.movie.seconds <= 0.0 || progress.stop_requested()) return;
  statistics = make_movie(run, folder.file("movie.mp4"), "machine", progress);
  if (statistics.frames > 0) files.movie = folder.file("movie.mp4");
}

}  // namespace

void write_run(PendingFolder& folder, const sim::Job& job, sim::Result& result, const OutputOptions& options,
               Progress& progress) {
  keep_inputs(folder, job, options);
  progress.begin("write results", 3, "files");
  sim::write_trajectory(folder.file("trajectory.csv"), result.main.motion.trajectory, result.main.path, job);
  progress.advance(1);
  result.stock->save(folder.file("stock.vdb"), result.cut.metadata);
  progress.advance(2);
  for (size_t i = 0; i < result.main.dexels.size(); ++i) {
    result.main.dexels[i].save(folder.file(fmt::format("surface_{}.rays", i)));
  }
  progress.end();
  if (result.stopped) {
    folder.move_into_place();
    return;
  }

  const FinishedRun run{job, result.main.motion.trajectory, *result.stock, result.main.dexels};
  RunFiles files;
  RenderStatistics statistics;
  progress.begin("glTF", 3, "files");
  const TriMesh closed = run.stock.mesh();
  progress.advance(1);
  const DisplayMesh light = display_mesh(run, closed, kPartGlbError);
  files.part_error_mm = light.error_mm;
  write_part_glb(run, light, folder.file("part.glb"));
  files.part_glb = folder.file("part.glb");
  progress.advance(2);
  write_machine_glb(run, light, folder.file("machine.glb"));
  files.machine_glb = folder.file("machine.glb");
  files.animation_scale = animation_scale(run);
  progress.end();
  if (options.render) write_pictures(folder, run, shown_part(run, closed), progress, files, statistics);
  result.stopped = progress.stop_requested();
  progress.begin("report", 1, "files");
  write_report(folder.file("report.html"), report_data(job, result, files, options.render));
  write_text(folder.file("metrics.json"), metrics_json(job, result, statistics));
  write_text(folder.file("findings.json"), findings_json(result));
  progress.end();
  folder.move_into_place();
}

StoredRun read_run(const std::string& folder) {
  const fs::path root(folder);
  std::ifstream manifest(root / "run.json");
  if (!manifest) {
    throw InputError("not-a-run", {folder}, "there is no run.json: this is not the folder of a finished run",
                     "name the folder that 'swarf run ... -o DIR' wrote");
  }
  const auto json = nlohmann::json::parse(manifest, nullptr, false);
  if (json.is_discarded() || !json.contains("overrides")) {
    throw InputError("not-a-run", {(root / "run.json").string()}, "this file is broken",
                     "run the scene again");
  }
  sim::Job job = sim::load_job((root / "input" / "scene.toml").string(),
                               json.at("overrides").get<std::vector<std::string>>());
  job.scene.name = json.value("scene", job.scene.name);
  motion::Trajectory trajectory = sim::read_trajectory((root / "trajectory.csv").string(), job);
  StoredRun run{std::move(job), std::move(trajectory), stock::Stock::load((root / "stock.vdb").string()), {}};
  const std::vector<stock::RayFieldPtr> fields = sim::design_rays(run.job);
  for (size_t i = 0; i < fields.size(); ++i) {
    const fs::path rays = root / fmt::format("surface_{}.rays", i);
    if (!fs::exists(rays)) break;  // a run that was stopped before it was measured
    run.dexels.push_back(stock::SurfaceDexels::load(rays.string(), fields[i]));
  }
  return run;
}

}  // namespace swarf::reports

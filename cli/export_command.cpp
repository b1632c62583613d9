#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>

#include "base/file.h"
#include "base/units.h"
#include "brep/write_step.h"
#include "cli/commands.h"
#include "cli/number_flags.h"
#include "cli/terminal.h"
#include "cli/window_options.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "render/figures/colour.h"
#include "reports/part_view.h"
#include "reports/pending_folder.h"
#include "reports/pictures.h"
#include "reports/review_findings.h"
#include "reports/review_models.h"
#include "reports/run_output.h"
#include "sim/run/measured_mesh.h"
#include "sim/run/ray_cutters.h"
#include "sim/run/recorder.h"

namespace swarf::cli {
namespace {

/// CAD systems take minutes for what a viewer shows at once.
constexpr double kGltfErrorUm = 2.0, kStepErrorUm = 10.0;

struct ExportOptions {
  std::string folder, gltf, machine_gltf, stl, obj, threemf, step, ply, vdb, trajectory;
  sim::WindowPlaces window;
  std::optional<double> error_um;  ///< of decimation
  render::GltfEncoding encoding = render::GltfEncoding::kFloat;
  bool needs_stock() const { return !(gltf + machine_gltf + stl + obj + threemf + step + ply + vdb).empty(); }
};

void check_options(const ExportOptions& options) {
  if (!options.needs_stock() && options.trajectory.empty()) {
    throw InputError("nothing-to-do", {"swarf export"}, "no format was given",
                     "write for example: swarf export DIR --stl part.stl");
  }
  if (options.window.any() && (options.trajectory + options.machine_gltf + options.gltf).empty()) {
    throw InputError("no-motion-asked", {"swarf export"},
                     "--from and --to are for motions: the finished part has none",
                     "write for example: swarf export DIR --trajectory part.csv --from 60 --to 62");
  }
  for (const std::string& file :
       {options.gltf, options.machine_gltf, options.stl, options.obj, options.threemf, options.step,
        options.ply, options.vdb, options.trajectory})
    reports::check_output_file(file);
  if (!options.trajectory.empty()) sim::check_cycle_table_name(options.trajectory);
}

void write_trajectory(const ExportOptions& options, const sim::Job& job, const motion::Cycles& cycles) {
  const sim::CycleWindow window = sim::window_of(options.window, cycles);
  sim::write_cycle_window(options.trajectory, job, cycles, window);
  fmt::print("{}: {} cycles from {:.3f} to {:.3f} s, {:g} ms each\n", options.trajectory, window.size(),
             static_cast<double>(window.first) * cycles.period_s(),
             static_cast<double>(window.end - 1) * cycles.period_s(), cycles.period_s() * 1e3);
}

void write_gltf(const ExportOptions& options, const reports::FinishedRun& run) {
  reports::ReviewModels models =
      reports::review_models(run, run.stock.mesh(), options.error_um.value_or(kGltfErrorUm) * kMicrometre,
                             reports::review_pins(reports::read_findings(options.folder)));
  reports::show_worst(run, reports::kept_worst_places(options.folder), models);
  const reports::GltfOptions written{options.encoding, true};
  const auto write = [](const std::string& path, const std::string& bytes) {
    replace_file(path, bytes, {"cannot-write-file", "the glTF file cannot be written"});
  };
  if (!options.gltf.empty()) write(options.gltf, reports::part_glb(run, models, written));
  if (!options.machine_gltf.empty()) write(options.machine_gltf, reports::machine_glb(run, models, written));
  fmt::print("glTF: finished part decimated within {:.3f} um\n", um_from_mm(models.part.error_mm));
}

void write_step(const ExportOptions& options, const reports::FinishedRun& run) {
  double error_mm = 0.0;
  const TriMesh part =
      mesh::decimate(run.stock.mesh(), options.error_um.value_or(kStepErrorUm) * kMicrometre, &error_mm);
  brep::write_step(options.step, part, run.job.scene.name);
  fmt::print("{}: {} plane triangles, decimated within {:.3f} um, mm\n", options.step, part.triangles.size(),
             um_from_mm(error_mm));
}

void write_meshes(const ExportOptions& options, const reports::FinishedRun& run) {
  for (const std::string& file : {options.stl, options.obj, options.threemf}) {
    if (file.empty()) continue;
    const TriMesh part = run.stock.mesh();
    mesh::save_mesh(file, part);
    fmt::print("{}: {} triangles, mm\n", file, part.triangles.size());
  }
  if (!options.step.empty()) write_step(options, run);
  if (!options.ply.empty()) {
    TriMesh coloured = reports::part_mesh(run);
    render::colour_by_deviation(coloured, reports::deviation_scale(run.job, run.dexels));
    mesh::save_mesh(options.ply, coloured);
    fmt::print("{}: {} triangles with deviation in um, mm\n", options.ply, coloured.triangles.size());
  }
  if (!options.vdb.empty()) {
    run.stock.save(options.vdb, {{"scene", run.job.scene.name}, {"swarf", SWARF_VERSION}});
    fmt::print("{}: level set, {:g} mm voxels\n", options.vdb, run.stock.voxel_mm());
  }
}

int export_run(const ExportOptions& options) {
  check_options(options);
  print_diagnostics(reports::remarks_on_run(options.folder));
  TerminalProgress progress;
  if (!options.needs_stock()) {  // reading the stock would take longer than the cycles
    const sim::Job job = reports::read_job(options.folder, {});
    write_trajectory(options, job, *reports::window_motion(job, options.folder, progress).cycles);
    return kPass;
  }
  const reports::StoredRun stored = reports::read_run(options.folder);
  const bool coloured = !options.gltf.empty() || !options.ply.empty();
  const bool sweeps =
      coloured && sim::colours_need_sweeps(stored.job, stored.dexels, stored.stock.voxel_mm());
  const bool moves = !options.gltf.empty() || !options.machine_gltf.empty() || !options.trajectory.empty() ||
                     (coloured && sim::normals_need_cycles(stored.job)) || sweeps;
  const sim::MeasuredPath path = options.window.any()
                                     ? reports::window_motion(stored.job, options.folder, progress)
                                     : reports::motion_of(stored, options.folder, moves, progress);
  const sim::Job shown = sim::with_worn(stored.job, stored.worn);
  reports::FinishedRun run{shown, *path.cycles, stored.stock, stored.dexels, *path.carried};
  sim::JobSweeps rays;
  if (sweeps) rays = sim::all_ray_sweeps(stored.job, *path.cycles, *path.carried);
  run.rays = &rays;
  if (options.window.any()) run.window = sim::window_of(options.window, *path.cycles);
  if (!options.gltf.empty() || !options.machine_gltf.empty()) write_gltf(options, run);
  write_meshes(options, run);
  if (!options.trajectory.empty()) write_trajectory(options, stored.job, *path.cycles);
  return kPass;
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export", "Write meshes of a finished run, without simulating again");
  command->add_option("folder", options->folder, "folder of a finished run")->required();
  command->add_option("--gltf", options->gltf,
                      "finished part with deviation colours and tool-axis fan (.glb)");
  command->add_option(
      "--machine-gltf", options->machine_gltf,
      "animated machine (.glb): between two keys an axis moves in a straight line, which no cycle is "
      "farther from than 0.02 mm or 0.0136 deg; more where an axis would have over 32768 keys: "
      "asset.extras says how far, for each axis (key_error_max_X_mm)");
  command->add_option("--stl", options->stl, "finished part (.stl, mm)");
  command->add_option("--obj", options->obj, "finished part (.obj, mm)");
  command->add_option("--3mf", options->threemf, "finished part (.3mf, mm)");
  command->add_option("--step", options->step,
                      "finished part as a solid of plane triangles, decimated (.step, AP214, mm)");
  command->add_option("--ply", options->ply, "finished part with deviation (.ply, mm)");
  command->add_option("--vdb", options->vdb, "finished stock as a level set (.vdb)");
  command->add_option("--trajectory", options->trajectory,
                      "each control cycle as a row of a table (.csv or .h5); exactly those of the run");
  add_window_options(*command, options->window, "--trajectory, --machine-gltf and the fan of --gltf");
  command
      ->add_option("--error-um", options->error_um,
                   "largest error of the decimation (default: 2 for --gltf, 10 for --step)")
      ->check(positive());
  static const std::map<std::string, render::GltfEncoding> kEncodings{
      {"float", render::GltfEncoding::kFloat},
      {"quantized", render::GltfEncoding::kQuantised},
      {"meshopt", render::GltfEncoding::kMeshopt}};
  command
      ->add_option(
          "--encoding", options->encoding,
          "of --gltf and --machine-gltf: float, which every reader knows; quantized, positions in 16 "
          "bits (KHR_mesh_quantization; asset.extras says within how many um); meshopt, the same "
          "compressed (EXT_meshopt_compression: three.js, not Blender)")
      ->transform(CLI::CheckedTransformer(kEncodings, CLI::ignore_case))
      ->option_text("float|quantized|meshopt [float]");
  command->footer(R"(Examples:
  swarf export out/dome --stl part.stl
  swarf export out/dome --gltf small.glb --encoding meshopt
  swarf export out/dome --trajectory cycles.csv --from 12.5 --to 13)");
  command->callback([options, &exit_code] { exit_code = export_run(*options); });
}

}  // namespace swarf::cli

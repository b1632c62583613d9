#include <fmt/format.h>

#include <memory>

#include "base/units.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "render/figures/colour.h"
#include "reports/part_view.h"
#include "reports/pending_folder.h"
#include "reports/pictures.h"
#include "reports/run_output.h"

namespace swarf::cli {
namespace {

struct ExportOptions {
  std::string folder, gltf, machine_gltf, stl, ply, vdb;
  double error_um = 2.0;
};

int export_run(const ExportOptions& options) {
  if (options.gltf.empty() && options.machine_gltf.empty() && options.stl.empty() && options.ply.empty() &&
      options.vdb.empty()) {
    throw InputError("nothing-to-do", {"swarf export"}, "no format was given",
                     "write for example: swarf export DIR --stl part.stl");
  }
  for (const std::string& file : {options.gltf, options.machine_gltf, options.stl, options.ply, options.vdb})
    reports::check_output_file(file);
  TerminalProgress progress;
  const reports::StoredRun stored = reports::read_run(options.folder);
  const bool coloured = !options.gltf.empty() || !options.ply.empty();
  const bool moves =
      !options.gltf.empty() || !options.machine_gltf.empty() || (coloured && !stored.job.scene.has_blocks());
  const sim::MeasuredPath path = reports::motion_of(stored, options.folder, moves, progress);
  const reports::FinishedRun run{stored.job, *path.cycles, stored.stock, stored.dexels};
  if (!options.gltf.empty() || !options.machine_gltf.empty()) {
    const reports::DisplayMesh light =
        reports::display_mesh(run, stored.stock.mesh(), options.error_um * kMicrometre);
    if (!options.gltf.empty()) reports::write_part_glb(run, light, options.gltf);
    if (!options.machine_gltf.empty()) reports::write_machine_glb(run, light, options.machine_gltf);
    fmt::print("glTF: finished part decimated within {:.3f} um\n", um_from_mm(light.error_mm));
  }
  if (!options.stl.empty()) {
    const TriMesh part = stored.stock.mesh();
    mesh::save_mesh(options.stl, part);
    fmt::print("{}: {} triangles, mm\n", options.stl, part.triangles.size());
  }
  if (!options.ply.empty()) {
    TriMesh coloured = reports::part_mesh(run);
    render::colour_by_deviation(coloured, reports::deviation_scale(stored.job));
    mesh::save_mesh(options.ply, coloured);
    fmt::print("{}: {} triangles with deviation in um, mm\n", options.ply, coloured.triangles.size());
  }
  if (!options.vdb.empty()) {
    stored.stock.save(options.vdb, {{"scene", stored.job.scene.name}, {"swarf", SWARF_VERSION}});
    fmt::print("{}: level set, {:g} mm voxels\n", options.vdb, stored.stock.voxel_mm());
  }
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
  command->add_option("--machine-gltf", options->machine_gltf, "animated machine (.glb)");
  command->add_option("--stl", options->stl, "finished part (.stl, mm)");
  command->add_option("--ply", options->ply, "finished part with deviation (.ply, mm)");
  command->add_option("--vdb", options->vdb, "finished stock as a level set (.vdb)");
  command->add_option("--error-um", options->error_um, "largest error of the decimation for --gltf")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->callback([options, &exit_code] { exit_code = export_run(*options); });
}

}  // namespace swarf::cli

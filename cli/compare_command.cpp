#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "cli/commands.h"
#include "cli/compare_runs.h"
#include "cli/terminal.h"
#include "measure/mesh_deviation.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "reports/compare_output.h"
#include "reports/pending_folder.h"
#include "sim/scene.h"
#include "stock/stock.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::string stock, design, output;
  double reach_mm = 1.0, scallop_um = 10.0, gouge_um = 1.0, pitch_mm = 0.5, edge_mm = -1.0, rays_um = 0.2;
  bool json = false;
};

constexpr double kSmooth = kPi;  // rad: no creases, so that each vertex has one normal

std::string extension(const std::string& file) {
  return fs::path(file).extension().string();
}

/// Half a voxel is what the mesh of a level set takes off a sharp edge, on either side; twice that for
/// safety.
constexpr double kRoundedVoxels = 1.0;

/// The stock as a mesh; fills in the margin of the edges that its grid has rounded.
TriMesh load_stock(const std::string& file, double& edge_mm) {
  if (extension(file) == ".vdb") {
    const stock::Stock stock = stock::Stock::load(file);
    if (edge_mm < 0.0) edge_mm = kRoundedVoxels * stock.voxel_mm();
    return stock.mesh();
  }
  edge_mm = std::max(edge_mm, 0.0);
  TriMesh mesh = mesh::load_mesh(file);
  if (mesh.normals.empty()) mesh::compute_vertex_normals(mesh, kSmooth);
  return mesh;
}

std::vector<surface::SurfacePtr> design_surfaces(const std::string& file) {
  std::vector<surface::SurfacePtr> surfaces;
  if (extension(file) == ".toml") {
    surfaces = sim::load_job(file, {}).design;
  } else {
    for (const program::SurfaceDefinition& definition : program::load_surfaces(file))
      surfaces.push_back(definition.surface);
  }
  if (surfaces.empty()) {
    throw InputError("no-design", {file}, "there is no design surface to compare with",
                     "name a scene with a [design], a program of surface blocks or a mesh");
  }
  return surfaces;
}

bool is_mesh(const std::string& file) {
  const std::string kind = extension(file);
  return kind == ".stl" || kind == ".ply" || kind == ".obj";
}

void measure_stock(const CompareOptions& options, TriMesh& stock) {
  if (is_mesh(options.design)) {
    TriMesh design = mesh::load_mesh(options.design);
    mesh::compute_vertex_normals(design, kSmooth);
    measure::deviation_from_mesh(stock, design, options.reach_mm);
    return;
  }
  const Box box = mesh::bounds(stock);
  for (const surface::SurfacePtr& surface : design_surfaces(options.design)) {
    measure::deviation_from_surface(stock, stock::SurfaceDexels(surface, options.pitch_mm, box),
                                    options.reach_mm, options.edge_mm);
  }
}

std::string json_text(const measure::DeviationSummary& s, bool holds) {
  return nlohmann::ordered_json{{"schema", 1},
                                {"verdict", holds ? "pass" : "findings"},
                                {"surface",
                                 {{"measured", s.measured},
                                  {"unmeasured", s.unmeasured},
                                  {"excess_max_um", s.excess_max_um},
                                  {"gouge_max_um", s.gouge_max_um},
                                  {"mean_abs_um", s.mean_abs_um},
                                  {"rms_um", s.rms_um},
                                  {"within_tolerance_pct", s.within_tolerance_pct}}}}
             .dump(2) +
         "\n";
}

void print_summary(const CompareOptions& options, const measure::DeviationSummary& s) {
  fmt::print("{} against {}\n", options.stock, options.design);
  print_table(
      {{"measured",
        fmt::format("{} vertices; {} have no foot on the design within {:g} mm or lie {:g} mm from its edge",
                    s.measured, s.unmeasured, options.reach_mm, std::max(options.edge_mm, 0.0))},
       {"excess", fmt::format("{:.2f} um highest", s.excess_max_um)},
       {"gouge", fmt::format("{:.2f} um deepest", s.gouge_max_um)},
       {"mean", fmt::format("{:.2f} um absolute, {:.2f} um rms", s.mean_abs_um, s.rms_um)},
       {"tolerance", fmt::format("{:.2f} % within -{:g} .. +{:g} um", s.within_tolerance_pct,
                                 options.gouge_um, options.scallop_um)}});
}

int compare(CompareOptions options) {
  if (fs::is_directory(options.stock) && fs::is_directory(options.design))
    return compare_runs(options.stock, options.design, options.rays_um, options.json);
  if (!options.output.empty()) reports::check_output_folder(options.output, reports::kCompareMark);
  TriMesh stock = load_stock(options.stock, options.edge_mm);
  measure_stock(options, stock);
  const measure::DeviationSummary summary =
      measure::summarise(stock, {options.scallop_um * kMicrometre, options.gouge_um * kMicrometre});
  if (summary.measured == 0) {
    throw InputError(
        "nothing-measured", {options.stock},
        fmt::format("no vertex of the stock lies within {:g} mm of the design", options.reach_mm),
        "check that both are in the same frame and in mm, or raise --reach-mm");
  }
  const bool holds = summary.excess_max_um <= options.scallop_um && summary.gouge_max_um <= options.gouge_um;
  const std::string json = json_text(summary, holds);
  if (!options.output.empty()) {
    reports::write_compare(options.output, stock, std::max(options.scallop_um, options.gouge_um), json);
  }
  if (options.json) {
    fmt::print("{}", json);
  } else {
    print_summary(options, summary);
    fmt::print("  {}\n", holds ? "PASS" : "FINDINGS");
  }
  return holds ? kPass : kFindings;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare",
                                         "Compare a finished stock (vdb, stl, ply, obj) with a design, or "
                                         "two finished runs ray by ray");
  command->add_option("stock", options->stock, "stock.vdb of a run, or a mesh in mm; or the folder of a run")
      ->required();
  command
      ->add_option(
          "design", options->design,
          "a scene or program with surface blocks, or a closed mesh in mm; or the folder of another run "
          "with the same design")
      ->required();
  command->add_option("-o,--output", options->output,
                      "folder for deviation.ply, deviation.png and metrics.json");
  command->add_option("--reach-mm", options->reach_mm, "measure what lies so near to the design")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--rays-um", options->rays_um, "allowed difference between the rays of two runs")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--scallop-um", options->scallop_um, "allowed excess")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--gouge-um", options->gouge_um, "allowed gouge")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--edge-mm", options->edge_mm,
                   "leave out what lies so near to the edge of a design surface (default: one voxel of a "
                   ".vdb, whose grid "
                   "rounds edges; 0 for meshes)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", options->json, "print JSON instead of the table");
  command->footer(
      "The vertices of the stock are measured, so the accuracy is that of its grid or mesh. The run itself\n"
      "measures with rays from the design, far below the voxel size: see surface in metrics.json.");
  command->callback([options, &exit_code] { exit_code = compare(*options); });
}

}  // namespace swarf::cli

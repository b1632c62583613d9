#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "base/units.h"
#include "cli/commands.h"
#include "cli/compare_align.h"
#include "cli/compare_inputs.h"
#include "cli/compare_runs.h"
#include "cli/compare_text.h"
#include "cli/number_flags.h"
#include "cli/shell_text.h"
#include "cli/terminal.h"
#include "mesh/mesh_ops.h"
#include "reports/compare_output.h"
#include "reports/pending_folder.h"
#include "reports/run_output.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::string stock, design, output;
  std::optional<double> excess_um, gouge_um, pitch_mm, edge_mm, reach_mm;
  double allowance_mm = 0.0, rays_um = 0.2;
  std::vector<std::string> pairs;
  bool json = false, best_fit = false;
};

constexpr double kExcessUm = 10.0, kGougeUm = 1.0;  // without a scene that says otherwise
/// Where no pitch is given: samples along the diagonal of the smaller of the two boxes, and over both
/// surfaces.
constexpr double kSamplesAcross = 250.0;
constexpr double kSamples = 100'000.0;
/// Needles need more, for the proof of long cells beside many others is slow: so many a facet and in all.
constexpr double kSamplesOfFacet = 10.0, kMostNeedleSamples = 400'000.0;
/// Over both surfaces, with a pitch that is given: some three gigabytes and a minute of processor time.
constexpr double kMostSamples = 2e7;
/// Facets of parametric surfaces, mm: curvature makes them smaller where it must.
constexpr double kPatchPitch = 0.5;

/// What the user gives, else the scene's [accept], else the defaults.
void set_limits(const CompareOptions& options, const ComparedDesign& design,
                measure::ComparisonInput& input) {
  std::optional<double> excess = options.excess_um, gouge = options.gouge_um;
  if (design.accept) {
    if (!excess)
      excess = design.accept->excess_max_um ? design.accept->excess_max_um : design.accept->scallop_max_um;
    if (!gouge) gouge = design.accept->gouge_max_um;
  }
  for (const auto& [limit, option] : {std::pair{excess, "--excess-um"}, {gouge, "--gouge-um"}}) {
    if (!limit || *limit > 0.0) continue;
    throw InputError("limit-of-zero", {option},
                     "a limit of 0 um cannot be proven: coordinates of meshes are rounded",
                     "give what the part may be off, such as 0.1");
  }
  input.excess = excess.value_or(kExcessUm) * kMicrometre;
  input.gouge = gouge.value_or(kGougeUm) * kMicrometre;
}

/// About how many cells of this pitch a surface needs; long thin facets need them along their length.
double cells_at(const mesh::SignedDistance& mesh, double pitch_mm) {
  double cells = 0.0;
  for (uint32_t t = 0; t < mesh.mesh().triangles.size(); ++t) {
    const measure::Corners corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    cells += measure::area_of(corners) / (pitch_mm * pitch_mm) + measure::radius_of(corners) / pitch_mm;
  }
  return cells;
}

double default_pitch(const mesh::SignedDistance& stock, const mesh::SignedDistance& design) {
  constexpr double kCoarser = 1.25;
  double pitch =
      std::min(mesh::bounds(stock.mesh()).size().norm(), mesh::bounds(design.mesh()).size().norm()) /
      kSamplesAcross;
  const auto allowed = [&](const mesh::SignedDistance& mesh) {
    const auto facets = static_cast<double>(mesh.mesh().triangles.size());
    return std::max({kSamples, facets, std::min(kSamplesOfFacet * facets, kMostNeedleSamples)});
  };
  while (cells_at(stock, pitch) > allowed(stock) || cells_at(design, pitch) > allowed(design))
    pitch *= kCoarser;
  return pitch;
}

/// The pitch that is asked for, unless its samples would fill the memory.
double given_pitch(double pitch_mm, const mesh::SignedDistance& stock, const mesh::SignedDistance& design) {
  const double cells = cells_at(stock, pitch_mm) + cells_at(design, pitch_mm);
  if (cells <= kMostSamples) return pitch_mm;
  throw InputError("pitch-too-fine", {"flags"},
                   fmt::format("--pitch-mm {:g} asks for {:.2g} samples, {:.2g} are the most", pitch_mm,
                               cells, kMostSamples),
                   fmt::format("leave it out, for cells are divided further where the limits ask for it, or "
                               "give one from about {:.2g} on",
                               pitch_mm * std::sqrt(cells / kMostSamples)));
}

measure::ComparisonInput comparison_of(const CompareOptions& options, const ComparedStock& stock,
                                       const ComparedDesign& design) {
  measure::ComparisonInput input;
  input.stock = stock.mesh.get();
  input.design = design.mesh.get();
  input.open_design = design.open;
  input.allowance = options.allowance_mm;
  set_limits(options, design, input);
  input.pitch = options.pitch_mm ? given_pitch(*options.pitch_mm, *stock.mesh, *design.mesh)
                                 : default_pitch(*stock.mesh, *design.mesh);
  input.design_error = design.error_mm;
  input.design_errors = design.errors;
  input.faces = design.faces.get();
  if (!design.grid) input.stock_error = stock.error;  // two grids are compared as they are
  input.stock_edge = stock.edge;
  input.edge = options.edge_mm.value_or(stock.voxel_mm);
  input.reach = options.reach_mm;
  return input;
}

void check_measured(const CompareOptions& options, const measure::PartComparison& result) {
  if (result.stock.area_mm2 + result.design.area_mm2 > 0.0) return;
  throw InputError("nothing-measured", {options.stock},
                   "nothing of stock and design lies within --reach-mm of the other",
                   "check that both are in the same frame and in mm, or raise --reach-mm");
}

/// Two closed meshes have no edge that a grid has rounded: the option would change nothing.
void require_use_of_edge(const CompareOptions& options, const ComparedStock& stock,
                         const ComparedDesign& design) {
  if (!options.edge_mm || stock.voxel_mm > 0.0 || design.open) return;
  throw InputError(
      "unused-option", {options.stock},
      "--edge-mm loosens edges that a grid has rounded, and here both are meshes as they are",
      "leave it out, or compare the run's stock.vdb; --gouge-um and --excess-um loosen all places");
}

std::vector<std::string> compare_words(const CompareOptions& options) {
  std::vector<std::string> words{"swarf", "compare", options.stock, options.design};
  const auto add = [&](const char* option, const std::optional<double>& value) {
    if (value) words.insert(words.end(), {option, fmt::format("{}", *value)});
  };
  add("--excess-um", options.excess_um);
  add("--gouge-um", options.gouge_um);
  add("--pitch-mm", options.pitch_mm);
  add("--edge-mm", options.edge_mm);
  add("--reach-mm", options.reach_mm);
  if (options.allowance_mm > 0.0) add("--allowance-mm", options.allowance_mm);
  for (const std::string& pair : options.pairs) words.insert(words.end(), {"--align", pair});
  if (options.best_fit) words.emplace_back("--best-fit");
  if (!options.output.empty()) words.insert(words.end(), {"-o", options.output});
  return words;
}

int compare_solids(const CompareOptions& options) {
  if (!options.output.empty()) reports::check_output_folder(options.output, reports::kCompareMark);
  // What a run has left: whether it came to its end.
  for (const std::string& file : {options.stock, options.design})
    if (file.ends_with(".vdb"))
      print_diagnostics(reports::remarks_on_run(fs::absolute(file).parent_path().string()));
  ComparedStock stock = load_stock(options.stock);
  const ComparedDesign design = load_design(options.design, kPatchPitch);
  const std::optional<measure::Alignment> aligned = align(options.pairs, options.best_fit, design, stock);
  check_boxes(stock, design, options.stock, options.design);
  require_use_of_edge(options, stock, design);
  const measure::ComparisonInput input = comparison_of(options, stock, design);
  const measure::PartComparison result = measure::compare_parts(input);
  check_measured(options, result);
  const ComparedPieces pieces = pieces_between(stock, design);
  const std::vector<sim::Check> checks = judge_comparison(input, result, pieces);
  const std::string json = comparison_json(stock, design, input, result, checks, aligned, pieces);
  reports::ComparedPair pair{options.stock, options.design,
                             design.grid,   "",
                             checks,        comparison_rows(stock, design, input, result, pieces)};
  if (aligned) pair.alignment = alignment_text(*aligned);
  pair.command = shell_text(compare_words(options));
  if (!options.output.empty())
    reports::write_compare(options.output, pair, input, result,
                           um_from_mm(std::max({input.excess, input.gouge, 1e-5})), json);
  if (options.json) {
    fmt::print("{}", json);
  } else {
    fmt::print("{} against {}\n", options.stock, options.design);
    if (aligned) print_table({{"alignment", pair.alignment}});
    print_table(pair.rows);
    for (const sim::Check& check : checks) {
      if (check.outcome != sim::Outcome::kHolds)
        fmt::print("  {}\n", check.reason.empty() ? check.what : check.reason);
    }
    fmt::print("  {}\n", sim::passes(checks) ? "PASS" : "FINDINGS");
  }
  return sim::passes(checks) ? kPass : kFindings;
}

int compare(const CompareOptions& options) {
  let_interrupts_end();
  if (fs::is_directory(options.stock) && fs::is_directory(options.design))
    return compare_runs(options.stock, options.design, options.rays_um, options.json);
  return compare_solids(options);
}

constexpr const char* kFooter =
    R"(What is measured
  Both surfaces, by area, each against the other: every point of the stock to the design (a boss too many,
  a pocket not cut) and every point of the design to the stock (a boss missing, a wall cut away). Positive
  is excess, material where the design has none; negative is gouge. Nothing is left out for being far away.

What PASS means
  Between the samples the deviation is bounded: a distance changes by no more than the way to the next
  sample, and over facets that face each other by what their corners are apart. Cells are divided until
  the bound meets the limit. PASS is given when the bound, errors of facets and grid included, meets it;
  "not proven below .." says how far the proof went where it does not.

Input
  Meshes must be closed, manifold, turned outward and free of crossings, in mm; anything else is refused.
  A scene's [accept] gives the limits (excess_max_um, else scallop_max_um; gouge_max_um). Parametric
  designs are open patches: what of the stock lies beyond them is not compared, and stated in mm2.
  A .vdb is as good as its grid: the error is added to the bound. At sharp edges, which a grid rounds, one
  voxel (--edge-mm) is put down to the grid; more counts wholly. The run itself measures far below the
  voxel size. A stock that is in more pieces than the design is a finding, with the place of the loose ones.
  Limits are above 0.

  Against an earlier .vdb what stands out was added and what is missing removed; the errors of the two
  grids are stated, not added.

Examples
  swarf compare new/stock.vdb old/stock.vdb -o changed
  swarf compare scanned.stl part.stp --best-fit -o out
  swarf compare reports/out/dome/stock.vdb scenes/lin_koren_dome/scene.toml
  swarf compare scanned.stl part.stl --excess-um 20 --gouge-um 20 -o out
  swarf compare roughed.stl part.stl --allowance-mm 0.3 --excess-um 100 --gouge-um 50
  swarf compare RUN_A RUN_B --rays-um 0.2

Exit code 0: pass, 1: findings, 2: the input cannot be compared.)";

void add_limits(CLI::App& command, CompareOptions& options) {
  command
      .add_option("--excess-um,--scallop-um", options.excess_um,
                  "allowed excess (default: the scene's [accept], else 10)")
      ->check(nonnegative());
  command.add_option("--gouge-um", options.gouge_um, "allowed gouge (default: the scene's [accept], else 1)")
      ->check(nonnegative());
  command
      .add_option("--allowance-mm", options.allowance_mm,
                  "stock left on purpose: the target is the design offset outward by so much")
      ->capture_default_str()
      ->check(nonnegative());
  command.add_option("--rays-um", options.rays_um, "allowed difference between the rays of two runs")
      ->capture_default_str()
      ->check(nonnegative());
}

void add_sampling(CLI::App& command, CompareOptions& options) {
  command
      .add_option("--pitch-mm", options.pitch_mm,
                  "every point lies so near to a sample, before the proof divides further (default: 1/250 of "
                  "the smaller diagonal, or some 100 000 samples a surface)")
      ->check(positive());
  command
      .add_option("--edge-mm", options.edge_mm,
                  "what a rounded edge may be off, and the width along the border of a parametric design "
                  "(default: one voxel of a .vdb, 0 for meshes)")
      ->check(nonnegative());
  command
      .add_option("--reach-mm", options.reach_mm,
                  "measure only what lies so near; what does not is a finding with its area (default: all)")
      ->check(positive());
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
          "a scene or program with surface blocks, a closed mesh in mm, a STEP or IGES file, or an earlier "
          "stock.vdb; or the folder of another run with the same design")
      ->required();
  command->add_option(
      "-o,--output", options->output,
      "folder for report.html, deviation.ply and .png, design.ply and .png, pictures of the worst "
      "places, and metrics.json");
  command
      ->add_option(
          "--align", options->pairs,
          "a point of the stock and the point of the design that it is to lie on, mm; three pairs or "
          "more move the stock (least squares)")
      ->type_name("X,Y,Z=X,Y,Z")
      ->expected(1)
      ->take_all();
  command->add_flag(
      "--best-fit", options->best_fit,
      "move the stock onto the design by least squares over its surface, after --align if it is "
      "given; the motion is stated");
  add_limits(*command, *options);
  add_sampling(*command, *options);
  command->add_flag("--json", options->json, "print JSON instead of the table");
  command->footer(kFooter);
  command->callback([options, &exit_code] { exit_code = compare(*options); });
}

}  // namespace swarf::cli

#include "sim/run/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "base/parallel.h"
#include "measure/certificate.h"
#include "motion/speed/jerk_profile.h"
#include "sim/job/memory_limit.h"
#include "sim/run/cut_sweeps.h"
#include "sim/run/picture_memory.h"
#include "sim/run/prove_part.h"
#include "sim/run/result.h"
#include "stock/rays/ray_field.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::sim {
namespace {

constexpr double kMegabyte = 1024.0 * 1024.0;

// What a run holds besides the stock, in bytes; peaks measured with tests/scenes/memory_test.cpp's scenes.
// Code, libraries (93 MB once they are loaded, OpenCASCADE's 20 among them), tables of the program, thread
// pools.
constexpr double kBase = 100.0 * kMegabyte;
constexpr double kMovie = 300.0 * kMegabyte;   // Mesa, Embree and the encoder, with pictures of 1280 x 720
constexpr double kStills = 200.0 * kMegabyte;  // Embree, cut faces and lettering, with pictures of that size
constexpr double kPage =
    105.0 * kMegabyte;  // glTF and the page alone: decimated meshes and what they are coded in
constexpr double kUsualPixels = 1280.0 * 720.0;
// Of a still: what its samples have seen (84), and the light as it is shared with neighbours (28).
constexpr double kStillPixel = 112.0;
// Of a movie: two renderers and the encoder's frames, with one sample; each further sample.
constexpr double kMoviePixel = 85.0, kMovieSample = 22.5;
// Of the movie's own stock, in that stock's bytes: its leaves, what the mesher keeps of each, and patches as
// they are made, thinned and sent to two renderers; and of the one that chips fly from.
constexpr double kMovieStock = 4.0, kChipsStock = 1.0;
// Of the stock: room that leaves which are gone leave between those that stay, and pairs of sweep and leaf.
constexpr double kHoles = 0.25;
constexpr double kSweep = sizeof(stock::Sweep) + sizeof(SweepSource);
// The same with its map: in the proof, and for the rays of what is shown of a CAD file or a mesh.
constexpr double kShownSweep = sizeof(stock::Sweep) + sizeof(stock::SweepMap);
constexpr double kCutting = sizeof(ToolPose) + 8.0;  // the poses of cycles to be merged; boxes of EarlierCuts
// A sweep of blocks, made when it is asked for; its vector grows by halves, and its share of a box.
constexpr double kSweepOfBlock = 1.5 * sizeof(SweepOfBlocks) + 1.5;
// Look-ahead: a cell with its share of curve, corner and plan, of at most so many that are held at once.
constexpr double kPlannedCell = 600.0, kCellsOfBlock = 2.0;
constexpr double kMeasuredRay = 78.0;  // while it is measured: neighbours, ridges, feet
constexpr double kRay = 83.0;          // point, normal, height, block; its share of a tile
// Of a mesh as the design: corners, sheets and their normals, Embree's tree and that of the free ranges.
constexpr double kDesignTriangle = 260.0;
// Each triangle of the mesh, half a vertex with it, from the mesher's points to the decimated copy.
constexpr double kTriangle = 105.0;
// The same once more in a still of the whole part, Embree's tree included; in colours with a copy of the
// mesh.
constexpr double kShownTriangle = 80.0, kColouredTriangle = 110.0;
// The same where links are held against it: its body with a tree of boxes, too.
constexpr double kBodyTriangle = 420.0;
// A tick of a path that is only compared: its sample, axes and sweep, and what vectors that grow hold beside.
constexpr double kComparedTick = 530.0;

/// Counts of a stock while and after it is cut.
struct SurfaceCounts {
  double leaves_most = 0.0, triangles = 0.0, bytes = 0.0;  ///< bytes: of the preview itself
};

constexpr double kCoarser = 4.0;
constexpr size_t kPieces = 32;           // looks at the number of leaves
constexpr size_t kPreviewMost = 20'000;  // sweeps: of more, every n-th shows the same shape

/// The sweeps of the preview: those of a long program overlap, so that not all are needed.
std::vector<stock::Sweep> thinned(const CutSweeps& sweeps) {
  std::vector<stock::Sweep> some;
  const size_t step = sweeps.size() / kPreviewMost + 1;
  for (size_t n = 0; n < sweeps.size(); n += step) some.push_back(sweeps[n]);
  return some;
}

/// `meshed`: the triangles are asked for.
SurfaceCounts preview(const Job& job, const motion::Cycles& cycles, const CarriedCuts& carried, bool meshed) {
  const StockSettings& settings = job.scene.stock;
  // Three voxels to the thinnest cutter's radius still show every groove.
  double thinnest = std::numeric_limits<double>::infinity();
  for (const cutter::Cutter& tool : job.scene.tools) thinnest = std::min(thinnest, tool.radius());
  const double voxel = std::max(settings.voxel_mm, std::min(kCoarser * settings.voxel_mm, thinnest / 3.0));
  const CutSweeps sweeps = cut_sweeps(job, cycles, voxel / 8.0);
  const std::vector<stock::Sweep> some = thinned(sweeps);
  stock::Stock stock = starting_stock(job, carried, voxel);
  const std::vector<stock::CutterSolid> solids = tool_solids(job.scene);
  double most = static_cast<double>(stock.leaves());
  size_t bytes = stock.memory_bytes();
  const size_t piece = some.size() / kPieces + 1;
  for (size_t i = 0; i < some.size(); i += piece) {
    for_each_tool(
        std::span(some).subspan(i, std::min(piece, some.size() - i)),
        [&](uint32_t block) { return sweeps.source_of(block).tool; },
        [&](size_t tool, std::span<const stock::Sweep> part) { stock.cut(part, solids[tool]); });
    most = std::max(most, static_cast<double>(stock.leaves()));
    bytes = std::max(bytes, stock.memory_bytes());
  }
  const double finer = std::pow(voxel / settings.voxel_mm, 2);
  return {most * finer, meshed ? static_cast<double>(stock.mesh().triangles.size()) * finer : 0.0,
          static_cast<double>(bytes)};
}

/// What is measured along rays, and proven between them.
struct RayCounts {
  double rays = 0.0, proof_bytes = 0.0;
};

/// Of the design. Surfaces: counted eight times as coarse, where the chord may stray 64 times as far.
/// Meshes: as they are made, because the turns and borders of the facets ask for rays too; the denser walls
/// beside them hold no material.
RayCounts ray_counts(const Job& job, const stock::RayFieldPtr& field) {
  constexpr double kCoarse = 8.0, kChord = 0.005;
  const double pitch = job.scene.design.pitch_mm;
  constexpr double kWall = 0.75;  // of a ray: point, normal, facet, its share of a tile
  RayCounts counts;
  if (field) {
    counts.rays = static_cast<double>(field->size()) + kWall * static_cast<double>(field->walls->size());
    counts.proof_bytes = measure::certify_bytes(*field);
  }
  for (const surface::SurfacePtr& surface : job.design) {
    const auto grid = stock::rays_on_surface(surface, kCoarse * pitch, kCoarse * kCoarse * kChord);
    counts.rays += kCoarse * static_cast<double>(grid->u_lines.size() - 1) * kCoarse *
                   static_cast<double>(grid->v_lines.size() - 1);
    counts.proof_bytes = std::max(counts.proof_bytes, measure::certify_bytes(*grid));
  }
  return counts;
}

/// Ticks of the longest path of the comparisons: the off-line one that stops at the end of each segment. The
/// sagitta of a few ticks of the main path gives the length of a segment within the chord tolerance there.
double longest_comparison(const Job& job, const MeasuredPath& path) {
  constexpr size_t kReach = 10;
  motion::CycleReader reader(*path.cycles);
  const motion::MotionOptions& options = job.scene.motion;
  double seconds = 0.0;
  motion::ToolSample a, b, c;
  for (size_t i = 0; i < path.cycles->size(); i += kReach) {
    a = b;
    b = c;
    c = reader.at(i).sample;
    if (i < 2 * kReach) continue;
    const auto* pass = path.path.elements.pass(static_cast<size_t>(b.element));
    const double chord = (c.contact_W - a.contact_W).norm();
    const double sagitta = (b.contact_W - 0.5 * (a.contact_W + c.contact_W)).norm();
    if (pass == nullptr || a.element != c.element || !(chord > 0.0)) {
      seconds += kReach * options.period_s;
      continue;
    }
    const double longest = chord * std::sqrt(pass->chord_tolerance_mm / std::max(sagitta, 1e-12));
    const double length = std::min(longest, 1e3);
    const motion::RestToRest segment(length, pass->feed_mm_s, options.path_acceleration_max,
                                     options.path_jerk_max);
    seconds += (c.contact_W - b.contact_W).norm() / length * segment.duration();
  }
  return seconds / options.period_s;
}

double pixels_of(const std::array<int, 2>& size) {
  return static_cast<double>(size[0]) * size[1];
}

double still_bytes(const StillSettings& stills) {
  if (!stills.any()) return kPage;
  return kStills + kStillPixel * std::max(0.0, pixels_of(stills.size) - kUsualPixels);
}

/// What each triangle of the part's mesh takes in the picture that takes most.
double still_triangle_bytes(const StillSettings& stills) {
  double most = 0.0;
  const auto count = [&](const std::string& kind) {
    if (kind != "machine") most = std::max(most, kind == "deviation" ? kColouredTriangle : kShownTriangle);
  };
  for (const std::string& kind : stills.kinds) count(kind);
  for (const StillShot& shot : stills.shots) count(shot.kind);
  return most;
}

double movie_bytes(const MovieSettings& movie) {
  if (movie.seconds <= 0.0) return 0.0;
  return kMovie + kMoviePixel * std::max(0.0, pixels_of(movie.size) - kUsualPixels) +
         kMovieSample * (movie.samples - 1) * pixels_of(movie.size);
}

/// Of the stocks that only a movie has. `leaves`: of the scene's stock.
double movie_stock_bytes(const Scene& scene, double leaves) {
  const MovieSettings& movie = scene.movie;
  if (movie.seconds <= 0.0) return 0.0;
  const double finer = scene.stock.voxel_mm / movie.voxel_mm;
  const bool chips =
      std::any_of(movie.shots.begin(), movie.shots.end(), [](const MovieShot& shot) { return shot.chips; });
  return (kMovieStock + (chips ? kChipsStock : 0.0)) *
         static_cast<double>(
             stock::Stock::memory_for(scene.stock.box_W, movie.voxel_mm, leaves * finer * finer));
}

/// What the pictures take beside the part's mesh. They are made one after the other.
double pictures_bytes(const Scene& scene, double triangles, double leaves) {
  return std::max(still_bytes(scene.stills) + triangles * still_triangle_bytes(scene.stills),
                  movie_bytes(scene.movie) + movie_stock_bytes(scene, leaves));
}

/// A number to two digits, not below it.
double rounded_up(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::ceil(value / digit) * digit;
}

/// A voxel, to two digits, at which what grows with 1/voxel^2 fits beside the rest.
double voxel_that_fits(const Job& job, const MemoryPrediction& prediction) {
  constexpr double kMargin = 1.1;  // the prediction itself wavers with the voxel
  const double rest = prediction.peak_mb - prediction.scaling_mb;
  const double room = std::max(prediction.limit_mb - rest, 0.05 * prediction.scaling_mb);
  const double fitting = kMargin * job.scene.stock.voxel_mm * std::sqrt(prediction.scaling_mb / room);
  return rounded_up(fitting);
}

}  // namespace

double movie_stock_mb(const Scene& scene, double leaves) {
  return movie_stock_bytes(scene, leaves) / kMegabyte;
}

MemoryPrediction predict_memory(const Job& job, const MeasuredPath& path, const Outputs& outputs,
                                int stocks) {
  const StockSettings& settings = job.scene.stock;
  const bool suspects = path.contacts && !path.contacts->suspects.empty();
  const SurfaceCounts counts =
      preview(job, *path.cycles, *path.carried, outputs.page || outputs.pictures || suspects);
  const auto ticks = static_cast<double>(path.cycles->size());
  const bool by_block = settings.cut_by == CutBy::kBlocks, planned_passes = settings.cut_by == CutBy::kPasses;
  const double sweeps = by_block ? static_cast<double>(path.path.elements.size()) : ticks;
  const RayCounts measured = ray_counts(job, path.mesh_rays);
  const double rays = measured.rays;
  const bool compared = job.scene.compare_planners && planned_passes;
  // The longest, and beside it those that have about as many ticks as the path itself.
  const double beside =
      std::min(static_cast<double>(kComparedAtOnce), static_cast<double>(thread_count())) - 1.0;
  const double compared_ticks =
      compared ? std::max(ticks, longest_comparison(job, path)) + beside * ticks : 0.0;
  const double own_sweeps = sweeps * (by_block ? kSweepOfBlock : kSweep);
  const double design_mesh =
      job.design_mesh ? kDesignTriangle * static_cast<double>(job.design_mesh->triangles.size()) : 0.0;
  // One stretch is in use while the next is planned (motion::PlanAhead).
  const double stretches = thread_count() > 1 ? 2.0 : 1.0;
  const double planned = std::min(kCellsOfBlock * static_cast<double>(path.path.elements.size()),
                                  stretches * static_cast<double>(motion::LookAheadReach{}.planned));
  const double held = kBase + static_cast<double>(settings.body_W().memory_bytes()) +
                      static_cast<double>(path.carried->bytes()) + own_sweeps + design_mesh +
                      (planned_passes ? 0.0 : planned * kPlannedCell) +
                      static_cast<double>(path.cycles->kept().size() * sizeof(motion::Cycle)) +
                      static_cast<double>(path.path.elements.bytes() + path.cycles->motions().bytes());
  const auto shown_bytes = [&](double triangles) {
    return outputs.pictures ? pictures_bytes(job.scene, triangles, counts.leaves_most)
           : outputs.page   ? kPage
                            : 0.0;
  };
  const double pictures = shown_bytes(counts.triangles), pictures_alone = shown_bytes(0.0);
  const double mesh = outputs.page || outputs.pictures ? counts.triangles * kTriangle : 0.0;
  const double shown = job.design_mesh && mesh > 0.0 ? sweeps * kShownSweep : 0.0;
  // The stages that hold most; each ends before the next begins.
  const auto peak = [&](double stock) {
    const double cutting = held + (stocks + kHoles) * stock + (by_block ? 0.0 : sweeps * kCutting) +
                           (suspects ? counts.triangles * kBodyTriangle : 0.0);
    const double after = held + rays * kRay + stock;
    const double comparing =
        compared ? after + compared_ticks * kComparedTick + (1.0 + beside) * rays * kRay : 0.0;
    const double measuring =
        job.has_design() ? after + kHoles * stock + rays * kMeasuredRay + sweeps * (kSweep + kCutting) : 0.0;
    const double proving =
        wants_proof(job) ? after + kHoles * stock + sweeps * kShownSweep + measured.proof_bytes : 0.0;
    return std::max(
        {held + counts.bytes, cutting, measuring, proving, comparing, after + mesh + shown + pictures});
  };
  const double stock =
      static_cast<double>(stock::Stock::memory_for(settings.box_W, settings.voxel_mm, counts.leaves_most));
  const double on_disk = counts.leaves_most * static_cast<double>(stock::Stock::kLeafBytes);
  return {.stock_mb = stocks * stock / kMegabyte,
          .peak_mb = peak(stock) / kMegabyte,
          .scaling_mb = (stock + mesh + pictures - pictures_alone) / kMegabyte,
          .fixed_mb = (kBase + pictures_alone) / kMegabyte,
          .limit_mb = memory_limit_mb(job.scene),
          .rest_mb = peak(stock - on_disk) / kMegabyte,
          .leaf_mb = (1.0 + kHoles) * static_cast<double>(stock::Stock::kLeafBytes) / kMegabyte,
          .leaves = counts.leaves_most};
}

namespace {

/// The same picture with so few pixels that it leaves what is too much; even sides. None: too small to see.
std::optional<std::array<int, 2>> smaller(const std::array<int, 2>& size, double bytes_of_pixel,
                                          double too_much_mb) {
  const double pixels = pixels_of(size);
  const double room = pixels - too_much_mb * kMegabyte / bytes_of_pixel;
  if (room < kUsualPixels) return {};
  const double share = std::sqrt(room / pixels);
  return std::array{static_cast<int>(share * size[0]) / 2 * 2, static_cast<int>(share * size[1]) / 2 * 2};
}

/// Where libraries and pictures alone exceed the limit, so that no voxel of the stock helps.
std::string pictures_that_fit(const Scene& scene, double too_much_mb, double leaves) {
  constexpr double kMargin = 1.1;  // the prediction wavers
  const double movie = movie_bytes(scene.movie), movie_stock = movie_stock_bytes(scene, leaves);
  const double left = movie_stock - too_much_mb * kMegabyte;
  if (movie + movie_stock > still_bytes(scene.stills) && left > 0.0)
    return fmt::format("movie.voxel_mm = {:g} is too fine: {:g} fits; or raise --max-memory",
                       scene.movie.voxel_mm,
                       rounded_up(scene.movie.voxel_mm * std::sqrt(kMargin * movie_stock / left)));
  const auto named = [&](const char* key, const std::array<int, 2>& size, double bytes_of_pixel) {
    const auto fitting = smaller(size, bytes_of_pixel, kMargin * too_much_mb);
    return fitting ? fmt::format("{} = [{}, {}] is too large: [{}, {}] fits", key, size[0], size[1],
                                 (*fitting)[0], (*fitting)[1])
                   : std::string("no size of its pictures fits: give --no-render");
  };
  return (still_bytes(scene.stills) >= movie_bytes(scene.movie)
              ? named("stills.size", scene.stills.size, kStillPixel)
              : named("movie.size", scene.movie.size,
                      kMoviePixel + kMovieSample * (scene.movie.samples - 1))) +
         "; or raise --max-memory";
}

}  // namespace

void require_memory(const Job& job, const MemoryPrediction& prediction, int ranks) {
  if (prediction.peak_mb <= prediction.limit_mb) return;
  throw InputError(
      "out-of-memory", {job.scene.file},
      fmt::format("stock.voxel_mm = {:g} is expected to need {:.0f} MB, {:.0f} MB may be used",
                  job.scene.stock.voxel_mm, prediction.peak_mb, prediction.limit_mb),
      prediction.fixed_mb < prediction.limit_mb
          ? fmt::format("voxel_mm = {:g} fits; or raise --max-memory, or {}",
                        voxel_that_fits(job, prediction),
                        ranks > 1 ? "start fewer ranks on a machine"
                                  : "add --spill: slower, leaves of the stock go to the disk")
          : pictures_that_fit(job.scene, prediction.peak_mb - prediction.limit_mb, prediction.leaves));
}

}  // namespace swarf::sim

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "base/parallel.h"
#include "cli/commands.h"
#include "cli/number_flags.h"
#include "cli/page_pdf.h"
#include "cli/terminal.h"
#include "cli/window_options.h"
#include "render/movie/movie_writer.h"
#include "reports/finding_pictures.h"
#include "reports/kept_findings.h"
#include "reports/part_view.h"
#include "reports/pending_folder.h"
#include "reports/pictures.h"
#include "reports/review_findings.h"
#include "reports/run_output.h"
#include "sim/run/measured_mesh.h"
#include "sim/run/ray_cutters.h"

namespace swarf::cli {
namespace {

struct RenderOptions {
  std::string folder, movie, still, pdf, kind = "part", camera;
  std::vector<int> size;
  double seconds = -1.0;
  int samples = 0, threads = 0, finding = 0;
  std::string section;
  std::optional<bool> transparent, labels;  ///< none: as the scene says
  sim::WindowPlaces window;
};

/// Of the stills, only those of the machine and of the fan show a motion.
void check_window(const RenderOptions& options, reports::StillKind kind) {
  const bool still_moves = kind == reports::StillKind::kMachine || kind == reports::StillKind::kFan;
  if (!options.window.any() || !options.movie.empty() || still_moves) return;
  throw InputError("no-motion-asked", {"swarf render"},
                   "--from and --to are for motions: the finished part has none",
                   "add --movie, or --kind machine");
}

/// The shots keep their shares.
void set_seconds(sim::MovieSettings& movie, double seconds) {
  double all = 0.0;
  for (const sim::MovieShot& shot : movie.shots) all += shot.seconds;
  for (sim::MovieShot& shot : movie.shots)
    shot.seconds =
        all > 0.0 ? shot.seconds * seconds / all : seconds / static_cast<double>(movie.shots.size());
  movie.seconds = seconds;
}

std::optional<sim::SectionPlane> section_of(const RenderOptions& options) {
  if (options.section.empty()) return {};
  if (options.still.empty() || options.finding > 0)
    throw InputError("nothing-to-do", {"--section"}, "--section is for a still",
                     "write for example: swarf render DIR --section x=10 --still cut.png");
  const auto plane = sim::section_named(options.section);
  if (plane) return plane;
  throw InputError("bad-section", {"--section"}, fmt::format("'{}' is no plane", options.section),
                   "write " + sim::section_forms());
}

reports::StillLook look_of(const RenderOptions& options, const sim::StillSettings& stills,
                           const std::optional<sim::SectionPlane>& section) {
  return {options.transparent.value_or(stills.transparent),
          options.labels.value_or(stills.labels.value_or(section.has_value())),
          section,
          {"--section"}};
}

/// The page of the run as it is.
void print_report(const RenderOptions& options) {
  const std::filesystem::path page = std::filesystem::path(options.folder) / "report.html";
  if (!std::filesystem::exists(page))
    throw InputError("no-page", {options.folder}, "this folder holds no report.html",
                     "name the folder of a run that was not made with --no-render");
  require_chromium();
  reports::check_output_file(options.pdf);
  write_page_pdf(page.string(), options.pdf);
  fmt::print("{}\n", options.pdf);
}

int render(const RenderOptions& options) {
  set_thread_count(options.threads);
  if (options.movie.empty() && options.still.empty() && options.pdf.empty()) {
    throw InputError("nothing-to-do", {"swarf render"}, "neither --movie nor --still nor --pdf was given",
                     "write for example: swarf render DIR --still part.png");
  }
  if (!options.pdf.empty()) print_report(options);
  if (options.movie.empty() && options.still.empty()) return kPass;
  if (options.finding > 0 && options.still.empty())
    throw InputError("nothing-to-do", {"--finding"}, "--finding is for a still, and none was asked for",
                     "write for example: swarf render DIR --finding 1 --still finding.png");
  const reports::StillKind kind = reports::still_kind(options.kind);
  check_window(options, kind);
  const std::optional<sim::SectionPlane> section = section_of(options);
  if (!options.camera.empty()) reports::camera_direction(options.camera);
  for (const std::string& file : {options.movie, options.still}) reports::check_output_file(file);
  if (!options.movie.empty()) render::check_movie_name(options.movie);
  print_diagnostics(reports::remarks_on_run(options.folder));
  TerminalProgress progress;
  reports::StoredRun stored = reports::read_run(options.folder);
  if (options.size.size() == 2) {
    stored.job.scene.stills.size = {options.size[0], options.size[1]};
    stored.job.scene.movie.size = stored.job.scene.stills.size;
  }
  if (options.samples > 0) stored.job.scene.stills.samples = options.samples;
  if (options.seconds > 0.0) set_seconds(stored.job.scene.movie, options.seconds);
  const bool coloured = !options.movie.empty() || kind == reports::StillKind::kDeviation;
  const bool sweeps =
      coloured && sim::colours_need_sweeps(stored.job, stored.dexels, stored.stock.voxel_mm());
  const bool moves = sweeps || !options.movie.empty() || options.finding > 0 ||
                     sim::normals_need_cycles(stored.job) || kind == reports::StillKind::kMachine ||
                     kind == reports::StillKind::kFan;
  const sim::MeasuredPath path = options.window.any()
                                     ? reports::window_motion(stored.job, options.folder, progress)
                                     : reports::motion_of(stored, options.folder, moves, progress);
  // What a finding shows had not been cut yet.
  const sim::Job shown = options.finding > 0 ? stored.job : sim::with_worn(stored.job, stored.worn);
  reports::FinishedRun run{shown, *path.cycles, stored.stock, stored.dexels, *path.carried};
  sim::JobSweeps rays;
  if (sweeps) rays = sim::all_ray_sweeps(stored.job, *path.cycles, *path.carried);
  run.rays = &rays;
  const reports::KeptFindings findings = reports::read_findings(options.folder);
  run.findings = &findings.list;
  if (options.window.any()) run.window = sim::window_of(options.window, *path.cycles);
  if (options.finding > 0) {
    reports::make_finding_picture(run, findings, options.finding, options.still);
    fmt::print("{}\n", options.still);
  } else if (!options.still.empty()) {
    const reports::StillPart part =
        reports::still_part(run, stored.stock.mesh(), reports::kept_worst_places(options.folder));
    reports::make_still(run, part, kind, options.camera, options.still,
                        look_of(options, stored.job.scene.stills, section));
    fmt::print("{}\n", options.still);
  }
  if (!options.movie.empty()) {
    const reports::RenderStatistics statistics = reports::make_movie(
        run, options.movie, options.camera.empty() ? "machine" : options.camera, progress);
    fmt::print("{}: {} frames, {:.1f} ms each (median)\n", options.movie, statistics.frames,
               statistics.frame_ms_median);
  }
  return progress.stop_requested() ? kStopped : kPass;
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command =
      app.add_subcommand("render", "Make pictures from a finished run, without simulating again");
  command->add_option("folder", options->folder, "folder of a finished run")->required();
  command->add_option("--movie", options->movie, "movie to write: .mp4 (H.264), .webm (VP9) or .apng");
  command->add_option("--still", options->still, "picture to write (.png)");
  command->add_option("--pdf", options->pdf, "report.html as a PDF with page numbers (.pdf; chromium)");
  command->add_option("--kind", options->kind, "what the still shows: machine, part, deviation, fan")
      ->capture_default_str();
  command->add_option("--camera", options->camera,
                      "machine, iso, low, front, back, left, right, top, or x,y,z towards the eye");
  command->add_option("--size", options->size, "width and height, px")
      ->expected(2)
      ->check(CLI::Range(64, 7680));
  command->add_option("--seconds", options->seconds, "length of the movie, s")->check(positive());
  add_window_options(*command, options->window, "movie, machine and fan");
  command->add_option("--samples", options->samples, "rays per pixel of the still, at most")
      ->check(CLI::Range(1, 4096));
  command
      ->add_option(
          "--finding", options->finding,
          "the still shows the machine at this finding, by its number in the page and in findings.json")
      ->check(positive());
  command->add_option(
      "--section", options->section,
      "cut the still open, of the machine its stock and fixtures: x=10, y=10, z=10 (mm), or a point "
      "and a normal, x,y,z,nx,ny,nz; with the outlines of part and design, straight on without "
      "--camera (not the machine)");
  command->add_flag_function(
      "--transparent,!--no-transparent", [options](int64_t count) { options->transparent = count > 0; },
      "no backdrop and no floor behind the still");
  command->add_flag_function(
      "--labels,!--no-labels", [options](int64_t count) { options->labels = count > 0; },
      "a scale bar on the still, right at the middle of what is shown; on a deviation its deepest and "
      "highest place with their values; a section has them unless --no-labels");
  command->add_option("--threads", options->threads, "threads to use (default: all cores)")
      ->check(CLI::Range(1, 4096));
  command->footer(R"(Examples:
  swarf render out/dome --still part.png --kind part --camera left
  swarf render out/dome --still at.png --finding 1
  swarf render out/dome --still cut.png --kind deviation --section x=0
  swarf render out/dome --movie cut.mp4 --seconds 20 --from-line 40 --to-line 80)");
  command->callback([options, &exit_code] { exit_code = render(*options); });
}

}  // namespace swarf::cli

#include "reports/run_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "base/file.h"
#include "base/side_by_side.h"
#include "mesh/mesh_io.h"
#include "reports/avoidance_output.h"
#include "reports/design_view.h"
#include "reports/finding_pictures.h"
#include "reports/html.h"
#include "reports/kept_inputs.h"
#include "reports/kept_motion.h"
#include "reports/part_view.h"
#include "reports/pending_folder.h"
#include "reports/pictures.h"
#include "reports/report_writer.h"
#include "reports/review_findings.h"
#include "reports/review_models.h"
#include "reports/run_report.h"
#include "sim/run/design_rays.h"
#include "sim/run/worn_fixtures.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;

constexpr double kPartGlbError = 2e-3;  // mm; a fifth of a usual scallop, far below a pixel

/// With an automatic voxel, where all is meant for a first look, a quarter of that.
double part_error_mm(const sim::Job& job) {
  const sim::StockSettings& stock = job.scene.stock;
  return stock.auto_voxel ? std::max(0.25 * stock.voxel_mm, kPartGlbError) : kPartGlbError;
}

/// Runs the parts of the writing one after the other; what goes wrong in one does not take the others with
/// it.
class Attempts {
 public:
  template <typename Part>
  void run(Part part) {
    try {
      part();
    } catch (const InputError& error) {
      const auto& found = error.diagnostics.list();
      failures.insert(failures.end(), found.begin(), found.end());
    } catch (...) {
      if (!fault_) fault_ = std::current_exception();
    }
  }
  /// What was no fault of the input, when everything else has been written.
  void rethrow() const {
    if (fault_) std::rethrow_exception(fault_);
  }

  std::vector<Diagnostic> failures;

 private:
  std::exception_ptr fault_;
};

/// Before any work: a logo that cannot be shown is told at its key.
void require_logo(const sim::ReportSettings& report) {
  if (report.logo_file.empty()) return;
  try {
    page_picture(report.logo_file);
  } catch (const InputError& error) {
    const Diagnostic& found = error.diagnostics.list().front();
    throw InputError("bad-logo", report.logo_where, report.logo_file + ": " + found.text,
                     "name a PNG file, or leave report.logo out");
  }
}

std::string shot_caption(const sim::StillShot& shot) {
  std::string caption = shot.kind == "machine" ? "The machine near the middle of the program"
                        : shot.kind == "fan"   ? "The tool's paths and its axes"
                        : shot.kind == "part"  ? "The finished part"
                                               : "Deviation from the design";
  if (!shot.camera.empty()) caption += ", camera " + shot.camera;
  if (shot.section) caption += ", cut open at " + sim::section_words(*shot.section);
  return caption + ".";
}

struct Picture {
  StillKind kind = StillKind::kPart;
  std::string file{}, caption{}, camera{};
  std::optional<sim::SectionPlane> section{};
  SourceLocation where{};
};

std::vector<Picture> planned_stills(const FinishedRun& run) {
  const bool blocks = run.cycles.elements().hold_blocks();
  std::vector<Picture> pictures{
      {StillKind::kMachine, "still_machine.png", "The machine near the middle of the program."},
      {StillKind::kPart, "still_part.png",
       blocks ? "The finished part."
              : "The finished part: strip lights break at each ridge, so every band is one pass."},
      {StillKind::kFan, "still_fan.png",
       blocks || run.job.scene.driven ? "The tool's paths and its axes."
                                      : "Paths and tool axes (Lin & Koren, Fig. 13)."}};
  if (!run.dexels.empty()) {
    pictures.insert(pictures.begin() + 2, {StillKind::kDeviation, "still_deviation.png",
                                           "Deviation from the design, from measuring rays."});
  }
  const sim::StillSettings& stills = run.job.scene.stills;
  std::erase_if(pictures, [&](const Picture& picture) {
    return std::find(stills.kinds.begin(), stills.kinds.end(), still_name(picture.kind)) ==
           stills.kinds.end();
  });
  for (size_t i = 0; i < stills.shots.size(); ++i) {
    const sim::StillShot& shot = stills.shots[i];
    pictures.push_back({still_kind(shot.kind), fmt::format("still_shot_{}.png", i + 1), shot_caption(shot),
                        shot.camera, shot.section, shot.where});
  }
  return pictures;
}

/// `left_out`: those that there is no time for.
void write_stills(const PendingFolder& folder, const FinishedRun& run, const StillPart& part,
                  Progress& progress, RunFiles& files, std::vector<std::string>& left_out,
                  Attempts& attempts) {
  const std::vector<Picture> pictures = planned_stills(run);
  const sim::StillSettings& stills = run.job.scene.stills;
  render::RayTreePtr tree;
  progress.begin("stills", static_cast<double>(pictures.size()), "pictures");
  for (const Picture& picture : pictures) {
    if (progress.stop_requested()) {
      left_out.push_back(picture.file);
      continue;
    }
    // What is measured has its scale; the deepest and the highest place are where the measures found them.
    const bool measured = picture.kind == StillKind::kPart || picture.kind == StillKind::kDeviation;
    attempts.run([&] {
      make_still(
          run, part, picture.kind, picture.camera, folder.file(picture.file),
          {stills.transparent, stills.labels.value_or(measured), picture.section, picture.where, &tree});
      files.stills.push_back({folder.file(picture.file), picture.caption});
    });
    progress.advance(static_cast<double>(files.stills.size()));
  }
}

/// Half a movie would be taken for a whole one.
void write_movie(const PendingFolder& folder, const FinishedRun& run, const TimeBudget& budget,
                 Progress& progress, RunFiles& files, RenderStatistics& statistics,
                 std::vector<std::string>& left_out) {
  constexpr const char* kMovie = "movie.mp4";
  if (run.job.scene.movie.seconds <= 0.0) return;
  if (!progress.stop_requested()) statistics = make_movie(run, folder.file(kMovie), "machine", progress);
  if (budget.has_passed() && !(statistics.frames > 0 && statistics.is_whole)) {
    fs::remove(folder.file(kMovie));
    statistics = {};
    left_out.emplace_back(kMovie);
  }
  if (statistics.frames > 0) files.movie = folder.file(kMovie);
}

void write_pictures(const PendingFolder& folder, const FinishedRun& run, const StillPart& part,
                    const TimeBudget& budget, sim::Result& result, Progress& progress, RunFiles& files,
                    RenderStatistics& statistics, Attempts& attempts) {
  write_stills(folder, run, part, progress, files, result.left_out, attempts);
  files.finding_pngs = make_finding_pictures(
      run, part.mesh, result,
      [&](size_t number) { return folder.file(fmt::format("still_finding_{}.png", number)); }, progress);
  progress.end();
  const bool lacks_some = std::any_of(files.finding_pngs.begin(), files.finding_pngs.end(),
                                      [](const std::string& file) { return file.empty(); });
  if (lacks_some && progress.stop_requested()) result.left_out.emplace_back("pictures of findings");
  write_movie(folder, run, budget, progress, files, statistics, result.left_out);
}

/// What pictures and measures can be made from again, the most precious first.
void write_state(const PendingFolder& folder, const sim::Job& job, const sim::Result& result,
                 const OutputOptions& options, Progress& progress) {
  progress.begin("write results", 2, "files");
  if (!result.cut.is_written) result.stock->save(folder.file(sim::kFinishedStock), result.cut.metadata);
  fs::remove(folder.file(sim::kKeptStock));
  progress.advance(1);
  for (size_t i = 0; i < result.main.dexels.size(); ++i) {
    result.main.dexels[i].save(folder.file(fmt::format("surface_{}.rays", i)));
  }
  keep_called_programs(folder, job,
                       result.main.nc ? result.main.nc->summary.files : std::vector<std::string>{},
                       result.main.carried->called);
  if (!result.main.cycles->stopped()) keep_motion(folder, *result.main.cycles);
  if (!result.stopped) {
    write_text(folder.file("metrics.json"), metrics_json(job, result, {}, options.avoidance));
    write_text(folder.file("findings.json"), findings_json(result));
  }
  progress.end();
}

/// As write_state; what could be written is not thrown away when the rest cannot.
void write_state_or_keep(PendingFolder& folder, const sim::Job& job, const sim::Result& result,
                         const OutputOptions& options, Progress& progress) {
  try {
    write_state(folder, job, result, options, progress);
  } catch (const std::exception& error) {
    if (!fs::exists(folder.file(sim::kFinishedStock))) throw;
    const std::string place = folder.keep_incomplete();
    const auto* input = dynamic_cast<const InputError*>(&error);
    if (input == nullptr)
      throw std::runtime_error(fmt::format("{} (what could be written is kept in {})", error.what(), place));
    Diagnostics told = input->diagnostics;
    told.note("results-incomplete", {place}, "what could be written is kept here; nothing was replaced");
    throw InputError(told);
  }
}

/// A fixture that the program has cut into, by the number of its link.
std::string worn_name(size_t link) {
  return fmt::format("fixture_{}_cut.ply", link);
}

void write_glb(const PendingFolder& folder, const FinishedRun& run, ReviewModels models,
               const sim::Result& result, RunFiles& files) {
  using render::GltfEncoding;
  show_worst(run, worst_places(result), models);
  models.design = shown_design(run.job);
  const auto write = [&](const char* name, const std::string& bytes) {
    replace_file(folder.file(name), bytes, {"cannot-write-file", "the glTF file cannot be written"});
  };
  // The page has its own reader: a quarter of the bytes, and colours by the limits that its reader chooses.
  const GltfOptions page{GltfEncoding::kMeshopt, false, true};
  const std::array<std::function<void()>, 4> encodings{
      [&] { write("part.glb", part_glb(run, models, {})); },
      [&] { write("machine.glb", machine_glb(run, models, {})); },
      [&] { files.part_glb = part_glb(run, models, page); },
      [&] { files.machine_glb = machine_glb(run, models, page); }};
  side_by_side(
      encodings.size(), 2, [&](size_t n) { encodings[n](); }, [](size_t) {});
  files.part_error_mm = models.part.error_mm;
  files.animation_scale = animation_scale(run);
  files.shown_from_s = static_cast<double>(run.first_shown()) * run.cycles.period_s();
  files.way = models.way;
}

/// All cycles again, which must be those of the run.
sim::MeasuredPath whole_motion(const sim::Job& job, const std::string& folder, Progress& progress) {
  const std::optional<KeptMotion> kept = read_motion(folder);
  if (kept) require_inputs(*kept, folder);
  sim::MeasuredPath path = sim::move_tool(job, progress);
  if (!kept || path.cycles->stopped() || path.cycles->recalled().hash == kept->recall.hash) return path;
  throw InputError(
      "run-differs", {folder},
      fmt::format("the inputs kept here give another motion than they gave swarf {}, of {} cycles "
                  "where it had {}: this is swarf {}",
                  kept->swarf, path.cycles->size(), kept->recall.cycles, SWARF_VERSION),
      "run the scene again");
}

}  // namespace

void begin_run(const PendingFolder& folder, const sim::Job& job, const OutputOptions& options) {
  require_logo(job.scene.report);
  const KeptInputs kept = keep_inputs(folder, job, options.overrides);
  nlohmann::ordered_json manifest{{"swarf", SWARF_VERSION},
                                  {"scene", job.scene.name},
                                  {"program", fs::path(job.scene.program_file).filename().string()},
                                  {"command", options.command},
                                  {"overrides", kept.own}};
  if (kept.earlier) manifest["earlier_overrides"] = *kept.earlier;
  write_text(folder.file(kRunMark),
             manifest.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

std::vector<Diagnostic> write_run(PendingFolder& folder, const sim::Job& job, sim::Result& result,
                                  const OutputOptions& options, Progress& progress) {
  write_state_or_keep(folder, job, result, options, progress);
  Attempts attempts;
  if (result.stopped) {
    folder.move_into_place();
    return {};
  }
  const std::vector<sim::WornFixture> worn = sim::worn_fixtures(job, result);
  for (const sim::WornFixture& fixture : worn)
    attempts.run([&] { mesh::save_mesh(folder.file(worn_name(fixture.link)), fixture.mesh_M); });
  const sim::Job shown = sim::with_worn(job, worn);
  FinishedRun run{shown, *result.main.cycles, *result.stock, result.main.dexels, *result.main.carried};
  if (result.main.keys) run.keys = &*result.main.keys;
  run.rays = &result.main.rays;
  run.findings = &result.findings;
  RunFiles files;
  RenderStatistics statistics;
  TriMesh closed = options.report || options.render ? run.stock.mesh() : TriMesh{};
  std::optional<ReviewModels> models;
  std::optional<StillPart> part;
  BudgetProgress limited(progress, options.budget, 1.0);
  const bool models_wanted = options.report && !limited.stop_requested();
  if (models_wanted) {
    progress.begin("glTF", 2, "files");
    attempts.run([&] { models = review_models(run, closed, part_error_mm(run.job), review_pins(result)); });
    progress.advance(1);
  }
  if (options.render) attempts.run([&] { part = still_part(run, std::move(closed), worst_places(result)); });
  if (models) attempts.run([&] { write_glb(folder, run, std::move(*models), result, files); });
  if (models_wanted) progress.end();
  if (options.report && !models_wanted) result.left_out = {"part.glb", "machine.glb"};
  if (part)
    attempts.run([&] {
      write_pictures(folder, run, *part, options.budget, result, limited, files, statistics, attempts);
    });
  result.stopped = progress.stop_requested();
  if (options.report) {
    progress.begin("report", 1, "files");
    attempts.run([&] {
      ReportData data = report_data(job, result, files, options.render);
      data.reproduce = {options.command};
      if (options.avoidance != nullptr)
        data.topics.insert(data.topics.begin(), avoidance_topic(*options.avoidance, job));
      write_report(folder.file("report.html"), data);
    });
    progress.end();
  }
  if (options.render || options.report)  // else nothing has been added to them
    attempts.run([&] {
      write_text(folder.file("metrics.json"), metrics_json(job, result, statistics, options.avoidance));
    });
  folder.move_into_place();
  attempts.rethrow();
  return attempts.failures;
}

sim::Job read_job(const std::string& folder, const std::vector<std::string>& overrides) {
  return sim::load_kept_job(folder, overrides);
}

namespace {

std::vector<sim::WornFixture> read_worn(const fs::path& folder, const sim::Job& job) {
  std::vector<sim::WornFixture> worn;
  for (size_t i = 0; i < job.machine.links.size(); ++i) {
    const fs::path file = folder / worn_name(i);
    if (!job.machine.links[i].fixture || !fs::exists(file)) continue;
    worn.push_back({i, job.machine.links[i].name, 0.0, mesh::load_mesh(file.string())});
    worn.back().mesh_M.normals.clear();
  }
  return worn;
}

}  // namespace

StoredRun read_run(const std::string& folder) {
  const fs::path root(folder);
  sim::Job job = read_job(folder, {});
  stock::Stock stock = stock::Stock::load((root / sim::kFinishedStock).string());
  std::vector<sim::WornFixture> worn = read_worn(root, job);
  StoredRun run{std::move(job), std::move(stock), {}, std::move(worn)};
  const std::vector<stock::RayFieldPtr> fields = sim::design_rays(run.job);
  for (size_t i = 0; i < fields.size(); ++i) {
    const fs::path rays = root / fmt::format("surface_{}.rays", i);
    if (!fs::exists(rays)) break;  // a run that was stopped before it was measured
    run.dexels.push_back(stock::SurfaceDexels::load(rays.string(), fields[i]));
  }
  return run;
}

std::vector<Diagnostic> remarks_on_run(const std::string& folder) {
  const std::string mark = (fs::path(folder) / kRunMark).string();
  std::ifstream file(mark);
  const nlohmann::json manifest = nlohmann::json::parse(file, nullptr, false);
  if (!manifest.is_object() || !manifest.contains("swarf")) return {};  // told by what reads it
  std::vector<Diagnostic> told;
  const nlohmann::json& version = manifest.at("swarf");
  if (version != SWARF_VERSION)
    told.push_back(
        {"other-version",
         Severity::kWarning,
         {mark},
         fmt::format("swarf {} has made this run, this is {}: what it writes may differ from the run's own",
                     version.is_string() ? version.get<std::string>() : version.dump(), SWARF_VERSION),
         "run the scene again where it matters"});
  const fs::path stock = fs::path(folder) / sim::kFinishedStock;
  // Judged runs alone have numbers.
  if (fs::exists(stock) && !fs::exists(fs::path(folder) / "metrics.json"))
    told.push_back({"run-stopped",
                    Severity::kWarning,
                    {folder},
                    "this run was stopped before it was judged: its stock is as it was cut up to then",
                    fmt::format("go on from it: swarf run SCENE --from {}", stock.string())});
  return told;
}

sim::MeasuredPath motion_of(const StoredRun& run, const std::string& folder, bool needed,
                            Progress& progress) {
  if (!needed) {
    sim::MeasuredPath none;
    none.cycles = std::make_unique<motion::Cycles>(toolpath::Elements{}, sim::machines_by_tool(run.job),
                                                   run.job.scene.tools.front(), run.job.scene.motion);
    return none;
  }
  return whole_motion(run.job, folder, progress);
}

sim::MeasuredPath window_motion(const sim::Job& job, const std::string& folder, Progress& progress) {
  std::optional<KeptMotion> kept = read_motion(folder);
  if (!kept) return whole_motion(job, folder, progress);
  sim::MeasuredPath path = sim::plan_tool(job, progress);
  recall_motion(*path.cycles, std::move(*kept), folder);
  return path;
}

}  // namespace swarf::reports

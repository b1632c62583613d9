#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "reports/run_output.h"
#include "sim/replay.h"

namespace swarf::cli {
namespace {

struct ReplayOptions {
  std::string record, scene;
  std::vector<std::string> overrides;
  int threads = 0;
  bool json = false;
};

/// Without --scene the record's own scene must be as it was: a changed one is compared only when it is named.
void require_unchanged(const ReplayOptions& options, const sim::CutRecord& record,
                       const sim::ReplayResult& result) {
  Diagnostics diagnostics;
  for (const sim::IdentityDifference& part : result.parts) {
    diagnostics.error(
        "record-scene-changed", {record.scene},
        fmt::format("{} was {} when it was recorded and is {}", part.name, part.before, part.now),
        fmt::format("compare on purpose with: swarf replay {} --scene {}", options.record, record.scene));
  }
  diagnostics.throw_if_errors();
}

std::string cut_place_text(const sim::CutPlace& place) {
  return fmt::format("line {}, t = {:.4f} s, block {}", place.line, place.t_s, place.block);
}

void print_result(const sim::CutRecord& record, const sim::ReplayResult& result) {
  for (const sim::IdentityDifference& part : result.parts) {
    fmt::print("  differs: {}: {} | {}\n", part.name, part.before, part.now);
  }
  fmt::print("  {} of {} recorded sweeps compared, {} states of the stock\n", result.sweeps,
             record.sweeps.size(), result.states);
  if (!result.difference) {
    fmt::print("  {}\n", result.same_motion ? "EQUAL: same motion, same stock"
                                            : "EQUAL STOCK: the motion differs, the stock never does");
    return;
  }
  const sim::ReplayDifference& d = *result.difference;
  if (d.exact) {
    fmt::print("  DIFFERENT: the stocks differ first at sweep {}\n", d.first + 1);
  } else {
    fmt::print(
        "  DIFFERENT: the same motion left another stock within sweeps {} to {}\n"
        "    record with --record-every 1 to find the sweep\n",
        d.first + 1, d.last + 1);
  }
  fmt::print("    recorded: {}\n    now:      {}\n", cut_place_text(d.recorded), cut_place_text(d.now));
}

nlohmann::ordered_json cut_place_json(const sim::CutPlace& place) {
  return {{"line", place.line}, {"t_s", place.t_s}, {"block", place.block}};
}

std::string json_text(const sim::ReplayResult& result) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const sim::IdentityDifference& part : result.parts) {
    parts.push_back({{"name", part.name}, {"recorded", part.before}, {"now", part.now}});
  }
  nlohmann::ordered_json json{{"schema", 1},
                              {"equal", !result.difference},
                              {"same_motion", result.same_motion},
                              {"sweeps", result.sweeps},
                              {"states", result.states},
                              {"parts", parts},
                              {"difference", nullptr}};
  if (result.difference) {
    const sim::ReplayDifference& d = *result.difference;
    json["difference"] = {{"exact", d.exact},
                          {"first_sweep", d.first + 1},
                          {"last_sweep", d.last + 1},
                          {"recorded", cut_place_json(d.recorded)},
                          {"now", cut_place_json(d.now)}};
  }
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// The job to compare with. When the recorded scene is no longer where it was, the copies that were kept with
/// the record stand for it.
sim::Job job_to_compare(const ReplayOptions& options, const sim::CutRecord& record) {
  if (!options.scene.empty()) return sim::load_job(options.scene, options.overrides);
  const std::string folder = std::filesystem::absolute(options.record).parent_path().string();
  const bool gone = !std::filesystem::exists(record.scene);
  if (gone && std::filesystem::exists(std::filesystem::path(folder) / reports::kRunMark)) {
    fmt::print(stderr, "{} is not there: its copy in {} is taken\n", record.scene, folder);
    return reports::read_job(folder, options.overrides);
  }
  std::vector<std::string> overrides = record.overrides;
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  return sim::load_job(record.scene, overrides);
}

int replay(const ReplayOptions& options) {
  set_thread_count(options.threads);
  const sim::CutRecord record = sim::read_record(options.record);
  const bool own_scene = options.scene.empty();
  const sim::Job job = job_to_compare(options, record);
  print_diagnostics(job.warnings);
  TerminalProgress progress;
  const sim::ReplayResult result = sim::replay(record, job, progress);
  if (result.stopped) {
    fmt::print(stderr, "stopped: the runs are equal up to sweep {}\n", result.sweeps);
    return kStopped;
  }
  if (own_scene && options.overrides.empty()) require_unchanged(options, record, result);
  if (options.json) {
    fmt::print("{}", json_text(result));
  } else {
    fmt::print("{} against {}\n", options.record, own_scene ? record.scene : options.scene);
    print_result(record, result);
  }
  return result.difference ? kFindings : kPass;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand(
      "replay", "Cut a recorded run again and name the first block at which the stocks differ");
  command->add_option("record", options->record, "run.record, written by swarf run --record")->required();
  command->add_option(
      "--scene", options->scene,
      "compare with this scene (default: the recorded one, which must be unchanged; where it is gone, the "
      "copy kept with the record)");
  command
      ->add_option("--set", options->overrides,
                   "replace a key of the scene; what was set in the recorded run is set again unless --scene "
                   "is given")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->add_option("--threads", options->threads, "threads to use (default: all cores)")
      ->check(CLI::Range(1, 4096));
  command->add_flag("--json", options->json, "print JSON instead of the table");
  command->footer(
      "Example:\n  swarf replay out/dome/run.record --scene scenes/lin_koren_dome/scene.toml\n\n"
      "Exit codes: 0 the stocks are equal after every block; 1 they differ; 2 the input is wrong.");
  command->callback([options, &exit_code] { exit_code = replay(*options); });
}

}  // namespace swarf::cli

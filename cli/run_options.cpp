#include "cli/run_options.h"

#include <fmt/format.h>

#include <map>

#include "cli/number_flags.h"

namespace swarf::cli {
namespace {

constexpr const char* kRunFooter =
    R"(Without a scene, everything that the flags leave open is taken by a rule: machine, block, voxel, clamping. The table at
the top of the console, in report.html and in metrics.json (`assumptions`) says each value, its reason and what changes
it. One picture and no movie: --set movie.seconds=10 adds it.

Examples:
  swarf run part.nc --tool 6                                 one flat end, block around the path, generic mill
  swarf run part.nc --tools T1=10,T2=drill5 --stock 0,0,-20,80,60,0
  swarf run part.mpf --machine spinner_u5_620 --tools tools.toml --design part.stl
  swarf run scene.toml --set stock.voxel_mm=0.1 --no-render  a scene, one key changed, numbers only
  mpirun -n 8 swarf run scene.toml --tiles --no-render       eight processes, on one machine or several)";

/// Options of the stock on its way.
void add_stock_options(CLI::App& command, RunOptions& options) {
  CLI::Option* from = command.add_option(
      "--from", options.from,
      "go on from a stock.vdb that this scene has saved or left when it was stopped; the finished stock is "
      "bit-identical to that of an uninterrupted run");
  command
      .add_option("--save-stock-after", options.save_after,
                  "save the stock after these places in the program: lines as findings name them (13), "
                  "program times (12.5s) and tools (T5, T=NAME), separated by commas; stock_after_*.vdb in "
                  "the results")
      ->type_name("PLACE[,PLACE...]");
  command
      .add_flag("--record", options.record,
                "keep every sweep and hashes of the stock in run.record, for swarf replay")
      ->excludes(from);
  command.add_option("--record-every", options.record_every, "sweeps between two hashes of --record")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  command
      .add_option(
          "--keep-every", options.keep_every_s,
          "keep the stock so far every so many seconds in <output>.part<process>/stock_so_far.vdb, to "
          "go on from when the run is killed; 0: never")
      ->type_name("SECONDS")
      ->capture_default_str()
      ->check(nonnegative());
  CLI::Option* check =
      command.add_flag("--check", options.check,
                       "check the costly invariants of the stock on the way too, not only at the end");
  CLI::Option* most =
      command
          .add_option(
              "--max-memory", options.max_memory_mb,
              "refuse to start when more is expected to be needed (default: stock.max_memory_mb, else "
              "80 % of what is free)")
          ->type_name("MB")
          ->check(positive());
  command
      .add_flag(
          "--spill", options.spill,
          "when more memory is needed than --max-memory allows, leaves of the stock that are not cut go "
          "to a file in the results' folder, which is gone when the run ends: slower instead of "
          "refused, with the same results")
      ->needs(most)
      ->excludes(check);
}

}  // namespace

std::vector<std::string> command_words(const RunOptions& options) {
  std::vector<std::string> words{"swarf", "run", options.scene};
  const auto add = [&](bool given, const char* option, const std::string& value) {
    if (given) words.insert(words.end(), {option, value});
  };
  const auto flag = [&](bool given, const char* option) {
    if (given) words.emplace_back(option);
  };
  const std::vector<std::string> job = given_words(options.job);
  words.insert(words.end(), job.begin(), job.end());
  for (const std::string& set : options.overrides) add(true, "--set", set);
  add(!options.from.empty(), "--from", options.from);
  add(!options.save_after.empty(), "--save-stock-after", options.save_after);
  flag(options.record, "--record");
  add(options.record_every != RunOptions{}.record_every, "--record-every",
      fmt::format("{}", options.record_every));
  flag(options.check, "--check");
  add(options.max_memory_mb > 0.0, "--max-memory", fmt::format("{}", options.max_memory_mb));
  flag(options.spill, "--spill");
  add(options.keep_every_s != RunOptions{}.keep_every_s, "--keep-every",
      fmt::format("{}", options.keep_every_s));
  add(options.budget_s > 0.0, "--budget", fmt::format("{}", options.budget_s));
  add(options.setup > 0, "--setup", fmt::format("{}", options.setup));
  add(options.threads > 0, "--threads", fmt::format("{}", options.threads));
  flag(options.tiles, "--tiles");
  flag(options.no_render, "--no-render");
  flag(options.report, "--report");
  add(!options.trajectory.empty(), "--trajectory", options.trajectory);
  flag(options.json, "--json");
  flag(options.open, "--open");
  flag(options.pdf, "--pdf");
  add(!options.pipeline.sarif.empty(), "--sarif", options.pipeline.sarif);
  add(!options.pipeline.junit.empty(), "--junit", options.pipeline.junit);
  add(!options.output.empty(), "-o", options.output);
  return words;
}

std::vector<std::string> overrides_of(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  // With --spill it is judged when it is known what goes to the disk (sim::CutOptions).
  constexpr double kAnything = 1e12;
  if (options.max_memory_mb > 0.0)
    overrides.push_back(
        fmt::format("stock.max_memory_mb={}", options.spill ? kAnything : options.max_memory_mb));
  if (options.budget_s > 0.0) overrides.push_back(fmt::format("output.budget_s={}", options.budget_s));
  if (!options.trajectory.empty())
    overrides.push_back(fmt::format("output.trajectory=\"{}\"", options.trajectory));
  return overrides;
}

sim::CutOptions cut_options(const RunOptions& options, const std::string& save_folder) {
  sim::CutOptions cut;
  cut.resume_file = options.from;
  if (!options.save_after.empty()) cut.save_after = sim::parse_places(options.save_after);
  cut.save_folder = save_folder;
  cut.record = options.record;
  cut.record_every = options.record_every;
  cut.check_voxels = options.check;
  cut.keep_every_s = options.keep_every_s;
  cut.spill = options.spill;
  cut.max_memory_mb = options.max_memory_mb;
  cut.outputs = {!options.no_render, !options.no_render || options.report};
  cut.overrides = options.overrides;
  cut.ranks = options.ranks;
  return cut;
}

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_option("file", options.scene, "scene.toml, an NC program or CL data");
  command.add_option("-o,--output", options.output,
                     "folder for the results (default: out/<scene folder>, out/<program>)");
  add_job_flags(command, options.job);
  command.footer(kRunFooter);
  command.add_option("--set", options.overrides, "replace a key of the scene: --set stock.voxel_mm=0.1")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  add_parameter_flag(command, options.overrides);
  command.add_flag_callback(
      "--roughing", [&options] { options.overrides.push_back("accept.roughing=true"); },
      "material may be left above the design: without it, and without accept.excess_max_um, more than 100 um "
      "fail");
  command
      .add_option("--setup", options.setup,
                  "of a scene with several [[setup]]: run them up to this one (default: all)")
      ->type_name("NUMBER")
      ->check(CLI::Range(1, 1000));
  command
      .add_option("--threads", options.threads,
                  "threads to use (default: all cores); results do not depend on it")
      ->check(CLI::Range(1, 4096));
  command.add_flag(
      "--tiles", options.tiles,
      "one of the processes that mpirun has started: each cuts its own tiles of the stock and of the "
      "measuring rays; results are those of one process, to the last bit");
  add_stock_options(command, options);
  command
      .add_option(
          "--budget", options.budget_s,
          "time for the whole run: 20s, 5min, 1h. Cutting and measuring always end. The proofs end with "
          "what they have shown by then (a limit that is not proven is a finding), and no further "
          "picture is begun; what is left out is named")
      ->type_name("TIME")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1.0}, {"min", 60.0}, {"h", 3600.0}}))
      ->check(positive());
  command.add_flag("--no-render", options.no_render,
                   "no movie, no stills, no page and no glTF: numbers, findings, stock and blocks.csv");
  command.add_flag("--report", options.report, "with --no-render: page and glTF all the same");
  command
      .add_option(
          "--trajectory", options.trajectory,
          "write each control cycle too, instead of what the scene's [output] trajectory says: csv (about "
          "230 bytes a cycle, 800 MB for an hour; ten decimals, good for jerk by differences to 0.4 "
          "mm/s^3 at 1 ms) or h5 (HDF5, compressed, numbers as they are)")
      ->check(CLI::IsMember({"csv", "h5", "none"}));
  command.add_flag("--json", options.json, "print metrics.json instead of the table");
  command.add_flag("--open", options.open, "show report.html when it is there (xdg-open)");
  command.add_flag("--pdf", options.pdf, "print report.html to report.pdf too, with page numbers (chromium)");
  add_pipeline_options(command, options.pipeline);
}

}  // namespace swarf::cli

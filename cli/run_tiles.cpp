#include "cli/run_tiles.h"

#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <optional>

#include "cli/open_ranks.h"
#include "cli/posted_scene.h"
#include "cli/terminal.h"
#include "sim/job/set_ups.h"
#include "sim/run/tile_ranks.h"
#include "sim/simulation.h"

namespace swarf::cli {
namespace {

void refuse_as_rank(bool given, const std::string& what, const char* remedy) {
  if (given) throw InputError("not-in-tiles", {what}, "this is for a run of one process", remedy);
}

/// Another rank than 0: it writes and says nothing; what is wrong with its input is told by rank 0.
int serve_as_rank(const RunOptions& options, Ranks& ranks) {
  try {
    std::optional<sim::Job> job;
    sim::CutOptions cut;
    try {
      refuse_for_tiles(options);
      cut = cut_options(options, "");
      job = load_job(options.scene, options.job, overrides_of(options));
      refuse_for_tiles(*job);
    } catch (const InputError& error) {
      sim::refuse_tile_lead(ranks, error.what());
      return kPass;
    }
    Progress silent;
    sim::serve_tiles(*job, cut, ranks, silent);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: rank {}: {}\n", ranks.rank(), error.what());
    ranks.abort(kInternalError);
  }
  return kPass;
}

/// Open MPI's mpirun answers Ctrl-C by SIGCONT, a second later SIGTERM, and kills after one more: too soon
/// for a large stock to be written. SIGUSR1 it passes on, and waits.
void tell_how_to_stop() {
  if (manner().quiet || std::getenv("OMPI_COMM_WORLD_RANK") == nullptr) return;
  fmt::print(
      stderr,
      "note: SIGUSR1 to mpirun stops in order; after Ctrl-C it leaves the ranks one second to keep what "
      "is cut (more: mpirun --mca odls_base_sigkill_timeout SECONDS), then what --keep-every has kept\n");
}

}  // namespace

void refuse_for_tiles(const RunOptions& options) {
  refuse_as_rank(options.scene == "-", "-", "name a file that every rank can read");
  refuse_as_rank(
      options.spill, "--spill",
      "leave it out: of what the ranks hold together rank 0 holds the whole, and raise --max-memory");
  refuse_as_rank(count_setups(options.scene, overrides_of(options)) > 0, "[[setup]]",
                 "make each set-up a scene of its own: stock.from_run is the folder of the one before");
}

void refuse_for_tiles(const sim::Job& job) {
  refuse_as_rank(wants_post(job), "[post]",
                 "write the program with swarf post, and name it as nc of the scene");
}

int run_as_rank(RunOptions options, const std::function<int(const RunOptions&)>& run) {
  const std::unique_ptr<Ranks> ranks = open_ranks();
  if (ranks->rank() > 0) return serve_as_rank(options, *ranks);
  options.ranks = ranks.get();
  tell_how_to_stop();
  struct Dismissal {
    Ranks& ranks;
    ~Dismissal() { sim::dismiss_ranks(ranks); }
  } dismissal{*ranks};
  return run(options);
}

}  // namespace swarf::cli

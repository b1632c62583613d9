#include "sim/cut_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "sim/cut_record.h"
#include "sim/simulation.h"

namespace swarf::sim {
namespace {

constexpr size_t kSweepsPerBatch = 256;  // between two looks at the holder, the progress bar and Ctrl-C
constexpr size_t kChecks = 8;            // of the invariants on the way, evenly spread over the sweeps

size_t next_multiple(size_t at, size_t step) {
  return (at / step + 1) * step;
}

class CutStage {
 public:
  CutStage(const Job& job, const CutOptions& options, Progress& progress, Result& result)
      : job_(job),
        options_(options),
        progress_(progress),
        result_(result),
        outcome_(result.cut),
        merged_(stock_sweeps(job, result.main.path, result.main.motion.trajectory)),
        solids_(tool_solids(job.scene)),
        identity_(cut_identity(job, merged_)),
        clearance_(job.scene.tools, job.scene.stock.voxel_mm),
        bad_cuts_(job, result.main.path, merged_) {
    outcome_.state.clearance = clearance_.result();
    result_.sweep_bound_mm = merged_.error_bound_mm;
    result_.merged_sweeps = merged_.sweeps.size();
  }

  void run() {
    find_saves();
    make_stock();
    progress_.begin("cut", static_cast<double>(merged_.sweeps.size()), "blocks");
    progress_.start_at(static_cast<double>(at_));
    save_due();
    while (at_ < merged_.sweeps.size() && !progress_.stop_requested()) cut_on();
    progress_.end();
    check(CheckKind::kAtEnd);
    finish();
  }

 private:
  enum class CheckKind { kOnTheWay, kAtEnd };
  struct Save {
    size_t after;  ///< sweeps
    const ProgramPlace* place;
  };

  void find_saves() {
    for (const ProgramPlace& place : options_.save_after) {
      const size_t after =
          sweeps_until(place, merged_, result_.main.motion.trajectory, result_.main.path, job_.scene.tools);
      saves_.push_back({after, &place});
    }
    std::stable_sort(saves_.begin(), saves_.end(),
                     [](const Save& a, const Save& b) { return a.after < b.after; });
  }

  void make_stock() {
    const StockSettings& settings = job_.scene.stock;
    result_.stock = std::make_unique<stock::Stock>(settings.box_W, settings.voxel_mm);
    full_mm3_ = result_.stock->volume_mm3();
    if (!options_.resume_file.empty()) {
      result_.stock.reset();
      result_.stock =
          std::make_unique<stock::Stock>(load_in_process(options_.resume_file, identity_, outcome_.state));
      at_ = outcome_.resumed_from = outcome_.state.sweeps;
      clearance_.resume(outcome_.state.clearance);
      bad_cuts_.resume(outcome_.state.bad_cuts);
      for (const Save& save : saves_) {
        if (save.after >= at_) continue;
        throw InputError("place-before-resume", {save.place->text},
                         fmt::format("the stock to go on from was cut up to line {}, {:.3f}s already",
                                     outcome_.state.place.line, outcome_.state.place.t_s),
                         "save after a later place, or run from the start");
      }
    }
    if (options_.check_voxels) checked_ = result_.stock->clone();
  }

  /// Cuts up to the next place where something is due, and does it. The looks at shank and holder follow the
  /// program's own batches, so that they do not depend on where the run began or what it saves.
  void cut_on() {
    const size_t total = merged_.sweeps.size();
    const size_t batch_end = std::min(next_multiple(at_, kSweepsPerBatch), total);
    size_t end = batch_end;
    if (options_.record) end = std::min(end, next_multiple(at_, options_.record_every));
    if (next_save_ < saves_.size() && saves_[next_save_].after > at_) {
      end = std::min(end, saves_[next_save_].after);
    }
    each_tool(at_, end,
              [&](size_t tool, std::span<const stock::Sweep> part) { cut_row(part, solids_[tool]); });
    at_ = end;
    if (at_ == batch_end) {
      const size_t before = (at_ - 1) / kSweepsPerBatch * kSweepsPerBatch;
      each_tool(before, at_, [&](size_t tool, std::span<const stock::Sweep> part) {
        clearance_.check(*result_.stock, part, tool);
      });
      outcome_.state.clearance = clearance_.result();
      if (before * kChecks / total != at_ * kChecks / total) check(CheckKind::kOnTheWay);
      progress_.advance(static_cast<double>(at_));
    }
    if (options_.record && (at_ % options_.record_every == 0 || at_ == total)) {
      record_.states.push_back(result_.stock->hash());
    }
    save_due();
  }

  /// Sweeps of one tool; those that must take nothing are looked at one by one, each before it is cut.
  void cut_row(std::span<const stock::Sweep> sweeps, const stock::CutterSolid& solid) {
    while (!sweeps.empty()) {
      const auto suspicious = [&](const stock::Sweep& sweep) { return bad_cuts_.suspicious(sweep); };
      const auto first = std::find_if(sweeps.begin(), sweeps.end(), suspicious);
      const auto plain = static_cast<size_t>(first - sweeps.begin());
      result_.stock->cut(sweeps.first(plain), solid);
      sweeps = sweeps.subspan(plain);
      if (sweeps.empty()) break;
      bad_cuts_.check(*result_.stock, sweeps.front());
      result_.stock->cut(sweeps.first(1), solid);
      sweeps = sweeps.subspan(1);
    }
    outcome_.state.bad_cuts = bad_cuts_.result();
  }

  /// Sweeps [begin, end) as rows of one tool.
  template <typename Visit>
  void each_tool(size_t begin, size_t end, const Visit& visit) const {
    for_each_tool(
        std::span(merged_.sweeps).subspan(begin, end - begin),
        [&](uint32_t block) { return merged_.sources[block].tool; }, visit);
  }

  CutState state() const {
    CutState state = outcome_.state;
    state.sweeps = at_;
    if (at_ > 0) state.place = place(at_ - 1);
    return state;
  }
  CutPlace place(size_t sweep) const {
    return place_of(merged_.sweeps[sweep], merged_.sources, result_.main.motion.trajectory,
                    result_.main.path);
  }

  void save_due() {
    for (; next_save_ < saves_.size() && saves_[next_save_].after <= at_; ++next_save_) {
      const std::string name = saved_stock_name(*saves_[next_save_].place);
      result_.stock->save(options_.save_folder + "/" + name,
                          cut_metadata(job_.scene.name, identity_, state()));
      outcome_.saved.push_back(name);
    }
  }

  /// The first broken invariant is kept; the run goes on and reports it.
  void check(CheckKind kind) {
    const bool voxels = options_.check_voxels || kind == CheckKind::kAtEnd;
    std::string broken = result_.stock->check(voxels ? stock::CheckLevel::kVoxels : stock::CheckLevel::kMap);
    ++(voxels ? outcome_.voxel_checks : outcome_.map_checks);
    if (checked_) {
      if (broken.empty()) broken = result_.stock->check_since(*checked_);
      checked_ = result_.stock->clone();
    }
    if (broken.empty() || !outcome_.broken_invariant.empty()) return;
    outcome_.broken_invariant = fmt::format("{} (after {} of {} sweeps, line {}, {:.3f}s)", broken, at_,
                                            merged_.sweeps.size(), state().place.line, state().place.t_s);
  }

  void finish() {
    outcome_.state = state();
    outcome_.metadata = cut_metadata(job_.scene.name, identity_, outcome_.state);
    result_.clearance = clearance_.result();
    result_.volume_left_mm3 = result_.stock->volume_mm3();
    result_.volume_removed_mm3 = full_mm3_ - result_.volume_left_mm3;
    if (options_.record) write_states();
    result_.cut_sources = std::move(merged_.sources);
  }

  void write_states() {
    record_.scene = job_.scene.file;
    record_.overrides = options_.overrides;
    record_.identity = identity_;
    record_.every = options_.record_every;
    record_.program_sweeps = merged_.sweeps.size();
    record_.sweeps.assign(merged_.sweeps.begin(), merged_.sweeps.begin() + static_cast<ptrdiff_t>(at_));
    for (size_t n = 0; n < at_; ++n) {
      record_.places.push_back(place(n));
      record_.tools.push_back(merged_.sources[merged_.sweeps[n].block].tool);
    }
    // A stopped run ends between two hashes.
    if (record_.states.size() * record_.every < at_) record_.states.push_back(result_.stock->hash());
    write_record(options_.save_folder + "/" + kRecordFile, record_);
  }

  const Job& job_;
  const CutOptions& options_;
  Progress& progress_;
  Result& result_;
  CutOutcome& outcome_;
  JobSweeps merged_;
  std::vector<stock::CutterSolid> solids_;  ///< by tool
  CutIdentity identity_;
  ToolClearanceCheck clearance_;
  BadCutCheck bad_cuts_;
  std::vector<Save> saves_;
  size_t next_save_ = 0, at_ = 0;
  double full_mm3_ = 0.0;
  std::optional<stock::Stock> checked_;  ///< the state at the last check
  CutRecord record_;
};

}  // namespace

std::string saved_stock_name(const ProgramPlace& place) {
  std::string text = place.text;
  for (char& c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') c = '_';
  }
  return fmt::format("stock_after_{}{}.vdb", place.line > 0 ? "line_" : "", text);
}

void cut_stock(const Job& job, const CutOptions& options, Progress& progress, Result& result) {
  CutStage(job, options, progress, result).run();
}

}  // namespace swarf::sim

#include "sim/run/cut_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <ctime>
#include <future>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "sim/run/cut_parts.h"
#include "sim/run/cut_record.h"
#include "sim/run/leaf_budget.h"
#include "sim/run/result.h"
#include "sim/run/stock_contacts.h"
#include "sim/run/tile_ranks.h"

namespace swarf::sim {
namespace {

constexpr size_t kSuspectsPerStep = 32;  // between two looks at the progress bar, where each is judged

size_t next_multiple(size_t at, size_t step) {
  return (at / step + 1) * step;
}

/// False: there is no folder for it, or something went wrong: that is told when the results are written,
/// which tries it again.
bool write_finished(const stock::Stock& stock, const CutOptions& options,
                    const stock::StockMetadata& metadata) {
  if (options.save_folder.empty()) return false;
  try {
    stock.save(options.save_folder + "/" + kFinishedStock, metadata);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Of a thread that may use the processor of another one while that waits, for the disk say.
class OtherThread {
 public:
  /// It has kept a processor for most of the time since this was asked last.
  bool is_working() {
    constexpr double kMost = 0.5;
    const auto now = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    const double passed_s = std::chrono::duration<double>(now - asked_).count();
    const double used_s = static_cast<double>(used - used_) / CLOCKS_PER_SEC;
    asked_ = now;
    used_ = used;
    return used_s > kMost * passed_s;
  }

 private:
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  std::clock_t used_ = std::clock();  ///< of the whole process: who asks has slept meanwhile
};

class CutStage {
 public:
  CutStage(const Job& job, const CutOptions& options, Progress& progress, Result& result)
      : job_(job),
        options_(options),
        progress_(progress),
        result_(result),
        outcome_(result.cut),
        parts_(job, *result.main.cycles, *result.main.carried),
        contacts_(job, result.main.contacts ? &*result.main.contacts : nullptr, *result.main.cycles,
                  sweeps_) {
    outcome_.state.clearance = clearance_.result();
    result_.sweep_bound_mm = std::max(sweeps_.error_bound_mm, carried_.stock.error_bound_mm);
    result_.merged_sweeps = sweeps_.size();
    if (options.spill && result.memory.peak_mb > result.memory.limit_mb) {
      budget_.emplace(job, parts_, result.memory, options.save_folder);
      result.memory.peak_mb = result.memory.limit_mb;
    }
    if (options.ranks != nullptr) tiles_.emplace(*options.ranks, parts_);
  }

  void run() {
    find_saves();
    make_stock();
    progress_.begin("cut", static_cast<double>(sweeps_.size()), "blocks");
    progress_.start_at(static_cast<double>(at_));
    save_due();
    while (at_ < sweeps_.size() && !may_stop()) cut_on();
    // mpirun that is stopped gives its ranks a second: no check and no report comes before what is cut.
    if (tiles_ && at_ < sweeps_.size() && keeps()) keep();
    if (at_ == sweeps_.size()) look_at_contacts();
    progress_.end();
    check_at_end();
    finish();
  }

 private:
  struct Save {
    size_t after;  ///< sweeps
    const ProgramPlace* place;
  };

  void find_saves() {
    for (const ProgramPlace& place : options_.save_after) {
      const size_t after = sweeps_until(place, sweeps_, *result_.main.cycles, job_.scene.tools);
      saves_.push_back({after, &place});
    }
    std::stable_sort(saves_.begin(), saves_.end(),
                     [](const Save& a, const Save& b) { return a.after < b.after; });
  }

  void make_stock() {
    begin_stock();
    if (!options_.resume_file.empty()) resume();
    finder_.emplace(*result_.stock);
    if (tiles_)
      tiles_->begin(*result_.stock,
                    {at_, at_ == 0 && carried_.empty(), may_go_ahead(options_), contacts_.due()});
    if (options_.check_voxels) checked_ = result_.stock->clone();
  }

  /// The raw body less what earlier set-ups have cut. Stopped on the way nothing of the program is cut, and a
  /// run that goes on begins here again.
  void begin_stock() {
    const StockSettings& settings = job_.scene.stock;
    result_.stock = std::make_unique<stock::Stock>(settings.body_W(), settings.voxel_mm,
                                                   budget_ ? &budget_->spill() : nullptr);
    result_.full_mm3 = full_mm3_ = result_.stock->volume_mm3();
    if (!carried_.empty()) {
      cut_carried(*result_.stock, carried_, &progress_);
      make_room();
      full_mm3_ = result_.stock->volume_mm3();
    }
    if (tiles_ && options_.resume_file.empty() && carried_.empty()) tiles_->call_together();
    result_.start_hash = result_.stock->hash();
  }

  void resume() {
    const stock::RawShape raw = job_.scene.stock.body_W();
    result_.stock.reset();
    result_.stock =
        std::make_unique<stock::Stock>(load_in_process(options_.resume_file, identity_, raw, outcome_.state));
    if (budget_) result_.stock->begin_spill(budget_->spill());
    at_ = outcome_.resumed_from = outcome_.state.sweeps;
    make_room();
    if (at_ > 0) {
      clearance_.resume(outcome_.state.clearance);
      bad_cuts_.resume(outcome_.state.bad_cuts);
      if (!contacts_.resume(outcome_.state.stock_contacts, at_)) throw not_resumable(options_.resume_file);
    } else {
      outcome_.state.clearance = clearance_.result();
      if (!carried_.empty()) begin_stock();
    }
    for (const Save& save : saves_) {
      if (save.after >= at_) continue;
      throw InputError("place-before-resume", {save.place->text},
                       fmt::format("the stock to go on from was cut up to line {}, {:.3f}s already",
                                   outcome_.state.place.line, outcome_.state.place.t_s),
                       "save after a later place, or run from the start");
    }
  }

  /// Cuts up to the next place where something is due, and does it. The looks ahead follow the program's own
  /// batches, so that they do not depend on where the run began or what it saves.
  void cut_on() {
    const size_t total = sweeps_.size();
    look_at_contacts();
    if (at_ >= batch().end) begin_batch();
    const size_t before = at_;
    size_t end = std::min({batch().end, after_suspects(kSuspectsPerStep), parts_.check_end(at_), total});
    if (budget_) end = std::min(end, next_multiple(at_, LeafBudget::kSweepsPerStep));
    end = std::min(end, contacts_.due());
    if (options_.record) end = std::min(end, next_multiple(at_, options_.record_every));
    if (next_save_ < saves_.size() && saves_[next_save_].after > at_) {
      end = std::min(end, saves_[next_save_].after);
    }
    while (at_ < end) cut_to(std::min(end, next_suspect()));
    make_room();
    if (at_ == batch().end) end_batch();
    progress_.advance(static_cast<double>(at_));
    if (parts_.is_check_due(before, at_)) check_on_the_way();
    if (options_.record && (at_ % options_.record_every == 0 || at_ == total)) {
      record_.states.push_back(whole().hash());
    }
    save_due();
    keep_due();
  }

  void make_room() {
    if (budget_) budget_->make_room(*result_.stock, at_);
  }

  /// Links and fixtures where they come to the raw stock.
  void look_at_contacts() {
    while (contacts_.due() <= at_) contacts_.look(whole());
  }

  BatchState& batch() { return outcome_.state.batch; }

  /// Which sweeps of the batch are clear of the stock as it stands now, and so of all that is left of it.
  void begin_batch() {
    const size_t end = parts_.batch_end(at_);
    if (tiles_) {
      batch() = tiles_->look_ahead(at_, end);
      if (batch().suspects.empty() && batch().bad_suspects.empty()) return;
      whole();
      finder_->refresh();  // for those that are judged
      return;
    }
    finder_->refresh();
    ToolClearanceCheck::Outlook outlook = clearance_.look_ahead(*finder_, at_, end);
    batch() = {end, outlook.nearest_mm, std::move(outlook.suspects),
               bad_cuts_.look_ahead(*finder_, at_, end)};
  }
  void end_batch() {
    clearance_.saw(batch().nearest_mm);
    outcome_.state.clearance = clearance_.result();
    batch() = {};
  }

  /// The first suspect from at_ on; none: far away.
  size_t next_suspect() {
    size_t next = std::numeric_limits<size_t>::max();
    for (const std::vector<size_t>* suspects : {&batch().suspects, &batch().bad_suspects}) {
      const auto first = std::lower_bound(suspects->begin(), suspects->end(), at_);
      if (first != suspects->end()) next = std::min(next, *first);
    }
    return next;
  }
  /// Behind so many suspects from at_ on.
  size_t after_suspects(size_t count) {
    size_t after = std::numeric_limits<size_t>::max();
    for (const std::vector<size_t>* suspects : {&batch().suspects, &batch().bad_suspects}) {
      const auto first = std::lower_bound(suspects->begin(), suspects->end(), at_);
      if (static_cast<size_t>(suspects->end() - first) >= count)
        after = std::min(after, *(first + static_cast<ptrdiff_t>(count) - 1) + 1);
    }
    return after;
  }

  /// Cuts sweeps up to `end`, where a suspect may stand: then that one is judged and cut too.
  void cut_to(size_t end) {
    if (end > at_) {
      cut(at_, end);
      at_ = end;
      return;
    }
    whole();
    const auto is_in = [&](const std::vector<size_t>& suspects) {
      return std::binary_search(suspects.begin(), suspects.end(), at_);
    };
    const bool tool_meets = is_in(batch().suspects);
    if (tool_meets) clearance_.judge_before(*finder_, at_);
    if (is_in(batch().bad_suspects)) bad_cuts_.judge(*finder_, at_);
    cut(at_, at_ + 1);
    if (tool_meets) {
      whole();
      clearance_.judge_after(*finder_, at_);
    }
    ++at_;
  }

  void cut(size_t begin, size_t end) {
    if (tiles_) {
      tiles_->cut(begin, end);
    } else {
      parts_.cut(*result_.stock, begin, end);
    }
  }
  /// The stock as all ranks have cut it.
  const stock::Stock& whole() {
    if (tiles_) tiles_->gather();
    return *result_.stock;
  }

  /// The other ranks may have cut more than this one: the whole stock is there when this one comes to where
  /// they stop.
  bool is_even() {
    if (!tiles_) return true;
    if (!even_at_) even_at_ = tiles_->hold();
    return at_ >= *even_at_;
  }
  bool may_stop() { return progress_.stop_requested() && is_even(); }

  CutState state() const {
    CutState state = outcome_.state;
    state.sweeps = at_;
    state.clearance = clearance_.result();
    state.clearance.checked_sweeps = at_;
    state.bad_cuts = bad_cuts_.result();
    state.stock_contacts = contacts_.text();
    if (at_ > 0) state.place = place(at_ - 1);
    return state;
  }
  CutPlace place(size_t sweep) const { return place_of(sweeps_, sweep, result_.main.path.elements, reader_); }

  void save_due() {
    for (; next_save_ < saves_.size() && saves_[next_save_].after <= at_; ++next_save_) {
      const std::string name = saved_stock_name(*saves_[next_save_].place);
      whole().save(options_.save_folder + "/" + name, cut_metadata(job_.scene.name, identity_, state()));
      outcome_.saved.push_back(name);
    }
  }

  bool keeps() const { return options_.keep_every_s > 0.0 && !options_.save_folder.empty(); }
  void keep_due() {
    const auto now = std::chrono::steady_clock::now();
    if (!keeps() || std::chrono::duration<double>(now - kept_at_).count() < options_.keep_every_s) return;
    if (!is_even()) return;
    keep();
    if (tiles_ && may_go_ahead(options_)) tiles_->go_ahead();
    even_at_.reset();
  }
  void keep() {
    const std::string path = options_.save_folder + "/" + kKeptStock;
    whole().save(path, cut_metadata(job_.scene.name, identity_, state()));
    if (!is_kept_) progress_.note(fmt::format("the stock so far is kept in {}", path));
    is_kept_ = true;
    kept_at_ = std::chrono::steady_clock::now();
  }

  void check_on_the_way() {
    if (options_.check_voxels) {
      ++outcome_.voxel_checks;
      std::string broken = whole().check();
      if (broken.empty()) broken = result_.stock->check_since(*checked_);
      checked_ = result_.stock->clone();
      tell(broken);
      return;
    }
    // Other ranks look at their own tiles, and have looked at those that this one has taken since.
    ++outcome_.map_checks;
    if (tiles_ && at_ <= tiles_->own_from()) return;
    tell(result_.stock->check(tiles_ ? stock::CheckLevel::kOwnMap : stock::CheckLevel::kMap));
  }

  /// Together with the proof of the volume where other ranks share both: they are sent the same leaves.
  void check_at_end() {
    ++outcome_.voxel_checks;
    const stock::Stock& stock = whole();
    outcome_.state = state();
    outcome_.metadata = cut_metadata(job_.scene.name, identity_, outcome_.state);
    if (tiles_) {
      prove_by_ranks(stock);
    } else {
      tell(stock.check());
      result_.volume_left_mm3 = stock.volume_mm3();
    }
    if (checked_) tell(stock.check_since(*checked_));
    checked_.reset();
  }

  /// Meanwhile this one checks and writes what it alone has: a rank of one thread only deals as long as that
  /// needs its processor.
  void prove_by_ranks(const stock::Stock& stock) {
    std::string broken;
    std::future<void> own = std::async(std::launch::async, [&] {
      broken = stock.check(stock::CheckLevel::kLeaves);
      stock.hash();  // is kept for the metrics
      outcome_.is_written = write_finished(stock, options_, outcome_.metadata);
    });
    OtherThread other;
    const stock::StockProof proof = tiles_->prove(result_.sweep_bound_mm, [&] {
      return thread_count() == 1 && own.wait_for(std::chrono::seconds(0)) != std::future_status::ready &&
             other.is_working();
    });
    own.get();
    result_.volume_left_mm3 = proof.volume_mm3;
    result_.volume_range = proof.range;
    tell(tiles_->broken());
    tell(broken);
    tell(proof.broken_step);
  }

  /// The first broken invariant is kept; the run goes on and reports it. "": all hold.
  void tell(const std::string& broken) {
    if (broken.empty() || !outcome_.broken_invariant.empty()) return;
    outcome_.broken_invariant = fmt::format("{} (after {} of {} sweeps, line {}, {:.3f}s)", broken, at_,
                                            sweeps_.size(), state().place.line, state().place.t_s);
  }

  void finish() {
    result_.clearance = outcome_.state.clearance;
    if (result_.main.contacts) result_.main.contacts->as_cut = contacts_.result();
    if (budget_)
      progress_.note(fmt::format("{} of {} leaves of the stock ended on the disk",
                                 result_.stock->leaves_on_disk(), result_.stock->leaves()));
    result_.volume_removed_mm3 = full_mm3_ - result_.volume_left_mm3;
    if (options_.record) write_states();
  }

  void write_states() {
    record_.scene = job_.scene.file;
    record_.overrides = options_.overrides;
    record_.identity = identity_;
    record_.every = options_.record_every;
    record_.program_sweeps = sweeps_.size();
    record_.sweeps = sweeps_.part(0, at_);
    for (size_t n = 0; n < at_; ++n) {
      record_.places.push_back(place(n));
      record_.tools.push_back(sweeps_.tool(n));
    }
    // A stopped run ends between two hashes.
    if (record_.states.size() * record_.every < at_) record_.states.push_back(whole().hash());
    write_record(options_.save_folder + "/" + kRecordFile, record_);
  }

  const Job& job_;
  const CutOptions& options_;
  Progress& progress_;
  Result& result_;
  CutOutcome& outcome_;
  CutParts parts_;
  const CutSweeps& sweeps_ = parts_.sweeps;
  const CarriedCuts& carried_ = parts_.carried;
  const CutIdentity& identity_ = parts_.identity;
  ToolClearanceCheck& clearance_ = parts_.clearance;
  BadCutCheck& bad_cuts_ = parts_.bad_cuts;
  mutable motion::CycleReader reader_{*result_.main.cycles};
  std::optional<stock::ContactFinder> finder_;
  std::optional<TileLead> tiles_;     ///< none: this process cuts alone
  std::optional<LeafBudget> budget_;  ///< none: all leaves stay in memory
  StockContactCheck contacts_;
  std::vector<Save> saves_;
  size_t next_save_ = 0, at_ = 0;
  double full_mm3_ = 0.0;                ///< before the first sweep of the program
  std::optional<stock::Stock> checked_;  ///< the state at the last check
  std::optional<size_t> even_at_;        ///< sweeps at which no rank is ahead; none: they may be
  std::chrono::steady_clock::time_point kept_at_ = std::chrono::steady_clock::now();
  bool is_kept_ = false;
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

void leave_uncut(const Job& job, const CutOptions& options, Result& result) {
  CutOutcome& outcome = result.cut;
  if (options.resume_file.empty()) {
    const StockSettings& settings = job.scene.stock;
    const stock::Spill spill{options.save_folder};
    result.stock = std::make_unique<stock::Stock>(settings.body_W(), settings.voxel_mm,
                                                  options.spill ? &spill : nullptr);
    outcome.metadata = cut_metadata(job.scene.name, cut_identity(job, {}, *result.main.carried), {});
    return;
  }
  result.stock =
      std::make_unique<stock::Stock>(load_unchecked(options.resume_file, outcome.metadata, outcome.state));
  outcome.resumed_from = outcome.state.sweeps;
}

}  // namespace swarf::sim

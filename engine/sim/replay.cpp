#include "sim/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/diagnostics.h"
#include "sim/simulation.h"

namespace swarf::sim {
namespace {

bool same_pose(const ToolPose& a, const ToolPose& b) {
  return a.tip_W == b.tip_W && a.axis_W == b.axis_W;
}
bool same_sweep(const stock::Sweep& a, const stock::Sweep& b) {
  return same_pose(a.start, b.start) && same_pose(a.end, b.end);
}

class Replay {
 public:
  Replay(const CutRecord& record, const Job& job, Progress& progress)
      : record_(record),
        progress_(progress),
        path_(move_tool(job, progress)),
        sweeps_(cut_sweeps(job, *path_.cycles)),
        solids_(tool_solids(job.scene)),
        stock_(starting_stock(job, *path_.carried, job.scene.stock.voxel_mm)) {
    result_.parts = differences(record.identity, cut_identity(job, sweeps_, *path_.carried));
  }

  ReplayResult run() {
    require_same_grid();
    const size_t other = first_other_motion();
    const bool stopped = record_.sweeps.size() < record_.program_sweeps;
    length_ = stopped ? record_.sweeps.size() : std::max(record_.sweeps.size(), sweeps_.size());
    result_.same_motion = other == length_;
    progress_.begin("replay", static_cast<double>(length_), "blocks");
    if (compare_states(other) && !result_.same_motion) compare_sweeps(other);
    result_.stopped = progress_.stop_requested();
    progress_.end();
    return std::move(result_);
  }

 private:
  void require_same_grid() const {
    Diagnostics diagnostics;
    for (const IdentityDifference& part : result_.parts) {
      if (!needed_to_compare(part.name)) continue;
      diagnostics.error("record-other-stock", {},
                        fmt::format("the recorded run has another {}: {}; the scene has {}", part.name,
                                    part.before, part.now),
                        "name a scene with the same box, voxel size and cutter, or record again");
    }
    diagnostics.throw_if_errors();
  }

  /// The first sweep that differs, by its poses or its tool, or that one of them lacks.
  size_t first_other_motion() const {
    const size_t count = std::min(record_.sweeps.size(), sweeps_.size());
    size_t n = 0;
    while (n < count && same_sweep(record_.sweeps[n], sweeps_[n]) && record_.tools[n] == sweeps_.tool(n)) ++n;
    return n;
  }

  void cut(size_t begin, size_t end) {
    sweeps_.for_each_tool(begin, end, [&](size_t tool, std::span<const stock::Sweep> part) {
      stock_.cut(part, solids_[tool]);
    });
    progress_.advance(static_cast<double>(end));
  }

  /// Cuts the common motion, comparing every hash; leaves the stock cut up to `other`. False: a difference
  /// was found, or the user stopped.
  bool compare_states(size_t other) {
    for (size_t at = 0; at < other;) {
      if (progress_.stop_requested()) return false;
      const size_t end = std::min((at / record_.every + 1) * record_.every, other);
      cut(at, end);
      const bool recorded = end % record_.every == 0 || end == record_.sweeps.size();
      if (recorded && stock_.hash() != record_.states[(end - 1) / record_.every]) {
        result_.difference = {end - at == 1, at, end - 1, record_.places[end - 1], place(end - 1)};
        return false;
      }
      result_.states += recorded ? 1 : 0;
      result_.sweeps = at = end;
    }
    return true;
  }

  /// Both paths from the first other motion on, one sweep at a time, as far as both are known.
  void compare_sweeps(size_t other) {
    stock::Stock recorded = stock_.clone();
    for (size_t n = other; n < length_ && !progress_.stop_requested(); ++n) {
      if (n < record_.sweeps.size()) {
        const auto tool = static_cast<size_t>(record_.tools[n]);
        recorded.cut(std::span(record_.sweeps).subspan(n, 1), solids_.at(tool));
      }
      if (n < sweeps_.size()) cut(n, n + 1);
      result_.sweeps = n + 1;
      ++result_.states;
      if (recorded.hash() == stock_.hash()) continue;
      result_.difference = {true, n, n, record_.places[std::min(n, record_.places.size() - 1)],
                            place(std::min(n, sweeps_.size() - 1))};
      return;
    }
  }

  CutPlace place(size_t n) const { return place_of(sweeps_, n, path_.path.elements, reader_); }

  const CutRecord& record_;
  Progress& progress_;
  MeasuredPath path_;
  mutable motion::CycleReader reader_{*path_.cycles};
  CutSweeps sweeps_;
  std::vector<stock::CutterSolid> solids_;  ///< by tool
  stock::Stock stock_;
  size_t length_ = 0;  ///< sweeps to compare: a stopped run only as far as it went
  ReplayResult result_;
};

}  // namespace

ReplayResult replay(const CutRecord& record, const Job& job, Progress& progress) {
  return Replay(record, job, progress).run();
}

}  // namespace swarf::sim

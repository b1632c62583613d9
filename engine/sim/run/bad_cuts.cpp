#include "sim/run/bad_cuts.h"

#include <algorithm>
#include <variant>

#include "base/parallel.h"

namespace swarf::sim {
namespace {

using toolpath::BlockMove;

constexpr size_t kSweepsPerTask = 16;

std::optional<BadCutKind> kind_of(const BlockMove& block, const std::vector<cutter::Cutter>& tools) {
  if (toolpath::is_rapid(block)) return BadCutKind::kRapid;
  if (!block.spindle_rpm) return std::nullopt;
  if (*block.spindle_rpm == 0.0) return BadCutKind::kSpindleStands;
  const bool counter_clockwise = *block.spindle_rpm < 0.0;
  const bool right = counter_clockwise == tools[static_cast<size_t>(block.tool)].left_hand;
  return right ? std::nullopt : std::optional(BadCutKind::kSpindleReversed);
}

std::optional<BadCutKind> kind_of(const toolpath::Elements& elements, size_t i,
                                  const std::vector<cutter::Cutter>& tools) {
  if (elements.hold_blocks()) return kind_of(elements.block(i), tools);
  const toolpath::Element element = elements[i];
  const auto* free = std::get_if<toolpath::FreeMove>(&element.what);
  return free != nullptr && free->feed_mm_s == 0.0 ? std::optional(BadCutKind::kRapid) : std::nullopt;
}

ToolPose pose_at(const stock::Sweep& sweep, double t) {
  return {(1.0 - t) * sweep.start.tip_W + t * sweep.end.tip_W,
          ((1.0 - t) * sweep.start.axis_W + t * sweep.end.axis_W).normalized()};
}

stock::Sweep share(const stock::Sweep& sweep, double from_t, double to_t) {
  return {from_t <= 0.0 ? sweep.start : pose_at(sweep, from_t),
          to_t >= 1.0 ? sweep.end : pose_at(sweep, to_t), sweep.block};
}

}  // namespace

BadCutCheck::BadCutCheck(const Job& job, const motion::Cycles& cycles, const CutSweeps& sweeps,
                         const SweepPlaces& places, const EarlierCuts& earlier)
    : sweeps_(sweeps),
      places_(places),
      ahead_(sweeps, cycles),
      earlier_(earlier),
      by_element_(cycles.elements().hold_blocks()) {
  for (const cutter::Cutter& tool : job.scene.tools) {
    flutes_.emplace_back(tool);
    parts_.emplace_back();
    for (const cutter::ConvexPiece& piece : flutes_.back().pieces) parts_.back().emplace_back(piece);
  }
  const toolpath::Elements& elements = cycles.elements();
  elements_ = static_cast<int>(elements.size());
  for (int i = 0; i < elements_; ++i) {
    const auto kind = kind_of(elements, static_cast<size_t>(i), job.scene.tools);
    if (rows_.empty() || rows_.back().kind != kind) rows_.push_back({i, kind});
  }
}

size_t BadCutCheck::row_of(int element) const {
  const auto after = std::upper_bound(rows_.begin(), rows_.end(), element,
                                      [](int sought, const Row& row) { return sought < row.first; });
  return static_cast<size_t>(after - rows_.begin()) - 1;
}

std::vector<BadCutCheck::Move> BadCutCheck::moves(size_t sweep, const SweepPlaces& places) const {
  if (by_element_) {
    const size_t row = row_of(source(sweep).element);
    if (!rows_[row].kind) return {};
    return {{0.0, 1.0, *rows_[row].kind, row}};
  }
  std::vector<Move> moves;
  const SweepPlaces::Range range = places.cycles(sweep);
  double from_t = 0.0;
  for (size_t k = range.first + 1; k <= range.last; ++k) {
    const double to_t = k == range.last ? 1.0 : places.progress(sweep, k);
    const size_t row = row_of(places.cycle(k).sample.element);
    const std::optional<BadCutKind>& kind = rows_[row].kind;
    if (kind && !moves.empty() && moves.back().to_t == from_t) {
      moves.back().to_t = to_t;
    } else if (kind) {
      moves.push_back({from_t, to_t, *kind, row});
    }
    from_t = to_t;
  }
  return moves;
}

bool BadCutCheck::wanted(const Move& move) const {
  if (move.kind == BadCutKind::kRapid) return true;
  return std::none_of(found_.begin(), found_.end(),
                      [&](const BadCut& cut) { return row_of(cut.event.first.element) == move.row; });
}

std::vector<size_t> BadCutCheck::look_ahead(const stock::ContactFinder& finder, size_t begin,
                                            size_t end) const {
  std::vector<std::vector<Move>> moves_of;  // reading cycles is for one thread
  for (size_t sweep = begin; sweep < end; ++sweep) moves_of.push_back(moves(sweep, ahead_));
  std::vector<uint8_t> meets(end - begin, 0);
  parallel_chunks(meets.size(), kSweepsPerTask, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      for (const Move& move : moves_of[i]) {
        if (meets[i] != 0 || !wanted(move)) continue;
        const stock::SweepMap map = stock::sweep_map(share(sweeps_[begin + i], move.from_t, move.to_t));
        for (const stock::RevolvedPart& part : parts_[static_cast<size_t>(source(begin + i).tool)]) {
          if (finder.gap(map, part, -finder.deep_mm()) < -finder.deep_mm() ||
              finder.may_be_shallow(map, part, 0.0))
            meets[i] = 1;
        }
      }
    }
  });
  std::vector<size_t> suspects;
  for (size_t i = 0; i < meets.size(); ++i)
    if (meets[i] != 0) suspects.push_back(begin + i);
  return suspects;
}

std::optional<stock::Contact> BadCutCheck::contact(const stock::ContactFinder& finder, size_t sweep,
                                                   const Move& move) const {
  const stock::Sweep whole = sweeps_[sweep];
  const auto tool = static_cast<size_t>(source(sweep).tool);
  const stock::SweepMap map = stock::sweep_map(share(whole, move.from_t, move.to_t));
  const stock::OwnCut before{&flutes_[tool], stock::sweep_map(share(whole, 0.0, move.from_t)), false};
  std::optional<stock::Contact> found;
  for (const stock::RevolvedPart& part : parts_[tool]) {
    const stock::OwnCut* const own = move.from_t > 0.0 ? &before : nullptr;
    auto one = finder.contact(map, part, own);
    if (!one && finder.may_be_shallow(map, part, 0.0))
      one = finder.shallow_contact(map, part, own, earlier_.before(sweep));
    if (!one) continue;
    if (!found) found = one;
    found->first_t = std::min(found->first_t, one->first_t);
    found->last_t = std::max(found->last_t, one->last_t);
    if (one->depth_mm <= found->depth_mm) continue;
    found->depth_mm = one->depth_mm;
    found->deepest_t = one->deepest_t;
    found->place_W = one->place_W;
  }
  if (!found) return found;
  for (double* t : {&found->first_t, &found->last_t, &found->deepest_t})
    *t = move.from_t + *t * (move.to_t - move.from_t);
  return found;
}

void BadCutCheck::judge(const stock::ContactFinder& finder, size_t sweep) {
  for (const Move& move : moves(sweep, places_)) {
    if (!wanted(move)) continue;
    const std::optional<stock::Contact> contact = this->contact(finder, sweep, move);
    if (contact) add({move.kind, event_of("flutes", source(sweep).tool, *contact, places_, sweep)}, move.row);
  }
}

int BadCutCheck::last_of_row(size_t row) const {
  return (row + 1 < rows_.size() ? rows_[row + 1].first : elements_) - 1;
}

void BadCutCheck::add(BadCut cut, size_t row) {
  if (cut.kind != BadCutKind::kRapid) {
    cut.event.last_element = last_of_row(row);
  } else if (!found_.empty() && found_.back().kind == cut.kind && goes_on(found_.back().event, cut.event)) {
    join(found_.back().event, cut.event);
    return;
  }
  found_.push_back(std::move(cut));
}

}  // namespace swarf::sim

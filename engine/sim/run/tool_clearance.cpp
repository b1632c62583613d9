#include "sim/run/tool_clearance.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "cutter/tool_walls.h"

namespace swarf::sim {
namespace {

constexpr double kBandVoxels = 3.0;  // half width of the level set
constexpr size_t kClearedPerTask = 16;

/// The sweeps follow the motion within a bound as far up as the flutes reach; a turn takes the tool's far end
/// away from it in the ratio of the levers.
double bound_at_far_end_mm(std::span<const cutter::Cutter> tools, const CutSweeps& sweeps) {
  double ratio = 1.0;
  for (const cutter::Cutter& tool : tools) {
    for (const cutter::ToolWall& wall : cutter::tool_walls(tool)) {
      const double lever = std::hypot(std::max(wall.low_radius, wall.high_radius), wall.high);
      ratio = std::max(ratio, lever / tool.flute_length_mm);
    }
  }
  return ratio * sweeps.error_bound_mm;
}

}  // namespace

std::vector<ToolPart> tool_parts(const cutter::Cutter& cutter) {
  std::vector<ToolPart> parts;
  for (const cutter::ToolWall& wall : cutter::tool_walls(cutter)) {
    parts.push_back(
        {wall.part, stock::RevolvedPart::frustum(wall.low, wall.high, wall.low_radius, wall.high_radius)});
  }
  return parts;
}

ToolClearanceCheck::ToolClearanceCheck(std::span<const cutter::Cutter> tools, const CutSweeps& sweeps,
                                       const SweepPlaces& places, const EarlierCuts& earlier, double voxel_mm)
    : sweeps_(sweeps), places_(places), earlier_(earlier) {
  for (const cutter::Cutter& tool : tools) {
    parts_.push_back(tool_parts(tool));
    flutes_.emplace_back(tool);
  }
  result_.band_mm = kBandVoxels * voxel_mm;
  result_.nearest_mm = result_.band_mm;
  result_.sees_mm = voxel_mm + bound_at_far_end_mm(tools, sweeps) + earlier.carried_bound_mm();
}

ToolClearanceCheck::Outlook ToolClearanceCheck::look_ahead(const stock::ContactFinder& finder, size_t begin,
                                                           size_t end,
                                                           std::span<const size_t> known_suspects) const {
  std::vector<double> gaps(end - begin);
  std::vector<uint8_t> hinted(end - begin, 0);
  const std::vector<stock::Sweep> ahead = sweeps_.part(begin, end);
  parallel_chunks(gaps.size(), kClearedPerTask, [&](size_t from, size_t to) {
    double least = result_.band_mm;  // what is farther than a gap seen need not be known
    for (size_t i = from; i < to; ++i) {
      const stock::SweepMap map = stock::sweep_map(ahead[i]);
      gaps[i] = least;
      if (std::binary_search(known_suspects.begin(), known_suspects.end(), begin + i)) continue;
      for (const ToolPart& part : parts_[tool_of(begin + i)]) {
        gaps[i] = std::min(gaps[i], finder.gap(map, part.body, gaps[i]));
        // The gap is only known up to the least seen: the hint looks for itself.
        if (hinted[i] == 0 && finder.may_be_shallow(map, part.body, 0.0)) hinted[i] = 1;
      }
      if (gaps[i] > -finder.deep_mm()) least = gaps[i];
    }
  });
  Outlook outlook{{}, result_.band_mm};
  for (size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i] < -finder.deep_mm() || hinted[i] != 0) {
      outlook.suspects.push_back(begin + i);
    } else {
      outlook.nearest_mm = std::min(outlook.nearest_mm, gaps[i]);
    }
  }
  return outlook;
}

void ToolClearanceCheck::saw(double gap_mm) {
  result_.nearest_mm = std::min(result_.nearest_mm, std::max(0.0, gap_mm));
}

void ToolClearanceCheck::judge_before(const stock::ContactFinder& finder, size_t sweep) {
  const size_t tool = tool_of(sweep);
  const stock::SweepMap map = stock::sweep_map(sweeps_[sweep]);
  const stock::OwnCut own{&flutes_[tool], map, true};
  free_.clear();
  for (const ToolPart& part : parts_[tool]) {
    const double gap = finder.gap(map, part.body, result_.nearest_mm);
    if (gap >= -finder.deep_mm()) {
      if (!shallow(finder, sweep, part, gap)) saw(gap);
    } else if (const auto contact = finder.contact(map, part.body, &own)) {
      add(event_of(part.name, static_cast<int>(tool), *contact, places_, sweep));
    } else if (!shallow(finder, sweep, part, gap)) {
      free_.push_back(&part.body);
    }
  }
}

bool ToolClearanceCheck::shallow(const stock::ContactFinder& finder, size_t sweep, const ToolPart& part,
                                 double gap) {
  const size_t tool = tool_of(sweep);
  const stock::SweepMap map = stock::sweep_map(sweeps_[sweep]);
  if (!finder.may_be_shallow(map, part.body, gap)) return false;
  const stock::OwnCut own{&flutes_[tool], map, true};
  const auto contact = finder.shallow_contact(map, part.body, &own, earlier_.before(sweep));
  if (contact) add(event_of(part.name, static_cast<int>(tool), *contact, places_, sweep));
  return contact.has_value();
}

void ToolClearanceCheck::judge_after(const stock::ContactFinder& finder, size_t sweep) {
  const stock::SweepMap map = stock::sweep_map(sweeps_[sweep]);
  for (const stock::RevolvedPart* part : free_) saw(finder.gap(map, *part, result_.nearest_mm));
}

void ToolClearanceCheck::add(const ContactEvent& event) {
  saw(0.0);
  // Each part has a row of its own: the last one of this part.
  const auto last = std::find_if(result_.events.rbegin(), result_.events.rend(),
                                 [&](const ContactEvent& e) { return e.part == event.part; });
  if (last != result_.events.rend() && goes_on(*last, event)) {
    join(*last, event);
  } else {
    result_.events.push_back(event);
  }
}

}  // namespace swarf::sim

#include "sim/judge/finding_groups.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string_view>
#include <tuple>
#include <utility>

namespace swarf::sim {
namespace {

int last_line_of(const Finding& finding) {
  return std::max(finding.where.line, finding.line_last);
}

/// Sets of numbers that are joined; the smallest of a set stands for it.
class Sets {
 public:
  explicit Sets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), size_t{0}); }
  size_t of(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(size_t a, size_t b) {
    a = of(a), b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<size_t> parent_;
};

using Members = std::vector<size_t>;

void join_places(std::span<const Finding> findings, const Members& alike, Sets& sets) {
  for (size_t i = 0; i < alike.size(); ++i) {
    const Finding& a = findings[alike[i]];
    if (!a.place_W) continue;
    for (size_t j = 0; j < i; ++j) {
      const Finding& b = findings[alike[j]];
      if (b.place_W && (*a.place_W - *b.place_W).norm() <= std::max(a.reach_mm, b.reach_mm))
        sets.join(alike[i], alike[j]);
    }
  }
}

void join_lines(std::span<const Finding> findings, Members alike, Sets& sets) {
  std::erase_if(alike, [&](size_t i) { return findings[i].place_W || findings[i].where.line == 0; });
  std::stable_sort(alike.begin(), alike.end(),
                   [&](size_t a, size_t b) { return findings[a].where.line < findings[b].where.line; });
  int reached = 0;
  for (size_t i = 0; i < alike.size(); ++i) {
    if (i > 0 && findings[alike[i]].where.line <= reached + kLinesApart + 1)
      sets.join(alike[i], alike[i - 1]);
    reached = std::max(reached, last_line_of(findings[alike[i]]));
  }
}

FindingGroup group_of(std::span<const Finding> findings, Members members) {
  FindingGroup group{std::move(members)};
  const auto worst = std::max_element(group.members.begin(), group.members.end(), [&](size_t a, size_t b) {
    return findings[a].amount_mm < findings[b].amount_mm;
  });
  std::rotate(group.members.begin(), worst, worst + 1);
  for (const size_t i : group.members) {
    const int line = findings[i].where.line;
    if (line == 0) continue;
    group.first_line = group.first_line == 0 ? line : std::min(group.first_line, line);
    group.last_line = std::max(group.last_line, last_line_of(findings[i]));
  }
  return group;
}

}  // namespace

int risk_of(const Finding& finding) {
  static constexpr std::array<std::pair<std::string_view, int>, 15> kRisks{{{"machine_parts", 5},
                                                                            {"rapids_in_material", 5},
                                                                            {"spindle_wrong", 5},
                                                                            {"collisions", 4},
                                                                            {"gouge", 3},
                                                                            {"excess", 3},
                                                                            {"uncut", 3},
                                                                            {"scallop", 3},
                                                                            {"flank_limit", 3},
                                                                            {"travel", 2},
                                                                            {"axis_speed", 2},
                                                                            {"driven_cycles", 2},
                                                                            {"stock_invariants", 1},
                                                                            {"stock_and_rays", 1},
                                                                            {"round_trip", 1}}};
  const auto found =
      std::find_if(kRisks.begin(), kRisks.end(), [&](const auto& one) { return one.first == finding.check; });
  const bool open = finding.code.ends_with("-not-proven");
  return found == kRisks.end() ? 0 : (open ? std::min(found->second, 1) : found->second);
}

std::vector<FindingGroup> group_findings(std::span<const Finding> findings) {
  using Key = std::tuple<std::string_view, Severity, std::string_view, std::string_view, std::string_view>;
  std::map<Key, Members> alike;
  for (size_t i = 0; i < findings.size(); ++i) {
    const Finding& f = findings[i];
    alike[{f.code, f.severity, f.check, f.cause, f.where.file}].push_back(i);
  }
  Sets sets(findings.size());
  for (const auto& [key, members] : alike) {
    join_places(findings, members, sets);
    join_lines(findings, members, sets);
  }
  std::map<size_t, Members> by_set;
  for (size_t i = 0; i < findings.size(); ++i) by_set[sets.of(i)].push_back(i);
  std::vector<FindingGroup> groups;
  for (auto& [first, members] : by_set) groups.push_back(group_of(findings, std::move(members)));
  const auto rank = [&](const FindingGroup& group) {
    const Finding& worst = findings[group.members.front()];
    return std::tuple(-static_cast<int>(worst.severity), -risk_of(worst), -worst.amount_mm);
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const FindingGroup& a, const FindingGroup& b) { return rank(a) < rank(b); });
  return groups;
}

}  // namespace swarf::sim

#include "sim/job/post_keys.h"

#include <cmath>

#include "base/units.h"

namespace swarf::sim {
namespace {

ClampingGrid read_grid(ConfigTable table) {
  ClampingGrid grid;
  const std::vector<double> step = table.numbers("step_mm", 3, std::vector<double>{10.0, 10.0, 10.0});
  const std::vector<double> count = table.numbers("count", 3, std::vector<double>{1.0, 1.0, 1.0});
  constexpr double kMost = 99.0;
  for (size_t i = 0; i < 3 && step.size() == 3 && count.size() == 3; ++i) {
    if (!(count[i] >= 1.0) || count[i] > kMost || count[i] != std::floor(count[i]))
      table.error("empty-grid", "count", "a grid of clamping positions has 1 to 99 of them along each axis",
                  "count = [9, 9, 3]");
    else
      grid.count.at(i) = static_cast<int>(count[i]);
    if (!(step[i] > 0.0))
      table.error("out-of-range", "step_mm", "the clamping positions are no distance apart",
                  "give the table's slots above 0 mm");
    grid.step_mm[static_cast<long>(i)] = step[i];
  }
  return grid;
}

}  // namespace

PostSettings read_post(ConfigTable table, size_t tools) {
  PostSettings post;
  post.post = table.text("words", post.post);
  if (table.has("tcp")) post.tcp = table.boolean("tcp");
  post.tolerance_mm = table.number("tolerance_um", kAboveZero, 10.0) * kMicrometre;
  post.axis_tolerance_rad = rad_from_deg(table.number("axis_tolerance_deg", kAboveZero, 0.1));
  const std::string routes = table.choice("routes", {"backtrack", "best"}, "");
  post.prefer = table.choice("prefer", {"time", "accuracy", "travel"}, "");
  post.best_routes = routes == "best" || !post.prefer.empty();
  if (routes == "backtrack" && !post.prefer.empty())
    table.error("prefer-of-backtracking", "prefer",
                "backtracking takes the first way that is free: it has nothing to choose by",
                "leave routes out, or write routes = \"best\"");
  post.unit = table.choice("unit", {"mm", "inch"}, "");
  post.planes = table.choice("planes", {"never", "cycles", "constant"}, "");
  post.clearance_mm = table.number("clearance_mm", kZeroOrMore, 0.0);
  if (table.has("clamping")) post.grid = read_grid(table.table("clamping"));
  if (table.has("tool_reach")) {
    ConfigTable reach = table.table("tool_reach");
    post.reach.step_mm = reach.number("step_mm", kAboveZero, post.reach.step_mm);
    post.reach.most_mm = reach.number("most_mm", kZeroOrMore, 0.0);
    post.reach.least_mm = reach.number("least_mm", {-1e4, 0.0}, 0.0);
  }
  post.written = table.text("written", "");
  if (table.has("extended_mm")) post.extended_mm = table.numbers("extended_mm", tools);
  return post;
}

}  // namespace swarf::sim

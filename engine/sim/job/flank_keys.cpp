#include "sim/job/flank_keys.h"

#include "base/units.h"

namespace swarf::sim {

FlankSettings read_flank(ConfigTable table, bool by_program) {
  FlankSettings settings;
  settings.where = table.where("placement");
  const std::string word = table.choice("placement", flank::placement_names(), "minimax");
  for (const flank::Placement one :
       {flank::Placement::kPublished, flank::Placement::kBalanced, flank::Placement::kMinimax})
    if (flank::placement_name(one) == word) settings.placement = one;
  flank::FlankMotion& motion = settings.motion;
  if (!by_program) {
    motion.feed_mm_s = mm_s_from_mm_min(table.number("feed_mm_min", kAboveZero));
    motion.chord_mm = table.number("chord_um", kAboveZero, um_from_mm(motion.chord_mm)) * kMicrometre;
    motion.spindle_rpm = table.number("spindle_rpm", kZeroOrMore, 0.0);
  }
  motion.on_curve = table.choice("path", {"blocks", "curve"}, "blocks") == "curve";
  motion.limit_mm = table.number("limit_um", kZeroOrMore, 0.0) * kMicrometre;
  motion.overrun_mm = table.number("overrun_mm", kAboveZero, motion.overrun_mm);
  motion.retract_mm = table.number("retract_mm", kAboveZero, motion.retract_mm);
  settings.tip_below_mm = table.number("tip_below_mm", {}, settings.tip_below_mm);
  constexpr int kMostPasses = 100;
  if (table.has("clearance_mm")) settings.clearance_mm = table.number("clearance_mm", kAboveZero);
  settings.best_tool = table.choice("tool", {"only", "best"}, "only") == "best";
  settings.all_machines = table.choice("machines", {"own", "all"}, "own") == "all";
  settings.depth_passes = table.integer("depth_passes", 1, kMostPasses, 1);
  return settings;
}

}  // namespace swarf::sim

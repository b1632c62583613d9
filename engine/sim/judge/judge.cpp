#include "sim/judge/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>

#include "base/units.h"
#include "cutter/cutter.h"
#include "sim/job/tool_words.h"
#include "sim/judge/limit_text.h"
#include "sim/judge/unlimited_excess.h"
#include "sim/judge/unlimited_gouge.h"
#include "sim/run/result.h"

namespace swarf::sim {
namespace {

using measure::SurfaceMetrics;

constexpr const char* kMicrometres = "um";
constexpr const char* kNoDesign = "no design";
/// Forward kinematics of the inverse's solution must lead back to within this, mm.
constexpr double kRoundTrip = 1e-9;

Check not_judged(std::string name, std::string subject, std::string reason) {
  Check check{std::move(name), std::move(subject)};
  check.what = check.subject;
  check.reason = std::move(reason);
  return check;
}

/// So many of what may not happen; `allowed` of [accept].
Check counted(std::string name, std::string subject, size_t count, int allowed) {
  Check check{std::move(name), std::move(subject)};
  check.limit = allowed;
  check.value = static_cast<double>(count);
  check.outcome = *check.value <= *check.limit ? Outcome::kHolds : Outcome::kFails;
  check.what = fmt::format("{}: {}, at most {}", check.subject, count, allowed);
  if (allowed > 0) check.reason = fmt::format("[accept] allows {}", allowed);
  return check;
}

/// Why a proof has no bound.
std::string unfinished_reason(const Job& job, const Result& result) {
  if (result.stopped) return "the run was stopped before the proof between the rays was finished";
  const double budget_s = job.scene.output.budget_s;
  return budget_s > 0.0 ? fmt::format("the time budget of {:g} s ended the proof", budget_s)
                        : "the proof between the rays was not finished";
}

/// A measure of the finished part against its limit of [accept]. `unfinished`: unfinished_reason().
Check measured(std::string name, std::string subject, std::optional<double> limit, double value,
               const std::optional<measure::Bound>& bound, const std::string& unfinished) {
  Check check{std::move(name), std::move(subject)};
  check.unit = kMicrometres;
  check.value = value;
  if (bound) check.bound = bound->um;
  const auto text = [&](double um) { return limit ? text_beside(um, *limit) : fmt::format("{:.3f}", um); };
  check.what = fmt::format("{} {} um", check.subject, text(value));
  if (check.bound) check.what += fmt::format(", proven below {} um", text(*check.bound));
  if (!limit) {
    check.reason = "no limit in [accept]";
    return check;
  }
  check.limit = limit;
  check.what += fmt::format(", at most {} um", limit_text(*limit));
  if (value > *limit) {
    check.outcome = Outcome::kFails;
  } else if (check.bound && *check.bound <= *limit) {
    check.outcome = Outcome::kHolds;
  } else {
    check.outcome = Outcome::kNotProven;
    check.reason = !check.bound ? fmt::format("not proven below {} um: {}", limit_text(*limit), unfinished)
                                : fmt::format(
                                      "not proven below {} um: proven {} um at "
                                      "({:.3f}, {:.3f}, {:.3f}) mm",
                                      limit_text(*limit), text(bound->um), bound->place.x(), bound->place.y(),
                                      bound->place.z());
  }
  return check;
}

/// A part that its stock cannot hold is never the finished one, and neither is one that is cut into deeply,
/// whether or not anybody has set a limit.
void judge_without_limit(const SurfaceMetrics& surface, Check& gouge) {
  if (gouge.outcome != Outcome::kNotJudged) return;
  const UnlimitedGouge what = unlimited_gouge(surface);
  if (what == UnlimitedGouge::kNone) return;
  gouge.outcome = Outcome::kFails;
  gouge.limit = what == UnlimitedGouge::kCut ? kGougeAllowed : kMissingAllowed;
  gouge.reason = fmt::format("without a limit in [accept] {:g} um are allowed", *gouge.limit);
  if (what == UnlimitedGouge::kCut) return;
  gouge.value = std::max(*gouge.value, surface.missing_max_um);
  gouge.what = fmt::format("{} {:.3f} um", gouge.subject, *gouge.value);
  gouge.reason = fmt::format("the stock lacks {:.3f} um of material that nobody has cut; {}",
                             surface.missing_max_um, gouge.reason);
}

/// Without a limit a part that stands far above its design is none, unless the job leaves material to another
/// one.
void judge_left_without_limit(const Job& job, const Result& result, Check& excess) {
  const AcceptLimits& accept = job.scene.accept;
  if (excess.outcome != Outcome::kNotJudged || accept.scallop_max_um) return;
  if (accept.roughing) {
    excess.reason = "roughing: material may be left";
    return;
  }
  const double left_um = highest_left(job, result).um;
  if (!(left_um > kExcessAllowed)) return;
  if (job.scene.stock.auto_box) {
    excess.reason = "the block is assumed around the path; --stock or stock.box_mm says the real one";
    return;
  }
  excess.outcome = Outcome::kFails;
  excess.limit = kExcessAllowed;
  excess.value = left_um;
  excess.what = fmt::format("{} {:.3f} um", excess.subject, left_um);
  excess.reason = fmt::format(
      "without a limit in [accept] {:g} um are allowed; accept.excess_max_um sets one, --roughing "
      "(accept.roughing) leaves material",
      kExcessAllowed);
}

/// A mesh has faces that the stock brings along: there only excess tells what is missing. A program of blocks
/// may leave a part of the design to others, unless a scallop limit says that it machines it.
Check reached_check(const Job& job, const Result& result) {
  constexpr const char* name = "uncut";
  constexpr const char* subject = "Measuring rays that no cut has reached";
  if (job.design_mesh)
    return not_judged(name, subject, "faces of a mesh may be the stock's own; accept.excess_max_um tells");
  if ((result.main.path.elements.hold_blocks() || job.driven) && !job.scene.accept.scallop_max_um)
    return not_judged(name, subject, "no scallop limit in [accept]");
  return counted(name, subject, result.main.surface.uncut_samples, 0);
}

void add_surface_checks(const Job& job, const Result& result, std::vector<Check>& checks) {
  constexpr const char* gouge = "Deepest gouge";
  constexpr const char* excess = "Highest material";
  constexpr const char* scallop = "Highest scallop";
  if (!job.has_design()) {
    checks.push_back(not_judged("gouge", gouge, kNoDesign));
    checks.push_back(not_judged("excess", excess, kNoDesign));
    checks.push_back(not_judged("scallop", scallop, kNoDesign));
    checks.push_back(not_judged("uncut", "Measuring rays that no cut has reached", kNoDesign));
    return;
  }
  const SurfaceMetrics& surface = result.main.surface;
  const AcceptLimits& accept = job.scene.accept;
  const std::string unfinished = unfinished_reason(job, result);
  Check deepest =
      measured("gouge", gouge, accept.gouge_max_um, surface.gouge_max_um, surface.gouge_bound, unfinished);
  if (deepest.outcome == Outcome::kFails && surface.gouge_block == stock::kUncut)
    deepest.reason = "the stock has no material there: nobody has cut it";
  judge_without_limit(surface, deepest);
  checks.push_back(std::move(deepest));
  Check highest = measured("excess", excess, accept.excess_max_um, surface.excess_max_um,
                           surface.excess_bound, unfinished);
  judge_left_without_limit(job, result, highest);
  checks.push_back(std::move(highest));
  checks.push_back(measured("scallop", scallop, accept.scallop_max_um, surface.scallop_max_um,
                            surface.scallop_bound, unfinished));
  checks.push_back(reached_check(job, result));
}

size_t count_bad_cuts(const Result& result, bool rapids) {
  const std::vector<BadCut>& cuts = result.cut.state.bad_cuts;
  return static_cast<size_t>(std::count_if(cuts.begin(), cuts.end(), [&](const BadCut& cut) {
    return (cut.kind == BadCutKind::kRapid) == rapids;
  }));
}

/// Feed moves, and those of them for which nobody says whether the spindle turns.
struct SpindleWords {
  size_t feeds = 0, silent = 0;
};

SpindleWords spindle_words(const toolpath::ToolPath& path) {
  SpindleWords words;
  if (!path.elements.hold_blocks()) return words;
  for (size_t i = 0; i < path.elements.size(); ++i) {
    const toolpath::BlockMove block = path.elements.block(i);
    if (toolpath::is_rapid(block)) continue;
    ++words.feeds;
    words.silent += block.spindle_rpm ? 0 : 1;
  }
  return words;
}

Check spindle_check(const Job& job, const Result& result) {
  constexpr const char* name = "spindle_wrong";
  constexpr const char* subject = "Cuts with the spindle stopped or turning the wrong way";
  if (!result.main.path.elements.hold_blocks())
    return not_judged(name, subject, "surface blocks do not switch the spindle");
  const SpindleWords words = spindle_words(result.main.path);
  Check check = counted(name, subject, count_bad_cuts(result, false), job.scene.accept.spindle_wrong);
  if (words.silent == 0 || check.outcome == Outcome::kFails) return check;
  check.outcome = Outcome::kNotJudged;
  check.what = subject;
  check.reason = words.silent == words.feeds
                     ? std::string("the program does not say when it turns")
                     : fmt::format("the program does not say whether it turns in {} of {} feed moves",
                                   words.silent, words.feeds);
  if (words.silent == words.feeds) check.value.reset();
  return check;
}

/// Whether each of the scene's tools moves in the path; all of them where nobody says.
std::vector<bool> tools_at_work(const Job& job, const toolpath::ToolPath& path) {
  const bool known = path.elements.hold_blocks();
  std::vector<bool> works(job.scene.tools.size(), !known);
  for (size_t i = 0; known && i < path.elements.size(); ++i) {
    const auto tool = static_cast<size_t>(path.elements.tool(i));
    if (tool < works.size()) works[tool] = true;
  }
  return works;
}

/// Of the tools at work, those that have nothing but flutes.
struct BareTools {
  size_t working = 0, bare = 0;
  std::string names{};  ///< "T2, T5"
};

BareTools bare_tools(const Job& job, const Result& result) {
  const std::vector<bool> works = tools_at_work(job, result.main.path);
  BareTools tools;
  for (size_t i = 0; i < works.size(); ++i) {
    if (!works[i]) continue;
    ++tools.working;
    if (!is_bare(job.scene.tools[i])) continue;
    ++tools.bare;
    tools.names += (tools.names.empty() ? "" : ", ") + cutter::call_name(job.scene.tools[i]);
  }
  return tools;
}

void add_tool_checks(const Job& job, const Result& result, std::vector<Check>& checks) {
  const AcceptLimits& accept = job.scene.accept;
  const std::string covers = fmt::format("contacts of {:.3f} mm and more{}", result.clearance.sees_mm,
                                         job.scene.stock.auto_box ? " with the block that is assumed" : "");
  const auto add = [&](Check check) {
    check.covers = covers;
    check.what += " (" + covers + ")";
    check.reason += check.reason.empty() ? "whole moves, each against the stock before it"
                                         : "; whole moves, each against the stock before it";
    checks.push_back(std::move(check));
  };
  const size_t rapids = count_bad_cuts(result, true);
  // A block that was laid around the path reaches where a real one may not.
  const auto assumed = [](size_t count) {
    return fmt::format(
        "the block is assumed around the path and {} meet it; --stock or stock.box_mm says the real one",
        count);
  };
  constexpr const char* collisions = "Neck, shank or holder in the stock";
  constexpr const char* rapid = "Rapid moves that remove material";
  const BareTools tools = bare_tools(job, result);
  const bool touches = !result.clearance.events.empty();
  if (job.scene.stock.auto_box && touches) {
    checks.push_back(not_judged("collisions", collisions, assumed(result.clearance.events.size())));
  } else if (tools.bare == tools.working && !touches) {
    checks.push_back(not_judged("collisions", collisions, "the tools have neither shank nor holder"));
  } else {
    Check check = counted("collisions", collisions, result.clearance.events.size(), accept.collisions);
    if (tools.bare > 0) {
      check.unseen = fmt::format("shank and holder of {} (none are known)", tools.names);
      check.reason += fmt::format("{}not looked at: {}", check.reason.empty() ? "" : "; ", check.unseen);
    }
    add(std::move(check));
  }
  if (job.scene.stock.auto_box && rapids > 0) {
    checks.push_back(not_judged("rapids_in_material", rapid, assumed(rapids)));
  } else {
    add(counted("rapids_in_material", rapid, rapids, accept.rapids_in_material));
  }
  checks.push_back(spindle_check(job, result));
}

size_t count_faults(const Result& result, std::string_view check) {
  const std::vector<motion::MotionFinding>& all = result.main.motion.findings;
  return static_cast<size_t>(std::count_if(all.begin(), all.end(), [&](const motion::MotionFinding& fault) {
    return fault.severity == Severity::kError && check_of(fault) == check;
  }));
}

/// What was left out, in words; "": nothing.
std::string not_looked_at(const Result& result) {
  const MachineContacts& contacts = *result.main.contacts;
  std::vector<std::string> names;
  for (const std::string& link : contacts.without_mesh) names.push_back(link + " (no mesh)");
  for (const collision::LeftOutPair& pair : contacts.findings.left_out) {
    const ContactBody &a = contacts.bodies[pair.a], &b = contacts.bodies[pair.b];
    const bool cuts = (a.kind == collision::BodyKind::kStock && b.kind == collision::BodyKind::kToolPart) ||
                      (b.kind == collision::BodyKind::kStock && a.kind == collision::BodyKind::kToolPart);
    const char* const why = pair.reason == collision::PairReason::kTouchesAtHome      ? "they overlap at home"
                            : pair.reason == collision::PairReason::kGuided           ? "one guides the other"
                            : pair.reason == collision::PairReason::kAllowed && !cuts ? "the scene allows it"
                                                                                      : nullptr;
    if (why != nullptr) names.push_back(fmt::format("{} with {} ({})", a.name, b.name, why));
  }
  const std::vector<int>& changes = contacts.findings.unseen_changes;
  if (!changes.empty()) {
    const int line = result.main.path.elements.line(static_cast<size_t>(changes.front()));
    names.push_back(
        fmt::format("the ways to {} tool changes (the first before line {})", changes.size(), line));
  }
  return names.empty() ? "" : fmt::format("; not looked at: {}", fmt::join(names, ", "));
}

/// Pairs of links that have no mesh, the first of them; "": all links have one.
std::string pairs_without_mesh(const MachineContacts& contacts) {
  constexpr size_t kNamed = 12;
  const std::vector<collision::NamePair>& pairs = contacts.without_mesh_pairs;
  std::vector<std::string> names;
  for (size_t i = 0; i < std::min(kNamed, pairs.size()); ++i)
    names.push_back(fmt::format("{} with {}", pairs[i].first, pairs[i].second));
  if (pairs.size() > kNamed) names.push_back(fmt::format("{} pairs more", pairs.size() - kNamed));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// How the stock was looked at; "": nothing comes to the raw one.
std::string stock_looks_text(const MachineContacts& contacts) {
  if (contacts.suspects.empty()) return "";
  if (!contacts.as_cut) return fmt::format("{} times at the raw stock; ", contacts.suspects.size());
  const StockContacts& stock = *contacts.as_cut;
  return fmt::format(
      "{} times at the raw stock, {} of them clear of what is left of it (gaps of {:.3f} mm and more are "
      "seen){}; ",
      stock.suspects, stock.count(StockVerdict::kClear), stock.seen_mm,
      stock.unseen ? ", not all could be looked at" : "");
}

Check machine_check(const Job& job, const Result& result) {
  constexpr const char* name = "machine_parts";
  constexpr const char* subject = "Contacts of machine, fixtures and tool";
  if (!result.main.contacts)
    return not_judged(name, subject, "the machine has no meshes: [[link]] mesh in machine.toml");
  const MachineContacts& contacts = *result.main.contacts;
  const std::string without_mesh = pairs_without_mesh(contacts);
  if (contacts.findings.pairs.empty())
    return not_judged(
        name, subject,
        without_mesh.empty()
            ? "no two bodies move against each other"
            : fmt::format("without [[link]] mesh in machine.toml nothing is known of {}", without_mesh));
  const bool assumed = job.scene.stock.auto_box;
  // With a block that is laid around the path a contact says nothing: a real one may not reach there.
  const uint64_t proven = contacts.contacts() + (assumed ? 0 : contacts.stock_contacts());
  const uint64_t open = contacts.stock_open() + (assumed ? contacts.stock_contacts() : 0);
  Check check = counted(name, subject, proven, job.scene.accept.machine_parts);
  if (proven + open > static_cast<uint64_t>(job.scene.accept.machine_parts) &&
      check.outcome == Outcome::kHolds) {
    check.outcome = assumed ? Outcome::kNotJudged : Outcome::kNotProven;
    check.reason = assumed ? fmt::format("{} contacts with a block that is assumed; ", open)
                           : fmt::format("{} times something is not proven to be clear of the stock; ", open);
  }
  check.reason += stock_looks_text(contacts);
  check.reason +=
      fmt::format("{} pairs over the whole motion{}", contacts.findings.pairs.size(), not_looked_at(result));
  check.unseen = without_mesh;
  return check;
}

Check invariants_check(const Result& result) {
  Check check{"stock_invariants", "Invariants of the level set"};
  const bool holds = result.cut.broken_invariant.empty();
  check.outcome = holds ? Outcome::kHolds : Outcome::kFails;
  check.what = holds ? fmt::format("{}: numbers 1 to 8 hold ({} checks of all, {} of 1 to 4 on the way)",
                                   check.subject, result.cut.voxel_checks, result.cut.map_checks)
                     : fmt::format("{}: broken, {}", check.subject, result.cut.broken_invariant);
  return check;
}

Check rays_check(const Job& job, const Result& result) {
  constexpr const char* name = "stock_and_rays";
  constexpr const char* subject = "Level set against measuring rays";
  if (!job.has_design()) return not_judged(name, subject, kNoDesign);
  if (job.design_mesh)
    return not_judged(name, subject, "the bound needs the curvature of a design surface, this is a mesh");
  if (!result.cross_check) return not_judged(name, subject, "no ray could be compared");
  const measure::CrossCheck& cross = *result.cross_check;
  Check check{name, subject};
  check.unit = kMicrometres;
  check.limit = cross.bound_um;
  check.value = cross.max_um;
  check.outcome = cross.holds ? Outcome::kHolds : Outcome::kFails;
  check.what = fmt::format("{}: differ by {:.2f} um, bound {:.2f} um ({} rays)", subject, cross.max_um,
                           cross.bound_um, cross.samples);
  if (cross.excluded > 0)
    check.reason =
        fmt::format("{} rays cannot be compared: uncut, at a wall or at a face of the block", cross.excluded);
  return check;
}

/// A driven cycle that does not do what it is commanded is a fault of ours, or a part that cannot be
/// followed.
Check driven_check(const Result& result) {
  const motion::DrivenStatistics& driven = *result.driven;
  Check check =
      counted("driven_cycles", "Driven cycles above a clamp or a limit, or off their chord",
              driven.above_clamp + driven.above_acceleration + driven.above_jerk + driven.off_chord, 0);
  check.reason = fmt::format("{} cycles of {} passes run again", driven.cycles, driven.passes);
  return check;
}

/// Of the cut itself, above and below; a ray that nothing was predicted for is none that holds.
Check flank_check(const Job& job, const Result& result) {
  const FlankFigures& figures = *result.flank_milling;
  Check check{"flank_limit", "Error of the flank milled surface"};
  check.unit = kMicrometres;
  check.limit = um_from_mm(job.scene.flank->motion.limit_mm);
  check.value = um_from_mm(figures.cut.most_mm());
  check.outcome =
      *check.value <= *check.limit && figures.rays_elsewhere == 0 ? Outcome::kHolds : Outcome::kFails;
  check.what = fmt::format("{}: {:.3f} um, at most {:g} um ({} rays, {} that no flank meets)", check.subject,
                           *check.value, *check.limit, figures.rays_compared, figures.rays_elsewhere);
  check.covers = fmt::format("rays {:g} mm apart", job.scene.design.pitch_mm);
  return check;
}

}  // namespace

const char* check_of(const motion::MotionFinding& fault) {
  return fault.code == "axis-speed" ? "axis_speed" : "travel";
}

std::vector<Check> judge_motion(const Job& job, const Result& result) {
  const AcceptLimits& accept = job.scene.accept;
  std::vector<Check> checks;
  checks.push_back(
      counted("travel", "Moves beyond the travel of an axis", count_faults(result, "travel"), accept.travel));
  checks.push_back(counted("axis_speed", "Moves faster than an axis", count_faults(result, "axis_speed"),
                           accept.axis_speed));
  Check trip{"round_trip", "Forward of inverse kinematics, every cycle"};
  trip.unit = "mm";
  trip.limit = kRoundTrip;
  trip.value = result.main.motion.statistics.fk_ik_error_max_mm;
  trip.outcome = *trip.value < *trip.limit ? Outcome::kHolds : Outcome::kFails;
  trip.what = fmt::format("{}: {:.1e} mm, below {:.0e} mm", trip.subject, *trip.value, *trip.limit);
  checks.push_back(std::move(trip));
  return checks;
}

std::vector<Check> judge(const Job& job, const Result& result) {
  std::vector<Check> checks;
  add_surface_checks(job, result, checks);
  add_tool_checks(job, result, checks);
  for (Check& check : judge_motion(job, result)) checks.push_back(std::move(check));
  checks.push_back(invariants_check(result));
  checks.push_back(rays_check(job, result));
  checks.push_back(machine_check(job, result));
  if (result.flank_milling && job.scene.flank->motion.limit_mm > 0.0)
    checks.push_back(flank_check(job, result));
  if (result.driven && job.scene.driven->plan.cam_tolerance_mm == 0.0) checks.push_back(driven_check(result));
  return checks;
}

}  // namespace swarf::sim

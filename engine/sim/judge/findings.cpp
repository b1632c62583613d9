#include "sim/judge/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "base/check.h"
#include "base/units.h"
#include "program/source_text.h"
#include "sim/judge/judge.h"
#include "sim/judge/limit_text.h"
#include "sim/judge/unlimited_excess.h"
#include "sim/judge/unlimited_gouge.h"

namespace swarf::sim {
namespace {

class Collector {
 public:
  Collector(const Job& job, const Result& result)
      : job_(job), result_(result), reader_(*result.main.cycles) {}

  /// What follows breaks this check: an error unless [accept] allows so much of it.
  void begin(const char* check_name) {
    check_ = find_check(result_.checks, check_name);
    SWARF_CHECK(check_ != nullptr, "a finding must belong to a check of the judge");
  }
  const Check& check() const { return *check_; }

  /// The finding, for what else is known of it.
  Finding& add(std::string code, std::string text, std::string fix, SourceLocation where, double t_s) {
    return findings_.emplace_back(Finding{std::move(code), breaks() ? Severity::kError : Severity::kWarning,
                                          std::move(text), std::move(fix), std::move(where), t_s, "",
                                          check_->name});
  }
  /// A warning, whatever becomes of the check; the finding, for what else is known of it.
  Finding& note(std::string code, std::string text, std::string fix, SourceLocation where, double t_s) {
    return findings_.emplace_back(Finding{std::move(code), Severity::kWarning, std::move(text),
                                          std::move(fix), std::move(where), t_s, "", check_->name});
  }
  /// Breaks nothing.
  void warn(const motion::MotionFinding& fault) {
    findings_.push_back({fault.code, fault.severity, fault.text, "", fault.where, fault.t_s, "", ""});
  }
  /// At the block that a sweep comes from; at the program when no sweep is to blame.
  Finding& at_block(std::string code, std::string text, std::string fix,
                    const std::vector<SweepSource>& sources, uint32_t block) {
    if (block >= sources.size()) {
      const size_t carried = block - sources.size();
      const CarriedSweeps& before = result_.main.carried->rays;
      const bool is_earlier = carried < before.sweeps.size();
      const SourceLocation earlier = is_earlier ? carried_block(before, carried) : SourceLocation{};
      if (is_earlier)
        text += fmt::format("; it was cut {}, {}:{}", carried_place(before, carried),
                            std::filesystem::path(earlier.file).filename().string(), earlier.line);
      Finding& added = add(std::move(code), std::move(text), std::move(fix), {job_.scene.program_file}, 0.0);
      added.earlier = earlier;
      return added;
    }
    const SweepSource& source = sources[block];
    const cutter::Cutter& tool = job_.scene.tools[static_cast<size_t>(source.tool)];
    Finding& added = add(std::move(code), std::move(text), std::move(fix),
                         result_.main.path.elements.where(static_cast<size_t>(source.element)),
                         reader_.at(cycle_of(source, reader_)).sample.t_s);
    added.cause = cutter::call_name(tool);
    added.reach_mm = tool.diameter_mm;
    return added;
  }
  /// At the block in which the tool first touches.
  Finding& at_event(std::string code, std::string text, std::string fix, const ContactEvent& event) {
    Finding& added =
        add(std::move(code), std::move(text), std::move(fix),
            result_.main.path.elements.where(static_cast<size_t>(event.first.element)), event.first.t_s);
    const cutter::Cutter& tool = job_.scene.tools[static_cast<size_t>(event.tool)];
    added.line_last = result_.main.path.elements.line(static_cast<size_t>(event.last_element));
    added.place_W = event.deepest_W;
    added.amount_mm = event.depth_mm;
    added.cause = event.part + " of " + cutter::call_name(tool);
    added.reach_mm = tool.diameter_mm;
    return added;
  }
  /// The findings with the text of their blocks.
  std::vector<Finding> take() {
    const auto names_line = [&](const Finding& finding) {
      return finding.where.line > 0 && finding.where.file != job_.scene.file;
    };
    std::map<std::string, std::set<int>> wanted;
    for (const Finding& finding : findings_)
      if (names_line(finding)) wanted[finding.where.file].insert(finding.where.line);
    std::map<std::string, std::map<int, std::string>> texts;
    for (const auto& [file, lines] : wanted) texts[file] = program::read_lines(file, lines);
    for (Finding& finding : findings_)
      if (names_line(finding)) finding.block = texts[finding.where.file][finding.where.line];
    return std::move(findings_);
  }

 private:
  bool breaks() const { return check_->outcome == Outcome::kFails || check_->outcome == Outcome::kNotProven; }

  std::vector<Finding> findings_;
  const Check* check_ = nullptr;
  const Job& job_;
  const Result& result_;
  motion::CycleReader reader_;
};

std::string place(const measure::Region& region, double limit_um) {
  const std::string area = region.area_mm2 > 0.0 ? fmt::format(" over {:.2f} mm2", region.area_mm2) : "";
  return fmt::format("{} um{} about ({:.3f}, {:.3f}, {:.3f}) mm; [accept] allows {} um",
                     text_beside(region.worst_um, limit_um), area, region.place.x(), region.place.y(),
                     region.place.z(), limit_text(limit_um));
}

void at_region(Finding& finding, const measure::Region& region) {
  finding.place_W = region.place;
  finding.amount_mm = region.worst_um * kMicrometre;
}

/// A limit that the measures meet and no proof does.
void not_proven(const Job& job, const Result& result, Collector& collect) {
  const Check& check = collect.check();
  if (check.outcome != Outcome::kNotProven) return;
  const std::string what = fmt::format("{}: {}", check.subject, check.reason);
  if (!check.bound && (result.stopped || job.scene.output.budget_s > 0.0)) {
    collect.add(
        check.name + "-not-proven", what,
        result.stopped ? "let the run come to its end" : "give it more time (--budget, output.budget_s)",
        {job.scene.program_file}, 0.0);
    return;
  }
  // To the next thousandth upwards: what is said is allowed.
  const std::string wider =
      check.bound ? fmt::format("allow {:.3f} um in [accept]", std::ceil(*check.bound * 1e3) * 1e-3)
                  : "take the limit out of [accept]";
  collect.add(check.name + "-not-proven", what,
              "a smaller design.pitch_mm gives the proof smaller cells to settle this; or " + wider,
              {job.scene.program_file}, 0.0);
}

/// Gouges, or what stands too high.
struct RegionKind {
  const char *check, *what, *remedy;
  const char* missing;  ///< what no cut has taken; null: there is no such thing
  const std::vector<measure::Region>& regions;
  std::optional<double> limit_um;
  measure::Region worst;  ///< of all, where no region tells it
};

constexpr const char* kNobodyCut = "the stock ends here, nobody has cut it: material is missing";
constexpr const char* kNobodyCutRemedy =
    "bring design and stock together, or make the stock larger (the warning design-beyond-stock says by how "
    "much)";

/// One finding for each listed region beyond its limit; where the worst is so little beyond it that the proof
/// draws no region, one for its place.
void region_faults(const Job& job, const RegionKind& kind, const Result& result, Collector& collect) {
  collect.begin(kind.check);
  std::vector<measure::Region> beyond;
  for (const measure::Region& region : kind.regions)
    if (kind.limit_um && region.worst_um > *kind.limit_um) beyond.push_back(region);
  if (beyond.empty() && collect.check().outcome == Outcome::kFails) beyond.push_back(kind.worst);
  for (const measure::Region& region : beyond) {
    const bool missing = kind.missing != nullptr && region.block == stock::kUncut;
    at_region(collect.at_block(
                  missing ? "stock-missing" : kind.check,
                  fmt::format("{}, {}", missing ? kind.missing : kind.what, place(region, *kind.limit_um)),
                  missing ? kNobodyCutRemedy : kind.remedy, result.main.rays.sources, region.block),
              region);
  }
  not_proven(job, result, collect);
}

/// Without a limit of gouges the one place that lacks most, or is cut into most.
void gouge_without_limit(const Result& result, const char* remedy, Collector& collect) {
  collect.begin("gouge");
  if (collect.check().outcome != Outcome::kFails) return;
  const measure::SurfaceMetrics& surface = result.main.surface;
  const bool missing = unlimited_gouge(surface) == UnlimitedGouge::kMissing;
  measure::Region region;
  region.worst_um = missing ? surface.missing_max_um : surface.gouge_max_um;
  region.place = missing ? surface.missing_place : surface.gouge_bottom;
  at_region(
      collect.at_block(missing ? "stock-missing" : "gouge",
                       fmt::format("{}, {:.3f} um about ({:.3f}, {:.3f}, {:.3f}) mm; more than the {:g} "
                                   "um that are allowed where [accept] has no limit",
                                   missing ? kNobodyCut : "a gouge", region.worst_um, region.place.x(),
                                   region.place.y(), region.place.z(), *collect.check().limit),
                       missing ? kNobodyCutRemedy : remedy, result.main.rays.sources,
                       missing ? stock::kUncut : surface.gouge_block),
      region);
}

constexpr const char* kExcess = "material stands above the design";
constexpr const char* kExcessRemedy = "machine this place too, or start from a smaller stock";

/// Without a limit of excess the one place where most is left.
void excess_without_limit(const Job& job, const Result& result, Collector& collect) {
  collect.begin("excess");
  if (collect.check().outcome != Outcome::kFails) return;
  const HighestLeft left = highest_left(job, result);
  measure::Region region;
  region.worst_um = left.um;
  region.place = left.place;
  region.block = left.block;
  at_region(
      collect.at_block("excess",
                       fmt::format("{}, {:.3f} um about ({:.3f}, {:.3f}, {:.3f}) mm; more than the {:g} um "
                                   "that are allowed where [accept] has no limit",
                                   kExcess, region.worst_um, region.place.x(), region.place.y(),
                                   region.place.z(), *collect.check().limit),
                       std::string(kExcessRemedy) +
                           "; accept.excess_max_um allows more, --roughing leaves material to others",
                       result.main.rays.sources, region.block),
      region);
}

void region_faults(const Job& job, const Result& result, Collector& collect) {
  const measure::SurfaceMetrics& surface = result.main.surface;
  const AcceptLimits& accept = job.scene.accept;
  const auto worst = [](double um, const Vec3& at, uint32_t block) {
    measure::Region region;
    region.worst_um = um;
    region.place = at;
    region.block = block;
    return region;
  };
  const char* remedy = result.main.path.elements.hold_blocks()
                           ? "move the tool of this block away from the design"
                           : "lower the feed F or the control period: the chord of one cycle cuts into a "
                             "convex surface";
  if (accept.gouge_max_um)
    region_faults(job,
                  {"gouge", "a gouge", remedy, kNobodyCut, surface.gouges, accept.gouge_max_um,
                   worst(surface.gouge_max_um, surface.gouge_bottom, surface.gouge_block)},
                  result, collect);
  else
    gouge_without_limit(result, remedy, collect);
  if (!accept.excess_max_um) return excess_without_limit(job, result, collect);
  region_faults(job,
                {"excess", kExcess, kExcessRemedy, nullptr, surface.excesses, accept.excess_max_um,
                 worst(surface.excess_max_um, surface.excess_top, surface.excess_block)},
                result, collect);
}

void surface_faults(const Job& job, const Result& result, Collector& collect) {
  const measure::SurfaceMetrics& surface = result.main.surface;
  const AcceptLimits& accept = job.scene.accept;
  collect.begin("scallop");
  if (collect.check().outcome == Outcome::kFails) {
    const auto highest =
        std::max_element(result.main.ridges.begin(), result.main.ridges.end(),
                         [](const auto& a, const auto& b) { return a.height_um < b.height_um; });
    const bool known = highest != result.main.ridges.end();
    Finding& added = collect.at_block("scallop",
                                      fmt::format("the highest scallop is {} um, [accept] allows {} um",
                                                  text_beside(surface.scallop_max_um, *accept.scallop_max_um),
                                                  limit_text(*accept.scallop_max_um)),
                                      result.main.path.elements.hold_blocks()
                                          ? "bring the passes closer together"
                                          : "lower the scallop word E of the G06.3 block",
                                      result.main.rays.sources, known ? highest->block_a : stock::kUncut);
    if (known) {
      added.place_W = highest->point;
      added.amount_mm = highest->height_um * kMicrometre;
    }
  }
  not_proven(job, result, collect);
  region_faults(job, result, collect);
  collect.begin("uncut");
  if (collect.check().outcome == Outcome::kFails) {
    collect.add("uncut",
                fmt::format("{} of {} measuring points were never reached by the cutter",
                            surface.uncut_samples, surface.samples),
                "machine the whole surface, or measure only what the program machines",
                {job.scene.program_file}, 0.0);
  }
}

void driven_faults(const Job& job, const Result& result, Collector& collect) {
  if (!result.driven || job.scene.driven->plan.cam_tolerance_mm > 0.0) return;
  collect.begin("driven_cycles");
  if (collect.check().outcome != Outcome::kFails) return;
  const motion::DrivenStatistics& driven = *result.driven;
  collect.add(
      "driven-cycles",
      fmt::format("driven cycles: {} above a clamp speed, {} above the acceleration, {} above the jerk, "
                  "{} off their chord (by {:.1e} of it at the most)",
                  driven.above_clamp, driven.above_acceleration, driven.above_jerk, driven.off_chord,
                  driven.chord_error_max_rel),
      "lower driven.feed_mm_min; please report the scene", job.scene.driven->where, 0.0);
}

void flank_faults(const Job& job, const Result& result, Collector& collect) {
  if (!result.flank_milling || job.scene.flank->motion.limit_mm <= 0.0) return;
  collect.begin("flank_limit");
  if (collect.check().outcome != Outcome::kFails) return;
  const FlankFigures& figures = *result.flank_milling;
  const Vec3& p = figures.cut.most_W();
  collect.add(
      "flank-limit",
      fmt::format(
          "the flank leaves {:.3f} um at ({:.3f}, {:.3f}, {:.3f}) mm, limit {:g} um; {} rays are met by no "
          "flank",
          um_from_mm(figures.cut.greatest_mm > -figures.cut.least_mm ? figures.cut.greatest_mm
                                                                     : figures.cut.least_mm),
          p.x(), p.y(), p.z(), um_from_mm(job.scene.flank->motion.limit_mm), figures.rays_elsewhere),
      "a longer flank.overrun_mm at the ends, a smaller flank.chord_um, a lower feed, or stock that "
      "reaches over the design's edges",
      job.scene.flank->where, 0.0);
}

/// Another clamping; or another tool, where the axis along it travels less than it is long.
std::string travel_remedy(const Job& job, const motion::MotionFinding& fault) {
  const kinematics::MachineModel& machine = job.machine.model;
  const auto axis = std::find_if(machine.axes.begin(), machine.axes.end(),
                                 [&](const kinematics::Axis& one) { return one.name == fault.axis; });
  if (fault.code != "travel" || axis == machine.axes.end() || axis->kind != kinematics::AxisKind::kLinear)
    return "";
  const auto reach = [](const cutter::Cutter& tool) { return cutter::gauge_length(tool); };
  const cutter::Cutter& longest = *std::max_element(
      job.scene.tools.begin(), job.scene.tools.end(),
      [&](const cutter::Cutter& a, const cutter::Cutter& b) { return reach(a) < reach(b); });
  const double travel = axis->max - axis->min;
  const bool along = axis->direction_M.cross(machine.tool_axis_M).norm() < 1e-9;
  if (along && reach(longest) > travel)
    return fmt::format("take a shorter tool: {} reaches {:g} mm below the gauge line, {} travels {:g} mm",
                       cutter::call_name(longest), reach(longest), axis->name, travel);
  return "clamp the work elsewhere (setup.work_origin_mm)";
}

void motion_faults(const Job& job, const Result& result, Collector& collect) {
  for (const motion::MotionFinding& fault : result.main.motion.findings) {
    if (fault.severity != Severity::kError) {
      collect.warn(fault);
      continue;
    }
    collect.begin(check_of(fault));
    collect.add(fault.code, fault.text, travel_remedy(job, fault), fault.where, fault.t_s).cause = fault.axis;
  }
}

/// "line 14" or "lines 14 to 20".
std::string lines_of(const Result& result, const ContactEvent& event) {
  const auto line = [&](int element) { return result.main.path.elements.line(static_cast<size_t>(element)); };
  const int first = line(event.first.element), last = line(event.last_element);
  return first == last ? fmt::format("line {}", first) : fmt::format("lines {} to {}", first, last);
}

/// How deep, where, when.
std::string depth_text(const Result& result, const ContactEvent& event) {
  const int line = result.main.path.elements.line(static_cast<size_t>(event.deepest.element));
  return fmt::format("{:.2f} mm deep at ({:.2f}, {:.2f}, {:.2f}) mm, line {}, {:.3f} s", event.depth_mm,
                     event.deepest_W.x(), event.deepest_W.y(), event.deepest_W.z(), line, event.deepest.t_s);
}

std::string longer_tool(const cutter::Cutter& tool, const ContactEvent& event) {
  if (event.part == "holder") {
    return fmt::format("let {} stand out {:.1f} mm more (length_mm {:.1f}), or rough the stock first",
                       cutter::call_name(tool), event.depth_mm, tool.length_mm + event.depth_mm);
  }
  return fmt::format(
      "take a tool whose flutes, or a neck inside their radius, reach {:.1f} mm more, or rough "
      "the stock first",
      event.depth_mm);
}

/// The first of many, and how many more.
constexpr size_t kListed = 50;
std::string and_more(size_t listed, size_t all) {
  return listed == kListed && all > kListed ? fmt::format("; {} more of these follow", all - kListed) : "";
}

void clearance_faults(const Job& job, const Result& result, Collector& collect) {
  const std::vector<ContactEvent>& events = result.clearance.events;
  collect.begin("collisions");
  for (size_t i = 0; i < std::min(kListed, events.size()); ++i) {
    const ContactEvent& event = events[i];
    collect.at_event(event.part + "-in-stock",
                     fmt::format("the {} stands in the stock, {}: {}{}", event.part, lines_of(result, event),
                                 depth_text(result, event), and_more(i + 1, events.size())),
                     longer_tool(job.scene.tools[static_cast<size_t>(event.tool)], event), event);
  }
}

/// Moves that must not cut.
void bad_cut_faults(const Result& result, Collector& collect) {
  const std::vector<BadCut>& cuts = result.cut.state.bad_cuts;
  for (size_t i = 0; i < std::min(kListed, cuts.size()); ++i) {
    const BadCut& cut = cuts[i];
    const bool rapid = cut.kind == BadCutKind::kRapid;
    collect.begin(rapid ? "rapids_in_material" : "spindle_wrong");
    const std::string text =
        rapid ? "a rapid move removes material"
              : fmt::format("the tool cuts with {}", cut.kind == BadCutKind::kSpindleStands
                                                         ? "the spindle stopped"
                                                         : "the spindle turning the wrong way");
    collect.at_event(rapid ? "rapid-cut" : "spindle",
                     fmt::format("{}, {}: {}{}", text, lines_of(result, cut.event),
                                 depth_text(result, cut.event), and_more(i + 1, cuts.size())),
                     rapid ? "move there with G1, or retract first" : "start the spindle before it: M3, S",
                     cut.event);
  }
}

/// What Kruth et al. (Table 1) would change: A the clamping, B the tool's length, C the set-up, D the path.
std::string remedy_of(const ContactBody& a, const ContactBody& b) {
  using collision::BodyKind;
  const auto has = [&](BodyKind kind) { return a.kind == kind || b.kind == kind; };
  const bool flutes = a.name.starts_with("flutes") || b.name.starts_with("flutes");
  if (has(BodyKind::kFixture) && has(BodyKind::kToolPart))
    return flutes ? "set the work up in another way, or lead the path around the fixture"
                  : "take a longer tool, or set the work up in another way";
  if (has(BodyKind::kFixture))
    return "clamp the work elsewhere (setup.work_origin_mm), or set it up in another way";
  if (has(BodyKind::kStock)) return "clamp the work elsewhere (setup.work_origin_mm), or take a longer tool";
  if (has(BodyKind::kToolPart)) return "clamp the work higher or elsewhere (setup.work_origin_mm)";
  return "clamp the work elsewhere (setup.work_origin_mm), or take the other rotary solution";
}

std::string contact_text(const Result& result, const ContactBody& a, const ContactBody& b,
                         const collision::ContactEvent& event) {
  const auto line = [&](int element) { return result.main.path.elements.line(static_cast<size_t>(element)); };
  const int first = line(event.first_element), last = line(event.last_element);
  const std::string lines =
      first == last ? fmt::format("line {}", first) : fmt::format("lines {} to {}", first, last);
  const Vec3& p = event.point_a;
  std::string text =
      fmt::format("{} touches {}, {}: first at ({:.2f}, {:.2f}, {:.2f}) mm of the machine, {:.3f} s", a.name,
                  b.name, lines, p.x(), p.y(), p.z(), event.first.time_s);
  if (event.inside) text += "; one stands inside the other";
  if (event.depth_mm > 0.0)
    text += fmt::format("; {:.2f} mm deep, nowhere deeper than {:.2f}", event.depth_mm, event.depth_bound_mm);
  return text;
}

/// A link or fixture in what is left of the stock, or not proven to be clear of it.
std::string stock_contact_text(const Result& result, const MachineContacts& contacts,
                               const StockEvent& event) {
  const auto line = [&](int element) { return result.main.path.elements.line(static_cast<size_t>(element)); };
  const int first = line(event.first.element), last = line(event.last_element);
  const std::string& body =
      contacts.bodies[contacts.beside_stock(contacts.findings.pairs[event.suspect.pair])].name;
  const std::string when =
      fmt::format("{}, {:.3f} s",
                  first == last ? fmt::format("line {}", first) : fmt::format("lines {} to {}", first, last),
                  event.first.time_s);
  const Vec3& p = event.place_M;
  const std::string deep = fmt::format(
      "{:.2f} mm deep at ({:.2f}, {:.2f}, {:.2f}) mm of the machine at most where it was looked at",
      event.depth_mm, p.x(), p.y(), p.z());
  if (event.verdict == StockVerdict::kContact)
    return fmt::format("{} touches what is left of the stock, {}; {}", body, when, deep);
  return fmt::format("{} is not proven to be clear of what is left of the stock, {}; {}", body, when,
                     event.depth_mm > 0.0
                         ? deep
                         : fmt::format("gaps of {:.3f} mm and more are seen", contacts.as_cut->seen_mm));
}

void machine_faults(const Result& result, Collector& collect) {
  if (!result.main.contacts) return;
  const MachineContacts& contacts = *result.main.contacts;
  collect.begin("machine_parts");
  const uint64_t all = contacts.contacts() + contacts.stock_contacts() + contacts.stock_open();
  size_t listed = 0;
  const auto add = [&](const std::string& text, const collision::PairFindings& pair, int element,
                       int last_element, double t_s, double depth_mm, const Vec3& place_M) {
    if (listed == kListed) return;
    const ContactBody &a = contacts.bodies[pair.a], &b = contacts.bodies[pair.b];
    const toolpath::Elements& elements = result.main.path.elements;
    Finding& added = collect.add("machine-contact", text + and_more(++listed, all), remedy_of(a, b),
                                 elements.where(static_cast<size_t>(element)), t_s);
    added.line_last = elements.line(static_cast<size_t>(last_element));
    added.cause = a.name + " and " + b.name;
    added.amount_mm = depth_mm;
    added.place_M = place_M;
  };
  for (const collision::PairFindings& pair : contacts.findings.pairs) {
    if (contacts.with_stock(pair)) continue;
    for (const collision::ContactEvent& event : pair.contacts)
      add(contact_text(result, contacts.bodies[pair.a], contacts.bodies[pair.b], event), pair,
          event.first_element, event.last_element, event.first.time_s, event.depth_mm, event.point_a);
  }
  if (!contacts.as_cut) return;
  for (const StockVerdict verdict : {StockVerdict::kContact, StockVerdict::kOpen})
    for (const StockEvent& event : contacts.as_cut->events)
      if (event.verdict == verdict)
        add(stock_contact_text(result, contacts, event), contacts.findings.pairs[event.suspect.pair],
            event.first.element, event.last_element, event.first.time_s, event.depth_mm, event.place_M);
}

/// Gaps below what the scene asks of single pairs ([[contact_pair]]).
void near_misses(const Result& result, Collector& collect) {
  if (!result.main.contacts) return;
  const MachineContacts& contacts = *result.main.contacts;
  const toolpath::Elements& elements = result.main.path.elements;
  collect.begin("machine_parts");
  for (const collision::PairFindings& pair : contacts.findings.pairs) {
    const ContactBody &a = contacts.bodies[pair.a], &b = contacts.bodies[pair.b];
    const collision::NearMissRule* const rule = contacts.rules.near_miss_of(a.name, b.name);
    if (rule == nullptr || !pair.near_miss.within || !pair.spans.empty()) continue;
    const collision::NearMiss& near = pair.near_miss;
    const auto element = static_cast<size_t>(near.place.element);
    const Vec3& p = near.point_a;
    const char* const raw = contacts.with_stock(pair) ? " (the raw one)" : "";
    Finding& added = collect.note(
        "near-miss",
        fmt::format("{} comes as near as {:.3f} mm to {}{}, line {}: at ({:.2f}, {:.2f}, {:.2f}) mm of the "
                    "machine, {:.3f} s; {:g} mm are asked for",
                    a.name, near.upper, b.name, raw, elements.line(element), p.x(), p.y(), p.z(),
                    near.place.time_s, rule->near_miss_mm),
        remedy_of(a, b), elements.where(element), near.place.time_s);
    added.cause = a.name + " and " + b.name;
    added.amount_mm = near.upper;
    added.place_M = p;
  }
}

void built_in_checks(const Job& job, const Result& result, Collector& collect) {
  collect.begin("stock_invariants");
  if (!result.cut.broken_invariant.empty()) {
    collect.add("stock-invariant",
                fmt::format("the level set broke its invariant {}", result.cut.broken_invariant),
                "this is a fault of the program: please report it with the scene", {job.scene.file}, 0.0);
  }
  collect.begin("stock_and_rays");
  if (result.cross_check && !result.cross_check->holds) {
    collect.add("stock-and-rays-disagree",
                fmt::format("level set and measuring rays differ by {:.1f} um, the bound is {:.1f} um",
                            result.cross_check->max_um, result.cross_check->bound_um),
                "this is a fault of the program: please report it with the scene", {job.scene.file}, 0.0);
  }
  collect.begin("round_trip");
  if (collect.check().outcome == Outcome::kFails) {
    collect.add("round-trip", collect.check().what,
                "this is a fault of the program: please report it with the scene", {job.scene.file}, 0.0);
  }
}

}  // namespace

std::vector<Finding> find_faults(const Job& job, const Result& result) {
  Collector collect(job, result);
  surface_faults(job, result, collect);
  motion_faults(job, result, collect);
  driven_faults(job, result, collect);
  flank_faults(job, result, collect);
  clearance_faults(job, result, collect);
  bad_cut_faults(result, collect);
  machine_faults(result, collect);
  near_misses(result, collect);
  built_in_checks(job, result, collect);
  return collect.take();
}

}  // namespace swarf::sim

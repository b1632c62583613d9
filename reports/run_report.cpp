#include "reports/run_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "cutter/cutting_pieces.h"
#include "measure/measure.h"
#include "motion/speed/look_ahead.h"
#include "papers/lin_koren.h"
#include "papers/so_study.h"
#include "papers/so_table2.h"
#include "reports/check_rows.h"
#include "reports/cl_report.h"
#include "reports/driven_output.h"
#include "reports/fig6_table.h"
#include "reports/flank_output.h"
#include "reports/flank_table.h"
#include "reports/nc_report.h"
#include "reports/page_program.h"
#include "reports/part_view.h"
#include "reports/pictures.h"
#include "reports/review_findings.h"
#include "reports/run_plots.h"
#include "reports/singularity_section.h"
#include "reports/time_facts.h"
#include "reports/tools_table.h"

namespace swarf::reports {
namespace {

std::string um(double value) {
  return fmt::format("{:.3f}", value);
}

std::string duration(double seconds) {
  return seconds < 100.0
             ? fmt::format("{:.1f} s", seconds)
             : fmt::format("{} min {:02d} s", static_cast<int>(seconds) / 60, static_cast<int>(seconds) % 60);
}

/// The path is the program's own blocks, not planned passes.
bool brings_blocks(const sim::Result& result) {
  return result.main.path.elements.hold_blocks();
}

/// A measure of the surface, in the tone of the check that judged it; not judged is neutral, never green.
KeyNumber judged_number(const sim::Result& result, const char* check_name, const char* label,
                        const std::string& hint) {
  const sim::Check& check = *sim::find_check(result.checks, check_name);
  if (!check.value) return {label, "not judged", "", check.reason};
  return {label, um(*check.value), "µm", hint, tone_of(check)};
}

/// What a measure of the surface rests on.
std::string rays_hint(const measure::SurfaceMetrics& surface, const std::optional<measure::Bound>& bound) {
  const std::string known =
      bound ? fmt::format("proven below {:.3f} µm", bound->um) : "between them measured, not proven";
  return fmt::format("{} measuring rays; {}", surface.samples, known);
}

KeyNumber rays_number(const sim::Result& result) {
  const sim::Check& check = *sim::find_check(result.checks, "stock_and_rays");
  return judged_number(result, "stock_and_rays", "Level set against rays",
                       check.limit ? fmt::format("bound {:.2f} µm", *check.limit) : "");
}

/// Text and unit; of small parts nothing would be left in cm³.
std::pair<std::string, std::string> volume_words(double mm3) {
  constexpr double kSmall = 1e3;
  if (mm3 < kSmall) return {fmt::format("{:.3g}", mm3), "mm³"};
  return {fmt::format("{:.1f}", 1e-3 * mm3), "cm³"};
}

KeyNumber removed_number(const sim::Result& result) {
  const auto [removed, unit] = volume_words(result.volume_removed_mm3);
  const auto [left, left_unit] = volume_words(result.volume_left_mm3);
  return {"Removed", removed, unit, fmt::format("{} {} left", left, left_unit)};
}

/// The numbers of a program of blocks: its surface, when it has one, is measured for excess and gouge.
std::vector<KeyNumber> block_key_numbers(const sim::Result& result) {
  const measure::SurfaceMetrics& surface = result.main.surface;
  std::vector<KeyNumber> numbers{{"Machining time", duration(result.main.motion.statistics.time_s), "",
                                  fmt::format("{} blocks", result.main.path.elements.size())},
                                 removed_number(result)};
  if (surface.samples == 0) return numbers;
  numbers.push_back(
      judged_number(result, "excess", "Highest material", rays_hint(surface, surface.excess_bound)));
  numbers.push_back(judged_number(result, "gouge", "Deepest gouge", rays_hint(surface, surface.gouge_bound)));
  numbers.push_back(rays_number(result));
  return numbers;
}

std::vector<KeyNumber> key_numbers(const sim::Result& result) {
  const measure::SurfaceMetrics& surface = result.main.surface;
  const motion::MotionStatistics& motion = result.main.motion.statistics;
  return {
      judged_number(result, "scallop", "Highest scallop",
                    fmt::format("theory {:.3f} µm", surface.scallop_theory_um)),
      {"5 % of the ridges lie below", um(surface.scallop_p05_um), "µm",
       fmt::format("{} ridge points", surface.ridges)},
      judged_number(result, "gouge", "Deepest gouge", rays_hint(surface, surface.gouge_bound)),
      {"Within tolerance", fmt::format("{:.2f}", surface.within_tolerance_pct), "%",
       "of the machined surface"},
      {"Machining time", duration(motion.time_s), "", fmt::format("{} passes", result.main.path.passes)},
      {"Feed error", fmt::format("{:.1e}", motion.feed_error_max_rel), "", "relative, largest of all cycles"},
      removed_number(result),
      rays_number(result)};
}

Table planner_table(const sim::Result& result) {
  Table table;
  table.title = "Planners compared";
  table.intro = "The same program, cutter and interpolator; each path was interpolated, cut and measured.";
  table.columns = {{"Planner"},
                   {"Passes", "", true},
                   {"Contact length", "mm", true},
                   {"Links", "mm", true},
                   {"Time", "s", true},
                   {"Scallop max", "µm", true},
                   {"Scallop 5 %", "µm", true},
                   {"Theory", "µm", true},
                   {"Gouge", "µm", true}};
  for (const sim::ComparisonRow& row : result.planners) {
    if (row.used) table.highlighted_row = static_cast<int>(table.rows.size());
    table.rows.push_back({row.name, fmt::format("{}", row.passes), fmt::format("{:.1f}", row.pass_length_mm),
                          fmt::format("{:.1f}", row.link_length_mm), fmt::format("{:.2f}", row.time_s),
                          um(row.surface.scallop_max_um), um(row.surface.scallop_p05_um),
                          um(row.surface.scallop_theory_um), um(row.surface.gouge_max_um)});
  }
  table.notes = {
      "Scallop 5 %: 5 % of the ridge points lie below it; equal to the maximum when the cusp is constant."};
  return table;
}

Table mode_table(const sim::Result& result) {
  Table table;
  table.title = "Interpolators compared";
  table.intro =
      "The same path; real-time interpolation on the surface against off-line line segments (erratum E19).";
  table.columns = {{"Interpolator"},
                   {"Time", "s", true},
                   {"Feed error", "relative", true},
                   {"Chord error", "µm", true},
                   {"Orientation error", "deg", true},
                   {"Gouge", "µm", true},
                   {"Scallop max", "µm", true}};
  for (const sim::ComparisonRow& row : result.modes) {
    if (row.used) table.highlighted_row = static_cast<int>(table.rows.size());
    table.rows.push_back({row.name, fmt::format("{:.2f}", row.time_s),
                          fmt::format("{:.1e}", row.feed_error_max_rel),
                          fmt::format("{:.4f}", um_from_mm(row.chord_error_max_mm)),
                          fmt::format("{:.5f}", deg_from_rad(row.orientation_error_max_rad)),
                          um(row.surface.gouge_max_um), um(row.surface.scallop_max_um)});
  }
  return table;
}

Table axis_table(const sim::Job& job, const sim::Result& result) {
  Table table;
  table.title = "Axes";
  table.columns = {{"Axis"},
                   {"Unit"},
                   {"Least", "", true},
                   {"Greatest", "", true},
                   {"Limits", "", true},
                   {"Travelled", "", true},
                   {"Top speed", "per s", true},
                   {"Limit", "per s", true},
                   {"in rapids", "per s", true}};
  const motion::MotionStatistics& motion = result.main.motion.statistics;
  for (size_t i = 0; i < motion.axes.size(); ++i) {
    const kinematics::Axis& axis = job.machine.model.axes[i];
    const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
    const auto shown = [&](double value) {
      return fmt::format("{:.2f}", rotary ? deg_from_rad(value) : value);
    };
    table.rows.push_back(
        {axis.name + (axis.reversed ? " (reversed)" : ""), rotary ? "deg" : "mm", shown(motion.axes[i].min),
         shown(motion.axes[i].max), shown(axis.min) + " .. " + shown(axis.max), shown(motion.axes[i].travel),
         shown(motion.axes[i].speed_max), shown(axis.speed_max), shown(motion::speed_limit(axis, true))});
  }
  const auto& axes = job.machine.model.axes;
  if (std::any_of(axes.begin(), axes.end(), [](const kinematics::Axis& axis) { return axis.reversed; }))
    table.notes = {
        "Reversed: the table itself turns positively, not the tool relative to the work (ISO 841)."};
  return table;
}

std::string left_out_words(const sim::Job& job, const sim::Result& result) {
  return fmt::format("{} (time budget of {:g} s)", fmt::join(result.left_out, ", "),
                     job.scene.output.budget_s);
}

/// The judge's list, then what this program does not look at.
std::vector<Check> checks_of(const sim::Job& job, const sim::Result& result, bool rendered) {
  std::vector<Check> checks = check_rows(result.checks);
  checks.push_back(
      {"Cutter load, spindle power, deflection", "", "the simulation is geometric", State::kNotChecked});
  if (brings_blocks(result)) {
    checks.push_back({"Planners and interpolators compared", "",
                      "a program of blocks is one path: not applicable", State::kNotChecked});
  }
  if (!rendered) {
    checks.push_back({"Pictures and movie", "", "switched off with --no-render", State::kNotChecked});
  }
  if (!result.left_out.empty()) {
    checks.push_back({"Left out", "", left_out_words(job, result), State::kNotChecked});
  }
  return checks;
}

const char* law_in_words(const sim::Job& job, const sim::Result& result) {
  if (result.main.nc) return "as the program's own words choose in each block";
  if (!brings_blocks(result))
    return "every cycle is one pose of the tool tip in the work frame; axes are linear inside a cycle";
  switch (job.scene.block_law) {
    case toolpath::BlockLaw::kTcp:
      return "tcp: in each block the tip is straight or on its arc, the axis turns evenly along the great "
             "circle";
    case toolpath::BlockLaw::kJoint:
      return "joint: in each block all machine axes are linear between its ends";
    case toolpath::BlockLaw::kTcpAxes:
      return "tcp_axes: in each block the tip is straight or on its arc and the rotary axes are linear";
    case toolpath::BlockLaw::kEnds:
      return "ends: in each block the tip and every guide point on the axis are straight";
    case toolpath::BlockLaw::kCurve:
      return "curve: tip and axis follow one smooth curve from block to block";
  }
  return "";
}

/// Whether the blocks themselves cut, or the control's cycles.
bool blocks_cut(const sim::Job& job) {
  return job.scene.stock.cut_by == sim::CutBy::kBlocks;
}

std::string execution_of(const sim::Job& job, const sim::Result& result) {
  return fmt::format("{}; the stock is cut by {}", law_in_words(job, result),
                     blocks_cut(job) ? "the blocks themselves" : "what the axes do in the control's cycles");
}

std::string sweeps_fact(const sim::Job& job, const sim::Result& result) {
  const auto cycles = static_cast<size_t>(result.main.motion.statistics.ticks);
  return fmt::format(
      "{} sweeps stay within {:.3f} µm of the {} {}", result.merged_sweeps, um_from_mm(result.sweep_bound_mm),
      blocks_cut(job) ? result.main.path.elements.size() : cycles, blocks_cut(job) ? "blocks" : "cycles");
}

std::string solid_fact(const cutter::Cutter& cutter) {
  const double error = cutter::chord_error_mm(cutter);
  const size_t pieces = cutter::cutting_pieces(cutter).size();
  const std::string exact =
      error > 0.0 ? fmt::format("hollow arcs as chords, at most {:.2f} µm too large", um_from_mm(error))
                  : "exact";
  return fmt::format("{} convex {} of revolution, {}", pieces, pieces == 1 ? "solid" : "solids", exact);
}

std::string holder_fact(const cutter::Cutter& cutter) {
  std::string text;
  for (const cutter::ToolSection& s : cutter.holder) {
    const bool cone = s.top_diameter_mm != s.diameter_mm;
    text += fmt::format("{}D {:g}{} mm, {:g} mm long", text.empty() ? "" : "; ", s.diameter_mm,
                        cone ? fmt::format(" to {:g}", s.top_diameter_mm) : "", s.length_mm);
  }
  return text;
}

FactGroup tool_facts(const sim::Job& job) {
  FactGroup group{"Machine and tools", {{"Machine", job.machine.model.name}}};
  for (const cutter::Cutter& tool : job.scene.tools) {
    group.facts.push_back({cutter::call_name(tool), cutter::describe(tool)});
    group.facts.push_back({"its solid", solid_fact(tool)});
    group.facts.push_back({"its holder", holder_fact(tool)});
    if (!job.machine.model.gauge_M) continue;
    group.facts.push_back({"gauge line to tip", fmt::format("{:g} mm", cutter::gauge_length(tool))});
  }
  return group;
}

/// What was there before any cut.
Fact raw_fact(const sim::StockSettings& stock) {
  const Vec3 size = stock.box_W.size();
  const std::string box = fmt::format("{:g} x {:g} x {:g} mm", size.x(), size.y(), size.z());
  if (!stock.shape) return {"Box", box};
  return {"Raw stock",
          fmt::format("{}; {:.6g} mm³ in a box of {}", stock.shape->text(), stock.shape->volume_mm3(), box)};
}

std::vector<FactGroup> facts_of(const sim::Job& job, const sim::Result& result, const RunFiles& files) {
  const motion::MotionStatistics& motion = result.main.motion.statistics;
  const stock::CutStatistics& cut = result.stock->statistics();
  const motion::ToolSample first = motion::CycleReader(*result.main.cycles).at(0).sample;
  const auto name_of = [](const std::string& path) { return path.substr(path.find_last_of('/') + 1); };
  return {{"Job",
           {{"Program", name_of(job.scene.program_file)},
            {"Planner", result.main.path.planner},
            {"Execution", execution_of(job, result)},
            {"Control period", fmt::format("{:g} ms", job.scene.motion.period_s * 1e3)},
            {"Start",
             fmt::format("tip at ({:.2f}, {:.2f}, {:.2f}) mm: {}", first.pose.tip_W.x(), first.pose.tip_W.y(),
                         first.pose.tip_W.z(),
                         result.main.nc ? result.main.nc->summary.start : "the first complete position")},
            {"Cycles", fmt::format("{}", motion.ticks)},
            {"Inside a cycle", fmt::format("axes are linear: the tip leaves the path by at most {:.4f} µm",
                                           um_from_mm(motion.tip_error_max_mm))}}},
          tool_facts(job),
          {"Stock",
           {raw_fact(job.scene.stock),
            {"Voxel", fmt::format("{:g} mm", job.scene.stock.voxel_mm)},
            {"Sweeps", sweeps_fact(job, result)},
            {"Cut", fmt::format("{} sweeps, {} voxel updates", cut.sweeps, cut.voxel_updates)},
            {"Hash of the finished stock", fmt::format("{:016x}", result.stock->hash())},
            {"part.glb", fmt::format("decimated, within {:.2f} µm of the level set's mesh",
                                     um_from_mm(files.part_error_mm))},
            {"Movie", fmt::format("shows a stock of {:g} mm voxels; nothing is measured on it",
                                  job.scene.movie.voxel_mm)}}},
          {"Program",
           {{"swarf", SWARF_VERSION},
            {"Memory", fmt::format("{:.0f} MB expected for the whole run; metrics.json has its measured peak",
                                   result.memory.peak_mb)},
            {"Cut", result.cut.resumed_from > 0 ? fmt::format("resumed after {} of {} sweeps",
                                                              result.cut.resumed_from, result.merged_sweeps)
                                                : "from the box"}}}};
}

using Lines = std::vector<std::pair<std::string, std::string>>;

Lines path_lines(const sim::Job& job, const sim::Result& result) {
  const motion::MotionStatistics& m = result.main.motion.statistics;
  return {
      {"path", fmt::format("{} passes, {:.0f} mm in contact, planner {}", result.main.path.passes,
                           result.main.path.pass_length_mm, result.main.path.planner)},
      {"time", fmt::format("{} at F {:.0f} mm/min ({} cycles of {:g} ms)", duration(m.time_s),
                           mm_min_from_mm_s(job.scene.driven ? job.scene.driven->plan.feed_mm_s
                                                             : job.program.operations.front().feed_mm_s),
                           m.ticks, job.scene.motion.period_s * 1e3)},
      {"feed error",
       fmt::format("{:.1e} relative; slowest {:.2f} mm/s in contact", m.feed_error_max_rel, m.feed_min_mm_s)},
      {"cycle cost", fmt::format("{:.0f} ns median, {:.0f} ns at 99.9 %", m.tick_ns_median, m.tick_ns_p999)}};
}

Lines cl_path_lines(const sim::Job& job, const sim::Result& result) {
  const motion::MotionStatistics& m = result.main.motion.statistics;
  const Vec3& start = job.cl->start.tip_W;
  Lines lines{{"writer", program::writer_name(job.cl->writer)}};
  for (const std::string& remark : job.cl->remarks) lines.emplace_back("note", remark);
  const Lines path{
      {"path", fmt::format("{} blocks, {:.0f} mm of feed moves, {:.0f} mm of rapids, law {}",
                           result.main.path.elements.size(), result.main.path.pass_length_mm,
                           result.main.path.link_length_mm, toolpath::law_name(job.scene.block_law))},
      {"start", fmt::format("({:.3f}, {:.3f}, {:.3f}) mm, line {}: the first complete position", start.x(),
                            start.y(), start.z(), job.cl->start_line)},
      {"time", fmt::format("{} ({} cycles of {:g} ms): feed {:.2f} s, rapid {:.2f} s, dwell {:.2f} s",
                           duration(m.time_s), m.ticks, job.scene.motion.period_s * 1e3, m.cycle.feed_s,
                           m.cycle.rapid_s, m.cycle.dwell_s)}};
  lines.insert(lines.end(), path.begin(), path.end());
  return lines;
}

Lines flank_path_lines(const sim::Job& job, const sim::Result& result) {
  const motion::MotionStatistics& m = result.main.motion.statistics;
  return {{"path", fmt::format("{} blocks, {:.0f} mm of feed moves, {:.0f} mm of rapids, law {}",
                               result.main.path.elements.size(), result.main.path.pass_length_mm,
                               result.main.path.link_length_mm, toolpath::law_name(job.scene.block_law))},
          {"time", fmt::format("{} ({} cycles of {:g} ms)", duration(m.time_s), m.ticks,
                               job.scene.motion.period_s * 1e3)}};
}

/// What was found may be far less than what is proven, where no ray looks.
std::string proven_words(const std::optional<measure::Bound>& bound) {
  return bound ? fmt::format(", proven below {:.3f} um", bound->um) : ", measured, not proven";
}

Lines surface_lines(const sim::Job& job, const sim::Result& result) {
  const measure::SurfaceMetrics& s = result.main.surface;
  if (!job.has_design()) return {{"design", "none: the finished part is not measured"}};
  Lines lines;
  if (brings_blocks(result)) {
    lines.emplace_back("design", job.scene.design.name);
    lines.emplace_back(
        "excess", fmt::format("{:.3f} um highest material{}", s.excess_max_um, proven_words(s.excess_bound)));
    if (s.ridges > 0) lines.emplace_back("scallop", fmt::format("{:.3f} um highest", s.scallop_max_um));
  } else {
    lines.emplace_back("scallop", fmt::format("{:.3f} um highest, {:.3f} um at 5 %, theory {:.3f} um",
                                              s.scallop_max_um, s.scallop_p05_um, s.scallop_theory_um));
  }
  lines.emplace_back("gouge",
                     fmt::format("{:.3f} um deepest{}", s.gouge_max_um, proven_words(s.gouge_bound)));
  lines.emplace_back(
      "tolerance",
      fmt::format("{:.2f} % of {} rays within -{:g} .. +{:g} um", s.within_tolerance_pct, s.samples,
                  job.scene.accept.gouge_band_um(), job.scene.accept.scallop_band_um()));
  return lines;
}

/// Empty where the scene says everything.
std::vector<Table> assumption_tables(const sim::Job& job) {
  if (job.scene.assumptions.empty()) return {};
  Table table;
  table.title = "What was assumed";
  table.intro = "Neither the program nor the scene says it; the last column is where to say it.";
  table.columns = {{"What"}, {"Taken"}, {"Why"}, {"Say it by"}};
  for (const sim::Assumption& one : job.scene.assumptions)
    table.rows.push_back({one.what, one.value, one.reason, one.change});
  return {table};
}

}  // namespace

namespace {

JobHead job_head_of(const sim::ReportSettings& report) {
  JobHead head{report.logo_file, {}};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) head.facts.push_back({name, value});
  };
  add("Job", report.job);
  add("Part number", report.part_number);
  add("Customer", report.customer);
  add("Date", report.date);
  add("Approval", report.approval);
  return head;
}

}  // namespace

namespace {

/// Over one place of the design more than one surface may stand.
std::string hanging_note(const measure::SurfaceMetrics& surface) {
  if (surface.overhung_samples == 0) return "";
  return fmt::format(
      "Above {} of {} measuring rays there is material beyond a gap, as over an undercut; its colours, like "
      "all others, say how far above the design it stands. The highest material of all stands {:.3f} µm "
      "above the design.",
      surface.overhung_samples, surface.samples, surface.excess_max_um);
}

}  // namespace

ReportData report_data(const sim::Job& job, const sim::Result& result, const RunFiles& files, bool rendered) {
  ReportData data;
  data.title = job.scene.title;
  data.subtitle =
      fmt::format("{} on {}", job.scene.program_file.substr(job.scene.program_file.find_last_of('/') + 1),
                  job.machine.model.name);
  data.head = job_head_of(job.scene.report);
  data.verdict = verdict_of(result.checks);
  data.key_numbers = brings_blocks(result) ? block_key_numbers(result) : key_numbers(result);
  data.findings = report_findings(result);
  for (size_t i = 0; i < std::min(files.finding_pngs.size(), data.findings.size()); ++i)
    data.findings[i].picture_png = files.finding_pngs[i];
  if (!files.finding_pngs.empty() && data.findings.size() > files.finding_pngs.size())
    data.findings_note = fmt::format(
        "Pictures of the first {} alone; swarf render DIR --finding N --still N.png draws any other.",
        files.finding_pngs.size());
  data.assumptions = assumption_tables(job);
  if (!files.stills.empty()) {
    data.hero_png = files.stills.front().png_path;
    data.hero_caption = files.stills.front().caption;
    data.stills.assign(files.stills.begin() + 1, files.stills.end());
  }
  const render::DeviationScale scale = deviation_scale(job, result.main.dexels);
  data.viewer = {files.part_glb, files.machine_glb,
                 job.has_design() ? deviation_colour_bar(scale) : ColourBar(), files.animation_scale};
  data.viewer.colour_bar.low_value = -scale.below_um;
  data.viewer.colour_bar.high_value = scale.above_um;
  data.viewer.program = page_program(job, result, files);
  data.viewer.hanging = hanging_note(result.main.surface);
  data.movie_mp4 = files.movie;
  const std::vector<sim::MovieShot>& shots = job.scene.movie.shots;
  data.movie_even = shots.size() == 1 && shots.front().speed == sim::MovieSpeed::kTime &&
                    !shots.front().from_s && !shots.front().to_s && !shots.front().from_line &&
                    !shots.front().to_line;
  data.movie_caption =
      "The whole program, evenly sped up. The tool cuts the stock as it stands at that moment.";
  data.plots = run_plots(job, result);
  if (brings_blocks(result)) {
    data.tables = {axis_table(job, result), axis_limit_table(job, result)};
    if (result.flank) data.tables.insert(data.tables.begin(), flank_table(*result.flank));
  } else if (result.driven) {
    data.tables = {axis_table(job, result), axis_limit_table(job, result)};
  } else {
    data.tables = {planner_table(result), mode_table(result), axis_table(job, result),
                   axis_limit_table(job, result), fig6_table()};
    data.paper_title = "Lin & Koren: the paper's figures against ours";
    data.paper = papers::lin_koren_rows(job, result);
  }
  const std::vector<Table> first{cycle_time_table(job, result), tools_table(job, result)};
  data.tables.insert(data.tables.begin(), first.begin(), first.end());
  if (result.singularity) {
    const std::vector<kinematics::MachineModel> by_tool = sim::machines_by_tool(job);
    const kinematics::MachineModel& machine =
        papers::machine_of_worst(by_tool, result.main.path, *result.singularity);
    const papers::BlockStudy study = papers::study_block(machine, result.singularity->worst.front());
    data.topics = {singularity_topic(result.main.path, *result.singularity, study)};
    data.paper = papers::so_paper_rows(machine, *result.singularity);
    if (!data.paper.empty()) data.paper_title = "So et al. (2008), Table 2 and section 5";
  }
  if (result.driven) data.topics.insert(data.topics.begin(), driven_topic(result));
  if (result.flank_milling) data.topics.insert(data.topics.begin(), flank_topic(job, result));
  data.checks = checks_of(job, result, rendered);
  data.facts = facts_of(job, result, files);
  data.facts.insert(data.facts.begin() + 1, time_facts(job, result));
  if (result.main.nc) {
    data.facts.insert(data.facts.begin() + 1, nc_facts(job, result));
    const std::vector<Check> more = nc_checks(job, result);
    data.checks.insert(data.checks.end(), more.begin(), more.end());
  }
  if (job.cl) {
    data.facts.insert(data.facts.begin() + 1, cl_facts(*job.cl));
    const std::vector<Check> more = cl_checks(*job.cl);
    data.checks.insert(data.checks.end(), more.begin(), more.end());
  }
  return data;
}

/// Contacts of neck, shank and holder, or how near they came.
std::string clearance_line(const sim::Result& result) {
  const sim::ToolClearance& clearance = result.clearance;
  if (clearance.events.empty()) {
    const sim::Check* const check = sim::find_check(result.checks, "collisions");
    if (check != nullptr && check->outcome == sim::Outcome::kNotJudged)
      return "not looked at: " + check->reason;
    return fmt::format(
        "shank and holder free over the whole way of {} sweeps (contacts of {:.3f} mm and more){}",
        clearance.checked_sweeps, clearance.sees_mm,
        check == nullptr || check->unseen.empty() ? "" : "; not looked at: " + check->unseen);
  }
  const auto deepest = std::max_element(clearance.events.begin(), clearance.events.end(),
                                        [](const auto& a, const auto& b) { return a.depth_mm < b.depth_mm; });
  return fmt::format("{} contacts; the {} stands {:.2f} mm deep in the stock", clearance.events.size(),
                     deepest->part, deepest->depth_mm);
}

/// Contacts of machine, fixtures and tools, or how near they came.
std::string machine_line(const sim::MachineContacts& contacts) {
  if (contacts.findings.pairs.empty()) return "not checked: no pairs of links, fixtures and tools";
  std::string line = fmt::format("{} contacts among {} pairs of links, fixtures and tools",
                                 contacts.contacts(), contacts.findings.pairs.size());
  if (const auto& stock = contacts.as_cut)
    line += fmt::format("; {} times at the raw stock: {} in what is left of it, {} open, {} clear",
                        stock->suspects, stock->count(sim::StockVerdict::kContact),
                        stock->count(sim::StockVerdict::kOpen), stock->count(sim::StockVerdict::kClear));
  const collision::PairFindings* const nearest = contacts.nearest();
  if (contacts.findings.pairs.empty()) return "not looked at: no two bodies move against each other";
  if (nearest == nullptr)
    return line + fmt::format("; none comes nearer than {:g} mm", contacts.near_miss_mm);
  return line + fmt::format("; nearest: {} and {}, {:.3f} mm", contacts.bodies[nearest->a].name,
                            contacts.bodies[nearest->b].name, nearest->near_miss.upper);
}

std::vector<std::pair<std::string, std::string>> summary_lines(const sim::Job& job,
                                                               const sim::Result& result) {
  Lines lines = result.main.nc    ? nc_lines(job, result)
                : job.cl          ? cl_path_lines(job, result)
                : job.scene.flank ? flank_path_lines(job, result)
                                  : path_lines(job, result);
  if (result.flank_milling)
    for (auto& line : flank_lines(job, result)) lines.push_back(std::move(line));
  if (result.driven)
    for (auto& line : driven_lines(result)) lines.push_back(std::move(line));
  const Lines surface = surface_lines(job, result);
  lines.insert(lines.end(), surface.begin(), surface.end());
  const stock::CutStatistics& cut = result.stock->statistics();
  lines.emplace_back("removed", fmt::format("{:.1f} mm3, {:.1f} mm3 left, proven within {:.1f} mm3",
                                            result.volume_removed_mm3, result.volume_left_mm3,
                                            result.volume_error_bound_mm3));
  lines.emplace_back(
      "cutting",
      fmt::format("{} blocks in {:.2f} s = {:.0f} blocks/s, {:g} mm voxels", cut.sweeps, cut.seconds,
                  cut.seconds > 0 ? static_cast<double>(cut.sweeps) / cut.seconds : 0.0,
                  job.scene.stock.voxel_mm));
  lines.emplace_back("clearance", clearance_line(result));
  if (result.main.contacts) lines.emplace_back("machine", machine_line(*result.main.contacts));
  if (!result.left_out.empty()) lines.emplace_back("left out", left_out_words(job, result));
  return lines;
}

}  // namespace swarf::reports

#include "reports/movie_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/diagnostics.h"
#include "base/units.h"
#include "program/source_text.h"
#include "render/lettering.h"

namespace swarf::reports {
namespace {

constexpr double kFlashSeconds = 1.5;  // that a finding stays on the picture
constexpr size_t kFlashesMost = 3;     // at once
constexpr double kAwaySizes = 0.5;     // of the stock's greatest side: a tool farther away is told
constexpr double kAtHome = 1e-3;       // mm, rad
/// Of the picture's height that the lines may cover. Letters cannot become smaller with it for ever: a small
/// movie leaves out axis values, then the place.
constexpr double kCaptionShare = 1.0 / 6.0;
constexpr size_t kLineLetters = 70;  // of a program's line or a finding's text

/// At most so many letters; never half of one.
std::string shortened(const std::string& text, size_t most) {
  std::string line = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  std::replace(line.begin(), line.end(), '\t', ' ');
  size_t letters = 0;
  for (size_t i = 0; i < line.size(); ++i) {
    if ((static_cast<unsigned char>(line[i]) & 0xc0U) != 0x80U && ++letters > most)
      return line.substr(0, i) + "...";
  }
  return line;
}

double distance_to(const Box& box, const Vec3& place) {
  return (place - box.lower.cwiseMax(place.cwiseMin(box.upper))).norm();
}

/// Of a tool that need not be in the picture: that it stands at home, or how far it is from the stock.
std::string whereabouts(const sim::Job& job, const motion::Cycle& cycle) {
  const std::vector<kinematics::Axis>& axes = job.machine.model.axes;
  const Box& stock = job.scene.stock.box_W;
  const double away = distance_to(stock, cycle.sample.pose.tip_W);
  if (away <= kAwaySizes * stock.size().maxCoeff()) return "";
  bool home = true;
  for (size_t a = 0; a < axes.size(); ++a)
    home = home && std::abs(cycle.q[static_cast<Eigen::Index>(a)] - axes[a].home) < kAtHome;
  return home ? "   at home" : fmt::format("   {:.0f} mm from the stock", away);
}

}  // namespace

MovieOverlay::MovieOverlay(const FinishedRun& run, const std::vector<PlannedFrame>& frames)
    : run_(run), frames_(frames), flashes_(frames.size()) {
  std::map<std::string, std::set<int>> wanted;
  for (const PlannedFrame& frame : frames) {
    const SourceLocation where = run.cycles.elements().where(static_cast<size_t>(frame.cycle.sample.element));
    if (where.line > 0) wanted[where.file].insert(where.line);
  }
  for (const auto& [file, lines] : wanted) {
    try {
      texts_[file] = program::read_lines(file, lines);
    } catch (const InputError&) {
      continue;  // a program that is gone by now is shown without its text
    }
  }
  find_flashes();
}

/// A finding is shown from the frame that passes its time on.
void MovieOverlay::find_flashes() {
  if (run_.findings == nullptr) return;
  const auto last = static_cast<size_t>(std::max(1.0, kFlashSeconds * run_.job.scene.movie.fps));
  for (const sim::Finding& finding : *run_.findings) {
    if (finding.where.line <= 0 || finding.severity == Severity::kNote) continue;
    for (size_t f = 1; f < frames_.size(); ++f) {
      const bool passes = frames_[f - 1].shot == frames_[f].shot &&
                          frames_[f - 1].cycle.sample.t_s < finding.t_s &&
                          frames_[f].cycle.sample.t_s >= finding.t_s;
      if (!passes) continue;
      for (size_t k = f; k < std::min(f + last, frames_.size()); ++k)
        if (flashes_[k].size() < kFlashesMost)
          flashes_[k].push_back(
              shortened(fmt::format("line {}: {}", finding.where.line, finding.text), kLineLetters));
    }
  }
}

std::string MovieOverlay::program_line(const motion::Cycle& cycle) const {
  const SourceLocation where = run_.cycles.elements().where(static_cast<size_t>(cycle.sample.element));
  if (where.line <= 0) return run_.job.scene.name;
  const auto file = texts_.find(where.file);
  if (file == texts_.end() || file->second.count(where.line) == 0) return fmt::format("line {}", where.line);
  return fmt::format("{}  {}", where.line, shortened(file->second.at(where.line), kLineLetters));
}

std::vector<std::string> MovieOverlay::lines_of(const motion::Cycle& cycle) const {
  const motion::ToolSample& sample = cycle.sample;
  const toolpath::Elements& elements = run_.cycles.elements();
  std::string axes,
      words = fmt::format("t {:8.2f} s   F {:5.0f} mm/min", sample.t_s, mm_min_from_mm_s(sample.feed_mm_s));
  if (elements.hold_blocks()) {
    const auto rpm = elements.block(static_cast<size_t>(sample.element)).spindle_rpm;
    if (rpm) words += fmt::format("   S {:.0f}", std::abs(*rpm));
  }
  const std::vector<cutter::Cutter>& tools = run_.job.scene.tools;
  words += fmt::format("   {}", cutter::call_name(tools[static_cast<size_t>(sample.tool)])) +
           whereabouts(run_.job, cycle);
  const Vec3 &tip = sample.pose.tip_W, &axis = sample.pose.axis_W;
  for (size_t a = 0; a < run_.job.machine.model.axes.size(); ++a) {
    const kinematics::Axis& one = run_.job.machine.model.axes[a];
    const double q = cycle.q[static_cast<Eigen::Index>(a)];
    const bool rotary = one.kind == kinematics::AxisKind::kRotary;
    axes += fmt::format("   {}{:8.2f}{}", one.name, rotary ? deg_from_rad(q) : q, rotary ? "°" : "");
  }
  std::string work = fmt::format("work   x{:8.2f}   y{:8.2f}   z{:8.2f}", tip.x(), tip.y(), tip.z());
  if (run_.job.machine.model.axes.size() > 3)
    work += fmt::format("   i{:6.3f}   j{:6.3f}   k{:6.3f}", axis.x(), axis.y(), axis.z());
  return {program_line(cycle), words, work, "axes" + axes};
}

std::vector<std::pair<size_t, std::string>> MovieOverlay::tools() const {
  std::vector<std::pair<size_t, std::string>> list;
  for (size_t f = 0; f < frames_.size(); ++f) {
    const auto tool = static_cast<size_t>(frames_[f].cycle.sample.tool);
    if (f > 0 && tool == static_cast<size_t>(frames_[f - 1].cycle.sample.tool)) continue;
    list.emplace_back(f, cutter::call_name(run_.job.scene.tools[tool]));
  }
  if (list.size() < 2) list.clear();  // one chapter divides nothing
  return list;
}

void MovieOverlay::draw(size_t frame, render::Image& image) const {
  const motion::Cycle& cycle = frames_[frame].cycle;
  std::vector<std::string> lines = lines_of(cycle);
  lines.resize(std::min(lines.size(), render::caption_lines(image.height, kCaptionShare)));
  render::draw_caption(image, lines);
  const double whole = std::max(run_.cycles.time_s(), run_.cycles.period_s());
  render::draw_progress(image, std::clamp(cycle.sample.t_s / whole, 0.0, 1.0));
  // Twice a second, so that it is seen.
  const auto blink = static_cast<int>(2 * frame / static_cast<size_t>(run_.job.scene.movie.fps)) % 2;
  render::draw_notice(image, flashes_[frame], blink == 0);
}

}  // namespace swarf::reports

#include "reports/path_view.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "sim/run/block_rows.h"

namespace swarf::reports {
namespace {

constexpr size_t kCyclesLooked = 200'000;  // of elements that are no blocks

void append_arc(const toolpath::BlockMove& block, const WayPoint& end, double start_s,
                std::vector<WayPoint>& points) {
  const Vec3& normal = block.arc->normal_W;
  const Vec3 spoke = block.from.tip_W - block.arc->centre_W;
  const Vec3 radial = spoke - spoke.dot(normal) * normal;
  const double angle = toolpath::arc_angle(block), radius = std::max(radial.norm(), kWayError);
  // Sagitta of a chord: r (1 - cos(step / 2)) = kWayError.
  const double step = 2.0 * std::acos(std::max(0.0, 1.0 - kWayError / radius));
  const int chords = std::clamp(static_cast<int>(std::ceil(angle / step)), 1, 720);
  const Vec3 rise = normal * (block.to.tip_W - block.from.tip_W).dot(normal);
  for (int i = 1; i < chords; ++i) {
    const double share = static_cast<double>(i) / chords;
    WayPoint point = end;
    point.tip_W = block.arc->centre_W + Eigen::AngleAxisd(share * angle, normal) * spoke + share * rise;
    point.t_s = start_s + share * (end.t_s - start_s);
    points.push_back(point);
  }
}

std::vector<WayPoint> points_of_blocks(const FinishedRun& run) {
  const toolpath::Elements& elements = run.cycles.elements();
  const std::vector<sim::BlockRow> rows = sim::block_rows(run.cycles);
  std::vector<WayPoint> points;
  double before_s = 0.0;
  for (size_t i = 0; i < std::min(rows.size(), elements.size()); ++i) {
    const toolpath::BlockMove block = elements.block(i);
    WayPoint end{block.to.tip_W, rows[i].t_s,  rows[i].feed_mm_s.value_or(block.feed_mm_s),
                 block.tool,     rows[i].line, toolpath::is_rapid(block)};
    if (i == 0 || (block.from.tip_W - points.back().tip_W).norm() > kWayError) {
      WayPoint start = end;
      start.tip_W = block.from.tip_W;
      start.t_s = before_s;
      points.push_back(start);
    }
    if (block.arc) append_arc(block, end, before_s, points);
    points.push_back(end);
    before_s = end.t_s;
  }
  return points;
}

std::vector<WayPoint> points_of_cycles(const FinishedRun& run) {
  std::vector<WayPoint> points;
  const size_t shown = run.last_shown() - run.first_shown() + 1;
  for (const motion::Cycle& cycle : run.shown_cycles(std::min(shown, kCyclesLooked))) {
    const motion::ToolSample& sample = cycle.sample;
    points.push_back({sample.pose.tip_W, sample.t_s, sample.feed_mm_s, sample.tool,
                      run.cycles.elements().line(static_cast<size_t>(sample.element)),
                      sample.kind == motion::SampleKind::kRapid});
  }
  return points;
}

bool alike(const WayPoint& a, const WayPoint& b) {
  return a.tool == b.tool && a.line == b.line && a.rapid == b.rapid;
}

double off_line(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - from - share * along).norm();
}

/// Ramer, Douglas and Peucker within [first, last]; `kept` marks what stays.
void thin(const std::vector<WayPoint>& points, size_t first, size_t last, double error_mm,
          std::vector<uint8_t>& kept) {
  std::vector<std::pair<size_t, size_t>> open{{first, last}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    size_t farthest = a;
    double most = error_mm;
    for (size_t i = a + 1; i < b; ++i) {
      const double off = off_line(points[i].tip_W, points[a].tip_W, points[b].tip_W);
      if (off > most) most = off, farthest = i;
    }
    if (farthest == a) continue;
    kept[farthest] = 1;
    open.emplace_back(a, farthest);
    open.emplace_back(farthest, b);
  }
}

/// Ends of blocks stay: the time and the line there are known.
std::vector<WayPoint> thinned_way(const std::vector<WayPoint>& points, double error_mm, bool keep_lines) {
  std::vector<uint8_t> kept(points.size(), 0);
  size_t first = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const bool last = i + 1 == points.size();
    const bool ends =
        last || (keep_lines ? !alike(points[i], points[i + 1])
                            : points[i].tool != points[i + 1].tool || points[i].rapid != points[i + 1].rapid);
    if (!ends) continue;
    kept[first] = kept[i] = 1;
    thin(points, first, i, error_mm, kept);
    first = i;
  }
  std::vector<WayPoint> out;
  for (size_t i = 0; i < points.size(); ++i)
    if (kept[i] != 0) out.push_back(points[i]);
  return out;
}

}  // namespace

Way program_way(const FinishedRun& run) {
  Way way;
  const std::vector<WayPoint> all =
      run.cycles.elements().hold_blocks() ? points_of_blocks(run) : points_of_cycles(run);
  if (all.empty()) return way;
  way.error_mm = kWayError;
  way.points = thinned_way(all, way.error_mm, true);
  for (int tries = 0; way.points.size() > kWayPoints && tries < 20; ++tries) {
    way.error_mm *= 2.0;
    way.points = thinned_way(all, way.error_mm, false);
  }
  return way;
}

std::array<uint8_t, 4> tool_colour(size_t tool) {
  // Okabe and Ito's colours: told apart without red and green.
  static constexpr std::array<std::array<uint8_t, 4>, 6> kColours{{{213, 94, 0, 255},
                                                                   {0, 114, 178, 255},
                                                                   {0, 158, 115, 255},
                                                                   {204, 121, 167, 255},
                                                                   {230, 159, 0, 255},
                                                                   {86, 180, 233, 255}}};
  return kColours.at(tool % kColours.size());
}

render::GltfPath gltf_path(const Way& way) {
  constexpr std::array<uint8_t, 4> kRapid{120, 128, 138, 255};
  render::GltfPath path;
  path.name = "path";
  std::vector<float>&time = path.numbers["_TIME_S"], &feed = path.numbers["_FEED_MM_MIN"],
  &tool = path.numbers["_TOOL"], &line = path.numbers["_LINE"], &rapid = path.numbers["_RAPID"];
  for (const WayPoint& point : way.points) {
    const Eigen::Vector3f p = point.tip_W.cast<float>();
    path.points.push_back({p.x(), p.y(), p.z()});
    path.colours.push_back(point.rapid ? kRapid : tool_colour(static_cast<size_t>(point.tool)));
    time.push_back(static_cast<float>(point.t_s));
    feed.push_back(static_cast<float>(mm_min_from_mm_s(point.feed_mm_s)));
    tool.push_back(static_cast<float>(point.tool));
    line.push_back(static_cast<float>(point.line));
    rapid.push_back(point.rapid ? 1.0F : 0.0F);
  }
  return path;
}

}  // namespace swarf::reports

#include "reports/chips.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/units.h"
#include "cutter/profile.h"

namespace swarf::reports {
namespace {

constexpr double kTicks = 240.0;  // in a second of the movie
constexpr size_t kPoints = 256;   // of the flutes, at each tick
/// Of the tool's diameter: chords of the outline that no point of a chip shows.
constexpr double kOutlineTolerance = 1e-3;
/// By which a chip rises from the plane in which its tooth turns, rad: flutes lift it.
constexpr double kLiftLeast = 0.15, kLiftMost = 0.8;
/// Of its tumbling, rad/s.
constexpr double kTumbleLeast = 20.0, kTumbleMost = 80.0;

uint64_t seed_of(int element, uint64_t cycle) {
  Hash hash;
  hash.add(static_cast<uint64_t>(element));
  hash.add(cycle);
  return hash.value();
}

/// rad/s about the tool's axis, from the tip to the spindle; clockwise, as the spindle looks, is below 0.
double turn_of(const FinishedRun& run, const motion::ToolSample& sample) {
  const toolpath::Elements& elements = run.cycles.elements();
  if (elements.hold_blocks()) {
    const auto rpm = elements.block(static_cast<size_t>(sample.element)).spindle_rpm;
    if (rpm) return -*rpm * 2.0 * kPi / 60.0;
  }
  return -kUnsaidCuttingSpeed / run.job.scene.tools[static_cast<size_t>(sample.tool)].radius();
}

}  // namespace

ChipClock chip_clock(double rate, double removed_mm3, double time_s, double period_s) {
  ChipClock clock;
  clock.flight = std::min(1.0, kFlightSpeed / rate);
  clock.step = static_cast<size_t>(std::max(1.0, std::floor(rate / kTicks / period_s)));
  const double life_s = kFlight_s / clock.flight;
  if (removed_mm3 > 0.0 && time_s > 0.0) clock.one_mm3 = removed_mm3 * life_s / time_s / kChipsMean;
  return clock;
}

double rate_of_shot(const std::vector<PlannedFrame>& frames, size_t shot, int fps, double period_s) {
  std::vector<double> steps;
  for (size_t f = 1; f < frames.size(); ++f) {
    if (frames[f].shot == shot && frames[f - 1].shot == shot)
      steps.push_back(frames[f].cycle.sample.t_s - frames[f - 1].cycle.sample.t_s);
  }
  if (steps.empty()) return 1.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return std::exp2(std::round(std::log2(std::max(*middle, period_s) * fps)));
}

Pose flown(const Chip& chip, const Pose& X_born, double lowest) {
  const Vec3 from = X_born * chip.place_W, speed = X_born.linear() * chip.speed_W;
  const double above = std::max(from.z() - lowest, 0.0);
  const double down_s = (speed.z() + std::sqrt(speed.z() * speed.z() + 2.0 * kGravity * above)) / kGravity;
  const double t = std::min(chip.flown_s, std::max(down_s, 0.0));
  Rng rng(chip.seed);
  const Vec3 axis = rng.direction();
  const double tumble = rng.uniform(0.0, 2.0 * kPi) + t * rng.uniform(kTumbleLeast, kTumbleMost);
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(tumble, axis).toRotationMatrix();
  pose.translation() = from + t * speed - 0.5 * kGravity * t * t * Vec3::UnitZ();
  return pose;
}

Chips::Chips(const FinishedRun& run, const std::vector<PlannedFrame>& frames)
    : run_(run), reader_(run.cycles) {
  const sim::MovieSettings& movie = run.job.scene.movie;
  clocks_.resize(movie.shots.size());
  if (std::none_of(movie.shots.begin(), movie.shots.end(), [](const auto& shot) { return shot.chips; }))
    return;
  const stock::Stock raw = sim::starting_stock(run.job, run.carried, movie.voxel_mm);
  const double removed = raw.volume_mm3() - run.stock.volume_mm3(), period = run.cycles.period_s();
  for (size_t i = 0; i < clocks_.size(); ++i) {
    if (movie.shots[i].chips)
      clocks_[i] =
          chip_clock(rate_of_shot(frames, i, movie.fps, period), removed, run.cycles.time_s(), period);
  }
  for (const cutter::Cutter& tool : run.job.scene.tools) {
    Flutes flutes{cutter::sample_outline(cutter::outline(tool), kOutlineTolerance * tool.diameter_mm), {}};
    double area = 0.0;
    for (size_t i = 1; i < flutes.corners.size(); ++i) {
      const Vec2 &a = flutes.corners[i - 1], &b = flutes.corners[i];
      area += kPi * (a.x() + b.x()) * (b - a).norm();
      flutes.area_to.push_back(area);
    }
    flutes_.push_back(std::move(flutes));
  }
}

std::vector<Chip> Chips::at(const PlannedFrame& frame) {
  const ChipClock& clock = clocks_[frame.shot];
  if (clock.one_mm3 == 0.0) return {};
  const uint64_t now = frame.cycle.number;
  const double period = run_.cycles.period_s(), life_s = kFlight_s / clock.flight;
  const auto life = static_cast<uint64_t>(std::ceil(life_s / period));
  if (frame.shot != shot_ || now < now_) {
    flying_.clear();
    next_tick_ = 0;
  }
  shot_ = frame.shot;
  now_ = now;
  // The first tick whose chips may still fly.
  const uint64_t first = now < life ? 0 : (now - life) / clock.step * clock.step;
  next_tick_ = std::max(next_tick_, first);
  if (next_tick_ < cut_to_) along_.reset();  // cut farther already, for the shot before
  for (; next_tick_ <= now; next_tick_ += clock.step) tick(next_tick_, clock);
  while (!flying_.empty() && frame.cycle.sample.t_s - flying_.front().born_s >= life_s) flying_.pop_front();
  std::vector<Chip> chips(flying_.begin(), flying_.end());
  for (Chip& chip : chips) chip.flown_s = (frame.cycle.sample.t_s - chip.born_s) * clock.flight;
  return chips;
}

void Chips::tick(uint64_t cycle, const ChipClock& clock) {
  if (cycle == 0) return;
  cut_to_ = cycle;
  const motion::Cycle before = reader_.at(cycle - 1);
  const motion::Cycle now = reader_.at(cycle);
  if (!along_) along_.emplace(run_.job, run_.carried, run_.cycles, run_.job.scene.movie.voxel_mm);
  along_->advance_whole(before);
  const double turn = turn_of(run_, now.sample);
  if (now.sample.kind == motion::SampleKind::kRapid || now.sample.tool != before.sample.tool || turn == 0.0)
    return;
  Rng rng(seed_of(now.sample.element, now.number));
  const std::vector<Engaged> points = engaged(before, now, rng);
  if (points.empty()) return;
  const double time_s = static_cast<double>(clock.step) * run_.cycles.period_s();
  const double area = flutes_[static_cast<size_t>(now.sample.tool)].area_to.back();
  const double removed = time_s * area * points.back().flux_to / static_cast<double>(kPoints);
  removed_mm3_ += removed;
  const double count =
      std::min(std::floor(removed / clock.one_mm3 + rng.uniform()), static_cast<double>(kChipsMost));
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) flying_.push_back(thrown(now, turn, points, rng));
  if (flying_.size() > kChipsMost)
    flying_.erase(flying_.begin(), flying_.end() - static_cast<std::ptrdiff_t>(kChipsMost));
}

/// Those of the random points that move into material.
std::vector<Chips::Engaged> Chips::engaged(const motion::Cycle& before, const motion::Cycle& now,
                                           Rng& rng) const {
  const Flutes& flutes = flutes_[static_cast<size_t>(now.sample.tool)];
  const ToolPose &from = before.sample.pose, &to = now.sample.pose;
  const Vec3 way = to.tip_W - from.tip_W, turn = from.axis_W.cross(to.axis_W);
  const Eigen::Quaterniond stands = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), to.axis_W);
  std::vector<Engaged> found;
  double flux = 0.0;
  for (size_t i = 0; i < kPoints; ++i) {
    const double at = (static_cast<double>(i) + rng.uniform()) / static_cast<double>(kPoints);
    const double angle = rng.uniform(0.0, 2.0 * kPi), along = rng.uniform();
    const double area = at * flutes.area_to.back();
    const auto cone = static_cast<size_t>(
        std::upper_bound(flutes.area_to.begin(), flutes.area_to.end() - 1, area) - flutes.area_to.begin());
    const Vec2 &a = flutes.corners[cone], &b = flutes.corners[cone + 1];
    // Evenly over the cone's area: rho^2 is even between its ends' where they differ.
    const double rho = std::sqrt(a.x() * a.x() + along * (b.x() * b.x() - a.x() * a.x()));
    const double share = std::abs(b.x() - a.x()) > 1e-9 ? (rho - a.x()) / (b.x() - a.x()) : along;
    const Vec2 normal = cutter::outward((b - a).normalized());
    const Vec3 radial(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 arm = stands * (rho * radial + (a.y() + share * (b.y() - a.y())) * Vec3::UnitZ());
    const double into =
        (way + turn.cross(arm)).dot(stands * (normal.x() * radial + normal.y() * Vec3::UnitZ()));
    if (into <= 0.0 || along_->stock().distance_mm(to.tip_W + arm) >= 0.0) continue;
    flux += into / run_.cycles.period_s();
    found.push_back({to.tip_W + arm, stands * radial, rho, flux});
  }
  return found;
}

/// From one of the points, the more likely the more it removes, the way that its tooth goes.
Chip Chips::thrown(const motion::Cycle& now, double turn_rad_s, const std::vector<Engaged>& from,
                   Rng& rng) const {
  const double flux = rng.uniform(0.0, from.back().flux_to);
  const Engaged& point = *std::upper_bound(from.begin(), from.end() - 1, flux,
                                           [](double value, const Engaged& e) { return value < e.flux_to; });
  const Vec3& axis = now.sample.pose.axis_W;
  const Vec3 tooth = turn_rad_s * point.rho * axis.cross(point.outward_W);
  const double lift = rng.uniform(kLiftLeast, kLiftMost);
  Chip chip;
  chip.born_s = now.sample.t_s;
  chip.place_W = point.place_W;
  chip.speed_W = std::cos(lift) * tooth + std::sin(lift) * tooth.norm() * axis;
  chip.q = now.q;
  chip.tool = static_cast<size_t>(now.sample.tool);
  chip.seed = rng.next();
  return chip;
}

}  // namespace swarf::reports

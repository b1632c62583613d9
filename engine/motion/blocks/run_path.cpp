#include "motion/blocks/run_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "kinematics/forward_chain.h"

namespace swarf::motion {
namespace {

using kinematics::AxisValues;
using toolpath::BlockMove;

/// Blocks shorter than this go nowhere, mm.
constexpr double kRunLengthMin = 1e-9;
/// A corner of a lower tolerance is passed at rest, mm: the axis values' rounding is no longer far below it.
constexpr double kSharp = 1e-9;
/// Share of a block that each of its corners may take.
constexpr double kCornerShare = 0.5;
/// Slopes that differ by less are one straight line.
constexpr double kStraight = 1e-12;
constexpr int kFits = 40;
/// Speed of a rapid that no axis limits (out of reach), mm/s.
constexpr double kRapidUnfollowed = 1000.0;

/// Integral twice over of a triangle of height 2 on [0,1]: slope 0 to 1, bend 0 at both ends.
double triangular_turn(double x) {
  const double y = 1.0 - x;
  return x <= 0.5 ? x * x * x / 1.5 : x - 0.5 + y * y * y / 1.5;
}

Blend blend_between(const BlockCurve::Jet& a, const BlockCurve::Jet& b, double before, double after) {
  Blend blend;
  blend.before = before;
  blend.length = before + after;
  const double l = blend.length;
  blend.turn = l * (b.first - a.first);
  const AxisValues v = l * a.first, a0 = l * l * a.second, a1 = l * l * b.second;
  // What the turn leaves to the quintic: no change of slope.
  const AxisValues change = b.value - a.value - triangular_turn(1.0) * blend.turn;
  blend.coefficient[0] = a.value;
  blend.coefficient[1] = v;
  blend.coefficient[2] = 0.5 * a0;
  blend.coefficient[3] = 10.0 * (change - v) - 1.5 * a0 + 0.5 * a1;
  blend.coefficient[4] = -15.0 * (change - v) + 1.5 * a0 - a1;
  blend.coefficient[5] = 6.0 * (change - v) - 0.5 * (a0 - a1);
  return blend;
}

/// Where a x^2 + b x + c is 0, ascending; both NaN where it never is, one is infinite or NaN where a is 0.
std::array<double, 2> quadratic_roots(double a, double b, double c) {
  const double root = std::sqrt(b * b - 4.0 * a * c);
  const double far = -0.5 * (b + std::copysign(root, b));
  const double first = far / a, second = c / far;
  return first < second ? std::array{first, second} : std::array{second, first};
}

/// The root between two places of different sign: Newton's steps, halves where they would leave the bracket.
/// A place of greatest_of() where the slope is all but 0: its own rounding shows in the value by its square.
double root_of_cubic(std::span<const double, 4> c, double low, double high, bool rises) {
  double x = 0.5 * (low + high);
  for (int i = 0; i < 60; ++i) {
    const double value = ((c[3] * x + c[2]) * x + c[1]) * x + c[0];
    ((value < 0.0) == rises ? low : high) = x;
    const double next = x - value / ((3.0 * c[3] * x + 2.0 * c[2]) * x + c[1]);
    const double taken = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(taken - x) < 1e-12) return taken;
    x = taken;
  }
  return x;
}

/// Greatest |p| on [0,1], p of degree 2 to 4: at an end or where its slope is 0.
template <size_t N>
double greatest_of(const std::array<double, N>& p) {
  double result = 0.0;
  const auto see = [&](double x) {
    if (!(x >= 0.0 && x <= 1.0)) return;
    double sum = 0.0;
    for (size_t k = N; k-- > 0;) sum = sum * x + p[k];
    result = std::max(result, std::abs(sum));
  };
  see(0.0);
  see(1.0);
  if constexpr (N == 3) {
    see(-0.5 * p[1] / p[2]);
  } else if constexpr (N == 4) {
    for (const double x : quadratic_roots(3.0 * p[3], 2.0 * p[2], p[1])) see(x);
  } else {
    static_assert(N == 5);
    const std::array<double, 4> slope{p[1], 2.0 * p[2], 3.0 * p[3], 4.0 * p[4]};
    // The turns of the slope divide [0,1] into pieces with one root of it at most.
    const auto turns = quadratic_roots(3.0 * slope[3], 2.0 * slope[2], slope[1]);
    const auto at = [&](double x) { return ((slope[3] * x + slope[2]) * x + slope[1]) * x + slope[0]; };
    double from = 0.0;
    for (const double end : {turns[0], turns[1], 1.0}) {
      if (!(end > from && end <= 1.0)) continue;
      const double a = at(from), b = at(end);
      if ((a < 0.0) != (b < 0.0)) see(root_of_cubic(slope, from, end, a < b));
      see(end);
      from = end;
    }
  }
  return result;
}

/// Then q(s) runs on with two derivatives, and there is no corner.
bool on_one_curve(const BlockCurve& a, const BlockCurve& b) {
  if (a.law() == nullptr || b.law() == nullptr) return false;
  const BlockMove &from = a.law()->motion.block, &to = b.law()->motion.block;
  return from.curve && to.curve && toolpath::continues(*from.curve, *to.curve);
}

PathCell blend_cell(const Blend& blend) {
  PathCell cell;
  cell.corner = true;
  cell.length = blend.length;
  cell.first = cell.second = cell.third = AxisValues::Zero();
  const double l = blend.length;
  for (Eigen::Index i = 0; i < kinematics::kMaxAxes; ++i) {
    if (blend.turn[i] == 0.0 && blend.coefficient[1][i] == 0.0 && blend.coefficient[3][i] == 0.0 &&
        blend.coefficient[4][i] == 0.0 && blend.coefficient[5][i] == 0.0 && blend.coefficient[2][i] == 0.0)
      continue;
    std::array<double, 5> d1{};
    std::array<double, 4> d2{};
    std::array<double, 3> d3{};
    for (size_t k = 2; k <= 5; ++k) d1[k - 1] = static_cast<double>(k) * blend.coefficient[k][i];
    for (size_t k = 1; k <= 4; ++k) d2[k - 1] = static_cast<double>(k) * d1[k];
    for (size_t k = 1; k <= 3; ++k) d3[k - 1] = static_cast<double>(k) * d2[k];
    const double slope = blend.coefficient[1][i], turn = blend.turn[i];
    cell.first[i] = (std::max(std::abs(slope), std::abs(slope + turn)) + greatest_of(d1)) / l;
    cell.second[i] = (2.0 * std::abs(turn) + greatest_of(d2)) / (l * l);
    cell.third[i] = (4.0 * std::abs(turn) + greatest_of(d3)) / (l * l * l);
  }
  return cell;
}

}  // namespace

AxisValues Blend::q(double s) const {
  const double x = s / length;
  AxisValues sum = coefficient[5];
  for (int k = 4; k > 0; --k) sum = sum * x + coefficient[k];
  return coefficient[0] + x * sum + triangular_turn(x) * turn;
}

double corner_tolerance(const BlockMove& block, const MotionOptions& options) {
  return block.corner_tolerance_mm > 0.0 ? block.corner_tolerance_mm : options.corner_tolerance_mm;
}

RunPathBuilder::RunPathBuilder(const BlockMotions& motions, const kinematics::InverseKinematics& inverse,
                               const MotionOptions& options, const PathPlace& start)
    : motions_(motions),
      inverse_(inverse),
      options_(options),
      machine_(*motions[0].machine),
      forward_(machine_),
      rapid_(is_rapid(motions.block(0))),
      at_(start) {
  limits_ = axis_limits(machine_, rapid_);
  reference_mm_s_ = reference_speed();
  path_.first = start.before.value_or(start.next);
  at_.skip = 0;
  extend(start.skip);
  take(start.skip);
}

void RunPathBuilder::extend(size_t cells) {
  while (!done_ && path_.cells.size() < cells) {
    if (at_.next < motions_.size()) {
      look_at(at_.next);
    } else {
      if (at_.before) add_block_piece(*at_.before, at_.from, curve(*at_.before).length());
      done_ = true;
    }
  }
}

PathPlace RunPathBuilder::place(size_t cell) const {
  const size_t piece = path_.piece_of_cell[cell];
  const auto first = std::lower_bound(path_.piece_of_cell.begin(), path_.piece_of_cell.end(), piece);
  PathPlace place = place_of_piece_[piece];
  place.skip += cell - static_cast<size_t>(first - path_.piece_of_cell.begin());
  return place;
}

RunPath RunPathBuilder::take(size_t cells) {
  const bool all = cells >= path_.cells.size();
  const size_t pieces = all ? path_.pieces.size() : path_.piece_of_cell[cells];
  // A piece that is cut in two begins later from now on.
  if (!all) place_of_piece_[pieces] = place(cells);
  const auto blends = static_cast<size_t>(std::count_if(path_.pieces.begin(),
                                                        path_.pieces.begin() + static_cast<ptrdiff_t>(pieces),
                                                        [](const Piece& piece) { return piece.blend >= 0; }));
  const auto behind = [](const auto& list, size_t count) {
    return std::decay_t<decltype(list)>(list.begin() + static_cast<ptrdiff_t>(std::min(count, list.size())),
                                        list.end());
  };
  RunPath rest;
  rest.first = all ? at_.before.value_or(path_.first) : path_.pieces[pieces].block;
  rest.curves = behind(path_.curves, rest.first - path_.first);
  rest.blends = behind(path_.blends, blends);
  rest.pieces = behind(path_.pieces, pieces);
  rest.cells = behind(path_.cells, cells);
  rest.piece_of_cell = behind(path_.piece_of_cell, cells);
  rest.offset_of_cell = behind(path_.offset_of_cell, cells);
  place_of_piece_ = behind(place_of_piece_, pieces);
  for (size_t& piece : rest.piece_of_cell) piece -= pieces;
  for (Piece& piece : rest.pieces)
    if (piece.blend >= 0) piece.blend -= static_cast<int>(blends);
  return std::exchange(path_, std::move(rest));
}

/// The greatest_of feed; of rapids, and where durations alone are given, the fastest linear axis.
double RunPathBuilder::reference_speed() const {
  double feed = 0.0, axis = 0.0;
  for (size_t i = 0; i < motions_.size(); ++i) feed = std::max(feed, motions_.feed_mm_s(i));
  if (feed > 0.0 && !rapid_) return feed;
  for (const kinematics::Axis& own : machine_.axes)
    if (own.kind == kinematics::AxisKind::kLinear) axis = std::max(axis, own.speed_max);
  return axis;
}

const BlockCurve& RunPathBuilder::curve(size_t block) {
  while (path_.first + path_.curves.size() <= block)
    path_.curves.emplace_back(motions_[path_.first + path_.curves.size()], inverse_, reference_mm_s_);
  return path_.curve(block);
}

void RunPathBuilder::look_at(size_t block) {
  if (curve(block).length() < kRunLengthMin) {
    ++at_.next;
    return;
  }
  const double from = at_.before ? add_corner(*at_.before, block) : 0.0;
  at_ = {block, block + 1, from, 0};
}

void RunPathBuilder::add_cells(size_t first) {
  double offset = 0.0;
  PathPlace start = at_;
  for (size_t i = first; i < path_.cells.size(); ++i) {
    PathCell& cell = path_.cells[i];
    limit_speed(limits_, cell);
    if (!std::isfinite(cell.speed)) {
      cell.speed = kRapidUnfollowed;
      cell.tip = {options_.path_acceleration_max, options_.path_jerk_max};
    }
    path_.piece_of_cell.push_back(path_.pieces.size() - 1);
    path_.offset_of_cell.push_back(offset);
    offset += cell.length;
    ++at_.skip;
  }
  place_of_piece_.push_back(start);
}

BlockCurve::TipLimits RunPathBuilder::tip_limits(size_t block) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const BlockMove move = motions_.block(block);
  const RampLimits path =
      rapid_ ? RampLimits{kNone, kNone} : RampLimits{options_.path_acceleration_max, options_.path_jerk_max};
  return {move.feed_mm_s, move.duration_s, path};
}

void RunPathBuilder::add_block_piece(size_t block, double from, double to) {
  if (!(to - from > kRunLengthMin)) return;
  const size_t first = path_.cells.size();
  path_.curve(block).append_cells(from, to, tip_limits(block), path_.cells);
  path_.pieces.push_back({block, from, to - from, -1});
  add_cells(first);
}

/// The piece of block a up to its corner with block b, and the corner. Returns where b's own piece starts.
double RunPathBuilder::add_corner(size_t a, size_t b) {
  const BlockCurve &out = curve(b), &in = curve(a);  // b first: it may move the others
  const double from = at_.from;
  const auto stop = [&] {
    add_block_piece(a, from, in.length());
    path_.cells.back().stop = true;
    return 0.0;
  };
  if (!in.followed() || !out.followed()) return stop();
  if (on_one_curve(in, out)) {
    add_block_piece(a, from, in.length());
    return 0.0;
  }
  if (in.even() && out.even()) {
    const AxisValues change = in.jet(in.length()).first - out.jet(0.0).first;
    if (change.cwiseAbs().maxCoeff() < kStraight) {
      add_block_piece(a, from, in.length());
      return 0.0;
    }
  }
  const std::optional<Blend> fitted = fit(a, b);
  if (!fitted) return stop();
  const Blend& blend = *fitted;
  const double d = blend.before;
  add_block_piece(a, from, in.length() - d);
  const size_t first = path_.cells.size();
  PathCell cell = blend_cell(blend);
  limit_tip(a, b, cell);
  path_.cells.push_back(cell);
  path_.blends.push_back(blend);
  path_.pieces.push_back({a, in.length() - d, blend.length, static_cast<int>(path_.blends.size()) - 1});
  add_cells(first);
  return d;
}

/// Feed and path limits of both blocks beside the corner.
void RunPathBuilder::limit_tip(size_t a, size_t b, PathCell& cell) const {
  const double d = 0.5 * cell.length;
  const BlockCurve& in = path_.curve(a);
  cell.speed = cell.tip.acceleration = cell.tip.jerk = std::numeric_limits<double>::infinity();
  in.limit_tip(in.length() - d, in.length(), tip_limits(a), cell);
  path_.curve(b).limit_tip(0.0, d, tip_limits(b), cell);
}

/// The longest corner within the tolerance: its deviation grows with its length, at least about linearly.
/// None where the tolerance is below kSharp.
std::optional<Blend> RunPathBuilder::fit(size_t a, size_t b) const {
  const BlockCurve &in = path_.curve(a), &out = path_.curve(b);
  std::optional<BlockCurve::Law> even_in, even_out;
  const Corner corner{in, out, in.law() != nullptr ? *in.law() : even_in.emplace(motions_[a]),
                      out.law() != nullptr ? *out.law() : even_out.emplace(motions_[b])};
  const double tolerance = corner_tolerance(corner.in_law.motion.block, options_);
  if (tolerance < kSharp) return std::nullopt;
  double d = kCornerShare * std::min(in.length(), out.length());
  for (int i = 0; i < kFits; ++i) {
    Blend blend = blend_between(in.jet(in.length() - d), out.jet(d), d, d);
    blend.deviation = deviation(corner, blend);
    if (blend.deviation <= tolerance) return blend;
    d *= std::min(0.98, 0.999 * tolerance / blend.deviation);
  }
  SWARF_CHECK(false, "a corner becomes as sharp as it must");
  return std::nullopt;
}

/// Greatest distance of the tip from the programmed one at the same s.
double RunPathBuilder::deviation(const Corner& corner, const Blend& blend) const {
  constexpr size_t kPlaces = 16;
  const BlockCurve &in = corner.in, &out = corner.out;
  std::array<AxisValues, kPlaces - 1> q;
  std::array<ToolPose, kPlaces - 1> rounded;
  std::array<double, kPlaces + 1> distance{};
  const auto place = [&](size_t i) { return blend.length * static_cast<double>(i) / kPlaces; };
  for (size_t i = 1; i < kPlaces; ++i) q[i - 1] = blend.q(place(i));
  forward_.at(q, rounded);
  for (size_t i = 1; i < kPlaces; ++i) {
    const double s = place(i);
    const ToolPose programmed = s < blend.before ? corner.in_law.at(in.share(in.length() - blend.before + s))
                                                 : corner.out_law.at(out.share(s - blend.before));
    distance[i] = (rounded[i - 1].tip_W - programmed.tip_W).norm();
  }
  // Between the places: the top of the parabola through the greatest_of and those beside it.
  const auto top = std::max_element(distance.begin() + 1, distance.end() - 1);
  const double before = *(top - 1), after = *(top + 1), bend = 2.0 * *top - before - after;
  return bend > 0.0 ? *top + std::pow(before - after, 2) / (8.0 * bend) : *top;
}

namespace {

/// The point, or all but what goes to the open ones.
void set_point(const RunPath& path, const CellOffset& at, PathPoint& point, OpenPoints& open) {
  const Piece& piece = path.pieces[path.piece_of_cell[at.cell]];
  const double s = path.offset_of_cell[at.cell] + at.offset;
  point.block = piece.block;
  point.rounded = piece.blend >= 0;
  point.pose.reset();
  if (piece.blend < 0) {
    const BlockCurve& curve = path.curve(piece.block);
    point.share = curve.share(piece.from + s);
    if (curve.is_solved(piece.from + s, point.share, point.q, open.pose[open.count], open.before[open.count]))
      return;
    open.point[open.count++] = &point;
    return;
  }
  const Blend& blend = path.blends[static_cast<size_t>(piece.blend)];
  point.q = blend.q(s);
  if (s <= blend.before) {
    point.share = path.curve(piece.block).share(piece.from + s);
  } else {
    do ++point.block;
    while (path.curve(point.block).length() < kRunLengthMin);
    point.share = path.curve(point.block).share(s - blend.before);
  }
}

}  // namespace

void OpenPoints::solve(const kinematics::InverseKinematics& inverse) {
  if (count == 0) return;
  inverse.continued(std::span(pose).first(count), std::span(before).first(count), found);
  for (size_t i = 0; i < count; ++i) {
    point[i]->pose = pose[i];
    if (found[i].outcome != kinematics::InverseOutcome::kUnreachable) point[i]->q = found[i].q;
  }
  count = 0;
}

void points_at(const RunPath& path, std::span<const CellOffset> places, std::span<PathPoint> points,
               OpenPoints& open) {
  const kinematics::InverseKinematics& inverse = path.curves.front().inverse();
  for (size_t i = 0; i < places.size(); ++i) {
    set_point(path, places[i], points[i], open);
    if (open.count == OpenPoints::kMost) open.solve(inverse);
  }
  open.solve(inverse);
}

PathPoint point_at(const RunPath& path, size_t cell, double offset) {
  const CellOffset place{cell, offset};
  PathPoint point;
  OpenPoints open;
  points_at(path, std::span(&place, 1), std::span(&point, 1), open);
  return point;
}

}  // namespace swarf::motion

#include "motion/blocks/run_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "base/roots.h"

namespace swarf::motion {
namespace {

using kinematics::AxisValues;
using toolpath::BlockMove;

/// Blocks shorter than this go nowhere, mm.
constexpr double kRunLengthMin = 1e-9;
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

/// Greatest |p| on [0,1].
double greatest_of(std::span<const double> p) {
  const auto value = [&](double x) {
    double sum = 0.0;
    for (size_t k = p.size(); k-- > 0;) sum = sum * x + p[k];
    return std::abs(sum);
  };
  std::array<double, 6> slope{};
  for (size_t k = 1; k < p.size(); ++k) slope[k - 1] = static_cast<double>(k) * p[k];
  double result = std::max(value(0.0), value(1.0));
  const UnitRoots roots = unit_roots(std::span(slope).first(p.size() - 1));
  for (const double x : roots.all()) result = std::max(result, value(x));
  return result;
}

/// Then q(s) runs on with two derivatives, and there is no corner.
bool on_one_curve(const BlockMove& a, const BlockMove& b) {
  return a.curve && b.curve && toolpath::continues(*a.curve, *b.curve);
}

PathCell blend_cell(const Blend& blend) {
  PathCell cell;
  cell.corner = true;
  cell.length = blend.length;
  cell.first = cell.second = cell.third = AxisValues::Zero();
  const double l = blend.length;
  for (Eigen::Index i = 0; i < kinematics::kMaxAxes; ++i) {
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
  if (!in.followed() || !out.followed()) {
    add_block_piece(a, from, in.length());
    path_.cells.back().stop = true;
    return 0.0;
  }
  if (on_one_curve(motions_[a].block, motions_[b].block)) {
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
  const Blend blend = fit(a, b);
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
  std::vector<PathCell> sides;
  const double d = 0.5 * cell.length;
  const BlockCurve& in = path_.curve(a);
  in.append_cells(in.length() - d, in.length(), tip_limits(a), sides);
  path_.curve(b).append_cells(0.0, d, tip_limits(b), sides);
  cell.speed = cell.tip.acceleration = cell.tip.jerk = std::numeric_limits<double>::infinity();
  for (const PathCell& side : sides) {
    cell.speed = std::min(cell.speed, side.speed);
    cell.tip.acceleration = std::min(cell.tip.acceleration, side.tip.acceleration);
    cell.tip.jerk = std::min(cell.tip.jerk, side.tip.jerk);
  }
}

/// The longest corner within the tolerance: its deviation grows with its length, at least about linearly.
Blend RunPathBuilder::fit(size_t a, size_t b) const {
  const BlockCurve &in = path_.curve(a), &out = path_.curve(b);
  const Corner corner{in, out, motions_[a], motions_[b]};
  const double tolerance = corner_tolerance(corner.in_motion.block, options_);
  double d = kCornerShare * std::min(in.length(), out.length());
  for (int i = 0; i < kFits; ++i) {
    Blend blend = blend_between(in.jet(in.length() - d), out.jet(d), d, d);
    blend.deviation = deviation(corner, blend);
    if (blend.deviation <= tolerance) return blend;
    d *= std::min(0.98, 0.999 * tolerance / blend.deviation);
  }
  SWARF_CHECK(false, "a corner becomes as sharp as it must");
  return {};
}

/// Greatest distance of the tip from the programmed one at the same s.
double RunPathBuilder::deviation(const Corner& corner, const Blend& blend) const {
  constexpr int kPlaces = 16;
  const BlockCurve &in = corner.in, &out = corner.out;
  std::array<double, kPlaces + 1> distance{};
  for (int i = 1; i < kPlaces; ++i) {
    const double s = blend.length * i / kPlaces;
    const ToolPose programmed = s < blend.before
                                    ? pose_at(corner.in_motion, in.share(in.length() - blend.before + s))
                                    : pose_at(corner.out_motion, out.share(s - blend.before));
    const ToolPose rounded = kinematics::forward(machine_, blend.q(s));
    distance[static_cast<size_t>(i)] = (rounded.tip_W - programmed.tip_W).norm();
  }
  // Between the places: the top of the parabola through the greatest_of and those beside it.
  const auto top = std::max_element(distance.begin() + 1, distance.end() - 1);
  const double before = *(top - 1), after = *(top + 1), bend = 2.0 * *top - before - after;
  return bend > 0.0 ? *top + std::pow(before - after, 2) / (8.0 * bend) : *top;
}
PathPoint point_at(const RunPath& path, size_t cell, double offset) {
  const Piece& piece = path.pieces[path.piece_of_cell[cell]];
  const double s = path.offset_of_cell[cell] + offset;
  PathPoint point;
  point.block = piece.block;
  if (piece.blend < 0) {
    const BlockCurve& curve = path.curve(piece.block);
    point.share = curve.share(piece.from + s);
    point.q = curve.q(piece.from + s);
    return point;
  }
  const Blend& blend = path.blends[static_cast<size_t>(piece.blend)];
  point.rounded = true;
  point.q = blend.q(s);
  if (s <= blend.before) {
    point.share = path.curve(piece.block).share(piece.from + s);
  } else {
    do ++point.block;
    while (path.curve(point.block).length() < kRunLengthMin);
    point.share = path.curve(point.block).share(s - blend.before);
  }
  return point;
}

}  // namespace swarf::motion

#include "flank/flank_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace swarf::flank {
namespace {

using surface::Derivatives;

/// Smaller cells are not divided, in parameters; more are not looked at.
constexpr double kSmallest = 1e-6;
constexpr int kMostCells = 200000;
/// Normals whose angle has a smaller cosine stand square to each other.
constexpr double kSquare = 1e-9;

struct Range {
  double low, high;
  double middle() const { return 0.5 * (low + high); }
  double half() const { return 0.5 * (high - low); }
};

enum class Shown { kYes, kNo, kOpen };

/// Of the second derivatives on these rulings; the surface goes straight on beyond [0,1].
struct Bends {
  double uu, uv;
};
Bends bends_on(const surface::Surface& S, const Range& u) {
  if (u.high <= 0.0 || u.low >= 1.0) return {0.0, S.derivatives(u.middle(), 0.0).Suv.norm()};
  const surface::BendBounds bounds = S.bend_bounds({u.low, 0.0}, {u.high, 1.0});
  return {bounds.uu.most(), bounds.uv.most()};
}

/// Su x Sv at v, and how far it is from that elsewhere in the cell.
struct Cross {
  Vec3 at;
  double stray;
};
Cross cross_on(const surface::Surface& S, const Range& u, double v, const Bends& bends) {
  const Derivatives d = S.derivatives(u.middle(), v);
  const double r = u.half(), along = d.Su.norm() + r * bends.uu, across = d.Sv.norm() + r * bends.uv;
  return {d.Su.cross(d.Sv), r * (bends.uu * across + along * bends.uv)};
}

Shown untwisted(const surface::Surface& S, const Range& u) {
  const Bends bends = bends_on(S, u);
  const Cross low = cross_on(S, u, 0.0, bends), high = cross_on(S, u, 1.0, bends);
  const double dot = low.at.dot(high.at), a = low.at.norm(), b = high.at.norm();
  if (dot <= kSquare * a * b) return Shown::kNo;
  const double stray = a * high.stray + b * low.stray + low.stray * high.stray;
  return dot - stray > 0.0 ? Shown::kYes : Shown::kOpen;
}

struct Cell {
  Range u, v;
};

/// Greatest ball between two heights; a barrel's is greatest at the height of its arc's centre.
double thickest(const FlankProfile& profile, double low, double high) {
  double most = std::max(ball_radius(profile, low), ball_radius(profile, high));
  if (profile.arc_radius > 0.0)
    most = std::max(most, ball_radius(profile, std::clamp(profile.arc_height, low, high)));
  return most;
}

/// What bounds k rho over a cell; none: too large to say.
std::optional<double> hollow_bound(const FlankTask& task, const Cell& cell) {
  const surface::Surface& S = *task.surface;
  const Derivatives d = S.derivatives(cell.u.middle(), cell.v.middle());
  const surface::BendBounds bend = S.bend_bounds({cell.u.low, cell.v.low}, {cell.u.high, cell.v.high});
  const double hu = cell.u.half(), hv = cell.v.half();
  const double stray_u = hu * bend.uu.most() + hv * bend.uv.most();
  const double stray_v = hu * bend.uv.most() + hv * bend.vv.most();
  const double Su = d.Su.norm(), Sv = d.Sv.norm();
  const double product = Su * stray_v + Sv * stray_u + stray_u * stray_v;
  const Vec3 W = d.Su.cross(d.Sv);
  const double least_W = W.norm() - product, least_Sv = Sv - stray_v, most_Sv = Sv + stray_v;
  if (least_W <= 0.0 || least_Sv <= 0.0) return std::nullopt;
  const Vec3 n = S.outward_sign() * W.normalized();
  const double turned = std::numbers::sqrt2 * product / W.norm();  // |n - n_c|, angles up to 90 deg
  const double uu = n.dot(bend.uu.mean) + bend.uu.stray + turned * bend.uu.most();
  const double uv = n.dot(bend.uv.mean), uv_stray = bend.uv.stray + turned * bend.uv.most();
  const double F = d.Su.dot(d.Sv);
  double twist = std::numeric_limits<double>::infinity();  // least of F/G n.Suv
  for (const double f : {F - product, F + product})
    for (const double g : {least_Sv * least_Sv, most_Sv * most_Sv})
      for (const double p : {uv - uv_stray, uv + uv_stray}) twist = std::min(twist, f / g * p);
  const double bracket = uu - 2.0 * twist;
  if (bracket <= 0.0) return 0.0;
  const double rho = thickest(task.profile, task.tip_below_mm + cell.v.low * least_Sv,
                              task.tip_below_mm + cell.v.high * most_Sv);
  return most_Sv * most_Sv / (least_W * least_W) * bracket * rho;
}

/// At one place: 1/k (infinity: not hollow) and the ball.
WeakPlace hollow_at(const FlankTask& task, double u, double v) {
  const surface::Surface& S = *task.surface;
  const Derivatives d = S.derivatives(u, v);
  const Vec3 n = surface::outward_normal(S, d);
  const double G = d.Sv.squaredNorm(), F = d.Su.dot(d.Sv);
  const double k = G / d.Su.cross(d.Sv).squaredNorm() * (n.dot(d.Suu) - 2.0 * F / G * n.dot(d.Suv));
  WeakPlace place{u, v};
  place.hollow_mm = k > 0.0 ? 1.0 / k : std::numeric_limits<double>::infinity();
  place.cutter_mm = ball_radius(task.profile, task.tip_below_mm + v * std::sqrt(G));
  return place;
}

void divide_cell(const Cell& cell, bool along_u, std::vector<Cell>& open) {
  Cell low = cell, high = cell;
  (along_u ? low.u.high : low.v.high) = along_u ? cell.u.middle() : cell.v.middle();
  (along_u ? high.u.low : high.v.low) = along_u ? cell.u.middle() : cell.v.middle();
  open.push_back(high);
  open.push_back(low);
}

}  // namespace

std::optional<WeakPlace> turned_ruling(const FlankTask& task) {
  std::vector<Range> open;
  for (const Range& part : {Range{task.u_low, 0.0}, Range{0.0, 1.0}, Range{1.0, task.u_high}})
    if (part.low < part.high) open.push_back(part);
  for (int looked = 0; !open.empty(); ++looked) {
    const Range u = open.back();
    open.pop_back();
    const Shown shown = untwisted(*task.surface, u);
    if (shown == Shown::kYes) continue;
    if (shown == Shown::kNo) return WeakPlace{u.middle(), 0.5};
    if (u.half() < kSmallest || looked > kMostCells) return WeakPlace{u.middle(), 0.5, false};
    open.push_back({u.middle(), u.high});
    open.push_back({u.low, u.middle()});
  }
  return std::nullopt;
}

std::optional<WeakPlace> narrow_place(const FlankTask& task) {
  std::vector<Cell> open{{{0.0, 1.0}, {0.0, 1.0}}};
  for (int looked = 0; !open.empty(); ++looked) {
    const Cell cell = open.back();
    open.pop_back();
    const std::optional<double> bound = hollow_bound(task, cell);
    if (bound && *bound <= 1.0) continue;
    WeakPlace place = hollow_at(task, cell.u.middle(), cell.v.middle());
    if (place.hollow_mm < place.cutter_mm) return place;
    place.shown = false;
    if (std::max(cell.u.half(), cell.v.half()) < kSmallest || looked > kMostCells) return place;
    // What bends more with u is divided along u twice as often as along v.
    divide_cell(cell, cell.u.half() * 2.0 > cell.v.half(), open);
  }
  return std::nullopt;
}

}  // namespace swarf::flank

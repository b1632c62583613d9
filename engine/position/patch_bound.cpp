#include "position/patch_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace swarf::position {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();
constexpr double kMostModulus = 1e6;  ///< 1/mm; any smaller one is true as well
/// Part of the squared step that is given to the surface's own bend, in (L + r)^2 >= (1 - k) L^2 - (1/k - 1)
/// r^2.
constexpr double kBendShare = 0.1;

/// Greatest of g x + c x^2 over [low, high].
double highest(double g, double c, double low, double high) {
  double most = std::max(low * (g + c * low), high * (g + c * high));
  if (c < 0.0) {
    const double at = -0.5 * g / c;
    if (at > low && at < high) most = 0.5 * g * at;
  }
  return most;
}

double highest_about_centre(double g, double c) {
  const double size = std::abs(g);
  return c < 0.0 && size < -2.0 * c ? -0.25 * g * g / c : size + c;
}

/// What a tool of this slope has for the plane of a point at this distance.
double lift_of(const ToolProfile& profile, double slope) {
  // Points count as under the rim a little beyond it.
  return profile.lift(slope) + slope * kRim_mm;
}

/// Least 2 (w(s) - w* - slope (s - rho)) / (s - rho)^2 over low <= s <= high, with w(s) = 0 below s = 0.
class RadialModulus {
 public:
  RadialModulus(const ToolProfile& profile, double rho, double slope, double low, double high)
      : profile_(profile),
        rho_(rho),
        slope_(slope),
        low_(low),
        high_(std::min(high, profile.radius() + kRim_mm)) {
    base_ = profile.height(std::min(rho, profile.radius()));
  }
  double least() {
    if (low_ < 0.0) consider_line(low_, std::min(0.0, high_), 0.0, 0.0, 0.0);
    for (const ProfilePiece& piece : profile_.pieces()) {
      const double from = std::max(low_, piece.from), to = std::min(high_, piece.to);
      if (from > to) continue;
      const bool home = rho_ >= piece.from && rho_ <= piece.to;
      if (home && !piece.is_line()) {
        least_ = std::min(least_, profile_bend(piece, std::min(from, rho_)).second);
      } else {
        // w lies above its tangent at the end that is nearer to the contact.
        const double near = std::clamp(rho_, from, to);
        const double steep = std::min(piece.slope_at(near), kSteepestSlope);
        consider_line(from, to, near, piece.height(near), steep);
      }
    }
    return std::max(0.0, least_);
  }

 private:
  void consider_line(double from, double to, double near, double height, double slope) {
    // (A + B d) / d^2 with A + B d >= 0 has its least value at an end.
    for (const double s : {from, to}) {
      const double d = s - rho_;
      const double gain = height + slope * (s - near) - base_ - slope_ * d;
      if (std::abs(d) > 1e-12) least_ = std::min(least_, 2.0 * gain / (d * d));
    }
  }
  const ToolProfile& profile_;
  double rho_, slope_, low_, high_, base_ = 0.0, least_ = kMostModulus;
};

/// mu_r and mu_t of (2).
struct Moduli {
  double radial = 0.0, round = 0.0;
};

/// w'/rho at the contact: what the underside rises by round the axis.
double round_modulus(const ToolProfile& profile, const Footing& at, double slope) {
  const ProfilePiece& first = profile.pieces().front();
  if (at.ring < 0 && !first.is_line() && first.centre_rho == 0.0 && at.rho < first.to)
    return profile_bend(first, at.rho).round;
  return at.rho > 0.0 ? slope / at.rho : 0.0;
}

/// `low`, `high`: bounds of e.x over the cell; `most`: of |x|.
Moduli moduli(const ToolProfile& profile, const Footing& at, double low, double high, double most) {
  const double slope = at.slope.norm(), radius = profile.radius();
  const double widest = std::min(most, radius + kRim_mm);
  if (at.tip) {
    const double spare = 2.0 * (profile.pieces().front().slope_at(0.0) - slope) / std::max(widest, kRim_mm);
    return {std::clamp(spare, 0.0, kMostModulus), std::clamp(spare, 0.0, kMostModulus)};
  }
  const double inner = std::clamp(low, 0.0, radius);
  Moduli apart;
  apart.radial = RadialModulus(profile, at.rho, slope, low, high).least();
  const double steep = std::min(profile.piece(inner).slope_at(inner), kSteepestSlope);
  apart.round = std::min(kMostModulus, steep / widest);
  const double even = std::min(RadialModulus(profile, at.rho, slope, inner, widest).least(),
                               round_modulus(profile, at, slope));
  if (apart.round >= 0.8 * even) return apart;
  return {even, even};
}

/// Where x + s a + t b, |s| and |t| <= 1, comes nearest to the axis, or close to that.
Vec2 nearest_of(const Vec2& x, const Vec2& a, const Vec2& b) {
  constexpr int kTurns = 3;
  const auto best = [](const Vec2& from, const Vec2& side) {
    const double length2 = side.squaredNorm();
    return length2 > 0.0 ? std::clamp(-from.dot(side) / length2, -1.0, 1.0) : 0.0;
  };
  double s = 0.0, t = 0.0;
  for (int i = 0; i < kTurns; ++i) {
    s = best(x + t * b, a);
    t = best(x + s * a, b);
  }
  return x + s * a + t * b;
}

/// Whether a line beside the tool parts it from the cell; `x` is the cell's centre. A wall beside the flank
/// is known by it at once, however long it is.
bool parted_by_line(const PatchCell& cell, const GuideLine& line, const Vec2& x, double radius) {
  const auto flat = [&](const Vec3& v) { return Vec2(v.dot(line.x_W), v.dot(line.y_W)); };
  const Vec2 a = flat(cell.a), b = flat(cell.b), nearest = nearest_of(x, a, b);
  const double distance = nearest.norm();
  if (!(distance > 0.0)) return false;
  const Vec2 e = nearest / distance;
  const double reach = std::abs(e.dot(a)) + std::abs(e.dot(b)) + std::abs(e.dot(flat(cell.uu))) +
                       std::abs(e.dot(flat(cell.uv))) + std::abs(e.dot(flat(cell.vv))) + cell.stray;
  return e.dot(x) - reach > radius + kRim_mm;
}

/// The cell about a place in it, in halves of its sides.
struct About {
  Vec2 low, high;
  double most2 = 0.0;  ///< greatest squared distance
};

About about(const PatchCell& cell, const Vec2& uv) {
  About range;
  for (int i = 0; i < 2; ++i) {
    range.low[i] = std::min(0.0, (cell.centre[i] - uv[i]) / cell.half[i] - 1.0);
    range.high[i] = std::max(0.0, (cell.centre[i] - uv[i]) / cell.half[i] + 1.0);
  }
  range.most2 = range.low.cwiseAbs().cwiseMax(range.high.cwiseAbs()).squaredNorm();
  return range;
}

/// Half extents of a linear form over the range: least and greatest value.
Vec2 span_of(const Vec2& linear, const About& range) {
  Vec2 span = Vec2::Zero();
  for (int i = 0; i < 2; ++i) {
    span[0] += std::min(linear[i] * range.low[i], linear[i] * range.high[i]);
    span[1] += std::max(linear[i] * range.low[i], linear[i] * range.high[i]);
  }
  return span;
}

/// Slopes of w on both sides of rho: infinite beyond the rim.
double outer_slope(const ToolProfile& profile, double rho) {
  if (rho >= profile.radius()) return std::numeric_limits<double>::infinity();
  return profile.piece(rho).slope_at(rho);
}
double inner_slope(const ToolProfile& profile, double rho) {
  const double at = std::min(std::max(rho, 0.0), profile.radius());
  double slope = 0.0;
  for (const ProfilePiece& piece : profile.pieces()) {
    if (piece.from > 0.0 && piece.from >= at) break;
    slope = at > 0.0 ? piece.slope_at(std::min(at, piece.to)) : 0.0;
  }
  return slope;
}

/// A way through the parameters and what the place does on it.
struct Way {
  Vec3 mean = Vec3::Zero();
  double stray = 0.0;  ///< over the cell, mm
};
Way way_along(const PatchCell& cell, const GuideLine& line, const Vec2& direction) {
  const double s = std::abs(direction.x()), t = std::abs(direction.y());
  const double uv = cell.uv.norm() + cell.stray_uv;
  const Vec3 d = direction.x() * cell.a + direction.y() * cell.b;
  return {
      {d.dot(line.x_W), d.dot(line.y_W), d.dot(line.axis_W)},
      s * (2.0 * (cell.uu.norm() + cell.stray_uu) + uv) + t * (2.0 * (cell.vv.norm() + cell.stray_vv) + uv)};
}

}  // namespace

Support support_plane(const ToolProfile& profile, const GuideLine& line, const Vec2& slope) {
  Support support;
  support.normal_W = line.axis_W - slope.x() * line.x_W - slope.y() * line.y_W;
  support.length = support.normal_W.norm();
  support.offset = lift_of(profile, slope.norm()) - support.normal_W.dot(line.point_W);
  return support;
}

Support support_paraboloid(const ToolProfile& profile, const GuideLine& line, const Footing& at) {
  Support support = support_plane(profile, line, at.slope);
  const double radius = profile.radius() + kRim_mm;
  const Moduli mu = moduli(profile, at, -radius, radius, radius);
  support.modulus = std::min(mu.radial, mu.round);
  support.foot = at.d.S.head<2>();
  return support;
}

double support_bound(const PatchCell& cell, const Support& support, const GuideLine& line, double enough) {
  const Vec3& n = support.normal_W;
  double level = n.dot(cell.p) + support.offset + support.length * cell.stray;
  double a = n.dot(cell.a), b = n.dot(cell.b);
  double uu = n.dot(cell.uu), uv = n.dot(cell.uv), vv = n.dot(cell.vv);
  const auto greatest = [&] {
    const double cross = 0.5 * std::abs(uv);
    return level + highest_about_centre(a, uu + cross) + highest_about_centre(b, vv + cross);
  };
  const double plane = greatest();
  if (plane <= enough || !(support.modulus > 0.0)) return plane;
  const auto flat = [&](const Vec3& v) { return Vec2(v.dot(line.x_W), v.dot(line.y_W)); };
  const double mu = support.modulus;
  const Vec2 x = flat(cell.p - line.point_W) - support.foot;
  const Vec2 xa = flat(cell.a), xb = flat(cell.b), xuu = flat(cell.uu), xuv = flat(cell.uv),
             xvv = flat(cell.vv);
  // |x + J s + r|^2 >= |x|^2 + 2 x.(J s + r) + k |J s|^2 - (k / (1 - k)) |r|^2, r being what is not linear.
  const double bent =
      std::sqrt(xuu.squaredNorm()) + std::sqrt(xuv.squaredNorm()) + std::sqrt(xvv.squaredNorm()) + cell.stray;
  const double a2 = xa.squaredNorm(), b2 = xb.squaredNorm(), x2 = x.squaredNorm();
  const double size = std::sqrt(a2) + std::sqrt(b2);
  const double lost = size > 0.0 ? std::min(0.5, bent / size) : 0.5;
  const double kept = 1.0 - lost;
  level += mu * (std::sqrt(x2) * cell.stray - 0.5 * x2);
  if (lost > 0.0) level += 0.5 * mu * bent * bent * kept / lost;
  a -= mu * x.dot(xa);
  b -= mu * x.dot(xb);
  uu -= mu * (x.dot(xuu) + 0.5 * kept * a2);
  uv -= mu * (x.dot(xuv) + kept * xa.dot(xb));
  vv -= mu * (x.dot(xvv) + 0.5 * kept * b2);
  return std::min(plane, greatest());
}

double cell_bound(const PatchCell& cell, const ToolProfile& profile, const GuideLine& line,
                  const Support* known, double enough) {
  const Vec3 d = cell.p - line.point_W;
  const double z = d.dot(line.axis_W), radius = profile.radius();
  const Vec2 x(d.dot(line.x_W), d.dot(line.y_W));
  const double rho = std::sqrt(x.squaredNorm()), ball = z + cell.radius;
  if (rho - cell.radius > radius + kRim_mm) return -kNoBound;
  if (ball <= enough || cell.patch < 0) return ball;
  const double by_known = known != nullptr ? support_bound(cell, *known, line, enough) : ball;
  if (by_known <= enough || rho == 0.0) return std::min(ball, by_known);
  if (parted_by_line(cell, line, x, radius)) return -kNoBound;
  const Vec3 out_W = (x.x() * line.x_W + x.y() * line.y_W) / rho;
  const double a = out_W.dot(cell.a), b = out_W.dot(cell.b);
  const double bend =
      std::abs(out_W.dot(cell.uu)) + std::abs(out_W.dot(cell.uv)) + std::abs(out_W.dot(cell.vv));
  const double reach = std::abs(a) + std::abs(b) + bend + cell.stray;
  // The tool's own slope over the middle of the cell; beyond the rim that with which the cell rises.
  const double inside = std::min(rho, radius - std::min(0.5 * radius, 0.5 * reach));
  double slope = std::min(profile.piece(inside).slope_at(inside), kSteepestSlope);
  if (rho > inside) {
    const double rise = (a * line.axis_W.dot(cell.a) + b * line.axis_W.dot(cell.b)) / (a * a + b * b);
    if (std::isfinite(rise)) slope = std::max(slope, std::min(rise, kSteepestSlope));
  }
  const Vec2 vector = x * (slope / rho);
  return std::min({ball, by_known, support_bound(cell, support_plane(profile, line, vector), line, enough)});
}

double excess_bound(const PatchCell& cell, const Footing& at, const ToolProfile& profile,
                    const GuideLine& line) {
  const Vec3 n = line.axis_W - at.slope.x() * line.x_W - at.slope.y() * line.y_W;
  const double length = n.norm();
  const Vec3 local_n(-at.slope.x(), -at.slope.y(), 1.0);
  const About range = about(cell, at.uv);
  const Vec2 gradient(local_n.dot(at.d.Su) * cell.half.x(), local_n.dot(at.d.Sv) * cell.half.y());

  // The surface's own part of the form; |s t| <= (s^2 + t^2) / 2.
  Mat2 form;
  form(0, 0) = n.dot(cell.uu) + length * (cell.stray_uu + 0.5 * cell.stray_uv);
  form(1, 1) = n.dot(cell.vv) + length * (cell.stray_vv + 0.5 * cell.stray_uv);
  form(0, 1) = form(1, 0) = 0.5 * n.dot(cell.uv);

  // The tool's part: a and b are linear in (u,v) but for `bend` times the distance squared.
  const auto square = [&](const Vec3& v) { return std::hypot(v.dot(line.x_W), v.dot(line.y_W)); };
  const double bend_uv = 0.5 * (square(cell.uv) + cell.stray_uv);
  const double bend = std::max(square(cell.uu) + cell.stray_uu, square(cell.vv) + cell.stray_vv) + bend_uv;
  const Vec2 side(-at.out.y(), at.out.x());
  const Vec2 u = at.d.Su.head<2>() * cell.half.x(), v = at.d.Sv.head<2>() * cell.half.y();
  const Vec2 outwards(at.out.dot(u), at.out.dot(v)), round(side.dot(u), side.dot(v));
  const double strayed = bend * range.most2;
  const Vec2 out_span = span_of(outwards, range), round_span = span_of(round, range);
  const double low = at.rho + out_span[0] - strayed, high = at.rho + out_span[1] + strayed;
  const double aside = std::max(-round_span[0], round_span[1]) + strayed;
  const Moduli mu =
      moduli(profile, at, low, high, std::hypot(std::max(std::abs(low), std::abs(high)), aside));

  const double kept = bend > 0.0 ? 1.0 - kBendShare : 1.0;
  form -= 0.5 * kept * (mu.radial * outwards * outwards.transpose() + mu.round * round * round.transpose());
  const double lost = bend > 0.0 ? (1.0 / kBendShare - 1.0) * bend * bend * range.most2 : 0.0;
  const double middle = 0.5 * (form(0, 0) + form(1, 1)) + 0.5 * lost * std::max(mu.radial, mu.round);
  const double greatest = middle + std::hypot(0.5 * (form(0, 0) - form(1, 1)), form(0, 1));
  // On a ring, and beyond the rim, the slope is a subgradient but for kRim_mm.
  const bool inexact = at.ring >= 0 || at.tip || high >= profile.radius();
  return (inexact ? at.slope.norm() * kRim_mm : 0.0) +
         highest(gradient.x(), greatest, range.low.x(), range.high.x()) +
         highest(gradient.y(), greatest, range.low.y(), range.high.y());
}

bool beyond_rim(const PatchCell& cell, const Footing& nearest, const ToolProfile& profile,
                const GuideLine& line) {
  const auto flat = [&](const Vec3& v) { return Vec2(v.dot(line.x_W), v.dot(line.y_W)); };
  const Vec2 x = nearest.d.S.head<2>();
  const Vec2 u = nearest.d.Su.head<2>() * cell.half.x(), v = nearest.d.Sv.head<2>() * cell.half.y();
  const Vec2 uu = flat(cell.uu), uv = flat(cell.uv), vv = flat(cell.vv);
  const About range = about(cell, nearest.uv);
  // |x + J + r|^2 >= |x|^2 + 2 x.J + 2 x.r + |J|^2 - 2 |J| |r|, J linear; |s t| <= (s^2 + t^2) / 2.
  const double size = std::sqrt(range.most2) * std::hypot(u.norm(), v.norm());
  const double stray = 2.0 * (nearest.rho + size), cross = std::abs(u.dot(v) + x.dot(uv)) + size * uv.norm();
  const auto curve = [&](const Vec2& linear, const Vec2& bent, double strayed) {
    return linear.squaredNorm() + 2.0 * (x.dot(bent) - size * bent.norm()) - cross -
           stray * (strayed + 0.5 * cell.stray_uv);
  };
  const double nearer =
      highest(-2.0 * x.dot(u), -curve(u, uu, cell.stray_uu), range.low.x(), range.high.x()) +
      highest(-2.0 * x.dot(v), -curve(v, vv, cell.stray_vv), range.low.y(), range.high.y());
  const double rim = profile.radius() + kRim_mm;
  return nearest.rho * nearest.rho - nearer > rim * rim;
}

bool rises_everywhere(const PatchCell& cell, const ToolProfile& profile, const GuideLine& line) {
  const Vec3 p = line.local(cell.p);
  const double beside = p.head<2>().norm();
  const double nearest = std::max(0.0, beside - cell.radius);
  const Vec2 out = beside > 0.0 ? Vec2(p.head<2>() / beside) : Vec2(Vec2::UnitX());
  const double steep = profile.tangent(std::min(beside, profile.radius())).slope;
  const Vec3 n = line.axis_W - steep * (out.x() * line.x_W + out.y() * line.y_W);
  const double long_a = cell.a.squaredNorm(), long_b = cell.b.squaredNorm();
  if (!(long_a > 0.0 && long_b > 0.0)) return false;
  const Way way = way_along(cell, line, {n.dot(cell.a) / long_a, n.dot(cell.b) / long_b});
  // e.D: the directions from the axis to the cell lie in a cone about `out`.
  const double level = way.mean.head<2>().norm();
  constexpr double kChordOfSine = 1.4143;  // 2 sin(angle / 2) <= sqrt(2) sin(angle) up to a right angle
  const double turn = cell.radius < beside ? kChordOfSine * cell.radius / beside : 2.0;
  const double greatest = std::min(level, way.mean.head<2>().dot(out) + level * turn) + way.stray;
  const double slope = greatest > 0.0 ? outer_slope(profile, beside + cell.radius + kRim_mm)
                                      : inner_slope(profile, nearest - kRim_mm);
  const double climb = way.mean.z() - way.stray - slope * greatest;
  constexpr double kRounding = 1e-9;  // of the sizes that the sum is made of
  return climb > kRounding * (way.mean.norm() + way.stray + slope * std::abs(greatest));
}

}  // namespace swarf::position

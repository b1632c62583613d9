#include "position/patch_footing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace swarf::position {
namespace {

constexpr double kNoFooting = -std::numeric_limits<double>::infinity();
constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kOnRing_mm = 1e-9;
constexpr double kSlopeJump = 1e-9;
constexpr int kMostSteps = 16;
constexpr double kMuchSteeper = 3.0;
constexpr int kStepsUnder = 6;
constexpr double kSnap = 1e-15;  ///< of a parameter: rounding
constexpr double kStuck_mm = 1e-10;
constexpr double kSettled_mm = 1e-5;  ///< a step below it is the last: Newton's next would be its square

/// Slopes of w on the two sides of the outer end of a piece.
struct Jump {
  double inner = 0.0, outer = kUnbounded;
  bool is_one() const { return outer > inner + kSlopeJump; }
};

Jump jump_at(const ToolProfile& profile, size_t piece) {
  const auto pieces = profile.pieces();
  Jump jump;
  jump.inner = pieces[piece].slope_at(pieces[piece].to);
  if (piece + 1 < pieces.size()) jump.outer = pieces[piece + 1].slope_at(pieces[piece + 1].from);
  return jump;
}

int ring_at(const ToolProfile& profile, double rho) {
  const auto pieces = profile.pieces();
  for (size_t i = 0; i < pieces.size(); ++i)
    if (std::abs(rho - pieces[i].to) <= kOnRing_mm && jump_at(profile, i).is_one())
      return static_cast<int>(i);
  return -1;
}

double cross_of(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// What f does in the parameters, with w as one piece has it.
struct Ascent {
  Vec2 z, rho;  ///< derivatives of z and of rho
  Mat2 zz, rr;  ///< second ones
};

Ascent ascent_of(const Footing& at) {
  const surface::Derivatives& d = at.d;
  const Vec2 side(-at.out.y(), at.out.x());
  const auto out = [&](const Vec3& v) { return at.out.dot(v.head<2>()); };
  const double su = side.dot(d.Su.head<2>()), sv = side.dot(d.Sv.head<2>());
  const double turn = at.rho > 0.0 ? 1.0 / at.rho : 0.0;
  Ascent a;
  a.z = {d.Su.z(), d.Sv.z()};
  a.rho = {out(d.Su), out(d.Sv)};
  a.zz << d.Suu.z(), d.Suv.z(), d.Suv.z(), d.Svv.z();
  a.rr << out(d.Suu) + su * su * turn, out(d.Suv) + su * sv * turn, out(d.Suv) + su * sv * turn,
      out(d.Svv) + sv * sv * turn;
  return a;
}

/// -1 at the lower border of the box, +1 at the upper, else 0.
int border(const UvBox& box, const Vec2& uv, int i) {
  if (uv[i] <= box.low[i]) return -1;
  return uv[i] >= box.high[i] ? 1 : 0;
}

/// The slope of w, between those of the jump, for which f falls off into the box best.
double balanced_slope(const Ascent& a, const UvBox& box, const Vec2& uv, const Jump& jump) {
  double low = jump.inner, high = jump.outer, above = 0.0, below = 0.0;
  for (int i = 0; i < 2; ++i) {
    const int at = border(box, uv, i);
    if (at == 0) {
      // Scaled by the box: what counts is how much f changes over it.
      const double width = box.high[i] - box.low[i];
      above += a.z[i] * a.rho[i] * width * width;
      below += a.rho[i] * a.rho[i] * width * width;
    } else if (a.rho[i] != 0.0) {
      const double bound = a.z[i] / a.rho[i];
      if (at * a.rho[i] > 0.0) {
        high = std::min(high, bound);
      } else {
        low = std::max(low, bound);
      }
    }
  }
  const double wanted = below > 0.0 ? above / below : low;
  // Where no slope does, the one that the free directions ask for.
  const double inside = low <= high ? std::clamp(wanted, low, high) : wanted;
  return std::clamp(inside, jump.inner, jump.outer);
}

/// The slope vector of a plane through Su and Sv; false where they do not span one over the horizontal.
bool plane_slope(const surface::Derivatives& d, Vec2& slope) {
  const Vec2 u = d.Su.head<2>(), v = d.Sv.head<2>();
  const double det = cross_of(u, v);
  if (!(std::abs(det) > 1e-12 * u.norm() * v.norm())) return false;
  slope = {(d.Su.z() * v.y() - d.Sv.z() * u.y()) / det, (d.Sv.z() * u.x() - d.Su.z() * v.x()) / det};
  return true;
}

void choose_slope(const ToolProfile& profile, const UvBox& box, Footing& at) {
  const double point = profile.pieces().front().slope_at(0.0);
  at.tip = at.rho <= kOnRing_mm && point > kSlopeJump;
  if (at.tip) {
    if (!plane_slope(at.d, at.slope)) at.slope.setZero();
    const double steep = at.slope.norm();
    if (steep > point) at.slope *= point / steep;
    return;
  }
  at.ring = ring_at(profile, at.rho);
  double slope = 0.0;
  if (at.ring >= 0) {
    slope = balanced_slope(ascent_of(at), box, at.uv, jump_at(profile, static_cast<size_t>(at.ring)));
  } else {
    slope = std::min(profile.piece(at.rho).slope_at(at.rho), kSteepestSlope);
  }
  at.slope = slope * at.out;
}

Vec3 about_line(const GuideLine& line, const Vec3& way) {
  return {way.dot(line.x_W), way.dot(line.y_W), way.dot(line.axis_W)};
}

/// Step of Newton's method with the curvature made to point down, in the directions that are free.
Vec2 newton_step(Vec2 gradient, Mat2 bend, const std::array<bool, 2>& held, const Vec2& scale) {
  // In mm, so that "how steep" and "how curved" mean the same in u and v.
  for (int i = 0; i < 2; ++i) {
    gradient[i] *= scale[i];
    for (int j = 0; j < 2; ++j) bend(i, j) *= scale[i] * scale[j];
  }
  Vec2 step = Vec2::Zero();
  if (held[0] || held[1]) {
    const int i = held[0] ? 1 : 0;
    if (!held[i]) step[i] = gradient[i] / std::max({-bend(i, i), 0.2 * std::abs(bend(i, i)), 1e-9});
  } else {
    const double middle = 0.5 * (bend(0, 0) + bend(1, 1));
    const double spread = std::hypot(0.5 * (bend(0, 0) - bend(1, 1)), bend(0, 1));
    const double shift = std::max(0.0, middle + spread + 1e-3 * (std::abs(middle) + spread) + 1e-9);
    // Concave by a margin: as it is; else moved down until it is.
    if (middle + spread > -1e-6 * (std::abs(middle) + spread)) bend -= shift * Mat2::Identity();
    const double det = bend(0, 0) * bend(1, 1) - bend(0, 1) * bend(0, 1);
    step = Vec2(bend(0, 1) * gradient.y() - bend(1, 1) * gradient.x(),
                bend(0, 1) * gradient.x() - bend(0, 0) * gradient.y()) /
           det;
  }
  return step.cwiseProduct(scale);
}

class Climb {
 public:
  Climb(const Setting& setting, int patch, const UvBox& box) : setting_(setting), patch_(patch), box_(box) {}

  Footing run(const Vec2& start, int& steps) {
    Footing at = footing_at(setting_, patch_, box_, start);
    if (!at.under()) come_under(at, steps);
    Footing best = at;
    if (!at.under()) return best;
    for (int i = 0; i < kMostSteps; ++i) {
      const Vec2 step = step_from(at);
      if (!step.allFinite()) break;
      ++steps;
      const Vec2 from = at.uv;
      // What borders and rings cut short is not yet where it goes to.
      const double wanted_mm = length_of(at, step), moved_mm = advance(at, step);
      if (at.under() && at.height >= best.height) best = at;
      if (at.uv == from || moved_mm < kStuck_mm || std::max(moved_mm, wanted_mm) < kSettled_mm) break;
    }
    return best;
  }

 private:
  Vec2 step_from(const Footing& at) const {
    const auto pieces = setting_.profile.pieces();
    const Ascent a = ascent_of(at);
    scale_ = {1.0 / std::max(at.d.Su.norm(), 1e-9), 1.0 / std::max(at.d.Sv.norm(), 1e-9)};
    Vec2 slope;
    const bool plane = plane_slope(at.d, slope);
    const double steep = at.slope.norm();
    if (plane && at.ring < 0 && steep > kMuchSteeper * std::max(1.0, slope.norm()))
      return flatter_step(at, slope);
    const double point = pieces.front().slope_at(0.0);
    // A pointed cutter stands on its tip where the surface is less steep than it.
    if (point > kSlopeJump && at.rho < pieces.front().to && plane && slope.norm() <= point)
      return place_step(at, -at.d.S.head<2>());
    if (at.ring >= 0) {
      const size_t ring = static_cast<size_t>(at.ring);
      const Jump jump = jump_at(setting_.profile, ring);
      const double free = balanced_slope(a, box_, at.uv, {-kUnbounded, kUnbounded});
      if (free >= jump.inner && free <= jump.outer) return ring_step(at, a, pieces[ring].to, free);
      const bool inwards = free < jump.inner || ring + 1 >= pieces.size();
      return piece_step(at, a, pieces[inwards ? ring : ring + 1]);
    }
    return piece_step(at, a, setting_.profile.piece(at.rho));
  }
  /// Towards the axis, by one parameter after the other, until the cutter is above the place.
  void come_under(Footing& at, int& steps) const {
    for (int i = 0; i < kStepsUnder && !at.under(); ++i) {
      const Vec2 way = (i % 2 == 0 ? at.d.Su : at.d.Sv).head<2>();
      const double size2 = way.squaredNorm();
      if (!(size2 > 0.0)) continue;
      Vec2 uv = at.uv;
      uv[i % 2] -= at.d.S.head<2>().dot(way) / size2;
      at = footing_at(setting_, patch_, box_, box_.nearest(uv));
      ++steps;
    }
  }
  /// Near the equator of a ball Newton's steps are small: straight to where the tool is as steep as the
  /// plane.
  Vec2 flatter_step(const Footing& at, const Vec2& slope) const {
    const double size = slope.norm(), rho = setting_.profile.touching(size).low;
    const Vec2 wanted = size > 0.0 ? Vec2(slope * (rho / size)) : Vec2::Zero();
    return place_step(at, wanted - at.d.S.head<2>());
  }
  /// By so much over the ground, if the surface were its tangent plane.
  Vec2 place_step(const Footing& at, const Vec2& way) const {
    const Vec2 u = at.d.Su.head<2>(), v = at.d.Sv.head<2>();
    const double det = cross_of(u, v);
    return {cross_of(way, v) / det, cross_of(u, way) / det};
  }
  Vec2 piece_step(const Footing& at, const Ascent& a, const ProfilePiece& piece) const {
    const ProfileBend w = profile_bend(piece, at.rho);
    if (!std::isfinite(w.second)) return Vec2::Zero();
    const Vec2 side(-at.out.y(), at.out.x());
    const Vec2 across(side.dot(at.d.Su.head<2>()), side.dot(at.d.Sv.head<2>()));
    // w' times what bends rho without the part that turns, which is w'/rho and finite on the axis.
    Mat2 straight = a.rr;
    if (at.rho > 0.0) straight -= across * across.transpose() / at.rho;
    const Vec2 gradient = a.z - w.first * a.rho;
    const Mat2 bend = a.zz - w.first * straight - w.round * across * across.transpose() -
                      w.second * a.rho * a.rho.transpose();
    return newton_step(gradient, bend, held(at, gradient), scale_);
  }
  Vec2 ring_step(const Footing& at, const Ascent& a, double radius, double slope) const {
    const Vec2 gradient = a.z - slope * a.rho;
    const std::array<bool, 2> fixed = held(at, gradient);
    const double missing = radius - at.rho;
    if (fixed[0] && fixed[1]) return Vec2::Zero();
    if (fixed[0] || fixed[1]) {
      const int i = fixed[0] ? 1 : 0;
      Vec2 step = Vec2::Zero();
      step[i] = missing / a.rho[i];
      return step;
    }
    const Vec2 up = a.rho.cwiseProduct(scale_);
    const double up2 = up.squaredNorm();
    if (!(up2 > 0.0)) return Vec2::Zero();
    const Vec2 normal = up * (missing / up2);
    const Vec2 along = Vec2(-up.y(), up.x()) / std::sqrt(up2);
    Mat2 bend = a.zz - slope * a.rr;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) bend(i, j) *= scale_[i] * scale_[j];
    const double rise = along.dot(gradient.cwiseProduct(scale_)) + along.dot(bend * normal);
    const double curve = along.dot(bend * along);
    const double step = rise / std::max({-curve, 0.2 * std::abs(curve), 1e-9});
    return (normal + step * along).cwiseProduct(scale_);
  }
  std::array<bool, 2> held(const Footing& at, const Vec2& gradient) const {
    std::array<bool, 2> out{};
    for (int i = 0; i < 2; ++i) {
      const int side = border(box_, at.uv, i);
      out[static_cast<size_t>(i)] = side != 0 && side * gradient[i] >= 0.0;
    }
    return out;
  }

  /// Takes the step, or as much of it as climbs; stops on rings that it crosses. mm that were moved.
  double advance(Footing& at, const Vec2& step) const {
    double share = std::min(1.0, 0.5 * setting_.profile.radius() / std::max(1e-9, length_of(at, step)));
    if (at.ring >= 0) share = std::min(share, share_to_border(at.uv, step));
    Footing next = at;
    for (int i = 0; i < 6; ++i, share *= 0.35) {
      next = footing_at(setting_, patch_, box_, snapped(at.uv + share * step));
      if (at.ring >= 0 && next.ring != at.ring) back_to_ring(at, next);
      const double ring = crossed(at, next);
      if (ring >= 0.0) {
        const double part = (ring - at.rho) / (next.rho - at.rho);
        next = footing_at(setting_, patch_, box_, at.uv + part * (next.uv - at.uv));
        to_ring(ring, next);
      }
      if (next.under() && next.height >= at.height) {
        const double moved = (next.d.S - at.d.S).norm();
        at = next;
        return moved;
      }
    }
    return 0.0;
  }
  /// Along a ring what is cut off at the border of the box must be cut off as a whole.
  double share_to_border(const Vec2& uv, const Vec2& step) const {
    double share = 1.0;
    for (int i = 0; i < 2; ++i) {
      const double room = (step[i] > 0.0 ? box_.high[i] : box_.low[i]) - uv[i];
      if (room != 0.0 && step[i] != 0.0) share = std::min(share, room / step[i]);
    }
    return share;
  }
  Vec2 snapped(const Vec2& uv) const {
    Vec2 inside = box_.nearest(uv);
    for (int i = 0; i < 2; ++i) {
      if (inside[i] - box_.low[i] < kSnap) inside[i] = box_.low[i];
      if (box_.high[i] - inside[i] < kSnap) inside[i] = box_.high[i];
    }
    return inside;
  }
  double length_of(const Footing& at, const Vec2& step) const {
    return (step.x() * at.d.Su + step.y() * at.d.Sv).norm();
  }
  /// A step along the ring leaves it by what the ring bends; one off it stays as it is.
  void back_to_ring(const Footing& at, Footing& next) const {
    const double radius = setting_.profile.pieces()[static_cast<size_t>(at.ring)].to;
    const bool left = next.under() && std::abs(next.rho - radius) > 0.3 * (next.d.S - at.d.S).norm();
    if (!left) to_ring(radius, next);
  }
  void to_ring(double radius, Footing& next) const {
    for (int i = 0; i < 4 && std::abs(next.rho - radius) > 0.5 * kOnRing_mm; ++i) {
      const Ascent a = ascent_of(next);
      Vec2 up = a.rho.cwiseProduct(scale_);
      // Along a border, not against it.
      for (int j = 0; j < 2; ++j)
        if (border(box_, next.uv, j) * up[j] * (radius - next.rho) > 0.0) up[j] = 0.0;
      const double up2 = up.squaredNorm();
      if (!(up2 > 0.0)) return;
      const Vec2 step = up.cwiseProduct(scale_) * ((radius - next.rho) / up2);
      next = footing_at(setting_, patch_, box_, box_.nearest(next.uv + step));
    }
  }
  /// The radius of a ring between two places, or -1.
  double crossed(const Footing& at, const Footing& next) const {
    const auto pieces = setting_.profile.pieces();
    if (!at.under()) return -1.0;
    for (size_t i = 0; i < pieces.size(); ++i) {
      const double ring = pieces[i].to;
      const bool outwards = at.rho < ring - kOnRing_mm && next.rho > ring + kOnRing_mm;
      const bool inwards = at.rho > ring + kOnRing_mm && next.rho < ring - kOnRing_mm;
      if ((outwards || inwards) && jump_at(setting_.profile, i).is_one()) return ring;
    }
    return -1.0;
  }

  const Setting& setting_;
  int patch_;
  UvBox box_;
  mutable Vec2 scale_ = Vec2::Ones();
};

}  // namespace

ProfileBend profile_bend(const ProfilePiece& piece, double rho) {
  if (piece.is_line()) return {piece.slope, 0.0, rho > 0.0 ? piece.slope / rho : 0.0};
  const double x = rho - piece.centre_rho, rest = piece.radius * piece.radius - x * x;
  if (!(rest > 0.0)) return {kUnbounded, kUnbounded, kUnbounded};
  const double root = std::sqrt(rest);
  ProfileBend bend{x / root, piece.radius * piece.radius / (rest * root), 0.0};
  // About the axis itself w'/rho has the limit 1/radius.
  bend.round = piece.centre_rho == 0.0 || rho <= 0.0 ? 1.0 / root : bend.first / rho;
  return bend;
}

Footing footing_at(const Setting& setting, int patch, const UvBox& box, const Vec2& uv) {
  const surface::Surface& surface = *setting.patches[static_cast<size_t>(patch)].surface;
  const surface::Derivatives d = surface.derivatives(uv.x(), uv.y());
  const GuideLine& line = setting.line;
  Footing at;
  at.patch = patch;
  at.uv = uv;
  at.d = {line.local(d.S),         about_line(line, d.Su),  about_line(line, d.Sv),
          about_line(line, d.Suu), about_line(line, d.Suv), about_line(line, d.Svv)};
  const Vec2 x = at.d.S.head<2>();
  at.rho = x.norm();
  if (at.rho > 0.0) at.out = x / at.rho;
  const double radius = setting.profile.radius();
  at.height =
      at.rho <= radius + kRim_mm ? at.d.S.z() - setting.profile.height(std::min(at.rho, radius)) : kNoFooting;
  if (at.under()) choose_slope(setting.profile, box, at);
  return at;
}

Footing settle(const Setting& setting, int patch, const UvBox& box, const Vec2& uv, int& steps) {
  return Climb(setting, patch, box).run(box.nearest(uv), steps);
}

Footing nearest_to_axis(const Setting& setting, int patch, const UvBox& box, const Vec2& uv, int& steps) {
  constexpr int kSteps = 8;
  constexpr double kEven = 1e-12;  // a direction along the axis changes nothing: it stays
  Footing at = footing_at(setting, patch, box, box.nearest(uv));
  const Vec2 side = box.high - box.low;
  for (int i = 0; i < kSteps; ++i) {
    const Vec2 x = at.d.S.head<2>(), u = at.d.Su.head<2>() * side.x(), v = at.d.Sv.head<2>() * side.y();
    const auto bent = [&](const Vec3& d, double scale) { return scale * x.dot(d.head<2>()); };
    Vec2 slope(x.dot(u), x.dot(v));
    Mat2 form;
    form << u.dot(u) + bent(at.d.Suu, side.x() * side.x()), u.dot(v) + bent(at.d.Suv, side.x() * side.y()),
        0.0, v.dot(v) + bent(at.d.Svv, side.y() * side.y());
    form(1, 0) = form(0, 1);
    // Where the distance falls off beyond a border, that border is kept.
    for (int k = 0; k < 2; ++k) {
      const bool held = slope[k] > 0.0 ? at.uv[k] <= box.low[k] : at.uv[k] >= box.high[k];
      if (!held) continue;
      slope[k] = form(0, 1) = form(1, 0) = 0.0;
      form(k, k) = 1.0;
    }
    form.diagonal().array() += kEven * (u.squaredNorm() + v.squaredNorm());
    const double det = form.determinant();
    Vec2 step = -slope.cwiseQuotient(Vec2(u.squaredNorm(), v.squaredNorm()).cwiseMax(kEven));
    if (det > 0.0 && form(0, 0) > 0.0)
      step =
          Vec2(form(0, 1) * slope[1] - form(1, 1) * slope[0], form(1, 0) * slope[0] - form(0, 0) * slope[1]) /
          det;
    const Footing next = footing_at(setting, patch, box, box.nearest(at.uv + step.cwiseProduct(side)));
    ++steps;
    if (!(next.rho < at.rho)) break;
    const bool there = (next.d.S - at.d.S).head<2>().norm() < kSettled_mm;
    at = next;
    if (there) break;
  }
  return at;
}

}  // namespace swarf::position

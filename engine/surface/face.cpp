#include "surface/face.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "surface/nurbs.h"

namespace swarf::surface {
namespace {

/// Twice the area, above 0 where it runs counter-clockwise.
double twice_area(const TrimLoop& loop) {
  double sum = 0.0;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = loop[i], &b = loop[(i + 1) % loop.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// Whether the closed segment meets the closed rectangle: their boxes overlap and the segment's line does not
/// leave all four corners on one side.
bool meets(const Vec2& a, const Vec2& b, const Vec2& low, const Vec2& high) {
  if (std::max(a.x(), b.x()) < low.x() || std::min(a.x(), b.x()) > high.x()) return false;
  if (std::max(a.y(), b.y()) < low.y() || std::min(a.y(), b.y()) > high.y()) return false;
  const Vec2 way = b - a;
  int left = 0, right = 0;
  for (const double u : {low.x(), high.x()}) {
    for (const double v : {low.y(), high.y()}) {
      const double side = way.x() * (v - a.y()) - way.y() * (u - a.x());
      left += side > 0.0;
      right += side < 0.0;
    }
  }
  return left < 4 && right < 4;
}

/// Gauss-Legendre, eight points on [0,1].
constexpr std::array<double, 8> kGaussPlace{0.019855071751231884, 0.10166676129318663, 0.23723379504183550,
                                            0.40828267875217511,  0.59171732124782489, 0.76276620495816450,
                                            0.89833323870681337,  0.98014492824876812};
constexpr std::array<double, 8> kGaussWeight{0.050614268145188130, 0.11119051722668724, 0.15685332293894363,
                                             0.18134189168918099,  0.18134189168918099, 0.15685332293894363,
                                             0.11119051722668724,  0.050614268145188130};

/// Where a surface's pieces end along one parameter; smooth pieces are divided once more, for |N| is no
/// polynomial.
std::vector<double> pieces_of(const Surface& surface, bool along_u) {
  const auto* nurbs = dynamic_cast<const NurbsSurface*>(&surface);
  const std::vector<double> unit{0.0, 1.0};
  const std::vector<double>& breaks = nurbs == nullptr ? unit
                                      : along_u        ? nurbs->grid().breaks_u
                                                       : nurbs->grid().breaks_v;
  constexpr int kDivisions = 4;
  std::vector<double> pieces{breaks.front()};
  for (size_t i = 0; i + 1 < breaks.size(); ++i) {
    for (int k = 1; k <= kDivisions; ++k)
      pieces.push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * k / kDivisions);
  }
  return pieces;
}

/// Integral over s from 0 to u at one v: of |N| and of S . N / 3.
FaceMeasure strip_to(const Surface& surface, const std::vector<double>& pieces, double u, double v) {
  FaceMeasure sum;
  for (size_t i = 0; i + 1 < pieces.size() && pieces[i] < u; ++i) {
    const double width = std::min(pieces[i + 1], u) - pieces[i];
    for (size_t k = 0; k < kGaussPlace.size(); ++k) {
      const Derivatives d = surface.derivatives(pieces[i] + kGaussPlace[k] * width, v);
      const Vec3 N = d.Su.cross(d.Sv);
      sum.area_mm2 += kGaussWeight[k] * width * N.norm();
      sum.flux_mm3 += kGaussWeight[k] * width * surface.outward_sign() * d.S.dot(N) / 3.0;
    }
  }
  return sum;
}

/// The integral along a segment of strip_to() dv, in pieces between the surface's breaks. What lies outside
/// the square is cut off by holding u and v to it.
void add_segment(const Surface& surface, const std::vector<double>& across, const std::vector<double>& along,
                 const Vec2& a, const Vec2& b, FaceMeasure& sum) {
  const double rise = b.y() - a.y();
  if (rise == 0.0) return;
  std::vector<double> stops{0.0, 1.0};
  const auto add_stop = [&](double t) {
    if (t > 0.0 && t < 1.0) stops.push_back(t);
  };
  for (const double v : along) add_stop((v - a.y()) / rise);
  for (const double u : across) {
    if (a.x() != b.x()) add_stop((u - a.x()) / (b.x() - a.x()));
  }
  std::sort(stops.begin(), stops.end());
  for (size_t i = 0; i + 1 < stops.size(); ++i) {
    const double width = stops[i + 1] - stops[i];
    const double middle = a.y() + 0.5 * (stops[i] + stops[i + 1]) * rise;
    if (middle < 0.0 || middle > 1.0) continue;
    for (size_t k = 0; k < kGaussPlace.size(); ++k) {
      const Vec2 place = a + (stops[i] + kGaussPlace[k] * width) * (b - a);
      const FaceMeasure strip = strip_to(surface, across, std::clamp(place.x(), 0.0, 1.0), place.y());
      sum.area_mm2 += kGaussWeight[k] * width * rise * strip.area_mm2;
      sum.flux_mm3 += kGaussWeight[k] * width * rise * strip.flux_mm3;
    }
  }
}

const TrimLoop& square() {
  static const TrimLoop loop{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  return loop;
}

}  // namespace

FaceDomain::FaceDomain(const Face& face) {
  for (const TrimLoop& loop : face.loops) {
    SWARF_CHECK(loop.size() >= 3, "a trimming loop has at least three places");
    for (size_t i = 0; i < loop.size(); ++i) segments_.push_back({loop[i], loop[(i + 1) % loop.size()]});
  }
  if (segments_.empty()) return;
  low_ = segments_.front().a.y();
  double high = low_;
  for (const Segment& s : segments_) {
    low_ = std::min(low_, s.a.y());
    high = std::max(high, s.a.y());
  }
  constexpr size_t kMostStrips = 4096;
  strips_.resize(std::min(segments_.size(), kMostStrips));
  height_ = std::max(high - low_, 1e-300) / static_cast<double>(strips_.size());
  for (uint32_t n = 0; n < segments_.size(); ++n) {
    const auto [from, to] = std::minmax(segments_[n].a.y(), segments_[n].b.y());
    for (size_t i = strip_of(from); i <= strip_of(to); ++i) strips_[i].push_back(n);
  }
}

size_t FaceDomain::strip_of(double v) const {
  const double strip = std::floor((v - low_) / height_);
  return static_cast<size_t>(std::clamp(strip, 0.0, static_cast<double>(strips_.size() - 1)));
}

bool FaceDomain::within_loops(const Vec2& uv) const {
  if (!is_trimmed()) return true;
  bool odd = false;
  for (const uint32_t n : strips_[strip_of(uv.y())]) {
    const auto& [a, b] = segments_[n];
    if ((a.y() > uv.y()) == (b.y() > uv.y())) continue;
    const double side = (b.x() - a.x()) * (uv.y() - a.y()) - (b.y() - a.y()) * (uv.x() - a.x());
    odd ^= (side > 0.0) == (b.y() > a.y());
  }
  return odd;
}

bool FaceDomain::inside(const Vec2& uv) const {
  return uv.minCoeff() >= 0.0 && uv.maxCoeff() <= 1.0 && within_loops(uv);
}

Region FaceDomain::classify(const Vec2& low, const Vec2& high) const {
  if (high.minCoeff() < 0.0 || low.maxCoeff() > 1.0) return Region::kOutside;
  if (is_trimmed()) {
    for (size_t i = strip_of(low.y()); i <= strip_of(high.y()); ++i) {
      for (const uint32_t n : strips_[i]) {
        if (meets(segments_[n].a, segments_[n].b, low, high)) return Region::kCrossing;
      }
    }
    if (!within_loops(0.5 * (low + high))) return Region::kOutside;
  }
  return low.minCoeff() >= 0.0 && high.maxCoeff() <= 1.0 ? Region::kInside : Region::kCrossing;
}

LoopGap join_loop(const Surface& surface, const std::vector<std::vector<Vec2>>& pieces, TrimLoop& loop) {
  LoopGap widest;
  loop.clear();
  for (size_t i = 0; i < pieces.size(); ++i) {
    const std::vector<Vec2>&piece = pieces[i], &before = pieces[(i + pieces.size() - 1) % pieces.size()];
    SWARF_CHECK(piece.size() >= 2, "a piece of a loop has at least two places");
    const Vec3 from = surface.point(before.back().x(), before.back().y());
    const double gap = (surface.point(piece.front().x(), piece.front().y()) - from).norm();
    if (gap > widest.gap_mm) widest = {gap, from};
    // A jump along a collapsed edge (the pole of a sphere) or a seam is none on the surface, but one here.
    constexpr double kSamePlace = 1e-6;
    if ((piece.front() - before.back()).norm() <= kSamePlace) {
      loop.push_back(0.5 * (before.back() + piece.front()));
    } else {
      loop.push_back(before.back());
      loop.push_back(piece.front());
    }
    loop.insert(loop.end(), piece.begin() + 1, piece.end() - 1);
  }
  return widest;
}

bool orient_loops(std::vector<TrimLoop>& loops) {
  if (loops.empty()) return true;
  const auto size = [](const TrimLoop& loop) { return std::abs(twice_area(loop)); };
  std::stable_sort(loops.begin(), loops.end(),
                   [&](const TrimLoop& a, const TrimLoop& b) { return size(a) > size(b); });
  const FaceDomain outer({nullptr, {loops.front()}, 0.0, "", 0});
  bool nested = true;
  for (size_t i = 0; i < loops.size(); ++i) {
    if ((twice_area(loops[i]) > 0.0) != (i == 0)) std::reverse(loops[i].begin(), loops[i].end());
    if (i == 0) continue;
    nested = nested && outer.inside(loops[i].front());
  }
  return nested;
}

namespace {

/// A parallelogram over the whole square: |N| and S . N are the same everywhere.
bool is_parallelogram(const Surface& surface) {
  constexpr double kFlat = 1e-12;  // mm
  const BendBounds b = surface.bend_bounds(Vec2::Zero(), Vec2::Ones());
  return std::max({b.uu.most(), b.uv.most(), b.vv.most()}) <= kFlat;
}

FaceMeasure measure_parallelogram(const Surface& surface, const std::vector<TrimLoop>& loops) {
  double share = 0.0;
  for (TrimLoop loop : loops) {
    for (Vec2& place : loop) place = place.cwiseMax(Vec2::Zero()).cwiseMin(Vec2::Ones());
    share += 0.5 * twice_area(loop);
  }
  const Derivatives d = surface.derivatives(0.5, 0.5);
  const Vec3 N = d.Su.cross(d.Sv);
  return {share * N.norm(), share * surface.outward_sign() * d.S.dot(N) / 3.0};
}

}  // namespace

FaceMeasure measure_face(const Face& face) {
  const std::vector<double> across = pieces_of(*face.surface, true), along = pieces_of(*face.surface, false);
  std::vector<TrimLoop> loops = face.loops;
  if (loops.empty()) loops.push_back(square());
  if (is_parallelogram(*face.surface)) return measure_parallelogram(*face.surface, loops);
  FaceMeasure sum;
  for (const TrimLoop& loop : loops) {
    for (size_t i = 0; i < loop.size(); ++i)
      add_segment(*face.surface, across, along, loop[i], loop[(i + 1) % loop.size()], sum);
  }
  return sum;
}

}  // namespace swarf::surface

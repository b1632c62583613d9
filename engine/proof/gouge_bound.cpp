#include "proof/gouge_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "collision/convex_distance.h"
#include "measure/sweep_index.h"
#include "proof/tool_body.h"
#include "stock/contact/convex_contact.h"

namespace swarf::proof {
namespace {

constexpr size_t kSweepsPerTask = 32;
/// A turning sweep is not divided below this share of its time.
constexpr double kShortest = 1.0 / 256.0;

/// Bodies of one cutter that lie within one depth of it: for each piece, the ways to reduce it.
using CutterBodies = std::vector<std::vector<collision::RevolvedSolid>>;

CutterBodies bodies_of(const stock::CutterSolid& cutter, double g_mm) {
  CutterBodies bodies;
  for (const cutter::ConvexPiece& piece : cutter.pieces) bodies.push_back(reduced_bodies(piece, g_mm));
  return bodies;
}

Pose pose_of(const ToolPose& tool) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), tool.axis_W).toRotationMatrix();
  pose.translation() = tool.tip_W;
  return pose;
}

/// A piece of a sweep: both ends, and how far what lies between strays from the hull of both.
struct Span {
  std::array<ToolPose, 2> ends;
  double stray_mm = 0.0;
  bool turns = false;
};

/// Angle between two axes, rad.
double turn_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Span span_of(const stock::Sweep& sweep, double t0, double t1, double lever_mm) {
  const double turn = turn_between(sweep.start.axis_W, sweep.end.axis_W);
  const auto at = [&](double t) -> ToolPose {
    const Vec3 tip = sweep.start.tip_W + t * (sweep.end.tip_W - sweep.start.tip_W);
    if (turn == 0.0) return {tip, sweep.start.axis_W};
    const Vec3 axis = std::sin((1.0 - t) * turn) * sweep.start.axis_W + std::sin(t * turn) * sweep.end.axis_W;
    return {tip, axis.normalized()};
  };
  Span span{{at(t0), at(t1)}, 0.0, turn > 0.0};
  if (!span.turns) return span;
  const double part = turn * (t1 - t0);
  span.stray_mm = part * part * lever_mm / 8.0 + stock::motion_bound(sweep, lever_mm);
  return span;
}

/// The directions that parted the tool from facets before: those beside them are parted by the same.
class Directions {
 public:
  /// Whether one of them serves; it is tried first the next time.
  template <typename Parts>
  bool any(const Parts& parts) {
    for (size_t i = 0; i < count_; ++i) {
      if (!parts(kept_[i])) continue;
      std::rotate(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(i),
                  kept_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      return true;
    }
    return false;
  }
  void keep(const Vec3& direction) {
    count_ = std::min(count_ + 1, kept_.size());
    std::rotate(kept_.begin(), kept_.end() - 1, kept_.end());
    kept_.front() = direction;
  }

 private:
  std::array<Vec3, 8> kept_;
  size_t count_ = 0;
};

class SpanBody {
 public:
  SpanBody(const collision::RevolvedSolid& solid, const Span& span) : solid_(solid), span_(span) {
    for (size_t i = 0; i < 2; ++i) {
      poses_[i] = pose_of(span.ends[i]);
      placed_[i] = {span.ends[i].tip_W, span.ends[i].axis_W, solid.corners};
    }
  }
  /// Greatest d . x over the hull of both ends, widened by the stray; d of length 1.
  double reach(const Vec3& d) const {
    return std::max(d.dot(support(placed_[0], d)), d.dot(support(placed_[1], d))) + span_.stray_mm;
  }
  Box box() const {
    Box box = bounds(placed_[0]);
    const Box other = bounds(placed_[1]);
    const Vec3 wide = Vec3::Constant(span_.stray_mm);
    return {box.lower.cwiseMin(other.lower) - wide, box.upper.cwiseMax(other.upper) + wide};
  }
  /// Tries the directions given, then looks for another one and puts it among them.
  bool is_clear_of(const std::array<Vec3, 3>& facet, const Vec3& normal, Directions& directions) const {
    const double plane = normal.dot(facet[0]);
    if (reach(-normal) <= -plane) return true;
    const auto parts = [&](const Vec3& d) {
      return reach(d) <= std::min({d.dot(facet[0]), d.dot(facet[1]), d.dot(facet[2])});
    };
    for (const Vec3& d : {span_.ends[0].axis_W, Vec3(-span_.ends[0].axis_W), normal})
      if (parts(d)) return true;
    if (directions.any(parts)) return true;
    collision::ConvexView tool, flat;
    for (size_t k = 0; k < 3; ++k) flat.corners[k] = flat.home[k] = facet[k];
    tool.solid = &solid_;
    tool.poses = 2;
    tool.pose[0] = &poses_[0];
    tool.pose[1] = &poses_[1];
    const collision::ConvexDistance apart = collision::convex_distance(flat, tool, span_.stray_mm);
    if (!(apart.lower > span_.stray_mm)) return false;
    directions.keep(apart.normal);
    return true;
  }
  /// A point of it, far from the tip.
  Vec3 top() const { return span_.ends[0].tip_W + solid_.corners.back().y() * span_.ends[0].axis_W; }

 private:
  const collision::RevolvedSolid& solid_;
  const Span& span_;
  std::array<Pose, 2> poses_;
  std::array<collision::RevolvedSolid, 2> placed_;
};

std::array<Vec3, 3> corners_of(const SolidDesign& design, uint32_t facet) {
  return {design.distance().corner(facet, 0), design.distance().corner(facet, 1),
          design.distance().corner(facet, 2)};
}

/// What a sweep meets: a facet, or kInside where it lies in the design without meeting one.
constexpr uint32_t kInside = 0xffffffffu;
using Meeting = std::optional<uint32_t>;

class Passage {
 public:
  explicit Passage(const SolidDesign& design) : design_(design) {}

  /// The first facet that keeps the body of the sweep from being clear; nothing: it is clear.
  Meeting meets(const stock::Sweep& sweep, const collision::RevolvedSolid& solid) {
    double lever = std::abs(solid.corners.back().y());
    for (const Vec2& corner : solid.corners) lever = std::max(lever, corner.norm());
    std::vector<std::array<double, 2>> spans{{0.0, 1.0}};
    while (!spans.empty()) {
      const auto [t0, t1] = spans.back();
      spans.pop_back();
      const Span span = span_of(sweep, t0, t1, lever);
      const Meeting met = meets(SpanBody(solid, span));
      if (!met) continue;
      if (!span.turns || t1 - t0 < kShortest) return met;
      const double middle = 0.5 * (t0 + t1);
      spans.push_back({middle, t1});
      spans.push_back({t0, middle});
    }
    return std::nullopt;
  }

 private:
  Meeting meets(const SpanBody& body) {
    found_.clear();
    design_.find(body.box(), found_);
    for (const uint32_t facet : found_)
      if (!body.is_clear_of(corners_of(design_, facet), design_.distance().face_normal(facet), directions_))
        return facet;
    if (design_.distance().at(body.top()).distance_mm < 0.0) return kInside;
    return std::nullopt;
  }

  const SolidDesign& design_;
  std::vector<uint32_t> found_;
  Directions directions_;
};

struct Deep {
  double depth_mm = 0.0;
  Vec3 bottom = Vec3::Zero(), foot = Vec3::Zero();
};

/// Looks for the deepest removed point under a facet: down its normal from places of the facet that the sweep
/// passes, a compass search over the places.
class DeepSearch {
 public:
  DeepSearch(const SolidDesign& design, const stock::Sweep& sweep, const stock::CutterSolid& cutter)
      : design_(design), map_(stock::sweep_map(sweep)), cutter_(cutter), sweep_(sweep) {}

  Deep under(uint32_t facet) const {
    Deep best;
    if (facet == kInside) {
      look_at(sweep_.start.tip_W + 0.5 * cutter_.height * sweep_.start.axis_W, best);
      return best;
    }
    const std::array<Vec3, 3> c = corners_of(design_, facet);
    const Vec3& normal = design_.distance().face_normal(facet);
    const auto place = [&](const Vec2& l) -> Vec3 {
      return c[0] + l.x() * (c[1] - c[0]) + l.y() * (c[2] - c[0]);
    };
    constexpr int kParts = 8;
    Vec2 at(1.0 / 3.0, 1.0 / 3.0);
    const auto try_at = [&](const Vec2& l) {
      if (l.minCoeff() < 0.0 || l.sum() > 1.0 || !look_below(place(l), normal, best)) return false;
      at = l;
      return true;
    };
    for (int i = 0; i <= kParts; ++i)
      for (int k = 0; i + k <= kParts; ++k)
        try_at({static_cast<double>(i) / kParts, static_cast<double>(k) / kParts});
    for (const ToolPose* pose : {&sweep_.start, &sweep_.end}) look_at(pose->tip_W, best);
    // Where the tool comes down on a large facet: the places under the tip, and around it.
    for (const double t : {0.0, 0.5, 1.0}) {
      const Vec3 tip = sweep_.start.tip_W + t * (sweep_.end.tip_W - sweep_.start.tip_W);
      mesh::Feature feature;
      const Vec3 near = mesh::closest_point_on_triangle(tip, c[0], c[1], c[2], &feature);
      try_at(shares(c, near));
    }
    for (double step = 0.5 / kParts; step > 1e-5; step *= 0.5) {
      for (bool better = true; better;) {
        better = false;
        const Vec2 middle(at.x(), at.y());
        for (const Vec2& d : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1), Vec2(1, -1), Vec2(-1, 1)})
          better = try_at(middle + step * d) || better;
      }
    }
    return best;
  }

 private:
  static Vec2 shares(const std::array<Vec3, 3>& c, const Vec3& x) {
    const Vec3 b = c[1] - c[0], d = c[2] - c[0], p = x - c[0];
    const double e = b.squaredNorm(), f = b.dot(d), g = d.squaredNorm(), det = e * g - f * f;
    if (!(det > 0.0)) return Vec2::Zero();
    const Vec2 l((g * b.dot(p) - f * d.dot(p)) / det, (e * d.dot(p) - f * b.dot(p)) / det);
    const Vec2 positive = l.cwiseMax(0.0);
    return positive / std::max(1.0, positive.sum());
  }

  bool removes(const Vec3& p) const { return stock::swept_contact(p, map_, cutter_).distance_mm <= 0.0; }

  bool look_at(const Vec3& p, Deep& best) const {
    if (!removes(p)) return false;
    const mesh::SignedPoint seen = design_.distance().at(p);
    if (!(-seen.distance_mm > best.depth_mm * (1.0 + 1e-6) + 1e-9)) return false;
    best = {-seen.distance_mm, p, seen.foot};
    return true;
  }

  /// The end of what the sweep removes below a place of a facet.
  bool look_below(const Vec3& place, const Vec3& normal, Deep& best) const {
    constexpr double kJustBelow = 1e-6, kFarthest = 1e3;
    double inside = kJustBelow;
    if (!removes(place - inside * normal)) return false;
    double outside = 2.0 * inside;
    while (outside < kFarthest && removes(place - outside * normal)) {
      inside = outside;
      outside *= 2.0;
    }
    for (int i = 0; i < 50 && outside - inside > 1e-9; ++i) {
      const double middle = 0.5 * (inside + outside);
      (removes(place - middle * normal) ? inside : outside) = middle;
    }
    return look_at(place - inside * normal, best);
  }

  const SolidDesign& design_;
  stock::SweepMap map_;
  const stock::CutterSolid& cutter_;
  const stock::Sweep& sweep_;
};

/// A sweep that was not clear, and what it met.
struct Blocked {
  uint32_t sweep = 0, facet = kInside;
};

class GougeSearch {
 public:
  explicit GougeSearch(const GougeQuestion& in) : in_(in) {}

  GougeBound run() {
    std::vector<Blocked> all;
    for (uint32_t n = 0; n < in_.sweeps.size(); ++n) all.push_back({n, kInside});
    constexpr double kFirstShare = 0.1, kAbove = 1.05;
    const double first = std::min(in_.limit_mm, std::max(kFirstShare * in_.limit_mm, kAbove * in_.known_mm));
    std::vector<Blocked> blocked = blocked_at(first, all);
    GougeBound result;
    if (blocked.empty()) {
      result.bound_mm = first;
      return result;
    }
    std::vector<Blocked> beyond = first < in_.limit_mm ? blocked_at(in_.limit_mm, blocked) : blocked;
    result.open = beyond.size();
    double low = first, high = in_.limit_mm;
    if (!beyond.empty()) {
      look_for_deepest(beyond, result);
      blocked = beyond;
      low = in_.limit_mm;
      // Up to where all are clear.
      constexpr double kMost = 100.0;  // mm
      for (high = std::max(2.0 * low, kAbove * result.found_mm); high < kMost; high *= 2.0) {
        beyond = blocked_at(high, blocked);
        if (beyond.empty()) break;
        blocked = beyond;
        low = high;
      }
    }
    result.bound_mm = narrowed(low, high, std::move(blocked), result);
    return result;
  }

 private:
  /// All of `blocked` are clear at `high`, not at `low`: the least depth between at which all are.
  double narrowed(double low, double high, std::vector<Blocked> blocked, GougeBound& result) {
    constexpr double kShare = 0.01, kLeast = 2e-5;
    if (!blocked.empty()) result.place = place_of(blocked.front());
    while (high - low > std::max(kShare * high, kLeast) && !in_.progress.stop_requested()) {
      const double middle = 0.5 * (low + high);
      std::vector<Blocked> still = blocked_at(middle, blocked);
      if (still.empty()) {
        high = middle;
        continue;
      }
      low = middle;
      blocked = std::move(still);
      result.place = place_of(blocked.front());
    }
    return high;
  }

  Vec3 place_of(const Blocked& blocked) const {
    const Vec3 tip = in_.sweeps[blocked.sweep].end.tip_W;
    if (blocked.facet == kInside) return in_.design.distance().at(tip).foot;
    const std::array<Vec3, 3> c = corners_of(in_.design, blocked.facet);
    return mesh::closest_point_on_triangle(tip, c[0], c[1], c[2]);
  }

  /// Those of `sweeps` for which no body within g of the cutter was clear; in their order.
  std::vector<Blocked> blocked_at(double g_mm, const std::vector<Blocked>& sweeps) {
    std::map<const stock::CutterSolid*, CutterBodies> bodies;
    for (const Blocked& one : sweeps) {
      const stock::CutterSolid* cutter = &in_.cutters[one.sweep];
      if (!bodies.contains(cutter)) bodies.emplace(cutter, bodies_of(*cutter, g_mm));
    }
    std::vector<Meeting> met(sweeps.size());
    parallel_chunks(sweeps.size(), kSweepsPerTask, [&](size_t begin, size_t end) {
      if (in_.progress.stop_requested()) return;
      Passage passage(in_.design);
      for (size_t i = begin; i < end; ++i) {
        const uint32_t n = sweeps[i].sweep;
        for (const auto& ways : bodies.at(&in_.cutters[n])) {
          Meeting least = ways.empty() ? Meeting() : Meeting(kInside);
          for (const collision::RevolvedSolid& solid : ways) {
            const Meeting one = passage.meets(in_.sweeps[n], solid);
            if (!one) least.reset();
            if (!one) break;
            least = one;
          }
          if (!least) continue;
          met[i] = least;
          break;
        }
      }
    });
    std::vector<Blocked> blocked;
    for (size_t i = 0; i < sweeps.size(); ++i)
      if (met[i]) blocked.push_back({sweeps[i].sweep, *met[i]});
    return blocked;
  }

  void look_for_deepest(const std::vector<Blocked>& blocked, GougeBound& result) {
    // Many sweeps may pass one place: some of them, evenly spread, tell how deep it is.
    constexpr size_t kMost = 400;
    const size_t step = std::max<size_t>(1, blocked.size() / kMost);
    const size_t count = (blocked.size() + step - 1) / step;
    std::vector<Deep> deep(count);
    parallel_chunks(count, 1, [&](size_t begin, size_t) {
      const Blocked& one = blocked[begin * step];
      const DeepSearch search(in_.design, in_.sweeps[one.sweep], in_.cutters[one.sweep]);
      std::vector<uint32_t> near;
      in_.design.find(measure::sweep_box(in_.sweeps[one.sweep], in_.cutters[one.sweep]), near);
      deep[begin] = search.under(one.facet);
      constexpr size_t kFacets = 64;
      for (size_t i = 0; i < std::min(kFacets, near.size()); ++i) {
        const Deep other = search.under(near[i]);
        if (other.depth_mm > deep[begin].depth_mm) deep[begin] = other;
      }
    });
    for (size_t i = 0; i < count; ++i) {
      if (!(deep[i].depth_mm > result.found_mm)) continue;
      result.found_mm = deep[i].depth_mm;
      result.bottom = deep[i].bottom;
      result.foot = deep[i].foot;
      result.sweep = blocked[i * step].sweep;
    }
  }

  const GougeQuestion& in_;
};

}  // namespace

GougeBound bound_gouges(const GougeQuestion& question) {
  return GougeSearch(question).run();
}

}  // namespace swarf::proof

#include "cutter/profile_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/plane_vectors.h"
#include "cutter/profile.h"

namespace swarf::cutter {
namespace {

constexpr double kDip = 1e-5;  // mm
constexpr double kNoWidthRad = 0.01;
constexpr double kShortestPiece = 1e-9;  // mm

std::string at(const Vec2& p) {
  return fmt::format("[{:g}, {:g}] mm", p.x(), p.y());
}

/// Points, before anything is drawn between them.
std::vector<std::string> point_problems(const std::vector<ProfilePoint>& profile) {
  if (profile.size() < 2)
    return {fmt::format("the profile has {} corners: it needs two or more", profile.size())};
  std::vector<std::string> problems;
  for (size_t i = 0; i < profile.size(); ++i) {
    const Vec2& p = profile[i].to;
    if (!p.allFinite() || !std::isfinite(profile[i].radius_mm)) {
      problems.push_back(fmt::format("corner {} of the profile is not a finite number", i + 1));
    } else if (p.x() < 0.0) {
      problems.push_back(fmt::format("corner {} of the profile, {}, lies beyond the axis", i + 1, at(p)));
    } else if (p.y() < 0.0) {
      problems.push_back(fmt::format("corner {} of the profile, {}, lies below the tip", i + 1, at(p)));
    } else if (p.x() < kShortestPiece && i > 0 && i + 1 < profile.size()) {
      problems.push_back(
          fmt::format("corner {} of the profile, {}, lies on the axis before the end", i + 1, at(p)));
    }
  }
  const ProfilePoint& first = profile.front();
  if (first.to.x() > 0.0) {
    problems.push_back(
        fmt::format("the profile starts at {}: it must start on the axis, at [0, 0]", at(first.to)));
  } else if (first.to.y() > 0.0) {
    problems.push_back(
        fmt::format("the profile starts at {}: its first corner is the tip, [0, 0]", at(first.to)));
  }
  if (first.radius_mm != 0.0)
    problems.emplace_back("the first corner of the profile is a point: it has no radius_mm");
  return problems;
}

std::vector<std::string> element_problems(const std::vector<ProfilePoint>& profile) {
  std::vector<std::string> problems;
  for (size_t i = 1; i < profile.size(); ++i) {
    const double chord = (profile[i].to - profile[i - 1].to).norm(), radius = profile[i].radius_mm;
    if (chord < kShortestPiece) {
      problems.push_back(
          fmt::format("corners {} and {} of the profile are the same, {}", i, i + 1, at(profile[i].to)));
    } else if (radius != 0.0 && 2.0 * std::abs(radius) < chord - kShortestPiece) {
      problems.push_back(
          fmt::format("the arc to corner {} of the profile, {}, has radius_mm {:g}, but the corners "
                      "are {:g} mm apart",
                      i + 1, at(profile[i].to), radius, chord));
    }
  }
  return problems;
}

/// True when a hollow arc comes to the axis between its ends.
bool reaches_axis(const OutlineElement& arc) {
  const double level = arc.centre.y();
  return arc.radius < 0.0 && arc.from.y() < level && level < arc.to.y() &&
         arc.centre.x() + arc.radius < kShortestPiece;
}

std::vector<OutlineElement> elements_of(const std::vector<ProfilePoint>& profile) {
  std::vector<OutlineElement> elements;
  for (size_t i = 1; i < profile.size(); ++i) {
    const Vec2 &from = profile[i - 1].to, &to = profile[i].to;
    elements.push_back(profile[i].radius_mm == 0.0 ? OutlineElement{from, to, 0.0, Vec2::Zero()}
                                                   : arc_between(from, to, profile[i].radius_mm));
  }
  return elements;
}

/// Where the open segments ab and cd cross, if they do.
std::optional<Vec2> crossing(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto side = [](const Vec2& p, const Vec2& q, const Vec2& x) { return cross(q - p, x - p); };
  const double from = side(c, d, a), to = side(c, d, b);
  if (side(a, b, c) * side(a, b, d) >= 0.0 || from * to >= 0.0) return std::nullopt;
  return a + (b - a) * (from / (from - to));
}

/// Where the outline turns back on itself: an edge or a notch of no width.
std::optional<Vec2> fold(const std::vector<OutlineElement>& elements) {
  for (size_t i = 0; i + 1 < elements.size(); ++i) {
    const Vec2 in = end_tangent(elements[i]), out = start_tangent(elements[i + 1]);
    if (in.dot(out) < 0.0 && std::abs(cross(in, out)) < kNoWidthRad) return elements[i].to;
  }
  return std::nullopt;
}

/// Where the drawn outline crosses itself, if it does. One that never falls can only fold; of the others this
/// finds the words.
std::optional<Vec2> self_crossing(const std::vector<OutlineElement>& elements) {
  double size = 0.0;
  for (const OutlineElement& e : elements) size = std::max(size, e.to.cwiseAbs().maxCoeff());
  const std::vector<Vec2> p = sample_outline(elements, 1e-3 * size);
  for (size_t i = 0; i + 1 < p.size(); ++i) {
    for (size_t k = i + 2; k + 1 < p.size(); ++k) {
      if (const auto where = crossing(p[i], p[i + 1], p[k], p[k + 1])) return where;
    }
  }
  return std::nullopt;
}

/// How far the element falls below the highest point before it, mm.
double dip(const OutlineElement& element) {
  if (element.is_line()) return element.from.y() - element.to.y();
  // An arc falls where its outward normal points towards the axis: at its ends, since it turns one way.
  const double side = element.radius > 0.0 ? 1.0 : -1.0, r = std::abs(element.radius);
  const auto beyond = [&](const Vec2& end) {
    const Vec2 arm = end - element.centre;
    return side * arm.x() < 0.0 ? r - std::abs(arm.y()) : 0.0;
  };
  return std::max({beyond(element.from), beyond(element.to), element.from.y() - element.to.y()});
}

}  // namespace

std::vector<std::string> profile_problems(const std::vector<ProfilePoint>& profile) {
  std::vector<std::string> problems = point_problems(profile);
  if (problems.empty()) problems = element_problems(profile);
  if (!problems.empty()) return problems;
  const std::vector<OutlineElement> elements = elements_of(profile);
  if (const std::optional<Vec2> where = fold(elements)) {
    return {fmt::format("the profile turns back on itself at {}", at(*where))};
  }
  if (const std::optional<Vec2> where = self_crossing(elements)) {
    return {fmt::format("the profile crosses itself near {}", at(*where))};
  }
  for (size_t i = 0; i < elements.size(); ++i) {
    if (reaches_axis(elements[i])) {
      problems.push_back(fmt::format("the hollow arc to corner {} of the profile reaches the axis", i + 2));
    }
    if (dip(elements[i]) <= kDip) continue;
    problems.push_back(
        fmt::format("the profile falls by {:g} mm on the way from corner {} to corner {}: dished "
                    "ends and hooks cannot be cut, every part of it must rise or stay level",
                    dip(elements[i]), i + 1, i + 2));
  }
  const OutlineElement& end = elements.back();
  if (problems.empty() && end.to.y() < kShortestPiece) {
    problems.emplace_back("the profile has no height");
  } else if (problems.empty() && end.from.y() > end.to.y() - kShortestPiece && end.from.x() < end.to.x()) {
    problems.push_back(fmt::format(
        "the profile ends with a level step outwards, at {}: a disc without thickness", at(end.to)));
  }
  return problems;
}

}  // namespace swarf::cutter

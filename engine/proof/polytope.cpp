#include "proof/polytope.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace swarf::proof {
namespace {

/// Corners this near to the plane lie on it; mm.
constexpr double kOnPlane = 1e-12;

/// One side of a cut: corners are taken over or made on the plane, each once.
class Side {
 public:
  Side(const Polytope& body, const std::vector<double>& heights, double sign)
      : body_(body), heights_(heights), sign_(sign), number_(body.corners.size(), kNone) {}

  Polytope part(const Vec3& normal) {
    for (const std::vector<uint16_t>& face : body_.faces) add_face(face);
    add_cut_face(normal);
    return std::move(part_);
  }

 private:
  static constexpr uint16_t kNone = 0xffff;
  struct Crossing {
    uint16_t a, b, number;
  };

  double height(uint16_t corner) const { return sign_ * heights_[corner]; }

  uint16_t kept(uint16_t corner) {
    if (number_[corner] == kNone) {
      number_[corner] = static_cast<uint16_t>(part_.corners.size());
      part_.corners.push_back(body_.corners[corner]);
      if (std::abs(heights_[corner]) <= kOnPlane) on_plane_.push_back(number_[corner]);
    }
    return number_[corner];
  }

  uint16_t crossing(uint16_t from, uint16_t to) {
    const uint16_t a = std::min(from, to), b = std::max(from, to);
    for (const Crossing& known : crossings_)
      if (known.a == a && known.b == b) return known.number;
    const double t = heights_[a] / (heights_[a] - heights_[b]);
    const auto number = static_cast<uint16_t>(part_.corners.size());
    part_.corners.push_back(body_.corners[a] + t * (body_.corners[b] - body_.corners[a]));
    on_plane_.push_back(number);
    crossings_.push_back({a, b, number});
    return number;
  }

  void add_face(const std::vector<uint16_t>& face) {
    std::vector<uint16_t> kept_face;
    for (size_t k = 0; k < face.size(); ++k) {
      const uint16_t from = face[k], to = face[(k + 1) % face.size()];
      if (height(from) <= kOnPlane) kept_face.push_back(kept(from));
      const bool crosses = (height(from) > kOnPlane && height(to) < -kOnPlane) ||
                           (height(from) < -kOnPlane && height(to) > kOnPlane);
      if (crosses) kept_face.push_back(crossing(from, to));
    }
    if (kept_face.size() >= 3) part_.faces.push_back(std::move(kept_face));
  }

  /// The corners on the plane, around their middle.
  void add_cut_face(const Vec3& normal) {
    if (on_plane_.size() < 3) return;
    Vec3 middle = Vec3::Zero();
    for (const uint16_t n : on_plane_) middle += part_.corners[n];
    middle /= static_cast<double>(on_plane_.size());
    int least = 0;
    normal.cwiseAbs().minCoeff(&least);
    const Vec3 e1 = normal.cross(Vec3::Unit(least)).normalized(), e2 = normal.cross(e1);
    std::vector<std::pair<double, uint16_t>> around;
    for (const uint16_t n : on_plane_) {
      const Vec3 d = part_.corners[n] - middle;
      around.emplace_back(std::atan2(d.dot(e2), d.dot(e1)), n);
    }
    std::sort(around.begin(), around.end());
    std::vector<uint16_t> face;
    for (const auto& [angle, n] : around) face.push_back(n);
    part_.faces.push_back(std::move(face));
  }

  const Polytope& body_;
  const std::vector<double>& heights_;
  double sign_;
  std::vector<uint16_t> number_, on_plane_;
  std::vector<Crossing> crossings_;
  Polytope part_;
};

}  // namespace

Vec3 Polytope::centre() const {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& corner : corners) sum += corner;
  return sum / static_cast<double>(corners.size());
}

double Polytope::radius(const Vec3& from) const {
  double squared = 0.0;
  for (const Vec3& corner : corners) squared = std::max(squared, (corner - from).squaredNorm());
  return std::sqrt(squared);
}

Box Polytope::box() const {
  Box box{corners.front(), corners.front()};
  for (const Vec3& corner : corners) {
    box.lower = box.lower.cwiseMin(corner);
    box.upper = box.upper.cwiseMax(corner);
  }
  return box;
}

Polytope frustum_between(std::span<const Vec3> lower, std::span<const Vec3> upper) {
  Polytope body;
  body.corners.assign(lower.begin(), lower.end());
  body.corners.insert(body.corners.end(), upper.begin(), upper.end());
  const auto n = static_cast<uint16_t>(lower.size());
  std::vector<uint16_t> low, high;
  for (uint16_t k = 0; k < n; ++k) {
    const auto next = static_cast<uint16_t>((k + 1) % n);
    low.push_back(static_cast<uint16_t>(n - 1 - k));
    high.push_back(static_cast<uint16_t>(n + k));
    body.faces.push_back({k, next, static_cast<uint16_t>(n + next), static_cast<uint16_t>(n + k)});
  }
  body.faces.push_back(std::move(low));
  body.faces.push_back(std::move(high));
  return body;
}

Polytope box_polytope(const Box& box) {
  const auto at = [&](bool x, bool y, bool z) {
    return Vec3(x ? box.upper.x() : box.lower.x(), y ? box.upper.y() : box.lower.y(),
                z ? box.upper.z() : box.lower.z());
  };
  const std::array<Vec3, 4> lower{at(false, false, false), at(true, false, false), at(true, true, false),
                                  at(false, true, false)};
  const std::array<Vec3, 4> upper{at(false, false, true), at(true, false, true), at(true, true, true),
                                  at(false, true, true)};
  return frustum_between(lower, upper);
}

std::pair<Polytope, Polytope> cut_by_plane(const Polytope& body, const Vec3& normal, double offset) {
  std::vector<double> heights;
  heights.reserve(body.corners.size());
  for (const Vec3& corner : body.corners) heights.push_back(normal.dot(corner) - offset);
  return {Side(body, heights, 1.0).part(normal), Side(body, heights, -1.0).part(normal)};
}

}  // namespace swarf::proof

#include "render/gltf/keyframes.h"

#include <algorithm>
#include <functional>

#include "base/check.h"

namespace swarf::render {
namespace {

/// Error at index i when the keys on both sides of it are a and b, at the share t of their interval.
using KeyError = std::function<double(size_t a, size_t b, size_t i, double t)>;

std::vector<size_t> ramer(std::span<const double> times, double tolerance, const KeyError& error) {
  if (times.empty()) return {};
  std::vector<size_t> keys{0};
  if (times.size() == 1) return keys;
  std::vector<std::pair<size_t, size_t>> open{{0, times.size() - 1}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    size_t worst = a;
    double worst_error = tolerance;
    for (size_t i = a + 1; i < b; ++i) {
      const double e = error(a, b, i, (times[i] - times[a]) / (times[b] - times[a]));
      if (e > worst_error) {
        worst_error = e;
        worst = i;
      }
    }
    if (worst == a) {
      keys.push_back(b);
    } else {
      open.emplace_back(worst, b);  // the left half is taken first, so that keys ascend
      open.emplace_back(a, worst);
    }
  }
  return keys;
}

}  // namespace

std::vector<Eigen::Quaterniond> continuous_rotations(std::span<const Pose> poses) {
  std::vector<Eigen::Quaterniond> rotations;
  rotations.reserve(poses.size());
  for (const Pose& pose : poses) {
    Eigen::Quaterniond q(pose.linear());
    q.normalize();
    if (!rotations.empty() && rotations.back().dot(q) < 0.0) q.coeffs() = -q.coeffs();
    rotations.push_back(q);
  }
  return rotations;
}

std::vector<size_t> translation_keys(std::span<const double> times_s, std::span<const Pose> poses,
                                     double tolerance_mm) {
  SWARF_CHECK(times_s.size() == poses.size(), "one time for each pose");
  return ramer(times_s, tolerance_mm, [&](size_t a, size_t b, size_t i, double t) {
    const Vec3 from = poses[a].translation(), to = poses[b].translation();
    return (from + t * (to - from) - poses[i].translation()).norm();
  });
}

std::vector<size_t> rotation_keys(std::span<const double> times_s,
                                  std::span<const Eigen::Quaterniond> rotations, double tolerance_rad) {
  SWARF_CHECK(times_s.size() == rotations.size(), "one time for each rotation");
  return ramer(times_s, tolerance_rad, [&](size_t a, size_t b, size_t i, double t) {
    return rotations[a].slerp(t, rotations[b]).angularDistance(rotations[i]);
  });
}

}  // namespace swarf::render

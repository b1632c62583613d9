#include "measure/alignment.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "base/diagnostics.h"

namespace swarf::measure {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr int kMostSteps = 200;
constexpr double kAtRest = 1e-7;  // mm: a step that moves no point by more is the last
/// Of the greatest eigenvalue: less is what the shapes leave open, and rounding.
constexpr double kOpenMotion = 1e-6;
/// Of the extent along the line: what the points must lie beside it.
constexpr double kBesideLine = 1e-3;

/// Point i lies in the triangle in which the share (i + 1/2) / n of the area ends, at places of a sequence
/// that fills the triangle evenly.
std::vector<Vec3> spread_points(const mesh::SignedDistance& mesh, size_t count) {
  std::vector<double> areas;
  double all = 0.0;
  for (uint32_t t = 0; t < mesh.mesh().triangles.size(); ++t) {
    all += 0.5 * (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0)).norm();
    areas.push_back(all);
  }
  std::vector<Vec3> points;
  uint32_t t = 0;
  for (size_t i = 0; i < count; ++i) {
    const double at = all * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    while (t + 1 < areas.size() && areas[t] < at) ++t;
    constexpr double kPlastic1 = 0.7548776662466927, kPlastic2 = 0.5698402909980532;  // Roberts' sequence
    double whole = 0.0;
    double u = std::modf(kPlastic1 * static_cast<double>(i), &whole);
    double v = std::modf(kPlastic2 * static_cast<double>(i), &whole);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const Vec3 a = mesh.corner(t, 0);
    points.push_back(a + u * (mesh.corner(t, 1) - a) + v * (mesh.corner(t, 2) - a));
  }
  return points;
}

/// Turn and shift about `centre`, lengths over `size` so that both count alike.
struct NormalEquations {
  Mat6 matrix = Mat6::Zero();
  Vec6 right = Vec6::Zero();
  double squares = 0.0;

  void add(const Vec3& arm, const Vec3& normal, double distance) {
    Vec6 row;
    row << arm.cross(normal), normal;
    matrix += row * row.transpose();
    right -= distance * row;
    squares += distance * distance;
  }
  /// Along what the shapes decide alone.
  Vec6 solve() const {
    const Eigen::SelfAdjointEigenSolver<Mat6> eigen(matrix);
    const double least = kOpenMotion * eigen.eigenvalues().maxCoeff();
    Vec6 step = Vec6::Zero();
    for (int i = 0; i < 6; ++i) {
      const double value = eigen.eigenvalues()[i];
      if (value > least)
        step += eigen.eigenvectors().col(i) * (eigen.eigenvectors().col(i).dot(right) / value);
    }
    return step;
  }
};

Pose about(const Vec3& centre, const Vec3& turn, const Vec3& shift) {
  Pose pose = Pose::Identity();
  const double angle = turn.norm();
  if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  pose.translation() = centre + shift - pose.linear() * centre;
  return pose;
}

double rms_of_pairs(std::span<const PointPair> pairs, const Pose& pose) {
  double squares = 0.0;
  for (const auto& [stock, design] : pairs) squares += (pose * stock - design).squaredNorm();
  return std::sqrt(squares / static_cast<double>(pairs.size()));
}

void refuse_line(std::span<const PointPair> pairs) {
  for (const bool second : {false, true}) {
    const auto point = [&](const PointPair& pair) { return second ? pair.second : pair.first; };
    Vec3 middle = Vec3::Zero();
    for (const PointPair& pair : pairs) middle += point(pair) / static_cast<double>(pairs.size());
    Mat3 spread = Mat3::Zero();
    for (const PointPair& pair : pairs) spread += (point(pair) - middle) * (point(pair) - middle).transpose();
    const Vec3 squares = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvalues();
    if (squares[1] > kBesideLine * kBesideLine * squares[2]) continue;
    throw InputError("points-on-a-line", {"--align"},
                     std::string("the points of the ") + (second ? "design" : "stock") +
                         " lie on a line: the turn about it is left open",
                     "take three points that span a triangle, or --best-fit");
  }
}

}  // namespace

Alignment align_points(std::span<const PointPair> pairs) {
  if (pairs.size() < 3)
    throw InputError("points-on-a-line", {"--align"}, "an alignment needs three pairs of points or more",
                     "give --align three times");
  refuse_line(pairs);
  Eigen::Matrix3Xd from(3, pairs.size()), to(3, pairs.size());
  for (size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = pairs[i].first;
    to.col(static_cast<Eigen::Index>(i)) = pairs[i].second;
  }
  Alignment found;
  found.X_design_stock.matrix() = Eigen::umeyama(from, to, false);
  found.points = pairs.size();
  found.rms_before_mm = rms_of_pairs(pairs, Pose::Identity());
  found.rms_mm = rms_of_pairs(pairs, found.X_design_stock);
  return found;
}

Alignment best_fit(const mesh::SignedDistance& stock, const mesh::SignedDistance& design, const Pose& start) {
  const std::vector<Vec3> points = spread_points(stock, kFitPoints);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  double size = 0.0;
  for (const Vec3& p : points) size = std::max(size, (p - middle).norm());
  Alignment found;
  found.X_design_stock = start;
  found.points = points.size();
  for (; found.steps < kMostSteps; ++found.steps) {
    NormalEquations equations;
    const Vec3 centre = found.X_design_stock * middle;
    for (const Vec3& p : points) {
      const Vec3 at = found.X_design_stock * p;
      const mesh::SignedPoint seen = design.at(at);
      equations.add((at - centre) / size, seen.normal, (at - seen.foot).dot(seen.normal));
    }
    found.rms_mm = std::sqrt(equations.squares / static_cast<double>(points.size()));
    if (found.steps == 0) found.rms_before_mm = found.rms_mm;
    const Vec6 step = equations.solve();
    if (step.head<3>().norm() + step.tail<3>().norm() < kAtRest) return found;
    found.X_design_stock = about(centre, step.head<3>() / size, step.tail<3>()) * found.X_design_stock;
  }
  throw InputError("no-best-fit", {"--best-fit"},
                   "stock and design do not come to rest: after " + std::to_string(kMostSteps) +
                       " steps the stock still moves",
                   "bring them near each other by --align, or check that they are the same part");
}

TriMesh moved(const TriMesh& mesh, const Pose& pose) {
  TriMesh out = mesh;
  for (auto& position : out.positions) {
    const Vec3 p = pose * Vec3(position[0], position[1], position[2]);
    position = {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
  }
  for (auto& normal : out.normals) {
    const Vec3 n = pose.linear() * Vec3(normal[0], normal[1], normal[2]);
    normal = {static_cast<float>(n.x()), static_cast<float>(n.y()), static_cast<float>(n.z())};
  }
  return out;
}

}  // namespace swarf::measure

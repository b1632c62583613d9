#include <fmt/format.h>

#include <cmath>

#include "mesh/plain_solids.h"
#include "stock/raw/raw_body.h"

namespace swarf::stock {
namespace {

class RawBox final : public RawBody {
 public:
  explicit RawBox(const Box& box) : box_(box) {}

  Box box() const override { return box_; }
  bool is_box() const override { return true; }
  std::vector<Vec3> corners() const override {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
      const auto at = [&](int a) { return (i >> a) % 2 != 0 ? box_.upper[a] : box_.lower[a]; };
      corners.emplace_back(at(0), at(1), at(2));
    }
    return corners;
  }
  /// By quarter turns: the numbers of a box again.
  std::shared_ptr<const RawBody> moved(const Pose& X_VW) const override {
    const Mat3 turn = X_VW.linear();
    if (!(turn.array() == 0.0 || turn.array().abs() == 1.0).all()) return nullptr;
    const Vec3 a = X_VW * box_.lower + Vec3::Zero(), b = X_VW * box_.upper + Vec3::Zero();  // no -0
    return make_raw_box({a.cwiseMin(b), a.cwiseMax(b)});
  }
  TriMesh mesh_around() const override {
    TriMesh mesh;
    mesh::add_box(mesh, box_);
    return mesh;
  }
  double volume_mm3() const override { return box_.size().prod(); }
  double area_mm2() const override {
    const Vec3 d = box_.size();
    return 2.0 * (d.x() * d.y() + d.y() * d.z() + d.z() * d.x());
  }

  RawPoint at(const Vec3& p, double within) const override {
    const Vec3 inside = p.cwiseMax(box_.lower).cwiseMin(box_.upper), away = p - inside;
    const double outside = away.norm();
    RawPoint at;
    if (outside > 0.0) {
      at = {outside, inside, away / outside};
    } else {
      int axis = 0;
      const Vec3 low = p - box_.lower, high = box_.upper - p;
      at.distance_mm = -low.cwiseMin(high).minCoeff(&axis);
      const bool upper = high[axis] < low[axis];
      at.normal = (upper ? 1.0 : -1.0) * Vec3::Unit(axis);
      at.foot = p;
      at.foot[axis] = upper ? box_.upper[axis] : box_.lower[axis];
    }
    return std::abs(at.distance_mm) <= within ? at : RawPoint{};
  }

  void add_crossings(const Vec3& p, const Vec3& way, std::vector<double>& s) const override {
    for (int a = 0; a < 3; ++a) {
      if (way[a] == 0.0) continue;
      s.push_back((box_.lower[a] - p[a]) / way[a]);
      s.push_back((box_.upper[a] - p[a]) / way[a]);
    }
  }

  RawExtent extent(const Vec3& centre, double radius, const Vec3& m) const override {
    RawExtent extent;
    const Vec3 low = box_.lower.cwiseMax(centre - Vec3::Constant(radius));
    const Vec3 high = box_.upper.cwiseMin(centre + Vec3::Constant(radius));
    if ((high - low).minCoeff() < 0.0) return extent;
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2;
      Vec3 a = low, b = high;
      const double at = face % 2 != 0 ? box_.upper[axis] : box_.lower[axis];
      if (std::abs(at - centre[axis]) > radius) continue;
      a[axis] = b[axis] = at;
      include(extent, m.cwiseProduct(a).cwiseMin(m.cwiseProduct(b)).sum());
      include(extent, m.cwiseProduct(a).cwiseMax(m.cwiseProduct(b)).sum());
    }
    return extent;
  }

  std::vector<RawFace> faces(const Vec3& centre, double radius) const override {
    std::vector<RawFace> faces;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(box_.upper[axis] - centre[axis]) <= radius)
        faces.push_back({Vec3::Unit(axis), box_.upper[axis], box_.upper[axis]});
      if (std::abs(box_.lower[axis] - centre[axis]) <= radius)
        faces.push_back({-Vec3::Unit(axis), -box_.lower[axis], -box_.lower[axis]});
    }
    return faces;
  }

  std::vector<RawPlace> places(double) const override {
    std::vector<RawPlace> places;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 point = box_.centre();
      point[axis] = box_.upper[axis];
      places.push_back({point, Vec3::Unit(axis)});
    }
    return places;
  }

  std::string text() const override {
    return fmt::format("box [[{}, {}, {}], [{}, {}, {}]] mm", box_.lower.x(), box_.lower.y(), box_.lower.z(),
                       box_.upper.x(), box_.upper.y(), box_.upper.z());
  }

 private:
  Box box_;
};

}  // namespace

std::shared_ptr<const RawBody> make_raw_box(const Box& box_W) {
  return std::make_shared<RawBox>(box_W);
}

}  // namespace swarf::stock

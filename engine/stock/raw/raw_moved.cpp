// A raw stock in another place: every question is asked in the frame of the one that was moved.
#include <fmt/format.h>

#include <limits>
#include <utility>

#include "stock/raw/raw_body.h"

namespace swarf::stock {
namespace {

class RawMoved final : public RawBody {
 public:
  RawMoved(std::shared_ptr<const RawBody> body, const Pose& X_WF)
      : body_(std::move(body)), X_WF_(X_WF), X_FW_(X_WF.inverse(Eigen::Isometry)) {}

  /// The body is known by places that lie on it: their box is the least one.
  Box box() const override {
    Box box{Vec3::Constant(std::numeric_limits<double>::infinity()),
            Vec3::Constant(-std::numeric_limits<double>::infinity())};
    for (const Vec3& corner : body_->corners()) {
      const Vec3 p = X_WF_ * corner;
      box.lower = box.lower.cwiseMin(p);
      box.upper = box.upper.cwiseMax(p);
    }
    return box;
  }
  std::vector<Vec3> corners() const override {
    std::vector<Vec3> corners = body_->corners();
    for (Vec3& corner : corners) corner = X_WF_ * corner;
    return corners;
  }
  std::shared_ptr<const RawBody> moved(const Pose& X_VW) const override {
    return moved_body(body_, X_VW * X_WF_);
  }

  double volume_mm3() const override { return body_->volume_mm3(); }
  double area_mm2() const override { return body_->area_mm2(); }
  size_t memory_bytes() const override { return body_->memory_bytes(); }

  RawPoint at(const Vec3& p, double within) const override {
    RawPoint at = body_->at(X_FW_ * p, within);
    at.foot = X_WF_ * at.foot;
    at.normal = X_WF_.linear() * at.normal;
    return at;
  }
  void add_crossings(const Vec3& p, const Vec3& way, std::vector<double>& s) const override {
    body_->add_crossings(X_FW_ * p, X_FW_.linear() * way, s);
  }
  RawExtent extent(const Vec3& centre, double radius, const Vec3& m) const override {
    RawExtent extent = body_->extent(X_FW_ * centre, radius, X_FW_.linear() * m);
    if (extent.empty()) return extent;
    extent.least += m.dot(X_WF_.translation());
    extent.greatest += m.dot(X_WF_.translation());
    return extent;
  }
  std::vector<RawFace> faces(const Vec3& centre, double radius) const override {
    std::vector<RawFace> faces = body_->faces(X_FW_ * centre, radius);
    for (RawFace& face : faces) {
      face.normal = X_WF_.linear() * face.normal;
      const double away = face.normal.dot(X_WF_.translation());
      face.least += away;
      face.greatest += away;
      for (Vec3& p : face.hull) p = X_WF_ * p;
    }
    return faces;
  }
  std::vector<RawPlace> places(double step) const override {
    std::vector<RawPlace> places = body_->places(step);
    for (RawPlace& place : places) place = {X_WF_ * place.point_W, X_WF_.linear() * place.normal_W};
    return places;
  }
  TriMesh mesh_around() const override {
    TriMesh mesh = body_->mesh_around();
    for (auto& p : mesh.positions) {
      const Vec3 q = X_WF_ * Vec3(p[0], p[1], p[2]);
      p = {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
    }
    mesh.normals.clear();
    return mesh;
  }

  std::string text() const override {
    std::string rows;
    for (int i = 0; i < 3; ++i) {
      const Mat3 r = X_WF_.linear();
      rows += fmt::format("{}[{}, {}, {}, {}]", i > 0 ? ", " : "", r(i, 0), r(i, 1), r(i, 2),
                          X_WF_.translation()[i]);
    }
    return fmt::format("{}, moved by [{}]", body_->text(), rows);
  }

 private:
  std::shared_ptr<const RawBody> body_;
  Pose X_WF_, X_FW_;
};

}  // namespace

std::shared_ptr<const RawBody> moved_body(std::shared_ptr<const RawBody> body, const Pose& X_WF) {
  if (X_WF.matrix() == Pose::Identity().matrix()) return body;
  return std::make_shared<RawMoved>(std::move(body), X_WF);
}

}  // namespace swarf::stock

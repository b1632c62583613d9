// A shape where the job has it.
#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>
#include <TopLoc_Location.hxx>
#include <gp_Trsf.hxx>

#include "brep/occt_shape.h"

namespace swarf::brep {
namespace {

TopLoc_Location location_of(const Pose& pose) {
  gp_Trsf motion;
  const Mat3& R = pose.linear();
  const Vec3& t = pose.translation();
  motion.SetValues(R(0, 0), R(0, 1), R(0, 2), t.x(), R(1, 0), R(1, 1), R(1, 2), t.y(), R(2, 0), R(2, 1),
                   R(2, 2), t.z());
  return {motion};
}

/// The least box around a shape's faces, within the library's own precision.
Box box_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  constexpr bool kByTriangles = false, kByTolerances = false;
  BRepBndLib::AddOptimal(shape, box, kByTriangles, kByTolerances);
  Box found;
  box.Get(found.lower.x(), found.lower.y(), found.lower.z(), found.upper.x(), found.upper.y(),
          found.upper.z());
  return found;
}

Pose pose_of(const TopoDS_Shape& shape, const Placement& placement) {
  if (placement.origin == PartOrigin::kFile) return placement.pose({});
  Pose turn = Pose::Identity();
  turn.linear() = placement.turn;
  return placement.pose(box_of(shape.Moved(location_of(turn))));
}

}  // namespace

void take_placed(const TopoDS_Shape& shape, const NameOf& name_of, const Placement& placement, Model& model) {
  if (placement.stays()) {
    take_shape(shape, name_of, model);
    return;
  }
  const TopLoc_Location to = location_of(pose_of(shape, placement)), back = to.Inverted();
  // The file's names are those of the shape as it was read.
  take_shape(
      shape.Moved(to), [&](const TopoDS_Shape& part) { return name_of(part.Moved(back)); }, model);
}

}  // namespace swarf::brep

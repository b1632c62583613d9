// The library's shape and what its calls need around them. Internal to this folder.
#pragma once

#include <Message_Messenger.hxx>
#include <Standard_Transient.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "brep/model.h"
#include "surface/nurbs.h"

namespace swarf::brep {

struct Shape {
  TopoDS_Shape nurbs;  ///< every face on a B-spline surface
};

/// Names that a file gives to a shape: empty where it gives none.
using NameOf = std::function<std::string(const TopoDS_Shape&)>;

/// While it lives nothing is printed, what the library says is kept, and nobody else calls it: its sessions
/// are global.
class QuietSession {
 public:
  QuietSession();
  ~QuietSession();
  QuietSession(const QuietSession&) = delete;
  QuietSession& operator=(const QuietSession&) = delete;

  /// Lines of failures and alarms, each once.
  std::string said() const;

 private:
  std::unique_lock<std::mutex> lock_;
  Message_SequenceOfPrinters printers_;
  Handle(Message_Printer) listener_;
};

/// Runs a piece of the library; what it throws becomes InputError "cad-unreadable" of this file.
void guarded(const std::string& path, const std::function<void()>& work);

/// Faces, edges, vertices and solids of a shape in mm into the model.
void take_shape(const TopoDS_Shape& shape, const NameOf& name_of, Model& model);
/// The same of a shape that is moved to its place; names are asked of the shape as it was read.
void take_placed(const TopoDS_Shape& shape, const NameOf& name_of, const Placement& placement, Model& model);

/// A face's whole surface as it is meshed; `low`, `high` are the library's parameters of the unit square.
struct MeshedFace {
  std::shared_ptr<const surface::NurbsSurface> whole;
  std::vector<surface::NurbsPart> parts;  ///< without creases; their normals point out of the body
  Vec2 low, high;

  bool creased() const { return parts.size() > 1; }
};
MeshedFace meshed_face(const TopoDS_Face& face);

/// Refuses what is missing, a folder, empty or larger than a GB; the beginning of the file comes back.
std::string check_cad_file(const std::string& path);

}  // namespace swarf::brep

// IGES, and which reader a file is for.
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Solid.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "brep/occt_shape.h"

namespace swarf::brep {
namespace {

bool ends_with_any(const std::string& path, const std::vector<std::string>& endings) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

bool is_step_name(const std::string& path) {
  return ends_with_any(path, {".stp", ".step", ".p21"});
}

void add_parts(const TopoDS_Shape& shape, BRep_Builder& builder, TopoDS_Compound& all) {
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) builder.Add(all, it.Current());
}

/// Solids of the file, and what hangs together of its loose faces: closed shells as solids turned outward.
TopoDS_Shape sewn(const TopoDS_Shape& shape, double within_mm) {
  BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  add_parts(shape, builder, all);
  BRepBuilderAPI_Sewing sewing(within_mm);
  bool any = false;
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next(), any = true)
    sewing.Add(it.Current());
  if (!any) return all;
  sewing.Perform();
  const TopoDS_Shape result = sewing.SewedShape();
  for (TopExp_Explorer it(result, TopAbs_SHELL); it.More(); it.Next()) {
    TopoDS_Solid solid;
    if (BRep_Tool::IsClosed(it.Current())) {
      builder.MakeSolid(solid);
      builder.Add(solid, it.Current());
    }
    if (!solid.IsNull() && BRepLib::OrientClosedSolid(solid)) {
      builder.Add(all, solid);
    } else {
      builder.Add(all, it.Current());
    }
  }
  for (TopExp_Explorer it(result, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next())
    builder.Add(all, it.Current());
  return all;
}

NameOf iges_names(IGESControl_Reader& reader) {
  return [&reader](const TopoDS_Shape& shape) -> std::string {
    const auto entity = Handle(IGESData_IGESEntity)::DownCast(
        reader.WS()->TransferReader()->EntityFromShapeResult(shape.Located(TopLoc_Location()), -1));
    if (entity.IsNull() || !entity->HasName()) return "";
    const Handle(TCollection_HAsciiString) name = entity->NameValue();
    return name.IsNull() ? "" : std::string(name->ToCString());
  };
}

size_t count_faces(const TopoDS_Shape& shape) {
  size_t count = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) ++count;
  return count;
}

void transfer_iges(IGESControl_Reader& reader, double sewing_mm, const Placement& placement, Model& model) {
  if (reader.ReadFile(model.file.c_str()) != IFSelect_RetDone) {
    throw InputError("cad-unreadable", {model.file}, "the IGES file is damaged or cut off",
                     "copy or export it again; STEP is the better format");
  }
  const Handle(IGESData_IGESModel) file = reader.IGESModel();
  const IGESData_GlobalSection& global = file->GlobalSection();
  model.unit = global.UnitName().IsNull() ? "" : global.UnitName()->ToCString();
  model.mm_per_unit = global.UnitValue();
  if (!(model.mm_per_unit > 0.0) || model.unit.empty()) {
    throw InputError("cad-no-unit", {model.file}, "the file names no unit of length",
                     "export it again with its unit (mm, inch)");
  }
  for (int i = 1; i <= reader.NbRootsForTransfer(); ++i) {
    const Handle(Standard_Transient) root = reader.RootForTransfer(i);
    if (reader.TransferOneRoot(i)) continue;
    const auto entity = Handle(IGESData_IGESEntity)::DownCast(root);
    model.warnings.push_back(
        {"cad-not-read",
         Severity::kWarning,
         {model.file},
         fmt::format("entity {} of type {} was not read", file->StringLabel(root)->ToCString(),
                     entity.IsNull() ? 0 : entity->TypeNumber()),
         "export the part again if it belongs to it"});
  }
  const TopoDS_Shape read = reader.OneShape();
  const TopoDS_Shape shape = read.IsNull() ? read : sewn(read, sewing_mm);
  if (shape.IsNull()) {
    throw InputError("cad-empty", {model.file},
                     "the file holds no faces: points and curves alone, or nothing",
                     "export the part as a solid or as surfaces, not as a wireframe");
  }
  const size_t before = count_faces(read), after = count_faces(shape);
  if (before != after) {
    model.warnings.push_back({"cad-not-read",
                              Severity::kWarning,
                              {model.file},
                              fmt::format("{} of {} faces are left after sewing", after, before),
                              "look for faces that lie on each other"});
  }
  take_placed(shape, iges_names(reader), placement, model);
}

}  // namespace

bool is_cad_file(const std::string& path) {
  return is_step_name(path) || ends_with_any(path, {".igs", ".iges"});
}

Model read_iges(const std::string& path, double sewing_mm, const Placement& placement) {
  // Columns 73 to 80 of every line hold its section and number.
  const std::string start = check_cad_file(path);
  if (start.size() < 80 || (start[72] != 'S' && start[72] != 'C')) {
    throw InputError("cad-unreadable", {path}, "this is no IGES file: its first line is no start section",
                     "export the part as IGES 5.3 or as STEP");
  }
  Model model;
  model.file = path;
  const QuietSession session;
  guarded(path, [&] {
    IGESControl_Reader reader;
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    transfer_iges(reader, sewing_mm, placement, model);
  });
  return model;
}

Model read_cad(const std::string& path, const Placement& placement) {
  return is_step_name(path) ? read_step(path, placement) : read_iges(path, kSewing, placement);
}

}  // namespace swarf::brep

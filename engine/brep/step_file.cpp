// STEP: AP203, AP214, AP242.
#include <Interface_Check.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepGeom_GeometricRepresentationItem.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_TopologicalRepresentationItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Iterator.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <fmt/format.h>

#include <map>
#include <set>

#include "brep/occt_shape.h"

namespace swarf::brep {
namespace {

std::string text_of(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? "" : std::string(text->ToCString());
}

/// "#97 = ADVANCED_FACE 'top'".
std::string entity_text(const Handle(Interface_InterfaceModel) & model,
                        const Handle(Standard_Transient) & entity) {
  const auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity);
  const std::string name = item.IsNull() ? "" : text_of(item->Name());
  return fmt::format("{} = {}{}", model->StringLabel(entity)->ToCString(), model->TypeName(entity, false),
                     name.empty() ? "" : " '" + name + "'");
}

Handle(StepRepr_GlobalUnitAssignedContext) unit_context(const Handle(Standard_Transient) & entity) {
  if (const auto a =
          Handle(StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)::DownCast(entity))
    return a->GlobalUnitAssignedContext();
  if (const auto b =
          Handle(StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)::DownCast(entity))
    return b->GlobalUnitAssignedContext();
  return Handle(StepRepr_GlobalUnitAssignedContext)::DownCast(entity);
}

/// Unit and factor; several units are told, each context's own is multiplied in by the library.
void take_units(STEPControl_Reader& reader, Model& model) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  const Handle(StepData_StepModel) file = reader.StepModel();
  std::set<double> factors;
  for (int i = 1; i <= file->NbEntities(); ++i) {
    const Handle(StepRepr_GlobalUnitAssignedContext) context = unit_context(file->Value(i));
    if (context.IsNull()) continue;
    STEPConstruct_UnitContext units;
    units.ComputeFactors(context);
    if (units.LengthDone()) factors.insert(units.LengthFactor());
  }
  if (factors.empty() || lengths.IsEmpty()) {
    throw InputError("cad-no-unit", {model.file}, "the file names no unit of length",
                     "export it again with its unit (mm, inch)");
  }
  model.unit = lengths.First().ToCString();
  model.mm_per_unit = *factors.begin();
  if (factors.size() > 1) {
    model.warnings.push_back(
        {"cad-units",
         Severity::kWarning,
         {model.file},
         fmt::format("the file has {} units of length; each part is read in its own", factors.size()),
         ""});
  }
}

void warn_lost(const std::string& what, Model& model) {
  model.warnings.push_back({"cad-not-read",
                            Severity::kWarning,
                            {model.file},
                            what + " was not read",
                            "export the part again if it belongs to it"});
}

/// Faces of the file that have become none of the shape.
void tell_lost_faces(STEPControl_Reader& reader, const TopoDS_Shape& shape, Model& model) {
  TopTools_IndexedMapOfShape there;
  TopExp::MapShapes(shape, TopAbs_FACE, there);
  std::set<const TopoDS_TShape*> bodies;
  for (int i = 1; i <= there.Extent(); ++i) bodies.insert(there(i).TShape().get());
  const Handle(StepData_StepModel) file = reader.StepModel();
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= file->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = file->Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface))) continue;
    const TopoDS_Shape result = TransferBRep::ShapeResult(process, entity);
    bool found = false;
    if (!result.IsNull()) {
      TopTools_IndexedMapOfShape faces;
      TopExp::MapShapes(result, TopAbs_FACE, faces);
      for (int k = 1; k <= faces.Extent(); ++k) found = found || bodies.count(faces(k).TShape().get()) > 0;
    }
    if (!found) warn_lost(entity_text(file, entity), model);
  }
}

/// The name of the item that a shape was made of, wherever an instance of it stands.
NameOf names_of(STEPControl_Reader& reader, const std::map<const TopoDS_TShape*, std::string>& products) {
  return [&reader, products](const TopoDS_Shape& shape) -> std::string {
    const Handle(XSControl_TransferReader) transfer = reader.WS()->TransferReader();
    const TopoDS_Shape own = shape.Located(TopLoc_Location());
    const auto item = Handle(StepRepr_RepresentationItem)::DownCast(transfer->EntityFromShapeResult(own, -1));
    const std::string name = item.IsNull() ? "" : text_of(item->Name());
    if (!name.empty() && name != "NONE" && name != "None") return name;
    const auto product = products.find(shape.TShape().get());
    return product == products.end() ? "" : product->second;
  };
}

/// Names of products by the bodies in what they have become; the innermost product comes last.
std::map<const TopoDS_TShape*, std::string> product_names(STEPControl_Reader& reader) {
  std::map<const TopoDS_TShape*, std::pair<int, std::string>> named;
  const Handle(StepData_StepModel) file = reader.StepModel();
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= file->NbEntities(); ++i) {
    const auto definition = Handle(StepBasic_ProductDefinition)::DownCast(file->Value(i));
    if (definition.IsNull() || definition->Formation().IsNull()) continue;
    const Handle(StepBasic_Product) product = definition->Formation()->OfProduct();
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, definition);
    if (product.IsNull() || shape.IsNull()) continue;
    TopTools_IndexedMapOfShape bodies;
    TopExp::MapShapes(shape, TopAbs_SOLID, bodies);
    for (int k = 1; k <= bodies.Extent(); ++k) {
      auto& entry = named[bodies(k).TShape().get()];
      if (entry.second.empty() || bodies.Extent() < entry.first)
        entry = {bodies.Extent(), text_of(product->Name())};
    }
  }
  std::map<const TopoDS_TShape*, std::string> names;
  for (const auto& [body, entry] : named) names[body] = entry.second;
  return names;
}

void refuse_other_format(const std::string& path, const std::string& start) {
  if (start.find("ISO-10303-21") != std::string::npos) return;
  throw InputError("cad-unreadable", {path}, "this is no STEP file: it does not begin with ISO-10303-21",
                   "export the part as STEP AP203, AP214 or AP242");
}

/// The library goes on with what is left of an entity that lacks something, and does not look whether it is
/// there.
void refuse_damaged_geometry(const Handle(StepData_StepModel) & file, const std::string& path) {
  for (int i = 1; i <= file->NbEntities(); ++i) {
    const Handle(Interface_Check) found = file->Check(i, true);
    if (found.IsNull() || !found->HasFailed()) continue;
    const Handle(Standard_Transient) entity = file->Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepGeom_GeometricRepresentationItem)) &&
        !entity->IsKind(STANDARD_TYPE(StepShape_TopologicalRepresentationItem)))
      continue;
    throw InputError("cad-unreadable", {path},
                     fmt::format("{}: {}", entity_text(file, entity), found->CFail(1)),
                     "export the part again");
  }
}

void transfer(STEPControl_Reader& reader, const QuietSession& session, const Placement& placement,
              Model& model) {
  if (reader.ReadFile(model.file.c_str()) != IFSelect_RetDone) {
    const std::string said = session.said();
    throw InputError("cad-unreadable", {model.file},
                     "the STEP file is damaged or cut off" + (said.empty() ? "" : ": " + said),
                     "copy or export it again");
  }
  refuse_damaged_geometry(reader.StepModel(), model.file);
  const int roots = reader.NbRootsForTransfer();
  if (roots == 0) {
    throw InputError("cad-empty", {model.file}, "the STEP file holds no product with a shape",
                     "export the part as a solid");
  }
  take_units(reader, model);
  for (int i = 1; i <= roots; ++i) {
    const Handle(Standard_Transient) root = reader.RootForTransfer(i);
    if (!reader.TransferRoot(i)) warn_lost(entity_text(reader.StepModel(), root), model);
  }
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull()) {
    throw InputError("cad-empty", {model.file},
                     "the file holds no faces: points and curves alone, or nothing",
                     "export the part as a solid or as surfaces, not as a wireframe");
  }
  take_placed(shape, names_of(reader, product_names(reader)), placement, model);
  tell_lost_faces(reader, shape, model);
}

}  // namespace

Model read_step(const std::string& path, const Placement& placement) {
  refuse_other_format(path, check_cad_file(path));
  Model model;
  model.file = path;
  const QuietSession session;
  guarded(path, [&] {
    STEPControl_Reader reader;
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    transfer(reader, session, placement, model);
  });
  return model;
}

}  // namespace swarf::brep

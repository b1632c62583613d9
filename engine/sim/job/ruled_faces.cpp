#include "sim/job/ruled_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "brep/model.h"
#include "surface/ruled_face.h"

namespace swarf::sim {
namespace {

using surface::RulingDirection;

std::string bound_text(double mm) {
  return std::isfinite(mm) ? fmt::format("by at most {:.4g} um", um_from_mm(mm))
                           : std::string("by what its weights do not let be bounded");
}

/// The direction in which the net proves it; none: said.
std::optional<RulingDirection> ruling_of(const RuledFace& asked, const surface::NurbsSurface& nurbs,
                                         Diagnostics& diagnostics) {
  const double v = surface::ruled_departure_bound(nurbs, RulingDirection::kV),
               u = surface::ruled_departure_bound(nurbs, RulingDirection::kU);
  const bool both = std::max(u, v) <= surface::kRuledWithin;
  // A plane is ruled both ways: along v unless the scene says so.
  if (both && asked.along_u) return RulingDirection::kU;
  if (v <= surface::kRuledWithin) return RulingDirection::kV;
  if (u <= surface::kRuledWithin) return RulingDirection::kU;
  const RulingDirection nearer = u < v ? RulingDirection::kU : RulingDirection::kV;
  diagnostics.error(
      "face-not-ruled", asked.where,
      fmt::format("face {} is not ruled: from the lines between its edges it departs {}, and by "
                  "{:.4g} um at a place that was looked at",
                  asked.number, bound_text(std::min(u, v)),
                  um_from_mm(surface::ruled_departure_seen(nurbs, nearer))),
      "a face between two curves with straight rulings; other faces are milled by the end of the tool");
  return std::nullopt;
}

void add_part(const RuledFace& asked, const surface::Face& face, std::vector<surface::SurfacePtr>& surfaces,
              Diagnostics& diagnostics) {
  const auto* nurbs = dynamic_cast<const surface::NurbsSurface*>(face.surface.get());
  if (nurbs == nullptr) return;
  const std::optional<RulingDirection> direction = ruling_of(asked, *nurbs, diagnostics);
  if (!direction) return;
  const auto rectangle = surface::rectangle_of(face);
  if (!rectangle) {
    diagnostics.error(
        "face-trimmed", asked.where,
        fmt::format("face {} is ruled, but its edges are no rectangle of its parameters", asked.number),
        "a face that two rulings and two guide curves bound, without holes");
    return;
  }
  surfaces.push_back(
      surface::ruled_between({face.surface, *direction, (*rectangle)[0], (*rectangle)[1], asked.exchanged}));
}

}  // namespace

void read_ruled_faces(ConfigTable& table, DesignSettings& design) {
  design.kind = DesignKind::kRuledFaces;
  design.mesh_key = "step";
  design.mesh_file = table.text("step");
  design.placement = read_placement(table);
  constexpr int kMostFaces = 1000000;
  for (ConfigTable& face : table.tables("face")) {
    RuledFace one;
    one.number = face.integer("number", 1, kMostFaces);
    one.exchanged = face.boolean("exchanged", false);
    one.along_u = face.boolean("along_u", false);
    one.where = face.where("number");
    design.faces.push_back(one);
  }
  if (design.faces.empty())
    table.error("missing-key", "step", "no face of the file is named", "[[design.face]] with its number");
}

std::vector<surface::SurfacePtr> load_ruled_faces(const DesignSettings& design, Diagnostics& diagnostics) {
  const brep::Model model = brep::read_cad(design.mesh_file, design.placement);
  for (const Diagnostic& warning : model.warnings)
    diagnostics.warning(warning.code, warning.where, warning.text, warning.fix);
  std::vector<surface::SurfacePtr> surfaces;
  for (const RuledFace& asked : design.faces) {
    const auto is_asked = [&](const surface::Face& face) { return face.number == asked.number; };
    if (std::none_of(model.faces.begin(), model.faces.end(), is_asked))
      diagnostics.error("cad-no-face", asked.where,
                        fmt::format("{} has no face {}", design.mesh_file, asked.number),
                        fmt::format("its faces have the numbers 1 to {}", model.face_count));
    for (const surface::Face& face : model.faces)
      if (is_asked(face)) add_part(asked, face, surfaces, diagnostics);
  }
  return surfaces;
}

}  // namespace swarf::sim

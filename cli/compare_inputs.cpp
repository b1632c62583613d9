#include "cli/compare_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "base/angles.h"
#include "base/check.h"
#include "brep/model.h"
#include "brep/refine_facets.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_crossing.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_nesting.h"
#include "mesh/mesh_ops.h"
#include "mesh/scene_reader.h"
#include "stock/rays/ray_field.h"
#include "stock/stock.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

/// A grid cuts the tip off an edge that turns by t: by this times voxel times tan(t / 2) along the diagonal
/// of a voxel (measure::cross_check has the same bound).
constexpr double kTipShare = 0.8660254037844386;
/// Edges that turn by more are sharp: there the grid's error is not a small one; rad (30 deg).
constexpr double kSharp = 0.5235987755982988;
/// Facets of parametric surfaces stay this close to them, mm, unless that takes more than kMostFacets.
constexpr double kChord = 5e-5;
constexpr size_t kMostFacets = 3'000'000;
/// Of CAD files, mm: so close the library keeps facets and edges that are divided further, so close they are
/// divided, to so many; and so close it keeps those that cannot be divided.
constexpr double kBaseChord = 0.05, kBaseEdge = 0.02, kCadChord = 5e-3;
constexpr std::array kFineChords{3e-4, 1e-3, 2e-3, 4e-3};
constexpr size_t kFineFacets = 500'000;
/// Half a unit in the last place of a float, relative.
constexpr double kFloatRounding = 6e-8;

std::string extension(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::shared_ptr<const mesh::SignedDistance> checked_mesh(const TriMesh& mesh, const std::string& file,
                                                         const std::string& name) {
  Diagnostics diagnostics;
  mesh::check_design_mesh(mesh, file, nullptr, diagnostics, name);
  diagnostics.throw_if_errors();
  auto distance = std::make_shared<mesh::SignedDistance>(mesh);
  const mesh::Crossings crossings = mesh::find_crossings(*distance);
  if (crossings.pairs > 0) {
    throw InputError(
        "mesh-self-crossing", {file},
        fmt::format("the {} crosses itself: {} pairs of facets run through or over each other, the first at "
                    "({:.3f}, {:.3f}, {:.3f}) mm",
                    name, crossings.pairs, crossings.place.x(), crossings.place.y(), crossings.place.z()),
        "unite the bodies in the CAD or repair program and export again: what lies inside is not clear");
  }
  mesh::check_bodies(mesh, file, diagnostics, name);
  diagnostics.throw_if_errors();
  return distance;
}

/// Per vertex of the welded mesh the greatest angle between its normals, and those of its facets' other
/// corners: what the surface turns by within a voxel.
std::vector<double> turns_of(const TriMesh& mesh, const std::vector<uint32_t>& numbers, size_t count) {
  std::vector<double> turns(count, 0.0);
  const auto normal = [&](uint32_t v) {
    return Vec3(mesh.normals[v][0], mesh.normals[v][1], mesh.normals[v][2]).normalized();
  };
  for (const auto& t : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      const Vec3 a = normal(t[i]), b = normal(t[(i + 1) % 3]);
      const double turn = angle_between(a, b);
      for (const uint32_t v : {t[i], t[(i + 1) % 3]}) turns[numbers[v]] = std::max(turns[numbers[v]], turn);
    }
  }
  return turns;
}

ComparedStock stock_of_grid(const std::string& file) {
  const stock::Stock stock = stock::Stock::load(file);
  const TriMesh mesh = stock.mesh();
  ComparedStock compared;
  compared.voxel_mm = stock.voxel_mm();
  // At sharp rims the mesh folds over itself, by what is also granted to edges that the grid rounds.
  compared.mesh = std::make_shared<mesh::SignedDistance>(mesh, compared.voxel_mm);
  const size_t count = compared.mesh->mesh().positions.size();
  for (const double turn : turns_of(mesh, mesh::position_numbers(mesh.positions), count)) {
    const bool sharp = turn > kSharp;
    compared.edge.push_back(sharp ? 1 : 0);
    compared.error.push_back(sharp ? 0.0 : kTipShare * stock.voxel_mm() * std::tan(0.5 * turn));
  }
  return compared;
}

/// The patches as one mesh, with facets that stay as close as can be afforded.
ComparedDesign design_of_patches(const std::vector<surface::SurfacePtr>& surfaces, double pitch_mm) {
  for (double chord = kChord;; chord *= 4.0) {
    TriMesh mesh;
    double largest = 0.0;
    for (const surface::SurfacePtr& surface : surfaces) {
      const stock::RayFieldPtr field = stock::rays_on_surface(surface, pitch_mm, chord);
      const auto first = static_cast<uint32_t>(mesh.positions.size());
      for (const Vec3& p : field->points) {
        largest = std::max(largest, p.cwiseAbs().maxCoeff());
        mesh.positions.push_back(
            {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
      }
      for (const auto& t : field->triangles)
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    if (mesh.triangles.size() > kMostFacets) continue;
    // A facet's middle is off by the chords along u and v together; its corners are rounded to floats.
    ComparedDesign design;
    design.mesh = std::make_shared<mesh::SignedDistance>(mesh);
    design.open = true;
    design.error_mm = 2.0 * chord + 2.0 * kFloatRounding * largest;
    return design;
  }
}

/// Of the facets that a distance has kept: with equal positions as one, those without area are left out.
std::vector<double> kept_facets_of(const TriMesh& mesh, const std::vector<double>& strays,
                                   const mesh::SignedDistance& distance) {
  const mesh::WeldedMesh welded = mesh::weld(mesh);
  std::vector<double> kept;
  for (size_t t = 0; t < welded.triangles.size(); ++t) {
    const auto& [a, b, c] = welded.triangles[t];
    const Vec3 &p = welded.points[a], &q = welded.points[b], &r = welded.points[c];
    if ((q - p).cross(r - p).squaredNorm() > 0.0) kept.push_back(strays[welded.sources[t]]);
  }
  SWARF_CHECK(kept.size() == distance.mesh().triangles.size(), "errors of the facets of a distance");
  return kept;
}

/// Closed facets of a mesh file, which are the design.
ComparedDesign design_of_mesh(const TriMesh& mesh, const std::string& file, const std::string& name) {
  ComparedDesign design;
  design.mesh = checked_mesh(mesh, file, name);
  return design;
}

/// Facets of a CAD file as fine as can be, else as they are: samples are measured from the faces over them.
ComparedDesign design_of_cad(const brep::FineFacets& fine, const brep::Facets& facets,
                             const std::string& file) {
  if (fine.mesh.triangles.empty()) {
    ComparedDesign design = design_of_mesh(facets.mesh, file, "design");
    design.error_mm = std::max(facets.chord_mm, facets.under->edge_mm);
    design.faces = std::make_shared<stock::DesignMesh>(facets.mesh, facets.under);
    return design;
  }
  ComparedDesign design = design_of_mesh(fine.mesh, file, "design");
  design.errors = kept_facets_of(fine.mesh, fine.chords_mm, *design.mesh);
  design.error_mm = *std::max_element(design.errors.begin(), design.errors.end());
  return design;
}

brep::FineFacets finest(const brep::Facets& facets) {
  return brep::finest_facets(facets, kFineChords, kFineFacets);
}

/// The closed solids of a CAD file.
ComparedDesign design_of_cad(const std::string& file) {
  const brep::Model model = brep::read_cad(file);
  const brep::Facets coarse = brep::tessellate(model, kBaseChord, true, kBaseEdge);
  const brep::FineFacets fine = finest(coarse);
  if (!fine.mesh.triangles.empty()) return design_of_cad(fine, coarse, file);
  const brep::Facets facets = brep::tessellate(model, kCadChord, true);
  return design_of_cad(finest(facets), facets, file);
}

/// The design of a scene, which stands where the scene puts it.
ComparedDesign design_of_job(const sim::Job& job) {
  const std::string& file = job.scene.design.mesh_file;
  if (job.design_under == nullptr) return design_of_mesh(*job.design_mesh, file, "design mesh");
  brep::Facets facets;
  facets.mesh = *job.design_mesh;
  facets.under = job.design_under;
  facets.chord_mm = job.design_under->chord_mm;
  return design_of_cad(finest(facets), facets, file);
}

/// Files of CAD programs, which the reader of programs would otherwise take for blocks.
void refuse_cad(const std::string& file) {
  const std::string ending = extension(file);
  constexpr std::array kCad{".step", ".stp", ".igs", ".iges", ".sldprt", ".prt", ".x_t", ".brep"};
  if (std::none_of(kCad.begin(), kCad.end(), [&](const char* cad) { return ending == cad; })) return;
  throw InputError("cad-format", {file},
                   fmt::format("files of the kind '{}' are not read as a stock or a mesh", ending),
                   "export it from the CAD program as STL, PLY or OBJ, in mm");
}

[[noreturn]] void refuse_empty(const std::string& file) {
  throw InputError("no-design", {file}, "there is no design surface to compare with",
                   "name a scene with a [design], a program of surface blocks or a mesh");
}

}  // namespace

ComparedStock load_stock(const std::string& file) {
  refuse_cad(file);
  if (extension(file) == ".vdb") return stock_of_grid(file);
  ComparedStock compared;
  compared.mesh = checked_mesh(mesh::load_mesh(file), file, "stock mesh");
  return compared;
}

ComparedDesign load_design(const std::string& file, double pitch_mm) {
  if (brep::is_cad_file(file)) return design_of_cad(file);
  refuse_cad(file);
  if (extension(file) == ".vdb") {
    ComparedDesign earlier;
    const ComparedStock stock = stock_of_grid(file);
    earlier.mesh = stock.mesh;
    earlier.grid = true;
    earlier.voxel_mm = stock.voxel_mm;
    earlier.grid_error_mm = stock.greatest_error_mm();
    return earlier;
  }
  const std::string kind = extension(file);
  if (kind == ".stl" || kind == ".ply" || kind == ".obj" || mesh::is_scene_ending(kind))
    return design_of_mesh(mesh::load_mesh(file), file, "design mesh");
  if (kind == ".toml") {
    const sim::Job job = sim::load_job(file, {});
    if (!job.has_design()) refuse_empty(file);
    ComparedDesign design =
        job.design_mesh != nullptr ? design_of_job(job) : design_of_patches(job.design, pitch_mm);
    design.accept = job.scene.accept;
    return design;
  }
  std::vector<surface::SurfacePtr> surfaces;
  for (const program::SurfaceDefinition& definition : program::load_surfaces(file))
    surfaces.push_back(definition.surface);
  if (surfaces.empty()) refuse_empty(file);
  return design_of_patches(surfaces, pitch_mm);
}

namespace {

struct Unit {
  double factor;  ///< the stock is so many times larger
  const char* code;
  const char* text;
};
constexpr std::array<Unit, 6> kUnits{{{25.4, "looks-like-inches", "the design looks like inches"},
                                      {1.0 / 25.4, "looks-like-inches", "the stock looks like inches"},
                                      {1000.0, "looks-like-metres", "the design looks like metres"},
                                      {1e-3, "looks-like-metres", "the stock looks like metres"},
                                      {10.0, "looks-like-centimetres", "the design looks like centimetres"},
                                      {0.1, "looks-like-centimetres", "the stock looks like centimetres"}}};
/// Sizes that agree to this share after a change of unit are no accident.
constexpr double kUnitSlack = 0.05;
/// A design that fills this share of the stock's diagonal after the change, and lies inside, is none either.
constexpr double kUnitShare = 0.3;

std::string size_text(const Vec3& size) {
  return fmt::format("{:.4g} x {:.4g} x {:.4g} mm", size.x(), size.y(), size.z());
}

/// Largest sizes first: a patch may be flat in any direction, and a stock may be higher than its design.
bool same_size(const Vec3& a, const Vec3& b) {
  std::array<double, 3> x{a.x(), a.y(), a.z()}, y{b.x(), b.y(), b.z()};
  std::sort(x.rbegin(), x.rend());
  std::sort(y.rbegin(), y.rend());
  for (size_t i = 0; i < 2; ++i) {
    if (std::abs(x[i] - y[i]) > kUnitSlack * y[i]) return false;
  }
  return true;
}

bool lies_inside(const Box& inner, const Box& outer) {
  const double slack = kUnitSlack * outer.size().norm();
  return (inner.lower - outer.lower).minCoeff() >= -slack && (outer.upper - inner.upper).minCoeff() >= -slack;
}

bool is_other_unit(double factor, const Box& stock, const Box& design) {
  if (same_size(factor * design.size(), stock.size())) return true;
  const Box scaled{factor * design.lower, factor * design.upper};
  return lies_inside(scaled, stock) && scaled.size().norm() > kUnitShare * stock.size().norm() &&
         !lies_inside(design, stock) == (factor < 1.0);
}

}  // namespace

void check_boxes(const ComparedStock& stock, const ComparedDesign& design, const std::string& stock_file,
                 const std::string& design_file) {
  const Box s = mesh::bounds(stock.mesh->mesh()), d = mesh::bounds(design.mesh->mesh());
  const std::string sizes =
      fmt::format("the stock measures {} and the design {}", size_text(s.size()), size_text(d.size()));
  for (const Unit& unit : kUnits) {
    if (!is_other_unit(unit.factor, s, d)) continue;
    throw InputError(unit.code, {unit.factor > 1.0 ? design_file : stock_file},
                     fmt::format("{}: {}, a factor of {:g}", unit.text, sizes,
                                 unit.factor > 1.0 ? unit.factor : 1.0 / unit.factor),
                     "export both in mm");
  }
  const Vec3 gap = (s.lower - d.upper).cwiseMax(d.lower - s.upper);
  if (gap.maxCoeff() <= 0.0) return;
  throw InputError("boxes-apart", {design_file},
                   fmt::format("stock and design do not meet: their boxes are {:.4g} mm apart; {}",
                               gap.cwiseMax(0.0).norm(), sizes),
                   "give both in the work frame and in mm");
}

}  // namespace swarf::cli

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "base/units.h"
#include "brep/model.h"
#include "brep/refine_facets.h"
#include "cutter/profile.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_nesting.h"
#include "mesh/mesh_ops.h"
#include "mesh/mesh_slivers.h"
#include "position/part_check.h"
#include "position/patch_joints.h"
#include "sim/job/clamping_check.h"
#include "sim/job/design_place.h"
#include "sim/job/driven_part.h"
#include "sim/job/fixture_keys.h"
#include "sim/job/flank_clearance.h"
#include "sim/job/flank_job.h"
#include "sim/job/kept_job.h"
#include "sim/job/memory_limit.h"
#include "sim/job/mesh_unit.h"
#include "sim/job/open_job.h"
#include "sim/job/ruled_faces.h"
#include "sim/job/scene.h"
#include "sim/job/set_ups.h"
#include "sim/job/tool_table.h"
#include "stock/stock.h"

namespace swarf::sim {
namespace {

constexpr double kBytesPerMb = 1024.0 * 1024.0;
/// As for boxes and meshes: a kilometre from the origin of the work, mm.
constexpr double kFarthestStock = 1e6;

/// Upwards to two digits.
double two_digits(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::ceil(value / digit) * digit;
}

/// The smallest voxel, to two digits, whose estimate fits.
double voxel_of_raw_that_fits(const stock::RawShape& raw, double voxel, double limit_mb) {
  constexpr double kFinest = 1e-6;  // of the box: no memory holds more
  const double longest = raw.box().size().maxCoeff();
  double fitting = std::max(voxel, kFinest * longest);
  while (fitting<longest&& static_cast<double>(stock::Stock::memory_estimate(raw, fitting)) / kBytesPerMb>
             limit_mb)
    fitting *= 1.05;
  return two_digits(fitting);
}

/// What a box of voxels alone needs is known without a path: a wrong digit is refused at once.
void check_voxels(const Scene& scene, const char* key, double voxel, Diagnostics& diagnostics) {
  const double limit = memory_limit_mb(scene);
  const double need =
      static_cast<double>(stock::Stock::memory_estimate(scene.stock.body_W(), voxel)) / kBytesPerMb;
  // Before the path is known only the block can be counted; what lies between is for require_memory.
  constexpr double kBeyondDoubt = 2.0, kShareOfBlock = 1.0 / 6.0;
  if (need <= kBeyondDoubt * limit) return;
  diagnostics.error(
      "out-of-memory", {scene.file},
      fmt::format("{} = {:g} needs about {:.0f} MB, {:.0f} MB may be used", key, voxel, need, limit),
      fmt::format("voxel_mm = {:g} fits; or raise --max-memory",
                  voxel_of_raw_that_fits(scene.stock.body_W(), voxel, kShareOfBlock * limit)));
}

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

/// mm2; of surfaces from below, by chords.
double design_area(const Job& job) {
  constexpr int kParts = 16;
  double area = 0.0;
  if (job.design_mesh) {
    const auto corner = [&](uint32_t v) {
      const auto& p = job.design_mesh->positions[v];
      return Vec3(p[0], p[1], p[2]);
    };
    for (const auto& t : job.design_mesh->triangles)
      area += triangle_area(corner(t[0]), corner(t[1]), corner(t[2]));
  }
  for (const surface::SurfacePtr& surface : job.design) {
    const auto at = [&](int i, int k) { return surface->point(double(i) / kParts, double(k) / kParts); };
    for (int i = 0; i < kParts * kParts; ++i) {
      const int u = i / kParts, v = i % kParts;
      area += triangle_area(at(u, v), at(u + 1, v), at(u, v + 1)) +
              triangle_area(at(u + 1, v), at(u + 1, v + 1), at(u, v + 1));
    }
  }
  return area;
}

/// One measuring ray stands for a square of the pitch at the most: a wrong digit is refused before any is
/// made.
void check_rays(const Job& job, Diagnostics& diagnostics) {
  constexpr double kRayBytes = 80.0;
  const double limit = memory_limit_mb(job.scene), area = design_area(job), pitch = job.scene.design.pitch_mm;
  const double need = kRayBytes * area / pitch / pitch / kBytesPerMb;
  if (need <= limit) return;
  diagnostics.error(
      "out-of-memory", {job.scene.file},
      fmt::format(
          "design.pitch_mm = {:g} needs about {:.0f} MB for the measuring rays of {:.0f} mm2, {:.0f} MB "
          "may be used",
          pitch, need, area, limit),
      fmt::format("pitch_mm = {:g} fits",
                  two_digits(std::sqrt(4.0 * kRayBytes * area / (limit * kBytesPerMb)))));
}

void check_memory(const Job& job, Diagnostics& diagnostics) {
  check_voxels(job.scene, "stock.voxel_mm", job.scene.stock.voxel_mm, diagnostics);
  if (job.scene.movie.seconds > 0.0)
    check_voxels(job.scene, "movie.voxel_mm", job.scene.movie.voxel_mm, diagnostics);
  check_rays(job, diagnostics);
}

void check_tools(const Job& job, Diagnostics& diagnostics) {
  const cutter::Cutter& ours = job.scene.tools.front();
  for (const program::Operation& operation : job.program.operations) {
    if (operation.tool == ours.number) continue;
    diagnostics.error("unknown-tool", operation.where,
                      fmt::format("the block uses T{}, the scene describes {} only", operation.tool,
                                  cutter::call_name(ours)),
                      fmt::format("call T{} or set cutter.number = {}", ours.number, operation.tool));
    return;
  }
}

/// One parameter of CUTTER against the scene's cutter; what is not given contradicts nothing.
void check_parameter(const program::ClCutter& cutter, size_t index, const char* name, double ours,
                     const char* key, Diagnostics& diagnostics) {
  constexpr double kSame = 1e-3;  // CAM systems write three or four digits
  if (index >= cutter.parameters.size() || std::abs(cutter.parameters[index] - ours) <= kSame) return;
  diagnostics.error(
      "cutter-contradiction", cutter.where,
      fmt::format("CUTTER says {} = {:g}, the scene has {:g}", name, cutter.parameters[index], ours),
      fmt::format("set {} in the scene, or mend the CL file", key));
}

/// CUTTER of a CL file against the scene's cutter.
void check_cl_cutter(const program::ClCutter& cutter, const cutter::Cutter& ours, Diagnostics& diagnostics) {
  const std::optional<cutter::AptForm> form = cutter::apt_form(ours);
  check_parameter(cutter, 0, "d (mm)", form ? form->d : ours.diameter_mm, "cutter.diameter_mm", diagnostics);
  if (!form) return;  // seven parameters cannot say what the others are
  check_parameter(cutter, 1, "r (mm)", form->r, "cutter.corner_radius_mm", diagnostics);
  check_parameter(cutter, 4, "alpha (deg)", deg_from_rad(form->alpha), "the shape", diagnostics);
  check_parameter(cutter, 5, "beta (deg)", deg_from_rad(form->beta), "the shape", diagnostics);
}

/// The tools that a CL file loads, and its CUTTERs, against the scene's tools.
void check_cl_tools(const Job& job, Diagnostics& diagnostics) {
  const std::vector<int> tools = cl_tools(job);
  const std::string ours = list_tools(job.scene.tools);
  for (size_t i = 0; i < tools.size(); ++i) {
    if (tools[i] >= 0) continue;
    const program::ClTool& tool = job.cl->tools[i];
    const std::string called = tool.number != 0 ? fmt::format("tool {}", tool.number) : "tool " + tool.name;
    diagnostics.error("unknown-tool", tool.where,
                      fmt::format("the program loads {}, the scene describes {} only", called, ours),
                      "load one of them, or describe it in the scene: [[tool]], cutter.number");
  }
  for (const program::Move& move : job.cl->moves) {
    if (move.tool >= 0 || job.scene.tools.size() == 1) continue;
    diagnostics.error("tool-not-loaded", {job.cl->file, move.line, move.column},
                      fmt::format("no tool is loaded for this move, the scene describes {}", ours),
                      "write LOADTL before it");
    break;
  }
  for (const program::ClCutter& cutter : job.cl->cutters) {
    if (cutter.tool < 0 && job.scene.tools.size() > 1) continue;  // nobody can say whose it is
    const int index = cutter.tool < 0 ? 0 : tools[static_cast<size_t>(cutter.tool)];
    if (index >= 0) check_cl_cutter(cutter, job.scene.tools[static_cast<size_t>(index)], diagnostics);
  }
}

/// The stock that stock.from_run means; a folder is named by its stock.vdb as well. `raw.file` is the folder
/// then.
std::string stock_of_run(RawSettings& raw) {
  namespace fs = std::filesystem;
  constexpr const char* kFinished = "stock.vdb";
  const fs::path named(raw.file);
  if (named.extension() != ".vdb") return (named / kFinished).string();
  if (named.filename() != kFinished)
    throw InputError("from-run-unfinished", raw.where,
                     fmt::format("'{}' is a stock in the middle of its run", named.filename().string()),
                     "name the folder of the run: its program is cut to the end");
  raw.file = named.has_parent_path() ? named.parent_path().string() : ".";
  return raw.file + "/" + kFinished;
}

/// The body of the raw stock; a box has been read with the scene.
void load_stock(Job& job, Diagnostics& diagnostics) {
  StockSettings& stock = job.scene.stock;
  if (stock.raw.kind == RawKind::kBox) return;
  if (stock.raw.kind == RawKind::kRun) {
    const std::string file = stock_of_run(stock.raw);
    job.earlier =
        setups_up_to(std::make_shared<const Job>(load_kept_job(stock.raw.file, {})), stock.raw.X_WF, file);
  }
  double tool_mm = 0.0;
  for (const cutter::Cutter& tool : job.scene.tools) tool_mm = std::max(tool_mm, tool.diameter_mm);
  stock.shape = job.earlier.empty()
                    ? load_raw(stock.raw, tool_mm, diagnostics)
                    : job.earlier.back().job->scene.stock.body_W().moved(job.earlier.back().X_WE);
  if (!stock.shape) return;
  stock.box_W = stock.shape->box();
  job.scene.toolpath.stock_top_mm = stock.box_W.upper.z();
  if (stock.box_W.lower.cwiseAbs().cwiseMax(stock.box_W.upper.cwiseAbs()).maxCoeff() > kFarthestStock) {
    diagnostics.error("out-of-range", stock.raw.where,
                      "the stock reaches too far from the origin of the work",
                      fmt::format("every place of it must be within {:g} mm", kFarthestStock));
  }
  if (!stock.auto_voxel && !diagnostics.has_errors()) check_voxel(stock, job.scene.tools, diagnostics);
}

/// Walls that the level set cannot hold are told.
void check_walls(const Job& job, Diagnostics& diagnostics) {
  const StockSettings& stock = job.scene.stock;
  if (!stock.shape) return;
  const stock::ThinnestWall wall = stock.shape->thinnest_wall(stock.voxel_mm);
  if (wall.mm >= stock.voxel_mm) return;
  const Vec3& p = wall.place_W;
  diagnostics.warning(
      "stock-wall-thin", stock.raw.where,
      fmt::format(
          "the raw stock has a wall of {:.3g} mm at ({:.3f}, {:.3f}, {:.3f}) mm, thinner than a voxel "
          "of {:g} mm: the level set loses it in parts (looked for from places {:.3g} mm apart)",
          wall.mm, p.x(), p.y(), p.z(), stock.voxel_mm, wall.step_mm),
      fmt::format("stock.voxel_mm = {:.2g} holds it; measuring rays and proofs know the wall as it is",
                  wall.mm));
}

std::vector<surface::Face> faces_of_bodies(const brep::Model& model) {
  std::vector<surface::Face> faces;
  for (const brep::Solid& solid : model.solids) {
    if (!solid.closed) continue;
    for (const size_t i : solid.faces) faces.push_back(model.faces[i]);
  }
  return faces;
}

/// How closely facets follow the edges of a CAD file: a quarter of what a gouge may be deep is left to them.
double edge_chord(const AcceptLimits& accept) {
  constexpr double kShare = 0.25, kLeast = 2e-5;  // mm: facets are told by floats
  if (!accept.gouge_max_um) return brep::kEdgeChord;
  return std::clamp(kShare * *accept.gouge_max_um * kMicrometre, kLeast, brep::kEdgeChord);
}

/// Facets of a CAD file for its proofs, a fifth of each limit from the faces. None of free-form parts that
/// would need too many of them: those are proven on their faces.
void add_proof_facets(const brep::Model& model, const brep::Facets& facets, Job& job) {
  constexpr double kShare = 0.2, kFinest = 2e-5, kCoarsest = 1e-3;
  constexpr double kBaseChord = 0.05, kBaseEdge = 0.02;  // mm: of facets that are refined
  const AcceptLimits& accept = job.scene.accept;
  const auto chord_of = [=](double limit_um) {
    return std::clamp(kShare * limit_um * kMicrometre, kFinest, kCoarsest);
  };
  const double gouge = chord_of(accept.gouge_max_um.value_or(kGougeAllowed)),
               excess =
                   chord_of(accept.excess_max_um.value_or(accept.scallop_max_um.value_or(kExcessAllowed)));
  const brep::Facets coarse = brep::tessellate(model, kBaseChord, true, kBaseEdge);
  const auto finer = [&](double chord, size_t most) -> ProofFacets {
    brep::FineFacets fine = brep::refine_facets(coarse, chord, most);
    if (fine.mesh.triangles.empty()) fine = brep::refine_facets(facets, chord, most);
    if (fine.mesh.triangles.empty()) return {};
    return {std::make_shared<TriMesh>(std::move(fine.mesh)), fine.chord_mm};
  };
  // Sweeps are looked up in a tree of facets; leftover material is looked for over each of them.
  constexpr size_t kMostForSweeps = 1'000'000, kMostForRegions = 200'000;
  constexpr double kAlike = 1.5;
  job.proof_outside = finer(excess, kMostForRegions);
  if (job.proof_outside.mesh == nullptr) return;
  job.proof =
      excess < kAlike * gouge && gouge < kAlike * excess ? job.proof_outside : finer(gouge, kMostForSweeps);
}

/// Faces of a part that drives which do not meet: where the widest gap is, and how far the tool sinks into
/// it.
void tell_gaps(const brep::Model& model, const Scene& scene, Diagnostics& diagnostics) {
  const auto widest =
      std::max_element(model.edges.begin(), model.edges.end(),
                       [](const brep::Edge& a, const brep::Edge& b) { return a.gap_mm < b.gap_mm; });
  if (widest == model.edges.end() || widest->gap_mm <= position::kJoined_mm) return;
  const position::ToolProfile profile(scene.tools.front());
  const double sink = position::sinks_into(profile, widest->gap_mm);
  const Vec3& p = widest->gap_at;
  const std::string text = fmt::format(
      "two faces that share an edge lie {:.4g} mm apart at ({:.3f}, {:.3f}, {:.3f}) mm: ", widest->gap_mm,
      p.x(), p.y(), p.z());
  const char* fix = "join the faces in the CAD program (\"sew\") and export again, or take a wider cutter";
  if (!std::isfinite(sink))
    diagnostics.error("part-gap-wide", {model.file}, text + "the cutter falls through", fix);
  else if (sink > scene.driven->plan.chord_tolerance_mm)
    diagnostics.error("part-gap-wide", {model.file},
                      text + fmt::format("the tip sinks into it by up to {:.3g} um", um_from_mm(sink)), fix);
  else
    diagnostics.warning(
        "part-gap", {model.file},
        text + fmt::format("the cutter rides over it (it sinks by {:.2g} um at most)", um_from_mm(sink)),
        fix);
}

/// The closed bodies of the design's CAD file; what they are and how near the facets lie is told. The faces
/// under the facets go to the job, and those that drive it.
TriMesh cad_facets(Job& job, bool drives, Diagnostics& diagnostics) {
  const DesignSettings& design = job.scene.design;
  const SourceLocation where{design.mesh_file};
  const brep::Model model = brep::read_cad(design.mesh_file, design.placement);
  for (const Diagnostic& warning : model.warnings)
    diagnostics.warning(warning.code, warning.where, warning.text, warning.fix);
  size_t open = model.faces.size();
  for (const brep::Solid& solid : model.solids) open -= solid.closed ? solid.faces.size() : 0;
  if (open > 0) {
    const std::string text = fmt::format("{} of {} faces bound no closed body", open, model.faces.size());
    if (open == model.faces.size())
      throw InputError("cad-open", where, text,
                       "export the part as a solid; single patches: design.kind = \"nurbs\"");
    diagnostics.warning("cad-open", where, text + ": they are not measured", "export the part as solids");
  }
  // Cells follow the edges of curved faces wherever it matters; planes end on what their facets say.
  brep::Facets facets = brep::tessellate(model, design.chord_mm, true);
  if (facets.mesh.triangles.empty())
    throw InputError("cad-open", where, fmt::format("{} faces are sheets of no solid body", model.face_count),
                     "export the part as a solid");
  add_proof_facets(model, facets, job);
  const double edge_mm = edge_chord(job.scene.accept);
  if (job.proof.mesh == nullptr && facets.under->edge_mm > edge_mm)
    facets = brep::tessellate(model, design.chord_mm, true, edge_mm);
  diagnostics.note(
      "cad-read", where,
      fmt::format("{} bodies, {} faces; unit {} = {:g} mm; measured on the faces themselves, "
                  "their edges and what lies "
                  "beside them on {} facets, from which no face strays by more than {:.3g} um{}; edges "
                  "within {:.2g} um",
                  model.solids.size(), model.face_count, model.unit, model.mm_per_unit,
                  facets.mesh.triangles.size(), um_from_mm(facets.strays_mm),
                  facets.proven ? " (proven)" : " (proven but for faces with a crease inside)",
                  um_from_mm(facets.under->edge_mm)));
  if (facets.across_creases > 0)
    diagnostics.warning("cad-crease", where,
                        fmt::format("{} facets lie across a crease inside their face: there the facets are "
                                    "measured",
                                    facets.across_creases),
                        "export the part with faces that end at their creases");
  if (drives) {
    tell_gaps(model, job.scene, diagnostics);
    job.driven_faces = faces_of_bodies(model);
  }
  job.design_under = facets.under;
  return std::move(facets.mesh);
}

/// What the part is measured against.
/// In mm. A part smaller than the smallest tool that machines it is in another unit, or none.
TriMesh load_design_mesh(const Job& job, Diagnostics& diagnostics) {
  const DesignSettings& design = job.scene.design;
  TriMesh mesh = mesh::load_mesh(design.mesh_file);
  const auto unit = static_cast<float>(design.mesh_unit_mm.value_or(1.0));
  for (auto& p : mesh.positions)
    for (float& coordinate : p) coordinate *= unit;
  mesh::place(mesh, design.placement);
  double tool_mm = std::numeric_limits<double>::infinity();
  for (const cutter::Cutter& tool : job.scene.tools) tool_mm = std::min(tool_mm, tool.diameter_mm);
  if (!design.mesh_unit_mm && !mesh.positions.empty())
    suspect_unit({"design mesh", "design.mesh_unit", design.mesh_where}, mesh::bounds(mesh), tool_mm,
                 diagnostics);
  return mesh;
}

/// Facets no higher than this are turned by the rounding of their corners, mm: neither rays nor proofs can
/// rest on their planes.
constexpr double kSliverHeight = 2e-4;

/// Rays find what the proof decides: about so many of them over the whole design.
double pitch_of(const TriMesh& mesh) {
  constexpr double kRays = 20'000.0, kFinest = 0.2, kStep = 0.05;  // mm
  double area = 0.0;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](size_t k) {
      const auto& p = mesh.positions[t[k]];
      return Vec3(p[0], p[1], p[2]);
    };
    area += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return std::max(kFinest, kStep * std::round(std::sqrt(area / kRays) / kStep));
}

void load_design(Job& job, Diagnostics& diagnostics) {
  DesignSettings& design = job.scene.design;
  // The part that drives is the design.
  if (job.scene.driven && job.scene.driven->mesh && design.kind == DesignKind::kProgram) {
    design.kind = DesignKind::kMesh;
    design.mesh_file = job.scene.driven->file;
  }
  const bool own_faces = job.scene.driven && job.scene.driven->step;
  if (own_faces && design.kind == DesignKind::kProgram) {
    design.kind = DesignKind::kMesh;
    design.mesh_key = "step";
    design.mesh_file = job.scene.driven->file;
    design.chord_mm = job.scene.driven->chord_mm;
  }
  std::vector<program::SurfaceDefinition> defined = job.program.surfaces;
  if (design.kind == DesignKind::kSurface) defined = program::load_surfaces(design.surface_file);
  for (const program::SurfaceDefinition& definition : defined) job.design.push_back(definition.surface);
  if (design.kind == DesignKind::kAnalytic) job.design = design.surfaces;
  if (design.kind == DesignKind::kRuledFaces) job.design = load_ruled_faces(design, diagnostics);
  if (design.kind == DesignKind::kMesh) {
    auto mesh = std::make_shared<TriMesh>(design.mesh_key == "step" ? cad_facets(job, own_faces, diagnostics)
                                                                    : load_design_mesh(job, diagnostics));
    // An automatic box holds the design; of a raw stock that is itself at fault nothing is known.
    const StockSettings& stock = job.scene.stock;
    const bool open = stock.auto_box || (stock.raw.kind != RawKind::kBox && !stock.shape);
    const Box* box = open ? nullptr : &stock.box_W;
    mesh::check_design_mesh(*mesh, design.mesh_file, box, diagnostics);
    if (!diagnostics.has_errors()) mesh::check_bodies(*mesh, design.mesh_file, diagnostics, "design mesh");
    if (!diagnostics.has_errors()) mesh::check_apart(*mesh, design.mesh_file, diagnostics, "design mesh");
    if (design.mesh_key != "step" && !diagnostics.has_errors()) check_facet_chord(job, *mesh, diagnostics);
    const double moved_mm = job.design_under == nullptr ? mesh::flip_slivers(*mesh, kSliverHeight) : 0.0;
    constexpr double kNoCreases = kPi;  // one normal for each vertex
    if (mesh->normals.empty()) mesh::compute_vertex_normals(*mesh, kNoCreases);
    if (!design.pitch_given && !job.scene.driven) design.pitch_mm = pitch_of(*mesh);
    job.design_mesh = std::move(mesh);
    if (job.design_under == nullptr) job.proof = job.proof_outside = {job.design_mesh, moved_mm};
  }
}

/// G06.3 and G06.4 bring the end of the tool in contact with the surface; scallops of other ends are not
/// derived.
void check_planner_cutter(const Job& job, Diagnostics& diagnostics) {
  if (job.program.operations.empty() || toolpath::has_contact_end(job.scene.tools.front())) return;
  diagnostics.error(
      "planner-cutter", job.program.operations.front().where,
      fmt::format("surface blocks are planned for flat ends, balls and bull noses only, {} is {}",
                  cutter::call_name(job.scene.tools.front()), cutter::describe(job.scene.tools.front())),
      "set cutter.shape to \"flat\", \"ball\" or \"bull_nose\", or run a program that brings its own tool "
      "positions");
}

template <typename Load>
void collect(Diagnostics& diagnostics, Load load) {
  try {
    load();
  } catch (const InputError& error) {
    diagnostics.append(error.diagnostics);
  }
}

}  // namespace

std::vector<int> cl_tools(const Job& job) {
  const std::vector<cutter::Cutter>& ours = job.scene.tools;
  std::vector<int> tools;
  for (const program::ClTool& tool : job.cl->tools) {
    // A tool that is called by its name is the scene's only one while neither has another.
    const bool only =
        tool.number == 0 && job.cl->tools.size() == 1 && ours.size() == 1 && ours[0].name.empty();
    tools.push_back(only ? 0 : tool_index(ours, tool.number, tool.name));
  }
  return tools;
}

std::vector<kinematics::MachineModel> machines_by_tool(const Job& job) {
  std::vector<kinematics::MachineModel> machines;
  for (const cutter::Cutter& tool : job.scene.tools) {
    machines.push_back(kinematics::with_tool(job.machine.model, cutter::gauge_length(tool)));
  }
  return machines;
}

namespace {

/// Loads what the scene names.
Job complete(Scene scene, Diagnostics diagnostics, std::vector<EarlierSetup> earlier = {}) {
  diagnostics.throw_if_errors();
  Job job;
  job.scene = std::move(scene);
  job.earlier = std::move(earlier);
  // A user mends all files at once: what is wrong with one does not hide what is wrong with the other.
  Vec3 table_M = Vec3::Zero();
  collect(diagnostics, [&] {
    job.machine = machine::load_machine(job.scene.machine_file);
    Pose& X_MW = job.machine.model.X_MW;
    table_M = X_MW.translation();
    if (job.scene.setup.work_origin_mm) X_MW.translation() = *job.scene.setup.work_origin_mm;
    X_MW.linear() = Eigen::AngleAxisd(job.scene.setup.work_rotation_rad, Vec3::UnitZ()).toRotationMatrix();
  });
  if (!diagnostics.has_errors()) collect(diagnostics, [&] { bind_tools(job, diagnostics); });
  Diagnostics warnings;
  collect(diagnostics, [&] {
    if (job.scene.kind == ProgramKind::kCl) {
      job.cl = program::load_cl(job.scene.program_file, &warnings, job.scene.cl_options);
    } else if (job.scene.kind == ProgramKind::kSurfaceBlocks || job.scene.program_key == "program") {
      job.program = program::load_program(job.scene.program_file, &warnings);
    } else if (job.scene.driven && !job.scene.driven->mesh && !job.scene.driven->step &&
               !job.scene.driven->by_design) {
      job.program.surfaces = program::load_surfaces(job.scene.program_file);
    }
  });
  collect(diagnostics, [&] { load_stock(job, diagnostics); });
  collect(diagnostics, [&] { load_design(job, diagnostics); });
  diagnostics.throw_if_errors();
  diagnostics.append(warnings);
  if (job.cl) {
    check_cl_tools(job, diagnostics);
  } else if (job.scene.kind == ProgramKind::kSurfaceBlocks) {
    check_tools(job, diagnostics);
    check_planner_cutter(job, diagnostics);
  } else if (job.scene.flank) {
    check_tools(job, diagnostics);
  }
  diagnostics.throw_if_errors();
  fill_open(job, diagnostics);
  diagnostics.throw_if_errors();
  if (job.scene.flank) load_flank(job, diagnostics);
  diagnostics.throw_if_errors();
  if (job.scene.driven) load_driven(job, diagnostics);
  diagnostics.throw_if_errors();
  collect(diagnostics, [&] {
    place_fixtures(job, table_M, diagnostics);
    // What earlier set-ups have left is known when their paths are (sim/run/starting_clamping.h).
    if (!job.earlier.empty()) return;
    const TriMesh stock = job.scene.stock.body_W().mesh_around();
    check_clamping(job, {stock}, diagnostics, job.scene.assumptions);
  });
  diagnostics.throw_if_errors();
  if (job.scene.flank && job.scene.flank->clearance_mm)
    collect(diagnostics, [&] { keep_clear(job, diagnostics); });
  diagnostics.throw_if_errors();
  check_memory(job, diagnostics);
  check_design_place(job, diagnostics);
  diagnostics.throw_if_errors();
  check_walls(job, diagnostics);
  diagnostics.throw_if_errors();
  job.warnings = diagnostics.list();
  return job;
}

}  // namespace

Job load_job(const std::string& path, const std::vector<std::string>& overrides) {
  Diagnostics diagnostics;
  Scene scene = load_scene(path, overrides, diagnostics);
  return complete(std::move(scene), std::move(diagnostics));
}

Job load_job(const SceneText& text, const std::vector<std::string>& overrides) {
  Diagnostics diagnostics;
  Scene scene = load_scene(text, overrides, diagnostics);
  return complete(std::move(scene), std::move(diagnostics));
}

namespace {

void tell_not_turned(Job& job) {
  const SetupSettings& setup = job.scene.setup;
  if (setup.number > 1 && !setup.pose_said)
    job.scene.assumptions.push_back(
        {"Part", "not turned: it lies as in the first set-up",
         fmt::format("set-up {} has no part_pose", setup.number),
         "part_pose = { position_mm = [..], rotation_deg = [..] } of its [[setup]]"});
}

}  // namespace

std::vector<std::shared_ptr<const Job>> load_setups(const std::string& path,
                                                    const std::vector<std::vector<std::string>>& overrides) {
  std::vector<std::shared_ptr<const Job>> jobs;
  for (const std::vector<std::string>& own : overrides) {
    Diagnostics diagnostics;
    Scene scene = load_scene(path, own, diagnostics, static_cast<int>(jobs.size()) + 1);
    std::vector<EarlierSetup> earlier;
    if (!jobs.empty())
      earlier = setups_up_to(jobs.back(), scene.setup.X_WF * jobs.back()->scene.setup.X_WF.inverse());
    Job job = complete(std::move(scene), std::move(diagnostics), std::move(earlier));
    tell_not_turned(job);
    jobs.push_back(std::make_shared<const Job>(std::move(job)));
  }
  return jobs;
}

}  // namespace swarf::sim

#include "fuzz/seeds.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "base/diagnostics.h"
#include "base/hash.h"
#include "base/units.h"
#include "machine/machine_scene.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "mesh/mesh_source.h"
#include "sim/job/scene.h"
#include "sim/job/tool_table.h"
#include "stock/rays/ray_field.h"
#include "stock/stock.h"
#include "support/program_run.h"

namespace swarf::test {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = SWARF_SOURCE_DIR;

/// A closed tube bent to a ring, outward.
TriMesh ring(uint32_t n) {
  TriMesh mesh;
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t k = 0; k < n; ++k) {
      const double a = 2.0 * kPi * i / n, b = 2.0 * kPi * k / n, r = 30.0 + 8.0 * std::cos(b);
      mesh.positions.push_back({static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)),
                                static_cast<float>(8.0 * std::sin(b))});
      const uint32_t i1 = (i + 1) % n, k1 = (k + 1) % n;
      mesh.triangles.push_back({i * n + k, i1 * n + k, i1 * n + k1});
      mesh.triangles.push_back({i * n + k, i1 * n + k1, i * n + k1});
    }
  }
  return mesh;
}

std::string saved(const fs::path& path, const TriMesh& mesh) {
  mesh::save_mesh(path.string(), mesh);
  return read_text(path);
}

std::string numbers(const std::array<float, 3>& p) {
  char text[100];
  std::snprintf(text, sizeof(text), "%.9g %.9g %.9g", p[0], p[1], p[2]);
  return text;
}

std::string text_stl(const TriMesh& mesh) {
  std::string text = "solid ring\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const uint32_t v : t) text += "vertex " + numbers(mesh.positions[v]) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid ring\n";
}

std::string text_ply(const TriMesh& mesh) {
  std::string text =
      "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex " + std::to_string(mesh.positions.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
      "green\nproperty uchar blue\nelement face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& p : mesh.positions) text += numbers(p) + " 200 100 0\n";
  for (const auto& t : mesh.triangles)
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  return text;
}

/// From a little-endian file of three floats for each vertex and triangles.
std::string big_endian(std::string bytes, const TriMesh& mesh) {
  const std::string from = "binary_little_endian", end = "end_header\n";
  bytes.replace(bytes.find(from), from.size(), "binary_big_endian");
  auto at = bytes.begin() + static_cast<std::ptrdiff_t>(bytes.find(end) + end.size());
  for (size_t i = 0; i < 3 * mesh.positions.size(); ++i, at += 4) std::reverse(at, at + 4);
  for (size_t i = 0; i < mesh.triangles.size(); ++i, ++at) {
    for (int k = 0; k < 3; ++k) std::reverse(at + 1 + 4 * k, at + 5 + 4 * k);
    at += 12;
  }
  return bytes;
}

std::string text_obj(const TriMesh& mesh, bool normals) {
  std::string text = "# a ring\no ring\n";
  for (const auto& p : mesh.positions) text += "v " + numbers(p) + "\n";
  if (normals) text += "vn 0 0 1\nvn 1 0 0\n";
  for (size_t i = 0; i + 1 < mesh.triangles.size(); i += 2) {  // two triangles are one face of four corners
    text += "f";
    for (const uint32_t v :
         {mesh.triangles[i][0], mesh.triangles[i][1], mesh.triangles[i][2], mesh.triangles[i + 1][2]})
      text += " " + std::to_string(v + 1) + (normals ? "//" + std::to_string(v % 2 + 1) : "");
    text += "\n";
  }
  return text;
}

/// Makes a file in a child: threads that this process started would be missing in the children of the
/// sandbox.
template <typename Make>
void in_child(Make make) {
  const pid_t child = fork();
  if (child == 0) {
    make();
    _exit(0);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || status != 0)
    throw std::runtime_error("no stock file");
}

/// What an accepted mesh must be, so that the libraries behind need not ask.
std::string fault_of(const TriMesh& mesh) {
  if (mesh.triangles.empty()) return "a mesh without triangles was accepted";
  if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), mesh::within_bounds))
    return "a vertex is not finite or too far away";
  for (const auto& t : mesh.triangles) {
    for (const uint32_t v : t) {
      if (v >= mesh.positions.size()) return "a triangle names a vertex that is not there";
    }
  }
  const auto fits = [&](size_t size) { return size == 0 || size == mesh.positions.size(); };
  if (!fits(mesh.normals.size()) || !fits(mesh.colours.size())) return "normals or colours are missing";
  return "";
}

CaseResult load_mesh_case(const std::string& path) {
  TriMesh mesh = mesh::load_mesh(path);
  const std::string fault = fault_of(mesh);
  if (!fault.empty()) return {CaseOutcome::kWrong, fault};
  Diagnostics diagnostics;
  const Box stock{{-50, -50, -20}, {50, 50, 20}};
  mesh::check_design_mesh(mesh, path, &stock, diagnostics);
  mesh::compute_vertex_normals(mesh, kPi);
  diagnostics.throw_if_errors();
  stock::rays_on_mesh(mesh, 2.0);
  return {};
}

CaseResult load_stock_case(const std::string& path) {
  const stock::Stock stock = stock::Stock::load(path);
  const std::string broken = stock.check(stock::CheckLevel::kVoxels);
  return broken.empty() ? CaseResult{} : CaseResult{CaseOutcome::kWrong, broken};
}

CaseResult load_tools_case(const std::string& path) {
  Diagnostics diagnostics;
  sim::read_tool_table(path, diagnostics);
  diagnostics.throw_if_errors();
  return {};
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Scenes with copies of what lies beside them; what lies elsewhere is named where it is.
std::vector<FuzzKind::Seed> scene_seeds(const fs::path& folder) {
  std::vector<FuzzKind::Seed> seeds;
  for (const char* name : {"exact_slot_flat", "exact_scallop_mesh", "exact_hyperboloid", "lin_koren_dome",
                           "nc_pocket", "so_singularity", "cl_simple_block"}) {
    const fs::path place = folder / name;
    fs::copy(kSource / "scenes" / name, place);
    std::string text = read_text(place / "scene.toml");
    replace_all(text, "../../", kSource.string() + "/");
    seeds.push_back({text, place, ".toml"});
  }
  return seeds;
}

std::vector<FuzzKind::Seed> machine_seeds() {
  std::vector<FuzzKind::Seed> seeds;
  for (const char* name :
       {"assets/machines/mill_3axis/machine.toml", "assets/machines/fork_head/machine.toml",
        "assets/machines/lin_koren_xyzab/machine.toml", "tests/data/machines/small.toml"}) {
    std::string text = read_text(kSource / name);
    replace_all(text, "mesh = \"", "mesh = \"" + (kSource / name).parent_path().string() + "/");
    seeds.push_back({text, {}, ".toml"});
  }
  return seeds;
}

constexpr const char* kTbl =
    "; tools of the mill\nT1 P1 Z81.5 D8 ; end mill\nT2 P2 Z+100.25 D6.0 ; ball\nT10 P3 X0 Y0 Z60 D12 A0 B0 "
    "C0 I0 J0 Q0\n";

}  // namespace

std::vector<FuzzKind> fuzz_kinds(const fs::path& folder) {
  const TriMesh mesh = ring(9);
  TriMesh rich = mesh;
  for (size_t i = 0; i < rich.positions.size(); ++i) {
    rich.normals.push_back({0, 0, 1});
    rich.colours.push_back({200, 100, 0, 255});
    rich.deviation_um.push_back(0.5F);
  }
  const std::string stl = saved(folder / "ring.stl", mesh), ply = saved(folder / "ring.ply", mesh);
  const std::string rich_ply = saved(folder / "rich.ply", rich);
  const fs::path vdb = folder / "seed.vdb";
  in_child([&] {
    stock::Stock block({{-6, -6, -4}, {6, 6.05, 0}}, 0.8);
    const std::vector<stock::Sweep> sweeps{{{{-2, 0, -1.5}, Vec3::UnitZ()}, {{3, 1, -1}, Vec3::UnitZ()}, 0}};
    block.cut(sweeps, stock::CutterSolid{2.0, 10.0});
    block.save(vdb.string(), {{"scene", "fuzz"}});
  });
  std::vector<FuzzKind> kinds{
      {"stl", 4, {{stl, {}, ".stl"}, {text_stl(mesh), {}, ".stl"}}, load_mesh_case},
      {"ply",
       5,
       {{ply, {}, ".ply"},
        {rich_ply, {}, ".ply"},
        {big_endian(ply, mesh), {}, ".ply"},
        {text_ply(mesh), {}, ".ply"}},
       load_mesh_case},
      {"obj", 3, {{text_obj(mesh, false), {}, ".obj"}, {text_obj(mesh, true), {}, ".obj"}}, load_mesh_case},
      {"vdb", 2, {{read_text(vdb), {}, ".vdb"}}, load_stock_case},
      {"scene", 3, scene_seeds(folder),
       [](const std::string& path) {
         sim::load_job(path, {});
         return CaseResult{};
       }},
      {"machine", 2, machine_seeds(),
       [](const std::string& path) {
         machine::load_machine(path);
         return CaseResult{};
       }},
      {"tools",
       1,
       {{read_text(kSource / "assets/programs/spinner_u5/tools.toml"), {}, ".toml"},
        {read_text(kSource / "scenes/nc_pocket/tools.toml"), {}, ".toml"},
        {kTbl, {}, ".tbl"},
        {read_text(kSource / "tests/data/tools/fusion.json"), {}, ".json"},
        {read_text(kSource / "tests/data/tools/catalogue.p21"), {}, ".p21"}},
       load_tools_case}};
  for (FuzzKind& kind : kinds) {
    for (FuzzKind::Seed& seed : kind.seeds) {
      if (seed.place.empty()) seed.place = folder;
    }
  }
  return kinds;
}

}  // namespace swarf::test

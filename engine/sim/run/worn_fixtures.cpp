#include "sim/run/worn_fixtures.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/disjoint_sets.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_ops.h"
#include "mesh/plain_solids.h"
#include "sim/run/cut_sweeps.h"
#include "sim/run/result.h"

namespace swarf::sim {
namespace {

/// The closed bodies of a mesh. Bodies that touch share edges of more than two facets: none is joined there.
std::vector<TriMesh> closed_bodies(const TriMesh& mesh) {
  const mesh::WeldedMesh welded = mesh::weld(mesh);
  const std::vector<uint32_t> across = mesh::facets_across(welded.triangles);
  DisjointSets sets(welded.triangles.size());
  for (size_t side = 0; side < across.size(); ++side)
    if (across[side] != 0xffffffffU) sets.join(static_cast<uint32_t>(side / 3), across[side]);
  std::map<uint32_t, TriMesh> bodies;
  for (size_t i = 0; i < welded.triangles.size(); ++i) {
    TriMesh& body = bodies[sets.root(static_cast<uint32_t>(i))];
    const auto first = static_cast<uint32_t>(body.positions.size());
    for (const uint32_t vertex : welded.triangles[i]) {
      const Vec3& p = welded.points[vertex];
      body.positions.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    body.triangles.push_back({first, first + 1, first + 2});
  }
  std::vector<TriMesh> list;
  for (auto& [root, body] : bodies) list.push_back(std::move(body));
  return list;
}

bool met_by_flutes(const MachineContacts& contacts, const std::string& name) {
  const auto is = [&](size_t body, auto test) { return test(contacts.bodies[body]); };
  const auto fixture = [&](const ContactBody& one) {
    return one.kind == collision::BodyKind::kFixture && one.name == name;
  };
  const auto flutes = [](const ContactBody& one) {
    return one.kind == collision::BodyKind::kToolPart && one.name.starts_with("flutes");
  };
  return std::any_of(contacts.findings.pairs.begin(), contacts.findings.pairs.end(), [&](const auto& pair) {
    return !pair.spans.empty() &&
           ((is(pair.a, fixture) && is(pair.b, flutes)) || (is(pair.b, fixture) && is(pair.a, flutes)));
  });
}

/// Cuts all sweeps; the least volume that counts as cut is what the sum over cells rounds.
double cut_body(stock::Stock& body, const CutSweeps& sweeps, const std::vector<stock::CutterSolid>& solids) {
  constexpr size_t kSweepsAtOnce = 2048;
  const double before = body.volume_mm3();
  for (size_t at = 0; at < sweeps.size(); at += kSweepsAtOnce)
    sweeps.for_each_tool(
        at, std::min(at + kSweepsAtOnce, sweeps.size()),
        [&](size_t tool, std::span<const stock::Sweep> part) { body.cut(part, solids[tool]); });
  const double removed = before - body.volume_mm3();
  return removed > 1e-9 * before ? removed : 0.0;
}

}  // namespace

std::vector<WornFixture> worn_fixtures(const Job& job, const Result& result) {
  std::vector<WornFixture> worn;
  if (!result.main.contacts) return worn;
  const Pose X_WM = job.machine.model.X_MW.inverse();
  const std::vector<stock::CutterSolid> solids = tool_solids(job.scene);
  std::optional<CutSweeps> sweeps;
  for (size_t i = 0; i < job.machine.links.size(); ++i) {
    const machine::Link& link = job.machine.links[i];
    if (!link.fixture || !met_by_flutes(*result.main.contacts, link.name)) continue;
    if (!sweeps) sweeps = cut_sweeps(job, *result.main.cycles);
    WornFixture fixture{i, link.name, 0.0, {}};
    for (TriMesh& drawn : closed_bodies(link.mesh)) {
      if (!mesh::check_closed(drawn).empty()) {
        mesh::append(fixture.mesh_M, drawn);
        continue;
      }
      stock::Stock body(stock::RawShape::of_mesh(mesh::moved(drawn, X_WM), link.name),
                        job.scene.stock.voxel_mm);
      const double removed = cut_body(body, *sweeps, solids);
      fixture.removed_mm3 += removed;
      mesh::append(fixture.mesh_M,
                   removed > 0.0 ? mesh::moved(body.mesh(), job.machine.model.X_MW) : std::move(drawn));
    }
    fixture.mesh_M.normals.clear();  // the cut ones have some, the drawn ones none: flat shading for all
    if (fixture.removed_mm3 > 0.0) worn.push_back(std::move(fixture));
  }
  return worn;
}

Job with_worn(const Job& job, const std::vector<WornFixture>& worn) {
  Job shown = job;
  for (const WornFixture& fixture : worn) shown.machine.links[fixture.link].mesh = fixture.mesh_M;
  return shown;
}

}  // namespace swarf::sim

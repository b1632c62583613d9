#include "sim/run/machine_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "sim/job/tool_bodies.h"

namespace swarf::sim {
namespace {

using collision::Body;
using collision::BodyKind;

constexpr const char* kStock = "stock";

/// Tools may cut the stock; whether its other parts meet it is judged against what is left of it
/// (tool_clearance.h).
collision::PathCheckOptions options_of(const std::vector<Body>& bodies) {
  collision::PathCheckOptions options;
  for (const Body& body : bodies)
    if (body.kind == BodyKind::kToolPart) options.allowed.emplace_back(body.name, kStock);
  return options;
}

}  // namespace

std::vector<Body> contact_bodies(const Job& job) {
  std::vector<Body> bodies = collision::link_bodies(job.machine);
  for (Body& body : bodies)
    if (job.machine.links[static_cast<size_t>(body.link)].fixture) body.kind = BodyKind::kFixture;
  for (Body& body : tool_bodies(job)) bodies.push_back(std::move(body));
  bodies.push_back(
      collision::work_body(job.machine, kStock, BodyKind::kStock, job.scene.stock.body_W().mesh_around()));
  return bodies;
}

bool MachineContacts::with_stock(const collision::PairFindings& pair) const {
  return bodies[pair.a].kind == BodyKind::kStock || bodies[pair.b].kind == BodyKind::kStock;
}

size_t MachineContacts::beside_stock(const collision::PairFindings& pair) const {
  return bodies[pair.a].kind == BodyKind::kStock ? pair.b : pair.a;
}

uint64_t MachineContacts::contacts() const {
  uint64_t count = 0;
  for (const collision::PairFindings& pair : findings.pairs)
    if (!with_stock(pair)) count += pair.contact_count();
  return count;
}

uint64_t StockContacts::count(StockVerdict verdict) const {
  if (verdict == StockVerdict::kClear) return suspects - events.size();
  return static_cast<uint64_t>(std::count_if(
      events.begin(), events.end(), [&](const StockEvent& event) { return event.verdict == verdict; }));
}

const collision::PairFindings* MachineContacts::nearest() const {
  const collision::PairFindings* nearest = nullptr;
  for (const collision::PairFindings& pair : findings.pairs) {
    if (with_stock(pair) && !pair.spans.empty()) continue;
    if (pair.near_miss.within && (nearest == nullptr || pair.near_miss.upper < nearest->near_miss.upper))
      nearest = &pair;
  }
  return nearest;
}

MachineContactCheck::MachineContactCheck(const Job& job) {
  std::vector<Body> bodies = contact_bodies(job);
  for (const Body& body : bodies) contacts_.bodies.push_back({body.name, body.kind});
  for (const machine::Link& link : job.machine.links)
    if (link.mesh.triangles.empty()) contacts_.without_mesh.push_back(link.name);
  const collision::PathCheckOptions options = options_of(bodies);
  contacts_.near_miss_mm = options.near_miss_mm;
  Diagnostics diagnostics;
  check_ = std::make_unique<collision::PathCheck>(job.machine, std::move(bodies), options, diagnostics);
  contacts_.warnings = diagnostics.list();
}

void MachineContactCheck::find_suspects() {
  const std::vector<collision::PairFindings>& pairs = contacts_.findings.pairs;
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].spans.empty() || !contacts_.with_stock(pairs[i])) continue;
    for (const collision::CycleSpan& span : pairs[i].spans) contacts_.suspects.push_back({i, span});
    const size_t body = contacts_.beside_stock(pairs[i]);
    contacts_.shapes.emplace(body, check_->bodies()[body]);
  }
  std::stable_sort(
      contacts_.suspects.begin(), contacts_.suspects.end(),
      [](const StockSuspect& a, const StockSuspect& b) { return a.cycles.first < b.cycles.first; });
}

MachineContacts MachineContactCheck::finish() {
  contacts_.findings = check_->finish();
  find_suspects();
  return std::move(contacts_);
}

}  // namespace swarf::sim

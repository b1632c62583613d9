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
collision::PathCheckOptions options_of(const Job& job, const std::vector<Body>& bodies) {
  collision::PathCheckOptions options;
  options.rules = contact_rules(job, bodies);
  for (const Body& body : bodies)
    if (body.kind == BodyKind::kToolPart) options.rules.allowed.emplace_back(body.name, kStock);
  return options;
}

/// "holder" is that of every tool.
std::vector<const Body*> bodies_named(const std::vector<Body>& bodies, const std::string& name) {
  std::vector<const Body*> found;
  for (const Body& body : bodies) {
    const bool of_any = body.kind == BodyKind::kToolPart && body.name.starts_with(name + " of ");
    if (body.name == name || of_any) found.push_back(&body);
  }
  return found;
}

void check_rule(const Job& job, const ContactPair& said, const std::vector<const Body*>& a,
                const std::vector<const Body*>& b, Diagnostics& diagnostics) {
  const auto any = [](const std::vector<const Body*>& of, BodyKind kind) {
    return std::any_of(of.begin(), of.end(), [&](const Body* body) { return body->kind == kind; });
  };
  const bool tool = any(a, BodyKind::kToolPart) || any(b, BodyKind::kToolPart);
  if (tool && (any(a, BodyKind::kStock) || any(b, BodyKind::kStock)))
    diagnostics.error("pair-of-tool-and-stock", said.where,
                      fmt::format("{} and {}: a tool in the stock is judged as a collision", said.a, said.b),
                      "accept.collisions allows some");
  const auto never = [&](const Body* one, const Body* other) {
    return one == other || collision::RelativeMotion(job.machine, one->link, other->link).rigid();
  };
  if (!a.empty() && !b.empty() && never(a.front(), b.front()))
    diagnostics.error(
        "pair-never-moves", said.where,
        fmt::format("no axis lies between {} and {}: they never move against each other", said.a, said.b),
        "take the pair out");
}

void check_body_name(const std::string& name, const std::vector<Body>& bodies, const SourceLocation& where,
                     Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const Body& body : bodies) names.push_back(body.name);
  const std::string near = nearest_name(name, names);
  diagnostics.error("unknown-body", where, fmt::format("nothing with a mesh is called '{}'", name),
                    (near.empty() ? "" : fmt::format("did you mean '{}'? ", near)) +
                        fmt::format("there are: {}", fmt::join(names, ", ")));
}

/// Links without a mesh, and every body that an axis parts from them.
std::vector<collision::NamePair> unmeshed_pairs(const Job& job, const std::vector<Body>& bodies) {
  const std::vector<machine::Link>& links = job.machine.links;
  const auto rigid = [&](size_t a, int b) {
    return collision::RelativeMotion(job.machine, static_cast<int>(a), b).rigid();
  };
  std::vector<collision::NamePair> pairs;
  for (size_t i = 0; i < links.size(); ++i) {
    if (!links[i].mesh.triangles.empty()) continue;
    for (size_t k = 0; k < links.size(); ++k) {
      const bool twice = links[k].mesh.triangles.empty() && k <= i;
      const bool guides = links[i].parent == static_cast<int>(k) || links[k].parent == static_cast<int>(i);
      if (!twice && !guides && !rigid(i, static_cast<int>(k)))
        pairs.emplace_back(links[i].name, links[k].name);
    }
    for (const Body& body : bodies) {
      const bool part = body.kind == BodyKind::kToolPart || body.kind == BodyKind::kStock;
      if (part && !rigid(i, body.link)) pairs.emplace_back(links[i].name, body.name);
    }
  }
  return pairs;
}

}  // namespace

collision::PairRules contact_rules(const Job& job, const std::vector<Body>& bodies) {
  collision::PairRules rules;
  Diagnostics diagnostics;
  for (const ContactPair& said : job.scene.contact_pairs) {
    const std::vector<const Body*> a = bodies_named(bodies, said.a), b = bodies_named(bodies, said.b);
    if (a.empty()) check_body_name(said.a, bodies, said.where, diagnostics);
    if (b.empty()) check_body_name(said.b, bodies, said.where, diagnostics);
    check_rule(job, said, a, b, diagnostics);
    for (const Body* const one : a)
      for (const Body* const other : b) {
        if (said.may_touch) rules.allowed.emplace_back(one->name, other->name);
        if (said.near_miss_mm) rules.watched.push_back({{one->name, other->name}, *said.near_miss_mm});
      }
  }
  diagnostics.throw_if_errors();
  return rules;
}

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
  contacts_.without_mesh_pairs = unmeshed_pairs(job, bodies);
  const collision::PathCheckOptions options = options_of(job, bodies);
  contacts_.rules = options.rules;
  contacts_.near_miss_mm = options.near_miss_mm;
  for (const collision::NearMissRule& rule : options.rules.watched)
    contacts_.near_miss_mm = std::min(contacts_.near_miss_mm, rule.near_miss_mm);
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

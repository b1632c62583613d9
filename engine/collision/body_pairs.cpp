#include "collision/body_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "collision/containment.h"

namespace swarf::collision {
namespace {

bool is_named(const NamePair& names, const std::string& a, const std::string& b) {
  return (names.first == a && names.second == b) || (names.first == b && names.second == a);
}

void check_rule_names(const std::vector<Body>& bodies, const PairRules& rules) {
  std::vector<std::string> names;
  for (const Body& body : bodies) names.push_back(body.name);
  Diagnostics found;
  const auto check = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    const std::string nearest = nearest_name(name, names);
    found.error("unknown-body", {}, fmt::format("there is no body \"{}\" in a pair of bodies", name),
                nearest.empty() ? "name a link, a fixture, the part, the stock or a part of the tool"
                                : fmt::format("perhaps \"{}\" is meant", nearest));
  };
  const auto check_both = [&](const NamePair& pair) {
    check(pair.first);
    check(pair.second);
  };
  for (const NamePair& pair : rules.allowed) check_both(pair);
  for (const NearMissRule& rule : rules.watched) check_both(rule.names);
  found.throw_if_errors();
}

bool is_allowed(const PairRules& rules, const Body& a, const Body& b) {
  return std::any_of(rules.allowed.begin(), rules.allowed.end(),
                     [&](const NamePair& names) { return is_named(names, a.name, b.name); });
}

/// The link on which another one is guided: its parent, or the first carrier that has a mesh.
int guide_of(const machine::MachineScene& scene, int link) {
  int guide = scene.links[static_cast<size_t>(link)].parent;
  while (guide >= 0 && scene.links[static_cast<size_t>(guide)].mesh.triangles.empty()) {
    guide = scene.links[static_cast<size_t>(guide)].parent;
  }
  return guide;
}

bool is_guided(const Encounter& pair) {
  const int a = pair.a->link, b = pair.b->link;
  if (pair.a->kind != BodyKind::kLink || pair.b->kind != BodyKind::kLink || a < 0 || b < 0) return false;
  return guide_of(*pair.scene, a) == b || guide_of(*pair.scene, b) == a;
}

bool touches_at(const Encounter& pair, const AxisValues& q, double touch_mm) {
  AxisSegment still;
  still.q0 = still.q1 = q;
  ApproachQuery query;
  query.limit = 2.0 * touch_mm;
  query.tolerance = query.enough = touch_mm;
  const Approach found = closest_approach(pair, still, query);
  return (found.within && found.upper <= touch_mm) || one_holds_other(pair, q);
}

std::optional<PairReason> reason_to_leave_out(const Encounter& pair, const PairRules& rules,
                                              double touch_mm) {
  if (pair.b_from_a.rigid()) return PairReason::kRigid;
  if (is_allowed(rules, *pair.a, *pair.b)) return PairReason::kAllowed;
  if (rules.near_miss_of(pair.a->name, pair.b->name) != nullptr) return std::nullopt;
  if (is_guided(pair)) return PairReason::kGuided;
  const bool links = pair.a->kind == BodyKind::kLink && pair.b->kind == BodyKind::kLink;
  if (links && touches_at(pair, home_of(*pair.scene), touch_mm)) return PairReason::kTouchesAtHome;
  return std::nullopt;
}

}  // namespace

const NearMissRule* PairRules::near_miss_of(const std::string& a, const std::string& b) const {
  const auto found = std::find_if(watched.begin(), watched.end(),
                                  [&](const NearMissRule& rule) { return is_named(rule.names, a, b); });
  return found == watched.end() ? nullptr : &*found;
}

std::string text_of(PairReason reason) {
  switch (reason) {
    case PairReason::kRigid:
      return "no axis lies between them";
    case PairReason::kGuided:
      return "one guides the other: it is its parent";
    case PairReason::kAllowed:
      return "they may touch";
    case PairReason::kTouchesAtHome:
      return "their meshes overlap where the axes stand at home";
  }
  return "";
}

AxisValues home_of(const machine::MachineScene& scene) {
  AxisValues home = AxisValues::Zero();
  for (size_t i = 0; i < scene.model.axes.size(); ++i)
    home[static_cast<Eigen::Index>(i)] = scene.model.axes[i].home;
  return home;
}

PairChoice choose_pairs(const machine::MachineScene& scene, const std::vector<Body>& bodies,
                        const PairRules& rules, double touch_mm, Diagnostics& diagnostics) {
  check_rule_names(bodies, rules);
  PairChoice choice;
  for (size_t a = 0; a < bodies.size(); ++a) {
    for (size_t b = a + 1; b < bodies.size(); ++b) {
      const auto reason = reason_to_leave_out(encounter(scene, bodies[a], bodies[b]), rules, touch_mm);
      if (!reason) choice.watched.emplace_back(a, b);
      if (reason) choice.left_out.push_back({a, b, *reason});
      if (reason != PairReason::kTouchesAtHome) continue;
      diagnostics.warning(
          "links-touch-at-home", {scene.file, 0, 0},
          fmt::format("the links {} and {} overlap at home, so that their contacts are not watched",
                      bodies[a].name, bodies[b].name),
          "draw their meshes apart, or list the pair as one that may touch");
    }
  }
  return choice;
}

}  // namespace swarf::collision

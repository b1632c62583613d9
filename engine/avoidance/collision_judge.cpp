#include "avoidance/collision_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/units.h"
#include "collision/body_pairs.h"
#include "collision/containment.h"
#include "cutter/cutter.h"
#include "motion/blocks/block_motion.h"
#include "sim/job/clamping_check.h"
#include "sim/run/job_sweeps.h"
#include "sim/run/machine_contacts.h"
#include "stock/stock.h"

namespace swarf::avoidance {
namespace {

using collision::AxisSegment;
using collision::Body;
using collision::BodyKind;
using kinematics::AxisKind;
using kinematics::AxisValues;

constexpr double kTouch = 1e-4;  // mm, as of the run's own check

bool is_there(const Body& body, int tool) {
  return body.tool < 0 || body.tool == tool;
}

/// Where the axes stand when each of those that runs at its own speed has arrived, the first one first.
std::vector<AxisValues> dog_leg(const kinematics::MachineModel& machine, const AxisValues& from,
                                const AxisValues& to) {
  std::vector<double> times;
  const auto time_of = [&](size_t i) {
    const kinematics::Axis& axis = machine.axes[i];
    const double speed = axis.rapid_max > 0.0 ? axis.rapid_max : axis.speed_max;
    const auto row = static_cast<long>(i);
    return speed > 0.0 ? std::abs(to[row] - from[row]) / speed : 0.0;
  };
  for (size_t i = 0; i < machine.axes.size(); ++i) times.push_back(time_of(i));
  std::sort(times.begin(), times.end());
  std::vector<AxisValues> corners;
  for (const double time : times) {
    AxisValues q = to;
    for (size_t i = 0; i < machine.axes.size(); ++i) {
      const auto row = static_cast<long>(i);
      const double whole = time_of(i);
      if (whole > time) q[row] = from[row] + (to[row] - from[row]) * time / whole;
    }
    if (time > 0.0 && (corners.empty() || corners.back() != q)) corners.push_back(q);
  }
  return corners;
}

/// A place on the way, and the tool that comes there.
struct Corner {
  AxisValues q;
  int tool = -1;
};

/// The way of an approach (planner.h): up, to the changer where the tool changes, rotary axes, across, down.
/// `from`: null where nobody knows it; a machine that names the changer's place starts there.
std::vector<Corner> approach_corners(const kinematics::MachineModel& machine, const AxisValues* from,
                                     int tool_before, const post::PlanStep& step) {
  const int along = post::axis_along_tool(machine);
  const double out = post::retracted(machine);
  AxisValues over = step.q;
  over[along] = out;
  std::vector<Corner> corners;
  const bool changes = from == nullptr || tool_before != step.tool;
  if (from != nullptr) {
    AxisValues up = *from;
    up[along] = out;
    corners = {{*from, tool_before}, {up, tool_before}};
  }
  if (changes && machine.tool_change) {
    if (from != nullptr)
      for (const AxisValues& q : dog_leg(machine, corners.back().q, *machine.tool_change))
        corners.push_back({q, tool_before});
    corners.push_back({*machine.tool_change, step.tool});
  }
  if (!corners.empty()) {
    AxisValues turned = corners.back().q;
    for (size_t i = 0; i < machine.axes.size(); ++i) {
      const auto row = static_cast<long>(i);
      if (machine.axes[i].kind == AxisKind::kRotary) turned[row] = step.q[row];
    }
    corners.push_back({turned, step.tool});
    for (const AxisValues& q : dog_leg(machine, turned, over)) corners.push_back({q, step.tool});
  } else {
    corners.push_back({over, step.tool});
  }
  corners.push_back({step.q, step.tool});
  return corners;
}

}  // namespace

/// Two bodies that axes part.
struct CollisionJudge::Pair {
  size_t a, b;
  collision::Encounter encounter;
  bool stock = false;       ///< one is the stock
  bool tool_stock = false;  ///< and the other a part of the tool
};

/// A straight way of the axes.
struct CollisionJudge::Way {
  AxisValues q0, q1;
  size_t step = 0;
  int line = 0, tool = -1;
  bool approach = false;
  bool appears = false;  ///< it begins where nobody has looked before
  bool loading = false;  ///< to or from the tool changer
  AxisSegment segment() const { return {q0, q1, AxisValues::Zero()}; }
};

CollisionJudge::CollisionJudge(const sim::Job& job, double clearance_mm)
    : job_(job), limit_mm_(std::max(clearance_mm, 2.0 * kTouch)), bodies_(sim::contact_bodies(job)) {
  Diagnostics told;
  const collision::PairRules rules = sim::contact_rules(job, bodies_);
  for (const auto& watched : collision::choose_pairs(job.machine, bodies_, rules, kTouch, told).watched) {
    const Body &a = bodies_[watched.first], &b = bodies_[watched.second];
    Pair pair{watched.first, watched.second, collision::encounter(job.machine, a, b), false, false};
    const auto either = [&](BodyKind kind) { return a.kind == kind || b.kind == kind; };
    pair.stock = either(BodyKind::kStock);
    pair.tool_stock = pair.stock && either(BodyKind::kToolPart);
    pairs_.push_back(std::move(pair));
  }
  if (job.cl) tools_ = sim::cl_tools(job);
}

CollisionJudge::~CollisionJudge() = default;

Collision CollisionJudge::told(const Pair& pair, const Way& way, double share, bool proven) const {
  Collision found;
  const Body &a = bodies_[pair.a], &b = bodies_[pair.b];
  found.a = a.name;
  found.b = b.name;
  found.part_a = part_of(job_.machine, a);
  found.part_b = part_of(job_.machine, b);
  found.step = way.step;
  found.line = way.line;
  found.tool = way.tool;
  found.proven = proven;
  found.loading = way.loading;
  const collision::FirstContact touch = collision::first_contact(pair.encounter, way.segment());
  found.q = way.segment().at(touch.touches ? touch.t_touch : share);
  if (touch.touches) found.point_M = touch.point_a;
  std::string axes;
  for (size_t i = 0; i < job_.machine.model.axes.size(); ++i) {
    const kinematics::Axis& axis = job_.machine.model.axes[i];
    const double value = found.q[static_cast<long>(i)];
    axes += fmt::format(" {}{:.3f}", axis.name, axis.kind == AxisKind::kRotary ? deg_from_rad(value) : value);
  }
  const char* const how = !proven                                      ? "comes within a voxel of"
                          : touch.touches || limit_mm_ <= 2.0 * kTouch ? "touches"
                                                                       : "comes nearer than the clearance to";
  found.text = fmt::format("{} ({}) {} {} ({}){} at{}", found.a, part_name(found.part_a), how, found.b,
                           part_name(found.part_b),
                           way.loading    ? " while the tool is changed"
                           : way.approach ? " on the approach"
                                          : "",
                           axes);
  return found;
}

/// A halving search: the axes of ways [begin, end) lie within a stray of the straight line from the first to
/// the last, and one bound clears them all.
std::optional<size_t> CollisionJudge::first_near(const Pair& pair, const std::vector<Way>& ways, size_t begin,
                                                 size_t end) const {
  AxisSegment whole{ways[begin].q0, ways[end - 1].q1, AxisValues::Zero()};
  for (size_t k = begin + 1; k < end; ++k) {
    const double t = static_cast<double>(k - begin) / static_cast<double>(end - begin);
    whole.stray = whole.stray.cwiseMax((ways[k].q0 - whole.at(t)).cwiseAbs());
  }
  collision::ApproachQuery query;
  query.limit = limit_mm_;
  query.tolerance = 0.25 * limit_mm_;
  if (end - begin > 1) query.budget = 2000;  // then halves are cheaper
  const collision::Approach found = collision::closest_approach(pair.encounter, whole, query);
  if (!found.within && !found.given_up) return {};
  if (end - begin == 1) return begin;
  const size_t middle = begin + (end - begin) / 2;
  if (const std::optional<size_t> first = first_near(pair, ways, begin, middle)) return first;
  return first_near(pair, ways, middle, end);
}

/// The raw stock is met: is what is left of it?
bool CollisionJudge::against_stock(const Pair& pair, const Way& way, bool& proven) const {
  const size_t other = bodies_[pair.a].kind == BodyKind::kStock ? pair.b : pair.a;
  const collision::StockAnswer answer = stock_body_->over(bodies_[other], way.segment());
  proven = answer.outcome == collision::StockOutcome::kContact;
  // A cutter that comes down to where it begins to cut ends on the material.
  return proven || (answer.outcome == collision::StockOutcome::kOpen && !pair.tool_stock);
}

std::optional<Collision> CollisionJudge::first_of(const Pair& pair, const std::vector<Way>& ways) const {
  const auto counts = [&](const Way& way) {
    return is_there(bodies_[pair.a], way.tool) && is_there(bodies_[pair.b], way.tool) &&
           (!pair.tool_stock || way.approach);
  };
  for (size_t begin = 0; begin < ways.size();) {
    if (!counts(ways[begin])) {
      ++begin;
      continue;
    }
    size_t end = begin + 1;
    while (end < ways.size() && counts(ways[end]) && ways[end].q0 == ways[end - 1].q1) ++end;
    // What does not touch on its way stays outside: one look where a body comes into being.
    if (!pair.stock && (ways[begin].appears || begin > 0) &&
        collision::one_holds_other(pair.encounter, ways[begin].q0))
      return told(pair, ways[begin], 0.0, true);
    while (begin < end) {
      const std::optional<size_t> near = first_near(pair, ways, begin, end);
      if (!near) break;
      bool proven = true;
      if (!pair.stock || against_stock(pair, ways[*near], proven))
        return told(pair, ways[*near], 0.0, proven);
      begin = *near + 1;
    }
    begin = end;
  }
  return {};
}

void CollisionJudge::refresh_stock() {
  const stock::RawShape raw = job_.scene.stock.body_W();
  if (!stock_body_) stock_body_ = std::make_unique<collision::StockBody>(job_.machine, raw.mesh_around());
  if (!stock_) stock_ = std::make_unique<stock::Stock>(raw, job_.scene.stock.voxel_mm);
  const std::vector<stock::CutterSolid> solids = sim::tool_solids(job_.scene);
  for (const program::Move& move : uncut_) {
    const int tool = move.tool < 0 ? 0 : tools_[static_cast<size_t>(move.tool)];
    if (move.rapid || tool < 0) continue;
    motion::BlockMotion motion;
    motion.block.from = move.from;
    motion.block.to = move.to;
    motion.block.arc = move.arc;
    motion.machine = &job_.machine.model;
    const std::vector<ToolPose> poses =
        motion::subdivide(motion, sim::lever_of(job_.scene.tools[static_cast<size_t>(tool)]),
                          job_.scene.stock.sweep_tolerance_mm, {job_.scene.program_file, move.line, 0});
    std::vector<stock::Sweep> sweeps;
    for (size_t i = 0; i + 1 < poses.size(); ++i) sweeps.push_back({poses[i], poses[i + 1], 0});
    stock_->cut(sweeps, solids[static_cast<size_t>(tool)]);
  }
  const bool changed = !uncut_.empty();
  uncut_.clear();
  if (changed || stock_body_->as_cut().nodes.empty()) stock_body_->refresh(*stock_);
}

void CollisionJudge::cut(std::span<const program::Move> moves) {
  uncut_.insert(uncut_.end(), moves.begin(), moves.end());
  known_.clear();
  if (!moves.empty()) tool_ = moves.back().tool < 0 ? 0 : tools_[static_cast<size_t>(moves.back().tool)];
}

std::optional<Collision> CollisionJudge::look_at(const post::PlannedStretch& planned,
                                                 const AxisValues* from) {
  const kinematics::MachineModel& machine = job_.machine.model;
  std::vector<Way> arrival, ways;  // what depends on `from`, and what does not
  std::vector<double> key;
  const int tool_before = tool_;
  std::optional<AxisValues> at = from == nullptr ? std::nullopt : std::optional<AxisValues>(*from);
  for (size_t i = 0; i < planned.steps.size(); ++i) {
    const post::PlanStep& step = planned.steps[i];
    const bool approach = step.kind == post::StepKind::kApproach;
    const bool changes = tool_ != step.tool || from == nullptr;
    std::vector<Corner> corners;
    if (approach) {
      corners = approach_corners(machine, at ? &*at : nullptr, tool_, step);
    } else {
      const bool legs =
          step.kind == post::StepKind::kRapid && machine.rapid == kinematics::RapidMotion::kDogLeg;
      if (at) corners.push_back({*at, step.tool});
      if (at && legs)
        for (const AxisValues& q : dog_leg(machine, *at, step.q)) corners.push_back({q, step.tool});
      if (corners.size() < 2) corners.push_back({step.q, step.tool});
    }
    for (size_t k = 0; k + 1 < corners.size(); ++k) {
      const int tool = corners[k + 1].tool;
      const bool appears = (from == nullptr && i == 0 && k == 0) || tool != corners[k].tool;
      const bool loads = approach && i == 0 && changes && machine.tool_change.has_value();
      const bool comes_down = approach && k + 2 == corners.size();
      const Way way{corners[k].q, corners[k + 1].q, i,       step.line,
                    tool,         approach,         appears, loads && !comes_down};
      (i == 0 && !comes_down ? arrival : ways).push_back(way);
    }
    tool_ = step.tool;
    key.insert(key.end(), step.q.data(), step.q.data() + step.q.size());
    key.push_back(static_cast<double>(step.kind));
    at = step.q;
  }
  tool_ = tool_before;  // until the stretch is taken (cut())
  if (std::optional<Collision> found = first_among(arrival)) return found;
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  return known_[key] = first_among(ways);
}

/// The earliest; of several in one step that of the first pair.
std::optional<Collision> CollisionJudge::first_among(const std::vector<Way>& ways) {
  // Where any pair comes to the raw stock the material has to be known: one look before, for all threads.
  const auto meets_raw = [&](const Pair& pair) {
    return pair.stock && std::any_of(ways.begin(), ways.end(), [&](const Way& way) {
             return is_there(bodies_[pair.a], way.tool) && is_there(bodies_[pair.b], way.tool) &&
                    (!pair.tool_stock || way.approach) && first_near(pair, {way}, 0, 1).has_value();
           });
  };
  std::vector<char> meets(pairs_.size());
  parallel_chunks(pairs_.size(), 1, [&](size_t i, size_t) { meets[i] = meets_raw(pairs_[i]) ? 1 : 0; });
  if (std::find(meets.begin(), meets.end(), 1) != meets.end()) refresh_stock();
  std::vector<std::optional<Collision>> found(pairs_.size());
  parallel_chunks(pairs_.size(), 1, [&](size_t i, size_t) {
    if (!pairs_[i].stock || meets[i] != 0) found[i] = first_of(pairs_[i], ways);
  });
  std::optional<Collision> first;
  for (std::optional<Collision>& one : found)
    if (one && (!first || one->step < first->step)) first = std::move(one);
  return first;
}

std::string CollisionJudge::inside_table() const {
  const auto stock = std::find_if(bodies_.begin(), bodies_.end(),
                                  [](const Body& one) { return one.kind == BodyKind::kStock; });
  for (const Body& body : bodies_) {
    if (body.kind != BodyKind::kLink || body.link != job_.machine.work_link) continue;
    const collision::Encounter pair = collision::encounter(job_.machine, *stock, body);
    const double depth =
        collision::deepest_overlap(pair, collision::BodyDepth(*stock), collision::BodyDepth(body),
                                   collision::home_of(job_.machine))
            .depth_mm;
    if (depth > sim::kInsideMm)
      return fmt::format("the work would stand {:.3f} mm inside {}", depth, body.name);
  }
  return {};
}

std::optional<Collision> CollisionJudge::full_turn(int axis) const {
  constexpr int kParts = 8;
  AxisValues home = collision::home_of(job_.machine);
  std::vector<Way> ways;
  for (int i = 0; i < kParts; ++i) {
    Way way{home, home, 0, 0, -2, false, false, false};
    way.q0[axis] = home[axis] + kTurn * i / kParts;
    way.q1[axis] = home[axis] + kTurn * (i + 1) / kParts;
    ways.push_back(way);
  }
  for (const Pair& pair : pairs_) {
    const auto rides = [&](size_t body) {
      return bodies_[body].kind == BodyKind::kStock || bodies_[body].kind == BodyKind::kFixture;
    };
    if ((!rides(pair.a) && !rides(pair.b)) || pair.tool_stock) continue;
    if (!is_there(bodies_[pair.a], -2) || !is_there(bodies_[pair.b], -2)) continue;
    if (const std::optional<size_t> near = first_near(pair, ways, 0, ways.size()))
      return told(pair, ways[*near], 0.0, true);
  }
  return {};
}

bool CollisionJudge::may_stand(const AxisValues& q, int tool) const {
  const std::vector<Way> still{{q, q, 0, 0, tool, false, false, false}};
  return std::none_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
    return !pair.stock && is_there(bodies_[pair.a], tool) && is_there(bodies_[pair.b], tool) &&
           first_near(pair, still, 0, 1).has_value();
  });
}

void CollisionJudge::begin_again() {
  stock_.reset();
  stock_body_.reset();
  known_.clear();
  uncut_.clear();
  tool_ = -2;
}

}  // namespace swarf::avoidance

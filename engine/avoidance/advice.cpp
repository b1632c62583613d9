#include "avoidance/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/units.h"
#include "collision/body_pairs.h"
#include "cutter/cutter.h"
#include "cutter/profile.h"
#include "post/shipped.h"
#include "program/cl/rewrite.h"
#include "program/source_text.h"
#include "sim/simulation.h"

namespace swarf::avoidance {
namespace {

/// Rays are held against so much less than the limit, for the proof between them has to end below it, um.
constexpr double kProofMarginUm = 0.2;

/// Nearer to a pole the outer rotary axis may stand anywhere, once digits are rounded, rad.
constexpr double kBesidePole = 1e-3;

/// What finds a fault.
enum class Check { kAxes, kMaterial, kGouge };

struct Fault {
  Failure failure;
  Check check = Check::kAxes;
  double depth_mm = 0.0;  ///< of a gouge
};

/// A position of the CL data with what a change goes by.
struct Place {
  program::ClPosition at;
  Vec3 feed_W = Vec3::UnitX();
  int tool = 0;  ///< index into Scene::tools
};

/// Changes by index of their places.
using Changes = std::map<size_t, PathChange>;

/// Whether the way says where the feed goes: not along the axis.
bool gives_feed(const program::Move& move) {
  const Vec3 way = move.to.tip_W - move.from.tip_W;
  return way.norm() > 1e-6 && way.cross(move.to.axis_W).norm() > 1e-3 * way.norm();
}

/// Of the move that ends there, else of the nearest one behind it, else before it; feeds before rapids.
Vec3 feed_at(const std::vector<program::Move>& moves, size_t next) {
  for (const bool rapids : {false, true}) {
    const auto fits = [&](const program::Move& move) { return (rapids || !move.rapid) && gives_feed(move); };
    const auto way = [](const program::Move& move) { return Vec3(move.to.tip_W - move.from.tip_W); };
    if (next > 0 && fits(moves[next - 1])) return way(moves[next - 1]);
    for (size_t i = next; i < moves.size(); ++i)
      if (fits(moves[i])) return way(moves[i]);
    for (size_t i = next; i-- > 0;)
      if (fits(moves[i])) return way(moves[i]);
  }
  return Vec3::Zero();
}

std::vector<Place> places_of(const sim::Job& job, const std::string& text) {
  std::vector<Place> places;
  const std::vector<program::Move>& moves = job.cl->moves;
  const std::vector<int> tools = sim::cl_tools(job);
  size_t next = 0;  // the first move behind the place
  for (program::ClPosition& at : program::positions_of(text, job.scene.program_file, job.scene.cl_options)) {
    while (next < moves.size() && moves[next].line <= at.line) ++next;
    Place place{std::move(at), feed_at(moves, next), 0};
    const Vec3 &a = place.at.pose.axis_W, across = place.feed_W - place.feed_W.dot(a) * a;
    if (across.norm() < 1e-9) place.feed_W = std::abs(a.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const int called = moves[next > 0 ? next - 1 : 0].tool;
    if (called >= 0) place.tool = std::max(tools[static_cast<size_t>(called)], 0);
    places.push_back(std::move(place));
  }
  return places;
}

/// The scene's job at the clamping and with the tools of the outcome.
sim::Job job_of(const Task& task, const Outcome& outcome) {
  sim::Job job = *task.job;
  if (outcome.found) {
    job.machine.model.X_MW.translation() = outcome.positions[outcome.best].origin_M;
    extend(job, outcome.extended_mm);
    return job;
  }
  if (const Attempt* farthest = farthest_attempt(outcome)) {
    job.machine.model.X_MW.translation() = farthest->origin_M;
    extend(job, farthest->extended_mm);
  }
  return job;
}

class Advisor {
 public:
  Advisor(const Task& task, const Outcome& outcome, Progress& progress)
      : job_(job_of(task, outcome)),
        progress_(progress),
        format_(format_of(*job_.scene.post)),
        text_(program::read_file(job_.scene.program_file)),
        places_(places_of(job_, text_)),
        judge_(job_, job_.scene.post->clearance_mm) {
    for (const cutter::Cutter& tool : job_.scene.tools) {
      outlines_.push_back(cutter::outline(tool));
      inverses_.emplace_back(kinematics::with_tool(job_.machine.model, cutter::gauge_length(tool)));
    }
  }

  Advice run() {
    progress_.begin("changes of the path", static_cast<double>(places_.size()), "positions");
    while (!progress_.stop_requested()) {
      const std::optional<Fault> fault = first_fault(changes_);
      if (!fault) {
        advice_.left = unproven(text_with(changes_));
        advice_.free = !advice_.left;
        break;
      }
      if (free_block(*fault)) continue;
      advice_.left = fault->failure;
      break;
    }
    progress_.end();
    advice_.text = text_with(changes_);
    for (const auto& [index, change] : changes_) {
      const Place& place = places_[index];
      advice_.blocks.push_back(
          {place.at.line, change, place.at.pose, pose_with(index, change), reasons_[index]});
    }
    return std::move(advice_);
  }

 private:
  ToolPose pose_with(size_t index, const PathChange& change) const {
    const Place& place = places_[index];
    return changed_pose(place.at.pose, place.feed_W, outlines_[static_cast<size_t>(place.tool)], change);
  }

  std::string text_with(const Changes& changes) const {
    std::map<int, ToolPose> poses;
    for (const auto& [index, change] : changes) poses[places_[index].at.line] = pose_with(index, change);
    return program::rewrite_cl(text_, job_.scene.program_file, poses, job_.scene.cl_options);
  }

  /// The first one, or one of the first behind `line`.
  std::optional<Failure> failure(Check check, const std::string& text, int line) {
    if (check == Check::kMaterial) return material_failure(job_with(text));
    if (check == Check::kGouge) return gouge_failure(text);
    judge_.begin_again();
    Trial trial(job_, format_, &judge_);
    trial.of_text(text);
    trial.stop_behind(line);
    if (job_.scene.post->best_routes) trial.follow_all(false);
    Progress silent;
    return trial.run(silent).failure;
  }

  /// The first gouge beyond [accept], by the line of its deepest place on the measuring rays.
  std::optional<Failure> gouge_failure(const std::string& text) {
    const std::optional<double> limit = job_.scene.accept.gouge_max_um;
    if (!job_.has_design() || !limit) return {};
    sim::Job job = job_with(text);
    job.scene.accept = {};  // without a limit nothing is proven, which takes the most time
    Progress silent;
    const sim::Result result = sim::simulate(job, {}, silent);
    std::optional<Failure> first;
    for (const measure::Region& region : result.main.surface.gouges) {
      if (region.worst_um <= *limit - std::min(kProofMarginUm, 0.1 * *limit) ||
          region.block >= result.main.rays.sources.size())
        continue;
      const auto element = static_cast<size_t>(result.main.rays.sources[region.block].element);
      const int line = result.main.path.elements.line(element);
      if (first && first->line <= line) continue;
      gouge_mm_ = region.worst_um * kMicrometre;
      first = Failure{"gouge", fmt::format("a gouge of {:.1f} um", region.worst_um), line, -1, {}};
    }
    return first;
  }

  /// Between the rays too, once nothing else is found.
  std::optional<Failure> unproven(const std::string& text) const {
    if (!job_.has_design() || !job_.scene.accept.gouge_max_um) return {};
    Progress silent;
    const sim::Result result = sim::simulate(job_with(text), {}, silent);
    const sim::Check* const check = sim::find_check(result.checks, "gouge");
    if (check == nullptr || check->outcome == sim::Outcome::kHolds) return {};
    return Failure{"gouge", check->what + " " + check->reason, 0, -1, {}};
  }

  sim::Job job_with(const std::string& text) const {
    sim::Job job = job_;
    Diagnostics diagnostics;
    job.cl = program::parse_cl(text, job.scene.program_file, diagnostics, job.scene.cl_options);
    diagnostics.throw_if_errors();
    return job;
  }

  std::optional<Fault> first_fault(const Changes& changes) {
    ++advice_.looks;
    const std::string text = text_with(changes);
    std::optional<Fault> first;
    for (const Check check : {Check::kAxes, Check::kMaterial, Check::kGouge}) {
      std::optional<Failure> found = failure(check, text, std::numeric_limits<int>::max());
      if (found && (!first || found->line < first->failure.line))
        first = Fault{std::move(*found), check, gouge_mm_};
    }
    return first;
  }

  /// Everything up to the fault's block is free with these changes. What found it is asked first.
  bool frees(const Changes& changes, const Fault& fault) {
    ++advice_.looks;
    const std::string text = text_with(changes);
    const auto is_free = [&](Check check) {
      const std::optional<Failure> found = failure(check, text, fault.failure.line);
      return !found || found->line > fault.failure.line;
    };
    if (!is_free(fault.check)) return false;
    for (const Check check : {Check::kAxes, Check::kMaterial, Check::kGouge})
      if (check != fault.check && !is_free(check)) return false;
    return true;
  }

  bool free_block(const Fault& fault) {
    const auto at = std::find_if(places_.begin(), places_.end(),
                                 [&](const Place& one) { return one.at.line == fault.failure.line; });
    if (at == places_.end()) return false;
    const auto index = static_cast<size_t>(at - places_.begin());
    progress_.advance(static_cast<double>(index));
    std::vector<std::vector<size_t>> windows{{index}};
    if (index > 0) windows.push_back({index - 1, index});
    if (index + 1 < places_.size()) windows.push_back({index, index + 1});
    if (repeat(index, fault)) {
      reasons_.try_emplace(index, fault.failure.text);
      return true;
    }
    for (const std::vector<size_t>& window : windows)
      if (lift_out(window, fault) || lean(window, fault) ||
          lift(window, fault, Advice::kLiftStepMm, Advice::kLiftMostMm)) {
        for (const size_t one : window) reasons_.try_emplace(one, fault.failure.text);
        return true;
      }
    return false;
  }

  Changes with(const std::vector<size_t>& window, ChangeKind kind, double amount) const {
    Changes changes = changes_;
    for (const size_t one : window) changes[one].of(kind) += amount;
    return changes;
  }

  /// As the place before, where less than that is not enough.
  bool repeat(size_t index, const Fault& fault) {
    const auto before = index > 0 ? changes_.find(index - 1) : changes_.end();
    if (before == changes_.end() || changes_.contains(index)) return false;
    const PathChange change = before->second;
    for (const ChangeKind kind : {ChangeKind::kLead, ChangeKind::kTilt, ChangeKind::kLift}) {
      const double amount = change.of(kind);
      if (amount == 0.0) continue;
      const double resolution =
          kind == ChangeKind::kLift ? Advice::kLiftResolutionMm : rad_from_deg(Advice::kResolutionDeg);
      const double less = amount - std::copysign(2.0 * resolution, amount);
      if (!frees(with({index}, kind, amount), fault) || frees(with({index}, kind, less), fault)) continue;
      changes_ = with({index}, kind, amount);
      return true;
    }
    return false;
  }

  /// The least amount between one that is not enough and one that is.
  double bisected(const std::vector<size_t>& window, ChangeKind kind, double less, double enough,
                  double resolution, const Fault& fault) {
    while (std::abs(enough - less) > resolution && !progress_.stop_requested()) {
      const double middle = 0.5 * (less + enough);
      const bool free = can_stand(window, kind, middle) && frees(with(window, kind, middle), fault);
      (free ? enough : less) = middle;
    }
    return enough;
  }

  /// Whether the axes can stand at all the window's places with this change. True where that is not known:
  /// beside a pole, where the outer axis is free.
  bool can_stand(const std::vector<size_t>& window, ChangeKind kind, double amount) const {
    const Changes changes = with(window, kind, amount);
    return std::all_of(window.begin(), window.end(), [&](size_t index) {
      const Place& place = places_[index];
      const ToolPose pose = pose_with(index, changes.at(index));
      const kinematics::InverseKinematics& inverse = inverses_[static_cast<size_t>(place.tool)];
      if (inverse.pole_distance(pose.axis_W) < kBesidePole) return true;
      const kinematics::InverseSolutions both = inverse.solve(pose, collision::home_of(job_.machine));
      return std::any_of(both.branch, both.branch + both.count, [&](const kinematics::Branch& one) {
        return one.outcome == kinematics::InverseOutcome::kSingular ||
               (one.outcome == kinematics::InverseOutcome::kOk && judge_.may_stand(one.q, place.tool));
      });
    });
  }

  struct Direction {
    ChangeKind kind;
    double sign;
    double blocked = 0.0;  ///< greatest angle that is known not to do, rad
  };
  struct Found {
    ChangeKind kind;
    double amount;
  };

  /// Least angle of one direction between `low` and `high` that frees, rad.
  std::optional<Found> lean_in_band(const std::vector<size_t>& window, const Fault& fault, Direction& way,
                                    double low, double high) {
    const double step = rad_from_deg(Advice::kStandDeg);
    const int steps = std::max(1, static_cast<int>(std::lround((high - low) / step)));
    const auto at = [&](int i) { return low + (high - low) * i / steps; };
    const auto stands = [&](int i) { return can_stand(window, way.kind, way.sign * at(i)); };
    for (int first = 1; first <= steps; ++first) {
      if (!stands(first)) {
        way.blocked = at(first);
        continue;
      }
      int last = first;
      while (last < steps && stands(last + 1)) ++last;
      // At its very end a range is nearest to what ends it; one that goes on is tried as far out as the band.
      const double tried = last == steps ? high : at((first + last) / 2);
      if (progress_.stop_requested()) return {};
      if (frees(with(window, way.kind, way.sign * tried), fault))
        return Found{way.kind, bisected(window, way.kind, way.sign * way.blocked, way.sign * tried,
                                        rad_from_deg(Advice::kResolutionDeg), fault)};
      way.blocked = tried;
      first = last;
    }
    return {};
  }

  bool lean(const std::vector<size_t>& window, const Fault& fault) {
    std::vector<Direction> ways;
    for (const ChangeKind kind : {ChangeKind::kLead, ChangeKind::kTilt})
      for (const double sign : {1.0, -1.0}) ways.push_back({kind, sign});
    const double width = fault.check == Check::kGouge ? Advice::kGougeBandDeg : Advice::kBandDeg;
    for (double low = 0.0; low < Advice::kLeanMostDeg; low += width) {
      std::optional<Found> least;
      for (Direction& way : ways) {
        const std::optional<Found> found = lean_in_band(
            window, fault, way, rad_from_deg(low), rad_from_deg(std::min(low + width, Advice::kLeanMostDeg)));
        if (found && (!least || std::abs(found->amount) < std::abs(least->amount))) least = found;
      }
      if (progress_.stop_requested()) return false;
      if (!least) continue;
      changes_ = with(window, least->kind, least->amount);
      return true;
    }
    return false;
  }

  /// A tip that is too deep is lifted, not leaned: by twice its depth where its axis stands 60 degrees off.
  bool lift_out(const std::vector<size_t>& window, const Fault& fault) {
    return fault.check == Check::kGouge && lift(window, fault, fault.depth_mm, 2.0 * fault.depth_mm);
  }

  bool lift(const std::vector<size_t>& window, const Fault& fault, double first, double most) {
    double less = 0.0;
    for (double lift = first; lift <= most * (1.0 + 1e-9); lift *= 2.0) {
      if (progress_.stop_requested()) return false;
      if (frees(with(window, ChangeKind::kLift, lift), fault)) {
        const double amount =
            bisected(window, ChangeKind::kLift, less, lift, Advice::kLiftResolutionMm, fault);
        changes_ = with(window, ChangeKind::kLift, amount);
        return true;
      }
      less = lift;
    }
    return false;
  }

  sim::Job job_;
  Progress& progress_;
  post::PostFormat format_;
  std::string text_;
  std::vector<Place> places_;
  CollisionJudge judge_;                                       ///< of one program after the other
  std::vector<std::vector<cutter::OutlineElement>> outlines_;  ///< by tool of the scene
  std::vector<kinematics::InverseKinematics> inverses_;        ///< the same
  Changes changes_;
  std::map<size_t, std::string> reasons_;
  double gouge_mm_ = 0.0;  ///< depth of the first one that was seen last
  Advice advice_;
};

}  // namespace

Advice advise(const Task& task, const Outcome& outcome, Progress& progress) {
  return Advisor(task, outcome, progress).run();
}

}  // namespace swarf::avoidance

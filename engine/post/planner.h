// From CL data to axis values: which solution of the inverse, where the axes unwind, how many blocks.
//
//  The CL moves are planned by stretches, which begin where the tool is out of the way: at the start, where
//  the tool changes, and at the end of a rapid that follows a rapid (the first one has lifted the tool).
//
//  1. Candidates: both solutions of the inverse at the stretch's first pose, each also a turn to either side.
//     The order is BranchChoice's: as it stands, by rotary travel from where the axes are.
//  2. The first candidate whose whole stretch can be driven is taken (Kruth et al.: switch where it costs
//     nothing). Where it is the continuous one the rapid is driven as it is; else the tool is retracted along
//     the machine's tool axis, the rotary axes turn, and it comes down again.
//  3. The same with the other side of poles that are passed: the last one before the fault first, then the
//     ones before it (the paper's backtracking; what stands before the pole is kept).
//  4. When none can, the fault of the first one is told, with its CL line.
//
//  StretchJudge may object to a stretch that the axes can drive (collisions): it is then a fault like the
//  others. With routes_most above 1 all ways are followed at once, and the quickest program is taken: dynamic
//  programming over the stretches, whose states are the rotary axes at their ends.
//
//  A stretch is held whole, about a kilobyte for each move, but no more than kMovesAhead moves of it: the
//  rest goes on from where they end, so memory does not grow with the file.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "post/follow.h"
#include "post/plan.h"
#include "post/plane_runs.h"
#include "program/control/work_space.h"

namespace swarf::post {

/// A tool with what the plan needs of it.
struct PostTool {
  int number = 0;
  std::string name;
  double length_mm = 0.0;  ///< gauge line to tip
};

/// A candidate for the start of a stretch.
struct Start {
  kinematics::AxisValues q;
  bool continuous = false;  ///< the rapid goes there without a turn more than its poses ask for
};
/// Puts the candidates of a stretch in the order in which they are tried, or takes some out. Later rules
/// (collisions, dynamic programming over stretches) stand here. The moves are those of the stretch.
using BranchChoice =
    std::function<void(std::span<const program::Move> stretch, std::vector<Start>& candidates)>;

/// Why a stretch that the axes can drive may not be taken.
struct Objection {
  size_t step = 0;  ///< of the stretch: what comes before it is not objected to
  FollowFault fault;
};
/// `from`: where the axes stand before it; null: nobody knows, it is the first one.
using StretchJudge = std::function<std::optional<Objection>(const PlannedStretch& planned,
                                                            const kinematics::AxisValues* from)>;

/// The way that was taken through a stretch.
struct RouteChoice {
  Start start;
  bool lifted = false;          ///< it begins with an approach
  std::vector<PoleSide> sides;  ///< of the poles that it leaves, up to the last one that turns
};

/// A way through a stretch that was tried.
struct RouteTry {
  int first_line = 0, last_line = 0;  ///< of the CL data
  RouteChoice way;
  double time_s = 0.0;  ///< of the stretch, as far as it came
  FollowFault fault;    ///< code "": it can be driven
  int fault_line = 0;
};

/// What others have to say on the ways that are taken.
struct PlannerHooks {
  BranchChoice choice;  ///< none: as the candidates stand
  StretchJudge judge;   ///< none: what the axes can drive is taken
  std::function<void(std::span<const program::Move> stretch)> planned;  ///< a stretch is done with; or none
  std::function<void(const RouteTry&)> tried;                           ///< or none
  const std::vector<RouteChoice>* decided = nullptr;  ///< of each stretch: no other way is tried; null: none
  size_t faults_most = 20;
  std::function<double(const PlanSummary&)> cost;  ///< what the best of all ways has least of; none: its time
  size_t routes_most = 1;  ///< 1: the first way that can be driven; else so many are held at most
};

struct PlannerSetup {
  kinematics::MachineModel machine;
  std::vector<PostTool> tools;  ///< by the program's own order of calls grows; index -1: the spindle is empty
  FollowRules rules;
  PostAbilities abilities;
  PlannerHooks hooks;
};

/// The linear axis that runs along the tool with all axes at zero: the way out before a tool is changed.
/// Throws InputError "approach-axis" where the machine has none.
int axis_along_tool(const kinematics::MachineModel& machine);
/// Where that axis stands when the tool is out of the way: where tools are changed, or at home.
double retracted(const kinematics::MachineModel& machine);

/// Moves that the start of a stretch is chosen by.
inline constexpr size_t kMovesAhead = 50'000;

/// Takes the planned stretches in their order.
using StretchSink = std::function<void(const PlannedStretch&)>;

class Planner final : public program::ClSink {
 public:
  /// `tool_of`: index into setup.tools for an index into ClProgram::tools. All must outlive it.
  Planner(const PlannerSetup& setup, std::string file, StretchSink sink, Diagnostics& diagnostics);

  void move(const program::Move& move) override;
  void hole(const program::ClHole& hole) override;
  void note(program::ClNote note) override;
  /// The last stretch.
  void finish();
  /// What a tool index of the CL data means; called when a move has a new one.
  std::function<int(int cl_tool)> tool_of;
  const PlanSummary& summary() const { return routes_.front().state.summary; }
  /// The way through each stretch, for PlannerHooks::decided.
  const std::vector<RouteChoice>& choices() const { return routes_.front().choices; }
  /// Ways that were given up for routes_most; 0: the program is the quickest of all.
  long routes_dropped() const { return routes_dropped_; }

 private:
  /// What the stretches so far have left.
  struct State {
    kinematics::AxisValues q = kinematics::AxisValues::Zero();
    bool started = false, approach_next = true, tool_changed = false;
    PlanSummary summary;
    std::shared_ptr<const TiltedPlane> tilt;
  };
  struct Plan {
    PlannedStretch stretch;
    PoleSides poles;
    std::vector<size_t> pole_steps;  ///< steps that there were when each pole had been left
    kinematics::AxisValues q;
    RouteChoice way;
    std::optional<FollowFault> fault;
    int fault_line = 0;
    size_t fault_step = 0;
    PlanSummary summary;
    std::vector<PlaneRun> runs;
    size_t run = 0;  ///< of runs, the next one
    std::shared_ptr<const TiltedPlane> tilt;
  };
  using TakePlan = std::function<bool(Plan)>;  ///< true: no other one is wanted
  /// A program up to here.
  struct Route {
    State state;
    std::vector<std::shared_ptr<const PlannedStretch>> stretches;  ///< that the sink has not had
    std::vector<RouteChoice> choices;                              ///< of all of them
  };
  /// Where the stretch is entered, and the first move that is still to be driven from there.
  struct Entry {
    ToolPose pose;
    size_t first = 0;
    bool approach = false;
  };
  void plan_stretch();
  void plan_moves();
  void tell(const FollowFault& fault, int line);
  std::vector<Start> candidates(const State& state, const Entry& entry) const;
  Entry entry(const State& state) const;
  Plan plan_from(const State& state, const Entry& entry, RouteChoice way) const;
  Plan judged_plan(const State& state, const Entry& entry, RouteChoice way) const;
  void tell_tried(const State& state, const Plan& plan) const;
  std::optional<Plan> each_plan(const State& state, const TakePlan& take) const;
  Plan no_start(const State& state, const Entry& entry) const;
  void go_on(Route longer, Plan plan, std::vector<Route>& routes) const;
  void keep_best(std::vector<Route>& routes);
  bool add_move(const program::Move& move, Plan& plan) const;
  bool add_arc(const program::Move& move, Plan& plan) const;
  bool add_hole(const HoleSpan& span, Plan& plan) const;
  size_t add_span(const HoleSpan& span, size_t at, std::vector<size_t>& steps_before, Plan& plan) const;
  void change_plane(size_t move, Plan& plan) const;
  void stand(const program::Move& move, Plan& plan) const;
  void add_approach(const program::Move& move, const ToolPose& pose, const kinematics::AxisValues& q,
                    bool started, Plan& plan) const;
  PlanStep step_at(const program::Move& move, const ToolPose& pose, const kinematics::AxisValues& q,
                   StepKind kind, bool tcp, const std::shared_ptr<const TiltedPlane>& tilt) const;
  void add_step(PlanStep step, double way_mm, Plan& plan) const;
  void without_tcp(size_t first, Plan& plan) const;
  void use_tool(int tool);

  const PlannerSetup& setup_;
  std::string file_;
  StretchSink sink_;
  Diagnostics& diagnostics_;
  std::vector<Route> routes_;
  long routes_dropped_ = 0;
  size_t faults_ = 0;

  std::vector<program::Move> moves_;
  std::vector<HoleSpan> holes_;
  std::vector<PlacedNote> notes_;
  int in_hole_ = 0;  ///< moves of a hole that are still to come
  bool last_rapid_ = false;

  int cl_tool_ = -2, tool_ = -1;
  std::optional<Follower> follower_;
  mutable std::optional<program::nc::WorkSpace> space_;
  std::optional<program::ClHole> next_hole_;
};

}  // namespace swarf::post

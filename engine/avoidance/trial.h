// One program at one clamping position with one set of tools: planned, looked at, and why it cannot be
// driven.
#pragma once

#include <atomic>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "avoidance/collision_judge.h"
#include "base/progress.h"
#include "post/post.h"
#include "post/preference.h"
#include "sim/job/scene.h"

namespace swarf::avoidance {

/// Why a program cannot be driven.
struct Failure {
  std::string code, text;  ///< "collision", or as post::FollowFault
  int line = 0;            ///< of the CL data
  int tool = -1;           ///< index into Scene::tools
  std::vector<Remedy> remedies;
};

/// A way through a stretch that was tried, with what was found.
struct TriedWay {
  int first_line = 0, last_line = 0;
  std::string way;      ///< "B 20.000 C 0.000, lifted; C turns at pole 1"
  std::string outcome;  ///< "": taken
  int line = 0;         ///< of the fault
  double time_s = 0.0;
};

/// The program at one clamping position with one set of tools.
struct Attempt {
  Vec3 origin_M = Vec3::Zero();
  std::vector<double> extended_mm;  ///< by tool of the scene
  std::vector<TriedWay> tries;      ///< kTriesMost at most; all of them are counted
  size_t tried = 0;
  std::optional<Failure> failure;  ///< none: the program is free
  post::PlanSummary plan;
  std::vector<post::RouteChoice> choices;
  double slides_mm = 0.0;  ///< sum of the movements of the linear axes
  std::string action;      ///< what CONTROL did about the failure
  static constexpr size_t kTriesMost = 2000;
};

/// As the scene's [post] has it.
post::PostOptions options_of(const sim::Job& job);
/// The words of the scene's post, in the scene's unit.
post::PostFormat format_of(const sim::PostSettings& settings);
/// What the best of all ways has least of: as the scene's [post] says, else as its post, else time.
post::Preference preference_of(const sim::PostSettings& settings, const post::PostFormat& format);
/// Tools stand out so much farther, by tool of the scene.
void extend(sim::Job& job, const std::vector<double>& extended_mm);

/// Neck, shank or holder in the material, as the job's CL data cut it: the same on every machine and with
/// every solution of the axes. The first place.
std::optional<Failure> material_failure(const sim::Job& job);

/// One program, planned with a judge or without.
class Trial {
 public:
  /// All must outlive it.
  Trial(const sim::Job& job, const post::PostFormat& format, CollisionJudge* judge);

  /// All ways at once; the one that the post prefers (time), or that of the least slide movements.
  void follow_all(bool by_slides);
  /// Instead of the scene's CL data; must outlive it.
  void of_text(const std::string& text) { options_.cl_text = &text; }
  /// Stretches that begin behind this line of the CL data are not asked for: without a failure all before
  /// them is free.
  void stop_behind(int line) { last_line_ = line; }

  /// Throws InputError for CL data that cannot be read.
  Attempt run(Progress& progress);
  long dropped() const { return dropped_; }

 private:
  std::optional<post::Objection> object(const post::PlannedStretch& planned,
                                        const kinematics::AxisValues* from);
  void add(const post::RouteTry& way);
  Failure failure_of(const post::RouteTry& way) const;
  Failure joined_failure() const;

  const sim::Job& job_;
  post::PostFormat format_;
  CollisionJudge* judge_;
  post::PostOptions options_;
  Attempt attempt_;
  std::optional<Collision> collision_;
  std::vector<Failure> failures_;  ///< of the stretch that is being planned
  bool passed_ = false, failed_ = false;
  int last_line_ = std::numeric_limits<int>::max();
  std::atomic<bool> far_enough_ = false;
  long dropped_ = 0;
};

}  // namespace swarf::avoidance

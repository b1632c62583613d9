// By what the rotary solutions of a whole program are chosen, and what is told of the choice.
//
// The planner follows all ways at once (PlannerHooks::routes_most): dynamic programming over the stretches,
// whose states are the axes at their ends. A solution is held through a stretch, so through every connected
// cut; it changes where the tool is lifted, or at rest at a pole.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "post/planner.h"

namespace swarf::post {

/// What the whole program has least of. What is equal is decided by time.
enum class Preference {
  kTime,      ///< feeds, rapids and dwells
  kAccuracy,  ///< proven bound of the tip: chords and digits, which long arms make worse
  kTravel,    ///< slide movements of the linear axes together
};

/// Of "time", "accuracy", "travel"; none for another word.
std::optional<Preference> preference(std::string_view word);
/// "the least time".
const char* preference_text(Preference preferred);
/// "12.3 s", "4.1 um", "830.0 mm".
std::string preference_value(Preference preferred, const kinematics::MachineModel& machine,
                             const PlanSummary& plan);
/// Of PlannerHooks::cost.
double preference_cost(Preference preferred, const kinematics::MachineModel& machine,
                       const PlanSummary& plan);
/// Sum of the movements of the linear axes, mm.
double slides_of(const kinematics::MachineModel& machine, const PlanSummary& plan);

/// Ways that are held at once: more of them are given up, the dearest first.
inline constexpr size_t kRoutesMost = 64;

/// "B 20.000 C 0.000, lifted before; turns at pole 1".
std::string way_text(const kinematics::MachineModel& machine, const RouteChoice& way);

/// What became of the ways through the stretches.
class RouteLog {
 public:
  explicit RouteLog(const kinematics::MachineModel& machine) : machine_(machine) {}
  void add(const RouteTry& tried);

  struct Refusal {
    std::string way, why;
    int line = 0;
  };
  struct Stretch {
    int first_line = 0, last_line = 0;
    std::map<std::string, bool> ways;  ///< by their text: whether any program could drive it
    std::vector<Refusal> refusals;     ///< the first one of each way
  };
  const std::vector<Stretch>& stretches() const { return stretches_; }
  /// One line for each stretch: what was taken, and why others were not.
  std::vector<std::pair<std::string, std::string>> lines(const std::vector<RouteChoice>& taken) const;

 private:
  const kinematics::MachineModel& machine_;
  std::vector<Stretch> stretches_;
};

}  // namespace swarf::post

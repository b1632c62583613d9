// CL data to an NC program: plan and writing together, streamed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/progress.h"
#include "base/units.h"
#include "post/planner.h"
#include "post/post_format.h"
#include "post/writer.h"

namespace swarf::post {

struct PostOptions {
  std::optional<bool> tcp;              ///< none: as the format says, off on machines without two rotary axes
  double tip_mm = 0.01;                 ///< of the tip from the CL data, written digits included; without TCP
  double axis_rad = 0.1 * kPi / 180.0;  ///< of the tool axis from its great circle
  program::ClOptions cl;
  const std::string* cl_text = nullptr;  ///< instead of the file's own text, which it then only names
  std::optional<PlaneUse> planes;        ///< none: as the format says
  std::vector<PostTool> tools;           ///< the table; empty: lengths are not known
  PlannerHooks hooks;
};

struct PostResult {
  PlanSummary plan;
  WriterSummary written;
  bool tcp = false;
  FollowRules rules;                 ///< as they were kept to
  std::vector<RouteChoice> choices;  ///< of each stretch
  long routes_dropped = 0;           ///< Planner::routes_dropped()
};

/// What a format can do, for the planner.
PostAbilities abilities_of(const PostFormat& format);

/// Writes the program piece by piece to `out`. Throws InputError with the first faults of the CL data, of the
/// plan ("travel", "unreachable", "axis-jump", "tolerance-below-digits", "tool-length", "unknown-tool",
/// "no-tcp", "approach-axis"), of the writing ("tool-number", "feed-below-digits"); what has gone to `out` is
/// then no program. Warnings go to `diagnostics`.
PostResult post(const std::string& cl_file, const kinematics::MachineModel& machine, const PostFormat& format,
                const PostOptions& options, const Writer::Out& out, Progress& progress,
                Diagnostics& diagnostics);

}  // namespace swarf::post

// The part that a tool is set down on: any number of meshes and patches, and a floor under upright tools.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "position/patch_target.h"
#include "position/rest.h"
#include "position/tool_profile.h"

namespace swarf::position {

/// Where a part was touched last: the search begins there. It never changes a result.
struct Near {
  int triangle = -1;
  PatchHint patch;
};

/// Something that stops a tool.
class Target {
 public:
  virtual ~Target() = default;
  /// Raises `best` where this stops the tool higher than it already is. Allocates nothing.
  virtual void raise(const ToolProfile& profile, const GuideLine& line, Rest& best, Near& near) const = 0;
};

struct Part {
  std::vector<std::shared_ptr<const Target>> targets;
  /// A level plane that stops tools whose axis points up, mm in W; none: where no target stops it, a tool
  /// rests on nothing.
  std::optional<double> floor_mm;

  /// Where the tool comes to rest along the line; the highest of all.
  Rest rest(const ToolProfile& profile, const GuideLine& line, Near& near) const;
};

}  // namespace swarf::position

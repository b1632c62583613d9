// What determines a cut stock, part by part, so that a saved stock or a record knows what it belongs to, and
// a difference can be named.
#pragma once

#include <string>
#include <vector>

#include "sim/job/scene.h"
#include "sim/run/carried_cuts.h"
#include "sim/run/cut_sweeps.h"

namespace swarf::sim {

/// Counts up whenever equal sweeps may leave other bits in the stock: saved stocks then belong to the past.
inline constexpr int kCutAlgorithm = 3;

struct IdentityPart {
  std::string name;   ///< "stock.voxel_mm", "program", ...
  std::string value;  ///< to be read and compared; files and long lists by their hash
};
using CutIdentity = std::vector<IdentityPart>;

/// The last part, kMotionPart, is the hash of the sweeps themselves and of their tools: whatever else may
/// differ shows there.
/// `carried`: what earlier set-ups have cut.
CutIdentity cut_identity(const Job& job, const CutSweeps& sweeps, const CarriedCuts& carried);
inline constexpr const char* kMotionPart = "tool motion";

/// The tools with everything that decides on what they cut and touch.
std::string tools_text(const std::vector<cutter::Cutter>& tools);

struct IdentityDifference {
  std::string name, before, now;
};
/// Every part whose value differs or is missing. The motion is named only when nothing else explains it.
std::vector<IdentityDifference> differences(const CutIdentity& before, const CutIdentity& now);

/// Parts that must be equal for two cuts to be compared block by block: algorithm, box, voxel, tools.
bool needed_to_compare(const std::string& part_name);

}  // namespace swarf::sim

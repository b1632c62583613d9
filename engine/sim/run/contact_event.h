// What the tool must not do and did: contacts of neck, shank and holder with the material, and material taken
// by moves that must not take any. A row of blocks is one event, with its places in the program and in space.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/frames.h"

namespace swarf::sim {

/// An instant of the program.
struct ContactPlace {
  int element = 0;  ///< index into ToolPath::elements
  double t_s = 0.0;
};

struct ContactEvent {
  std::string part;  ///< "neck", "shank", "holder", "flutes"
  int tool = 0;      ///< index into Scene::tools
  ContactPlace first;
  int last_element = 0;   ///< the last block of the row
  double depth_mm = 0.0;  ///< greatest of them; see stock::Contact
  ContactPlace deepest;
  Vec3 deepest_W = Vec3::Zero();  ///< on the part, where it stands deepest
};

/// Of a whole program.
struct ToolClearance {
  size_t checked_sweeps = 0;         ///< each over its whole way
  std::vector<ContactEvent> events;  ///< by their first blocks
  double nearest_mm = 0.0;           ///< least gap seen, 0 in contact; up to band_mm
  double band_mm = 0.0;              ///< gaps are looked for up to here
  /// Every contact this deep is found: a voxel (see stock::ContactFinder), and what the sweeps err by at the
  /// tool's far end.
  double sees_mm = 0.0;
};

enum class BadCutKind {
  kRapid,            ///< the move is a rapid
  kSpindleStands,    ///< S is 0, M3 is missing
  kSpindleReversed,  ///< M4 with a right-hand tool, M3 with a left-hand one
};

/// Neighbouring rapids in material are one; of a row of feed moves with the same wrong spindle the first
/// block that cuts is kept, and the row's last block.
struct BadCut {
  BadCutKind kind = BadCutKind::kRapid;
  ContactEvent event;
};

/// For stock files, numbers as the shortest decimals that read back to the same bits; and back, false: not
/// such a text.
std::string clearance_text(const ToolClearance& clearance);
bool parse_clearance(const std::string& text, ToolClearance& clearance);
std::string bad_cuts_text(const std::vector<BadCut>& cuts);
bool parse_bad_cuts(const std::string& text, std::vector<BadCut>& cuts);

}  // namespace swarf::sim

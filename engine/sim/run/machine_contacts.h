// Everything that moves against everything else: links, fixtures, tools and the raw stock, over the whole
// motion.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "collision/path_check.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// What a body is called and is.
struct ContactBody {
  std::string name;  ///< of the link or fixture; "holder", with several tools "holder of T3"; "stock"
  collision::BodyKind kind = collision::BodyKind::kLink;
};

/// Of a whole program.
struct MachineContacts {
  std::vector<ContactBody> bodies;   ///< what the pairs count in
  collision::PathFindings findings;  ///< of all pairs but those of the tool with the stock (tool_clearance.h)
  std::vector<std::string> without_mesh;  ///< links that are not looked at: machine.toml gives them no mesh
  std::vector<Diagnostic> warnings;
  double near_miss_mm = 0.0;  ///< gaps are looked for up to here

  /// The stock is looked at as it is before the first cut: what touches it may be free of it by then.
  bool with_stock(const collision::PairFindings& pair) const;
  uint64_t contacts(bool with_stock) const;
  /// Of all pairs; null: none came as near as near_miss_mm.
  const collision::PairFindings* nearest() const;
};

/// Takes the cycles of the job's program in their order.
class MachineContactCheck {
 public:
  /// Flutes stand for a polygon of their outline, inside it by no more.
  static constexpr double kOutlineMm = 1e-3;

  /// `job` must outlive it.
  explicit MachineContactCheck(const Job& job);
  void add(std::span<const motion::Cycle> window) { check_->add(window); }
  MachineContacts finish();

 private:
  MachineContacts contacts_;
  std::unique_ptr<collision::PathCheck> check_;
};

}  // namespace swarf::sim

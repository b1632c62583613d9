// Everything that moves against everything else: links, fixtures, tools and the raw stock, over the whole
// motion. What comes to the raw stock is looked at again when that is cut (stock_contacts.h).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/path_check.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// Links, fixtures, the parts of every tool of the scene, which stand in the spinning flutes' outline, and
/// the raw stock.
std::vector<collision::Body> contact_bodies(const Job& job);

/// What the scene says of their pairs, by the bodies' own names. Throws InputError "unknown-body" where it
/// names what none of them is called, "pair-never-moves" where no axis lies between the two, and
/// "pair-of-tool-and-stock", for those are judged as collisions.
collision::PairRules contact_rules(const Job& job, const std::vector<collision::Body>& bodies);

/// What a body is called and is.
struct ContactBody {
  std::string name;  ///< of the link or fixture; "holder", with several tools "holder of T3"; "stock"
  collision::BodyKind kind = collision::BodyKind::kLink;
};

/// A link or fixture comes to the raw stock, which may be cut away there by then.
struct StockSuspect {
  size_t pair = 0;  ///< index into PathFindings::pairs
  collision::CycleSpan cycles;
};

enum class StockVerdict : uint8_t {
  kClear,    ///< of all that is left: proven
  kOpen,     ///< neither is proven
  kContact,  ///< deeper than a voxel in what is left
};

/// What came of a suspect that is not clear.
struct StockEvent {
  StockSuspect suspect;
  StockVerdict verdict = StockVerdict::kOpen;
  /// Of a contact: where it first touches the mesh of the material as it stood when the contact was found,
  /// which lies within a voxel of it; of an open one: the way that is not clear.
  collision::PathPlace first;
  int last_element = 0;         ///< of the suspect
  double depth_mm = 0.0;        ///< greatest that was looked at: at nine instants of five ways at most
  Vec3 place_M = Vec3::Zero();  ///< on the body, there
  Vec3 first_M = Vec3::Zero();  ///< on the body, at `first` of a contact
};

/// The suspects of a program against what is left of the stock.
struct StockContacts {
  uint64_t suspects = 0;           ///< stretches of cycles, of pairs
  std::vector<StockEvent> events;  ///< those that are not clear, by their first cycle
  double seen_mm = 0.0;            ///< gaps of this and more beside a face are proven to be clear
  int looks = 0;                   ///< meshes of the stock that were made
  bool unseen = false;             ///< some could not be looked at, and are open for that
  uint64_t count(StockVerdict verdict) const;
};

/// Of a whole program.
struct MachineContacts {
  std::vector<ContactBody> bodies;   ///< what the pairs count in
  collision::PathFindings findings;  ///< of all pairs but those of the tool with the stock (tool_clearance.h)
  std::vector<std::string> without_mesh;  ///< links that are not looked at: machine.toml gives them no mesh
  /// Their pairs, but for links that guide them and what no axis parts from them: not looked at either.
  std::vector<collision::NamePair> without_mesh_pairs;
  std::vector<Diagnostic> warnings;
  double near_miss_mm = 0.0;   ///< gaps are looked for up to here at least
  collision::PairRules rules;  ///< of the scene

  std::vector<StockSuspect> suspects;        ///< by their first cycles, then by pair
  std::map<size_t, collision::Body> shapes;  ///< of the bodies of suspects, by index into `bodies`
  std::optional<StockContacts> as_cut;       ///< none: the suspects are held against the raw stock alone

  bool with_stock(const collision::PairFindings& pair) const;
  /// Index into `bodies` of what comes to the stock.
  size_t beside_stock(const collision::PairFindings& pair) const;
  /// But for those with the stock.
  uint64_t contacts() const;
  /// With the stock: proven ones, and those of which nothing is proven.
  uint64_t stock_contacts() const { return as_cut ? as_cut->count(StockVerdict::kContact) : 0; }
  uint64_t stock_open() const { return as_cut ? as_cut->count(StockVerdict::kOpen) : suspects.size(); }
  /// Of all pairs but those that come to the raw stock; null: none came as near as near_miss_mm.
  const collision::PairFindings* nearest() const;
};

/// Takes the cycles of the job's program in their order.
class MachineContactCheck {
 public:
  /// `job` must outlive it.
  explicit MachineContactCheck(const Job& job);
  void add(std::span<const motion::Cycle> window) { check_->add(window); }
  MachineContacts finish();

 private:
  void find_suspects();

  MachineContacts contacts_;
  std::unique_ptr<collision::PathCheck> check_;
};

}  // namespace swarf::sim

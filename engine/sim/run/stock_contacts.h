// Links and fixtures against the stock as it stands, on the cycles on which they come to the raw one.
//
//   motion pass   raw stock: suspects, cycles in which a body touches it (elsewhere it is clear for ever)
//   cut stage     ---sweeps---> due: the stock's mesh ---sweeps---> due: ...
//
//   1. A suspect is due before the sweep that is under way in its first cycle: the stock then holds all that
//      is there in this cycle and later. Ways from cycle to cycle that are clear of it are done with, up to
//      the first one that is not; that one sets the next date, by the same rule.
//   2. A way that is not clear at its own date is held against the stock behind the sweeps that are under way
//      in it, which is there all the while: a body that stands deeper than a voxel in it is a contact; else
//      it stays open. Four more ways of the suspect, spread evenly, are then looked at like this.
//   3. One look at the stock serves all suspects. At most kLooksMost are made; what is not clear of the last
//      one is open then.
//
// Where the dates lie depends on motion and sweeps alone, not on where a run began or what it saves.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "collision/stock_body.h"
#include "sim/run/cut_sweeps.h"
#include "sim/run/machine_contacts.h"

namespace swarf::sim {

class StockContactCheck {
 public:
  static constexpr int kLooksMost = 100;
  static constexpr uint64_t kDeeper = 4;  ///< ways after the first one that is not clear

  /// `contacts`: of the motion; null: nothing was looked at. All must outlive it.
  StockContactCheck(const Job& job, const MachineContacts* contacts, const motion::Cycles& cycles,
                    const CutSweeps& sweeps);

  /// Number of sweeps after which look() is due; far away when nothing is left to look at.
  size_t due() const { return due_; }
  /// The stock after due() sweeps.
  void look(const stock::Stock& stock);

  /// For stock files: how far it is, and of what.
  std::string text() const;
  /// Goes on from the text of another run after so many sweeps. Where other bodies or another motion were
  /// looked at, suspects of those sweeps stay open. False: it is no such text.
  bool resume(const std::string& text, size_t sweeps);

  /// None: there was nothing to look at. What is still due counts as open.
  std::optional<StockContacts> result() const;

 private:
  struct Suspect {
    StockSuspect of;
    uint64_t next = 0;       ///< the way that is looked at next, by its first cycle
    uint64_t not_clear = 0;  ///< the first way that is not, once `blocked`
    uint64_t looked_at = 0;  ///< ways since then
    bool blocked = false, done = false;
    StockVerdict verdict = StockVerdict::kOpen;
    uint64_t cycle = 0;  ///< StockEvent::first
    double depth_mm = 0.0;
    Vec3 place_M = Vec3::Zero();
    double share = 0.0;  ///< of the way from `cycle`, StockEvent::first
    Vec3 first_M = Vec3::Zero();
    size_t due = 0;
  };

  size_t sweeps_before(uint64_t cycle) const;
  size_t sweeps_behind(uint64_t way) const;
  std::vector<collision::AxisValues> places(uint64_t first, uint64_t last) const;
  const collision::Body& body_of(const Suspect& suspect) const;
  uint64_t last_way(const Suspect& suspect) const;
  void set_due(Suspect& suspect) const;
  void look_at(Suspect& suspect, size_t sweeps) const;
  void pass_clear_ways(Suspect& suspect) const;
  void find_first(Suspect& suspect) const;
  void judge_way(Suspect& suspect) const;
  void close();
  uint64_t identity() const;
  bool read(std::istream& in);

  const MachineContacts* contacts_;
  const CutSweeps& sweeps_;
  const motion::Cycles& cycles_;
  mutable motion::CycleReader reader_;
  std::optional<collision::StockBody> body_;
  std::vector<Suspect> suspects_;
  size_t due_ = 0;  ///< sweeps
  int looks_ = 0;
  bool unseen_ = false;
  double seen_mm_ = 0.0;
};

}  // namespace swarf::sim

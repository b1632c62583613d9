// Instants of sweeps as places in the program, and contacts as events.
#pragma once

#include <string>

#include "sim/run/contact_event.h"
#include "sim/run/cut_sweeps.h"

namespace swarf::stock {
struct Contact;
}

namespace swarf::sim {

/// Where an instant of a sweep lies in the program: sweeps may join many blocks. Not to be shared by threads.
class SweepPlaces {
 public:
  /// All must outlive it.
  SweepPlaces(const CutSweeps& sweeps, const motion::Cycles& cycles)
      : sweeps_(sweeps), cycles_(cycles), reader_(cycles) {}

  /// `sweep`: its number; t from 0 to 1 along it. The block is exact where blocks are
  /// merged, the time that of the control cycles.
  ContactPlace at(size_t sweep, double t) const;
  /// Cycles that end inside the sweep: after `first`, up to `last`.
  struct Range {
    size_t first, last;
  };
  Range cycles(size_t sweep) const;
  /// How far along the sweep the tool stands in a cycle.
  double progress(size_t sweep, size_t cycle) const;
  const motion::Cycle& cycle(size_t k) const { return reader_.at(k); }

 private:
  double progress(const stock::Sweep& sweep, const ToolPose& pose) const;
  SweepSource source(size_t sweep) const { return sweeps_.source(sweep); }

  const CutSweeps& sweeps_;
  const motion::Cycles& cycles_;
  mutable motion::CycleReader reader_;
};

/// A contact of one sweep as an event of its own.
ContactEvent event_of(const std::string& part, int tool, const stock::Contact& contact,
                      const SweepPlaces& places, size_t sweep);
/// True when the event goes on where `before` ends: the same part of the same tool, and no block between.
bool goes_on(const ContactEvent& before, const ContactEvent& event);
void join(ContactEvent& before, const ContactEvent& event);

}  // namespace swarf::sim

// CUTCOM of CL data whose points are the part's contour: the core's cutter compensation (control/contour.h)
// on straight moves and arcs with a standing tool axis.
#pragma once

#include <functional>
#include <string>

#include "program/control/contour.h"

namespace swarf::program {

class ClCompensation final : public nc::ContourHost {
 public:
  /// `emit` takes the compensated segments in order. Faults are thrown as InputError at the place of at().
  ClCompensation(std::string file, nc::Plane plane, std::function<void(const nc::Segment&)> emit)
      : file_(std::move(file)), plane_(plane), emit_(std::move(emit)), contour_(*this) {}
  ClCompensation(const ClCompensation&) = delete;
  ClCompensation& operator=(const ClCompensation&) = delete;

  void start(nc::Compensation side, double radius_mm) { contour_.set_side(side, radius_mm, place_.column); }
  /// The next move in the plane leads out.
  void stop() { contour_.set_side(nc::Compensation::kOff, 0.0, place_.column); }
  void add(const nc::Segment& programmed) { contour_.add(programmed); }
  void flush() { contour_.flush(); }
  bool on() const { return contour_.side() != nc::Compensation::kOff; }
  /// Neither on nor waiting for its lead-out.
  bool done() const { return !on() && !contour_.leading_out(); }
  nc::Compensation side() const { return contour_.side(); }

  nc::Plane plane() const override { return plane_; }
  const nc::DialectWords& words() const override { return words_; }
  void at(int file, int line, int column) override { place_ = {file, line, column}; }
  [[noreturn]] void fail(const char* code, int column, std::string text, std::string fix) const override;
  void emit(const nc::Segment& segment) override { emit_(segment); }

 private:
  std::string file_;
  nc::Plane plane_;
  std::function<void(const nc::Segment&)> emit_;
  nc::DialectWords words_{.compensation_off = "CUTCOM/OFF", .feed_move = "a feed"};
  nc::Contour contour_;
  nc::Place place_;
};

}  // namespace swarf::program

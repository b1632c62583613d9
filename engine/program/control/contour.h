// Cutter radius compensation: the programmed contour, moved aside by a cutter radius, one corner of
// look-ahead.
//
//        outer corner                 inner corner
//      ------.  arc about the       --------+      both pieces end where
//      ----+  \  corner             ------+ |      their offsets meet
//          |   |                          | |
//
// 1. A straight or circular piece moves aside by r along n = side (normal x tangent); arcs keep their centre.
// 2. Outer corners get an arc of radius r about the programmed corner, and so do reversals; smooth ones
// nothing:
//    each piece goes on from where the one before it ended.
// 3. Inner corners end at the intersection of both offset curves. When it lies outside a piece the cutter
// would
//    cut beyond the corner: "compensation-gouge"; so does an arc whose inside is not wider than the cutter.
// 4. The first move (lead-in) ends a radius beside its programmed end, the first one after G40 starts there.
//    An arc leads in (kAlongEntry) as the arc from the tool to a radius beside the programmed end that ends
//    along the programmed one: its centre lies on the line through that end and the programmed centre.
// 5. Moves along the plane's normal wait for the corner that they stand in.
// Known limit: only neighbouring pieces are compared; a slot narrower than the cutter is seen by the
// simulation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "program/control/dialect_words.h"
#include "program/control/target.h"

namespace swarf::program::nc {

/// Who runs the contour: the control of an NC program, or the reader of CL data.
class ContourHost {
 public:
  virtual Plane plane() const = 0;
  /// How remedies name things.
  virtual const DialectWords& words() const = 0;
  /// The place that the next fail() names.
  virtual void at(int file, int line, int column) = 0;
  [[noreturn]] virtual void fail(const char* code, int column, std::string text, std::string fix) const = 0;
  /// A compensated segment, in order.
  virtual void emit(const Segment& segment) = 0;

 protected:
  ~ContourHost() = default;
};

class Contour {
 public:
  explicit Contour(ContourHost& host) : control_(host) {}
  Compensation side() const { return side_; }
  /// The next move in the plane leads out.
  bool leading_out() const { return leading_out_; }
  void set_side(Compensation side, double radius_mm, int column);
  /// The compensated tool stands at `tool` already; no lead-in follows.
  void enter(Compensation side, double radius_mm, const Vec3& tool);
  void set_entry(CompensationEntry entry) { entry_ = entry; }
  /// Corners that turn by no more, or within as much of half a turn back, count as smooth or as reversals.
  void set_smooth(double angle_rad) { smooth_rad_ = angle_rad; }
  void add(const Segment& programmed);
  /// Emits what waits for a corner that does not come; the compensated end stays where it is.
  void flush();

 private:
  struct Piece {
    Segment segment;                ///< compensated
    Vec3 corner;                    ///< its end as programmed
    Vec3 tangent_from, tangent_to;  ///< at both programmed ends, unit, in the plane
    double way = 0.0;               ///< programmed, mm
    bool lead_in = false;
  };
  Vec3 normal() const;
  Vec3 flat(const Vec3& v) const;
  Vec3 at_height(const Vec3& in_plane, const Vec3& height) const;
  /// Unit vector to the side of the travel on which the cutter goes.
  Vec3 aside(const Vec3& tangent) const;
  Vec3 tangent(const Segment& segment, const Vec3& at) const;
  Piece offset(const Segment& programmed) const;
  void lead_in(const Segment& programmed);
  /// A lead-in on an arc, with kAlongEntry alone: "compensation-entry" where none ends along the programmed
  /// one.
  void lead_in_round(const Segment& programmed);
  void lead_out(const Segment& programmed);
  void join(const Piece& next);
  void outer(const Piece& next);
  void inner(const Piece& next);
  void send_pending();
  void send_waiting(const Vec3& offset);
  Vec3 meet(const Piece& before, const Piece& after) const;
  /// Throws, by way of the host.
  void gouge(const Segment& segment, const char* why) const;

  ContourHost& control_;
  CompensationEntry entry_ = CompensationEntry::kAcrossNext;
  Compensation side_ = Compensation::kOff;
  double radius_ = 0.0, smooth_rad_ = 1e-9;
  bool leading_in_ = false, leading_out_ = false;
  std::optional<Piece> pending_;
  std::vector<Segment> waiting_;  ///< along the normal, after `pending_`
  Vec3 tool_ = Vec3::Zero();      ///< compensated point reached so far, program coordinates
  bool tool_known_ = false;
};

}  // namespace swarf::program::nc

// The least distance of two bodies over a motion, and the instant at which they first touch: proven, not
// sampled (theory 8).
//
// A branch and bound over triples (node of a, node of b, span of time):
//
//   1. b's box at both ends of the span, as seen from a, is put into one box, along the axes of a and along
//      those of b: what lies between stays within it but for the sagitta of the motion (relative_motion.h).
//      The distance of the boxes less the sagitta is the lower bound; a slide along a face at a small gap
//      costs no more than standing there.
//   2. The triple with the least bound is split: by time while the motion is longer than the boxes, else the
//      larger node.
//   3. Two primitives: hull(K(t0), K(t1)) against the other (convex_distance.h) less the sagitta is the lower
//      bound; the nearest points of the hull, looked at where they are at their instant, are an upper one.
//      For a straight motion both agree at once, else the span is split.
//
// What is split no further is known to within the tolerance, so the answer holds for every instant and place.
#pragma once

#include <limits>

#include "collision/relative_motion.h"

namespace swarf::collision {

/// Two bodies of a machine; all are borrowed and must outlive it.
struct Encounter {
  const machine::MachineScene* scene;
  const Body *a, *b;
  RelativeMotion b_from_a, a_from_b;
};
Encounter encounter(const machine::MachineScene& scene, const Body& a, const Body& b);

/// Indices of primitives.
struct PrimitivePair {
  uint32_t a = 0, b = 0;
};

struct ApproachQuery {
  double limit = std::numeric_limits<double>::infinity();  ///< mm; what is farther is not looked for
  double tolerance = 1e-3;                                 ///< mm between the bounds of the answer, above 0
  /// Look no further once a distance of this or less is found, mm; the bounds are then wider.
  double enough = -1.0;
  /// Triples that are split at most; beyond, the search is given up.
  uint64_t budget = std::numeric_limits<uint64_t>::max();
  /// A pair that was nearest a while ago: the answer does not depend on it but for which of equals is told.
  const PrimitivePair* hint = nullptr;
};

/// Least distance over a segment.
struct Approach {
  bool within = false;    ///< below the limit; else only `lower` means something
  bool given_up = false;  ///< the budget was spent: `lower` holds, but may lie far below
  double lower = std::numeric_limits<double>::infinity();  ///< mm; proven, also where nothing is within
  double upper = std::numeric_limits<double>::infinity();  ///< mm; of the two points at t
  double t = 0.0;                                          ///< share of the segment
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();     ///< in M, at t
  PrimitivePair pair;
};

/// The distance at one place of the axes of two given primitives: an upper bound of that of the bodies, mm.
double distance_at(const Encounter& pair, const AxisValues& q, const PrimitivePair& primitives);

/// Where the axes stray (AxisSegment::stray), the lower bound is that of all places they may be at; nothing
/// within the limit is proven as ever, but the search ends at the first place that may be nearer than the
/// limit, and `upper` is the distance there on the straight line.
/// Surfaces alone: a body wholly inside the other has the distance of their surfaces (containment.h).
Approach closest_approach(const Encounter& pair, const AxisSegment& segment, const ApproachQuery& query = {});

struct ContactQuery {
  /// Gaps of this or less are contacts, mm, above 0; so every contact is one, however shallow.
  double touch = 1e-4;
  double travel = 1e-2;  ///< mm that any point moves at most between the bounds of the answer
};

struct FirstContact {
  bool touches = false;
  /// Shares of the segment: without contact before t_free (proven), within `gap` at t_touch.
  double t_free = 1.0, t_touch = 1.0;
  double gap = 0.0;  ///< mm at t_touch: touch at most, or 1e-6 mm more where it grazes
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();  ///< in M, at t_touch
  PrimitivePair pair;
};

/// The earliest contact of the surfaces over the segment, whose stray must be 0.
FirstContact first_contact(const Encounter& pair, const AxisSegment& segment, const ContactQuery& query = {});

}  // namespace swarf::collision

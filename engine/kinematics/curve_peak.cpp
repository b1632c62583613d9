#include "kinematics/curve_peak.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "base/roots.h"

namespace swarf::kinematics {
namespace {

/// A piece of the curve; pieces shorter than this are rounding.
constexpr double kShortest = 1e-12;

struct Node {
  double u = 0.0;
  MeasureAt at;
};

struct Piece {
  Node low, high;
  double bound(double bend) const {
    const double h = high.u - low.u;
    return std::max(low.at.value, high.at.value) + 0.125 * h * h * bend;
  }
  bool holds_turn() const { return low.at.slope > 0.0 && high.at.slope < 0.0; }
};

class Search {
 public:
  Search(const std::function<MeasureAt(double)>& measure, double bend, double tolerance)
      : measure_(measure), bend_(bend), tolerance_(tolerance) {}

  Peak run() {
    const Node first = node(0.0), last = node(1.0);
    std::vector<Piece> pieces{{first, last}};
    std::vector<Piece> next;
    while (!pieces.empty()) {
      next.clear();
      for (const Piece& piece : pieces) divide(piece, next);
      pieces.swap(next);
    }
    best_.proven = std::max(best_.proven, best_.value);
    return best_;
  }

 private:
  Node node(double u) {
    const Node made{u, measure_(u)};
    if (made.at.value > best_.value || !found_) {
      best_.u = u;
      best_.value = made.at.value;
      found_ = true;
    }
    return made;
  }

  void divide(const Piece& piece, std::vector<Piece>& next) {
    const double bound = piece.bound(bend_);
    if (bound <= best_.value + tolerance_ || piece.high.u - piece.low.u < kShortest) {
      best_.proven = std::max(best_.proven, bound);
      return;
    }
    Node split;
    if (piece.holds_turn() && piece.high.u - piece.low.u < kTurnBracket) {
      split = node(bracketed_root([&](double u) { return measure_(u).slope; }, piece.low.u, piece.high.u,
                                  piece.low.at.slope, piece.high.at.slope));
      split.at.slope = 0.0;  // what is left of it is rounding, no second turn beside this one
    } else {
      split = node(0.5 * (piece.low.u + piece.high.u));
    }
    next.push_back({piece.low, split});
    next.push_back({split, piece.high});
  }

  /// Wider brackets are halved first: cheaper than a root that a later one replaces.
  static constexpr double kTurnBracket = 0.05;

  const std::function<MeasureAt(double)>& measure_;
  double bend_, tolerance_;
  Peak best_;
  bool found_ = false;
};

}  // namespace

Peak greatest(const std::function<MeasureAt(double u)>& measure, double bend, double tolerance) {
  SWARF_CHECK(std::isfinite(bend) && bend >= 0.0 && tolerance > 0.0, "a finite bend and a tolerance");
  return Search(measure, bend, tolerance).run();
}

}  // namespace swarf::kinematics

// A field along a straight side, known at some places, and the polyline that shows it. Internal to this
// folder.
#pragma once

#include <functional>
#include <utility>
#include <vector>

namespace swarf::mesh {

/// Where to look at a side of this length, mm: from 0 to 1 without the ends, evenly, and beside an end on a
/// crease at distances that double.
std::vector<double> places_on_side(double length_mm, bool crease_at_0, bool crease_at_1);

class FieldLine {
 public:
  void add(double t, float value) { places_.emplace_back(t, value); }

  struct Knots {
    std::vector<double> at;
    double worst = 0.0;  ///< error of the side as it is, of what is allowed
  };
  /// Where the side from `first` to `last` is to be divided. Candidates are the places, the kinks where
  /// straight pieces on both sides of a gap between places meet, and where the field reaches +-`saturates`,
  /// beyond which all values look the same. The one that errs most divides what lies on both sides of it,
  /// until all errors are at most `enough`. No knot is nearer than `apart` to another or to an end.
  /// error(low, high, t, truth): of what is shown between two values.
  Knots knots(float first, float last, double saturates, double apart, double enough,
              const std::function<double(float, float, double, float)>& error) const;

 private:
  std::vector<std::pair<double, float>> places_;
};

}  // namespace swarf::mesh

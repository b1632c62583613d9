// A stretch of a program's time as the user writes it, and the cycles that lie in it.
#pragma once

#include <cstddef>
#include <optional>

#include "motion/cycles/cycles.h"

namespace swarf::sim {

/// From and to, each as program time (s) or as a line of the program, or left out: from the start, to the
/// end.
struct WindowPlaces {
  std::optional<double> from_s, to_s;
  /// Of the line that findings and blocks.csv name: from the start of its first block, to the end of its last
  /// one.
  std::optional<int> from_line, to_line;
  bool any() const { return from_s || to_s || from_line || to_line; }
};

/// Numbers of cycles: [first, end).
struct CycleWindow {
  size_t first = 0, end = 0;
  size_t size() const { return end - first; }
};

/// A cycle at exactly either time lies inside; of a window between two cycles the one behind it is taken.
/// Throws InputError "place-unknown" for a time outside the program, a line without motion (naming the
/// nearest with), and an end before the start.
CycleWindow window_of(const WindowPlaces& places, const motion::Cycles& cycles);

/// Throws InputError "place-unknown", as window_of(), where the line moves nothing.
void require_line(int line, const toolpath::Elements& elements);

}  // namespace swarf::sim

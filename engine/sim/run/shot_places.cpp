#include "sim/run/shot_places.h"

#include <algorithm>

#include "base/diagnostics.h"

namespace swarf::sim {
namespace {

/// What is said of an option is said of the shot's key.
[[noreturn]] void refuse_at(const MovieShot& shot, const InputError& error) {
  const Diagnostic& found = error.diagnostics.list().front();
  throw InputError(found.code, shot.where, found.text, found.fix);
}

bool cuts(const CycleWindow& window, const motion::Cycles& cycles) {
  motion::CycleReader reader(cycles);
  for (size_t k = window.first; k < window.end; ++k)
    if (reader.at(k).sample.kind == motion::SampleKind::kCutting) return true;
  return false;
}

}  // namespace

bool has_places(const MovieShot& shot) {
  return shot.from_s || shot.to_s || shot.from_line || shot.to_line;
}

CycleWindow shot_window(const MovieShot& shot, const motion::Cycles& cycles) {
  try {
    return window_of({shot.from_s, shot.to_s, shot.from_line, shot.to_line}, cycles);
  } catch (const InputError& error) {
    refuse_at(shot, error);
  }
}

InputError shot_cuts_nothing(const MovieShot& shot) {
  return {"nothing-cut", shot.where, "no feed move lies in this shot, and its speed is \"cutting\"",
          "write speed = \"time\", or other places"};
}

void require_shot_lines(const MovieSettings& movie, const toolpath::Elements& elements, const Box& stock_W) {
  if (movie.seconds <= 0.0) return;
  for (const MovieShot& shot : movie.shots) {
    if (shot.section) require_section(*shot.section, shot.where, stock_W);
    try {
      if (shot.from_line) require_line(*shot.from_line, elements);
      if (shot.to_line) require_line(*shot.to_line, elements);
    } catch (const InputError& error) {
      refuse_at(shot, error);
    }
  }
}

void require_shots(const MovieSettings& movie, const motion::Cycles& cycles) {
  if (movie.seconds <= 0.0) return;
  for (const MovieShot& shot : movie.shots) {
    const CycleWindow window = has_places(shot) ? shot_window(shot, cycles) : CycleWindow{0, cycles.size()};
    if (shot.speed == MovieSpeed::kCutting && !cuts(window, cycles)) throw shot_cuts_nothing(shot);
  }
}

}  // namespace swarf::sim

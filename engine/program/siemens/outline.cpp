#include "program/siemens/outline.h"

#include <algorithm>
#include <cmath>

namespace swarf::program::nc::siemens {
namespace {

/// Pieces below this are rounding, mm.
constexpr double kNoPiece = 1e-9;

Vec2 polar(double radius, double angle_rad) {
  return {radius * std::cos(angle_rad), radius * std::sin(angle_rad)};
}

void add_straight(Outline& outline, const Vec2& to) {
  const Vec2 from = outline.pieces.empty() ? outline.start : outline.pieces.back().to;
  if ((to - from).norm() > kNoPiece) outline.pieces.push_back({to, Vec2::Zero(), 0});
}

void add_curve(Outline& outline, const Vec2& to, const Vec2& centre, int turn) {
  if ((to - centre).norm() > kNoPiece) outline.pieces.push_back({to, centre, turn});
}

}  // namespace

Outline rounded_rectangle(double half_length, double half_width, double radius) {
  const double r = std::max(0.0, std::min({radius, half_length, half_width}));
  const double x = half_length - r, y = half_width - r;
  Outline outline;
  outline.start = Vec2(half_length, 0.0);
  add_straight(outline, Vec2(half_length, y));
  add_curve(outline, Vec2(x, half_width), Vec2(x, y), 1);
  add_straight(outline, Vec2(-x, half_width));
  add_curve(outline, Vec2(-half_length, y), Vec2(-x, y), 1);
  add_straight(outline, Vec2(-half_length, -y));
  add_curve(outline, Vec2(-x, -half_width), Vec2(-x, -y), 1);
  add_straight(outline, Vec2(x, -half_width));
  add_curve(outline, Vec2(half_length, -y), Vec2(x, -y), 1);
  add_straight(outline, outline.start);
  return outline;
}

Outline round_band(double radius, double half_width, double from_rad, double to_rad) {
  const double inner = radius - half_width, outer = radius + half_width;
  const Vec2 first = polar(radius, from_rad), last = polar(radius, to_rad), none = Vec2::Zero();
  Outline outline;
  // The middle of the round end lies before the start of the arc, along its tangent.
  outline.start = first - half_width * Vec2(-std::sin(from_rad), std::cos(from_rad));
  add_curve(outline, polar(outer, from_rad), first, 1);
  add_curve(outline, polar(outer, to_rad), none, 1);
  add_curve(outline, polar(inner, to_rad), last, 1);
  add_curve(outline, polar(inner, from_rad), none, -1);
  add_curve(outline, outline.start, first, 1);
  return outline;
}

Outline reversed(const Outline& outline) {
  Outline back;
  back.start = outline.start;
  for (size_t n = outline.pieces.size(); n-- > 0;) {
    const OutlinePiece& piece = outline.pieces[n];
    back.pieces.push_back({n > 0 ? outline.pieces[n - 1].to : outline.start, piece.centre, -piece.turn});
  }
  return back;
}

std::vector<double> infeeds(double from, double to, int count) {
  std::vector<double> heights;
  for (int n = 1; n < count; ++n) heights.push_back(from + (to - from) * n / count);
  if (count > 0) heights.push_back(to);
  return heights;
}

}  // namespace swarf::program::nc::siemens

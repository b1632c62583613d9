// Conversions at the borders; inside, everything is mm, s and rad.
#pragma once

#include <numbers>

namespace swarf {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kMicrometre = 1e-3;  ///< mm

constexpr double rad_from_deg(double deg) {
  return deg * (kPi / 180.0);
}
constexpr double deg_from_rad(double rad) {
  return rad * (180.0 / kPi);
}
constexpr double mm_s_from_mm_min(double mm_min) {
  return mm_min / 60.0;
}
constexpr double mm_min_from_mm_s(double mm_s) {
  return mm_s * 60.0;
}
constexpr double um_from_mm(double mm) {
  return mm * 1e3;
}

}  // namespace swarf

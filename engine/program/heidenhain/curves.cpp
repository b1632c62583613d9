// LN and SPL of Heidenhain programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

using nc::Target;

namespace {

Vec3 unit_vector(BlockReader& reader, const std::array<Amount, 3>& words, const char* name) {
  const auto first = std::find_if(words.begin(), words.end(), [](const Amount& word) { return word.given; });
  Vec3 v;
  for (int i = 0; i < 3; ++i) {
    const Amount& word = words[static_cast<size_t>(i)];
    if (!word)
      reader.fail("missing-word", first->offset,
                  fmt::format("the vector {} has only some of its words", name),
                  fmt::format("write {0}X, {0}Y and {0}Z", name));
    v[i] = word.value;
  }
  if (!(std::abs(v.norm() - 1.0) <= 1e-3)) {
    reader.fail("bad-vector", words[0].offset,
                fmt::format("the vector {} has the length {:.6f}, not 1", name, v.norm()),
                "write unit vectors with seven decimals");
  }
  return v.normalized();
}

bool any(const std::array<Amount, 3>& words) {
  return words[0] || words[1] || words[2];
}

/// Each chord of a spline stays this near to it.
constexpr double kChordToleranceMm = 1e-4;
const double kChordToleranceRad = rad_from_deg(1e-3);
/// By how much a spline may start off the position before it (manual: 1 um).
constexpr double kStartToleranceMm = 1e-3;
const double kStartToleranceRad = rad_from_deg(1e-3);
constexpr double kPiecesMax = 100'000.0;

/// k0 + k1 t + k2 t^2 + k3 t^3, mm or rad; nothing where the axis stands.
using Cubic = std::optional<std::array<double, 4>>;

double value_of(const std::array<double, 4>& k, double t) {
  return k[0] + t * (k[1] + t * (k[2] + t * k[3]));
}

/// So many pieces keep the chords of a rotary axis near its polynomial: error <= h^2 max|q''| / 8.
double pieces_of(const std::array<double, 4>& k) {
  const double bend = 2.0 * std::abs(k[2]) + 6.0 * std::abs(k[3]);
  return std::ceil(std::sqrt(bend / (8.0 * kChordToleranceRad)));
}

class CubicCurve final : public nc::Curve {
 public:
  CubicCurve(const std::array<Cubic, nc::kAxisWords>& cubics, const std::array<double, nc::kAxisWords>& from)
      : cubics_(cubics), from_(from) {}

  nc::CurvePoint at(double u) const override {
    const double t = 1.0 - u;
    nc::CurvePoint point;
    for (size_t i = 0; i < 3; ++i) {
      point.tip[static_cast<long>(i)] = cubics_[i] ? value_of(*cubics_[i], t) : from_[i];
      if (cubics_[i + 3]) point.rotary[i] = value_of(*cubics_[i + 3], t);
    }
    return point;
  }

  std::vector<double> breaks() const override {
    double pieces = 1.0;
    for (size_t i = 3; i < cubics_.size(); ++i) {
      if (cubics_[i]) pieces = std::max(pieces, pieces_of(*cubics_[i]));
    }
    std::vector<double> inner;
    for (double n = 1.0; n < pieces; ++n) inner.push_back(n / pieces);
    return inner;
  }

 private:
  std::array<Cubic, nc::kAxisWords> cubics_;
  std::array<double, nc::kAxisWords> from_;
};

/// The polynomials of a block, checked against the position before it.
std::array<Cubic, nc::kAxisWords> cubics(BlockReader& reader, const MotionWords& words,
                                         const SplineWords& spline, const Target& end, size_t start) {
  nc::Control& control = reader.control();
  if (!end.any()) reader.fail("missing-word", start, "SPL has no end", "SPL X+10 K3X+0 K2X+0 K1X-10");
  if (!control.path.started)
    reader.fail("start-unknown", start, "a spline starts, and the position is not known yet",
                "position all axes before it");
  std::array<Cubic, nc::kAxisWords> all;
  for (size_t i = 0; i < all.size(); ++i) {
    const auto& k = spline[i];
    const char letter = nc::kAxisLetters[i];
    const bool complete = k[0] && k[1] && k[2];
    if (!words.axes[i] && !k[0] && !k[1] && !k[2]) continue;
    if (!words.axes[i] || words.axes[i].incremental || !complete)
      reader.fail("missing-word", start,
                  fmt::format("SPL needs {0}, K3{0}, K2{0} and K1{0} together", letter),
                  fmt::format("SPL {0}+10 K3{0}+0 K2{0}+0 K1{0}-10", letter));
    const double unit = i < 3 ? control.modal.mm(1.0) : rad_from_deg(1.0);
    all[i] = {end.value[i], unit * k[0].value, unit * k[1].value, unit * k[2].value};
    const double from = value_of(*all[i], 1.0);
    if (!std::isfinite(from) || (i >= 3 && pieces_of(*all[i]) > kPiecesMax))
      reader.fail("out-of-range", k[0].offset, "this spline bends beyond any machine", "correct its numbers");
    const double off = from - nc::position(control)[i];
    if (std::abs(off) > (i < 3 ? kStartToleranceMm : kStartToleranceRad))
      reader.fail("bad-spline", k[0].offset,
                  fmt::format("the spline starts {:.6f} {} off the position before it in {}",
                              i < 3 ? off : deg_from_rad(off), i < 3 ? "mm" : "degrees", letter),
                  "the sum of the end and K1, K2, K3 is the position before the block");
  }
  return all;
}

/// By how much the tip stands off the programmed point: the point counts from the tip by R and R2 along the
/// surface normal N, by their deltas alone unless FUNCTION PROG PATH IS CONTOUR:
/// tip = point + R2 N + (R - R2) N' - R2 T, where N' is the unit part of N across the tool axis T.
Vec3 surface_offset(nc::Control& control, Modes& modes, Orientation& orientation, BlockReader& reader,
                    const MotionWords& words, const Vec3& axis, size_t start) {
  const Vec3 normal = unit_vector(reader, words.normal, "N");
  const NcTool* tool = nc::active_tool(control);
  if (orientation.path_is_contour && tool == nullptr)
    reader.fail("compensation-no-tool", start,
                "the path is the contour, and no tool of the table is in the spindle", "TOOL CALL 5 Z");
  const double radius = (orientation.path_is_contour ? 0.5 * tool->diameter_mm : 0.0) + modes.delta_radius;
  const double corner = (orientation.path_is_contour ? tool->corner_radius_mm : 0.0) + modes.delta_corner;
  const Vec3 across = normal - normal.dot(axis) * axis;
  Vec3 off = corner * (normal - axis);
  if (across.norm() > 1e-9) off += (radius - corner) * across.normalized();
  if (off.isZero(0.0)) return off;
  for (int i = 0; i < 3; ++i) {
    const Amount& word = words.axes[static_cast<size_t>(i)];
    if (!word || word.incremental)
      reader.fail("missing-word", start, "LN with a tool correction needs absolute X, Y and Z",
                  "LN X+1 Y+2 Z+3 NX..");
  }
  if (words.any_rotary())
    reader.fail("words-conflict", start, "LN with a tool correction has rotary words",
                "write the tool vector TX TY TZ");
  return off;
}

}  // namespace

/// LN X Y Z NX NY NZ TX TY TZ.
void surface_line(Executor& executor, BlockReader& reader, size_t start) {
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kVectorsAllowed | kAlways | kTcpAllowed);
  no_open_corner(executor.path, reader, start);
  if (words.compensation && *words.compensation != nc::Compensation::kOff)
    reader.fail("unsupported-word", start, "RL and RR in LN (peripheral milling) are not supported",
                "write R0");
  need_true_size(executor.frames, reader, start, "LN");
  if (words.has_function(128)) set_tcpm(executor.control, executor.orientation, true, false, false, false);
  Element element;
  element.offset = start;
  element.target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  Vec3 axis = nc::tool_axis_P(executor.control);
  if (any(words.tool)) {
    if (words.any_rotary())
      reader.fail("words-conflict", start, "LN has rotary words and a tool vector", "write one of them");
    axis = unit_vector(reader, words.tool, "T");
    if (!executor.orientation.tcpm)
      reader.fail("vector-without-tcp", words.tool[0].offset, "a tool vector without M128 or FUNCTION TCPM",
                  "write M128 before it");
    turn_by(executor.control, executor.orientation, nc::Tcp::kVector);
    element.target.axis_P = axis;
  } else if (words.any_rotary()) {
    if (!executor.orientation.tcpm || executor.orientation.spatial)
      reader.fail("unsupported-word", start, "rotary words in LN are supported with M128 alone",
                  "write the tool vector TX TY TZ");
    turn_by(executor.control, executor.orientation, nc::Tcp::kAxes);
  }
  if (any(words.normal)) {
    const Vec3 off =
        surface_offset(executor.control, executor.modes, executor.orientation, reader, words, axis, start);
    for (int i = 0; i < 3; ++i) element.target.value[static_cast<size_t>(i)] += off[i];
  }
  if (!element.target.any())
    reader.fail("missing-word", start, "LN has no end", "LN X+1 Y+2 Z+3 TX+0 TY+0 TZ+1");
  move(executor, reader, words, element);
}

/// SPL X Y .. K3X K2X K1X ..: each axis along K3 t^3 + K2 t^2 + K1 t + end, t from 1 to 0.
void spline(Executor& executor, BlockReader& reader, size_t start) {
  SplineWords spline;
  const MotionWords words = read_motion_words(
      reader, kAxesAllowed | kCoefficientsAllowed | kFeedAllowed | kFunctionsAllowed, &spline);
  no_open_corner(executor.path, reader, start);
  need_true_size(executor.frames, reader, start, "SPL");
  if (executor.control.contour.side() != nc::Compensation::kOff)
    reader.fail("unsupported-word", start, "SPL while RL or RR is active is not supported",
                "write R0 before it");
  if (words.any_rotary() &&
      (executor.orientation.spatial || (executor.orientation.tilted && !executor.orientation.tcpm)))
    reader.fail("unsupported-word", start, "rotary words of SPL are not supported here",
                "use FUNCTION TCPM AXIS POS, without a tilted plane");
  Motion motion = Motion::kFeed;
  const double feed = feed_of(executor.control, executor.modes, reader, words, motion);
  if (motion == Motion::kRapid)
    reader.fail("unexpected-word", words.feed_value.offset, "SPL is not moved at FMAX",
                "write F with a value");
  functions_before(executor, reader, words);
  if (words.any_rotary()) turn_by(executor.control, executor.orientation, nc::Tcp::kAxes);
  const CubicCurve curve(
      cubics(reader, words, spline,
             target_of(executor.control, executor.modes, executor.frames, reader, words), start),
      nc::position(executor.control));
  if (feed > 0.0) set_feed(executor.control, feed, !words.any_linear());
  nc::curve(executor.control, curve, kChordToleranceMm);
  executor.path.tangent.reset();
  finish_motion(executor, reader, words);
}

}  // namespace swarf::program::nc::heidenhain

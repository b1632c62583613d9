// POLY blocks of Siemens 840D.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/siemens/functions.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {

using nc::Target;

namespace {

/// Each chord of a curve stays this near to it, mm.
constexpr double kChordToleranceMm = 1e-4;
/// PL as the manual gives it.
constexpr double kIntervalMin = 1e-4, kIntervalMax = 99999.9999;
/// A curve that swings further than this leaves every machine, mm.
constexpr double kSwingMax = 1e6;
/// A divisor below this is a pole of the curve.
constexpr double kPole = 1e-6;
/// Rotary values and tool axes nearer than this are one, rad.
constexpr double kSameAngle = 1e-12;

/// What the block says of its axes, mm and rad.
PolynomialBlock polynomial_block(Executor& executor, const BlockWords& words, const Target& target) {
  const std::array<double, nc::kAxisWords> here = nc::position(executor.control);
  PolynomialBlock block;
  block.by_way = executor.path.by_way;
  if (words.interval) block.interval = words.interval.value;
  if (words.divisor) {
    const auto& d = words.divisor.a;
    block.divisor = {words.divisor_end, d[0], d[1], d[2], d[3]};
  }
  for (size_t n = 0; n < here.size(); ++n) {
    const int word = static_cast<int>(n);
    const bool rotary = n >= 3;
    PolynomialAxis axis{here[n], here[n], {}};
    if (target.has(word)) axis.to = target.value[n] + (target.is_incremental(word) ? here[n] : 0.0);
    for (size_t k = 0; k < axis.a.size(); ++k) {
      const double a = words.polynomials[n].a[k];
      axis.a[k] = !words.polynomials[n] ? 0.0
                  : rotary              ? rad_from_deg(a)
                                        : executor.control.modal.mm(a) * executor.frames.stretch.factor[word];
    }
    if (!rotary) {
      block.linear[n] = axis;
      if (words.divisor && target.has(word) && !words.polynomials[n]) {
        fail(executor.place, "words-conflict", words.axes[n].offset,
             fmt::format("{0} is given without PO[{0}] beside a divisor PO[], which holds for X Y Z",
                         nc::kAxisLetters[n]),
             fmt::format("write PO[{}]=(...) with its end alone, or leave it out", nc::kAxisLetters[n]));
      }
    } else if (target.has(word)) {
      nc::require_axis(executor.control, static_cast<nc::AxisWord>(word),
                       column(executor.place, words.axes[n].offset));
      if (target.way[n - 3] != nc::RotaryWay::kAsWritten) {
        fail(executor.place, "words-conflict", words.axes[n].offset,
             "DC, ACP and ACN in a block with polynomials are not supported", "write the angle itself");
      }
      block.rotary[n - 3] = axis;
    }
  }
  return block;
}

/// Tool vectors turn with ORIWKS and ORIVECT, rotary axes with ORIAXES and ORIMKS or without TRAORI.
void polynomial_orientation(nc::Control& control, BlockPlace& place, const BlockWords& words,
                            const Target& target, PolynomialBlock& block) {
  if (target.axis_P) {
    if (control.offsets.tcp != nc::Tcp::kVector) {
      fail(place, "unsupported-word", words.motion_offset,
           "a tool vector in a block with polynomials is supported with ORIWKS and ORIVECT",
           "write ORIVECT, or rotary axes");
    }
    const Vec3 from = nc::tool_axis_P(control).normalized(), to = *target.axis_P;
    if (!(to.norm() > kSameAngle) || (from + to.normalized()).norm() < 1e-6) {
      control.report.fail("bad-vector", target.column,
                          "the tool vector has no length, or it turns back on itself",
                          "give vectors that are less than half a turn apart");
    }
    block.axis = {from, to.normalized()};
    return;
  }
  if (control.offsets.tcp != nc::Tcp::kVector) return;
  for (size_t i = 0; i < 3; ++i) {
    std::optional<PolynomialAxis>& axis = block.rotary[i];
    if (!axis) continue;
    if (words.polynomials[i + 3] || std::abs(axis->to - axis->from) > kSameAngle) {
      fail(place, "unsupported-word", words.axes[i + 3].offset,
           "rotary axes in a block with polynomials are supported with ORIAXES under TRAORI",
           "write ORIAXES, or the tool vector A3= B3= C3=");
    }
    axis.reset();
  }
}

}  // namespace

/// The first PO of the block; null when it has none.
const Coefficients* first_polynomial(const BlockWords& words) {
  for (const Coefficients& one : words.polynomials) {
    if (one) return &one;
  }
  return words.divisor ? &words.divisor : nullptr;
}

/// Words of polynomials stand with motions that take them.
void check_polynomial(nc::Control& control, const BlockPlace& place, const Modes& modes,
                      const BlockWords& words) {
  const Coefficients* polynomial = first_polynomial(words);
  if (polynomial == nullptr) {
    if (words.interval && modes.motion != kPoly) {
      fail(place, "unexpected-word", words.interval.offset, "PL= belongs to POLY, which is not active",
           "write POLY in this block");
    }
    return;
  }
  if ((modes.motion != kPoly && modes.motion != kG1) || words.code(Group::kSuppress)) {
    fail(place, "words-conflict", polynomial->offset,
         "a polynomial stands in a block with another motion, or with machine coordinates",
         "write POLY in this block, without SUPA, G53 and G153");
  }
  if (modes.motion == kG1) {
    control.report.warn_once("polynomial-not-active", column(place, polynomial->offset),
                             "POLY is not active: the ends of polynomials are approached on straight lines",
                             "write POLY in this block");
  }
}

/// POLY with PO: the curve of the block.
void polynomial(Executor& executor, const BlockWords& words, const Target& target) {
  const size_t offset = first_polynomial(words)->offset;
  if (executor.control.contour.side() != nc::Compensation::kOff || executor.control.contour.leading_out()) {
    fail(executor.place, "unsupported-word", offset,
         "polynomials with cutter radius compensation are not supported",
         "write G40 and a straight move before it, and post the path of the cutter's centre");
  }
  if (!executor.control.path.started) {
    fail(executor.place, "start-unknown", offset, "a polynomial starts, and the position is not known yet",
         "position all axes before it");
  }
  if (words.interval && !(words.interval.value >= kIntervalMin && words.interval.value <= kIntervalMax)) {
    fail(executor.place, "out-of-range", words.interval.offset,
         fmt::format("PL={:g} is no interval", words.interval.value),
         "PL is 0.0001 to 99999.9999; 1 where it is left out");
  }
  PolynomialBlock block = polynomial_block(executor, words, target);
  polynomial_orientation(executor.control, executor.place, words, target, block);
  const PolynomialCurve curve(block);
  if (!(curve.swing() <= kSwingMax)) {
    fail(executor.place, "out-of-range", offset, "this polynomial swings beyond any machine",
         "correct its coefficients");
  }
  if (!(curve.divisor_min() > kPole)) {
    fail(executor.place, "bad-polynomial", words.divisor.offset,
         "the divisor PO[] becomes zero between 0 and PL",
         "correct its coefficients: 1 + d1 p + d2 p^2 ... stays above zero");
  }
  nc::curve(executor.control, curve, kChordToleranceMm);
  executor.path.last.direction = curve.direction_at_end();
  executor.path.last.valid = executor.path.last.direction.norm() > 1e-9;
}

/// POLYPATH("AXES","VECT"): polynomials are those of the axes, as they are without it.
void polynomial_path(BlockPlace& place, const CycleCall& call) {
  bool axes = false;
  for (size_t n = 0; n < call.arguments.size(); ++n) {
    const std::string text = has_argument(call, n) ? as_text(*call.arguments[n]) : std::string();
    axes = axes || text == "AXES";
    if (text != "AXES" && text != "VECT") {
      fail(place, "wrong-arguments", call.offsets[n], "POLYPATH takes \"AXES\" and \"VECT\"",
           "POLYPATH(\"AXES\",\"VECT\")");
    }
  }
  if (!axes) {
    fail(place, "unsupported-word", call.offset,
         "POLYPATH that switches the polynomials of axes off is not supported",
         "write G1 where the axes run straight");
  }
}

}  // namespace swarf::program::nc::siemens

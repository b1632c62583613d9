#include "program/surface_blocks/table.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "program/surface_blocks/check.h"

namespace swarf::program {
namespace {

bool check_not_closed(const SurfaceEntry& entry, const CheckedBlock& block, Reporter& reporter) {
  if (!entry.closed()) return true;
  reporter.error(
      "surface-closed", block.line, block.column_of('P'),
      fmt::format("surface {} was closed by G10 L79 in line {}", block.values.whole('P'), entry.closed_line),
      "move this block before that L79, or give a new surface number");
  return false;
}

void check_index(const SurfaceEntry& entry, const CheckedBlock& block, char letter, Reporter& reporter) {
  const int degree = letter == 'I' ? entry.degree_u : entry.degree_v;
  const char degree_letter = letter == 'I' ? 'Q' : 'R';
  if (!block.values.has(letter) || block.values.whole(letter) <= degree) return;
  reporter.error("coefficient-outside-degree", block.line, block.column_of(letter),
                 fmt::format("{}{} lies outside the degree {} of surface {} (line {})", letter,
                             block.values.whole(letter), degree, block.values.whole('P'), entry.where.line),
                 fmt::format("{} goes from 0 to {}; or raise {} in G10 L70", letter, degree, degree_letter));
}

void check_complete_net(const SurfaceEntry& entry, const CheckedBlock& block, Reporter& reporter) {
  if (entry.basis != Action::kBezierPoint) return;
  std::string missing;
  int count = 0;
  constexpr int kShown = 4;
  for (int i = 0; i <= entry.degree_u; ++i) {
    for (int j = 0; j <= entry.degree_v; ++j) {
      if (entry.coefficients.count({i, j}) != 0) continue;
      if (++count <= kShown) missing += fmt::format("{}I{} J{}", count == 1 ? "" : ", ", i, j);
    }
  }
  if (count == 0) return;
  reporter.error("control-point-missing", block.line, block.column_of('P'),
                 fmt::format("{} of {} control points of surface {} are missing: {}{}", count,
                             (entry.degree_u + 1) * (entry.degree_v + 1), block.values.whole('P'), missing,
                             count > kShown ? ", ..." : ""),
                 "give every control point with G10 L72; none is taken as 0");
}

surface::PolynomialSurface build(const SurfaceEntry& entry, int outward_sign, const std::vector<Vec3>& net) {
  if (entry.basis == Action::kBezierPoint) {
    return surface::PolynomialSurface::from_bezier(entry.degree_u, entry.degree_v, net, outward_sign);
  }
  return {entry.degree_u, entry.degree_v, net, outward_sign};
}

void check_shape(const surface::PolynomialSurface& shape, const CheckedBlock& block, Reporter& reporter) {
  const auto spot = find_degenerate_point(shape);
  if (!spot) return;
  const int number = block.values.whole('P');
  if (!spot->finite) {
    reporter.error("surface-not-finite", block.line, block.column_of('P'),
                   fmt::format("surface {} or its derivatives overflow at (u,v) = ({:.6g}, {:.6g})", number,
                               spot->u, spot->v),
                   "its coefficients are far too large: they are lengths in mm");
    return;
  }
  reporter.error(
      "surface-degenerate", block.line, block.column_of('P'),
      fmt::format("surface {} has no normal at (u,v) = ({:.6g}, {:.6g}): |Su x Sv| vanishes there", number,
                  spot->u, spot->v),
      "its u and v lines must cross everywhere for 0 <= u,v <= 1: look for a missing or doubled coefficient, "
      "an edge that shrinks to a point, or a fold");
}

}  // namespace

void check_open_surface(const SurfaceTable& table, const CheckedBlock& block, Reporter& reporter) {
  const auto used = table.find(block.values.whole('P'));
  if (!block.values.has('P') || used == table.end()) return;
  reporter.error(
      "surface-number-used", block.line, block.column_of('P'),
      fmt::format("surface {} was opened in line {} already", used->first, used->second.where.line),
      "give this surface a number of its own");
}

void open_surface(SurfaceTable& table, const CheckedBlock& block, const Reporter& reporter) {
  SurfaceEntry entry;
  entry.degree_u = static_cast<int>(block.values.get('Q', entry.degree_u));
  entry.degree_v = static_cast<int>(block.values.get('R', entry.degree_v));
  entry.where = reporter.at(block.line, block.action_column);
  table.emplace(block.values.whole('P'), std::move(entry));
}

void check_coefficient(const SurfaceEntry& entry, const CheckedBlock& block, Reporter& reporter) {
  if (!check_not_closed(entry, block, reporter)) return;
  if (entry.basis != Action::kNone && entry.basis != block.action) {
    reporter.error(
        "mixed-coefficients", block.line, block.column_of('L'),
        fmt::format("surface {} has {} data in line {}, and {} here", block.values.whole('P'),
                    name_of(entry.basis), entry.coefficients.begin()->second.line, name_of(block.action)),
        "describe a surface by power coefficients (L71) or by control points (L72), not by both");
  }
  check_index(entry, block, 'I', reporter);
  check_index(entry, block, 'J', reporter);
  if (!block.values.has('I') || !block.values.has('J')) return;
  const auto twice = entry.coefficients.find({block.values.whole('I'), block.values.whole('J')});
  if (twice == entry.coefficients.end()) return;
  reporter.error(
      "coefficient-twice", block.line, block.column_of('I'),
      fmt::format("coefficient I{} J{} of surface {} was given in line {} already", twice->first.first,
                  twice->first.second, block.values.whole('P'), twice->second.line),
      "keep one of the two blocks");
}

void add_coefficient(SurfaceEntry& entry, const CheckedBlock& block) {
  const Values& values = block.values;
  entry.basis = block.action;
  const Vec3 value(values.get('X', 0.0), values.get('Y', 0.0), values.get('Z', 0.0));
  entry.coefficients[{values.whole('I'), values.whole('J')}] = {value, block.line};
}

std::shared_ptr<const surface::PolynomialSurface> check_close_surface(const SurfaceEntry& entry,
                                                                      const CheckedBlock& block,
                                                                      Reporter& reporter) {
  const int errors = reporter.errors();
  if (!check_not_closed(entry, block, reporter)) return nullptr;
  if (entry.coefficients.empty()) {
    reporter.error("no-coefficients", block.line, block.column_of('P'),
                   fmt::format("surface {} has no coefficients", block.values.whole('P')),
                   "give them with G10 L71 (power basis) or G10 L72 (control points) before G10 L79");
    return nullptr;
  }
  check_complete_net(entry, block, reporter);
  if (reporter.errors() != errors) return nullptr;

  std::vector<Vec3> net(static_cast<size_t>((entry.degree_u + 1) * (entry.degree_v + 1)), Vec3::Zero());
  for (const auto& [index, coefficient] : entry.coefficients) {
    net[static_cast<size_t>(index.first) * (entry.degree_v + 1) + index.second] = coefficient.value;
  }
  auto shape = std::make_shared<const surface::PolynomialSurface>(
      build(entry, static_cast<int>(block.values.get('D', 1.0)), net));
  check_shape(*shape, block, reporter);
  if (reporter.errors() == errors && entry.basis == Action::kBezierPoint) {
    const double lost = bezier_conversion_error(*shape, net);
    if (!(lost <= kBezierToleranceMm)) {
      reporter.error(
          "surface-inaccurate", block.line, block.column_of('P'),
          fmt::format(
              "surface {} loses {:.3g} mm when its control points become powers of u and v; {:g} mm are "
              "allowed",
              block.values.whole('P'), lost, kBezierToleranceMm),
          "split it into surfaces of a lower degree");
    }
  }
  return reporter.errors() == errors ? shape : nullptr;
}

}  // namespace swarf::program

#include "cli/compare_align.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/diagnostics.h"

namespace swarf::cli {
namespace {

measure::PointPair pair_of(const std::string& text) {
  measure::PointPair pair;
  auto& [a, b] = pair;
  int used = 0;
  const int read = std::sscanf(text.c_str(), "%lf,%lf,%lf=%lf,%lf,%lf%n", &a.x(), &a.y(), &a.z(), &b.x(),
                               &b.y(), &b.z(), &used);
  if (read == 6 && static_cast<size_t>(used) == text.size() && a.allFinite() && b.allFinite()) return pair;
  throw InputError("bad-pair", {"--align " + text}, "this is no pair of points",
                   "write X,Y,Z=X,Y,Z in mm: a point of the stock, and the point of the design it lies on");
}

}  // namespace

std::optional<measure::Alignment> align(const std::vector<std::string>& pairs, bool best_fit,
                                        const ComparedDesign& design, ComparedStock& stock) {
  if (pairs.empty() && !best_fit) return {};
  std::vector<measure::PointPair> points;
  for (const std::string& text : pairs) points.push_back(pair_of(text));
  measure::Alignment aligned;
  if (!points.empty()) aligned = measure::align_points(points);
  if (best_fit) aligned = measure::best_fit(*stock.mesh, *design.mesh, aligned.X_design_stock);
  const auto moved = std::make_shared<mesh::SignedDistance>(
      measure::moved(stock.mesh->mesh(), aligned.X_design_stock), stock.mesh->error_mm());
  if (!stock.error.empty() && moved->mesh().positions.size() != stock.error.size())
    throw InputError("align-rounding", {"--align"},
                     "moved, points of the grid fall on each other by rounding: its errors would be lost",
                     "export the stock as a mesh first: swarf export DIR --stl part.stl");
  stock.mesh = moved;
  return aligned;
}

}  // namespace swarf::cli

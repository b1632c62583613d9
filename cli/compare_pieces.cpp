#include "cli/compare_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/mesh_check.h"
#include "mesh/mesh_shells.h"

namespace swarf::cli {
namespace {

/// Pieces that a text names.
constexpr size_t kNamedPieces = 3;
/// Of a grid, in voxels.
constexpr double kCrumb = 8.0;

std::vector<SolidPiece> pieces_of(const TriMesh& mesh, double least_mm3) {
  const mesh::WeldedMesh welded = mesh::weld(mesh);
  std::vector<SolidPiece> pieces;
  for (const mesh::Shell& shell : mesh::shells_of(welded, mesh::facets_across(welded.triangles))) {
    SolidPiece piece;
    piece.middle = 0.5 * (shell.box.lower + shell.box.upper);
    for (const uint32_t facet : shell.facets) {
      const std::array<Vec3, 3> c = mesh::corners_of(welded, facet);
      piece.volume_mm3 += (c[0] - piece.middle).dot((c[1] - piece.middle).cross(c[2] - piece.middle)) / 6.0;
    }
    // Cavities are turned inward.
    if (piece.volume_mm3 > least_mm3) pieces.push_back(piece);
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const SolidPiece& a, const SolidPiece& b) { return a.volume_mm3 > b.volume_mm3; });
  return pieces;
}

}  // namespace

std::vector<SolidPiece> ComparedPieces::loose() const {
  const size_t whole = std::max<size_t>(design.size(), 1);
  if (stock.size() <= whole) return {};
  return {stock.begin() + static_cast<ptrdiff_t>(whole), stock.end()};
}

ComparedPieces pieces_between(const ComparedStock& stock, const ComparedDesign& design) {
  const auto crumb = [](double voxel_mm) { return kCrumb * std::pow(voxel_mm, 3); };
  ComparedPieces pieces{pieces_of(stock.mesh->mesh(), crumb(stock.voxel_mm)), {}};
  if (!design.open) pieces.design = pieces_of(design.mesh->mesh(), crumb(design.voxel_mm));
  return pieces;
}

std::string loose_text(const ComparedPieces& pieces) {
  const std::vector<SolidPiece> loose = pieces.loose();
  if (loose.empty()) return "";
  std::string text = fmt::format("{} pieces", pieces.stock.size());
  if (!pieces.design.empty()) text += fmt::format(", the design is {}", pieces.design.size());
  for (size_t i = 0; i < std::min(kNamedPieces, loose.size()); ++i)
    text += fmt::format("{} {:.4g} mm3 around ({:.3f}, {:.3f}, {:.3f}) mm", i == 0 ? ": loose is" : ",",
                        loose[i].volume_mm3, loose[i].middle.x(), loose[i].middle.y(), loose[i].middle.z());
  if (loose.size() > kNamedPieces) text += fmt::format(" and {} more", loose.size() - kNamedPieces);
  return text;
}

sim::Check pieces_check(const ComparedPieces& pieces) {
  sim::Check check{"pieces", "Pieces of the stock"};
  check.limit = static_cast<double>(std::max<size_t>(pieces.design.size(), 1));
  check.value = static_cast<double>(pieces.stock.size());
  const std::string loose = loose_text(pieces);
  check.outcome = loose.empty() ? sim::Outcome::kHolds : sim::Outcome::kFails;
  check.what = loose.empty() ? fmt::format("no loose piece ({} of the stock)", pieces.stock.size())
                             : "the stock is in " + loose;
  return check;
}

}  // namespace swarf::cli

#include "sim/job/design_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/units.h"
#include "mesh/facet_chord.h"

namespace swarf::sim {
namespace {

constexpr int kParts = 16;              ///< cells along u and v
constexpr double kInchOfDesign = 25.4;  ///< mm
/// A design this much smaller than the stock in the other unit, or larger, is none of another unit.
constexpr double kLikelyShare = 0.25;
constexpr double kBeyond = 1e-4;      ///< mm: past the rounding of designs that end at the stock's faces
constexpr double kMeshBeyond = 1e-5;  ///< of the mesh's size: single precision, as written and as turned
constexpr size_t kVerticesPerTask = 4096;

bool apart(const Box& a, const Box& b) {
  return (a.lower.array() > b.upper.array()).any() || (b.lower.array() > a.upper.array()).any();
}

Box joined(const Box& a, const Box& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

/// What is known of where it lies.
struct DesignPlace {
  Box box;              ///< holds it
  bool outside = true;  ///< all of it, proven
  DesignBeyond beyond{};
};

void keep_farther(const DesignBeyond& other, DesignBeyond& kept) {
  if (other.mm > kept.mm) kept = other;
}

/// Over a cell a surface is no farther from the bilinear patch of its corners than (h_u^2 |Suu| + h_v^2
/// |Svv|) / 8.
void add_cell(const surface::Surface& S, double stray, const Vec2& low, const stock::RawShape& raw,
              DesignPlace& place, bool first) {
  constexpr double h = 1.0 / kParts;
  const Vec3 centre = S.point(low.x() + 0.5 * h, low.y() + 0.5 * h);
  Box box{centre, centre};
  double radius = 0.0;
  for (const Vec2& corner : {Vec2(0, 0), Vec2(h, 0), Vec2(0, h), Vec2(h, h)}) {
    const Vec3 p = S.point(low.x() + corner.x(), low.y() + corner.y());
    box = joined(box, {p, p});
    radius = std::max(radius, (p - centre).norm());
    keep_farther({raw.distance_mm(p), p}, place.beyond);
  }
  box.lower.array() -= stray;
  box.upper.array() += stray;
  place.box = first ? box : joined(place.box, box);
  place.outside = place.outside && (apart(box, raw.box()) || raw.distance_mm(centre) > radius + 2.0 * stray);
}

DesignPlace place_of(const std::vector<surface::SurfacePtr>& design, const stock::RawShape& raw) {
  DesignPlace place;
  for (const surface::SurfacePtr& surface : design) {
    const surface::BendBounds bends = surface->bend_bounds(Vec2::Zero(), Vec2::Ones());
    const double stray = (bends.uu.most() + bends.vv.most()) / (8.0 * kParts * kParts);
    for (int n = 0; n < kParts * kParts; ++n)
      add_cell(*surface, stray, Vec2(n % kParts, n / kParts) / kParts, raw, place,
               n == 0 && surface == design.front());
  }
  return place;
}

Vec3 vertex(const TriMesh& mesh, size_t n) {
  return Eigen::Vector3f(mesh.positions[n].data()).cast<double>();
}

DesignPlace place_of(const TriMesh& mesh, const stock::RawShape& raw) {
  const size_t count = mesh.positions.size();
  std::vector<DesignPlace> parts((count + kVerticesPerTask - 1) / kVerticesPerTask);
  parallel_chunks(count, kVerticesPerTask, [&](size_t begin, size_t end) {
    DesignPlace& part = parts[begin / kVerticesPerTask];
    part.box = {vertex(mesh, begin), vertex(mesh, begin)};
    for (size_t n = begin; n < end; ++n) {
      const Vec3 p = vertex(mesh, n);
      part.box = joined(part.box, {p, p});
      keep_farther({raw.distance_mm(p), p}, part.beyond);
    }
  });
  DesignPlace place = parts.front();
  for (const DesignPlace& part : parts) {
    place.box = joined(place.box, part.box);
    keep_farther(part.beyond, place.beyond);
  }
  place.outside = false;
  return place;
}

DesignPlace place_of(const Job& job) {
  const stock::RawShape raw = job.scene.stock.body_W();
  return job.design_mesh ? place_of(*job.design_mesh, raw) : place_of(job.design, raw);
}

/// The least way along each axis that brings the design between the stock's faces; from middle to middle
/// where it is longer than the stock.
Vec3 shift_into(const Box& stock, const Box& design) {
  Vec3 shift = Vec3::Zero();
  for (int a = 0; a < 3; ++a) {
    const double up = stock.lower[a] - design.lower[a], down = stock.upper[a] - design.upper[a];
    if (up > down)
      shift[a] = stock.centre()[a] - design.centre()[a];
    else
      shift[a] = up > 0.0 ? up : std::min(down, 0.0);
  }
  return shift;
}

std::string remedy(const Job& job, const Box& design) {
  const Box stock = job.scene.stock.body_W().box();
  const std::string key = job.scene.stock.raw.spoken_key();
  for (const auto& [factor, word] :
       {std::pair(kInchOfDesign, "inches"), std::pair(1.0 / kInchOfDesign, "mm times 25.4")}) {
    const Box scaled{factor * design.lower, factor * design.upper};
    const bool fits = (scaled.lower.array() >= stock.lower.array()).all() &&
                      (scaled.upper.array() <= stock.upper.array()).all() &&
                      scaled.size().norm() >= kLikelyShare * stock.size().norm();
    if (fits)
      return fmt::format("its numbers may be {}: {:g} times as large it lies in the stock; write it in mm",
                         word, factor);
  }
  const Vec3 shift = shift_into(stock, design);
  if (shift.norm() < kBeyond) return fmt::format("make the stock larger ({}), or the design smaller", key);
  return fmt::format(
      "both are in the work frame, in mm: move the design by X {:.3f} Y {:.3f} Z {:.3f}, or {} by X {:.3f} Y "
      "{:.3f} Z {:.3f}; or make the stock larger",
      shift.x(), shift.y(), shift.z(), key, 0.0 - shift.x(), 0.0 - shift.y(), 0.0 - shift.z());
}

}  // namespace

std::string spoken_box(const Box& box) {
  return fmt::format("X {:.3f} to {:.3f}, Y {:.3f} to {:.3f}, Z {:.3f} to {:.3f} mm", box.lower.x(),
                     box.upper.x(), box.lower.y(), box.upper.y(), box.lower.z(), box.upper.z());
}

DesignBeyond design_beyond(const Job& job) {
  return job.has_design() ? place_of(job).beyond : DesignBeyond{};
}

void check_design_place(const Job& job, Diagnostics& diagnostics) {
  if (!job.has_design()) return;
  const DesignPlace place = place_of(job);
  const double slack = job.design_mesh ? std::max(kBeyond, kMeshBeyond * place.box.size().norm()) : kBeyond;
  const Vec3& farthest = place.beyond.place;
  if (place.outside)
    diagnostics.error("design-outside-stock", job.scene.design.mesh_where,
                      fmt::format("the design lies outside the stock, all of it: {}; the stock is {}",
                                  spoken_box(place.box), spoken_box(job.scene.stock.body_W().box())),
                      remedy(job, place.box));
  else if (place.beyond.mm > slack)
    diagnostics.warning(
        "design-beyond-stock", job.scene.design.mesh_where,
        fmt::format("the design reaches out of the stock, by {:.3f} mm at ({:.3f}, {:.3f}, {:.3f}) mm: there "
                    "material is missing that nobody cuts, and counts as missing",
                    place.beyond.mm, farthest.x(), farthest.y(), farthest.z()),
        remedy(job, place.box));
}

void check_facet_chord(const Job& job, const TriMesh& mesh, Diagnostics& diagnostics) {
  const AcceptLimits& accept = job.scene.accept;
  if (!accept.gouge_max_um && !accept.excess_max_um) return;
  const mesh::FacetChord chord = mesh::estimate_facet_chord(mesh);
  const double chord_um = um_from_mm(chord.mm);
  const auto tell = [&](const char* key, std::optional<double> limit_um) {
    if (!limit_um || chord_um <= *limit_um) return;
    diagnostics.warning(
        "limit-below-facets", {job.scene.design.mesh_file},
        fmt::format(
            "accept.{} = {:g} um is below what the facets allow: they lie about {:.2g} um off the curved "
            "face at ({:.3f}, {:.3f}, {:.3f}) mm (estimated from their angles)",
            key, *limit_um, chord_um, chord.place.x(), chord.place.y(), chord.place.z()),
        fmt::format("give the part as STEP ([design] step), export finer facets, or allow {:.2g} um",
                    chord_um + *limit_um));
  };
  tell("gouge_max_um", accept.gouge_max_um);
  tell("excess_max_um", accept.excess_max_um);
}

}  // namespace swarf::sim

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "stock/rays/dexel_kernel.h"
#include "stock/rays/ray_field.h"

namespace swarf::stock {
namespace {

constexpr size_t kRowsPerTask = 8;
constexpr int kTileSide = 8;
static_assert(kTileSide * kTileSide == kTileRays);
/// Curves per direction, and samples along each, when the grid's lines are chosen.
constexpr int kCurves = 8;
constexpr int kLengthSamples = 64;
/// A fillet of a micrometre's radius would ask for more lines than this between two; the pitch is then too
/// coarse for the design, and the rest of the error is accepted.
constexpr int kMostDivisions = 64;

Vec3 point_at(const surface::Surface& surface, bool along_u, double t, double fixed) {
  return along_u ? surface.point(t, fixed) : surface.point(fixed, t);
}

/// Length of the longest of a few iso-parametric curves.
double longest_curve(const surface::Surface& surface, bool along_u) {
  double longest = 0.0;
  for (int curve = 0; curve <= kCurves; ++curve) {
    const double fixed = static_cast<double>(curve) / kCurves;
    double length = 0.0;
    for (int i = 0; i < kLengthSamples; ++i) {
      length += (point_at(surface, along_u, static_cast<double>(i + 1) / kLengthSamples, fixed) -
                 point_at(surface, along_u, static_cast<double>(i) / kLengthSamples, fixed))
                    .norm();
    }
    longest = std::max(longest, length);
  }
  return longest;
}

/// Greatest distance between chord and curve at the middle of [from, to], over a few iso-parametric curves.
double sagitta(const surface::Surface& surface, bool along_u, double from, double to) {
  double greatest = 0.0;
  for (int curve = 0; curve <= 4 * kCurves; ++curve) {
    const double fixed = static_cast<double>(curve) / (4 * kCurves);
    const Vec3 a = point_at(surface, along_u, from, fixed), b = point_at(surface, along_u, to, fixed);
    const Vec3 off = point_at(surface, along_u, 0.5 * (from + to), fixed) - a, chord = b - a;
    const double length2 = chord.squaredNorm();
    const Vec3 across = length2 > 0.0 ? Vec3(off - off.dot(chord) / length2 * chord) : off;
    greatest = std::max(greatest, across.norm());
  }
  return greatest;
}

std::vector<double> lines_along(const surface::Surface& surface, bool along_u, double pitch_mm,
                                double chord_mm) {
  const int even = std::max(1, static_cast<int>(std::ceil(longest_curve(surface, along_u) / pitch_mm)));
  std::vector<double> lines{0.0};
  for (int i = 0; i < even; ++i) {
    const double from = static_cast<double>(i) / even, to = static_cast<double>(i + 1) / even;
    // The sagitta falls with the square of the division.
    const double ratio = sagitta(surface, along_u, from, to) / chord_mm;
    const int parts = std::clamp(static_cast<int>(std::ceil(std::sqrt(ratio))), 1, kMostDivisions);
    for (int k = 1; k < parts; ++k) lines.push_back(from + (to - from) * k / parts);
    lines.push_back(to);
  }
  return lines;
}

/// Half the way to the lines on both sides.
double share_of_line(const std::vector<double>& lines, size_t i) {
  const double low = i > 0 ? lines[i - 1] : lines[i];
  const double high = i + 1 < lines.size() ? lines[i + 1] : lines[i];
  return 0.5 * (high - low);
}

void place_rays(RayField& field) {
  const size_t nu = field.u_lines.size(), nv = field.v_lines.size();
  field.points.resize(nu * nv);
  field.normals.resize(nu * nv);
  field.areas_mm2.resize(nu * nv);
  parallel_chunks(nv, kRowsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin * nu; n < end * nu; ++n) {
      const size_t iu = n % nu, iv = n / nu;
      const surface::Derivatives d = field.surface->derivatives(field.u_lines[iu], field.v_lines[iv]);
      field.points[n] = d.S;
      field.normals[n] = surface::outward_normal(*field.surface, d, {field.u_lines[iu], field.v_lines[iv]});
      field.areas_mm2[n] =
          d.Su.cross(d.Sv).norm() * share_of_line(field.u_lines, iu) * share_of_line(field.v_lines, iv);
    }
  });
}

void connect_grid(RayField& field) {
  const auto nu = static_cast<uint32_t>(field.u_lines.size()),
             nv = static_cast<uint32_t>(field.v_lines.size());
  field.edges.reserve(size_t{2} * nu * nv);
  field.triangles.reserve(size_t{2} * nu * nv);
  const bool turned = field.surface->outward_sign() < 0;
  for (uint32_t iv = 0; iv < nv; ++iv) {
    for (uint32_t iu = 0; iu < nu; ++iu) {
      const uint32_t n = iv * nu + iu;
      if (iu + 1 < nu) field.edges.push_back({n, n + 1});
      if (iv + 1 < nv) field.edges.push_back({n, n + nu});
      if (iu + 1 == nu || iv + 1 == nv) continue;
      const uint32_t beside = turned ? n + nu : n + 1, above = turned ? n + 1 : n + nu;
      field.triangles.push_back({n, beside, n + nu + 1});
      field.triangles.push_back({n, n + nu + 1, above});
    }
  }
}

void group_grid(RayField& field) {
  const auto nu = static_cast<uint32_t>(field.u_lines.size()),
             nv = static_cast<uint32_t>(field.v_lines.size());
  field.order.reserve(field.size());
  for (uint32_t iv = 0; iv < nv; iv += kTileSide) {
    for (uint32_t iu = 0; iu < nu; iu += kTileSide) {
      const auto begin = static_cast<uint32_t>(field.order.size());
      for (uint32_t j = iv; j < std::min(nv, iv + kTileSide); ++j) {
        for (uint32_t i = iu; i < std::min(nu, iu + kTileSide); ++i) field.order.push_back(j * nu + i);
      }
      add_tile(field, begin);
    }
  }
}

}  // namespace

RayFieldPtr rays_on_surface(const surface::SurfacePtr& surface, double pitch_mm, double chord_mm) {
  SWARF_CHECK(pitch_mm > 0.0 && chord_mm > 0.0, "rays need a pitch and a chord tolerance");
  auto field = std::make_shared<RayField>();
  field->pitch_mm = pitch_mm;
  field->chord_mm = chord_mm;
  field->surface = surface;
  field->u_lines = lines_along(*surface, true, pitch_mm, chord_mm);
  field->v_lines = lines_along(*surface, false, pitch_mm, chord_mm);
  place_rays(*field);
  connect_grid(*field);
  group_grid(*field);
  return field;
}

}  // namespace swarf::stock

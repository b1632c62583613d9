// From knots and poles to Bezier patches; where a surface has creases.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "surface/nurbs.h"

namespace swarf::surface {
namespace {

constexpr size_t kMostRow = kMostNurbsDegree + 1;

void check_knots(const std::vector<double>& knots, int degree, const char* side,
                 std::vector<std::string>& problems) {
  if (degree < 1 || degree > kMostNurbsDegree) {
    problems.push_back(fmt::format("degree {} in {}: 1 to {} are read", degree, side, kMostNurbsDegree));
    return;
  }
  const auto p = static_cast<size_t>(degree);
  if (knots.size() < 2 * p + 2) {
    problems.push_back(
        fmt::format("{} knots in {}: degree {} needs at least {}", knots.size(), side, degree, 2 * p + 2));
    return;
  }
  for (size_t i = 0; i < knots.size(); ++i) {
    if (std::isfinite(knots[i]) && (i == 0 || knots[i] >= knots[i - 1])) continue;
    problems.push_back(fmt::format("knot {} in {} is {:g}: knots must not fall", i + 1, side, knots[i]));
    return;
  }
  const double first = knots[p], last = knots[knots.size() - 1 - p];
  if (!(first < last)) {
    problems.push_back(
        fmt::format("the knots in {} leave no parameters: from {:g} to {:g}", side, first, last));
    return;
  }
  for (size_t i = 0; i < knots.size();) {
    const auto count = static_cast<size_t>(std::count(knots.begin(), knots.end(), knots[i]));
    if (knots[i] > first && knots[i] < last && count > p) {
      problems.push_back(
          fmt::format("knot {:g} in {} is repeated {} times: with degree {} the surface has a gap", knots[i],
                      side, count, degree));
    }
    i += count;
  }
}

/// Bezier poles of the span between knots k and k + 1 from the poles of a row: the blossom of the span's
/// polynomial at (a, .. a, b, .. b). Every step is a convex combination where a and b bound the span.
void row_to_bezier(const std::vector<double>& knots, int degree, size_t k, const Vec4* poles, size_t stride,
                   Vec4* bezier) {
  const auto p = static_cast<size_t>(degree);
  const double a = knots[k], b = knots[k + 1];
  for (size_t upper = 0; upper <= p; ++upper) {  // how many arguments are b
    std::array<Vec4, kMostRow> d;
    for (size_t i = 0; i <= p; ++i) d[i] = poles[(k - p + i) * stride];
    for (size_t r = 1; r <= p; ++r) {
      const double x = r <= upper ? b : a;
      for (size_t i = p; i >= r; --i) {
        const double from = knots[k - p + i], to = knots[k + 1 + i - r];
        d[i] = ((to - x) * d[i - 1] + (x - from) * d[i]) / (to - from);
      }
    }
    bezier[upper] = d[p];
  }
}

/// Knots that begin a span of some width, within the domain.
std::vector<size_t> spans_of(const std::vector<double>& knots, int degree) {
  std::vector<size_t> spans;
  const auto p = static_cast<size_t>(degree);
  for (size_t k = p; k + p + 1 < knots.size(); ++k) {
    if (knots[k] < knots[k + 1]) spans.push_back(k);
  }
  return spans;
}

std::vector<double> breaks_of(const std::vector<double>& knots, const std::vector<size_t>& spans) {
  const double first = knots[spans.front()], last = knots[spans.back() + 1];
  std::vector<double> breaks;
  breaks.reserve(spans.size() + 1);
  for (const size_t k : spans) breaks.push_back((knots[k] - first) / (last - first));
  breaks.push_back(1.0);
  return breaks;
}

/// Spans [from, to) along u of a grid, its breaks mapped to the unit interval.
BezierGrid between_u(const BezierGrid& grid, size_t from, size_t to) {
  const double low = grid.breaks_u[from], width = grid.breaks_u[to] - low;
  BezierGrid part{grid.degree_u, grid.degree_v, {}, grid.breaks_v, {}};
  for (size_t i = from; i <= to; ++i) part.breaks_u.push_back((grid.breaks_u[i] - low) / width);
  part.breaks_u.back() = 1.0;
  const size_t row = (grid.breaks_v.size() - 1) * grid.patch_size();
  const auto at = [&](size_t i) { return grid.poles.begin() + static_cast<std::ptrdiff_t>(i * row); };
  part.poles.assign(at(from), at(to));
  return part;
}

BezierGrid transposed(const BezierGrid& grid) {
  BezierGrid other{grid.degree_v, grid.degree_u, grid.breaks_v, grid.breaks_u, {}};
  other.poles.resize(grid.poles.size());
  const size_t nu = grid.breaks_u.size() - 1, nv = grid.breaks_v.size() - 1;
  const auto p = static_cast<size_t>(grid.degree_u + 1), q = static_cast<size_t>(grid.degree_v + 1);
  for (size_t i = 0; i < nu; ++i) {
    for (size_t j = 0; j < nv; ++j) {
      for (size_t k = 0; k < p; ++k) {
        for (size_t l = 0; l < q; ++l)
          other.poles[(j * nu + i) * p * q + l * p + k] = grid.poles[(i * nv + j) * p * q + k * q + l];
      }
    }
  }
  return other;
}

/// Of a homogeneous curve by its poles, at t.
Vec4 casteljau(const Vec4* poles, size_t count, double t) {
  std::array<Vec4, kMostRow> d;
  std::copy(poles, poles + count, d.begin());
  for (size_t r = 1; r < count; ++r) {
    for (size_t i = 0; i + r < count; ++i) d[i] += t * (d[i + 1] - d[i]);
  }
  return d[0];
}

/// Su at the end (or the beginning) of patch (i, j), by u of the whole grid, for a t of the patch.
Vec3 edge_derivative(const BezierGrid& grid, size_t i, size_t j, bool end, double t) {
  const size_t q = static_cast<size_t>(grid.degree_v) + 1, p = static_cast<size_t>(grid.degree_u);
  const Vec4* net = grid.poles.data() + (i * (grid.breaks_v.size() - 1) + j) * grid.patch_size();
  const Vec4 edge = casteljau(net + (end ? p : 0) * q, q, t);
  const Vec4 beside = casteljau(net + (end ? p - 1 : 1) * q, q, t);
  const Vec4 rise =
      (end ? edge - beside : beside - edge) * grid.degree_u / (grid.breaks_u[i + 1] - grid.breaks_u[i]);
  return (rise.head<3>() - edge.head<3>() / edge.w() * rise.w()) / edge.w();
}

/// Equality of two rational curves of degree 3 q over w^3 is decided by as many places and one more.
bool is_crease_at(const BezierGrid& grid, size_t line) {
  const int places = 3 * grid.degree_v + 2;
  double jump = 0.0, most = 0.0;
  for (size_t j = 0; j + 1 < grid.breaks_v.size(); ++j) {
    for (int k = 0; k < places; ++k) {
      const double t = (k + 0.5) / places;
      const Vec3 before = edge_derivative(grid, line - 1, j, true, t);
      const Vec3 after = edge_derivative(grid, line, j, false, t);
      jump = std::max(jump, (after - before).norm());
      most = std::max({most, before.norm(), after.norm()});
    }
  }
  return jump > kCreaseJump * most;
}

/// Breaks between which the grid has no crease across u, 0 and the last among them.
std::vector<size_t> creases_u(const BezierGrid& grid) {
  std::vector<size_t> lines{0};
  for (size_t i = 1; i + 1 < grid.breaks_u.size(); ++i) {
    if (is_crease_at(grid, i)) lines.push_back(i);
  }
  lines.push_back(grid.breaks_u.size() - 1);
  return lines;
}

}  // namespace

std::vector<std::string> nurbs_problems(const NurbsData& data) {
  std::vector<std::string> problems;
  check_knots(data.knots_u, data.degree_u, "u", problems);
  check_knots(data.knots_v, data.degree_v, "v", problems);
  if (!problems.empty()) return problems;
  const auto count = static_cast<size_t>(data.count_u()) * static_cast<size_t>(data.count_v());
  if (data.poles.size() != count) {
    problems.push_back(fmt::format("{} poles: knots and degrees ask for {} x {} = {}", data.poles.size(),
                                   data.count_u(), data.count_v(), count));
  }
  if (!data.weights.empty() && data.weights.size() != data.poles.size())
    problems.push_back(fmt::format("{} weights for {} poles", data.weights.size(), data.poles.size()));
  for (size_t i = 0; i < data.weights.size(); ++i) {
    if (data.weights[i] > 0.0 && std::isfinite(data.weights[i])) continue;
    problems.push_back(fmt::format("weight {} is {:g}: weights are above 0", i + 1, data.weights[i]));
    break;
  }
  const auto finite = [](const Vec3& P) { return P.allFinite(); };
  if (!std::all_of(data.poles.begin(), data.poles.end(), finite))
    problems.emplace_back("a pole is not a number");
  if (data.outward_sign != 1 && data.outward_sign != -1) problems.emplace_back("outward sign is +1 or -1");
  return problems;
}

BezierGrid bezier_grid(const NurbsData& data) {
  SWARF_CHECK(nurbs_problems(data).empty(), "data of a NURBS surface: " + nurbs_problems(data).front());
  const std::vector<size_t> spans_u = spans_of(data.knots_u, data.degree_u),
                            spans_v = spans_of(data.knots_v, data.degree_v);
  BezierGrid grid{
      data.degree_u, data.degree_v, breaks_of(data.knots_u, spans_u), breaks_of(data.knots_v, spans_v), {}};
  const auto p = static_cast<size_t>(data.degree_u + 1), q = static_cast<size_t>(data.degree_v + 1);
  const auto count_v = static_cast<size_t>(data.count_v());
  std::vector<Vec4> homogeneous;
  homogeneous.reserve(data.poles.size());
  for (size_t n = 0; n < data.poles.size(); ++n) {
    const double w = data.weights.empty() ? 1.0 : data.weights[n];
    homogeneous.emplace_back(w * data.poles[n].x(), w * data.poles[n].y(), w * data.poles[n].z(), w);
  }
  grid.poles.resize(spans_u.size() * spans_v.size() * p * q);
  std::vector<Vec4> rows(p * count_v);  // of one span in u: Bezier there, still a spline in v
  std::array<Vec4, kMostRow> bezier;
  for (size_t a = 0; a < spans_u.size(); ++a) {
    for (size_t j = 0; j < count_v; ++j) {
      row_to_bezier(data.knots_u, data.degree_u, spans_u[a], homogeneous.data() + j, count_v, bezier.data());
      for (size_t i = 0; i < p; ++i) rows[i * count_v + j] = bezier[i];
    }
    for (size_t b = 0; b < spans_v.size(); ++b) {
      Vec4* net = grid.poles.data() + (a * spans_v.size() + b) * p * q;
      for (size_t i = 0; i < p; ++i)
        row_to_bezier(data.knots_v, data.degree_v, spans_v[b], rows.data() + i * count_v, 1, net + i * q);
    }
  }
  return grid;
}

std::vector<NurbsPart> smooth_parts(const NurbsData& data) {
  const BezierGrid whole = bezier_grid(data);
  const std::vector<size_t> across_u = creases_u(whole), across_v = creases_u(transposed(whole));
  std::vector<NurbsPart> parts;
  for (size_t a = 0; a + 1 < across_u.size(); ++a) {
    const BezierGrid strip = transposed(between_u(whole, across_u[a], across_u[a + 1]));
    for (size_t b = 0; b + 1 < across_v.size(); ++b) {
      BezierGrid part = transposed(between_u(strip, across_v[b], across_v[b + 1]));
      parts.push_back({std::make_shared<NurbsSurface>(std::move(part), data.outward_sign),
                       {whole.breaks_u[across_u[a]], whole.breaks_v[across_v[b]]},
                       {whole.breaks_u[across_u[a + 1]], whole.breaks_v[across_v[b + 1]]}});
    }
  }
  return parts;
}

}  // namespace swarf::surface

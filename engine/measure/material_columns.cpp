#include "measure/material_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"

namespace swarf::measure {
namespace {

constexpr size_t kChunk = 4096;
constexpr int kWholePixels = 640;

struct Hit {
  uint32_t pixel;
  uint32_t triangle;
  double depth;
  bool design;
  int8_t turn;  ///< +1: the column enters the material
  bool operator<(const Hit& other) const {
    if (pixel != other.pixel) return pixel < other.pixel;
    if (depth != other.depth) return depth < other.depth;
    return design != other.design ? other.design : triangle < other.triangle;
  }
};

/// On which side of the edge between two vertices a pixel lies: both facets of the edge compute the same
/// number and take opposite sides of it, zero included.
bool inside_edge(const Vec3& p, const Vec3& q, uint32_t p_id, uint32_t q_id, double u, double v, bool turned,
                 double& weight) {
  const bool forward = p_id < q_id;
  const Vec3 &a = forward ? p : q, &b = forward ? q : p;
  const double value = (b.x() - a.x()) * (v - a.y()) - (b.y() - a.y()) * (u - a.x());
  weight = forward ? value : -value;
  return forward != turned ? value >= 0.0 : value < 0.0;
}

class Raster {
 public:
  Raster(const TriMesh& mesh, bool design, const ColumnGrid& grid)
      : mesh_(mesh), grid_(grid), design_(design) {}

  void draw(uint32_t triangle, std::vector<Hit>& hits) const {
    const auto& t = mesh_.triangles[triangle];
    const std::array<Vec3, 3> p{place(t[0]), place(t[1]), place(t[2])};
    const auto [u0, u1] = pixels(p, 0);
    const auto [v0, v1] = pixels(p, 1);
    if (u0 > u1 || v0 > v1) return;
    const double twice_area =
        (p[1].x() - p[0].x()) * (p[2].y() - p[0].y()) - (p[1].y() - p[0].y()) * (p[2].x() - p[0].x());
    if (twice_area == 0.0) return;
    for (int iv = v0; iv <= v1; ++iv) {
      const double v = grid_.low_v + (iv + 0.5) * grid_.step_v;
      const auto [first, last] = pixels_of_row(p, v);
      for (int iu = std::max(u0, first); iu <= std::min(u1, last); ++iu) {
        const double u = grid_.low_u + (iu + 0.5) * grid_.step_u;
        std::array<double, 3> w{};
        bool inside = true;
        for (size_t i = 0; i < 3 && inside; ++i) {
          const size_t a = (i + 1) % 3, b = (i + 2) % 3;
          inside = inside_edge(p[a], p[b], t[a], t[b], u, v, twice_area < 0.0, w[i]);
        }
        if (!inside) continue;
        const double depth = (w[0] * p[0].z() + w[1] * p[1].z() + w[2] * p[2].z()) / (w[0] + w[1] + w[2]);
        hits.push_back({static_cast<uint32_t>(iv * grid_.n + iu), triangle, depth, design_,
                        static_cast<int8_t>(twice_area < 0.0 ? 1 : -1)});
      }
    }
  }

 private:
  Vec3 place(uint32_t v) const {
    const auto& p = mesh_.positions[v];
    return grid_.frame * Vec3(p[0], p[1], p[2]);
  }
  /// Those of a row that may lie inside, with one more at either end: needles fill little of their box.
  std::pair<int, int> pixels_of_row(const std::array<Vec3, 3>& p, double v) const {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (size_t i = 0; i < 3; ++i) {
      const Vec3 &a = p[i], &b = p[(i + 1) % 3];
      if (std::min(a.y(), b.y()) > v || std::max(a.y(), b.y()) < v) continue;
      const double share = a.y() == b.y() ? 0.0 : (v - a.y()) / (b.y() - a.y());
      const double u = a.x() + share * (b.x() - a.x());
      least = std::min({least, u, a.y() == b.y() ? b.x() : u});
      most = std::max({most, u, a.y() == b.y() ? b.x() : u});
    }
    if (!(least <= most)) return {0, -1};
    const auto pixel = [&](double u) {
      return std::clamp((u - grid_.low_u) / grid_.step_u - 0.5, -1.0, grid_.n + 1.0);
    };
    return {static_cast<int>(std::floor(pixel(least))) - 1, static_cast<int>(std::ceil(pixel(most))) + 1};
  }
  std::pair<int, int> pixels(const std::array<Vec3, 3>& p, int axis) const {
    const double low = axis == 0 ? grid_.low_u : grid_.low_v, step = axis == 0 ? grid_.step_u : grid_.step_v;
    const double least = std::min({p[0][axis], p[1][axis], p[2][axis]});
    const double most = std::max({p[0][axis], p[1][axis], p[2][axis]});
    const auto pixel = [&](double x) { return std::clamp((x - low) / step - 0.5, -1.0, grid_.n + 1.0); };
    return {std::max(0, static_cast<int>(std::floor(pixel(least)))),
            std::min(grid_.n - 1, static_cast<int>(std::ceil(pixel(most))))};
  }

  const TriMesh& mesh_;
  const ColumnGrid& grid_;
  bool design_;
};

void collect(const TriMesh& mesh, bool design, const ColumnGrid& grid, std::vector<Hit>& hits) {
  const Raster raster(mesh, design, grid);
  std::vector<std::vector<Hit>> parts((mesh.triangles.size() + kChunk - 1) / kChunk);
  parallel_chunks(mesh.triangles.size(), kChunk, [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; ++t) raster.draw(static_cast<uint32_t>(t), parts[begin / kChunk]);
  });
  for (const auto& part : parts) hits.insert(hits.end(), part.begin(), part.end());
}

/// -1: of the design only, +1: of the stock only, 0: of both or of neither.
int material(const std::array<int, 2>& depth) {
  return int{depth[0] > 0} - int{depth[1] > 0};
}

}  // namespace

Mat3 column_frame(const Vec3& direction) {
  const Vec3 askew(0.0132, 0.0071, 0.0117);
  const Vec3 third = (direction.normalized() + askew).normalized();
  const Vec3 helper = std::abs(third.x()) < 0.6 ? Vec3(1.0, 0.137, 0.071) : Vec3(0.093, 1.0, 0.151);
  const Vec3 first = helper.cross(third).normalized();
  Mat3 frame;
  frame.row(0) = first;
  frame.row(1) = third.cross(first);
  frame.row(2) = third;
  return frame;
}

void each_run(const TriMesh& stock, const TriMesh& design, const ColumnGrid& grid,
              const std::function<void(const ColumnRun&)>& visit) {
  std::vector<Hit> hits;
  collect(stock, false, grid, hits);
  collect(design, true, grid, hits);
  std::sort(hits.begin(), hits.end());
  const auto end_at = [&](const Hit& hit) {
    const double u = grid.low_u + (static_cast<int>(hit.pixel) % grid.n + 0.5) * grid.step_u;
    const double v = grid.low_v + (static_cast<int>(hit.pixel) / grid.n + 0.5) * grid.step_v;
    return ColumnEnd{hit.design, hit.triangle, grid.frame.transpose() * Vec3(u, v, hit.depth)};
  };
  std::array<int, 2> depth{0, 0};
  size_t begin = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (i > 0 && hits[i].pixel != hits[i - 1].pixel) depth = {0, 0};
    const int before = material(depth);
    depth[hits[i].design ? 1 : 0] += hits[i].turn;
    const int after = material(depth);
    if (before == after) continue;
    if (before != 0) {
      visit({before < 0, hits[i].depth - hits[begin].depth, {end_at(hits[begin]), end_at(hits[i])}});
    }
    begin = i;
  }
}

MaterialVolumes volumes_between(const TriMesh& stock, const TriMesh& design) {
  // Along none of the axes: most faces of a part lie along two of them.
  const Mat3 middle = column_frame({0.53, 0.61, 0.59});
  MaterialVolumes volumes;
  for (int k = 0; k < 3; ++k) {
    ColumnGrid grid;
    grid.frame.row(0) = middle.row((k + 1) % 3);
    grid.frame.row(1) = middle.row((k + 2) % 3);
    grid.frame.row(2) = middle.row(k);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const TriMesh* mesh : {&stock, &design}) {
      for (const auto& p : mesh->positions) {
        const Vec3 q = grid.frame * Vec3(p[0], p[1], p[2]);
        low = low.cwiseMin(q);
        high = high.cwiseMax(q);
      }
    }
    grid.n = kWholePixels;
    grid.low_u = low.x();
    grid.low_v = low.y();
    grid.step_u = (high.x() - low.x()) / grid.n;
    grid.step_v = (high.y() - low.y()) / grid.n;
    const double pixel = grid.step_u * grid.step_v / 3.0;
    each_run(stock, design, grid, [&](const ColumnRun& run) {
      (run.gouge ? volumes.gouge_mm3 : volumes.excess_mm3) += pixel * run.length_mm;
    });
  }
  return volumes;
}

}  // namespace swarf::measure

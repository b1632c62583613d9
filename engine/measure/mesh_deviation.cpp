#include "measure/mesh_deviation.h"

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/units.h"
#include "mesh/signed_distance.h"

namespace swarf::measure {

void deviation_from_mesh(TriMesh& stock, const TriMesh& design, double reach_mm) {
  constexpr size_t kChunk = 4096;
  const mesh::SignedDistance distance(design);
  stock.deviation_um.assign(stock.positions.size(), std::numeric_limits<float>::quiet_NaN());
  parallel_chunks(stock.positions.size(), kChunk, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto& p = stock.positions[i];
      const double mm = distance.at({p[0], p[1], p[2]}, reach_mm).distance_mm;
      if (std::abs(mm) <= reach_mm) stock.deviation_um[i] = static_cast<float>(um_from_mm(mm));
    }
  });
}

}  // namespace swarf::measure

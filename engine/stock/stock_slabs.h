// What is proven of a stock slab by slab, so that several processes can share the proof.
//
// A slab is a row of planes of leaf positions across x. Its proof looks at its own leaves and at those beside
// them: so much of that is sent as the other does not hold already. What comes back is added up in the order
// of the positions, so the sums have the bits of one process.
#pragma once

#include <string>
#include <vector>

#include "base/bytes.h"
#include "stock/stock.h"
#include "stock/stock_tiles.h"

namespace swarf::stock {

struct StockProof {
  double volume_mm3 = 0.0;  ///< Stock::volume_mm3()
  VolumeRange range;        ///< Stock::volume_between()
  std::string broken_step;  ///< the first breach of invariant 8 of Stock::check(), or ""
};

class SlabProofs {
 public:
  /// Divides the stock into about so many slabs of equally many leaves, the last of them smaller. It must
  /// outlive it and stay as it is.
  SlabProofs(const Stock& stock, double slack_mm, size_t slabs);

  size_t count() const { return slabs_.size(); }
  /// Adds what answer() needs to know of it, where these tiles are held as they stand here.
  void add_request(size_t slab, const TileSet& held, BytesWriter& out) const;
  /// To what add_request() has added. `own` holds the tiles that are held.
  static Bytes answer(BytesReader& request, const Stock& own);
  void take(size_t slab, const Bytes& answer);
  /// The same, here.
  void prove(size_t slab);
  /// When all slabs are proven.
  StockProof result() const;

 private:
  struct Slab {
    int first = 0, last = 0;  ///< planes, from the first to behind the last
    std::string broken_step;
  };
  size_t begin_of(int plane) const;

  const Stock& stock_;
  double slack_mm_;
  std::vector<Slab> slabs_;
  std::vector<double> volumes_;      ///< by leaf position, in voxels
  std::vector<VolumeRange> ranges_;  ///< the same
};

}  // namespace swarf::stock

// Tiles that are cut apart and put together are the stock that is cut in one piece, to the last bit.
#include "stock/stock_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>

#include "cutter_shapes.h"
#include "stock/contact/contact_finder.h"
#include "stock/stock_slabs.h"
#include "stock_test_support.h"

namespace swarf::stock::stock_tiles_test {
namespace {

constexpr double kVoxel = 0.4;
const Box kBox{{-9.3, -7.1, -4.0}, {8.2, 9.4, 3.3}};

/// Ranks of one process: `lead` is whole, `others` hold their own tiles.
struct Rank {
  Rank(Stock&& made, const TileSet& own) : stock(std::move(made)), tiles(stock, own) {}
  Stock stock;
  StockTiles tiles;
};
std::vector<std::unique_ptr<Rank>> ranks_of(const RawShape& raw, int count) {
  std::vector<std::unique_ptr<Rank>> ranks;
  ranks.push_back(std::make_unique<Rank>(Stock(raw, kVoxel), Share{0, count}));
  for (int n = 1; n < count; ++n)
    ranks.push_back(
        std::make_unique<Rank>(StockTiles::own_tiles(raw, kVoxel, Share{n, count}), Share{n, count}));
  return ranks;
}

void cut_all(std::vector<std::unique_ptr<Rank>>& ranks, const std::vector<Sweep>& sweeps,
             const CutterSolid& cutter) {
  for (auto& rank : ranks) rank->stock.cut(sweeps, cutter);
}
void gather(std::vector<std::unique_ptr<Rank>>& ranks) {
  for (size_t n = 1; n < ranks.size(); ++n)
    while (const auto piece = ranks[n]->tiles.next_changes()) ranks[0]->tiles.apply(*piece);
}

std::vector<Sweep> sweeps_of(Rng& rng, int count) {
  std::vector<Sweep> sweeps;
  for (int n = 0; n < count; ++n) sweeps.push_back(random_sweep(rng, 12.0, 6.0, n % 2 == 0 ? 0.0 : 0.4));
  return sweeps;
}

void expect_equal(const Stock& one, const Stock& other) {
  EXPECT_EQ(one.hash(), other.hash());
  EXPECT_EQ(one.check(), "");
  EXPECT_EQ(one.leaves(), other.leaves());
  EXPECT_EQ(one.volume_mm3(), other.volume_mm3());
  EXPECT_EQ(one.rounding_mm(), other.rounding_mm());
  EXPECT_EQ(one.statistics().voxel_updates, other.statistics().voxel_updates);
  EXPECT_EQ(one.statistics().leaf_visits, other.statistics().leaf_visits);
}

TEST(StockTiles, CutApartAndGatheredTheyAreTheStockOfOneProcess) {
  const RawShape raw = RawShape::of_box(kBox);
  Rng rng(19);
  for (const int count : {1, 2, 3, 4, 7, 8}) {
    SCOPED_TRACE(fmt::format("{} ranks", count));
    const CutterSolid cutter = count % 2 == 0 ? ball_nose(2.0, 9.0) : CutterSolid(2.5, 10.0);
    Stock whole(raw, kVoxel);
    auto ranks = ranks_of(raw, count);
    for (int step = 0; step < 4; ++step) {
      const std::vector<Sweep> sweeps = sweeps_of(rng, 12);
      whole.cut(sweeps, cutter);
      cut_all(ranks, sweeps, cutter);
      if (step == 1) continue;  // two cuts between two looks
      gather(ranks);
      expect_equal(ranks[0]->stock, whole);
    }
  }
}

TEST(StockTiles, OneThatBeginsLaterTakesOverWhatIsThere) {
  const RawShape raw = RawShape::of_box(kBox);
  Rng rng(20);
  const CutterSolid cutter(2.5, 10.0);
  Stock whole(raw, kVoxel);
  whole.cut(sweeps_of(rng, 20), cutter);
  auto ranks = ranks_of(raw, 1);
  ranks[0] = std::make_unique<Rank>(whole.clone(), Share{0, 3});
  for (int n = 1; n < 3; ++n) {
    ranks.push_back(std::make_unique<Rank>(StockTiles::own_tiles(raw, kVoxel, Share{n, 3}), Share{n, 3}));
    size_t from = 0;
    while (const auto piece = StockTiles::next_tiles(ranks[0]->stock, Share{n, 3}, from))
      ranks.back()->tiles.apply(*piece);
  }
  const std::vector<Sweep> more = sweeps_of(rng, 20);
  whole.cut(more, cutter);
  cut_all(ranks, more, cutter);
  gather(ranks);
  expect_equal(ranks[0]->stock, whole);
}

/// The least gap over all is that of the rank whose tile is nearest; a hint is seen where it lies.
TEST(StockTiles, TheLeastGapOfAllRanksIsThatOfTheWhole) {
  const RawShape raw = RawShape::of_box(kBox);
  Rng rng(21);
  const CutterSolid cutter(2.5, 10.0);
  Stock whole(raw, kVoxel);
  auto ranks = ranks_of(raw, 3);
  const std::vector<Sweep> sweeps = sweeps_of(rng, 20);
  whole.cut(sweeps, cutter);
  cut_all(ranks, sweeps, cutter);
  const ContactFinder all(whole);
  const RevolvedPart shank = RevolvedPart::frustum(10.0, 20.0, 3.0, 4.0);
  int near = 0;
  for (int n = 0; n < 200; ++n) {
    const SweepMap map = sweep_map(random_sweep(rng, 25.0, 6.0, 0.3));
    const double above = 3.0 * kVoxel;
    double least = above;
    bool hint = false;
    for (const auto& rank : ranks) {
      const ContactFinder own(rank->stock, ContactFinder::Tiles::kOwn);
      least = std::min(least, own.gap(map, shank, above));
      hint = hint || own.may_be_shallow(map, shank, 0.0);
    }
    const double gap = all.gap(map, shank, above);
    EXPECT_EQ(hint, all.may_be_shallow(map, shank, 0.0)) << "case " << n;
    if (gap < -all.deep_mm())
      EXPECT_LT(least, -all.deep_mm()) << "case " << n;  // neither looks further
    else
      EXPECT_EQ(least, gap) << "case " << n;
    near += gap < above ? 1 : 0;
  }
  EXPECT_GT(near, 20);
}

/// Rank 0 leaves some parts of its tiles to another one.
TEST(StockTiles, PartsOfAShareAreCutElsewhere) {
  const RawShape raw = RawShape::of_box(kBox);
  Rng rng(24);
  const CutterSolid cutter(2.5, 10.0);
  const std::vector<Sweep> sweeps = sweeps_of(rng, 20);
  Stock whole(raw, kVoxel);
  whole.cut(sweeps, cutter);
  constexpr uint32_t kGiven = 0b10010110;
  std::vector<std::unique_ptr<Rank>> ranks;
  ranks.push_back(
      std::make_unique<Rank>(Stock(raw, kVoxel), TileSet(Share{0, 2}, TileSet::kAllParts ^ kGiven)));
  for (const TileSet& own : {TileSet(Share{1, 2}), TileSet(Share{0, 2}, kGiven)})
    ranks.push_back(std::make_unique<Rank>(StockTiles::own_tiles(raw, kVoxel, own), own));
  cut_all(ranks, sweeps, cutter);
  gather(ranks);
  expect_equal(ranks[0]->stock, whole);
}

/// One rank is ahead with all tiles; the lead takes some of them as they stand, and both cut on. The work of
/// both together is that of one process, so each knows as much of its leaves as one process would.
TEST(StockTiles, TilesThatAreLeftToAnotherGoOnThere) {
  const RawShape raw = RawShape::of_box(kBox);
  constexpr uint32_t kTaken = 0b01101001;
  const TileSet taken(Share{0, 1}, kTaken), kept = taken.others();
  for (const uint64_t seed : {25, 26, 27, 28, 29, 30, 31, 32}) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Rng rng(seed);
    const CutterSolid cutter = seed % 2 == 0 ? ball_nose(2.0, 9.0) : CutterSolid(2.5, 10.0);
    const std::vector<Sweep> first = sweeps_of(rng, 20), then = sweeps_of(rng, 20);
    Stock whole(raw, kVoxel);
    whole.cut(first, cutter);
    whole.cut(then, cutter);
    std::vector<std::unique_ptr<Rank>> ranks;
    ranks.push_back(std::make_unique<Rank>(Stock(raw, kVoxel), taken));
    ranks.push_back(std::make_unique<Rank>(Stock(raw, kVoxel), TileSet()));
    ranks[1]->stock.cut(first, cutter);
    const size_t leaves = ranks[1]->stock.leaves();
    while (const auto piece = ranks[1]->tiles.next_left(kept)) ranks[0]->tiles.apply(*piece);
    EXPECT_LT(ranks[1]->stock.leaves(), leaves);
    EXPECT_EQ(ranks[1]->stock.check(CheckLevel::kOwnMap), "");
    cut_all(ranks, then, cutter);
    gather(ranks);
    expect_equal(ranks[0]->stock, whole);
  }
}

/// Deep inside, a node of the tree lies in tiles of this rank and of others, and has no leaf.
TEST(StockTiles, OwnTilesHoldTheInvariantsDeepInside) {
  constexpr double kFine = 0.1, kSide = 27.0;  // 34 leaf positions along each side, a node has 16
  const RawShape raw =
      RawShape::of_box({{-0.5 * kSide, -0.5 * kSide, -kSide}, {0.5 * kSide, 0.5 * kSide, 0.0}});
  for (const int rank : {0, 1}) {
    Stock stock = StockTiles::own_tiles(raw, kFine, Share{rank, 2});
    EXPECT_EQ(stock.check(CheckLevel::kOwnMap), "") << "rank " << rank;
  }
}

const TileSet kNoTiles(Share{}, 0);

/// Slab by slab, by whoever: the volume's bounds to the last bit. Who holds tiles is sent the others.
TEST(StockTiles, WhatIsProvenSlabBySlabIsProvenOfTheWhole) {
  Rng rng(22);
  auto ranks = ranks_of(RawShape::of_box(kBox), 2);
  cut_all(ranks, sweeps_of(rng, 20), CutterSolid(2.5, 10.0));
  gather(ranks);
  const Stock& stock = ranks[0]->stock;
  const TileSet kept(Share{1, 2});
  const VolumeRange whole = stock.volume_between(0.01);
  for (const size_t slabs : {1, 2, 5, 100}) {
    SlabProofs proofs(stock, 0.01, slabs);
    EXPECT_LE(proofs.count(), 2 * static_cast<size_t>(slabs));
    for (size_t n = 0; n < proofs.count(); ++n) {
      if (n % 2 == 1) {
        proofs.prove(n);
        continue;
      }
      BytesWriter all, out;
      proofs.add_request(n, kNoTiles, all);
      proofs.add_request(n, kept, out);
      EXPECT_LT(out.size(), all.size()) << slabs;
      const Bytes request = (n % 4 == 0 ? out : all).take();
      BytesReader in(request);
      proofs.take(n, SlabProofs::answer(in, ranks[1]->stock));
    }
    const StockProof proof = proofs.result();
    EXPECT_EQ(proof.volume_mm3, stock.volume_mm3()) << slabs;
    EXPECT_EQ(proof.range.least, whole.least) << slabs;
    EXPECT_EQ(proof.range.greatest, whole.greatest) << slabs;
    EXPECT_EQ(proof.broken_step, "") << slabs;
  }
}

/// A breach between two leaves, wherever it is.
TEST(StockTiles, ABrokenStepIsSeenWhereTheSlabIsProven) {
  Rng rng(23);
  Stock stock(RawShape::of_box(kBox), kVoxel);
  stock.cut(sweeps_of(rng, 20), CutterSolid(2.5, 10.0));
  SlabProofs proofs(stock, 0.0, 1);
  BytesWriter out;
  proofs.add_request(0, kNoTiles, out);
  Bytes request = out.take();
  // The last voxel of the last leaf, from one end of the band to the other.
  float value = 0.0F;
  std::byte* const last = request.data() + request.size() - sizeof(value);
  std::memcpy(&value, last, sizeof(value));
  value = static_cast<float>(value > 0.0F ? -3.0 * kVoxel : 3.0 * kVoxel);
  std::memcpy(last, &value, sizeof(value));
  BytesReader in(request);
  proofs.take(0, SlabProofs::answer(in, stock));
  EXPECT_EQ(proofs.result().broken_step.substr(0, 2), "8:");
}

TEST(StockTiles, EveryRowAndColumnOfTilesIsSharedByAll) {
  for (const int count : {1, 2, 3, 4, 5, 6, 7, 8, 12, 64}) {
    for (int line = -3; line < 3; ++line) {
      std::map<int, int> along_x, along_y;
      for (int n = -count; n < count; ++n) {
        ++along_x[owner_of_column(n * kTileLeaves, line * kTileLeaves, count)];
        ++along_y[owner_of_column(line * kTileLeaves + 7, n * kTileLeaves + 7, count)];
      }
      for (int rank = 0; rank < count; ++rank) {
        EXPECT_EQ(along_x[rank], 2) << count << " ranks, row " << line;
        EXPECT_EQ(along_y[rank], 2) << count << " ranks, column " << line;
      }
    }
  }
}

}  // namespace
}  // namespace swarf::stock::stock_tiles_test

// A stock whose leaves go to the disk is the stock that keeps them all in memory: the same answers to
// everything that it is asked, and the same file.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/parallel.h"
#include "stock/contact/contact_finder.h"
#include "stock/stock.h"
#include "stock_test_support.h"

namespace swarf::stock::stock_spill_test {
namespace {

namespace fs = std::filesystem;
const CutterSolid kCutter{2.0, 10.0};

/// Rows over the block, tilted a little, one beside the other; some of them a second time, deeper.
std::vector<Sweep> rows() {
  std::vector<Sweep> sweeps;
  uint32_t block = 0;
  for (const double z : {-1.0, -1.7})
    for (double y = -7.0; y < 7.0; y += z < -1.5 ? 2.5 : 0.7)
      sweeps.push_back(
          {{{-9, y, z}, Vec3::UnitZ()}, {{9, y + 0.3, z - 0.4}, Vec3(0.05, 0, 1).normalized()}, block++});
  return sweeps;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class StockSpill : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("stock_spill_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void expect_same(const RawShape& raw, size_t leaves_most) const {
    Stock whole(raw, 0.25);
    const Spill spill{folder_.string(), leaves_most};
    Stock spilled(raw, 0.25, &spill);
    EXPECT_GT(spilled.leaves_on_disk(), 0U);
    size_t most_on_disk = 0;
    uint32_t step = 0;
    for (const Sweep& sweep : rows()) {
      whole.cut({&sweep, 1}, kCutter);
      spilled.cut({&sweep, 1}, kCutter);
      std::vector<uint32_t> next(Stock::tiles_of(raw.box(), 0.25).size());
      for (size_t n = 0; n < next.size(); ++n) next[n] = static_cast<uint32_t>(n * 7 + step) % 11;
      spilled.make_room(next);
      EXPECT_LE(spilled.leaves() - spilled.leaves_on_disk(), leaves_most);
      most_on_disk = std::max(most_on_disk, spilled.leaves_on_disk());
      ++step;
    }
    EXPECT_EQ(spilled.leaves(), whole.leaves());
    EXPECT_GT(most_on_disk, whole.leaves() / 2);
    EXPECT_TRUE(fs::is_empty(folder_));  // the file has no name that could be left behind
    EXPECT_EQ(spilled.hash(), whole.hash());
    EXPECT_EQ(spilled.check(), "");
    EXPECT_EQ(spilled.volume_mm3(), whole.volume_mm3());
    const VolumeRange range = spilled.volume_between(0.01), expected = whole.volume_between(0.01);
    EXPECT_EQ(range.least, expected.least);
    EXPECT_EQ(range.greatest, expected.greatest);
    EXPECT_EQ(spilled.air_points(0.3).size(), whole.air_points(0.3).size());
    EXPECT_EQ(spilled.distance_mm({1, 2, -1.3}), whole.distance_mm({1, 2, -1.3}));
    const TriMesh mesh = spilled.mesh(), expected_mesh = whole.mesh();
    ASSERT_EQ(mesh.positions.size(), expected_mesh.positions.size());
    for (size_t n = 0; n < mesh.positions.size(); ++n)
      ASSERT_EQ(mesh.positions[n], expected_mesh.positions[n]);
    const Stock copy = spilled.clone();
    EXPECT_EQ(copy.hash(), whole.hash());
    EXPECT_EQ(spilled.check_since(copy), "");
    whole.save((folder_ / "whole.vdb").string(), {{"key", "value"}});
    spilled.save((folder_ / "spilled.vdb").string(), {{"key", "value"}});
    EXPECT_TRUE(bytes_of(folder_ / "whole.vdb") == bytes_of(folder_ / "spilled.vdb"));
    EXPECT_EQ(Stock::load((folder_ / "spilled.vdb").string()).hash(), whole.hash());
  }

  fs::path folder_;
};

TEST_F(StockSpill, BoxAnswersAsIfAllWereInMemory) {
  expect_same(RawShape::of_box({{-8, -8, -5}, {8, 8, 0}}), 60);
}

TEST_F(StockSpill, NothingAtAllMayStayInMemory) {
  expect_same(RawShape::of_box({{-8, -8, -5}, {8, 8, 0}}), 0);
}

TEST(StockTileGrid, CoversTheStockAndItsBand) {
  const TileGrid tiles = Stock::tiles_of({{-8, -8, -5}, {8, 8, 0}}, 0.25);
  EXPECT_DOUBLE_EQ(tiles.side_mm, 8 * 8 * 0.25);
  EXPECT_LE(tiles.lower_mm.x(), -8.75);
  EXPECT_GE(tiles.lower_mm.y() + tiles.count_y * tiles.side_mm, 8.75);
}

TEST_F(StockSpill, AFolderThatTakesNoFileIsTold) {
  const Spill spill{(folder_ / "nothing").string(), 10};
  try {
    Stock(RawShape::of_box({{-8, -8, -5}, {8, 8, 0}}), 0.25, &spill);
    FAIL() << "made";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().front().code, "spill-unwritable");
  }
}

}  // namespace
}  // namespace swarf::stock::stock_spill_test

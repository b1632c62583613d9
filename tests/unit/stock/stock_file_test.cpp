#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <fstream>

#include "base/diagnostics.h"
#include "stock/stock.h"
#include "stock_test_support.h"
#include "support/full_disk.h"
#include "support/scratch.h"

namespace swarf::stock {
namespace {

namespace fs = std::filesystem;

class StockFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(test::scratch_text()) / "stock_file_test";
    fs::remove_all(folder);
    fs::create_directories(folder);
    path = (folder / "stock.vdb").string();
  }
  static Stock small_stock() {
    Stock stock({{-6, -6, -4}, {6, 6.05, 0}}, 0.3);
    stock.cut(
        std::vector<Sweep>{{{{-2, 0, -1.5}, Vec3::UnitZ()}, {{3, 1, -1}, Vec3(0.1, 0, 1).normalized()}, 0}},
        CutterSolid{2.0, 10.0});
    return stock;
  }
  std::string code_of_load() const {
    try {
      Stock::load(path);
    } catch (const InputError& error) {
      EXPECT_FALSE(error.diagnostics.list().front().fix.empty());
      EXPECT_EQ(error.diagnostics.list().front().where.file, path);
      return error.diagnostics.list().front().code;
    }
    return "";
  }
  void write(const std::string& bytes) const {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }
  fs::path folder;
  std::string path;
};

TEST_F(StockFile, RoundTripIsBitIdenticalAndCutsOn) {
  Stock stock = small_stock();
  stock.save(path, {{"scene", "test"}, {"cutter", "D4"}});
  Stock loaded = Stock::load(path);
  EXPECT_EQ(loaded.hash(), stock.hash());
  EXPECT_EQ(loaded.check(), "");
  EXPECT_EQ(loaded.voxel_mm(), stock.voxel_mm());
  EXPECT_EQ(loaded.box().upper, stock.box().upper);
  const std::vector<Sweep> more{{{{0, -7, -2}, Vec3::UnitZ()}, {{0, 7, -3}, Vec3::UnitZ()}, 1}};
  stock.cut(more, CutterSolid{2.0, 10.0});
  loaded.cut(more, CutterSolid{2.0, 10.0});
  EXPECT_EQ(loaded.hash(), stock.hash());
  EXPECT_EQ(loaded.volume_mm3(), stock.volume_mm3());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(StockFile, EqualStocksAreEqualFiles) {
  const auto bytes_of = [&](const Stock& stock, const StockMetadata& metadata) {
    stock.save(path, metadata);
    std::ifstream in(path, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  };
  const std::string first = bytes_of(small_stock(), {{"scene", "test"}});
  EXPECT_EQ(bytes_of(small_stock(), {{"scene", "test"}}), first);
  EXPECT_EQ(bytes_of(Stock::load(path), {{"scene", "test"}}), first);
  EXPECT_NE(bytes_of(small_stock(), {{"scene", "other"}}), first);
}

TEST_F(StockFile, OpensInOpenVdbWithItsMetadata) {
  small_stock().save(path, {{"scene", "test"}});
  openvdb::io::File file(path);
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("stock"));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(grid->metaValue<std::string>("scene"), "test");
  EXPECT_NEAR(grid->voxelSize().x(), 0.3, 1e-12);
}

TEST_F(StockFile, EveryTruncationIsRecognised) {
  small_stock().save(path, {});
  std::ifstream in(path, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  in.close();
  for (size_t keep = 1; keep < whole.size(); keep += 1 + whole.size() / 60) {
    write(whole.substr(0, keep));
    EXPECT_EQ(code_of_load(), "stock-file-incomplete") << keep << " of " << whole.size() << " bytes";
  }
  write(whole.substr(0, whole.size() - 1));
  EXPECT_EQ(code_of_load(), "stock-file-incomplete");
}

TEST_F(StockFile, EveryFlippedByteIsRecognised) {
  small_stock().save(path, {});
  std::ifstream in(path, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  in.close();
  constexpr uint64_t kSeed = 71;
  Rng rng(kSeed);
  for (int n = 0; n < 100; ++n) {
    std::string damaged = whole;
    const size_t at = rng.next() % whole.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << rng.next() % 8));
    write(damaged);
    EXPECT_NE(code_of_load(), "") << "seed " << kSeed << " byte " << at;
  }
}

TEST_F(StockFile, WhatIsNoStockFileIsRefused) {
  EXPECT_EQ(code_of_load(), "stock-file-unreadable");
  write("");
  EXPECT_EQ(code_of_load(), "stock-file-empty");
  write("G21 G90\nM30\n");
  EXPECT_EQ(code_of_load(), "stock-file-foreign");
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_EQ(code_of_load(), "stock-file-unreadable");
}

/// Writes a grid as any OpenVDB program does.
void write_grid(const std::string& path, openvdb::GridClass grid_class) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(1.0F);
  grid->setName("density");
  grid->setGridClass(grid_class);
  openvdb::io::File file(path);
  file.write(openvdb::GridPtrVec{grid});
  file.close();
}

TEST_F(StockFile, AnotherProgramsGridIsRefused) {
  write_grid(path, openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(code_of_load(), "stock-file-foreign");
  write_grid(path, openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(code_of_load(), "stock-not-level-set");
  write_grid(path, openvdb::GRID_UNKNOWN);
  EXPECT_EQ(code_of_load(), "stock-not-level-set");
}

TEST_F(StockFile, SavedAgainByAnotherProgramIsRefused) {
  small_stock().save(path, {});
  openvdb::io::File file(path);
  file.open();
  const auto grids = file.getGrids();
  file.close();
  openvdb::io::File(path).write(*grids);
  EXPECT_EQ(code_of_load(), "stock-file-incomplete");
}

TEST_F(StockFile, MetadataComesBack) {
  small_stock().save(path, {{"swarf_scene", "dome"}, {"swarf_block", "17"}});
  StockMetadata metadata;
  Stock::load(path, &metadata);
  EXPECT_EQ(metadata.at("swarf_scene"), "dome");
  EXPECT_EQ(metadata.at("swarf_block"), "17");
}

TEST_F(StockFile, CloneIsItsOwnStock) {
  Stock stock = small_stock();
  Stock copy = stock.clone();
  EXPECT_EQ(copy.hash(), stock.hash());
  EXPECT_EQ(copy.check(), "");
  const uint64_t before = stock.hash();
  copy.cut(std::vector<Sweep>{{{{0, -7, -2}, Vec3::UnitZ()}, {{0, 7, -3}, Vec3::UnitZ()}, 1}},
           CutterSolid{2.0, 10.0});
  EXPECT_NE(copy.hash(), before);
  EXPECT_EQ(stock.hash(), before);
  EXPECT_EQ(copy.check_since(stock), "");
  // The other way round material grows.
  EXPECT_NE(stock.check_since(copy), "");
}

TEST_F(StockFile, FailedSaveSaysSoAndKeepsTheOldFile) {
  const Stock stock = small_stock();
  EXPECT_THROW(stock.save((folder / "missing" / "stock.vdb").string(), {}), InputError);
  stock.save(path, {});
  const uintmax_t size = fs::file_size(path);
  for (const uintmax_t room : {uintmax_t{0}, size / 2, size - 1}) {
    const test::FullDisk disk(room);
    EXPECT_THROW(stock.save(path, {}), InputError) << room << " of " << size << " bytes";
  }
  EXPECT_EQ(Stock::load(path).hash(), stock.hash());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace swarf::stock

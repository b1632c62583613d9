// Packed elements are given out as they were put in, to the last bit.
#include "toolpath/elements.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

#include "base/rng.h"

namespace swarf::toolpath {
namespace {

bool same_bits(const double* a, const double* b, size_t count) {
  return std::memcmp(a, b, count * sizeof(double)) == 0;
}
bool same_pose(const ToolPose& a, const ToolPose& b) {
  return same_bits(a.tip_W.data(), b.tip_W.data(), 3) && same_bits(a.axis_W.data(), b.axis_W.data(), 3);
}
bool same_number(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && (!a || same_bits(&*a, &*b, 1));
}

std::string difference(const Element& one, const Element& other) {
  const auto& a = std::get<BlockMove>(one.what);
  const auto& b = std::get<BlockMove>(other.what);
  if (!same_pose(a.from, b.from)) return "from";
  if (!same_pose(a.to, b.to)) return "to";
  if (a.arc.has_value() != b.arc.has_value()) return "arc";
  if (a.arc && (a.arc->centre_W != b.arc->centre_W || a.arc->normal_W != b.arc->normal_W))
    return "arc's place";
  if (a.axes.has_value() != b.axes.has_value()) return "axes";
  if (a.axes && !same_bits(a.axes->from.data(), b.axes->from.data(), kinematics::kMaxAxes))
    return "axes from";
  if (a.axes && !same_bits(a.axes->to.data(), b.axes->to.data(), kinematics::kMaxAxes)) return "axes to";
  if (a.law != b.law) return "law";
  if (!same_bits(&a.feed_mm_s, &b.feed_mm_s, 1) || !same_bits(&a.duration_s, &b.duration_s, 1)) return "feed";
  if (a.dwell_s != b.dwell_s || a.exact_stop != b.exact_stop) return "stop";
  if (a.corner_tolerance_mm != b.corner_tolerance_mm) return "corner";
  if (!same_number(a.spindle_rpm, b.spindle_rpm)) return "spindle";
  if (a.tool != b.tool || a.pass != b.pass) return "tool";
  const SourceLocation &p = one.where, &q = other.where;
  if (one.operation != other.operation || p.file != q.file || p.line != q.line || p.column != q.column)
    return "where";
  return "";
}

/// Programs as they come: most blocks join, many say the same as the one before, some numbers are -0.
std::vector<Element> random_blocks(Rng& rng, size_t count) {
  const double zeros[] = {0.0, -0.0};
  std::vector<Element> elements;
  BlockMove block;
  SourceLocation where{"main.nc", 0, 1};
  for (size_t i = 0; i < count; ++i) {
    const auto rarely = [&](double share) { return rng.uniform() < share; };
    block.from = block.to;
    if (rarely(0.01)) block.from.tip_W.x() = -block.from.tip_W.x();  // 0 becomes -0
    if (block.axes) block.axes->from = block.axes->to;
    if (rarely(0.02)) block.axes.reset();
    if (!block.axes && rarely(0.5)) block.axes.emplace();
    for (int k = 0; k < 3; ++k)
      if (rarely(0.5)) block.to.tip_W[k] = rarely(0.2) ? zeros[i % 2] : rng.uniform(-100, 100);
    if (rarely(0.1)) block.to.axis_W = rng.direction();
    if (block.axes && rarely(0.7)) block.axes->to[static_cast<int>(i % 5)] = rng.uniform(-3, 3);
    block.arc.reset();
    if (rarely(0.1)) block.arc = program::Arc{rng.direction(), rng.direction()};
    if (rarely(0.05)) block.law = static_cast<BlockLaw>(i % 4);
    if (rarely(0.05)) block.feed_mm_s = rng.uniform(0, 100);
    block.duration_s = rarely(0.5) ? rng.uniform() : 0.0;
    if (rarely(0.01)) block.spindle_rpm = rng.uniform(-1000, 1000);
    block.dwell_s = rarely(0.01) ? rng.uniform() : 0.0;
    block.exact_stop = rarely(0.05);
    if (rarely(0.02)) block.corner_tolerance_mm = rng.uniform();
    if (rarely(0.01)) block.tool = static_cast<int>(i % 3);
    if (rarely(0.02)) ++block.pass;
    if (rarely(0.01)) where.file = where.file == "main.nc" ? "sub.spf" : "main.nc";
    ++where.line;
    elements.push_back({block, static_cast<int>(i % 2000 / 1000), where});
  }
  return elements;
}

TEST(Elements, BlocksAreGivenOutToTheLastBit) {
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    Rng rng(seed);
    // Within a chunk, at its border and beyond several.
    const size_t count = seed == 1 ? 1023 : seed == 2 ? 1024 : seed == 3 ? 1025 : 5000;
    const std::vector<Element> blocks = random_blocks(rng, count);
    const Elements packed(blocks);
    ASSERT_EQ(packed.size(), count);
    EXPECT_TRUE(packed.hold_blocks());
    for (size_t i = 0; i < count; ++i) {
      ASSERT_EQ(difference(packed[i], blocks[i]), "") << fmt::format("Rng rng({}); block {}", seed, i);
      const auto& block = std::get<BlockMove>(blocks[i].what);
      ASSERT_TRUE(same_pose(packed.block_end(i), block.to));
      ASSERT_EQ(packed.feed_mm_s(i), block.feed_mm_s);
      ASSERT_EQ(packed.tool(i), block.tool);
      ASSERT_EQ(packed.line(i), blocks[i].where.line);
    }
    size_t n = 0;
    for (const Element& element : packed) ASSERT_EQ(difference(element, blocks[n++]), "");
    EXPECT_EQ(n, count);
  }
}

TEST(Elements, OfACopyAreItsOwn) {
  Rng rng(20);
  const std::vector<Element> blocks = random_blocks(rng, 1500);
  Elements one(std::vector<Element>(blocks.begin(), blocks.begin() + 1200));
  Elements other = one;
  for (size_t i = 1200; i < 1500; ++i) other.push_back(blocks[i]);
  other.rename_files([](const std::string& name) { return "O" + name; });
  ASSERT_EQ(one.size(), 1200U);
  ASSERT_EQ(other.size(), 1500U);
  for (size_t i = 0; i < 1200; ++i) ASSERT_EQ(difference(one[i], blocks[i]), "") << i;
  EXPECT_EQ(other.where(1499).file, "O" + blocks[1499].where.file);
  EXPECT_EQ(one.where(1199).file, blocks[1199].where.file);
}

/// Parts of two paths in turn, single elements between them, with names of files that the new path has not.
TEST(Elements, AppendedAreThoseOfTheOtherPath) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    Rng rng(seed);
    const std::vector<std::vector<Element>> blocks{random_blocks(rng, 3000), random_blocks(rng, 3000)};
    std::vector<Elements> sources{Elements(blocks[0]), Elements(blocks[1])};
    sources[1].rename_files([](const std::string& name) { return "P" + name; });
    Elements joined;
    std::vector<Element> wanted;
    for (int part = 0; part < 30; ++part) {
      const size_t from = rng.next() % 2, begin = rng.next() % 3000,
                   end = begin + rng.next() % (3001 - begin);
      joined.append(sources[from], begin, end);
      for (size_t i = begin; i < end; ++i) wanted.push_back(sources[from][i]);
      if (part % 3 != 0) continue;
      joined.push_back(blocks[0][end % 3000]);
      wanted.push_back(blocks[0][end % 3000]);
    }
    ASSERT_EQ(joined.size(), wanted.size());
    for (size_t i = 0; i < wanted.size(); ++i) {
      ASSERT_EQ(difference(joined[i], wanted[i]), "") << fmt::format("Rng rng({}); block {}", seed, i);
      ASSERT_EQ(joined.is_rapid(i), is_rapid(std::get<BlockMove>(wanted[i].what)));
    }
  }
}

/// Three axes, one feed, as finishing programs are written: tip, axis values, duration, line, kind.
TEST(Elements, OfALongProgramTakeLittleMemory) {
  Rng rng(30);
  constexpr size_t kCount = 100 * 1024;
  Elements elements;
  BlockMove block;
  block.axes.emplace();
  for (size_t i = 0; i < kCount; ++i) {
    block.from = block.to;
    block.axes->from = block.axes->to;
    block.to.tip_W = {rng.uniform(), rng.uniform(), rng.uniform()};
    block.axes->to.head<3>() = block.to.tip_W + Vec3(1, 2, 3);
    block.duration_s = rng.uniform();
    elements.push_back({block, 0, {"a.nc", static_cast<int>(i), 1}});
  }
  constexpr double kSeven = 7.0 * sizeof(double) + sizeof(int32_t);
  EXPECT_LT(static_cast<double>(elements.bytes()) / kCount, 1.1 * kSeven);
}

TEST(Elements, OfSurfacesAreKeptAsTheyAre) {
  SurfacePass pass;
  pass.feed_mm_s = 7.0;
  const FreeMove move{MoveKind::kRapid, {}, {Vec3(1, 2, 3), Vec3::UnitX()}, 0.0};
  const Elements elements({{move, 0, {"a", 1, 1}}, {pass, 1, {"a", 2, 1}}});
  EXPECT_FALSE(elements.hold_blocks());
  EXPECT_EQ(elements.pass(0), nullptr);
  ASSERT_NE(elements.pass(1), nullptr);
  EXPECT_EQ(elements.pass(1)->feed_mm_s, 7.0);
  EXPECT_EQ(std::get<FreeMove>(elements[0].what).to.tip_W, Vec3(1, 2, 3));
  EXPECT_EQ(elements.line(1), 2);
  EXPECT_TRUE(Elements().empty());
  EXPECT_FALSE(Elements().hold_blocks());
}

}  // namespace
}  // namespace swarf::toolpath

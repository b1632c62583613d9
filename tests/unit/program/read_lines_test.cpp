// Single lines of a file, against all of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "base/rng.h"
#include "program/source_text.h"
#include "support/program_run.h"

namespace swarf::program {
namespace {

TEST(ReadLines, AreThoseOfTheWholeText) {
  const auto folder = test::fresh_folder("read_lines");
  const std::string path = (folder / "lines.nc").string();
  const std::string parts[] = {"G1 X1", "", "\r", "\n", "\r\n", "\n\r", "(a comment)", "\xC3\xA4"};
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    std::string text = seed % 4 == 0 ? "\xEF\xBB\xBF" : "";
    for (int i = 0; i < 30; ++i) text += parts[static_cast<size_t>(rng.uniform(0.0, 7.999))];
    test::write_text(path, text);
    const std::vector<std::string_view> all = split_lines(text);
    std::set<int> wanted;
    for (int i = 0; i < 6; ++i) wanted.insert(static_cast<int>(rng.uniform(1.0, 40.0)));
    const std::map<int, std::string> lines = read_lines(path, wanted);
    for (const int line : wanted) {
      const bool is_there = static_cast<size_t>(line) <= all.size();
      ASSERT_EQ(lines.contains(line), is_there) << fmt::format("Rng rng({}); line {}", seed, line);
      if (is_there) {
        ASSERT_EQ(lines.at(line), all[static_cast<size_t>(line) - 1]) << fmt::format("Rng rng({})", seed);
      }
    }
  }
  EXPECT_THROW(read_lines((folder / "missing.nc").string(), {1}), InputError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace swarf::program

// tests/data/programs/cl/bad: each file states in its first line the error that refuses it, (expect: code
// line:column), and what it is read with: (contour), (unknown) for nothing at all; else CIRCLE is that of NX.
#include <algorithm>
#include <filesystem>

#include "unit/program/cl_support.h"

namespace swarf::program::cl_bad_files_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> bad_files() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(project_file("tests/data/programs/cl/bad")))
    files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

class BadClFile : public testing::TestWithParam<std::string> {};

TEST_P(BadClFile, IsRefusedWhereItStates) {
  const std::string text = read_file(GetParam()), head = "$$ (expect: ";
  ASSERT_TRUE(text.starts_with(head));
  const std::string first = text.substr(0, text.find('\n'));
  ClOptions options;
  if (first.find("(unknown)") == std::string::npos) options = as_nx();
  if (first.find("(contour)") != std::string::npos) options.cutcom = ClPoints::kContour;
  try {
    load_cl(GetParam(), nullptr, options);
    FAIL() << "it was read";
  } catch (const InputError& error) {
    const Diagnostics& found = error.diagnostics;
    EXPECT_EQ(places(found).front(), first.substr(head.size(), first.find(')') - head.size()))
        << all_text(found);
    for (const Diagnostic& one : found.list()) {
      EXPECT_FALSE(one.text.empty());
      EXPECT_FALSE(one.fix.empty()) << format(one);
      EXPECT_EQ(one.where.file, GetParam());
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Files, BadClFile, testing::ValuesIn(bad_files()),
                         [](const auto& one) { return fs::path(one.param).stem().string(); });

}  // namespace
}  // namespace swarf::program::cl_bad_files_test

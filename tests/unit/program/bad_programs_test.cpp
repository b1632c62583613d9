// tests/data/programs/bad: each file states in its first line, (expect: code line:column, ...), every
// diagnostic that it must give and no other. tests/data/programs/good: files that must give none.
#include <algorithm>

#include "unit/program/support.h"

namespace swarf::program::bad_programs_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(project_file(folder))) {
    if (entry.path().extension() == ".nc") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The items of "(expect: a, b)" at the start of a text.
std::vector<std::string> expectations(const std::string& text) {
  const std::string head = "(expect: ";
  const size_t end = text.find(')');
  if (!text.starts_with(head) || end == std::string::npos) return {};
  std::vector<std::string> items;
  size_t from = head.size();
  for (size_t comma = text.find(", ", from); comma < end; comma = text.find(", ", from)) {
    items.push_back(text.substr(from, comma - from));
    from = comma + 2;
  }
  items.push_back(text.substr(from, end - from));
  return items;
}

class BadProgram : public testing::TestWithParam<std::string> {};

TEST_P(BadProgram, GivesExactlyTheDiagnosticsItStates) {
  const std::string text = read_file(project_file("tests/data/programs/bad/" + GetParam() + ".nc"));
  std::vector<std::string> expected = expectations(text);
  ASSERT_FALSE(expected.empty()) << "the first line states no (expect: ...)";
  const Parsed parsed = parse(text);
  std::vector<std::string> found = places(parsed.diagnostics);
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected) << all_text(parsed.diagnostics);
  for (const Diagnostic& diagnostic : parsed.diagnostics.list()) {
    EXPECT_FALSE(diagnostic.text.empty());
    EXPECT_FALSE(diagnostic.fix.empty()) << format(diagnostic);
  }
}

std::string name_of_case(const testing::TestParamInfo<std::string>& info) {
  return info.param;
}

INSTANTIATE_TEST_SUITE_P(Files, BadProgram, testing::ValuesIn(names_in("tests/data/programs/bad")),
                         name_of_case);

class GoodProgram : public testing::TestWithParam<std::string> {};

TEST_P(GoodProgram, GivesNoDiagnostic) {
  const Program program =
      parse_clean(read_file(project_file("tests/data/programs/good/" + GetParam() + ".nc")));
  EXPECT_FALSE(program.surfaces.empty());
  EXPECT_FALSE(program.operations.empty());
}

INSTANTIATE_TEST_SUITE_P(Files, GoodProgram, testing::ValuesIn(names_in("tests/data/programs/good")),
                         name_of_case);

}  // namespace
}  // namespace swarf::program::bad_programs_test

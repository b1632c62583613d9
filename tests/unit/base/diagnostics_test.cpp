#include "base/diagnostics.h"

#include <gtest/gtest.h>

#include "base/check.h"

namespace swarf {
namespace {

TEST(Diagnostics, FormatNamesPlaceCodeAndRemedy) {
  const Diagnostic full{"bad-feed", Severity::kError, {"a.nc", 3, 7}, "F-1 mm/min", "write F3000"};
  EXPECT_EQ(format(full), "a.nc:3:7: error: F-1 mm/min [bad-feed]\n    fix: write F3000");
  EXPECT_EQ(format({"c", Severity::kWarning, {"a.nc", 3, 0}, "t", ""}), "a.nc:3: warning: t [c]");
  EXPECT_EQ(format({"c", Severity::kNote, {"a.nc", 0, 0}, "t", ""}), "a.nc: note: t [c]");
  // A column without a line has no meaning.
  EXPECT_EQ(format({"c", Severity::kNote, {"", 0, 9}, "t", ""}), "note: t [c]");
}

TEST(Diagnostics, OnlyErrorsStop) {
  Diagnostics diagnostics;
  diagnostics.note("n", {}, "note");
  diagnostics.warning("w", {}, "warning");
  EXPECT_FALSE(diagnostics.has_errors());
  EXPECT_NO_THROW(diagnostics.throw_if_errors());
  diagnostics.error("e", {"f", 1, 2}, "error", "fix");
  EXPECT_TRUE(diagnostics.has_errors());
  try {
    diagnostics.throw_if_errors();
    FAIL() << "an error must be thrown";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics.list().size(), 3U);
    EXPECT_STREQ(error.what(), "note: note [n]\nwarning: warning [w]\nf:1:2: error: error [e]\n    fix: fix");
  }
}

TEST(Diagnostics, OneErrorIsShortToThrow) {
  const InputError error("c", {"f", 1, 1}, "text", "fix");
  ASSERT_EQ(error.diagnostics.list().size(), 1U);
  EXPECT_TRUE(error.diagnostics.has_errors());
}

TEST(NearestName, FindsWhatWasMeant) {
  const std::vector<std::string> keys = {"diameter_mm", "length_mm", "feed", "G06.3", "G06.4"};
  EXPECT_EQ(nearest_name("diametr_mm", keys), "diameter_mm");
  EXPECT_EQ(nearest_name("lenght_mm", keys), "length_mm");
  EXPECT_EQ(nearest_name("fede", keys), "feed");
  EXPECT_EQ(nearest_name("G06.33", keys), "G06.3");
  EXPECT_EQ(nearest_name("feed", keys), "feed");
}

TEST(NearestName, FindsNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("colour", {"feed", "length_mm"}), "");
  EXPECT_EQ(nearest_name("xy", {"uv", "st"}), "");
  EXPECT_EQ(nearest_name("x", {}), "");
  EXPECT_EQ(nearest_name("", {"abc"}), "");
}

TEST(Check, NamesConditionFileAndLine) {
  try {
    SWARF_CHECK(1 == 2, "arithmetic");
    FAIL() << "a broken promise must be thrown";
  } catch (const InternalError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("diagnostics_test.cpp:"), std::string::npos) << text;
    EXPECT_NE(text.find("arithmetic (1 == 2 does not hold)"), std::string::npos) << text;
    EXPECT_EQ(text.find('/'), std::string::npos) << "no path of the build machine: " << text;
  }
  EXPECT_NO_THROW(SWARF_CHECK(true, "never"));
}

}  // namespace
}  // namespace swarf

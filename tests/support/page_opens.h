// What a person is sent is right: the glTF files for the validator, the page in headless Chromium.
#pragma once

#include <gtest/gtest.h>

#include <iostream>

#include "support/program_run.h"

namespace swarf::test {

/// tests/page/page.sh on these pages (paths with blanks between). Says NOT CHECKED where there is no
/// Chromium.
inline void expect_pages_open(const std::string& pages) {
  constexpr int kNoChromium = 77;
  const ProgramRun page = run_command(SWARF_SOURCE_DIR "/tests/page/page.sh " + pages);
  if (page.exit_code == kNoChromium) {
    std::cout << page.output;
    return;
  }
  EXPECT_EQ(page.exit_code, 0) << page.output;
}

/// Of the run in this folder.
inline void expect_review(const std::filesystem::path& folder) {
  const std::string run = folder.string();
  const ProgramRun valid =
      run_command(SWARF_SOURCE_DIR "/tests/gltf/validate.sh " + run + "/part.glb " + run + "/machine.glb");
  EXPECT_EQ(valid.exit_code, 0) << valid.output;
  expect_pages_open(run + "/report.html");
}

}  // namespace swarf::test

// The README's tutorials as printed: their files are saved, their commands run in order, and what they are
// said to print must be printed.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "support/program_run.h"

namespace readme_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::ProgramRun;

/// From its heading to the next one.
std::string section(const std::string& heading) {
  const std::string readme = swarf::test::read_text(SWARF_SOURCE_DIR "/README.md");
  const size_t start = readme.find("\n## " + heading);
  if (start == readme.npos) throw std::runtime_error("README.md has no section " + heading);
  return readme.substr(start, readme.find("\n## ", start + 1) - start);
}

struct Counts {
  int files = 0, commands = 0, printed = 0;
};

/// "Save as `NAME`" makes the next block a file; ```sh are commands, ```text lines that they print.
class Tutorial {
 public:
  explicit Tutorial(const std::string& name) : folder_(swarf::test::fresh_folder(name)) {
    fs::create_directories(folder_ / "bin");
    fs::create_symlink(SWARF_PROGRAM, folder_ / "bin" / "swarf");
  }
  ~Tutorial() { fs::remove_all(folder_); }

  Counts follow(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const size_t save = line.find("Save as `");
      if (save != line.npos) name_ = line.substr(save + 9, line.find('`', save + 9) - save - 9);
      if (line.rfind("```", 0) == 0) take(line.substr(3), block(lines));
    }
    return counts_;
  }

 private:
  static std::string block(std::istringstream& lines) {
    std::string text;
    for (std::string line; std::getline(lines, line) && line != "```";) text += line + "\n";
    return text;
  }
  void take(const std::string& kind, const std::string& text) {
    if (kind == "sh") {
      run(text);
    } else if (kind == "text") {
      expect(text);
    } else {
      ASSERT_FALSE(name_.empty()) << text;
      fs::create_directories((folder_ / name_).parent_path());
      swarf::test::write_text(folder_ / name_, text);
      name_.clear();
      ++counts_.files;
    }
  }
  void run(const std::string& commands) {
    std::istringstream lines(commands);
    for (std::string line; std::getline(lines, line);) {
      const ProgramRun done = swarf::test::run_command("cd " + folder_.string() + " && PATH=\"" +
                                                       (folder_ / "bin").string() + ":$PATH\" && " + line);
      EXPECT_EQ(done.exit_code, 0) << line << "\n" << done.output;
      printed_ = done.output;
      ++counts_.commands;
    }
  }
  void expect(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_NE(printed_.find(line), std::string::npos) << line << "\nis not in\n" << printed_;
      ++counts_.printed;
    }
  }

  fs::path folder_;
  std::string name_, printed_;
  Counts counts_;
};

TEST(Readme, AThreeAxisPocketInTenMinutes) {
  const Counts counts = Tutorial("readme_pocket").follow(section("A three-axis pocket in ten minutes"));
  EXPECT_EQ(counts.files, 1);
  EXPECT_GE(counts.commands, 4);
  EXPECT_GE(counts.printed, 3);
}

TEST(Readme, YourOwnFiveAxisMachineInTwenty) {
  const Counts counts = Tutorial("readme_five_axes").follow(section("Your own five-axis machine in twenty"));
  EXPECT_EQ(counts.files, 3);
  EXPECT_GE(counts.commands, 4);
  EXPECT_GE(counts.printed, 2);
}

}  // namespace
}  // namespace readme_test

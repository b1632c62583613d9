// Files as strangers have them: odd names, no ending, nothing or no text in them, places that are taken.
#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "support/program_run.h"

namespace odd_files_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::ProgramRun;
using swarf::test::run_command;
using swarf::test::write_text;

const char* const kShort =
    "G21 G17 G90 G94\nT1 M6\nS3000 M3\nG0 X0 Y0\nZ20\nG1 Z-4 F300\nX20 F900\nG0 Z20\nM5\nM2\n";

class OddFiles : public testing::Test {
 protected:
  void SetUp() override { root_ = swarf::test::fresh_folder("odd_files"); }
  void TearDown() override { fs::remove_all(root_); }

  /// Within the folder, as a person types it.
  ProgramRun swarf(const std::string& words) const {
    return run_command("cd '" + root_.string() + "' && " SWARF_PROGRAM " " + words);
  }
  void expect_refused(const std::string& words, const std::string& code) const {
    const ProgramRun done = swarf(words);
    EXPECT_EQ(done.exit_code, 2) << words << "\n" << done.output;
    EXPECT_NE(done.output.find("[" + code + "]"), std::string::npos) << words << "\n" << done.output;
  }

  fs::path root_;
};

TEST_F(OddFiles, NamesOfAnyLetters) {
  fs::create_directory(root_ / "a b");
  for (const char* name : {"a b/größe (1) #2.nc", "noending", "part.xyz", "-dash.nc", "50%.TAP", "'q'.nc"}) {
    write_text(root_ / name, kShort);
    const std::string typed = std::string(name) == "'q'.nc" ? "\"'q'.nc\"" : "'./" + std::string(name) + "'";
    EXPECT_EQ(swarf("check " + typed).exit_code, 0) << name;
    const ProgramRun done = swarf("run " + typed + " --tool 6 --voxel 1 --no-render -q -o out");
    EXPECT_EQ(done.exit_code, 0) << name << "\n" << done.output;
  }
}

TEST_F(OddFiles, WhatIsNoProgramIsSaidToBeNone) {
  write_text(root_ / "empty.nc", "");
  write_text(root_ / "zip.nc", std::string("PK\x03\x04", 4) + "word/document.xml");
  write_text(root_ / "utf16.nc", std::string("\xff\xfeG\0"
                                             "2\0"
                                             "1\0\n\0",
                                             10));
  fs::copy_file(SWARF_PROGRAM, root_ / "program");
  for (const char* command : {"check ", "run --tool 6 "}) {
    expect_refused(std::string(command) + "empty.nc", "empty-file");
    for (const char* name : {"zip.nc", "utf16.nc", "program"})
      expect_refused(command + std::string(name), "not-text");
  }
}

/// Squares of such numbers are no numbers: it ended as a fault of the program.
TEST_F(OddFiles, BlocksThatGoFartherThanAnyMachineAreNamed) {
  const std::string head = "G21 G90\nT1 M6\nS500 M3\nG0 X0 Y0 Z5\nG1 Z-1 F1000\n";
  const std::string cl =
      "UNITS/MM\nCUTTER/6\nFEDRAT/100,MMPM\nSPINDL/RPM,1000,CLW\nGOTO/0,0,5\nGOTO/1E200,0,-1\nFINI\n";
  for (const auto& [name, text] :
       {std::pair("x.nc", head + "X[10**200]\nX20\nM2\n"),
        std::pair("g92.nc", head + "G92 X[10**200]\nX20\nM2\n"),
        std::pair("g81.nc", head + "G99 G81 X[10**200] Z-1 R2\nG80\nM2\n"), std::pair("goto.cls", cl)}) {
    write_text(root_ / name, text);
    expect_refused("run " + std::string(name) + " --tool 6 --stock=-10,-10,-20,30,20,0 --no-render -o far",
                   "out-of-range");
  }
}

TEST_F(OddFiles, PlacesThatAreTakenStayAsTheyAre) {
  write_text(root_ / "part.nc", kShort);
  write_text(root_ / "notes.txt", "mine");
  fs::create_directory(root_ / "folder");
  write_text(root_ / "folder/notes.txt", "mine");
  const std::string run = "run part.nc --tool 6 --voxel 1 --no-render -o ";
  for (const char* place : {"notes.txt", "folder", "part.nc"})
    expect_refused(run + place, "output-in-the-way");
  EXPECT_EQ(swarf::test::read_text(root_ / "notes.txt"), "mine");
  EXPECT_EQ(swarf::test::read_text(root_ / "folder/notes.txt"), "mine");
  EXPECT_EQ(swarf::test::read_text(root_ / "part.nc"), kShort);
  EXPECT_EQ(swarf(run + "out").exit_code, 0);
  EXPECT_EQ(swarf(run + "out").exit_code, 0) << "an earlier result is replaced";
}

TEST_F(OddFiles, AReadOnlyFolderIsToldBeforeTheWork) {
  if (geteuid() == 0) GTEST_SKIP() << "root writes everywhere";
  write_text(root_ / "part.nc", kShort);
  fs::create_directory(root_ / "closed");
  fs::permissions(root_ / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  expect_refused("run part.nc --tool 6 --no-render -o closed/out", "cannot-write");
}

/// A hundred thousand lines of nothing, and one that does not end.
TEST_F(OddFiles, LongFilesOfNothing) {
  std::string blanks;
  for (int i = 0; i < 100000; ++i) blanks += "\n  \n( )\n";
  write_text(root_ / "blank.nc", blanks);
  EXPECT_EQ(swarf("run blank.nc --tool 6").exit_code, 2);
  write_text(root_ / "line.nc", std::string(2000000, ' ') + "G0 X1");
  EXPECT_LE(swarf("check line.nc").exit_code, 2);
}

}  // namespace
}  // namespace odd_files_test

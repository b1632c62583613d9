#include "base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <vector>

#include "base/diagnostics.h"
#include "support/full_disk.h"
#include "support/scratch.h"

namespace swarf {
namespace {

namespace fs = std::filesystem;

constexpr FileFault kFault{"test-unwritable", "the test cannot be written"};

/// What a fault says, or "" when there was none.
std::string said(const std::function<void()>& action) {
  try {
    action();
    return "";
  } catch (const InputError& error) {
    const Diagnostic& first = error.diagnostics.list().at(0);
    return first.code + ": " + first.text;
  }
}

/// Runs the action in a process of its own, which may lose rights or die; its exit code, or minus the signal.
int in_child(const std::function<int()>& action) {
  const pid_t child = fork();
  if (child == 0) _exit(action());
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

class NewFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directory(folder);
  }
  std::string file(const std::string& name) const { return (folder / name).string(); }
  void put(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  std::string content(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  size_t count() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  const fs::path folder = test::scratch_folder() / "new_file";
};

TEST_F(NewFileTest, ReplacesTheWholeContentAndLeavesNothingElse) {
  const std::string bytes("a\0b\r\nc", 6);
  replace_file(file("a.txt"), "something longer than what comes", kFault);
  replace_file(file("a.txt"), bytes, kFault);
  EXPECT_EQ(content("a.txt"), bytes);
  EXPECT_EQ(read_all(file("a.txt"), kFault), bytes);
  EXPECT_EQ(count(), 1U);
}

TEST_F(NewFileTest, ATemporaryFileEndsLikeItsTargetAndVanishesUnlessMoved) {
  std::string temporary;
  {
    const NewFile draft(file("run.h5"), kFault);
    temporary = draft.temporary();
    draft.write("half");
    EXPECT_EQ(fs::path(temporary).extension(), ".h5");
    EXPECT_EQ(fs::path(temporary).parent_path(), folder);
    EXPECT_TRUE(fs::exists(temporary));
    EXPECT_FALSE(fs::exists(file("run.h5")));
  }
  EXPECT_FALSE(fs::exists(temporary));
  EXPECT_EQ(count(), 0U);
}

TEST_F(NewFileTest, TheModeOfTheOldFileStays) {
  put("a.txt", "old");
  ASSERT_EQ(chmod(file("a.txt").c_str(), 0640), 0);
  replace_file(file("a.txt"), "new", kFault);
  struct stat now {};
  ASSERT_EQ(stat(file("a.txt").c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 0777, 0640U);
  const mode_t umask_before = umask(027);
  replace_file(file("b.txt"), "new", kFault);
  umask(umask_before);
  ASSERT_EQ(stat(file("b.txt").c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 0777, 0640U);
}

TEST_F(NewFileTest, ALinkStaysAndItsFileIsReplaced) {
  fs::create_directory(folder / "inside");
  put("inside/real.txt", "old");
  fs::create_symlink("inside/real.txt", file("link"));
  fs::create_symlink("link", file("link_to_link"));
  replace_file(file("link_to_link"), "new", kFault);
  EXPECT_TRUE(fs::is_symlink(file("link")) && fs::is_symlink(file("link_to_link")));
  EXPECT_EQ(content("inside/real.txt"), "new");
  fs::create_symlink("inside/made.txt", file("dangling"));
  replace_file(file("dangling"), "made", kFault);
  EXPECT_EQ(content("inside/made.txt"), "made");
  fs::create_symlink("round", file("round"));
  EXPECT_NE(said([&] { replace_file(file("round"), "x", kFault); }), "");
  EXPECT_TRUE(fs::is_symlink(file("round")));
}

TEST_F(NewFileTest, WhatIsNoFileIsNotReplaced) {
  EXPECT_EQ(said([&] { replace_file(folder.string(), "x", kFault); }),
            "test-unwritable: the test cannot be written: a folder stands in its place");
  ASSERT_EQ(mkfifo(file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(said([&] { replace_file(file("pipe"), "x", kFault); }),
            "test-unwritable: the test cannot be written: this is a pipe, no file");
  fs::create_symlink("/dev/full", file("full"));
  EXPECT_EQ(said([&] { replace_file(file("full"), "x", kFault); }),
            "test-unwritable: the test cannot be written: this is a device, no file");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(said([&] { replace_file(file("missing/a.txt"), "x", kFault); }),
            "test-unwritable: the test cannot be written: No such file or directory");
  EXPECT_EQ(count(), 2U);
}

/// Root may write everywhere: the child becomes nobody.
TEST_F(NewFileTest, AReadOnlyFolderOrFileIsToldAndKept) {
  put("a.txt", "old");
  put("locked.txt", "old");
  ASSERT_EQ(chmod(file("a.txt").c_str(), 0666), 0);
  ASSERT_EQ(chmod(file("locked.txt").c_str(), 0444), 0);
  const std::string denied = "test-unwritable: the test cannot be written: Permission denied";
  const auto refused = [&](const std::string& name) {
    return in_child([&] {
      constexpr uid_t kNobody = 65534;
      if (getuid() == 0 && (setgid(kNobody) != 0 || setuid(kNobody) != 0)) return 2;
      return said([&] { replace_file(file(name), "new", kFault); }) == denied ? 0 : 1;
    });
  };
  ASSERT_EQ(chmod(folder.c_str(), 0777), 0);
  EXPECT_EQ(refused("locked.txt"), 0);
  ASSERT_EQ(chmod(folder.c_str(), 0555), 0);
  EXPECT_EQ(refused("a.txt"), 0);
  ASSERT_EQ(chmod(folder.c_str(), 0755), 0);
  EXPECT_EQ(content("a.txt") + content("locked.txt"), "oldold");
  EXPECT_EQ(count(), 2U);
}

TEST_F(NewFileTest, AFullDiskIsToldAndTheOldFileStays) {
  put("a.txt", "old");
  const std::string reason = [&] {
    const test::FullDisk disk(4096);
    return said([&] { replace_file(file("a.txt"), std::string(10000, 'x'), kFault); });
  }();
  EXPECT_EQ(reason, "test-unwritable: the test cannot be written: File too large");
  EXPECT_EQ(content("a.txt"), "old");
  EXPECT_EQ(count(), 1U);
}

TEST_F(NewFileTest, AKilledWriterLeavesTheOldFileAndNobodyInTheWay) {
  put("a.txt", "old");
  const int ended = in_child([&] {
    const NewFile draft(file("a.txt"), kFault);
    draft.write("half");
    return raise(SIGKILL);
  });
  EXPECT_EQ(ended, -SIGKILL);
  EXPECT_EQ(content("a.txt"), "old");
  replace_file(file("a.txt"), "new", kFault);
  EXPECT_EQ(content("a.txt"), "new");
}

/// A name that a run with the same process number has left is passed over.
TEST_F(NewFileTest, ATakenNameIsPassedOver) {
  std::string taken;
  {
    const NewFile draft(file("a.txt"), kFault);
    taken = draft.temporary();
  }
  fs::create_directory(taken);
  replace_file(file("a.txt"), "new", kFault);
  EXPECT_EQ(content("a.txt"), "new");
  EXPECT_TRUE(fs::is_directory(taken));
}

/// Readers see one writer's whole content at any moment.
TEST_F(NewFileTest, ProcessesAtOnceDoNotMix) {
  constexpr int kWriters = 3, kTimes = 60;
  constexpr size_t kBytes = 200000;
  put("a.txt", std::string(kBytes, 'x'));
  std::vector<pid_t> writers;
  for (int w = 0; w < kWriters; ++w) {
    const pid_t child = fork();
    if (child == 0) {
      const std::string bytes(kBytes, static_cast<char>('a' + w));
      for (int i = 0; i < kTimes; ++i) replace_file(file("a.txt"), bytes, kFault);
      _exit(0);
    }
    writers.push_back(child);
  }
  int mixed = 0, status = 0;
  for (const pid_t writer : writers) {
    while (waitpid(writer, &status, WNOHANG) == 0) {
      const std::string seen = content("a.txt");
      mixed += seen.size() != kBytes || seen.find_first_not_of(seen[0]) != std::string::npos ? 1 : 0;
    }
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(mixed, 0);
  EXPECT_EQ(count(), 1U);
}

TEST_F(NewFileTest, WhatCannotBeReadIsTold) {
  EXPECT_EQ(said([&] { read_all(folder.string(), kFault); }),
            "test-unwritable: the test cannot be written: this is a folder");
  EXPECT_EQ(said([&] { read_all(file("none"), kFault); }),
            "test-unwritable: the test cannot be written: No such file or directory");
  EXPECT_EQ(said([&] { read_all("/dev/zero", kFault); }), "no-regular-file: this is a device, no file");
  const std::string large(size_t{3} << 16, 'y');
  put("large", large);
  EXPECT_EQ(read_all(file("large"), kFault), large);
}

/// Each byte counts, and so do zeros at the end, which fill the last word in any case.
TEST(Checksum, ShowsEachByteAndTheLength) {
  const std::string bytes = "0123456789abcdefg";
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string other = bytes;
    other[i] = static_cast<char>(other[i] ^ 1);
    EXPECT_NE(checksum(other), checksum(bytes)) << i;
  }
  EXPECT_NE(checksum(bytes + '\0'), checksum(bytes));
  EXPECT_NE(checksum(""), checksum(std::string(1, '\0')));
}

}  // namespace
}  // namespace swarf

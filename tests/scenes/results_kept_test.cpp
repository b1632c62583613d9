// Results are never lost: inputs are kept by name, output places are tried first, what fails takes nothing
// with it. The job is small (a slot of a few millimetres) and is cut by the shipped program.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "support/program_run.h"

namespace results_kept_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

/// A machine with a mesh, a program and a scene, all named relative to the scene's folder.
class ResultsKept : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder(testing::UnitTest::GetInstance()->current_test_info()->name());
    job_ = folder_ / "job";
    fs::create_directories(job_);
    const fs::path machines = fs::path(SWARF_SOURCE_DIR) / "tests/data/machines";
    for (const char* mesh : {"tetrahedron.ply", "tetrahedron.stl"})
      fs::copy_file(machines / mesh, job_ / mesh);
    fs::copy_file(machines / "small.toml", job_ / "machine.toml");
    write_text(job_ / "slot.ngc",
               "G21 G90 G54\nT1 M6\nS5000 M3\nG0 X-12 Y0 Z5 A0 B0\nG1 Z-1 F600\nG1 X12\nG0 Z50\nM2\n");
    write_text(job_ / "scene.toml", scene("machine.toml"));
  }
  void TearDown() override { fs::remove_all(folder_); }

  static void replace(std::string& text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }

  static std::string scene(const std::string& machine) {
    return "machine = \"" + machine +
           "\"\nnc = \"slot.ngc\"\ndialect = \"linuxcnc\"\n"
           "[cutter]\nnumber = 1\ndiameter_mm = 4\nflute_length_mm = 10\nlength_mm = 40\n"
           "[stock]\nbox_mm = [[-8, -4, -3], [8, 4, 0]]\nvoxel_mm = 0.5\n"
           "[design]\nkind = \"none\"\n[accept]\nmachine_parts = 100\n"  // its links are mere tetrahedra
           "[movie]\nseconds = 0\n[stills]\nsize = [64, 64]\nsamples = 1\n";
  }

  /// Runs in the job's own folder.
  swarf::test::ProgramRun swarf_there(const std::string& arguments, const std::string& before = "") const {
    return swarf::test::run_command("cd '" + job_.string() + "' && " + before + std::string(SWARF_PROGRAM) +
                                    " " + arguments);
  }

  /// Paths of the files below a folder, as seen from it.
  static std::vector<std::string> files_below(const fs::path& folder) {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(folder).string());
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  fs::path folder_, job_;
};

using Files = std::vector<std::string>;

TEST_F(ResultsKept, SceneBesideItsMachineWithResultsBelow) {
  const auto run = swarf_there("run scene.toml --no-render --record -o results/first");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(files_below(job_ / "results/first/input"),
            (Files{"machine/machine.toml", "machine/tetrahedron.ply", "machine/tetrahedron.stl",
                   "program/slot.ngc", "scene.toml", "sources.json"}));
  // The results stand on their own.
  fs::rename(job_ / "results", folder_ / "moved");
  fs::remove_all(job_);
  const std::string results = (folder_ / "moved/first").string();
  const auto render = run_swarf("render " + results + " --still " + (folder_ / "part.png").string() +
                                " --size 64 64 --samples 1");
  EXPECT_EQ(render.exit_code, 0) << render.output;
  const auto again = run_swarf("export " + results + " --machine-gltf " + (folder_ / "m.glb").string() +
                               " --stl " + (folder_ / "p.stl").string());
  EXPECT_EQ(again.exit_code, 0) << again.output;
  const auto replay = run_swarf("replay " + results + "/run.record");
  EXPECT_EQ(replay.exit_code, 0) << replay.output;
}

TEST_F(ResultsKept, OnlyNamedFilesAreCopiedFromAFullHome) {
  for (int i = 0; i < 1000; ++i) write_text(job_ / ("private_" + std::to_string(i) + ".txt"), "diary");
  write_text(job_ / "scene.toml", scene((job_ / "machine.toml").string()));
  const auto run =
      run_swarf("run " + (job_ / "scene.toml").string() + " --no-render -o " + (folder_ / "out").string());
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(files_below(folder_ / "out/input").size(), 6U);  // five inputs and sources.json
}

TEST_F(ResultsKept, MeshesOfOtherFoldersLinksAndEqualNamesAreKeptApart) {
  const fs::path other = folder_ / "other", plant = folder_ / "plant/mills";
  fs::create_directories(other);
  fs::create_directories(plant / "meshes");
  fs::copy_file(job_ / "tetrahedron.ply", other / "part.ply");
  fs::copy_file(job_ / "tetrahedron.ply", plant.parent_path() / "part.ply");
  fs::copy_file(SWARF_SOURCE_DIR "/tests/data/machines/tetrahedron.stl", plant / "part.stl");
  std::string machine = read_text(job_ / "machine.toml");
  replace(machine, "\"tetrahedron.ply\"", "\"../part.ply\"");
  replace(machine, "\"tetrahedron.stl\"", "\"meshes/../part.stl\"");
  replace(machine, "name = \"bed\"", "name = \"bed\"\nmesh = '" + (other / "part.ply").string() + "'");
  write_text(plant / "real.toml", machine);
  fs::create_symlink(plant / "real.toml", plant / "machine.toml");
  fs::create_directory_symlink(plant, job_ / "linked");
  write_text(job_ / "scene.toml", scene("linked/machine.toml"));
  const auto run = swarf_there("run scene.toml --no-render -o out");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(files_below(job_ / "out/input"),
            (Files{"machine/below_1/kept_0.ply", "machine/below_1/machine.toml", "machine/below_1/part.stl",
                   "machine/part.ply", "program/slot.ngc", "scene.toml", "sources.json"}));
  fs::rename(job_ / "out", folder_ / "out");
  for (const fs::path& gone : {job_, other, plant}) fs::remove_all(gone);
  const auto render =
      run_swarf("export " + (folder_ / "out").string() + " --machine-gltf " + (folder_ / "m.glb").string());
  EXPECT_EQ(render.exit_code, 0) << render.output;
}

TEST_F(ResultsKept, CalledProgramsAreKept) {
  write_text(job_ / "slot.ngc", "G21 G90 G54\nT1 M6\nS5000 M3\nG0 X-12 Y0 Z5 A0 B0\no<cut> call\nM2\n");
  write_text(job_ / "cut.ngc", "o<cut> sub\nG1 Z-1 F600\nG1 X12\nG0 Z5\no<cut> endsub\n");
  const auto run = swarf_there("run scene.toml --no-render -o out");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(fs::exists(job_ / "out/input/program/cut.ngc"));
}

/// Refused with exit 2 and this reason, before a sweep was cut and without a trace.
void expect_refused(const swarf::test::ProgramRun& run, const std::string& reason) {
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("memory: stock"), std::string::npos) << "the work had begun: " << run.output;
  EXPECT_EQ(run.output.find("internal error"), std::string::npos) << run.output;
}

TEST_F(ResultsKept, OutputPlacesAreTriedBeforeTheCut) {
  const auto run_to = [&](const std::string& place) {
    return swarf_there("run scene.toml --no-render -o " + place);
  };
  write_text(job_ / "file", "mine");
  const Files before = files_below(folder_);
  expect_refused(run_to("file"), "[output-in-the-way]");
  expect_refused(run_to("file/below"), "Not a directory");
  expect_refused(run_to("."), "[output-in-the-way]");
  expect_refused(run_to(".."), "[output-in-the-way]");
  expect_refused(run_to("/proc/nothing/here"), "[cannot-write]");
  expect_refused(run_to("/proc"), "[output-in-the-way]");
  EXPECT_EQ(files_below(folder_), before);
  EXPECT_EQ(run_to("new/deep/folder/").exit_code, 0);
  EXPECT_TRUE(fs::exists(job_ / "new/deep/folder/metrics.json"));
  EXPECT_EQ(run_to("new/deep/folder/").exit_code, 0);  // replaces itself
  EXPECT_EQ(files_below(job_ / "new").size(), files_below(job_ / "new/deep/folder").size());
  if (geteuid() != 0) {
    fs::create_directory(job_ / "locked");
    fs::permissions(job_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    expect_refused(run_to("locked/out"), "Permission denied");
    fs::permissions(job_ / "locked", fs::perms::owner_all);
  }
}

TEST_F(ResultsKept, OutputFilesAreTriedBeforeTheWork) {
  ASSERT_EQ(swarf_there("run scene.toml --no-render -o out").exit_code, 0);
  for (const std::string command :
       {"render out --still", "render out --movie", "export out --stl", "export out --ply",
        "export out --vdb", "export out --gltf", "export out --machine-gltf"}) {
    expect_refused(swarf_there(command + " no/such/folder/file.stl"), "No such file or directory");
    expect_refused(swarf_there(command + " ."), "a folder stands in its place");
  }
  expect_refused(swarf_there("plan scene.toml -o no/such/file.cl"), "No such file or directory");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1)
    lines.push_back(text.substr(begin, text.find('\n', begin) - begin));
  return lines;
}

TEST_F(ResultsKept, BlocksAreTabledAndCyclesWhereTheyAreAskedFor) {
  ASSERT_EQ(swarf_there("run scene.toml --no-render -o out").exit_code, 0);
  const std::vector<std::string> blocks = lines_of(read_text(job_ / "out/blocks.csv"));
  ASSERT_EQ(blocks.size(), 1U + 3U) << "a row for each of G1, G1, G0; the first G0 is the start";
  EXPECT_EQ(blocks[0].find("line,t_s,tip_x_mm,tip_y_mm,tip_z_mm,i,j,k,axis_X_mm,"), 0U);
  for (size_t n = 1; n < blocks.size(); ++n)
    EXPECT_EQ(blocks[n].find(std::to_string(n + 4) + ","), 0U) << blocks[n];
  EXPECT_NE(blocks[2].find(",12.0000000,0.0000000,-1.0000000,"), std::string::npos) << blocks[2];
  EXPECT_NE(blocks[2].find(",600.0000,cut,1"), std::string::npos) << blocks[2];
  for (const char* file : {"out/trajectory.csv", "out/report.html", "out/part.glb"})
    EXPECT_FALSE(fs::exists(job_ / file)) << file << ": nobody has asked for it";

  ASSERT_EQ(swarf_there("run scene.toml --no-render --trajectory csv -o out").exit_code, 0);
  const auto metrics = nlohmann::json::parse(read_text(job_ / "out/metrics.json"));
  EXPECT_EQ(lines_of(read_text(job_ / "out/trajectory.csv")).size(),
            metrics.at("motion").at("ticks").get<size_t>() + 2)
      << "the head, and a row for the start and each cycle";
}

TEST_F(ResultsKept, AMotionThatIsNotTheRunsIsRefused) {
  ASSERT_EQ(swarf_there("run scene.toml --no-render -o out").exit_code, 0);
  ASSERT_EQ(swarf_there("export out --machine-gltf a.glb").exit_code, 0);
  std::string program = read_text(job_ / "out/input/program/slot.ngc");
  replace(program, "X12", "X9");
  write_text(job_ / "out/input/program/slot.ngc", program);
  for (const char* command : {"export out --machine-gltf x.glb", "render out --kind machine --still x.png"}) {
    const auto run = swarf_there(command);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("[run-differs]"), std::string::npos) << run.output;
    EXPECT_FALSE(fs::exists(job_ / "x.glb"));
  }
  // What needs no motion is made all the same.
  EXPECT_EQ(swarf_there("export out --stl part.stl").exit_code, 0);
}

TEST_F(ResultsKept, FilesOfTheUserStayInAnEarlierResult) {
  ASSERT_EQ(swarf_there("run scene.toml --no-render -o out").exit_code, 0);
  write_text(job_ / "out/notes.txt", "good edge on the left");
  write_text(job_ / "out/stock_after_9.vdb", "of another run");
  ASSERT_EQ(swarf_there("run scene.toml --no-render -o out").exit_code, 0);
  EXPECT_EQ(read_text(job_ / "out/notes.txt"), "good edge on the left");
  EXPECT_FALSE(fs::exists(job_ / "out/stock_after_9.vdb"));
}

/// No file may grow beyond so many KiB: writes then fail as on a full disk, at a place that does not depend
/// on the system.
std::string limited_to(int kib) {
  return "trap '' XFSZ; ulimit -f " + std::to_string(2 * kib) + "; ";
}

TEST_F(ResultsKept, AFullDiskIsNamedAndTakesNothingWithIt) {
  // Fine rays are the largest of what is needed, the page the largest of all.
  std::string rays = scene("machine.toml");
  replace(rays, "kind = \"none\"",
          "kind = \"plane\"\norigin_mm = [-8, -2, -1]\nalong_u_mm = [16, 0, 0]\nalong_v_mm = [0, 4, 0]\n"
          "pitch_mm = 0.03");
  write_text(job_ / "scene.toml", rays);
  const auto whole = swarf_there("run scene.toml --no-render --report -o out");
  ASSERT_LE(whole.exit_code, 1) << whole.output;
  const std::string report = read_text(job_ / "out/report.html");
  const auto kib = [&](const char* name) {
    return static_cast<int>(fs::file_size(job_ / "out" / name) / 1024);
  };
  ASSERT_GT(kib("stock.vdb"), kib("blocks.csv") + 8);
  ASSERT_GT(kib("surface_0.rays"), kib("stock.vdb") + 8);
  ASSERT_GT(kib("report.html"), kib("surface_0.rays") + 8);

  const auto no_rays = swarf_there("run scene.toml --no-render -o out", limited_to(kib("stock.vdb") + 4));
  EXPECT_EQ(no_rays.exit_code, 2) << no_rays.output;
  EXPECT_NE(no_rays.output.find("surface_0.rays: error:"), std::string::npos) << no_rays.output;
  EXPECT_NE(no_rays.output.find("out.incomplete: note:"), std::string::npos) << no_rays.output;
  EXPECT_EQ(read_text(job_ / "out/report.html"), report);
  EXPECT_EQ(read_text(job_ / "out.incomplete/stock.vdb"), read_text(job_ / "out/stock.vdb"));

  const auto no_cycles =
      swarf_there("run scene.toml --no-render --trajectory csv -o out", limited_to(kib("stock.vdb") + 4));
  EXPECT_EQ(no_cycles.exit_code, 2) << no_cycles.output;
  EXPECT_NE(no_cycles.output.find("trajectory.csv: error:"), std::string::npos) << no_cycles.output;
  EXPECT_EQ(read_text(job_ / "out/report.html"), report);

  const auto no_page =
      swarf_there("run scene.toml --no-render --report -o other", limited_to(kib("surface_0.rays") + 4));
  EXPECT_EQ(no_page.exit_code, 2) << no_page.output;
  EXPECT_NE(no_page.output.find("report.html: error:"), std::string::npos) << no_page.output;
  EXPECT_EQ(read_text(job_ / "other/stock.vdb"), read_text(job_ / "out/stock.vdb"));
  EXPECT_TRUE(nlohmann::json::parse(read_text(job_ / "other/metrics.json")).contains("verdict"));
  for (const std::string& file : files_below(job_ / "other"))
    EXPECT_EQ(file.find(".part"), std::string::npos) << file;
}

TEST_F(ResultsKept, TheStockIsEqualByteForByte) {
  ASSERT_EQ(swarf_there("run scene.toml --no-render --threads 1 --save-stock-after 5 -o a").exit_code, 0);
  ASSERT_EQ(swarf_there("run scene.toml --no-render --threads 2 --save-stock-after 5 -o b").exit_code, 0);
  for (const char* file : {"stock.vdb", "stock_after_line_5.vdb", "blocks.csv"})
    EXPECT_EQ(read_text(job_ / "a" / file), read_text(job_ / "b" / file)) << file;
}

TEST_F(ResultsKept, TheCommandIsPrintedAsItWasGiven) {
  fs::rename(job_ / "scene.toml", job_ / "a scene's.toml");
  const auto run = swarf_there(
      "run \"a scene's.toml\" --set stock.voxel_mm=0.6 --set 'title=two words & <more>' --no-render --report "
      "-o "
      "out");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const std::string command = nlohmann::json::parse(read_text(job_ / "out/run.json")).at("command");
  EXPECT_EQ(command,
            "swarf run 'a scene'\\''s.toml' --set stock.voxel_mm=0.6 --set 'title=two words & <more>' "
            "--no-render --report -o out");
  EXPECT_NE(read_text(job_ / "out/report.html")
                .find("--set &#39;title=two words &amp; &lt;more&gt;&#39; --no-render --report -o out"),
            std::string::npos);
  // What is printed runs, and makes the same stock.
  const std::string stock = read_text(job_ / "out/stock.vdb");
  fs::remove_all(job_ / "out");
  ASSERT_EQ(swarf_there(command.substr(6)).exit_code, 0);
  EXPECT_EQ(read_text(job_ / "out/stock.vdb"), stock);
}

TEST_F(ResultsKept, NamesAndCommentsNeedNotBeUtf8) {
  const fs::path latin = folder_ / "Fr\xe4sen";
  fs::rename(job_, latin);
  job_ = latin;
  write_text(
      job_ / "slot.ngc",
      "G21 G90 G54\nT1 M6 (FR\xc4SER)\nS5000 M3\nG0 X-12 Y0 Z5 A0 B0\nG0 Z-1\nG0 X12 (NUT FR\xc4SEN)\nG1 Y1 "
      "F100\nG0 Z50\nM2\n");
  const auto run = swarf_there("run scene.toml --no-render -o out");
  EXPECT_EQ(run.exit_code, 1) << run.output;  // a rapid through the material
  const auto findings = nlohmann::json::parse(read_text(job_ / "out/findings.json"));
  EXPECT_NE(findings.dump().find("(NUT FR\xef\xbf\xbdSEN)"), std::string::npos) << findings.dump();
  EXPECT_EQ(nlohmann::json::parse(read_text(job_ / "out/metrics.json")).at("scene"), "Fr?sen");
}

/// Runs the program and interrupts it after a while; returns its exit code.
int interrupted_after(std::chrono::milliseconds delay, const fs::path& folder,
                      const std::vector<std::string>& words) {
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.c_str()) != 0) _exit(99);
    std::vector<char*> arguments{const_cast<char*>(SWARF_PROGRAM)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    if (freopen("/dev/null", "w", stderr) == nullptr || freopen("/dev/null", "w", stdout) == nullptr)
      _exit(99);
    execv(SWARF_PROGRAM, arguments.data());
    _exit(99);
  }
  std::this_thread::sleep_for(delay);
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_F(ResultsKept, AnInterruptAtAnyMomentLeavesWholeResults) {
  const std::vector<std::string> words{"run",   "scene.toml",         "-o",    "out",
                                       "--set", "movie.seconds=2",    "--set", "movie.size=[128,96]",
                                       "--set", "stock.voxel_mm=0.25"};
  const auto start = std::chrono::steady_clock::now();
  std::string line;
  for (const std::string& word : words) line += " '" + word + "'";
  ASSERT_EQ(swarf_there(line.substr(1)).exit_code, 0);
  const auto whole =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start);
  const std::string stock = read_text(job_ / "out/stock.vdb");
  for (int i = 1; i <= 12; ++i) {
    fs::remove_all(job_ / "out");
    const int code = interrupted_after(whole * i / 12, job_, words);
    EXPECT_TRUE(code == 0 || code == 130) << "interrupted after " << i << "/12: " << code;
    for (const auto& entry : fs::directory_iterator(job_))
      EXPECT_EQ(entry.path().filename().string().find(".part"), std::string::npos) << entry.path();
    if (!fs::exists(job_ / "out")) continue;  // before there was anything to keep
    for (const std::string& file : files_below(job_ / "out"))
      EXPECT_EQ(file.find(".part"), std::string::npos) << file;
    EXPECT_TRUE(fs::exists(job_ / "out/blocks.csv"));
    const auto resumed =
        swarf_there("run scene.toml --no-render --set stock.voxel_mm=0.25 --from out/stock.vdb -o again");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
    EXPECT_TRUE(fs::exists(job_ / "again/stock.vdb"));
  }
}

}  // namespace

}  // namespace results_kept_test

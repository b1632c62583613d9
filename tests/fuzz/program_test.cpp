// Damaged files through the shipped program, from the command line to the results and the pictures: it ends
// with 0, 1 or 2 and says why, within 20 s of processor time and 4 GB of address space.
//
//   SWARF_FUZZ_RUNS   how many (60)
//   SWARF_FUZZ_SEED   another start of the random numbers (1)
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <map>

#include "fuzz/mutation.h"
#include "fuzz/sandbox.h"
#include "support/program_run.h"

namespace swarf::test {
namespace {

namespace fs = std::filesystem;

/// A box of twelve facets.
std::string box_obj() {
  return "v -8 -4 -3\nv 8 -4 -3\nv 8 4 -3\nv -8 4 -3\nv -8 -4 -1\nv 8 -4 -1\nv 8 4 -1\nv -8 4 -1\n"
         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
}

/// A whole job in a folder, and its sound results.
void make_job(const fs::path& job) {
  const fs::path machines = fs::path(SWARF_SOURCE_DIR) / "tests/data/machines";
  for (const char* name : {"tetrahedron.ply", "tetrahedron.stl"}) fs::copy_file(machines / name, job / name);
  fs::copy_file(machines / "small.toml", job / "machine.toml");
  write_text(job / "slot.ngc",
             "G21 G90 G54\nT1 M6\nS5000 M3\nG0 X-12 Y0 Z5 A0 B0\nG1 Z-1 F600\nG1 X12\nG0 Z50\nM2\n");
  write_text(job / "tools.tbl", "T1 P1 Z60 D4 ; end mill\nT2 P2 Z80 D6 ; ball\n");
  write_text(job / "design.obj", box_obj());
  write_text(job / "scene.toml",
             "title = \"fuzz\"\nmachine = \"machine.toml\"\nnc = \"slot.ngc\"\ndialect = \"linuxcnc\"\n"
             "tool_table = \"tools.tbl\"\n[stock]\nbox_mm = [[-8, -4, -3], [8, 4, 0]]\nvoxel_mm = 0.5\n"
             "[design]\nkind = \"mesh\"\nmesh = \"design.obj\"\npitch_mm = 1\n[interpolator]\nperiod_ms = 4\n"
             "[accept]\ngouge_max_um = 2000\n[movie]\nseconds = 0\n[stills]\nsize = [64, 64]\nsamples = 1\n");
}

/// A damaged file and the command that meets it; {} is the job's folder.
struct Attack {
  const char* file;
  const char* command;
};
constexpr Attack kAttacks[] = {
    {"scene.toml", "check scene.toml"},
    {"scene.toml", "run scene.toml --no-render --max-memory 1500 -o out"},
    {"scene.toml", "run scene.toml --max-memory 1500 -o out"},
    {"machine.toml", "run scene.toml --no-render --max-memory 1500 -o out"},
    {"machine.toml", "check machine.toml"},
    {"tools.tbl", "run scene.toml --no-render --max-memory 1500 -o out"},
    {"slot.ngc", "run scene.toml --no-render --max-memory 1500 -o out"},
    {"design.obj", "run scene.toml --max-memory 1500 -o out"},
    {"tetrahedron.ply", "run scene.toml --max-memory 1500 -o out"},
    {"tetrahedron.stl", "run scene.toml --max-memory 1500 -o out"},
    {"design.obj", "compare sound/stock.vdb design.obj -o out"},
    {"part.stl", "compare part.stl design.obj"},
    {"part.ply", "compare part.ply design.obj"},
    {"part.ply", "compare design.obj part.ply -o out"},
    {"sound/stock.vdb", "compare sound/stock.vdb design.obj"},
    {"sound/stock.vdb", "run scene.toml --no-render --from sound/stock.vdb -o out"},
    {"sound/run.json", "render sound --still picture.png"},
    {"sound/input/program/slot.ngc", "render sound --still picture.png --kind fan"},
    {"sound/surface_0.rays", "render sound --still picture.png --kind deviation"},
    {"sound/run.record", "replay sound/run.record"},
};

/// The sanitizers need terabytes of address space that they never fill.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
const std::string kMemoryLimit;
#else
const std::string kMemoryLimit = "ulimit -v 4194304; ";
#endif

class FuzzProgram : public testing::Test {
 protected:
  void SetUp() override {
    make_job(job_);
    const std::string start = "cd " + job_.string() + " && " + SWARF_PROGRAM + " ";
    const auto sound = run_command(start + "run scene.toml --no-render --record -o sound");
    ASSERT_TRUE(sound.exit_code == 0 || sound.exit_code == 1) << sound.output;
    const auto meshes = run_command(start + "export sound --stl part.stl --ply part.ply");
    ASSERT_EQ(meshes.exit_code, 0) << meshes.output;
  }
  void TearDown() override { fs::remove_all(job_); }

  ProgramRun run_limited(const std::string& arguments) const {
    fs::remove_all(job_ / "out");
    return run_command("cd " + job_.string() + "; ulimit -c 0; ulimit -t 20; " + kMemoryLimit +
                       SWARF_PROGRAM + " " + arguments);
  }

  fs::path job_ = fresh_folder("fuzz_program");
};

TEST_F(FuzzProgram, EndsWithAnExitCodeOfItsOwn) {
  const uint64_t runs = from_environment("SWARF_FUZZ_RUNS", 60),
                 seed = from_environment("SWARF_FUZZ_SEED", 1);
  const fs::path failed = fs::temp_directory_path() / "swarf_fuzz_failures";
  std::map<int, int> codes;
  for (uint64_t n = 0; n < runs; ++n) {
    const Attack& attack = kAttacks[n % std::size(kAttacks)];
    const fs::path file = job_ / attack.file;
    const std::string sound = read_text(file);
    Rng rng(seed * 0x9e3779b97f4a7c15ULL + n * 0x2545f4914f6cdd1dULL);
    const std::string bytes = damaged(sound, rng);
    write_text(file, bytes);
    const ProgramRun run = run_limited(attack.command);
    write_text(file, sound);
    ++codes[run.exit_code];
    const bool good = run.exit_code >= 0 && run.exit_code <= 2;
    if (good && (run.exit_code != 2 || run.output.find("error") != std::string::npos)) continue;
    fs::create_directories(failed);
    const fs::path kept =
        failed / ("run_" + std::to_string(seed) + "_" + std::to_string(n) + "_" + file.filename().string());
    write_text(kept, bytes);
    ADD_FAILURE() << "run " << n << " of seed " << seed << ": swarf " << attack.command << " ended with "
                  << run.exit_code << "; " << attack.file << " is kept as " << kept << "\n"
                  << run.output.substr(0, 600);
  }
  for (const auto& [code, count] : codes) std::cout << count << " runs ended with " << code << "\n";
  EXPECT_GT(codes[2], 0);
}

}  // namespace
}  // namespace swarf::test

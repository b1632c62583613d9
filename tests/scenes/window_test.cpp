// A part of a program's time, made again from the folder of a run: the very rows of the whole run's table,
// from whatever place in the program; and what is no part of the program is refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "base/rng.h"
#include "support/program_run.h"

namespace {

namespace fs = std::filesystem;
using swarf::test::read_text;
using swarf::test::write_text;

/// Twenty slow grooves of eight seconds each, with a rapid back: 190 000 cycles in forty runs of blocks.
std::string grooves() {
  std::string text = "G21 G90 G54 G64 P0.01\nT1 M6\nS5000 M3\nG0 X-8 Y-3 Z5 A0 B0\n";
  for (int i = 0; i < 20; ++i) {
    const std::string y = std::to_string(-3.0 + 0.3 * i);
    text += "G0 X-8 Y" + y + " Z2\nG1 Z-0.5 F600\nX-3 F120\nX3 Z-0.7\nX8 Z-0.5\nG0 Z2\n";
  }
  return text + "G0 Z50\nM2\n";
}

class Window : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder() = swarf::test::fresh_folder("window");
    const fs::path machines = fs::path(SWARF_SOURCE_DIR) / "tests/data/machines";
    for (const char* file : {"tetrahedron.ply", "tetrahedron.stl", "small.toml"})
      fs::copy_file(machines / file, folder() / file);
    write_text(folder() / "grooves.ngc", grooves());
    write_text(folder() / "scene.toml",
               "machine = \"small.toml\"\nnc = \"grooves.ngc\"\ndialect = \"linuxcnc\"\n"
               "[cutter]\nnumber = 1\ndiameter_mm = 4\nflute_length_mm = 10\nlength_mm = 40\n"
               "[stock]\nbox_mm = [[-8, -4, -3], [8, 4, 0]]\nvoxel_mm = 0.5\n[design]\nkind = \"none\"\n"
               "[movie]\nseconds = 0\n[stills]\nsize = [64, 64]\nsamples = 1\n");
    const auto run = swarf_there("run scene.toml --no-render --trajectory csv -o out");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    std::istringstream table(read_text(folder() / "out/trajectory.csv"));
    for (std::string line; std::getline(table, line);) rows().push_back(line);
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }

  static fs::path& folder() {
    static fs::path path;
    return path;
  }
  /// Of the whole run, the head first.
  static std::vector<std::string>& rows() {
    static std::vector<std::string> list;
    return list;
  }
  static swarf::test::ProgramRun swarf_there(const std::string& arguments) {
    return swarf::test::run_command("cd '" + folder().string() + "' && " + std::string(SWARF_PROGRAM) + " " +
                                    arguments);
  }
  /// The head and the rows first to last of the whole run, numbered from 0.
  static std::string expected(size_t first, size_t last) {
    std::string text = rows().front() + "\n";
    for (size_t k = first; k <= last; ++k) text += rows()[k + 1] + "\n";
    return text;
  }
  static std::string exported(const std::string& options) {
    const auto run = swarf_there("export out --trajectory part.csv " + options);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return read_text(folder() / "part.csv");
  }
  static double time_of(size_t k) { return std::stod(rows()[k + 1]); }
  static int line_of(size_t k) { return std::stoi(rows()[k + 1].substr(rows()[k + 1].find(',') + 1)); }
};

TEST_F(Window, HasTheRowsOfTheWholeRun) {
  const size_t cycles = rows().size() - 1;
  ASSERT_GT(cycles, 150'000U) << "several places to begin at";
  swarf::Rng rng(11);
  for (int i = 0; i < 12; ++i) {
    const auto first = static_cast<size_t>(rng.uniform(0.0, static_cast<double>(cycles - 2500)));
    const size_t last = first + static_cast<size_t>(rng.uniform(0.0, 2500.0));
    const std::string options =
        "--from " + std::to_string(time_of(first)) + " --to " + std::to_string(time_of(last));
    EXPECT_TRUE(exported(options) == expected(first, last)) << "Rng rng(11), " << options;
  }
  EXPECT_TRUE(exported("--to 0") == expected(0, 0));
  EXPECT_TRUE(exported("--from 100.00004 --to 100.00006") == expected(100'001, 100'001)) << "between cycles";
  EXPECT_TRUE(exported("") == expected(0, cycles - 1));
}

TEST_F(Window, GoesByLinesOfTheProgram) {
  for (const int line : {6, 45, 123}) {
    size_t first = rows().size(), last = 0;
    for (size_t k = 0; k + 1 < rows().size(); ++k) {
      if (line_of(k) == line) first = std::min(first, k);
      if (line_of(k) == line + 1) last = k;
    }
    const std::string options =
        "--from-line " + std::to_string(line) + " --to-line " + std::to_string(line + 1);
    EXPECT_TRUE(exported(options) == expected(first, last)) << options;
  }
}

TEST_F(Window, OfAMotionAndOfTheProgramOnly) {
  const auto refused = [&](const std::string& arguments, const char* code) {
    const auto run = swarf_there(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << ": " << run.output;
    EXPECT_NE(run.output.find(code), std::string::npos) << arguments << ": " << run.output;
    for (const char* file : {"x.csv", "x.part.csv", "x.stl", "x.png"})
      EXPECT_FALSE(fs::exists(folder() / file)) << arguments;
  };
  refused("export out --trajectory x.csv --from 1e6", "[place-unknown]");
  refused("export out --trajectory x.csv --from 10 --to 9", "[place-unknown]");
  refused("export out --trajectory x.csv --from-line 100000", "[place-unknown]");
  refused("export out --trajectory x.csv --from-line 60 --to-line 20", "[place-unknown]");
  refused("export out --trajectory x.dat", "[unknown-ending]");
  refused("export out --stl x.stl --from 1 --to 2", "[no-motion-asked]");
  refused("render out --still x.png --from 1 --to 2", "[no-motion-asked]");
  EXPECT_NE(swarf_there("export out --trajectory x.csv --from 1 --from-line 7").exit_code, 0);
}

TEST_F(Window, OfChangedInputsIsRefused) {
  fs::copy(folder() / "out", folder() / "changed", fs::copy_options::recursive);
  std::string program = read_text(folder() / "changed/input/program/grooves.ngc");
  // As many cycles as before: only what they are differs.
  program.replace(program.find("Z-0.7"), 5, "Z-0.3");
  write_text(folder() / "changed/input/program/grooves.ngc", program);
  for (const char* command :
       {"export changed --trajectory y.csv --from 1 --to 2", "export changed --machine-gltf y.glb",
        "render changed --kind machine --still y.png --from 1 --to 2"}) {
    const auto run = swarf_there(command);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("[run-differs]"), std::string::npos) << run.output;
  }
  std::string places = read_text(folder() / "out/motion.places");
  places[places.size() / 2] = static_cast<char>(places[places.size() / 2] ^ 1);
  write_text(folder() / "changed/motion.places", places);
  const auto broken = swarf_there("export changed --trajectory y.csv --from 1 --to 2");
  EXPECT_EQ(broken.exit_code, 2) << broken.output;
  EXPECT_NE(broken.output.find("[not-a-run]"), std::string::npos) << broken.output;
}

}  // namespace

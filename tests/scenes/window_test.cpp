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

/// Twenty slow grooves of eight seconds each, with a rapid back: 190 000 cycles in forty runs of blocks. Then
/// the rotary axes turn in the air.
std::string grooves() {
  std::string text = "G21 G90 G54 G64 P0.01\nT1 M6\nS5000 M3\nG0 X-8 Y-3 Z5 A0 B0\n";
  for (int i = 0; i < 20; ++i) {
    const std::string y = std::to_string(-3.0 + 0.3 * i);
    text += "G0 X-8 Y" + y + " Z2\nG1 Z-0.5 F600\nX-3 F120\nX3 Z-0.7\nX8 Z-0.5\nG0 Z2\n";
  }
  return text + "G0 Z50\nG0 A20 B-200\nG1 A-30 B150 F2000\nM2\n";
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
               "[accept]\nmachine_parts = 100\n"  // its links are mere tetrahedra

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
    for (const auto& entry : fs::directory_iterator(folder()))
      EXPECT_NE(entry.path().filename().string()[0], 'x') << arguments << ": " << entry.path();
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

/// Read by h5py, as users would: every column of trajectory.csv, its unit, and the same numbers to the
/// decimals that the text has; names for kind and tool; chunks that are compressed.
constexpr const char* kReadH5 = R"(
import csv, sys, h5py, numpy
h5, table, scale = sys.argv[1], sys.argv[2], {"mm": 0.5e-10, "deg": 0.5e-10, "s": 0.5e-6, "mm/min": 0.5e-4, "1": 0.5e-9}
rows = list(csv.reader(open(table)))
head, rows = rows[0], rows[1:]
assert len({name.lower() for name in head}) == len(head), "names that differ by case alone: SQL and Excel take them for one"
with h5py.File(h5, "r") as file:
    assert set(file) == set(head), (set(file) ^ set(head))
    for i, name in enumerate(head):
        data, texts = file[name], [row[i] for row in rows]
        assert data.shape == (len(rows),) and data.compression == "gzip" and data.shuffle and data.chunks, name
        values, names = data[:], h5py.check_enum_dtype(data.dtype)
        if names:
            back = {value: text for text, value in names.items()}
            assert [back[v] for v in values] == texts, name
        elif values.dtype.kind == "i":
            assert [str(v) for v in values] == texts, name
        else:
            unit = data.attrs["units"]
            unit = unit.decode() if isinstance(unit, bytes) else unit
            want = numpy.array(texts, dtype=float)
            error = numpy.abs(values - want).max()
            assert error <= scale[unit] + 4e-16 * numpy.abs(want).max(), (name, error)
            ending = name.rsplit("_", 1)[-1]
            assert unit == {"mm": "mm", "deg": "deg", "s": "s", "min": "mm/min"}.get(ending, "1"), (name, unit)
    t = file["t_s"][:]
    assert numpy.array_equal(t, numpy.arange(round(t[0] / file.attrs["period_s"]), round(t[0] / file.attrs["period_s"]) + len(t)) * file.attrs["period_s"])
print("read", len(rows), "rows")
)";

TEST_F(Window, AsHdf5HasTheSameColumnsAndNumbers) {
  write_text(folder() / "read.py", kReadH5);
  const auto read = [&](const std::string& h5, const std::string& csv) {
    const auto run = swarf::test::run_command("cd '" + folder().string() + "' && /usr/bin/python3 read.py " +
                                              h5 + " " + csv);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_NE(run.output.find("read "), std::string::npos) << run.output;
  };
  ASSERT_EQ(swarf_there("run scene.toml --no-render --set output.trajectory='\"h5\"' -o h5").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder() / "h5/trajectory.csv"));
  read("h5/trajectory.h5", "out/trajectory.csv");
  EXPECT_LT(4 * fs::file_size(folder() / "h5/trajectory.h5"), fs::file_size(folder() / "out/trajectory.csv"));
  // The command line goes before the scene; equal runs give equal files.
  ASSERT_EQ(
      swarf_there("run scene.toml --no-render --set output.trajectory='\"h5\"' --trajectory none -o none")
          .exit_code,
      0);
  EXPECT_FALSE(fs::exists(folder() / "none/trajectory.h5"));
  for (const char* name : {"a.h5", "b.h5"})
    ASSERT_EQ(swarf_there(std::string("export h5 --from 20 --to 60 --trajectory ") + name).exit_code, 0);
  EXPECT_TRUE(read_text(folder() / "a.h5") == read_text(folder() / "b.h5"));
  ASSERT_EQ(swarf_there("export out --from 20 --to 60 --trajectory a.csv").exit_code, 0);
  read("a.h5", "a.csv");
}

/// A machine.glb of the whole program and one of a part of it, played against every cycle.
TEST_F(Window, KeysOfTheAnimationStayWithinTheErrorThatItStates) {
  for (const std::string part : {"", "--from 100 --to 140", "--from 150"}) {
    for (const std::string output : {"--trajectory part.h5", "--machine-gltf part.glb"}) {
      const auto run = swarf_there("export out " + output + " " + part);
      ASSERT_EQ(run.exit_code, 0) << run.output;
    }
    const auto played =
        swarf::test::run_command("cd '" + folder().string() + "' && /usr/bin/python3 '" +
                                 SWARF_SOURCE_DIR "/tests/gltf/keys_within.py' part.glb part.h5");
    EXPECT_EQ(played.exit_code, 0) << part << ": " << played.output;
    EXPECT_NE(played.output.find("Z: "), std::string::npos) << played.output;
  }
}

TEST_F(Window, AFullDiskIsToldForHdf5Too) {
  const auto run = swarf_there("export out --trajectory full.h5 >/dev/null");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const auto kib = fs::file_size(folder() / "full.h5") / 1024;
  for (const auto limit : {kib / 3, kib - 8, uintmax_t{1}}) {
    const auto full = swarf::test::run_command("cd '" + folder().string() + "' && trap '' XFSZ; ulimit -f " +
                                               std::to_string(2 * limit) + "; " + std::string(SWARF_PROGRAM) +
                                               " export out --trajectory x.h5");
    EXPECT_EQ(full.exit_code, 2) << limit << " KiB: " << full.output;
    EXPECT_NE(full.output.find("[cannot-write]"), std::string::npos) << full.output;
    for (const auto& entry : fs::directory_iterator(folder()))
      EXPECT_NE(entry.path().filename().string()[0], 'x') << limit << " KiB: " << entry.path();
  }
}

}  // namespace

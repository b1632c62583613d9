// What a person opens, watches and passes on: numbers of findings, the storyboard, the page's head, exports,
// and what is wrong with any of it told before the work.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "mesh/mesh_io.h"
#include "render/image_io.h"
#include "support/program_run.h"

namespace review_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::ProgramRun;
using swarf::test::read_text;
using swarf::test::run_command;
using swarf::test::run_swarf;
using swarf::test::write_text;

/// Two tools in a block of 40 x 30 x 12; T2 goes down in rapid at two places.
constexpr const char* kProgram = R"(G21 G17 G90 G94 G54
T1 M6 G43 H1
S9000 M3
G0 X5 Y5
Z2
G1 Z-3 F600
X15 F1200
G0 Z20
T2 M6 G43 H2
S3000 M3
G0 X25 Y10
Z2
G0 Z-2
Z2
G0 X35 Y25
G0 Z-2
Z20
M2
)";

constexpr const char* kScene = R"(title = "A <script>alert(1)</script> plate"
nc = "plate.ngc"
tools = "T1=6,T2=4"
setup.work_origin_mm = "on_table"

[stock]
box_mm = [[0, 0, -12], [40, 30, 0]]
voxel_mm = 0.4

[stills]
kinds = ["part"]
size = [320, 180]
samples = 2

[movie]
size = [128, 72]
fps = 10
seconds = 1
voxel_mm = 1.0
)";

bool says(const ProgramRun& run, const std::string& text) {
  return run.output.find(text) != std::string::npos;
}

class Review : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = swarf::test::fresh_folder("review");
    write_text(folder_ / "plate.ngc", kProgram);
    write_text(folder_ / "scene.toml", kScene);
    run_ = run_swarf("run " + (folder_ / "scene.toml").string() + " -o " + (folder_ / "out").string());
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static std::string out() { return (folder_ / "out").string(); }
  static json kept(const char* name) { return json::parse(read_text(folder_ / "out" / name)); }
  /// The scene with more text, in a folder of its own.
  static ProgramRun run_with(const std::string& more, const std::string& options = "") {
    const fs::path own = swarf::test::fresh_folder("review_more");
    write_text(own / "plate.ngc", kProgram);
    write_text(own / "scene.toml", kScene + more);
    return run_swarf("run " + (own / "scene.toml").string() + " -o " + (own / "out").string() + " " +
                     options);
  }
  static fs::path more_folder() { return swarf::test::scratch_folder() / "review_more"; }
  /// Refused with this code, at the scene where `at` says so, and nothing was cut.
  static void expect_refused(const ProgramRun& run, const std::string& code, const std::string& at = "") {
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_TRUE(says(run, "[" + code + "]")) << code << "\n" << run.output;
    EXPECT_TRUE(says(run, at)) << at << "\n" << run.output;
    EXPECT_FALSE(says(run, "cut     ")) << run.output;
    EXPECT_FALSE(fs::exists(more_folder() / "out"));
  }

  static inline fs::path folder_;
  static inline ProgramRun run_;
};

TEST_F(Review, AFindingHasOneNumberEverywhere) {
  ASSERT_EQ(run_.exit_code, 1) << run_.output;
  const json findings = kept("findings.json");
  ASSERT_GE(findings.size(), 2U);
  int faults = 0;
  for (const json& one : findings) {
    const int number = one.at("number");
    EXPECT_TRUE(number == faults || number == faults + 1) << "not in the page's order: " << findings.dump(1);
    faults = std::max(faults, number);
  }
  const std::string page = read_text(folder_ / "out/report.html");
  EXPECT_NE(page.find("id=\"finding-" + std::to_string(faults) + "\""), std::string::npos);
  EXPECT_EQ(page.find("id=\"finding-" + std::to_string(faults + 1) + "\""), std::string::npos);
  const std::string picture = (folder_ / "finding.png").string();
  const std::string render =
      "render " + out() + " --still " + picture + " --size 320 180 --samples 1 --finding ";
  const ProgramRun last = run_swarf(render + std::to_string(faults));
  EXPECT_EQ(last.exit_code, 0) << last.output;
  EXPECT_GT(fs::file_size(picture), 1000U);
  const ProgramRun beyond = run_swarf(render + std::to_string(faults + 1));
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_TRUE(says(beyond, "this run has " + std::to_string(faults) + " findings")) << beyond.output;
}

TEST_F(Review, FindingsThatAreNoneAreTold) {
  const fs::path copy = folder_ / "broken";
  fs::copy(folder_ / "out", copy, fs::copy_options::recursive);
  for (const char* text : {"{", "3", R"([{"code": "gouge"}])"}) {
    write_text(copy / "findings.json", text);
    const ProgramRun run = run_swarf("render " + copy.string() + " --still " + (folder_ / "x.png").string() +
                                     " --finding 1 --size 64 64");
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_TRUE(says(run, "[broken-findings]")) << run.output;
  }
  fs::remove_all(copy);
}

TEST_F(Review, ARunOfAnotherVersionIsTold) {
  const fs::path copy = folder_ / "other";
  fs::copy(folder_ / "out", copy, fs::copy_options::recursive);
  json manifest = kept("run.json");
  manifest["swarf"] = "9.9.9";
  write_text(copy / "run.json", manifest.dump());
  const ProgramRun run = run_swarf("export " + copy.string() + " --stl " + (folder_ / "x.stl").string());
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(says(run, "[other-version]") && says(run, "swarf 9.9.9 has made this run")) << run.output;
  manifest["swarf"] = 3;
  write_text(copy / "run.json", manifest.dump());
  EXPECT_TRUE(says(run_swarf("export " + copy.string() + " --stl " + (folder_ / "x.stl").string()),
                   "[other-version]"));
  fs::remove_all(copy);
}

TEST_F(Review, WhatAStoryboardNamesAndIsNotThereIsToldBeforeTheCut) {
  expect_refused(run_with("[[movie.shot]]\nfrom_line = 999\n"), "place-unknown", "scene.toml:");
  expect_refused(run_with("[[movie.shot]]\nto_line = 1\n"), "place-unknown",
                 "the nearest line with motion is");
  expect_refused(run_with("[[movie.shot]]\nto_s = 1e6\n"), "place-unknown", "write a time from 0 to");
  expect_refused(run_with("[[movie.shot]]\nfrom_line = 16\nto_line = 7\n"), "place-unknown");
  expect_refused(run_with("[[movie.shot]]\nfrom_line = 14\nspeed = \"cutting\"\n"), "nothing-cut",
                 "scene.toml:");
  expect_refused(run_with("[[movie.shot]]\nsection = \"x=500\"\n"), "section-misses", "x from 0 to 40 mm");
  expect_refused(run_with("[[movie.shot]]\ncamera = \"drone\"\n"), "unknown-camera", "scene.toml:");
  expect_refused(run_with("[[movie.shot]]\nspeed = \"warp\"\n"), "unknown-choice");
  expect_refused(run_with("[[movie.shot]]\nzoom = 3\n"), "unknown-key");
  // Where no movie is made its shots are not asked for.
  const ProgramRun without = run_with("[[movie.shot]]\nfrom_line = 999\n", "--no-render");
  EXPECT_EQ(without.exit_code, 1) << without.output;
}

TEST_F(Review, AMovieThatCannotBeWrittenIsToldBeforeTheWork) {
  const std::string render = "render " + out() + " --movie ";
  EXPECT_TRUE(says(run_swarf(render + (folder_ / "cut.avi").string()), "[movie-ending]"));
  EXPECT_TRUE(says(run_swarf(render + (folder_ / "none/cut.mp4").string()), "[cannot-write]"));
  EXPECT_TRUE(says(run_swarf(render + "/proc/cut.mp4"), "[cannot-write]"));
  fs::create_directories(folder_ / "folder.mp4");
  EXPECT_TRUE(says(run_swarf(render + (folder_ / "folder.mp4").string()), "[cannot-write]"));
}

TEST_F(Review, AFullDiskInTheMiddleOfAMovieLeavesTheLastGoodOne) {
  const fs::path movie = folder_ / "kept.mp4";
  const std::string words = " render " + out() + " --movie " + movie.string() + " --seconds 3";
  ASSERT_EQ(run_swarf(words).exit_code, 0);
  const std::string good = read_text(movie);
  const ProgramRun full = run_command("ulimit -f " + std::to_string(good.size() / 2 / 1024) +
                                      "; trap '' XFSZ; " + SWARF_PROGRAM + words);
  EXPECT_EQ(full.exit_code, 2) << full.output;
  EXPECT_TRUE(says(full, "[movie-write]")) << full.output;
  EXPECT_EQ(read_text(movie), good);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().filename().string().find("kept.mp4."), std::string::npos) << entry.path();
}

TEST_F(Review, ShortMoviesAreMovies) {
  const ProgramRun frame =
      run_swarf("render " + out() + " --movie " + (folder_ / "one.mp4").string() + " --seconds 0.01");
  EXPECT_EQ(frame.exit_code, 0) << frame.output;
  EXPECT_TRUE(says(frame, ": 1 frames")) << frame.output;
  const ProgramRun none = run_with("[[movie.shot]]\nseconds = 0\n");
  EXPECT_EQ(none.exit_code, 2) << none.output;  // a shot that shows nothing is a mistake
  EXPECT_TRUE(says(none, "[out-of-range]")) << none.output;
}

TEST_F(Review, TheHeadOfThePageSaysWhoseJobItIs) {
  const std::string longest(3000, 'W');
  swarf::render::Image logo{8, 4, std::vector<uint8_t>(size_t{4} * 8 * 4, 90)};
  const std::string png = (folder_ / "logo.png").string();
  swarf::render::save_png(logo, png);
  const ProgramRun run =
      run_with("[report]\nlogo = \"" + png + "\"\njob = \"J-<b>17</b>\"\npart_number = \"" + longest +
                   "\"\ncustomer = \"M\u00fcller & S\u00f6hne \u5de5\u5177\"\ndate = \"2026-11-25\"\n"
                   "approval = \"A. Pr\u00fcfer\"\n",
               "--no-render --report");
  EXPECT_EQ(run.exit_code, 1) << run.output;
  const std::string page = read_text(more_folder() / "out/report.html");
  for (const std::string& text :
       {std::string("J-&lt;b&gt;17&lt;/b&gt;"), longest,
        std::string("M\u00fcller &amp; S\u00f6hne \u5de5\u5177"), std::string("2026-11-25"),
        std::string("A. Pr\u00fcfer"), std::string("class=\"logo\"")})
    EXPECT_NE(page.find(text), std::string::npos) << text.substr(0, 40);
  // The folder stands for the scene: what it needs is in it.
  fs::remove(png);
  const ProgramRun exported =
      run_swarf("export " + (more_folder() / "out").string() + " --stl " + (folder_ / "x.stl").string());
  EXPECT_EQ(exported.exit_code, 0) << exported.output;
  EXPECT_EQ(read_text(folder_ / "out/report.html").find("class=\"job-head\""), std::string::npos);
}

TEST_F(Review, ALogoThatIsNoPictureIsToldAtItsKey) {
  write_text(folder_ / "logo.txt", "no picture");
  write_text(folder_ / "cut.png", read_text(folder_ / "out/still_part.png").substr(0, 200));
  for (const char* name : {"logo.txt", "cut.png", "none.png", "out"})
    expect_refused(run_with("[report]\nlogo = \"" + (folder_ / name).string() + "\"\n"), "bad-logo",
                   "scene.toml:");
}

TEST_F(Review, CycleTimeAndToolsAddUp) {
  const json motion = kept("metrics.json").at("motion");
  double all = 0.0;
  ASSERT_EQ(motion.at("operations").size(), 2U);
  for (const json& one : motion.at("operations"))
    all += one.at("feed_s").get<double>() + one.at("rapid_s").get<double>() + one.at("dwell_s").get<double>();
  EXPECT_NEAR(all, motion.at("time_s").get<double>(), 2e-3);
  const json& first = motion.at("operations").at(0);
  EXPECT_NEAR(first.at("feed_mm").get<double>(), 15.0, 0.05);  // 5 down, 10 along
  EXPECT_NEAR(first.at("deepest_mm").get<double>(), 3.0, 1e-6);
  EXPECT_GE(first.at("stick_out_mm").get<double>(), 3.0);
  EXPECT_LE(first.at("stick_out_mm").get<double>(), 3.5);
  const std::string page = read_text(folder_ / "out/report.html");
  EXPECT_NE(page.find("Cycle time"), std::string::npos);
  EXPECT_NE(page.find("class=\"tool-flutes\""), std::string::npos);
  // A three-axis job: nothing of the paper, of swings or of the pole.
  for (const char* word : {"Lin &amp; Koren", "rotary", "Rotary", "pole", "swing"})
    EXPECT_EQ(page.substr(0, page.find("<script>")).find(word), std::string::npos) << word;
}

TEST_F(Review, PicturesInThePageAreSmall) {
  const std::string page = read_text(folder_ / "out/report.html");
  EXPECT_NE(page.find("<img src=\"data:image/webp;base64,"), std::string::npos);
  EXPECT_EQ(page.find("<img src=\"data:image/png;base64,"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "out/still_part.png"));
}

TEST_F(Review, TheCutStockAs3mfAndObj) {
  const std::string part = (folder_ / "part").string();
  const ProgramRun run =
      run_swarf("export " + out() + " --stl " + part + ".stl --obj " + part + ".obj --3mf " + part + ".3mf");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const swarf::TriMesh stl = swarf::mesh::load_mesh(part + ".stl"),
                       obj = swarf::mesh::load_mesh(part + ".obj");
  EXPECT_EQ(obj.triangles.size(), stl.triangles.size());
  const ProgramRun read =
      run_command("/usr/bin/python3 -c \"import zipfile,re,sys; z=zipfile.ZipFile('" + part +
                  ".3mf'); assert z.testzip() is None; t=z.read('3D/3dmodel.model').decode(); "
                  "import xml.dom.minidom; xml.dom.minidom.parseString(t); "
                  "print(re.search('unit=.(.*?).[ >]',t)[1], len(re.findall('<triangle ',t)), "
                  "len(re.findall('<item ',t)))\"");
  EXPECT_EQ(read.output, "millimeter " + std::to_string(stl.triangles.size()) + " 1\n");
}

TEST_F(Review, TheCutStockAsStep) {
  const std::string part = (folder_ / "part.step").string();
  const ProgramRun run = run_swarf("export " + out() + " --step " + part + " --error-um 20");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(says(run, "plane triangles, decimated within")) << run.output;
  const std::string text = read_text(part);
  EXPECT_TRUE(text.starts_with("ISO-10303-21;"));
  EXPECT_NE(text.find("FACETED_BREP('',"), std::string::npos);
  EXPECT_NE(text.find("SI_UNIT(.MILLI.,.METRE.)"), std::string::npos);
  EXPECT_NE(text.find("END-ISO-10303-21;"), std::string::npos);
  const ProgramRun nowhere = run_swarf("export " + out() + " --step " + (folder_ / "no/part.step").string());
  EXPECT_EQ(nowhere.exit_code, 2) << nowhere.output;
}

TEST_F(Review, ThePageAsPdf) {
  if (run_command("command -v chromium").exit_code != 0) GTEST_SKIP() << "there is no chromium here";
  const std::string pdf = (folder_ / "page.pdf").string();
  const ProgramRun run = run_swarf("render " + out() + " --pdf " + pdf);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const std::string bytes = read_text(pdf);
  EXPECT_TRUE(bytes.starts_with("%PDF-"));
  EXPECT_GT(bytes.size(), 20000U);
  const ProgramRun none = run_swarf("run " + (folder_ / "scene.toml").string() + " --no-render --pdf -o " +
                                    (folder_ / "no").string());
  EXPECT_TRUE(none.exit_code == 2 && says(none, "[no-page]")) << none.output;
  const ProgramRun lacking =
      run_command("PATH=/nowhere " + std::string(SWARF_PROGRAM) + " render " + out() + " --pdf " + pdf);
  EXPECT_TRUE(lacking.exit_code == 2 && says(lacking, "[no-chromium]")) << lacking.output;
}

TEST_F(Review, ADesignWithoutAreaIsTold) {
  for (const char* text :
       {"solid a\nendsolid a\n",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\n"
        "endloop\nendfacet\nendsolid a\n"}) {
    write_text(folder_ / "flat.stl", text);
    const ProgramRun run = run_with("[design]\nkind = \"mesh\"\nmesh = \"" + (folder_ / "flat.stl").string() +
                                    "\"\npitch_mm = 1\n");
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_TRUE(says(run, "flat.stl") && says(run, "fix:")) << run.output;
    EXPECT_FALSE(says(run, "cut     ")) << run.output;
  }
}

}  // namespace
}  // namespace review_test

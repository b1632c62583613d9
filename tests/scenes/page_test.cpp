// What the page and the glTF files of a run say of the part is what metrics.json says, on CAD faces, on a
// mesh, on a plane and above a gap; and a finding leads to its place.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "mesh/mesh_io.h"
#include "mesh/plain_solids.h"
#include "render/image_io.h"
#include "support/glb.h"
#include "support/program_run.h"

namespace page_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::Glb;
using swarf::test::range_of;
using swarf::test::read_glb;
using swarf::test::read_text;
using swarf::test::run_command;
using swarf::test::run_swarf;

constexpr double kReadLimitUm = 0.1;
constexpr int kNoChromium = 77;

/// Planted gouges of 20, 5 and 1 um below a plane with scallops.
class GougedPage : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = swarf::test::fresh_folder("gouged_page");
    const auto run = run_swarf("run " SWARF_SOURCE_DIR
                               "/scenes/exact_gouges/scene.toml --set movie.seconds=1 "
                               "--set \"stills.kinds=[]\" -o " +
                               run_folder());
    ASSERT_EQ(run.exit_code, 1) << run.output;
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  static std::string run_folder() { return (folder_ / "run").string(); }
  inline static fs::path folder_;
};

TEST_F(GougedPage, DeviationInTheGltfIsThatOfTheMetrics) {
  const json surface = json::parse(read_text(folder_ / "run/metrics.json")).at("surface");
  const auto [low, high] = range_of(read_glb(folder_ / "run/part.glb"), "_DEVIATION_UM");
  EXPECT_NEAR(low, -surface.at("gouge_max_um").get<double>(), kReadLimitUm);
  EXPECT_NEAR(high, surface.at("excess_max_um").get<double>(), kReadLimitUm);
}

/// What is exported later says the same, with the pins of the findings.
TEST_F(GougedPage, AnExportedPartSaysTheSame) {
  const fs::path part = folder_ / "exported.glb";
  const auto run = run_swarf("export " + run_folder() + " --gltf " + part.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json surface = json::parse(read_text(folder_ / "run/metrics.json")).at("surface");
  const Glb glb = read_glb(part);
  EXPECT_NEAR(range_of(glb, "_DEVIATION_UM").first, -surface.at("gouge_max_um").get<double>(), kReadLimitUm);
  size_t pins = 0;
  for (const json& node : glb.model.at("nodes"))
    if (node.contains("extras") && node.at("extras").value("role", "") == "finding") ++pins;
  EXPECT_EQ(pins, 3U);
}

TEST_F(GougedPage, FindingsStandInTheGltfWithTheirNumbers) {
  const json findings = json::parse(read_text(folder_ / "run/findings.json"));
  const Glb glb = read_glb(folder_ / "run/part.glb");
  ASSERT_EQ(findings.size(), 3U);
  for (const json& finding : findings) {
    const json* pin = nullptr;
    for (const json& node : glb.model.at("nodes"))
      if (node.contains("extras") &&
          node.at("extras").value("finding", 0.0) == finding.at("number").get<double>())
        pin = &node;
    ASSERT_NE(pin, nullptr) << finding.dump();
    const json& extras = pin->at("extras");
    EXPECT_EQ(extras.at("line"), finding.at("line"));
    EXPECT_EQ(extras.at("text"), finding.at("text"));
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(pin->at("translation").at(k).get<double>(), finding.at("place_mm").at(k).get<double>(),
                  1e-9);
      EXPECT_EQ(extras.at(std::array{"x_mm", "y_mm", "z_mm"}.at(k)), finding.at("place_mm").at(k));
    }
    EXPECT_GT(extras.at("amount_mm").get<double>(), 0.0009);
  }
}

TEST_F(GougedPage, EveryEncodingIsRightForTheValidator) {
  std::string files = (folder_ / "run/part.glb").string() + " " + (folder_ / "run/machine.glb").string();
  size_t before = fs::file_size(folder_ / "run/part.glb") + 1;
  for (const std::string encoding : {"float", "quantized", "meshopt"}) {
    const fs::path part = folder_ / ("part_" + encoding + ".glb"),
                   machine = folder_ / ("machine_" + encoding + ".glb");
    const auto run = run_swarf("export " + run_folder() + " --gltf " + part.string() + " --machine-gltf " +
                               machine.string() + " --encoding " + encoding);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_LT(fs::file_size(part), before) << encoding << " is smaller than the one before";
    before = fs::file_size(part);
    files += " " + part.string() + " " + machine.string();
  }
  const auto valid = run_command(SWARF_SOURCE_DIR "/tests/gltf/validate.sh " + files);
  EXPECT_EQ(valid.exit_code, 0) << valid.output;
  const auto unknown = run_swarf("export " + run_folder() + " --gltf x.glb --encoding draco");
  EXPECT_EQ(unknown.exit_code, 2) << unknown.output;
}

TEST_F(GougedPage, StockIsCutInStagesAndAxesAreAChain) {
  const Glb glb = read_glb(folder_ / "run/machine.glb");
  size_t stages = 0, axes = 0;
  for (const json& node : glb.model.at("nodes")) {
    if (node.at("name").get<std::string>().starts_with("stock ")) ++stages;
    if (node.contains("extras") && node.at("extras").value("role", "") == "axis") {
      ++axes;
      EXPECT_TRUE(node.contains("children")) << "what it moves hangs on it";
    }
  }
  EXPECT_EQ(stages, 9U);
  EXPECT_GE(axes, 3U);
  EXPECT_EQ(glb.model.at("animations").at(0).at("name"), "exact_gouges");
  for (const json& material : glb.model.at("materials")) EXPECT_TRUE(material.contains("name"));
}

/// As many triangles as the STL has, all of them in millimetres; the reader's side is held by unit_mesh.
TEST_F(GougedPage, ObjIsThePart) {
  const fs::path obj = folder_ / "part.obj", stl = folder_ / "part.stl";
  const auto run = run_swarf("export " + run_folder() + " --obj " + obj.string() + " --stl " + stl.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const std::string text = read_text(obj), bytes = read_text(stl);
  uint32_t triangles = 0;
  std::memcpy(&triangles, bytes.data() + 80, sizeof triangles);
  size_t faces = 0;
  for (size_t at = text.find("\nf "); at != std::string::npos; at = text.find("\nf ", at + 1)) ++faces;
  EXPECT_EQ(faces, triangles);
  EXPECT_TRUE(text.starts_with("# millimetres\nv "));
}

/// The labels stand on the picture that there is without them.
TEST_F(GougedPage, AStillHasAScaleBarAndLeadersWhereTheyAreAskedFor) {
  const std::string plain = (folder_ / "plain.png").string(), labelled = (folder_ / "labelled.png").string();
  const std::string render =
      "render " + run_folder() + " --kind deviation --size 480 270 --samples 1 --still ";
  ASSERT_EQ(run_swarf(render + plain).exit_code, 0);
  const auto run = run_swarf(render + labelled + " --labels");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const swarf::render::Image before = swarf::render::load_png(plain),
                             after = swarf::render::load_png(labelled);
  size_t changed = 0, corner = 0;
  for (int y = 0; y < 270; ++y)
    for (int x = 0; x < 480; ++x) {
      const size_t at = size_t{4} * (480 * y + x);
      if (std::equal(&before.rgba[at], &before.rgba[at + 4], &after.rgba[at])) continue;
      ++changed;
      if (x < 180 && y > 220) ++corner;
    }
  EXPECT_GT(corner, 300U) << "the scale bar";
  EXPECT_GT(changed - corner, 2000U) << "two plates with their lines";
  EXPECT_LT(changed, 480U * 270U / 5) << "nothing else";
}

/// They are what `render --labels` draws of the same run, and not what it draws without.
TEST_F(GougedPage, TheRunsOwnStillsAreLabelled) {
  const fs::path job = folder_ / "stills";
  const std::string look = "'stills.size=[480,270]' --set stills.samples=1";
  const auto run = run_swarf("run " SWARF_SOURCE_DIR
                             "/scenes/exact_gouges/scene.toml --set movie.seconds=0 --set "
                             "'stills.kinds=[\"part\",\"deviation\"]' --set " +
                             look + " -o " + job.string());
  ASSERT_EQ(run.exit_code, 1) << run.output;
  for (const std::string kind : {"part", "deviation"}) {
    const std::string file = (folder_ / "again.png").string();
    const std::string render = "render " + job.string() + " --kind " + kind + " --still " + file;
    const std::string own = read_text(job / ("still_" + kind + ".png"));
    ASSERT_EQ(run_swarf(render + " --labels").exit_code, 0);
    EXPECT_EQ(own, read_text(file)) << kind;
    ASSERT_EQ(run_swarf(render).exit_code, 0);
    EXPECT_NE(own, read_text(file)) << kind;
  }
}

/// Of the vertices of a PLY file as Swarf writes it, whose last property is the deviation: each as its own
/// ray has measured it, with nothing added or lowered.
float highest_vertex(const fs::path& ply) {
  const std::string bytes = read_text(ply), end = "end_header\n";
  const size_t count = std::stoul(bytes.substr(bytes.find("element vertex ") + 15, 12));
  const size_t begin = bytes.find(end) + end.size();
  const std::string header = bytes.substr(0, bytes.find("element face"));
  EXPECT_TRUE(header.ends_with("property float deviation_um\n")) << header;
  size_t stride = 0;
  for (size_t at = header.find("property "); at != std::string::npos; at = header.find("property ", at + 1))
    stride += header.compare(at + 9, 5, "float") == 0 ? 4 : 1;
  float highest = -std::numeric_limits<float>::infinity();
  for (size_t i = 1; i <= count; ++i) {
    float value = 0.0F;
    std::memcpy(&value, bytes.data() + begin + i * stride - sizeof value, sizeof value);
    highest = std::max(highest, value);  // NaN, not measured, stays out
  }
  return highest;
}

const std::string kQuick = " --set movie.seconds=0 --set \"stills.kinds=[]\" ";

class Colours : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder(std::string("colours_") +
                                        ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string out() const { return (folder_ / "run").string(); }
  void run(const std::string& scene, const std::string& more) {
    const auto run = run_swarf("run " + scene + kQuick + more + " -o " + out());
    ASSERT_LE(run.exit_code, 1) << run.output;
    surface_ = json::parse(read_text(out() + "/metrics.json")).at("surface");
  }
  double um(const char* name) const { return surface_.at(name).get<double>(); }
  /// Of the run's own file, and of one that is made from its folder.
  void expect_range() {
    const auto exported = run_swarf("export " + out() + " --gltf " + (folder_ / "again.glb").string() +
                                    " --ply " + (folder_ / "again.ply").string());
    ASSERT_EQ(exported.exit_code, 0) << exported.output;
    EXPECT_LE(highest_vertex(folder_ / "again.ply"), um("excess_max_um") + kReadLimitUm)
        << "nothing is measured higher than what is told";
    for (const fs::path& file : {fs::path(out()) / "part.glb", folder_ / "again.glb"}) {
      const auto [low, high] = range_of(read_glb(file), "_DEVIATION_UM");
      EXPECT_NEAR(std::min(low, 0.0F), -um("gouge_max_um"), kReadLimitUm) << file;
      EXPECT_NEAR(high, um("excess_max_um"), kReadLimitUm) << file;
    }
  }
  fs::path folder_;
  json surface_;
};

/// Curved faces whose facets are up to 20 um off, cut and measured more coarsely than the scene is.
TEST_F(Colours, OfTrimmedFacesAreThoseOfTheirRays) {
  const std::string place = SWARF_SOURCE_DIR "/scenes/kato_mould/";
  std::string scene = read_text(place + "scene.toml");
  const auto change = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(scene.find(from), std::string::npos) << from;
    scene.replace(scene.find(from), from.size(), to);
  };
  change("compare_cam_um", "# compare_cam_um");
  change("interval_mm = 2", "interval_mm = 3");
  change("gouge_max_um", "# gouge_max_um");
  change("pitch_mm = 0.3", "pitch_mm = 0.8");
  change("voxel_mm = 0.2", "voxel_mm = 0.4");
  fs::copy_file(place + "mould.stp", folder_ / "mould.stp");
  swarf::test::write_text(folder_ / "scene.toml", scene);
  run((folder_ / "scene.toml").string(), "");
  EXPECT_LT(um("gouge_max_um"), 0.2);
  EXPECT_GT(um("excess_max_um"), 1000.0);
  expect_range();
}

TEST_F(Colours, OfAMeshAreThoseOfItsRays) {
  run(SWARF_SOURCE_DIR "/scenes/exact_scallop_mesh/scene.toml", swarf::test::kSoonProven);
  expect_range();
}

/// Rows along Y at x and z of a flat end of 8 mm, flutes as long as is said.
struct Row {
  double x, z;
};
std::string milled_scene(const fs::path& folder, const std::vector<Row>& rows, double flute_mm,
                         const std::string& box, const std::string& design) {
  std::string cl =
      "PARTNO/ROWS\nUNITS/MM\nLOADTL/1\nCUTTER/8,0\nMULTAX/ON\nSPINDL/8000,CLW\n"
      "FROM/-30.0,-12.0,30.0,0.0,0.0,1.0\nFEDRAT/3000,MMPM\n";
  for (const Row& row : rows) {
    cl += fmt::format(
        "RAPID\nGOTO/{0:.1f},-12.0,30.0,0.0,0.0,1.0\nRAPID\nGOTO/{0:.1f},-12.0,{1:.1f},0.0,0.0,1.0\n"
        "GOTO/{0:.1f},12.0,{1:.1f},0.0,0.0,1.0\nRAPID\nGOTO/{0:.1f},12.0,30.0,0.0,0.0,1.0\n",
        row.x, row.z);
  }
  swarf::test::write_text(folder / "path.cl", cl + "FINI\n");
  swarf::test::write_text(folder / "scene.toml", R"(
machine = ")" SWARF_SOURCE_DIR R"(/assets/machines/lin_koren_xyzab/machine.toml"
cl = "path.cl"
[cutter]
number = 1
diameter_mm = 8
corner_radius_mm = 0
shank_diameter_mm = 4
length_mm = 60
flute_length_mm = )" + fmt::format("{}\n[stock]\nbox_mm = {}", flute_mm, box) +
                                                     R"(
voxel_mm = 0.25
[interpolator]
mode = "tcp"
[design]
pitch_mm = 0.4
)" + design);
  return (folder / "scene.toml").string();
}

/// A block 3 mm higher than its design is faced down to it, but for a slab between 1 and 3 mm that the flutes
/// of a T-slot cutter have passed under from the right, and a neck of 2 mm that holds it.
std::string overhung_scene(const fs::path& folder, const std::string& design) {
  std::vector<Row> rows{{12.5, 0.0}};
  for (const double z : {2.0, 1.0, 0.0})
    for (double x = -8.0; x <= 4.0; x += 4.0) rows.push_back({x, z});
  rows.push_back({4.5, 2.0});
  return milled_scene(folder, rows, 1.0, "[[-10, -5, -5], [10, 5, 3]]", design);
}

constexpr const char* kPlaneUnderTheSlab = R"(kind = "plane"
origin_mm = [-9.9, -4.8, 0]
along_u_mm = [19.8, 0, 0]
along_v_mm = [0, 9.6, 0]
)";

TEST_F(Colours, AboveAGapOfAPlaneAreThoseOfItsRays) {
  run(overhung_scene(folder_, kPlaneUnderTheSlab), "");
  EXPECT_GT(um("overhung_samples"), 0.0);
  EXPECT_NEAR(um("excess_max_um"), 3000.0, kReadLimitUm);
  expect_range();
}

// Pictures look at the part, they do not measure it: what is told is the same without them.
TEST_F(Colours, ChangeNothingThatIsTold) {
  const std::string scene = overhung_scene(folder_, kPlaneUnderTheSlab);
  run(scene, "");
  const json with_page = json::parse(read_text(out() + "/metrics.json"));
  run(scene, " --no-render");
  const json alone = json::parse(read_text(out() + "/metrics.json"));
  for (const char* const part : {"surface", "highest_material", "checks", "gouges", "excesses"})
    EXPECT_EQ(with_page.at(part), alone.at(part)) << part;
}

/// A closed outline in x and z, 10 mm long.
void save_bar(const fs::path& file, const std::vector<swarf::Vec2>& outline) {
  swarf::TriMesh bar;
  ASSERT_TRUE(swarf::mesh::add_prism(bar, outline, -5, 5));
  for (auto& p : bar.positions) p = {p[0], -p[2], p[1]};
  swarf::mesh::save_mesh(file.string(), bar);
}

// What is left in an inner corner, 3 mm wide and 4 high, belongs to the wall as much as to the floor: what
// counts over the floor ends 3 mm above it. The place that is told lies on the part's surface.
TEST_F(Colours, WhereAnotherFaceEndsTheMaterialAreThoseOfThePart) {
  save_bar(folder_ / "step.stl", {{-5, -5}, {10, -5}, {10, 0}, {0, 0}, {0, 5}, {-5, 5}});
  run(milled_scene(folder_, {{4.0, 4.0}, {7.0, 0.0}}, 20.0, "[[-5, -5, -5], [10, 5, 5]]",
                   "kind = \"mesh\"\nmesh = \"step.stl\"\n"),
      "");
  const json highest = json::parse(read_text(out() + "/metrics.json")).at("highest_material");
  const double x = highest.at("x_mm"), z = highest.at("z_mm");
  EXPECT_NEAR(um("excess_max_um"), 3000.0, 1.0);
  EXPECT_NEAR(x, 3.0, 1e-3) << z;
  EXPECT_GE(z, 3.0 - 1e-3);
  EXPECT_LE(z, 4.0 + 1e-3);
  expect_range();
}

// An undercut that nobody has milled, beside a slot of 8 mm: half way between its floor and its roof nothing
// is higher, and that ray goes on into the roof. The material around it ends at the slot, or at the bar's
// ends.
TEST_F(Colours, InAnUndercutThatIsFullAreThoseOfItsMouth) {
  save_bar(folder_ / "slot.stl", {{-9, -6},
                                  {9, -6},
                                  {9, 0},
                                  {4, 0},
                                  {4, -2},
                                  {7, -2},
                                  {7, -3},
                                  {-7, -3},
                                  {-7, -2},
                                  {-4, -2},
                                  {-4, 0},
                                  {-9, 0}});
  run(milled_scene(folder_, {{0.0, -3.0}}, 20.0, "[[-9, -5, -6], [9, 5, 0]]",
                   "kind = \"mesh\"\nmesh = \"slot.stl\"\n"),
      "");
  const json highest = json::parse(read_text(out() + "/metrics.json")).at("highest_material");
  const double x = highest.at("x_mm"), y = highest.at("y_mm"), z = highest.at("z_mm");
  EXPECT_NEAR(um("excess_max_um"), 500.0, 30.0);
  EXPECT_LT(std::min(std::abs(x) - 4.0, 5.0 - std::abs(y)), 1e-5) << x << ' ' << y << ' ' << z;
  EXPECT_GT(std::abs(x), 4.0 - 1e-5);
  EXPECT_NEAR(z, -2.5, 0.5);
  expect_range();
}

TEST_F(Colours, AboveAGapOfAMeshAreThoseOfItsRays) {
  swarf::TriMesh block;
  swarf::mesh::add_box(block, {{-10, -5, -5}, {10, 5, 0}});
  swarf::mesh::save_mesh((folder_ / "block.stl").string(), block);
  run(overhung_scene(folder_, "kind = \"mesh\"\nmesh = \"block.stl\"\n"), "");
  EXPECT_GT(um("overhung_samples"), 0.0);
  EXPECT_NEAR(um("excess_max_um"), 3000.0, kReadLimitUm);
  expect_range();
}

/// The proof draws no region of what breaks a limit by less than it resolves.
TEST(Overhung, ALimitJustBelowTheHighestHasItsFinding) {
  const fs::path folder = swarf::test::fresh_folder("just_below");
  const auto run = run_swarf("run " + overhung_scene(folder, kPlaneUnderTheSlab) + " --no-render -o " +
                             (folder / "run").string() + " --set accept.excess_max_um=2999.9");
  EXPECT_EQ(run.exit_code, 1) << run.output;
  const json findings = json::parse(read_text(folder / "run/findings.json"));
  const auto excess = std::count_if(findings.begin(), findings.end(),
                                    [](const json& finding) { return finding.at("code") == "excess"; });
  EXPECT_EQ(excess, 1) << run.output;
  EXPECT_NE(run.output.find("material stands above the design, 3000.000 um about"), std::string::npos)
      << run.output;
  fs::remove_all(folder);
}

/// Pages whose findings are of different kinds.
class PagesWithFindings {
 public:
  explicit PagesWithFindings(fs::path folder) : folder_(std::move(folder)) {}

  /// The spindle stands while the tool cuts.
  std::string spindle() const {
    return page_of("spindle", written("spindle", R"(G21 G90
T1 M6 G43 H1
S5000 M3
G0 X-15 Y0 Z20
Z-2
G1 X0 F1000
M5
X15
G0 Z20
M2
)",
                                      R"(tools = "T1=6"
setup.work_origin_mm = "on_table"
stock.box_mm = [[-10, -8, -10], [10, 8, 0]]
stock.voxel_mm = 0.5
)"));
  }
  /// A second tool goes down in rapid.
  std::string rapid() const {
    return page_of("rapid", written("rapid", R"(G21 G90
T1 M6 G43 H1
S9000 M3
G0 X5 Y5 Z2
G1 Z-3 F600
X15
G0 Z20
T2 M6 G43 H2
S3000 M3
G0 X25 Y10
Z2
G0 Z-2
Z20
M2
)",
                                    R"(tools = "T1=6,T2=4"
setup.work_origin_mm = "on_table"
stock.box_mm = [[0, 0, -12], [40, 30, 0]]
stock.voxel_mm = 0.8
)"));
  }
  /// A clamp stands in the tool's way: found in the machine.
  std::string clamps() const {
    return page_of("clamps", written("clamps", R"(G21 G90 G17 G54
T1 M6 G43 H1
S5000 M3
G0 X0 Y0 Z50
G1 Z-2 F3000
X60
Y40
G0 Z50
M2
)",
                                     R"(dialect = "fanuc"
machine = "spinner_u5_620"
setup.work_origin_mm = "on_table"
stock.box_mm = [[-10, -10, -20], [70, 50, 0]]
stock.voxel_mm = 2
[[tool]]
number = 1
diameter_mm = 6
flute_length_mm = 30
length_mm = 60
holder_diameter_mm = 8
[[fixture]]
kind = "clamps"
sides = ["x-", "x+"]
)"));
  }
  /// The shank cuts, for the flutes are short.
  std::string shank() const {
    return page_of("shank", written("shank", R"(G21 G90
T1 M6 G43 H1
S5000 M3
G0 X-15 Y0 Z20
Z-6
G1 X15 F1000
G0 Z20
M2
)",
                                    R"(setup.work_origin_mm = "on_table"
stock.box_mm = [[-10, -8, -10], [10, 8, 0]]
stock.voxel_mm = 0.5
[[tool]]
number = 1
diameter_mm = 6
flute_length_mm = 4
shank_diameter_mm = 6
length_mm = 50
)"));
  }
  /// A mesh in a block that stands over it all round, highest over its corners, where no measuring ray looks;
  /// and cut too deep.
  std::string corners() const {
    swarf::TriMesh block;
    swarf::mesh::add_box(block, {{-8, -5, -3}, {8, 5, 0}});
    swarf::mesh::save_mesh((folder_ / "block.stl").string(), block);
    return page_of("corners", written("corners", R"(G21 G90
T1 M6 G43 H1
S5000 M3
G0 X-20 Y0 Z5
Z-0.02
G1 X20 F1000
G0 Z5
M2
)",
                                      R"(tools = "T1=4"
setup.work_origin_mm = "on_table"
stock.box_mm = [[-8.3, -5.3, -3.3], [8.3, 5.3, 0.3]]
stock.voxel_mm = 0.4
accept.gouge_max_um = 5
[design]
kind = "mesh"
mesh = "../block.stl"
pitch_mm = 1
)"));
  }

 private:
  /// The page of a run with a small movie, which ends with findings.
  std::string page_of(const std::string& name, const std::string& scene) const {
    const fs::path out = folder_ / name;
    const auto run = run_swarf("run " + scene +
                               " --set movie.seconds=1 --set 'movie.size=[128,72]' --set movie.fps=10 --set "
                               "movie.voxel_mm=1 --set 'stills.kinds=[]' -q -o " +
                               out.string());
    EXPECT_EQ(run.exit_code, 1) << name << "\n" << run.output;
    return (out / "report.html").string();
  }
  /// A scene in a folder of its own.
  std::string written(const std::string& name, const std::string& program, const std::string& scene) const {
    const fs::path folder = folder_ / (name + "_scene");
    fs::create_directories(folder);
    swarf::test::write_text(folder / "part.nc", program);
    swarf::test::write_text(folder / "scene.toml", "nc = \"part.nc\"\n" + scene);
    return (folder / "scene.toml").string();
  }

  const fs::path folder_;
};

/// In one Chromium, at both widths.
TEST_F(GougedPage, AndOthersLeadFromAFindingToItsPlaceLineAndMovie) {
  const PagesWithFindings more(folder_);
  std::string pages = run_folder() + "/report.html";
  for (const std::string& page : {more.spindle(), more.rapid(), more.clamps(), more.shank(), more.corners()})
    pages += " " + page;
  const auto page = run_command(SWARF_SOURCE_DIR "/tests/page/page.sh --leading " + pages);
  if (page.exit_code == kNoChromium) GTEST_SKIP() << page.output;
  EXPECT_EQ(page.exit_code, 0) << page.output;
  const json surface = json::parse(read_text(folder_ / "corners/metrics.json")).at("surface");
  EXPECT_NEAR(surface.at("excess_max_um").get<double>(), 300.0 * std::sqrt(3.0), 30.0)
      << "the corner of the block, as near as the vertices of its mesh are";
}

}  // namespace
}  // namespace page_test

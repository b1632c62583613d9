// machine.toml: what is read from a right file, and one diagnostic in its place for every wrong one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/units.h"
#include "machine/machine_scene.h"
#include "mesh/mesh_io.h"
#include "support/scratch.h"

namespace swarf::machine {
namespace {

namespace fs = std::filesystem;

const std::string kData = SWARF_SOURCE_DIR "/tests/data/machines/";
const std::string kPaperMachine = SWARF_SOURCE_DIR "/assets/machines/lin_koren_xyzab/machine.toml";

std::vector<std::string> bad_files() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kData + "bad")) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The diagnostics of a file; empty when it loads.
std::vector<Diagnostic> complaints(const std::string& path) {
  try {
    load_machine(path);
  } catch (const InputError& error) {
    return error.diagnostics.list();
  }
  return {};
}

class BadMachine : public testing::TestWithParam<std::string> {};

/// The leading lines "# expect: <code> <line>:<column>" of a file, without the first two words.
std::vector<std::string> expected_of(const std::string& path) {
  const std::string prefix = "# expect: ";
  std::ifstream file(path);
  std::vector<std::string> list;
  for (std::string line; std::getline(file, line) && line.rfind(prefix, 0) == 0;) {
    list.push_back(line.substr(prefix.size()));
  }
  return list;
}

TEST_P(BadMachine, HasExactlyTheDiagnosticsOfItsFirstLines) {
  const std::string path = kData + "bad/" + GetParam() + ".toml";
  std::vector<std::string> found;
  for (const Diagnostic& one : complaints(path)) {
    found.push_back(one.code + ' ' + std::to_string(one.where.line) + ':' + std::to_string(one.where.column));
    EXPECT_EQ(one.where.file, path);
    EXPECT_FALSE(one.fix.empty()) << format(one);
  }
  EXPECT_FALSE(found.empty());
  EXPECT_EQ(found, expected_of(path));
}

INSTANTIATE_TEST_SUITE_P(Files, BadMachine, testing::ValuesIn(bad_files()),
                         [](const auto& instance) { return instance.param; });

TEST(BadMachineText, NamesTheLoopTheFixAndTheMesh) {
  EXPECT_NE(complaints(kData + "bad/cycle.toml")[0].text.find("x_slide -> table -> cradle -> x_slide"),
            std::string::npos);
  EXPECT_EQ(complaints(kData + "bad/unknown_parent.toml")[0].fix, "did you mean 'x_slide'?");
  EXPECT_EQ(complaints(kData + "bad/unknown_key.toml")[0].fix, "did you mean 'jerk_max_mm_s3'?");
  EXPECT_NE(complaints(kData + "bad/mesh_missing.toml")[0].text.find("no_such.ply"), std::string::npos);
  EXPECT_NE(complaints(kData + "bad/direction_not_unit.toml")[0].text.find("1.41421356"), std::string::npos);
}

/// Writes `bytes` to a file of this test and returns its name.
std::string file_with(const std::string& bytes) {
  const std::string path =
      (test::scratch_folder() / ("swarf_machine_" + std::to_string(std::hash<std::string>{}(bytes))))
          .string();
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

TEST(BadMachineFile, MissingEmptyAndBinary) {
  EXPECT_EQ(complaints(kData + "no_such.toml").at(0).code, "file-not-found");
  EXPECT_EQ(complaints(file_with("")).at(0).code, "empty-file");
  EXPECT_EQ(complaints(file_with(" \n\t\n")).at(0).code, "empty-file");
  EXPECT_EQ(complaints(file_with(std::string("name = \"x\"\n\0\x01", 13))).at(0).code, "not-text");
  EXPECT_EQ(complaints(file_with("name = \"\xff\xfe\"\n")).at(0).code, "toml-syntax");
  EXPECT_EQ(complaints(file_with("max = 1e400\n")).empty(), false);
}

TEST(BadMachineFile, EveryTruncationIsReportedOrLoads) {
  std::ifstream in(kData + "small.toml");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  for (size_t length = 0; length + 120 < text.size(); length += 7) {
    const std::string path = file_with(text.substr(0, length));
    EXPECT_FALSE(complaints(path).empty()) << length;
    fs::remove(path);
  }
}

TEST(SmallMachine, IsReadWithItsChainsAndMeshes) {
  const MachineScene scene = load_machine(kData + "small.toml");
  EXPECT_EQ(scene.model.name, "small five-axis machine");
  EXPECT_EQ(scene.model.table_chain, (std::vector<int>{0, 3, 4}));
  EXPECT_EQ(scene.model.head_chain, (std::vector<int>{1, 2}));
  EXPECT_EQ(scene.links[static_cast<size_t>(scene.work_link)].name, "table");
  EXPECT_EQ(scene.links[static_cast<size_t>(scene.tool_link)].name, "head");
  EXPECT_EQ(scene.model.axes[3].side, kinematics::Side::kTable);
  EXPECT_EQ(scene.model.axes[1].side, kinematics::Side::kHead);
  EXPECT_TRUE(scene.model.axes[3].reversed);
  EXPECT_DOUBLE_EQ(scene.model.axes[0].speed_max, 250.0);
  EXPECT_DOUBLE_EQ(scene.model.axes[3].speed_max, kPi / 3.0);
  EXPECT_DOUBLE_EQ(scene.model.axes[1].home, 250.0);
  EXPECT_DOUBLE_EQ(scene.model.axes[4].max, 2.0 * kPi);
  for (const int link : {scene.work_link, scene.tool_link}) {
    const TriMesh& mesh = scene.links[static_cast<size_t>(link)].mesh;
    EXPECT_EQ(mesh.positions.size(), 4U);
    EXPECT_EQ(mesh.triangles.size(), 4U);
    EXPECT_EQ(mesh::check_closed(mesh), "");
  }
}

TEST(PaperMachine, HasThePapersKinematics) {
  const MachineScene scene = load_machine(kPaperMachine);
  const kinematics::MachineModel& machine = scene.model;
  ASSERT_EQ(machine.axes.size(), 5U);
  const kinematics::InverseKinematics inverse(machine);
  const kinematics::Branch branch = inverse.solve_nearest(
      {{10.0, 20.0, 30.0}, Vec3(0.2, 0.3, 0.9).normalized()}, kinematics::AxisValues::Zero());
  EXPECT_EQ(branch.outcome, kinematics::InverseOutcome::kOk);
  const double printed[] = {3.8829014, 58.0481602, 184.8443972, 21.83186897, 33.69006753};
  const char* names[] = {"X", "Y", "Z", "A", "B"};
  for (int i = 0; i < 5; ++i) {
    const kinematics::Axis& axis = machine.axes[static_cast<size_t>(i)];
    EXPECT_EQ(axis.name, names[i]);
    const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
    EXPECT_NEAR(rotary ? deg_from_rad(branch.q[i]) : branch.q[i], printed[i], rotary ? 5e-9 : 5e-8);
  }
}

/// The whole DOME job (theory 1.6) with the tool along the normal, and the way home.
TEST(PaperMachine, ReachesTheDomeInsideItsTravel) {
  const kinematics::MachineModel machine = load_machine(kPaperMachine).model;
  const kinematics::InverseKinematics inverse(machine);
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  for (int row = 0; row <= 80; ++row) {
    for (int column = 0; column <= 80; ++column) {
      const double u = column / 80.0, v = row / 80.0;
      const Vec3 point(100 * u - 50, 80 * v - 40, 80 * u - 80 * u * u + 60 * v - 60 * v * v);
      const Vec3 normal = Vec3(100, 0, 80 - 160 * u).cross(Vec3(0, 80, 60 - 120 * v)).normalized();
      for (const double clearance : {0.0, 60.0}) {
        const kinematics::Branch branch = inverse.solve_nearest({point + clearance * normal, normal}, q);
        ASSERT_TRUE(branch.outcome == kinematics::InverseOutcome::kOk ||
                    branch.outcome == kinematics::InverseOutcome::kSingular)
            << "u " << u << " v " << v << " axis " << branch.out_of_travel_axis;
        q = branch.q;
      }
    }
  }
}

TEST(LinkPoses, CarryTheToolAndTheWorkAsForwardKinematicsSays) {
  const MachineScene scene = load_machine(kData + "small.toml");
  for (const Pose& pose : link_poses(scene, kinematics::AxisValues::Zero())) {
    EXPECT_TRUE(pose.isApprox(Pose::Identity(), 1e-15));
  }
  kinematics::AxisValues q;
  q << 10.0, -20.0, 30.0, 0.4, -1.1;
  const std::vector<Pose> poses = link_poses(scene, q);
  const Pose X_WM = (poses[static_cast<size_t>(scene.work_link)] * scene.model.X_MW).inverse();
  const Pose& head = poses[static_cast<size_t>(scene.tool_link)];
  const ToolPose tool = kinematics::forward(scene.model, q);
  EXPECT_LT((X_WM * (head * scene.model.tip_M) - tool.tip_W).norm(), 1e-12);
  EXPECT_LT((X_WM.linear() * head.linear() * scene.model.tool_axis_M - tool.axis_W).norm(), 1e-15);
  EXPECT_TRUE(poses[0].isApprox(Pose::Identity(), 0.0)) << "the bed stands";
}

}  // namespace
}  // namespace swarf::machine

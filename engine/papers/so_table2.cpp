#include "papers/so_table2.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "kinematics/singularity_model.h"

namespace swarf::papers {
namespace {

using kinematics::AxisValues;
using kinematics::BlockEnds;
using kinematics::MachineModel;
using motion::BlockSingularity;
using motion::SingularityScan;

// What the paper prints, and nothing else.
struct PrintedPoint {
  const char* name;
  std::array<double, 6> cl;  ///< x, y, z (mm), i, j, k
  std::array<double, 5> nc;  ///< X, Y, Z (mm), A, C (deg)
};
constexpr PrintedPoint kPrinted[2] = {{"P0",
                                       {75.2110, -51.4295, 228.6808, 0.0095944, 0.0159479, 0.9998268},
                                       {-90.9595, 7.3103, 227.6341, 1.0664, 148.9685}},
                                      {"P1",
                                       {74.5130, -50.5510, 228.6857, 0.0175393, 0.0107682, 0.9997882},
                                       {-82.0656, -34.8175, 228.3975, 1.1793, 121.5477}}};
constexpr double kPrintedU = 0.4101;
constexpr const char* kAxisNames = "XYZAC";

/// Printed and programmed positions are the same, mm and 1.
constexpr double kSame = 1e-9;

bool is_point(const ToolPose& pose, const PrintedPoint& printed) {
  const Vec3 tip(printed.cl[0], printed.cl[1], printed.cl[2]);
  const Vec3 axis = Vec3(printed.cl[3], printed.cl[4], printed.cl[5]).normalized();
  return (pose.tip_W - tip).norm() < kSame && (pose.axis_W - axis).norm() < kSame;
}

/// Index of the axis with this letter; -1: none.
int axis_of(const MachineModel& machine, char letter) {
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    if (machine.axes[i].name == std::string(1, letter)) return static_cast<int>(i);
  }
  return -1;
}

bool has_paper_axes(const MachineModel& machine) {
  return std::all_of(kAxisNames, kAxisNames + 5, [&](char letter) { return axis_of(machine, letter) >= 0; });
}

const BlockSingularity* so_block(const SingularityScan& scan) {
  for (const BlockSingularity& block : scan.worst) {
    if (is_point(block.ends.from, kPrinted[0]) && is_point(block.ends.to, kPrinted[1])) return &block;
  }
  return nullptr;
}

AxisValues printed_values(const MachineModel& machine, const PrintedPoint& printed) {
  AxisValues q = AxisValues::Zero();
  for (int i = 0; i < 5; ++i) {
    const double value = printed.nc[static_cast<size_t>(i)];
    q[axis_of(machine, kAxisNames[i])] = i < 3 ? value : rad_from_deg(value);
  }
  return q;
}

double shown(const AxisValues& q, const MachineModel& machine, int i) {
  const double value = q[axis_of(machine, kAxisNames[i])];
  return i < 3 ? value : deg_from_rad(value);
}

std::string number(double value) {
  return fmt::format("{:.6f}", value);
}

class Rows {
 public:
  Rows(const MachineModel& machine, const BlockSingularity& block)
      : machine_(machine), block_(block), ends_(block.ends), model_(machine, block.ends) {}

  std::vector<PaperRow> all() {
    for (const int end : {0, 1}) forward_and_inverse(end);
    second_branch();
    trajectory_points();
    deviations();
    beyond_the_paper();
    model_letters();
    return std::move(rows_);
  }

 private:
  void add(PaperRow row) { rows_.push_back(std::move(row)); }

  BlockEnds printed_ends() const {
    BlockEnds ends;
    ends.q_from = printed_values(machine_, kPrinted[0]);
    ends.q_to = printed_values(machine_, kPrinted[1]);
    ends.from = kinematics::forward(machine_, ends.q_from);
    ends.to = kinematics::forward(machine_, ends.q_to);
    return ends;
  }

  void forward_and_inverse(int end) {
    const PrintedPoint& printed = kPrinted[end];
    const ToolPose back = kinematics::forward(machine_, printed_values(machine_, printed));
    const std::array<double, 6> ours{back.tip_W.x(),  back.tip_W.y(),  back.tip_W.z(),
                                     back.axis_W.x(), back.axis_W.y(), back.axis_W.z()};
    for (size_t i = 0; i < 6; ++i) {
      add({fmt::format("{}: forward of the NC data, {}", printed.name, "xyzijk"[i]), "Table 2",
           fmt::format("{:.{}f}", printed.cl[i], i < 3 ? 4 : 7),
           fmt::format("{:.{}f}", ours[i], i < 3 ? 6 : 7), i < 3 ? "mm" : "", "",
           "the printed NC data have four digits"});
    }
    const AxisValues& q = end == 0 ? ends_.q_from : ends_.q_to;
    for (int i = 0; i < 5; ++i) {
      const double value = shown(q, machine_, i), paper = printed.nc[static_cast<size_t>(i)];
      add({fmt::format("{}: inverse, {}", printed.name, kAxisNames[i]), "Table 2",
           fmt::format("{:.4f}", paper), number(value), i < 3 ? "mm" : "deg", "",
           fmt::format("they differ by {:.1e} {}: rounding of the printed data", value - paper,
                       i < 3 ? "mm" : "deg")});
    }
  }

  void second_branch() {
    for (const kinematics::BranchChoice& choice :
         kinematics::branch_choices(machine_, kinematics::InverseKinematics(machine_), ends_)) {
      if (!choice.other_from) continue;
      for (int i = 0; i < 5; ++i) {
        add({fmt::format("P0: second branch, {}", kAxisNames[i]), "Table 2", "–",
             number(shown(choice.q_from, machine_, i)), i < 3 ? "mm" : "deg", "",
             "not in the paper: (-A, C - 180 deg)"});
      }
      return;
    }
  }

  void trajectory_points() {
    for (const double u : {0.25, 0.5, 0.75}) {
      const AxisValues q = ends_.q_from + u * (ends_.q_to - ends_.q_from);
      const Vec3 tip = kinematics::forward(machine_, q).tip_W;
      for (int i = 0; i < 3; ++i) {
        add({fmt::format("Trajectory point, {}({:g})", "xyz"[i], u), "Fig. 9", "–", number(tip[i]), "mm", "",
             "the paper draws it"});
      }
    }
  }

  static double line_distance(const BlockEnds& ends, const Vec3& p) {
    const Vec3 d = (ends.to.tip_W - ends.from.tip_W).normalized(), g = p - ends.from.tip_W;
    return (g - g.dot(d) * d).norm();
  }

  void deviations() {
    const auto tip = [&](const BlockEnds& ends, double u) {
      return kinematics::forward(machine_, ends.q_from + u * (ends.q_to - ends.q_from)).tip_W;
    };
    const BlockEnds printed = printed_ends();
    const kinematics::TrajectoryError rounded = kinematics::trajectory_error(machine_, printed);
    BlockEnds printed_c = ends_;
    const int c = axis_of(machine_, 'C');
    printed_c.q_from[c] = printed.q_from[c];
    printed_c.q_to[c] = printed.q_to[c];
    const kinematics::Peak analytic_c =
        kinematics::SingularityModel(machine_, printed_c).greatest_deviation();
    const kinematics::Peak& line = block_.error.line;
    add({"Deviation from the line at u = .4101, printed NC data", "section 5", "0.9383",
         number(line_distance(printed, tip(printed, kPrintedU))), "mm", "", ""});
    add({"Deviation from the line at u = .4101, exact axis values", "section 5", "0.9383",
         number(line_distance(ends_, tip(ends_, kPrintedU))), "mm", "", "the NC data are rounded"});
    add({"Analytic deviation at u = .4101, Eq. (3), (6)", "section 5", "0.9382",
         number(model_.deviation(kPrintedU)), "mm", "E10–E12",
         "signs and letters of Eq. (3), P - P0 in Eq. (6)"});
    add({"Greatest deviation from the line", "section 5", "0.9383 at u = 0.4101",
         fmt::format("{:.6f} at u = {:.6f}", line.value, line.u), "mm", "E14",
         "the maximum is not at .4101"});
    add({"Greatest deviation from the line, printed NC data", "section 5", "0.9383 at u = 0.4101",
         fmt::format("{:.6f} at u = {:.6f}", rounded.line.value, rounded.line.u), "mm", "E14",
         "with the NC data rounded to four digits"});
    add({"Greatest analytic deviation, Eq. (8)", "section 5, Table 1", "0.9382",
         fmt::format("{:.6f} at u = {:.6f}", block_.analytic.value, block_.analytic.u), "mm", "E13",
         "Eq. (8) solved by bracketing instead of a quartic through five samples"});
    add({"The same with C as printed", "section 5, Table 1", "0.9382",
         fmt::format("{:.6f} at u = {:.6f}", analytic_c.value, analytic_c.u), "mm", "E13",
         "C rounded to four digits"});
    add({"Analytic against real maximum", "section 5", "99.99 %",
         fmt::format("{:.4f} %", 100.0 * block_.analytic.value / line.value), "", "E14",
         "each at its own maximum"});
  }

  void beyond_the_paper() {
    const kinematics::TrajectoryError& error = block_.error;
    add({"Greatest distance to the segment", "section 4", "–",
         fmt::format("{:.6f} at u = {:.4f}", error.segment.value, error.segment.u), "mm", "E15",
         "the distance to the infinite line hides the excursion past the end"});
    add({"Past P1 along the line", "section 4", "–", number(error.beyond.value), "mm", "E15", ""});
    add({"Length of the real path", "section 4", "–", number(error.length_mm), "mm", "E15",
         fmt::format("programmed: {:.6f} mm", error.chord_mm)});
    add({"Tool axis off the great circle", "section 4", "–", number(deg_from_rad(error.orientation_rad)),
         "deg", "", "the paper looks at the tip alone"});
  }

  void model_letters() {
    const kinematics::PolarForm form = model_.polar();
    const Vec3& p0 = ends_.from.tip_W;
    const Vec3 way = ends_.to.tip_W - p0;
    add({"s, sense of M0 M1", "Eq. (3)", "sign(M1y/M1x - M0y/M0x)", fmt::format("{:+.0f}", form.s), "", "E10",
         "sign(M0x M1y - M0y M1x)"});
    add({"k in a0 = -k a", "Eq. (3), (5)",
         fmt::format("{:.6f}, Eq. (5) as printed", p0.dot(way) / way.squaredNorm()), number(form.k), "",
         "E11, E12", "the foot of the origin on M0 M1; in Eq. (5) P means P - P0"});
    add({"d in r(u) and beta(u)", "Eq. (3)", "d, b", number(form.d), "mm", "E11",
         "one and the same: distance of the axis from the line M0 M1"});
    add({"F(0), F(1) of Eq. (8)", "Eq. (8)", "–",
         fmt::format("{:.6f}, {:.6f}", model_.tangent_criterion(0.0), model_.tangent_criterion(1.0)), "",
         "E13", "one change of sign: one root"});
  }

  const MachineModel& machine_;
  const BlockSingularity& block_;
  const BlockEnds& ends_;
  kinematics::SingularityModel model_;
  std::vector<PaperRow> rows_;
};

}  // namespace

bool runs_so_block(const MachineModel& machine, const SingularityScan& scan) {
  return has_paper_axes(machine) && so_block(scan) != nullptr;
}

std::vector<PaperRow> so_paper_rows(const MachineModel& machine, const SingularityScan& scan) {
  if (!runs_so_block(machine, scan)) return {};
  return Rows(machine, *so_block(scan)).all();
}

}  // namespace swarf::papers

// Random CL data for every shipped machine in every post, with and without TCP, read back by our interpreter:
// each position within half of the last digit, each feed within the tolerance; every second seed in inches. A
// failing case is printed whole.
#include <cstdlib>

#include "base/rng.h"
#include "unit/post/read_back.h"

namespace swarf::post::property_test {
namespace {

constexpr const char* kMachines[] = {"mill_3axis", "fork_head",     "head_table_bc", "lin_koren_xyzab",
                                     "maho_600c",  "mikron_ucp710", "nutating_head", "spinner_u5_620"};
constexpr const char* kPosts[] = {"fanuc", "siemens", "heidenhain", "linuxcnc", "haas", "mazak"};

/// Writes CL data statement by statement, near the middle of what the machine reaches.
class RandomPath {
 public:
  RandomPath(const kinematics::MachineModel& machine, uint64_t seed)
      : machine_(kinematics::with_tool(machine, 80.0)),
        inverse_(machine_),
        poles_(kinematics::find_poles(machine_)),
        rng_(seed) {
    for (size_t i = 0; i < machine_.axes.size(); ++i) {
      const kinematics::Axis& axis = machine_.axes[i];
      low_[static_cast<long>(i)] =
          axis.kind == kinematics::AxisKind::kRotary ? std::max(axis.min, -1.0) : 0.0;
      high_[static_cast<long>(i)] =
          axis.kind == kinematics::AxisKind::kRotary ? std::min(axis.max, 1.0) : 0.0;
    }
  }

  std::string text() {
    out_ = "$$ SWARF CL DATA\nPARTNO RANDOM\nLOADTL/1\nSPINDL/RPM,4000,CLW\nMULTAX/ON\n";
    tip_ = random_tip();
    axis_ = random_axis();
    out_ += "FROM/" + pose() + "\n";
    out_ += fmt::format("FEDRAT/{:.0f},MMPM\n", rng_.uniform(100, 2000));
    const int pieces = 3 + static_cast<int>(rng_.next() % 5);
    for (int i = 0; i < pieces; ++i) piece();
    return out_ + "FINI\n";
  }

 private:
  Vec3 random_tip() { return {rng_.uniform(-30, 30), rng_.uniform(-30, 30), rng_.uniform(0, 40)}; }
  /// Of axis values, so that the machine reaches it; often the pole or straight beyond it.
  Vec3 random_axis() {
    const uint64_t what = rng_.next() % 6;
    if (what == 0 && !poles_.at.empty()) return pole();
    kinematics::AxisValues q = kinematics::AxisValues::Zero();
    for (size_t i = 0; i < machine_.axes.size(); ++i)
      q[static_cast<long>(i)] = rng_.uniform(low_[static_cast<long>(i)], high_[static_cast<long>(i)] + 1e-9);
    return kinematics::forward(machine_, q).axis_W;
  }
  Vec3 pole() {
    for (const kinematics::Pole& one : poles_.at) {
      if (one.direction_W.z() > 0.0) return one.direction_W;
    }
    return poles_.at.front().direction_W;
  }
  std::string pose() const {
    return fmt::format("{:.4f},{:.4f},{:.4f},{:.9f},{:.9f},{:.9f}", tip_.x(), tip_.y(), tip_.z(), axis_.x(),
                       axis_.y(), axis_.z());
  }
  void go() { out_ += "GOTO/" + pose() + "\n"; }
  void piece() {
    switch (rng_.next() % 7) {
      case 0:
        return lines();
      case 1:
        return arcs();
      case 2:
        return holes();
      case 3:
        return through_pole();
      case 4:
        return rapids();
      case 5:
        return change();
      default:
        return turning_lines();
    }
  }
  void lines() {
    for (int i = 0; i < 4; ++i) tip_ = random_tip(), go();
  }
  void turning_lines() {
    for (int i = 0; i < 3; ++i) {
      const Vec3 to = random_axis();
      if (angle_between(axis_, to) > 0.7) continue;
      axis_ = to;
      tip_ = random_tip();
      go();
    }
  }
  void rapids() {
    out_ += "RAPID\n";
    tip_.z() = 60.0;
    go();
    out_ += "RAPID\n";
    axis_ = random_axis();
    tip_ = random_tip() + Vec3(0, 0, 30);
    go();
  }
  void change() {
    rapids();
    out_ += fmt::format("LOADTL/{}\nSPINDL/RPM,{},CLW\n", 1 + rng_.next() % 2, 1000 + rng_.next() % 5000);
    out_ += "RAPID\n";
    tip_ = random_tip() + Vec3(0, 0, 30);
    go();
    if (rng_.next() % 2 == 0) out_ += "DELAY/0.25\n";
    lines();
  }
  void through_pole() {
    if (poles_.at.empty()) return lines();
    const Vec3 p = pole();
    const Vec3 aside = p.cross(rng_.direction()).normalized() * rng_.uniform(0.02, 0.2);
    const Vec3 off = rng_.next() % 2 == 0
                         ? Vec3(Vec3::Zero())
                         : Vec3(p.cross(aside).normalized() * std::pow(10.0, rng_.uniform(-8, -1)));
    for (const double side : {1.0, -1.0}) {
      const Vec3 to = (p + side * aside + off).normalized();
      if (angle_between(axis_, to) > 0.8) return;
      axis_ = to;
      tip_ = random_tip();
      go();
    }
  }
  /// In a plane of the work, or across the tool.
  void arcs() {
    for (int i = 0; i < 3; ++i) {
      const uint64_t which = rng_.next() % 4;
      const Vec3 normal =
          which == 3 ? axis_ : Vec3(Vec3::Unit(static_cast<int>(which)) * (rng_.next() % 2 == 0 ? 1 : -1));
      Vec3 radius = normal.cross(rng_.direction()).normalized() * std::pow(10.0, rng_.uniform(-2.0, 1.2));
      const Vec3 centre = tip_ - radius;
      const double angle = rng_.next() % 5 == 0 ? kTurn : rng_.uniform(0.001, 6.28);
      const double rise = rng_.next() % 3 == 0 ? rng_.uniform(-3, 3) : 0.0;
      // CIRCLE of Swarf's own data runs clockwise about its vector.
      out_ += fmt::format("CIRCLE/{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.6f}\n", centre.x(), centre.y(),
                          centre.z(), -normal.x(), -normal.y(), -normal.z(), radius.norm());
      if (angle < kTurn) radius = std::cos(angle) * radius + std::sin(angle) * normal.cross(radius);
      tip_ = centre + radius + (angle < kTurn ? rise : 0.0) * normal;
      go();
    }
  }
  void holes() {
    constexpr const char* kKinds[] = {"DRILL", "DEEP", "BRKCHP", "BORE", "TAP", "FACE"};
    const uint64_t kind = rng_.next() % 6;
    out_ += fmt::format("CYCLE/{},DEPTH,{:.1f},CLEAR,2{}{},MMPM,{:.0f}\n", kKinds[kind], rng_.uniform(3, 12),
                        kind == 1 || kind == 2 ? ",STEP,2.5" : "", kind == 5 ? ",DWELL,0.4" : "",
                        rng_.uniform(80, 400));
    for (int i = 0; i < 3; ++i) {
      const double z = tip_.z();
      tip_ = random_tip();
      if (rng_.next() % 2 == 0) tip_.z() = z;
      go();
    }
    out_ += "CYCLE/OFF\nRAPID\n";  // the tool stands above the hole
    go();
  }

  kinematics::MachineModel machine_;
  kinematics::InverseKinematics inverse_;
  kinematics::Poles poles_;
  Rng rng_;
  kinematics::AxisValues low_ = kinematics::AxisValues::Zero(), high_ = low_;
  Vec3 tip_, axis_;
  std::string out_;
};

/// Without TCP and cycles our interpreter needs as long for the feeds as the plan does: inverse times, and
/// what stands for them, say the feed of the tip.
std::string feed_fault(const Posted& run) {
  if (run.result.tcp || run.result.plan.holes > 0) return "";
  double seconds = 0.0;
  for (const program::NcMove& move : run.moves) seconds += move.rapid ? 0.0 : move.duration_s;
  const double planned = run.result.plan.feed_s;
  return std::abs(seconds - planned) <= 5e-3 * planned + 0.02
             ? ""
             : fmt::format("feeds take {:.4f} s, planned {:.4f} s", seconds, planned);
}

TEST(PostProperty, ReadBackWithinHalfADigit) {
  const char* wished = std::getenv("SWARF_POST_SEED");
  const char* many = std::getenv("SWARF_POST_SEEDS");
  const uint64_t first = wished != nullptr ? std::strtoull(wished, nullptr, 10) : 1,
                 count = many != nullptr     ? std::strtoull(many, nullptr, 10)
                         : wished != nullptr ? 1
                                             : 6;
  long done = 0, refused = 0;
  for (const char* name : kMachines) {
    const kinematics::MachineModel machine = placed_machine(name);
    for (uint64_t seed = first; seed < first + count; ++seed) {
      const std::string cl = RandomPath(machine, seed).text();
      for (const char* post : kPosts) {
        for (const bool tcp : {false, true}) {
          if (tcp && machine.axes.size() < 4) continue;
          PostOptions options;
          options.tcp = tcp;
          options.tools = {{1, "MILL10", 80.0}, {2, "DRILL5", 80.0}};
          const Posted run = run_post(cl, machine, in_unit(shipped_post(post), seed % 2 == 0), options);
          ++done;
          if (!run.faults.empty()) {
            ++refused;
            const bool expected = run.faults.find("[axis-jump]") != std::string::npos ||
                                  run.faults.find("[travel]") != std::string::npos;
            ASSERT_TRUE(expected) << name << " " << post << "\n" << run.faults << cl;
            continue;
          }
          const std::string wrong = reading_faults(run) + compare(run) + feed_fault(run);
          ASSERT_EQ(wrong, "") << name << " " << post << " tcp " << tcp << " SWARF_POST_SEED=" << seed << "\n"
                               << cl << "\n"
                               << run.text;
        }
      }
    }
  }
  // Some paths need more travel than a machine has; most have to go through.
  EXPECT_LT(refused * 4, done);
  RecordProperty("done", static_cast<int>(done));
  RecordProperty("refused", static_cast<int>(refused));
  if (many != nullptr) fmt::print("{} programs, {} paths refused for travel\n", done, refused);
}

}  // namespace
}  // namespace swarf::post::property_test

// Property: 40 planted faults of shank, holder, rapid and spindle over all shipped machines are found with
// line and depth, and their 40 twins, the same moves two voxels clear of the block, are free. Seeded.
//
// The oracle is independent of the level set: the block is a box, every part of the tool a cylinder, both
// distances are closed forms, and how deep a part stands in the box is the greatest of  -box(p) - part(p):
// concave in p, so a search by shrinking steps finds it. It walks densely along the very sweeps that cut.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "base/rng.h"
#include "sim/simulation.h"
#include "support/program_run.h"

namespace swarf::sim {
namespace {

namespace fs = std::filesystem;

const char* const kMachines[] = {"fork_head",     "head_table_bc", "lin_koren_xyzab", "maho_600c",
                                 "mikron_ucp710", "mill_3axis",    "nutating_head",   "spinner_u5_620"};
constexpr double kPathHalf = 45.0;  // mm: long blocks begin and end this far from the block's middle

struct Cylinder {
  double low, high, radius;
  double distance(const Vec3& p) const {
    const double out = p.head<2>().norm() - radius, along = std::max(low - p.z(), p.z() - high);
    return std::max(out, along) <= 0.0 ? std::max(out, along)
                                       : std::hypot(std::max(out, 0.0), std::max(along, 0.0));
  }
};

double box_distance(const Box& box, const Vec3& p) {
  const Vec3 q = (p - box.centre()).cwiseAbs() - 0.5 * box.size();
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// How deep the cylinder stands in the box at a pose; below 0: minus their gap. `p`: a good guess, in the
/// tool's frame, and the place that was found.
double depth_at(const ToolPose& pose, const Cylinder& part, const Box& box, Vec3& p) {
  const Vec3 x = pose.axis_W.unitOrthogonal(), y = pose.axis_W.cross(x);
  const auto depth = [&](const Vec3& q) {
    const Vec3 point = pose.tip_W + q.x() * x + q.y() * y + q.z() * pose.axis_W;
    return -box_distance(box, point) - part.distance(q);
  };
  double best = depth(p);
  for (double step = part.high - part.low; step > 1e-3;) {
    Vec3 better = p;
    for (int i = 0; i < 26; ++i) {
      const int n = i < 13 ? i : i + 1;
      const Vec3 q = p + step * Vec3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
      if (const double value = depth(q); value > best + 1e-9) {
        best = value;
        better = q;
      }
    }
    if (better == p) step *= 0.5;
    p = better;
  }
  return best;
}

struct Oracle {
  double depth_mm = -1e9;
  struct Instant {
    size_t sweep = 0;
    double t = 0.0;
  };
  Instant first, sure;  ///< half a voxel and one and a quarter deep: it is found somewhere between
};

Oracle oracle_of(const JobSweeps& sweeps, const Cylinder& part, const Box& box, double voxel) {
  Oracle oracle;
  bool touched = false, surely = false;
  for (size_t n = 0; n < sweeps.sweeps.size(); ++n) {
    const stock::Sweep& sweep = sweeps.sweeps[n];
    const double way = (sweep.end.tip_W - sweep.start.tip_W).norm() +
                       part.high * (sweep.end.axis_W - sweep.start.axis_W).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(way / (0.5 * voxel))));
    Vec3 p(0, 0, part.low);
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const ToolPose pose{(1.0 - t) * sweep.start.tip_W + t * sweep.end.tip_W,
                          ((1.0 - t) * sweep.start.axis_W + t * sweep.end.axis_W).normalized()};
      const double depth = depth_at(pose, part, box, p);
      oracle.depth_mm = std::max(oracle.depth_mm, depth);
      if (!touched && depth > 0.5 * voxel) oracle.first = {n, t};
      touched = touched || depth > 0.5 * voxel;
      if (!surely && depth > 1.25 * voxel) oracle.sure = {n, t};
      surely = surely || depth > 1.25 * voxel;
    }
  }
  return oracle;
}

enum class Kind { kShank, kMerged, kHolder, kRapid, kSpindle, kSwing };

/// One job: what it is made of, and what must be found.
struct Plan {
  Kind kind = Kind::kShank;
  std::string machine, mode = "tcp";
  double voxel = 0.5, diameter = 8.0, flutes = 5.0, length = 60.0;
  Box box{{-15, -15, -40}, {15, 15, 0}};
  Vec3 axis = Vec3::UnitZ();
  double depth = 3.0;  ///< planted
  double lift = 0.0;   ///< of the twin
  Vec3 along = Vec3::UnitX();
  double azimuth = 2.0;  ///< kSwing: from minus to plus
  int blocks = 1;

  Cylinder part() const {
    if (kind == Kind::kHolder) return {length, length + 50.0, 20.0};
    if (kind == Kind::kRapid || kind == Kind::kSpindle) return {0.0, flutes, 0.5 * diameter};
    return {flutes, length, 0.5 * diameter};
  }
  std::string go(const Vec3& tip, const Vec3& a) const {
    const std::string place = fmt::format("GOTO/{:.9f},{:.9f},{:.9f}", tip.x(), tip.y(), tip.z() + lift);
    if (machine == "mill_3axis") return place + "\n";
    return place + fmt::format(",{:.12f},{:.12f},{:.12f}\n", a.x(), a.y(), a.z());
  }
  /// The tip at the block's middle: the lowest point of the part's lower rim lies `depth` below the face.
  Vec3 middle() const {
    const Cylinder c = part();
    const double sink = c.low * axis.z() - c.radius * std::hypot(axis.x(), axis.y());
    const Vec3 beside =
        kind == Kind::kHolder ? Vec3(box.upper.x() + 0.5 * diameter + 2.0, 0, 0) : Vec3(0, 0, 0);
    return beside + Vec3(0, 0, -depth - sink);
  }
  std::string program() const {
    std::string text = "UNITS/MM\nLOADTL/1\n";
    if (machine != "mill_3axis") text += "MULTAX/ON\n";
    text += "SPINDL/RPM,5000,CLW\n";
    const auto leaned = [&](double angle) {
      const double lean = std::hypot(axis.x(), axis.y());
      return Vec3(lean * std::cos(angle), lean * std::sin(angle), axis.z());
    };
    if (kind == Kind::kSwing) {
      const Vec3 tip = Vec3(box.lower.x() - 12.0, 0, -20.0);
      text += "FEDRAT/2000\n" + go(tip, leaned(-azimuth));
      for (int i = 1; i <= blocks; ++i) text += go(tip, leaned(azimuth * (2.0 * i / blocks - 1.0)));
      return text + "FINI\n";
    }
    const Vec3 start = middle() - kPathHalf * along;
    text += "FEDRAT/2000\n" + go(start + Vec3(0, 0, 20), axis) + go(start, axis);
    if (kind == Kind::kSpindle) text += "SPINDL/OFF\n";
    for (int i = 1; i <= blocks; ++i) {
      if (kind == Kind::kRapid) text += "RAPID\n";
      text += go(middle() + kPathHalf * (2.0 * i / blocks - 1.0) * along, axis);
    }
    return text + "FINI\n";
  }
  std::string scene() const {
    return fmt::format(
        "machine = \"{}/assets/machines/{}/machine.toml\"\ncl = \"path.cl\"\n[cutter]\nnumber = 1\n"
        "diameter_mm = {}\nflute_length_mm = {}\nlength_mm = {}\nholder_diameter_mm = 40\n"
        "[stock]\nbox_mm = [[{}, {}, {}], [{}, {}, {}]]\nvoxel_mm = {}\n[design]\nkind = \"none\"\n"
        "[interpolator]\nmode = \"{}\"\nperiod_ms = 4\n",
        SWARF_SOURCE_DIR, machine, diameter, flutes, length, box.lower.x(), box.lower.y(), box.lower.z(),
        box.upper.x(), box.upper.y(), box.upper.z(), voxel, mode);
  }
};

Plan plan_of(int index) {
  Rng rng(1100 + static_cast<uint64_t>(index));
  Plan plan;
  plan.machine = kMachines[index % 8];
  const bool turns = plan.machine != "mill_3axis";
  const Kind kinds[] = {Kind::kShank, Kind::kMerged, Kind::kHolder,
                        index % 2 == 0 ? Kind::kRapid : Kind::kSpindle, Kind::kSwing};
  plan.kind = kinds[index / 8];
  if (plan.kind == Kind::kSwing && !turns) plan.kind = Kind::kRapid;
  plan.voxel = rng.uniform(0.35, 0.7);
  plan.diameter = rng.uniform(6.0, 11.0);
  plan.flutes = plan.kind == Kind::kRapid || plan.kind == Kind::kSpindle ? 25.0 : rng.uniform(3.0, 7.0);
  plan.depth = rng.uniform(1.5 * plan.voxel, 7.0);
  const double angle = rng.uniform(0.0, 2.0 * kPi);
  plan.along = {std::cos(angle), std::sin(angle), 0.0};
  if (plan.kind == Kind::kMerged) plan.blocks = 7;
  if (plan.kind == Kind::kHolder) {
    plan.along = Vec3::UnitY();
    plan.length = rng.uniform(15.0, 25.0);
  } else if (plan.kind == Kind::kSwing) {
    plan.diameter = 8.0;
    plan.flutes = 4.0;
    plan.mode = index % 2 == 0 ? "joint" : "tcp";
    const double lean = rng.uniform(0.55, 0.65);
    plan.axis = {std::sin(lean), 0.0, std::cos(lean)};
    plan.azimuth = rng.uniform(2.0, 2.4);
    plan.blocks =
        12;  // the tip of a joint motion leaves its place by what the square of a block's turn gives
  } else if (turns) {
    const double lean = rng.uniform(0.0, 0.35), side = rng.uniform(0.0, 2.0 * kPi);
    plan.axis = {std::sin(lean) * std::cos(side), std::sin(lean) * std::sin(side), std::cos(lean)};
    // Leaned across the way: leaned along it, the flutes' high side clears the way for the shank's low one.
    plan.along = {-std::sin(side), std::cos(side), 0.0};
  }
  return plan;
}

struct Found {
  Result result;
  Oracle oracle;
  int first_line = 0, last_line = 0;  ///< of the oracle's first and sure instants
};

/// The block of an instant: where straight ones are merged, the one that the tip stands in.
int line_at(const toolpath::ToolPath& path, const JobSweeps& sweeps, const Oracle::Instant& instant) {
  const stock::Sweep& sweep = sweeps.sweeps[instant.sweep];
  const Vec3 tip = (1.0 - instant.t) * sweep.start.tip_W + instant.t * sweep.end.tip_W;
  const bool straight = sweep.start.axis_W == sweep.end.axis_W;
  const int element = sweeps.sources[sweep.block].element;
  for (const toolpath::Element& one : path.elements) {
    const auto& block = std::get<toolpath::BlockMove>(one.what);
    const Vec3 way = block.to.tip_W - block.from.tip_W;
    const bool same_way = way.cross(sweep.end.tip_W - sweep.start.tip_W).norm() < 1e-6 * way.norm();
    if (straight && same_way && (tip - block.from.tip_W).dot(way) <= way.squaredNorm() + 1e-9)
      return one.where.line;
  }
  return path.elements[static_cast<size_t>(element)].where.line;
}

Found run(const Plan& plan, const fs::path& folder) {
  test::write_text(folder / "scene.toml", plan.scene());
  test::write_text(folder / "path.cl", plan.program());
  const Job job = load_job((folder / "scene.toml").string(), {});
  Progress silent;
  Found out;
  out.result.main = move_tool(job, silent);
  const JobSweeps sweeps = stock_sweeps(job, *out.result.main.cycles);
  out.oracle = oracle_of(sweeps, plan.part(), plan.box, plan.voxel);
  cut_stock(job, {}, silent, out.result);
  out.first_line = line_at(out.result.main.path, sweeps, out.oracle.first);
  out.last_line = line_at(out.result.main.path, sweeps, out.oracle.sure);
  return out;
}

std::string pasted(const Plan& plan) {
  return fmt::format("--- scene.toml\n{}--- path.cl\n{}", plan.scene(), plan.program());
}

class PlantedContact : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { folder_ = test::fresh_folder(fmt::format("planted_{}", GetParam())); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_P(PlantedContact, IsFoundAndItsTwinIsFree) {
  Plan plan = plan_of(GetParam());
  const Found fault = run(plan, folder_);
  const bool flutes = plan.kind == Kind::kRapid || plan.kind == Kind::kSpindle;
  const std::vector<BadCut>& bad = fault.result.cut.state.bad_cuts;
  const std::vector<ContactEvent>& contacts = fault.result.clearance.events;
  ASSERT_EQ(contacts.size(), flutes ? 0U : 1U) << pasted(plan);
  ASSERT_EQ(bad.size(), flutes ? 1U : 0U) << pasted(plan);
  const ContactEvent& event = flutes ? bad[0].event : contacts[0];
  const char* const part = flutes ? "flutes" : plan.kind == Kind::kHolder ? "holder" : "shank";
  EXPECT_EQ(event.part, part) << pasted(plan);
  if (plan.kind != Kind::kSwing) {
    EXPECT_NEAR(fault.oracle.depth_mm, plan.depth, 0.02) << pasted(plan);
  }
  EXPECT_NEAR(event.depth_mm, fault.oracle.depth_mm, plan.voxel) << pasted(plan);
  const int line = fault.result.main.path.elements[static_cast<size_t>(event.first.element)].where.line;
  EXPECT_GE(line, fault.first_line) << pasted(plan);
  EXPECT_LE(line, fault.last_line) << pasted(plan);
  if (flutes) {
    EXPECT_EQ(bad[0].kind == BadCutKind::kRapid, plan.kind == Kind::kRapid);
  }

  // Up along the lift until two voxels of air are left; where the part leans, that is more than its depth.
  Plan twin = plan;
  std::optional<Found> free;
  double depth = fault.oracle.depth_mm;
  for (int step = 0; step < 20 && depth > -1.98 * plan.voxel; ++step) {
    twin.lift += depth + 2.0 * plan.voxel;
    free.emplace(run(twin, folder_));
    depth = free->oracle.depth_mm;
  }
  EXPECT_LE(depth, -1.98 * plan.voxel) << pasted(twin);
  EXPECT_TRUE(free->result.clearance.events.empty()) << pasted(twin);
  EXPECT_TRUE(free->result.cut.state.bad_cuts.empty()) << pasted(twin);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlantedContact, testing::Range(0, 40));

}  // namespace
}  // namespace swarf::sim

#include "sim/run/carried_cuts.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/hash.h"
#include "motion/interpolator.h"
#include "sim/job/job_path.h"
#include "sim/run/cut_sweeps.h"
#include "sim/run/in_process_stock.h"

namespace swarf::sim {
namespace {

constexpr size_t kCarriedPerStep = 512;  // sweeps between two looks at the progress bar and Ctrl-C

ToolPose moved_pose(const Pose& X_WE, const ToolPose& pose) {
  return {X_WE * pose.tip_W, X_WE.linear() * pose.axis_W};
}

/// The path of an earlier set-up with its cycles, which sweeps of planned passes and driven axes are made of.
struct EarlierMotion {
  explicit EarlierMotion(const Job& job) {
    Diagnostics told;  // its own run has told it
    JobPath found = job_path(job, told);
    path = std::move(found.path);
    if (found.nc) called = std::move(found.nc->summary.files);
    cycles.emplace(path.elements, machines_by_tool(job), job.scene.tools.front(), job.scene.motion);
    if (job.scene.stock.cut_by == CutBy::kBlocks) return;
    Progress silent;
    motion::interpolate(*cycles, silent, [](std::span<const motion::Cycle>) {});
  }
  toolpath::ToolPath path;
  std::vector<std::string> called;
  std::optional<motion::Cycles> cycles;
};

void append(const JobSweeps& own, const Pose& X_WE, size_t first_solid, const std::string& where,
            CarriedSweeps& all) {
  for (const stock::Sweep& sweep : own.sweeps) {
    all.solids.push_back(static_cast<int>(first_solid) + own.sources[sweep.block].tool);
    all.sweeps.push_back({moved_pose(X_WE, sweep.start), moved_pose(X_WE, sweep.end),
                          static_cast<uint32_t>(all.sweeps.size())});
  }
  all.where.push_back(where);
  all.ends.push_back(all.sweeps.size());
  all.error_bound_mm = std::max(all.error_bound_mm, own.error_bound_mm);
}

/// Before the sweeps themselves.
void append_blocks(const JobSweeps& own, const toolpath::Elements& elements, CarriedSweeps& all) {
  int last = -1;
  for (size_t n = 0; n < own.sweeps.size(); ++n) {
    const int element = own.sources[own.sweeps[n].block].element;
    if (element == last) continue;
    last = element;
    const SourceLocation where = elements.where(static_cast<size_t>(element));
    if (all.files.empty() || all.files.back() != where.file) all.files.push_back(where.file);
    all.blocks.push_back({all.sweeps.size() + n, static_cast<uint32_t>(all.files.size() - 1), where.line});
  }
}

std::string spoken_place(const EarlierSetup& earlier) {
  const Scene& scene = earlier.job->scene;
  if (earlier.other_run) return "in the run of " + scene.title;
  return fmt::format("in set-up {}{}", scene.setup.number,
                     scene.setup.name.empty() ? "" : ", " + scene.setup.name);
}

/// The stock that the other run has left names what has cut it.
void require_same_cuts(const EarlierSetup& setup, const motion::Cycles& cycles) {
  const CutSweeps sweeps = cut_sweeps(*setup.job, cycles);
  stock::StockMetadata metadata;
  CutState state;
  load_unchecked(setup.stock_file, metadata, state);
  if (state.sweeps < sweeps.size())
    throw InputError(
        "from-run-unfinished", {setup.stock_file},
        fmt::format("that run was stopped: {} of {} blocks are cut", state.sweeps, sweeps.size()),
        "run the earlier clamping to its end");
  Diagnostics diagnostics;
  const CarriedCutsPtr before = carried_cuts(*setup.job);
  for (const IdentityDifference& part :
       differences(identity_in(metadata), cut_identity(*setup.job, sweeps, *before)))
    diagnostics.error("from-run-differs", {setup.stock_file},
                      fmt::format("the inputs kept with that run do not cut its stock: {} was {} and is {}",
                                  part.name, part.before, part.now),
                      "run the earlier clamping again");
  diagnostics.throw_if_errors();
}

}  // namespace

CarriedCutsPtr carried_cuts(const Job& job) {
  auto all = std::make_shared<CarriedCuts>();
  for (size_t i = 0; i < job.earlier.size(); ++i) {
    const EarlierSetup& setup = job.earlier[i];
    const EarlierMotion motion(*setup.job);
    if (!setup.stock_file.empty()) require_same_cuts(setup, *motion.cycles);
    const size_t first_solid = all->solids.size();
    for (stock::CutterSolid& solid : tool_solids(setup.job->scene)) all->solids.push_back(std::move(solid));
    all->tools += (all->tools.empty() ? "" : "; ") + tools_text(setup.job->scene.tools);
    all->called.push_back(motion.called);
    const std::string where = spoken_place(setup);
    append(stock_sweeps(*setup.job, *motion.cycles, job.scene.stock.sweep_tolerance_mm), setup.X_WE,
           first_solid, where, all->stock);
    if (!job.has_design()) continue;
    const JobSweeps rays = ray_sweeps(*setup.job, *motion.cycles, job.scene.design.sweep_tolerance_mm);
    append_blocks(rays, motion.path.elements, all->rays);
    append(rays, setup.X_WE, first_solid, where, all->rays);
  }
  return all;
}

std::string CarriedCuts::text() const {
  if (empty()) return "";
  Hash hash;
  for (const stock::Sweep& sweep : stock.sweeps) {
    for (const Vec3* v : {&sweep.start.tip_W, &sweep.start.axis_W, &sweep.end.tip_W, &sweep.end.axis_W})
      for (int a = 0; a < 3; ++a) hash.add((*v)[a]);
  }
  for (const int solid : stock.solids) hash.add(static_cast<uint64_t>(solid));
  return fmt::format("{} sweeps {} of {}", stock.sweeps.size(), hash.text(), tools);
}

size_t CarriedCuts::bytes() const {
  const size_t sweeps = stock.sweeps.capacity() + rays.sweeps.capacity();
  return sweeps * (sizeof(stock::Sweep) + sizeof(int)) + rays.blocks.capacity() * sizeof(CarriedBlock);
}

bool cut_carried(stock::Stock& stock, const CarriedCuts& cuts, Progress* progress) {
  const size_t total = cuts.stock.sweeps.size();
  if (total == 0) return true;
  if (progress != nullptr) progress->begin("earlier set-ups", static_cast<double>(total), "blocks");
  for (size_t at = 0; at < total;) {
    if (progress != nullptr && progress->stop_requested()) break;
    const size_t end = std::min(at + kCarriedPerStep, total);
    for_each_solid(cuts.stock, at, end, [&](size_t solid, std::span<const stock::Sweep> part) {
      stock.cut(part, cuts.solids[solid]);
    });
    at = end;
    if (progress != nullptr) progress->advance(static_cast<double>(at));
  }
  if (progress != nullptr) progress->end();
  return progress == nullptr || !progress->stop_requested();
}

stock::Stock starting_stock(const Job& job, const CarriedCuts& cuts, double voxel_mm) {
  stock::Stock stock(job.scene.stock.body_W(), voxel_mm);
  cut_carried(stock, cuts);
  return stock;
}

const std::string& carried_place(const CarriedSweeps& carried, size_t sweep) {
  const auto setup = std::upper_bound(carried.ends.begin(), carried.ends.end(), sweep);
  return carried.where[static_cast<size_t>(setup - carried.ends.begin())];
}

SourceLocation carried_block(const CarriedSweeps& carried, size_t sweep) {
  const auto next =
      std::upper_bound(carried.blocks.begin(), carried.blocks.end(), sweep,
                       [](size_t one, const CarriedBlock& block) { return one < block.first_sweep; });
  const CarriedBlock& block = *std::prev(next);
  return {carried.files[block.file], block.line};
}

}  // namespace swarf::sim

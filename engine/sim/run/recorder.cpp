#include "sim/run/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "base/diagnostics.h"
#include "base/file.h"
#include "base/units.h"
#include "sim/run/cycle_h5.h"

namespace swarf::sim {
namespace {

constexpr std::array<const char*, 4> kKindNames{"cut", "approach", "retract",
                                                "rapid"};  // order of SampleKind

const char* kind_name(motion::SampleKind kind) {
  return kKindNames[static_cast<size_t>(kind)];
}

std::string pose_header() {
  return fmt::format("{}", fmt::join(kPoseColumns, ","));
}

std::string axis_header(const kinematics::MachineModel& machine) {
  std::string columns;
  for (const kinematics::Axis& axis : machine.axes) columns += fmt::format(",{}", axis_column(axis));
  return columns;
}

using Out = std::back_insert_iterator<fmt::memory_buffer>;

/// Of lengths and degrees. Of cycles as many as their third differences need, see open_cycle_table().
constexpr int kBlockDecimals = 7, kCycleDecimals = 10;

void append_pose(Out out, const ToolPose& pose, int decimals) {
  fmt::format_to(out, "{:.{}f},{:.{}f},{:.{}f},{:.10f},{:.10f},{:.10f}", pose.tip_W.x(), decimals,
                 pose.tip_W.y(), decimals, pose.tip_W.z(), decimals, pose.axis_W.x(), pose.axis_W.y(),
                 pose.axis_W.z());
}

void append_axes(Out out, const kinematics::AxisValues& q, const kinematics::MachineModel& machine,
                 int decimals) {
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const double value = q[static_cast<Eigen::Index>(i)];
    fmt::format_to(out, ",{:.{}f}", axis_column_value(machine.axes[i], value), decimals);
  }
}

std::ofstream open_table(const std::string& path, const std::string& header) {
  std::ofstream file(path, std::ios::binary);
  file << header << '\n';
  if (!file.flush()) throw unwritable_table(path);
  return file;
}

void put(std::ofstream& file, const fmt::memory_buffer& text) {
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
}

void close_table(std::ofstream& file, const std::string& path) {
  file.close();
  if (!file) throw unwritable_table(path);
}

/// trajectory.csv.
class CycleCsv final : public CycleTable {
 public:
  CycleCsv(const std::string& path, const Job& job, const motion::Cycles& cycles);
  void add(std::span<const motion::Cycle> window) override;
  void finish() override { close_table(file_, path_); }

 private:
  std::string path_;
  const Job& job_;
  const motion::Cycles& cycles_;
  std::ofstream file_;
};

}  // namespace

std::string tool_field(const cutter::Cutter& tool) {
  return tool.number > 0 ? fmt::format("{}", tool.number) : tool.name;
}

std::vector<std::string> kind_names() {
  return {kKindNames.begin(), kKindNames.end()};
}

InputError unwritable_table(const std::string& path) {
  return {"cannot-write",
          {path},
          "the table cannot be written",
          "check that the folder may be written and has space"};
}

std::string cycle_table_name(TrajectoryFormat format) {
  return format == TrajectoryFormat::kH5 ? "trajectory.h5" : "trajectory.csv";
}

BlockTable::BlockTable(const std::string& path, const Job& job, const motion::Cycles& cycles)
    : path_(path),
      job_(job),
      file_(open_table(
          path, "line,t_s," + pose_header() + axis_header(job.machine.model) + ",feed_mm_min,kind,tool")),
      rows_(cycles, [this](const BlockRow& row) { write(row); }) {}

void BlockTable::write(const BlockRow& row) {
  fmt::memory_buffer text;
  const Out out(text);
  fmt::format_to(out, "{},{:.6f},", row.line, row.t_s);
  append_pose(out, row.pose, kBlockDecimals);
  append_axes(out, row.q, job_.machine.model, kBlockDecimals);
  text.push_back(',');
  if (row.feed_mm_s) fmt::format_to(out, "{:.4f}", mm_min_from_mm_s(*row.feed_mm_s));
  fmt::format_to(out, ",{},{}\n", kind_name(row.kind), tool_field(job_.scene.tools[row.tool]));
  put(file_, text);
}

void BlockTable::finish() {
  rows_.finish();
  close_table(file_, path_);
}

CycleCsv::CycleCsv(const std::string& path, const Job& job, const motion::Cycles& cycles)
    : path_(path),
      job_(job),
      cycles_(cycles),
      file_(open_table(path, "t_s,block," + pose_header() + ",feed_mm_min" + axis_header(job.machine.model) +
                                 ",contact_x_mm,contact_y_mm,contact_z_mm,u,v,element,kind,tool")) {}

void CycleCsv::add(std::span<const motion::Cycle> window) {
  fmt::memory_buffer text;
  const Out out(text);
  for (const motion::Cycle& cycle : window) {
    const motion::ToolSample& s = cycle.sample;
    const int line = cycles_.elements().line(static_cast<size_t>(s.element));
    fmt::format_to(out, "{:.6f},{},", s.t_s, line);
    append_pose(out, s.pose, kCycleDecimals);
    fmt::format_to(out, ",{:.4f}", mm_min_from_mm_s(s.feed_mm_s));
    append_axes(out, cycle.q, job_.machine.model, kCycleDecimals);
    fmt::format_to(out, ",{:.10f},{:.10f},{:.10f},{:.9f},{:.9f},{},{},{}\n", s.contact_W.x(), s.contact_W.y(),
                   s.contact_W.z(), s.u, s.v, s.element, kind_name(s.kind),
                   tool_field(job_.scene.tools[static_cast<size_t>(s.tool)]));
  }
  put(file_, text);
}

void check_cycle_table_name(const std::string& path) {
  if (path.ends_with(".csv") || path.ends_with(".h5")) return;
  throw InputError("unknown-ending", {path}, "the ending of the file says no format of cycles",
                   "name it .csv or .h5");
}

std::unique_ptr<CycleTable> open_cycle_table(const std::string& path, const Job& job,
                                             const motion::Cycles& cycles) {
  check_cycle_table_name(path);
  if (path.ends_with(".h5")) return open_cycle_h5(path, job, cycles);
  return std::make_unique<CycleCsv>(path, job, cycles);
}

void write_cycle_window(const std::string& path, const Job& job, const motion::Cycles& cycles,
                        const CycleWindow& window) {
  NewFile file(path, {"cannot-write", "the table cannot be written"});
  const std::unique_ptr<CycleTable> table = open_cycle_table(file.temporary(), job, cycles);
  motion::CycleReader reader(cycles);
  std::vector<motion::Cycle> rows;
  for (size_t k = window.first; k < window.end; ++k) {
    rows.push_back(reader.at(k));
    if (rows.size() < motion::CycleStream::kWindow && k + 1 < window.end) continue;
    table->add(rows);
    rows.clear();
  }
  table->finish();
  file.move_into_place();
}

}  // namespace swarf::sim

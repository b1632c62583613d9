#include "sim/recorder.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "base/input_file.h"
#include "base/units.h"

namespace swarf::sim {
namespace {

using kinematics::AxisKind;

constexpr std::array<const char*, 4> kKindNames{"cut", "approach", "retract",
                                                "rapid"};  // order of SampleKind

std::string header(const kinematics::MachineModel& machine) {
  std::string line = "t_s,block,x_mm,y_mm,z_mm,i,j,k,feed_mm_min";
  for (const kinematics::Axis& axis : machine.axes) {
    line += fmt::format(",{}_{}", axis.name, axis.kind == AxisKind::kRotary ? "deg" : "mm");
  }
  return line + ",contact_x_mm,contact_y_mm,contact_z_mm,u,v,element,kind,tool";
}

std::string tool_field(const cutter::Cutter& tool) {
  return tool.number > 0 ? fmt::format("{}", tool.number) : tool.name;
}

double shown(const kinematics::Axis& axis, double q) {
  return axis.kind == AxisKind::kRotary ? deg_from_rad(q) : q;
}

void append_row(fmt::memory_buffer& out, const motion::ToolSample& s, const kinematics::AxisValues& q,
                const Job& job, int line) {
  const kinematics::MachineModel& machine = job.machine.model;
  auto it = std::back_inserter(out);
  const Vec3& p = s.pose.tip_W;
  const Vec3& a = s.pose.axis_W;
  fmt::format_to(it, "{:.6f},{},{:.7f},{:.7f},{:.7f},{:.10f},{:.10f},{:.10f},{:.4f}", s.t_s, line, p.x(),
                 p.y(), p.z(), a.x(), a.y(), a.z(), mm_min_from_mm_s(s.feed_mm_s));
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    fmt::format_to(it, ",{:.7f}", shown(machine.axes[i], q[static_cast<Eigen::Index>(i)]));
  }
  fmt::format_to(it, ",{:.7f},{:.7f},{:.7f},{:.9f},{:.9f},{},{},{}\n", s.contact_W.x(), s.contact_W.y(),
                 s.contact_W.z(), s.u, s.v, s.element, kKindNames[static_cast<size_t>(s.kind)],
                 tool_field(job.scene.tools[static_cast<size_t>(s.tool)]));
}

/// The fields of one line; text fields are kept as they are.
std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const auto comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

bool parse(std::string_view field, double& value) {
  const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), value);
  constexpr double kBeyondAnyRun = 1e9;  // of times, places, angles and numbers of elements
  return failure == std::errc() && end == field.data() + field.size() && std::abs(value) <= kBeyondAnyRun;
}

bool parse_kind(std::string_view field, motion::SampleKind& kind) {
  for (size_t i = 0; i < kKindNames.size(); ++i) {
    if (field != kKindNames[i]) continue;
    kind = static_cast<motion::SampleKind>(i);
    return true;
  }
  return false;
}

bool parse_tool(std::string_view field, const std::vector<cutter::Cutter>& tools, int16_t& tool) {
  for (size_t i = 0; i < tools.size(); ++i) {
    if (field != tool_field(tools[i])) continue;
    tool = static_cast<int16_t>(i);
    return true;
  }
  return false;
}

bool parse_row(std::string_view line, const Job& job, motion::ToolSample& s, kinematics::AxisValues& q) {
  const kinematics::MachineModel& machine = job.machine.model;
  const std::vector<std::string_view> fields = split(line);
  const size_t axes = machine.axes.size();
  if (fields.size() != 9 + axes + 8) return false;
  std::vector<double> x(fields.size() - 2);
  for (size_t i = 0; i < x.size(); ++i) {
    if (!parse(fields[i], x[i])) return false;
  }
  s.t_s = x[0];
  s.pose = {{x[2], x[3], x[4]}, Vec3(x[5], x[6], x[7]).normalized()};
  s.feed_mm_s = mm_s_from_mm_min(x[8]);
  for (size_t i = 0; i < axes; ++i) {
    const double value = x[9 + i];
    q[static_cast<Eigen::Index>(i)] = machine.axes[i].kind == AxisKind::kRotary ? rad_from_deg(value) : value;
  }
  const double* rest = x.data() + 9 + axes;
  s.contact_W = {rest[0], rest[1], rest[2]};
  s.u = rest[3];
  s.v = rest[4];
  s.element = static_cast<int>(rest[5]);
  return parse_kind(fields[x.size()], s.kind) && parse_tool(fields.back(), job.scene.tools, s.tool);
}

}  // namespace

void write_trajectory(const std::string& path, const motion::Trajectory& trajectory,
                      const toolpath::ToolPath& tool_path, const Job& job) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "{}\n", header(job.machine.model));
  for (size_t i = 0; i < trajectory.samples.size(); ++i) {
    const motion::ToolSample& sample = trajectory.samples[i];
    append_row(out, sample, trajectory.axes[i], job,
               tool_path.elements[static_cast<size_t>(sample.element)].where.line);
  }
  const std::string temporary = path + ".part";
  {
    std::ofstream file(temporary, std::ios::binary);
    file.write(out.data(), static_cast<std::streamsize>(out.size()));
    if (!file.flush()) {
      std::error_code ignored;
      std::filesystem::remove(temporary, ignored);
      throw InputError("cannot-write", {path}, "the trajectory cannot be written",
                       "check that the folder may be written and has space");
    }
  }
  std::filesystem::rename(temporary, path);
}

motion::Trajectory read_trajectory(const std::string& path, const Job& job) {
  refuse_special_file(path);
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line)) {
    throw InputError("file-not-found", {path}, "the trajectory of the run cannot be read",
                     "run the scene again");
  }
  if (line != header(job.machine.model)) {
    throw InputError("trajectory-mismatch", {path, 1, 1},
                     "the columns do not belong to the machine of this run", "run the scene again");
  }
  motion::Trajectory trajectory;
  trajectory.period_s = job.scene.motion.period_s;
  for (int number = 2; std::getline(file, line); ++number) {
    motion::ToolSample sample;
    kinematics::AxisValues q = kinematics::AxisValues::Zero();
    const double before = trajectory.samples.empty() ? sample.t_s : trajectory.samples.back().t_s;
    if (!parse_row(line, job, sample, q) || sample.t_s < before) {
      throw InputError("trajectory-broken", {path, number, 1}, "this line is not a sample of a run",
                       "run the scene again");
    }
    trajectory.samples.push_back(sample);
    trajectory.axes.push_back(q);
  }
  if (trajectory.samples.empty()) {
    throw InputError("trajectory-broken", {path}, "the trajectory has no sample", "run the scene again");
  }
  return trajectory;
}

}  // namespace swarf::sim

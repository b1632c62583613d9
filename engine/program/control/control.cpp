#include "program/control/control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/control/contour.h"

namespace swarf::program::nc {

using kinematics::AxisValues;

Control::Control(const ControlSetup& setup, NcSink& sink, Diagnostics& diagnostics, NcSummary& summary)
    : setup_(setup),
      sink_(sink),
      diagnostics_(diagnostics),
      summary_(summary),
      space_(setup.machine),
      contour_(std::make_unique<Contour>(*this)) {
  const Mat3& columns = space_.compensated({0.0, 0.0, 0.0}).columns_W;
  axes_rigid_ = (columns.transpose() * columns - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-9;
  for (int number = 1; number <= 9; ++number) origins_[number] = space_.gauge_zero();
  for (const auto& [number, difference] : setup.work_offsets)
    origins_[number] = space_.gauge_zero() + difference;
  origins_[0] = space_.gauge_zero();
  space_.set_origin(origins_[1]);
  if (setup.start) {
    q_ = *setup.start;
    start_here("given by the scene");
  }
}

Control::~Control() = default;

// --- Place and reports
// ---------------------------------------------------------------------------------------

int Control::enter_file(const std::string& path) {
  auto& files = summary_.files;
  const auto found = std::find(files.begin(), files.end(), path);
  if (found != files.end()) return static_cast<int>(found - files.begin());
  files.push_back(path);
  return static_cast<int>(files.size()) - 1;
}

void Control::fail(const char* code, int column, std::string text, std::string fix) const {
  const auto file = static_cast<size_t>(place_.file);
  const std::string name = file < summary_.files.size() ? summary_.files[file] : std::string();
  throw InputError(code, {name, place_.line, column > 0 ? column : place_.column}, std::move(text),
                   std::move(fix));
}

void Control::warn_once(const char* code, int column, std::string text, std::string fix) {
  if (std::find(warned_.begin(), warned_.end(), code) != warned_.end()) return;
  warned_.emplace_back(code);
  diagnostics_.warning(
      code,
      {summary_.files.empty() ? std::string() : summary_.files[static_cast<size_t>(place_.file)], place_.line,
       column > 0 ? column : place_.column},
      std::move(text), std::move(fix));
}

bool Control::take_builder_word(const std::string& word) {
  if (setup_.builder_words.empty()) return false;
  const auto found = setup_.builder_words.find(word);
  if (found == setup_.builder_words.end()) return false;
  without_effect(fmt::format("{} ({})", word, found->second));
  note(word, found->second);
  return true;
}

void Control::without_effect(std::string_view word) {
  auto& functions = summary_.functions;
  if (std::find(functions.begin(), functions.end(), word) == functions.end()) functions.emplace_back(word);
}

void Control::note(std::string_view word, std::string_view text) {
  sink_.note({std::string(word), std::string(text), place_.file, place_.line});
}

// --- Modal words
// ---------------------------------------------------------------------------------------------

void Control::set_plane(Plane plane) {
  if (plane == plane_) return;
  if (compensation() != Compensation::kOff) {
    fail("compensation-plane", 0, "the plane changes while cutter radius compensation is on",
         fmt::format("switch it off first: {}", words_.compensation_off));
  }
  plane_ = plane;
}

void Control::set_feed_mode(FeedMode mode) {
  if (mode == feed_mode_) return;
  feed_mode_ = mode;
  feed_ = 0.0;
  feed_fresh_ = false;
}

void Control::set_feed_in(double unit_mm, double value, int column) {
  if (!(value > 0.0)) {
    fail("bad-feed", column, fmt::format("F {:g} is not a feed", value), "write a feed above zero: F1000");
  }
  feed_ = value;
  feed_unit_mm_ = unit_mm;
  feed_fresh_ = true;
}

void Control::restore_feed(FeedMode mode, double feed) {
  feed_mode_ = mode;
  feed_ = feed;
  feed_unit_mm_ = unit_mm_;
  feed_fresh_ = false;
}

void Control::dwell(double seconds) {
  if (!(seconds >= 0.0)) {
    fail("out-of-range", 0, fmt::format("a dwell of {:g} s", seconds), "write a time of zero or more");
  }
  pending_dwell_s_ += seconds;
}

void Control::set_compensation_smooth(double angle_rad) {
  contour_->set_smooth(angle_rad);
}

void Control::set_compensation_entry(CompensationEntry entry) {
  contour_->set_entry(entry);
}

void Control::set_compensation(Compensation side, double radius_mm, int column) {
  if (side != Compensation::kOff && !(radius_mm >= 0.0 && std::isfinite(radius_mm))) {
    fail("compensation-no-tool", column, fmt::format("{:g} mm is not a cutter radius", radius_mm),
         "give the tool's diameter in the tool table");
  }
  contour_->set_side(side, radius_mm, column);
}

Compensation Control::compensation() const {
  return contour_->side();
}

bool Control::leading_out() const {
  return contour_->leading_out();
}

void Control::enter_compensation(Compensation side, double radius_mm, const Vec3& contour_point) {
  const Vec3 tool = position_xyz();
  contour_->enter(side, radius_mm, tool);
  for (int i = 0; i < 3; ++i) position_[static_cast<size_t>(i)] = contour_point[i];
}

// --- Tools
// ---------------------------------------------------------------------------------------------------

int Control::find_tool(int number, int column) {
  const auto found = std::find_if(setup_.tools.begin(), setup_.tools.end(),
                                  [&](const NcTool& tool) { return tool.number == number; });
  if (found != setup_.tools.end()) return static_cast<int>(found - setup_.tools.begin());
  return not_found(fmt::format("T{}", number), column);
}

int Control::find_tool(const std::string& name, int column) {
  const auto found = std::find_if(setup_.tools.begin(), setup_.tools.end(),
                                  [&](const NcTool& tool) { return tool.name == name; });
  if (found != setup_.tools.end()) return static_cast<int>(found - setup_.tools.begin());
  return not_found(fmt::format("T=\"{}\"", name), column);
}

int Control::not_found(const std::string& asked, int column) {
  if (setup_.tools.empty()) {
    warn_once("no-tool-table", column,
              fmt::format("{} cannot be looked up, there is no tool table: tools have length 0 here", asked),
              "give a tool table");
    return -1;
  }
  std::string list;
  for (const NcTool& tool : setup_.tools) {
    if (list.size() > 200) {
      list += ", ...";
      break;
    }
    if (!list.empty()) list += ", ";
    if (tool.number != 0) list += fmt::format("T{}", tool.number);
    if (!tool.name.empty()) list += fmt::format("{}\"{}\"", tool.number != 0 ? " " : "", tool.name);
  }
  fail("unknown-tool", column, fmt::format("{} is not in the tool table, which has {}", asked, list),
       "add the tool to the table, or correct the call");
}

void Control::select_tool(int index, int number) {
  selected_ = index;
  selected_number_ = number;
}

const NcTool* Control::active_tool() const {
  return tool_ < 0 ? nullptr : &setup_.tools[static_cast<size_t>(tool_)];
}

void Control::change_tool() {
  if (compensation() != Compensation::kOff) {
    fail("compensation-active", 0, "the tool changes while cutter radius compensation is on",
         fmt::format("switch it off first: {}", words_.compensation_off));
  }
  flush();
  spindle_ = 0;
  if (setup_.machine.tool_change) {
    if (started_) {
      Target target;
      for (int word = 0; word < kAxisWords; ++word) {
        if (axis_of(static_cast<AxisWord>(word)) >= 0)
          target.set(word, (*setup_.machine.tool_change)[axis_of(static_cast<AxisWord>(word))], false);
      }
      machine_line(Motion::kRapid, target);
    } else {
      q_ = *setup_.machine.tool_change;
      start_here(fmt::format("the machine's tool change position, at the first tool change in line {}",
                             place_.line));
    }
  }
  tool_ = selected_;
  tool_number_ = selected_number_;
  set_true_tool();
}

void Control::declare_tool(int index, int number) {
  flush();
  tool_ = index;
  tool_number_ = number;
  set_true_tool();
}

void Control::set_true_tool() {
  const NcTool* tool = active_tool();
  space_.set_true_length(tool == nullptr ? 0.0 : tool->length_mm);
  if (!started_) return;
  const LinearMap& map = space_.real(space_.rotary_of(q_));
  pose_ = {map.base_W + map.columns_W * space_.linear_of(q_), map.axis_W};
}

void Control::set_length_compensation(double length_mm, bool on) {
  moved_frame("the tool length compensation");
  length_on_ = on;
  space_.set_length(on ? length_mm : 0.0);
}

// --- Frames and offsets
// --------------------------------------------------------------------------------------

void Control::moved_frame(const char* what) {
  if (compensation() != Compensation::kOff) {
    fail("compensation-active", 0, fmt::format("{} changes while cutter radius compensation is on", what),
         fmt::format("switch it off first: {}", words_.compensation_off));
  }
  flush();
  position_valid_ = false;
}

void Control::set_work_offset(int number) {
  moved_frame("the work offset");
  offset_number_ = number;
  space_.set_origin(offset_origin(number));
}

AxisValues Control::offset_origin(int number) const {
  const auto found = origins_.find(number);
  return found == origins_.end() ? space_.gauge_zero() : found->second;
}

void Control::set_offset_origin(int number, const AxisValues& origin) {
  moved_frame("a work offset");
  origins_[number] = origin;
  if (number == offset_number_) space_.set_origin(origin);
}

void Control::set_shift(const AxisValues& shift) {
  moved_frame("the shift of the work offsets");
  space_.set_shift(shift);
}

void Control::set_frame(const Pose& frame) {
  moved_frame("the frame");
  space_.set_frame(frame);
}

void Control::set_coordinates(Coordinates coordinates) {
  moved_frame("the meaning of X Y Z");
  space_.set_coordinates(coordinates);
}

void Control::set_tcp(Tcp tcp) {
  moved_frame("TCP");
  space_.set_coordinates(tcp == Tcp::kOff ? Coordinates::kAxes : Coordinates::kWork);
  tcp_ = tcp;
}

// --- Positions
// -----------------------------------------------------------------------------------------------

int Control::require_axis(AxisWord word, int column) const {
  const int axis = axis_of(word);
  if (axis >= 0) return axis;
  std::string names;
  for (const kinematics::Axis& one : setup_.machine.axes) names += (names.empty() ? "" : " ") + one.name;
  fail(
      "axis-missing", column,
      fmt::format("the machine {} has no axis {}, it has {}", setup_.machine.name, kAxisLetters[word], names),
      "take the word out, or choose the machine that the program was posted for");
}

void Control::refresh_position() {
  if (position_valid_) return;
  const std::array<double, 3> rotary = space_.rotary_of(q_);
  const Vec3 p = space_.program_from_linear(space_.linear_of(q_), rotary);
  for (size_t i = 0; i < 3; ++i) {
    position_[i] = p[static_cast<long>(i)];
    position_[i + 3] = rotary[i] - space_.rotary_zero(static_cast<int>(i));
    if (started_) continue;
    if ((known_ >> i & 1u) == 0) position_[i] = std::nan("");
    if ((known_ >> (i + 3) & 1u) == 0) position_[i + 3] = std::nan("");
  }
  position_valid_ = started_;
}

const std::array<double, kAxisWords>& Control::position() {
  refresh_position();
  return position_;
}

Vec3 Control::position_xyz() {
  refresh_position();
  return {position_[0], position_[1], position_[2]};
}

Vec3 Control::tool_axis_P() {
  return space_.X_WP().linear().transpose() * space_.compensated(space_.rotary_of(q_)).axis_W;
}

Vec3 Control::tool_axis_at_zero_P() const {
  return space_.X_WP().linear().transpose() * space_.axis_at_zero_W();
}

void Control::flush() {
  // Without the lead-out, the tool stands beside the programmed point.
  if (contour_->leading_out()) position_valid_ = false;
  contour_->flush();
}

}  // namespace swarf::program::nc

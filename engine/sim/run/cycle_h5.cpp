#include "sim/run/cycle_h5.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/units.h"

namespace swarf::sim {
namespace {

using motion::Cycle;

constexpr hsize_t kChunk = 16384;
/// Higher levels take twice the time for a few per cent.
constexpr unsigned kDeflate = 1;

/// Once the library could not write a file, closing what belongs to it crashes (1.10): it is left open then.
bool left_open = false;

/// An open thing of the library, closed with it.
class H5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  H5Handle() = default;
  H5Handle(hid_t id, Close closing) : id_(id), close_(closing) {}
  H5Handle(H5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  H5Handle& operator=(H5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  H5Handle(const H5Handle&) = delete;
  H5Handle& operator=(const H5Handle&) = delete;
  ~H5Handle() {
    if (!left_open) close();
  }
  operator hid_t() const { return id_; }
  bool close() { return id_ < 0 || close_(std::exchange(id_, H5I_INVALID_HID)) >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// A column and the rows of it that are not in the file yet.
struct H5Column {
  std::string name, unit;
  std::function<double(const Cycle&)> number;    ///< of a column of float64
  std::function<int32_t(const Cycle&)> whole{};  ///< of one of int32 or enum
  std::vector<std::string> names{};              ///< of an enum
  H5Handle enum_type{}, dataset{};
  std::vector<double> numbers{};
  std::vector<int32_t> wholes{};

  bool is_whole() const { return whole != nullptr; }
  hid_t memory_type() const {
    return !names.empty() ? hid_t{enum_type} : is_whole() ? H5T_NATIVE_INT32 : H5T_NATIVE_DOUBLE;
  }
  hid_t file_type() const {
    return !names.empty() ? hid_t{enum_type} : is_whole() ? H5T_STD_I32LE : H5T_IEEE_F64LE;
  }
  const void* data() const {
    return is_whole() ? static_cast<const void*>(wholes.data()) : static_cast<const void*>(numbers.data());
  }
};

std::vector<H5Column> pose_columns() {
  std::vector<H5Column> columns;
  for (size_t i = 0; i < 3; ++i)
    columns.push_back({kPoseColumns[i], "mm", [i](const Cycle& cycle) {
                         return cycle.sample.pose.tip_W[static_cast<Eigen::Index>(i)];
                       }});
  for (size_t i = 0; i < 3; ++i)
    columns.push_back({kPoseColumns[i + 3], "1", [i](const Cycle& cycle) {
                         return cycle.sample.pose.axis_W[static_cast<Eigen::Index>(i)];
                       }});
  return columns;
}

H5Column column_of(const kinematics::Axis& axis, Eigen::Index index) {
  const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
  return {axis_column(axis), rotary ? "deg" : "mm",
          [axis, index](const Cycle& cycle) { return axis_column_value(axis, cycle.q[index]); }};
}

H5Column whole_column(const std::string& name, std::function<int32_t(const Cycle&)> value,
                      std::vector<std::string> names = {}) {
  H5Column column{name, "1", {}};
  column.whole = std::move(value);
  column.names = std::move(names);
  return column;
}

/// Names of tools; an enum has each only once.
std::vector<std::string> tool_names(const Job& job) {
  std::vector<std::string> names;
  for (const cutter::Cutter& tool : job.scene.tools) {
    std::string name = tool_field(tool);
    while (std::find(names.begin(), names.end(), name) != names.end()) name += "'";
    names.push_back(name);
  }
  return names;
}

std::vector<H5Column> columns_of(const Job& job, const motion::Cycles& cycles) {
  std::vector<H5Column> columns;
  const auto add = [&](H5Column column) { columns.push_back(std::move(column)); };
  const auto line = [&cycles](const Cycle& cycle) {
    return cycles.elements().line(static_cast<size_t>(cycle.sample.element));
  };
  add({"t_s", "s", [](const Cycle& cycle) { return cycle.sample.t_s; }});
  add(whole_column("block", line));
  for (H5Column& column : pose_columns()) add(std::move(column));
  add({"feed_mm_min", "mm/min", [](const Cycle& cycle) { return mm_min_from_mm_s(cycle.sample.feed_mm_s); }});
  const std::vector<kinematics::Axis>& axes = job.machine.model.axes;
  for (size_t i = 0; i < axes.size(); ++i) add(column_of(axes[i], static_cast<Eigen::Index>(i)));
  for (int i = 0; i < 3; ++i)
    add({fmt::format("contact_{}_mm", "xyz"[i]), "mm",
         [i](const Cycle& cycle) { return cycle.sample.contact_W[i]; }});
  add({"u", "1", [](const Cycle& cycle) { return cycle.sample.u; }});
  add({"v", "1", [](const Cycle& cycle) { return cycle.sample.v; }});
  add(whole_column("element", [](const Cycle& cycle) { return cycle.sample.element; }));
  add(whole_column(
      "kind", [](const Cycle& cycle) { return static_cast<int32_t>(cycle.sample.kind); }, kind_names()));
  add(whole_column(
      "tool", [](const Cycle& cycle) { return int32_t{cycle.sample.tool}; }, tool_names(job)));
  return columns;
}

class CycleH5 final : public CycleTable {
 public:
  CycleH5(const std::string& path, const Job& job, const motion::Cycles& cycles);
  void add(std::span<const Cycle> window) override;
  void finish() override;

 private:
  void require(bool done) const;
  H5Handle made(hid_t id, H5Handle::Close close) const;
  void create(H5Column& column);
  void write_text(hid_t object, const char* name, const std::string& text) const;
  void write_number(hid_t object, const char* name, double value) const;
  void flush();

  std::string path_;
  H5Handle file_;
  std::vector<H5Column> columns_;
  hsize_t rows_ = 0, waiting_ = 0;
};

CycleH5::CycleH5(const std::string& path, const Job& job, const motion::Cycles& cycles)
    : path_(path), columns_(columns_of(job, cycles)) {
  H5dont_atexit();                              // for what is left open
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are told by exceptions
  const H5Handle plan = made(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  require(H5Pset_link_creation_order(plan, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0 &&
          H5Pset_obj_track_times(plan, false) >= 0);
  file_ = made(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, plan, H5P_DEFAULT), H5Fclose);
  write_text(file_, "scene", job.scene.name);
  write_text(file_, "swarf", SWARF_VERSION);
  write_number(file_, "period_s", cycles.period_s());
  for (H5Column& column : columns_) create(column);
}

void CycleH5::require(bool done) const {
  if (done) return;
  left_open = true;
  throw unwritable_table(path_);
}

H5Handle CycleH5::made(hid_t id, H5Handle::Close close) const {
  require(id >= 0);
  return {id, close};
}

void CycleH5::create(H5Column& column) {
  if (!column.names.empty()) {
    column.enum_type = made(H5Tenum_create(H5T_STD_I32LE), H5Tclose);
    for (int32_t value = 0; value < static_cast<int32_t>(column.names.size()); ++value)
      require(H5Tenum_insert(column.enum_type, column.names[static_cast<size_t>(value)].c_str(), &value) >=
              0);
  }
  const hsize_t none = 0, most = H5S_UNLIMITED, chunk = kChunk;
  const H5Handle space = made(H5Screate_simple(1, &none, &most), H5Sclose);
  const H5Handle plan = made(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(H5Pset_chunk(plan, 1, &chunk) >= 0 && H5Pset_shuffle(plan) >= 0 &&
          H5Pset_deflate(plan, kDeflate) >= 0 && H5Pset_obj_track_times(plan, false) >= 0);
  column.dataset =
      made(H5Dcreate2(file_, column.name.c_str(), column.file_type(), space, H5P_DEFAULT, plan, H5P_DEFAULT),
           H5Dclose);
  write_text(column.dataset, "units", column.unit);
}

void CycleH5::write_text(hid_t object, const char* name, const std::string& text) const {
  const H5Handle type = made(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(type, text.size() + 1) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0);
  const H5Handle space = made(H5Screate(H5S_SCALAR), H5Sclose);
  const H5Handle attribute = made(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(H5Awrite(attribute, type, text.c_str()) >= 0);
}

void CycleH5::write_number(hid_t object, const char* name, double value) const {
  const H5Handle space = made(H5Screate(H5S_SCALAR), H5Sclose);
  const H5Handle attribute =
      made(H5Acreate2(object, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
}

/// Whole chunks reach the file, so that none is compressed twice.
void CycleH5::add(std::span<const Cycle> window) {
  while (!window.empty()) {
    const size_t count = std::min<size_t>(kChunk - waiting_, window.size());
    for (H5Column& column : columns_) {
      for (const Cycle& cycle : window.first(count)) {
        if (column.is_whole())
          column.wholes.push_back(column.whole(cycle));
        else
          column.numbers.push_back(column.number(cycle));
      }
    }
    window = window.subspan(count);
    waiting_ += count;
    if (waiting_ == kChunk) flush();
  }
}

void CycleH5::flush() {
  if (waiting_ == 0) return;
  const hsize_t total = rows_ + waiting_;
  const H5Handle memory = made(H5Screate_simple(1, &waiting_, nullptr), H5Sclose);
  for (H5Column& column : columns_) {
    require(H5Dset_extent(column.dataset, &total) >= 0);
    const H5Handle space = made(H5Dget_space(column.dataset), H5Sclose);
    require(H5Sselect_hyperslab(space, H5S_SELECT_SET, &rows_, nullptr, &waiting_, nullptr) >= 0 &&
            H5Dwrite(column.dataset, column.memory_type(), memory, space, H5P_DEFAULT, column.data()) >= 0);
    column.numbers.clear();
    column.wholes.clear();
  }
  rows_ = total;
  waiting_ = 0;
}

void CycleH5::finish() {
  flush();
  bool closed = true;
  for (H5Column& column : columns_) closed = column.dataset.close() && closed;
  closed = H5Fflush(file_, H5F_SCOPE_LOCAL) >= 0 && closed;
  require(file_.close() && closed);
}

}  // namespace

std::unique_ptr<CycleTable> open_cycle_h5(const std::string& path, const Job& job,
                                          const motion::Cycles& cycles) {
  return std::make_unique<CycleH5>(path, job, cycles);
}

}  // namespace swarf::sim

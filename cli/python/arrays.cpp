#include "cli/python/arrays.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <limits>

#include "base/units.h"
#include "sim/run/block_rows.h"
#include "sim/run/recorder.h"

namespace swarf::cli {
namespace {

namespace py = pybind11;

/// One value for each of `count` rows.
template <typename Number, typename Of>
py::array_t<Number> column(size_t count, const Of& of) {
  py::array_t<Number> array(static_cast<py::ssize_t>(count));
  auto values = array.template mutable_unchecked<1>();
  for (size_t i = 0; i < count; ++i) values(static_cast<py::ssize_t>(i)) = of(i);
  return array;
}

/// As text of equal width.
template <typename Of>
py::object text_column(size_t count, const Of& of) {
  py::list texts;
  for (size_t i = 0; i < count; ++i) texts.append(py::str(of(i)));
  return py::module_::import("numpy").attr("array")(texts, py::arg("dtype") = "str");
}

template <typename Of>
py::array_t<double> vector_column(size_t count, const Of& of) {
  py::array_t<double> array({static_cast<py::ssize_t>(count), py::ssize_t{3}});
  auto values = array.mutable_unchecked<2>();
  for (size_t i = 0; i < count; ++i) {
    const Vec3& vector = of(i);
    for (int k = 0; k < 3; ++k) values(static_cast<py::ssize_t>(i), k) = vector[k];
  }
  return array;
}

double pose_value(const ToolPose& pose, size_t k) {
  return k < 3 ? pose.tip_W[static_cast<Eigen::Index>(k)] : pose.axis_W[static_cast<Eigen::Index>(k - 3)];
}

/// A measuring ray: which face it stands on, which of its rays it is.
struct RayPlace {
  size_t face, ray;
};

std::vector<RayPlace> ray_places(const std::vector<stock::SurfaceDexels>& faces) {
  std::vector<RayPlace> places;
  for (size_t face = 0; face < faces.size(); ++face) {
    for (size_t ray = 0; ray < faces[face].heights_mm().size(); ++ray) places.push_back({face, ray});
  }
  return places;
}

int line_of(const sim::MeasuredPath& path, uint32_t block) {
  if (block >= path.rays.sources.size()) return 0;  // uncut, or by an earlier set-up
  return path.path.elements.line(static_cast<size_t>(path.rays.sources[block].element));
}

}  // namespace

py::dict block_arrays(const SceneRun& run) {
  const std::vector<sim::BlockRow> rows = sim::block_rows(*run.result.main.cycles);
  const size_t n = rows.size();
  const std::vector<std::string> kinds = sim::kind_names();
  py::dict table;
  table["line"] = column<int>(n, [&](size_t i) { return rows[i].line; });
  table["t_s"] = column<double>(n, [&](size_t i) { return rows[i].t_s; });
  for (size_t k = 0; k < sim::kPoseColumns.size(); ++k)
    table[sim::kPoseColumns[k]] = column<double>(n, [&](size_t i) { return pose_value(rows[i].pose, k); });
  const std::vector<kinematics::Axis>& axes = run.job.machine.model.axes;
  for (size_t a = 0; a < axes.size(); ++a) {
    table[sim::axis_column(axes[a]).c_str()] = column<double>(n, [&](size_t i) {
      return sim::axis_column_value(axes[a], rows[i].q[static_cast<Eigen::Index>(a)]);
    });
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  table["feed_mm_min"] =
      column<double>(n, [&](size_t i) { return mm_min_from_mm_s(rows[i].feed_mm_s.value_or(kNone)); });
  table["kind"] = text_column(n, [&](size_t i) { return kinds[static_cast<size_t>(rows[i].kind)]; });
  table["tool"] =
      text_column(n, [&](size_t i) { return sim::tool_field(run.job.scene.tools[rows[i].tool]); });
  return table;
}

py::dict ray_arrays(const SceneRun& run) {
  const std::vector<stock::SurfaceDexels>& faces = run.result.main.dexels;
  const std::vector<RayPlace> at = ray_places(faces);
  const size_t n = at.size();
  const auto of = [&](size_t i) -> const stock::SurfaceDexels& { return faces[at[i].face]; };
  py::dict table;
  table["point_mm"] = vector_column(n, [&](size_t i) -> const Vec3& { return of(i).points()[at[i].ray]; });
  table["normal"] = vector_column(n, [&](size_t i) -> const Vec3& { return of(i).normals()[at[i].ray]; });
  table["deviation_um"] =
      column<double>(n, [&](size_t i) { return um_from_mm(of(i).heights_mm()[at[i].ray]); });
  table["area_mm2"] = column<double>(n, [&](size_t i) { return of(i).field().areas_mm2[at[i].ray]; });
  table["line"] =
      column<int>(n, [&](size_t i) { return line_of(run.result.main, of(i).blocks()[at[i].ray]); });
  table["face"] = column<int>(n, [&](size_t i) { return static_cast<int>(at[i].face); });
  return table;
}

}  // namespace swarf::cli

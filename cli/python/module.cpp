// The compiled part of the Python module `swarf`; what users call stands in swarf/__init__.py.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <utility>

#include "cli/python/arrays.h"
#include "cli/python/python_progress.h"
#include "cli/python/scene_run.h"
#include "reports/metrics_json.h"

namespace py = pybind11;
using swarf::cli::PictureRequest;
using swarf::cli::RunRequest;
using swarf::cli::SceneRun;

namespace {

py::dict as_dict(const swarf::Diagnostic& one) {
  using namespace pybind11::literals;
  return py::dict("code"_a = one.code, "severity"_a = swarf::reports::severity_name(one.severity),
                  "file"_a = one.where.file, "line"_a = one.where.line, "column"_a = one.where.column,
                  "text"_a = one.text, "fix"_a = one.fix);
}

py::list as_list(const std::vector<swarf::Diagnostic>& diagnostics) {
  py::list list;
  for (const swarf::Diagnostic& one : diagnostics) list.append(as_dict(one));
  return list;
}

/// swarf.Error(text, diagnostics).
void raise(const swarf::InputError& error) {
  const py::object type = py::module_::import("swarf").attr("Error");
  PyErr_SetObject(type.ptr(), type(error.what(), as_list(error.diagnostics.list())).ptr());
}

void translate(std::exception_ptr raised) {
  try {
    if (raised) std::rethrow_exception(std::move(raised));
  } catch (const swarf::InputError& error) {
    raise(error);
  }
}

std::unique_ptr<SceneRun> run(const RunRequest& request, const py::object& told) {
  swarf::cli::PythonProgress progress(told);
  std::unique_ptr<SceneRun> done;
  try {
    const py::gil_scoped_release unlocked;
    done = swarf::cli::run_scene(request, progress);
  } catch (...) {
    progress.rethrow();  // what has stopped the run, before what came of it
    throw;
  }
  progress.rethrow();
  return done;
}

}  // namespace

PYBIND11_MODULE(_swarf, module) {
  module.attr("__version__") = SWARF_VERSION;
  py::register_local_exception_translator(translate);
  py::class_<RunRequest>(module, "RunRequest")
      .def(py::init<>())
      .def_readwrite("file", &RunRequest::file)
      .def_readwrite("toml", &RunRequest::toml)
      .def_readwrite("overrides", &RunRequest::overrides)
      .def_readwrite("output", &RunRequest::output)
      .def_readwrite("render", &RunRequest::render)
      .def_readwrite("command", &RunRequest::command)
      .def_readwrite("threads", &RunRequest::threads);
  py::class_<PictureRequest>(module, "PictureRequest")
      .def(py::init<>())
      .def_readwrite("kind", &PictureRequest::kind)
      .def_readwrite("camera", &PictureRequest::camera)
      .def_readwrite("width", &PictureRequest::width)
      .def_readwrite("height", &PictureRequest::height)
      .def_readwrite("samples", &PictureRequest::samples);
  py::class_<SceneRun>(module, "SceneRun")
      .def("metrics",
           [](const SceneRun& self) { return swarf::reports::metrics_json(self.job, self.result, {}); })
      .def("findings", [](const SceneRun& self) { return swarf::reports::findings_json(self.result); })
      .def("told", [](const SceneRun& self) { return as_list(self.told); })
      .def("blocks", &swarf::cli::block_arrays)
      .def("rays", &swarf::cli::ray_arrays)
      .def("save_picture", &swarf::cli::save_picture, py::call_guard<py::gil_scoped_release>());
  module.def("run", &run);
}

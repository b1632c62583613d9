#include "cli/python/python_progress.h"

#include <utility>

namespace swarf::cli {

namespace py = pybind11;

PythonProgress::PythonProgress(py::object told)
    : told_(std::move(told)), caller_(std::this_thread::get_id()) {}

void PythonProgress::begin(std::string_view stage, double total, std::string_view unit) {
  stage_ = stage;
  unit_ = unit;
  total_ = total;
  tell(0.0);
}

void PythonProgress::advance(double done) {
  if (due()) tell(done);
}

void PythonProgress::end() {
  tell(total_);
}

/// Signals are looked for in loops that do not advance, too.
bool PythonProgress::stop_requested() const {
  if (!stop_ && std::this_thread::get_id() == caller_ && due()) poll();
  return stop_;
}

void PythonProgress::rethrow() {
  if (error_) throw *std::exchange(error_, std::nullopt);
}

bool PythonProgress::due() const {
  constexpr std::chrono::milliseconds kApart{100};
  const Clock::time_point now = Clock::now();
  if (now < next_) return false;
  next_ = now + kApart;
  return true;
}

void PythonProgress::tell(double done) {
  poll();
  if (stop_ || told_.is_none()) return;
  const py::gil_scoped_acquire lock;
  try {
    told_(stage_, done, total_, unit_);
  } catch (const py::error_already_set& error) {
    error_ = error;
    stop_ = true;
  }
}

void PythonProgress::poll() const {
  const py::gil_scoped_acquire lock;
  if (stop_ || PyErr_CheckSignals() == 0) return;
  error_ = py::error_already_set();
  stop_ = true;
}

}  // namespace swarf::cli

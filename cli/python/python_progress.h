// Progress of a run told to a Python function, and Ctrl-C taken from Python.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "base/progress.h"

namespace swarf::cli {

/// Runs without the interpreter's lock and takes it for each call. An exception of the function, or
/// KeyboardInterrupt, stops the run and is raised behind it.
class PythonProgress final : public Progress {
 public:
  /// `told`: called as told(stage, done, total, unit) about ten times a second and at both ends of a stage;
  /// or None.
  explicit PythonProgress(pybind11::object told);

  void begin(std::string_view stage, double total, std::string_view unit) override;
  void advance(double done) override;
  void end() override;
  bool stop_requested() const override;

  /// To be called with the lock. Throws what has stopped the run.
  void rethrow();

 private:
  using Clock = std::chrono::steady_clock;
  void tell(double done);
  bool due() const;
  void poll() const;

  pybind11::object told_;
  std::thread::id caller_;
  std::string stage_, unit_;
  double total_ = 0.0;
  mutable Clock::time_point next_;  ///< read and set by the caller's thread alone
  mutable std::atomic<bool> stop_{false};
  mutable std::optional<pybind11::error_already_set> error_;
};

}  // namespace swarf::cli

// Progress and cancellation of long work. The command line draws it; the engine only reports.
#pragma once

#include <string_view>

namespace swarf {

/// Receives progress; every call but stop_requested() comes from the thread that runs the stage. The base
/// class is silent.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A stage begins; `total` is its amount of work in `unit` ("blocks", "frames").
  virtual void begin(std::string_view stage, double total, std::string_view unit);
  /// `done` of the stage's total is finished.
  virtual void advance(double done);
  /// The stage goes on from what an earlier run has done: that much took no time.
  virtual void start_at(double done);
  /// One line to be read while the work goes on: "memory: 168 MB expected, ...".
  virtual void note(std::string_view text);
  /// The stage is over.
  virtual void end();
  /// True once the user has asked to stop; long loops look at it between units of work, from any thread.
  virtual bool stop_requested() const { return false; }
};

}  // namespace swarf

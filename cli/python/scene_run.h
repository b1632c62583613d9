// A run that stays in memory: what the Python module asks of the simulation, without a word of Python.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "sim/simulation.h"

namespace swarf::cli {

/// What is to be run, and what is to be left on disk.
struct RunRequest {
  std::string file;                    ///< scene.toml; "": `toml`
  std::string toml;                    ///< a scene that stands in no file; its paths are those of the folder
  std::vector<std::string> overrides;  ///< "key=value" in TOML
  std::string output;                  ///< folder as `swarf run` leaves it; "": nothing is written
  bool render = true;                  ///< with an output folder: pictures, page and glTF
  std::string command;                 ///< how to run it again, for a shell; kept with the results
  int threads = 0;                     ///< 0: all cores
};

/// Job and result belong together: the result refers to the job.
struct SceneRun {
  sim::Job job;
  sim::Result result;
  std::vector<Diagnostic> told;  ///< warnings of the input and of the run
};

/// A stopped run has Result::stopped set, and nothing was written. Throws InputError as load_job, simulate
/// and write_run do, and "needs-scene" for a file that is no scene.toml.
std::unique_ptr<SceneRun> run_scene(const RunRequest& request, Progress& progress);

/// How a picture is taken; 0 and "": as the scene says.
struct PictureRequest {
  std::string kind = "part";  ///< machine, part, deviation, fan
  std::string camera;
  int width = 0, height = 0;  ///< pixels
  int samples = 0;            ///< rays per pixel
};

/// Draws the finished part into a .png file. Throws InputError for a kind or a camera that is not known, and
/// where the file cannot be written.
void save_picture(const SceneRun& run, const PictureRequest& request, const std::string& path);

}  // namespace swarf::cli

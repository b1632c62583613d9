// Scenes with [post]: their CL data become an NC program, which then stands for them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "avoidance/advice.h"
#include "avoidance/control.h"
#include "post/post.h"

namespace swarf::cli {

/// A program that has been written, and the scene that it belongs to.
struct PostedScene {
  avoidance::Outcome outcome;
  post::PostResult written;
  std::string post_name;
  std::vector<std::string> overrides;  ///< of the scene, so that the program runs in it
};

/// True where the scene asks for it and no program has been written yet.
bool wants_post(const sim::Job& job);

/// Writes the program into `file`, a whole path. None: the user stopped it, and nothing was written. Throws
/// InputError where none is free of collisions.
std::optional<PostedScene> post_scene(const avoidance::Task& task, const std::string& file,
                                      Progress& progress, Diagnostics& told);

/// The same with changes of the path.
struct FixedScene {
  avoidance::Advice advice;
  sim::Job job;  ///< of the changed CL data
  PostedScene posted;
};
struct FixedFiles {
  std::string cl, program;  ///< whole paths
};

/// Changes the CL data where no clamping, solution or tool helps and where they gouge the design, writes them
/// and their program, both or neither. None: the user stopped it. Throws InputError where no change helps.
std::optional<FixedScene> post_fixed_scene(const avoidance::Task& task, const FixedFiles& files,
                                           Progress& progress, Diagnostics& told);

}  // namespace swarf::cli

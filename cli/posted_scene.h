// Scenes with [post]: their CL data become an NC program, which then stands for them.
#pragma once

#include <optional>
#include <string>
#include <vector>

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

}  // namespace swarf::cli

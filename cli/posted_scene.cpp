#include "cli/posted_scene.h"

#include "base/file.h"
#include "post/shipped.h"
#include "program/nc_program.h"

namespace swarf::cli {

bool wants_post(const sim::Job& job) {
  return job.scene.post && job.scene.post->written.empty();
}

std::optional<PostedScene> post_scene(const avoidance::Task& task, const std::string& file,
                                      Progress& progress, Diagnostics& told) {
  const sim::PostSettings& settings = *task.job->scene.post;
  const std::string words = post::post_file(settings.post);
  if (words.empty())
    throw InputError("unknown-post", {task.job->scene.file}, "no post is called '" + settings.post + "'",
                     "choose " + post::shipped_list() + ", or give your own: post.words = \"my.toml\"");
  const post::PostFormat format = post::load_post(words);
  PostedScene posted;
  posted.post_name = format.name;
  posted.outcome = avoidance::control(task, progress);
  if (progress.stop_requested()) return {};
  if (!posted.outcome.found) throw InputError(avoidance::diagnostics_of(posted.outcome, *task.job));
  constexpr FileFault kFault{"program-unwritable", "the program cannot be written"};
  NewFile program(file, kFault);
  posted.written = avoidance::write_program(
      task, posted.outcome, format, [&](std::string_view text) { program.write(text); }, progress, told);
  if (progress.stop_requested()) return {};
  program.move_into_place();
  posted.overrides = avoidance::overrides_of(posted.outcome, file, program::dialect_name(format.dialect));
  return posted;
}

}  // namespace swarf::cli

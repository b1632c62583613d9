#include "cli/posted_scene.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/file.h"
#include "post/shipped.h"
#include "program/nc_program.h"

namespace swarf::cli {

namespace fs = std::filesystem;

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
  const post::PostFormat format = avoidance::format_of(settings);
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

namespace {

/// Of what no change of the path frees.
Diagnostics unfixed(const avoidance::Advice& advice, const sim::Job& job) {
  Diagnostics told;
  if (!advice.left) return told;
  told.error(
      "no-fix", {job.scene.program_file, advice.left->line, 0},
      fmt::format("no lead or tilt of up to {:g} deg and no lift of up to {:g} mm frees this block{}: {}",
                  avoidance::Advice::kLeanMostDeg, avoidance::Advice::kLiftMostMm,
                  advice.blocks.empty() ? "" : fmt::format(" ({} before it are freed)", advice.blocks.size()),
                  advice.left->text),
      "another set-up (C) or another path (D)");
  return told;
}

}  // namespace

std::optional<FixedScene> post_fixed_scene(const avoidance::Task& task, const FixedFiles& files,
                                           Progress& progress, Diagnostics& told) {
  if (fs::weakly_canonical(files.cl) == fs::weakly_canonical(task.job->scene.program_file))
    throw InputError("output-is-input", {files.cl}, "--fix would replace the CL data that it reads",
                     "name another file");
  const avoidance::Outcome before = avoidance::control(task, progress);
  FixedScene fixed;
  fixed.advice = avoidance::advise(task, before, progress);
  if (progress.stop_requested()) return {};
  if (!fixed.advice.free) throw InputError(unfixed(fixed.advice, *task.job));
  NewFile cl(files.cl, {"cl-unwritable", "the changed CL data cannot be written"});
  cl.write(fixed.advice.text);
  cl.move_into_place();
  const std::string key = fmt::format("cl=\"{}\"", files.cl);
  const auto load = [&](std::vector<std::string> more) {
    more.push_back(key);
    return task.load(more);
  };
  std::optional<PostedScene> posted;
  try {
    fixed.job = load({});
    posted = post_scene({&fixed.job, load}, files.program, progress, told);
  } catch (...) {
    fs::remove(files.cl);
    throw;
  }
  if (!posted) {
    fs::remove(files.cl);
    return {};
  }
  fixed.posted = std::move(*posted);
  fixed.posted.overrides.push_back(key);
  return fixed;
}

}  // namespace swarf::cli

// swarf: the command line. Exit codes are in commands.h.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <ios>
#include <new>
#include <string>
#include <vector>

#include "base/check.h"
#include "base/diagnostics.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "cli/version.h"

namespace {

const char* const kFooter = R"(Examples:
  swarf run part.nc --tool 6                                 any program, at once: the rest is assumed and said
  swarf init part.nc --tool 6 -o job                         the scene of that, to be changed: job/scene.toml
  swarf run scenes/lin_koren_dome/scene.toml -o out/dome     simulate, measure, render, report
  swarf run scene.toml --set stock.voxel_mm=0.1 --no-render  one key changed, numbers only
  swarf run scene.toml --save-stock-after 13,12.5s           stocks after program line 13 and after 12.5 s
  swarf run scene.toml --from out/dome/stock.vdb             go on from a saved or stopped stock
  swarf replay out/dome/run.record                           does the scene still cut the same, block by block?
  swarf check scene.toml program.nc machine.toml             find what is wrong, run nothing
  swarf compare out/dome/stock.vdb scene.toml                a finished stock against its design
  swarf render out/dome --still part.png --camera left       pictures without simulating again
  swarf export out/dome --stl part.stl                       meshes without simulating again

Exit codes: 0 no check of the verdict fails or is open; 1 findings (gouge, scallop, travel, ...); 2 the input is wrong;
3 internal error; 130 stopped with Ctrl-C (what is finished is kept).)";

/// "runn" is no command: the nearest one is named. Throws InputError.
void check_command_word(const CLI::App& app, int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "-";
  if (word.starts_with('-')) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::string near = swarf::nearest_name(word, names);
  throw swarf::InputError("unknown-command", {"swarf " + word}, "there is no such command",
                          near.empty()
                              ? fmt::format("one of {}; 'swarf --help' explains them", fmt::join(names, ", "))
                              : fmt::format("did you mean 'swarf {}'?", near));
}

/// "--toool" is no option of the command: the nearest one is named. Throws InputError where a word is none.
void check_option_words(const CLI::App& app, const CLI::ExtrasError& error, int argc, char** argv) {
  if (argc < 2) return;
  const std::vector<const CLI::App*> commands =
      app.get_subcommands([&](const CLI::App* one) { return one->get_name() == argv[1]; });
  if (commands.empty()) return;
  const CLI::App* const command = commands.front();
  std::vector<std::string> names;
  for (const CLI::App* one : {command, &app}) {
    for (const CLI::Option* option : one->get_options({}))
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i], name = word.substr(0, word.find('='));
    if (!name.starts_with("--") || name == "--") continue;
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    if (std::string(error.what()).find(name) == std::string::npos) continue;  // what stands behind an option
    const std::string near = swarf::nearest_name(name, names);
    const std::string help = fmt::format("'swarf {} --help' lists them", argv[1]);
    throw swarf::InputError("unknown-option", {fmt::format("swarf {} {}", argv[1], name)},
                            "there is no such option",
                            near.empty() ? help : fmt::format("did you mean '{}'? {}", near, help));
  }
}

void parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError& error) {
    check_option_words(app, error, argc, argv);
    throw;
  }
}

int guarded(CLI::App& app, int argc, char** argv, const int& exit_code) {
  try {
    check_command_word(app, argc, argv);
    parse(app, argc, argv);
    return exit_code;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? swarf::cli::kPass : swarf::cli::kBadInput;
  } catch (const swarf::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return swarf::cli::kBadInput;
  } catch (const std::filesystem::filesystem_error& error) {
    fmt::print(stderr, "error: {}\n    fix: check that the folder exists and may be written\n", error.what());
    return swarf::cli::kBadInput;
  } catch (const std::ios_base::failure& error) {
    fmt::print(stderr, "error: {}\n    fix: name files that can be read, and places with space\n",
               error.what());
    return swarf::cli::kBadInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: out of memory\n    fix: raise stock.voxel_mm or free memory\n");
    return swarf::cli::kInternalError;
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return swarf::cli::kBadInput;  // a full disk behind a pipe: main says so
    fmt::print(stderr, "internal error: {}\n    please report it with the scene\n", error.what());
    return swarf::cli::kInternalError;
  }
}

/// What was printed has to arrive: a pipeline reads it.
int checked_output(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  fmt::print(
      stderr, "{}\n",
      swarf::InputError("cannot-write", {"standard output"}, "not all that was printed could be written",
                        "name a file or a pipe with space")
          .what());
  return std::max<int>(exit_code, swarf::cli::kBadInput);
}

}  // namespace

int main(int argc, char** argv) {
  swarf::cli::catch_interrupt();  // first of all: before it the loader alone has worked
  CLI::App app{
      "Swarf: headless, visual 5-axis NC simulator. A program goes in; a measured, rendered report comes "
      "out."};
  app.set_version_flag("--version", swarf::cli::version_text());
  app.fallthrough();  // -q and the like may stand behind the command
  swarf::cli::Manner manner;
  app.add_flag("-q,--quiet", manner.quiet, "say only errors, warnings, findings and the verdict");
  app.add_flag("-v,--verbose", manner.verbose, "print every finding, not only the first five of each code");
  app.add_flag_callback(
      "--no-progress", [&manner] { manner.progress = false; }, "no lines about the work's progress");
  app.parse_complete_callback([&manner] { swarf::cli::set_manner(manner); });
  app.require_subcommand(1);
  app.footer(kFooter);
  int exit_code = swarf::cli::kPass;
  swarf::cli::add_run(app, exit_code);
  swarf::cli::add_batch(app, exit_code);
  swarf::cli::add_init(app, exit_code);
  swarf::cli::add_machines(app, exit_code);
  swarf::cli::add_show(app, exit_code);
  swarf::cli::add_replay(app, exit_code);
  swarf::cli::add_check(app, exit_code);
  swarf::cli::add_plan(app, exit_code);
  swarf::cli::add_post(app, exit_code);
  swarf::cli::add_compare(app, exit_code);
  swarf::cli::add_render(app, exit_code);
  swarf::cli::add_export(app, exit_code);
  swarf::cli::add_manual(app);
  return checked_output(guarded(app, argc, argv, exit_code));
}

#include "cli/manual.h"

#include <fmt/format.h>

#include <memory>
#include <vector>

#include "cli/commands.h"

namespace swarf::cli {
namespace {

/// Text as troff takes it: a backslash, a dash that stays a dash, no line that begins a request.
std::string troff(const std::string& text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) out += "\\&";
    line_start = c == '\n';
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

/// Lines as they stand: examples and tables.
std::string as_it_stands(const std::string& text) {
  return text.empty() ? "" : ".PP\n.nf\n" + troff(text) + "\n.fi\n";
}

std::vector<const CLI::Option*> long_options(const CLI::App& command) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional() && !option->get_lnames().empty()) options.push_back(option);
  }
  return options;
}

std::string option_text(const CLI::Option& option) {
  const std::string value =
      option.get_expected_min() > 0 ? " \\fI" + troff(option.get_type_name()) + "\\fR" : "";
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", troff(option.get_name(false, true)), value,
                     troff(option.get_description()));
}

std::string command_text(const CLI::App& command) {
  std::string text =
      fmt::format(".SS swarf {}\n{}\n", troff(command.get_name()), troff(command.get_description()));
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional())
      text += fmt::format(".TP\n\\fI{}\\fR\n{}\n", troff(option->get_name(true)),
                          troff(option->get_description()));
  }
  for (const CLI::Option* option : long_options(command)) text += option_text(*option);
  return text + as_it_stands(command.get_footer());
}

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_name().empty(); });
}

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH SWARF 1 \"\" \"swarf {}\" \"User Commands\"\n.SH NAME\nswarf \\- headless, visual 5\\-axis NC "
      "simulator\n"
      ".SH SYNOPSIS\n.B swarf\n\\fICOMMAND\\fR [\\fIARGUMENTS\\fR]\n.SH DESCRIPTION\n{}\n.SH COMMANDS\n",
      SWARF_VERSION, troff(app.get_description()));
  for (const CLI::App* command : shown_commands(app)) text += command_text(*command);
  text += ".SH OPTIONS OF ALL COMMANDS\n";
  for (const CLI::Option* option : long_options(app)) text += option_text(*option);
  return text + ".SH EXAMPLES AND EXIT STATUS\n" + as_it_stands(app.get_footer());
}

std::string bash_completions(const CLI::App& app) {
  std::string names, cases;
  for (const CLI::App* command : shown_commands(app)) {
    names += (names.empty() ? "" : " ") + command->get_name();
    std::string options;
    for (const CLI::Option* option : long_options(*command)) {
      for (const std::string& name : option->get_lnames()) options += (options.empty() ? "--" : " --") + name;
    }
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), options);
  }
  return fmt::format(R"(# Completions of swarf for bash: source this file, or keep it as
# ~/.local/share/bash-completion/completions/swarf
_swarf() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} words=""
  if [ "$COMP_CWORD" = 1 ]; then
    COMPREPLY=($(compgen -W "{}" -- "$current"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  case $current in
    -*) COMPREPLY=($(compgen -W "$words" -- "$current")) ;;
    *) COMPREPLY=($(compgen -f -- "$current")) ;;
  esac
}}
complete -o filenames -F _swarf swarf
)",
                     names, cases);
}

void add_manual(CLI::App& app) {
  auto form = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "manual", "Print the manual page (man) or completions for bash (bash): swarf manual man | man -l -");
  command->add_option("form", *form, "man or bash")->required()->check(CLI::IsMember({"man", "bash"}));
  command->callback(
      [form, &app] { fmt::print("{}", *form == "man" ? man_page(app) : bash_completions(app)); });
}

}  // namespace swarf::cli

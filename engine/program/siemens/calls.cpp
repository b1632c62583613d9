// Subprograms and repeated parts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "program/siemens/flow_steps.h"

namespace swarf::program::nc::siemens {
namespace {

namespace fs = std::filesystem;

constexpr size_t kNestedMax = 200;

/// "name.spf" or "name.mpf" in the folder, whatever its case; "" when there is none.
std::string file_named(const std::string& folder, const std::string& name) {
  std::error_code problem;
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, problem)) {
    const std::string file = capitals(entry.path().filename().string());
    if (file == name + ".SPF" || file == name + ".MPF") found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end(), [](const std::string& a, const std::string& b) {
    return std::make_pair(capitals(a).ends_with("MPF"), a) < std::make_pair(capitals(b).ends_with("MPF"), b);
  });
  return found.empty() ? "" : found.front();
}

/// The index in sources_ of the program with this name; -1: there is no such file.
int loaded(Programs& programs, Counts& counts, const std::string& name) {
  auto [entry, fresh] = programs.found.try_emplace(name);
  if (fresh) {
    std::vector<std::string> folders = {fs::path(programs.sources[0]->path()).parent_path().string()};
    folders.insert(folders.end(), programs.folders.begin(), programs.folders.end());
    for (size_t n = 0; n < folders.size() && entry->second.empty(); ++n) {
      entry->second = file_named(folders[n], name);
    }
  }
  const std::string& path = entry->second;
  if (path.empty()) return -1;
  for (size_t n = 0; n < programs.sources.size(); ++n) {
    if (programs.sources[n]->path() == path) return static_cast<int>(n);
  }
  programs.sources.push_back(std::make_unique<Source>(path));
  counts.lines += programs.sources.back()->lines();
  return static_cast<int>(programs.sources.size()) - 1;
}

void call_here(Flow& flow, TokenReader& reader, const std::string& name, size_t offset) {
  const int file = loaded(flow.programs, flow.counts, name);
  if (file < 0) {
    std::vector<std::string> known = flow.target.names();
    for (const std::string& variable : flow.variables.names()) known.push_back(variable);
    const std::string near = nearest_name(name, known);
    refuse(
        reader.line(), offset, "unknown-word",
        fmt::format("{} is neither a word that is read, nor a variable, nor the name of a program", name),
        !near.empty()
            ? fmt::format("did you mean {}?", near)
            : fmt::format("put {}.spf into the program's folder or one of subprogram_folders; a program of "
                          "the machine's builder that moves nothing is named in builder_words",
                          name));
  }
  call(flow, file, &reader, {}, 1);
}

/// The values in the parentheses of a call; places that are left out have none.
std::vector<Argument> read_arguments(Variables& variables, TokenReader& reader) {
  std::vector<Argument> arguments;
  if (!reader.skip("(") || reader.skip(")")) return arguments;
  do {
    Argument argument;
    argument.offset = reader.offset();
    if (!reader.peek().symbol(",") && !reader.peek().symbol(")")) {
      const Token& name = reader.peek();
      const bool variable = name.kind == TokenKind::kName && variables.find(name.name) != nullptr;
      const size_t start = reader.position();
      argument.value = evaluate(reader, variables);
      if (variable && reader.position() == start + 1) argument.variable = name.name;
    }
    arguments.push_back(std::move(argument));
  } while (reader.skip(","));
  reader.expect(")", "the arguments");
  return arguments;
}

/// NAME(REAL A, VAR INT B, STRING[10] C, REAL D=5) after PROC.
std::vector<Parameter> read_parameters(Flow& flow, TokenReader& reader) {
  std::vector<Parameter> parameters;
  if (!reader.done()) reader.next();
  if (reader.skip("(") && !reader.skip(")")) {
    do {
      Parameter parameter;
      parameter.returned = reader.skip("VAR");
      parameter.type = read_type(reader);
      if (parameter.type == Type::kString && reader.peek().symbol("["))
        evaluate_indices(reader, flow.variables);
      const Token& name = reader.peek();
      if (name.kind != TokenKind::kName) {
        refuse(reader.line(), reader.offset(), "bad-block", "the name of a parameter is missing",
               "PROC NAME(REAL WIDTH)");
      }
      parameter.name = reader.next().name;
      parameters.push_back(std::move(parameter));
    } while (reader.skip(","));
    reader.expect(")", "the parameters");
  }
  for (const char* word : {"DISPLOF", "DISPLON", "SBLOF"}) {
    if (reader.skip(word)) flow.target.note(word, "", source(flow).path(), flow.line.current + 1);
  }
  if (!reader.done()) {
    refuse(reader.line(), reader.offset(), "unsupported-word",
           fmt::format("{} of PROC is not supported", reader.peek().text), "PROC NAME(REAL WIDTH) is");
  }
  return parameters;
}

/// Declares the parameters of PROC in the new level and gives them the values of the call.
void bind(Flow& flow, Level& level, TokenReader* arguments, const std::vector<Value>& values) {
  Source& called = *flow.programs.sources[static_cast<size_t>(level.file)];
  std::vector<Token> tokens;
  int entry = -1;
  for (int index = 0; index < called.lines() && entry < 0; ++index) {
    if (called.line(index).text.starts_with('%')) continue;
    lex(called.line(index), tokens);
    const size_t first =
        !tokens.empty() && tokens[0].kind == TokenKind::kAddress && tokens[0].letter == 'N' ? 1 : 0;
    if (tokens.size() > first) entry = tokens[first].named("PROC") ? index : -2;
  }
  std::vector<Argument> given;
  if (arguments != nullptr) {
    given = read_arguments(flow.variables, *arguments);
  } else {
    for (const Value& value : values) given.push_back({value, {}, 0});
  }
  const LineRef& from = flow.line.running;
  if (entry < 0) {
    if (given.empty()) return;
    refuse(from, given[0].offset, "wrong-arguments",
           fmt::format("{} has no PROC and takes no arguments", called.path()),
           "call it without parentheses");
  }
  level.entry = entry;
  const LineRef head = called.line(entry);
  TokenReader reader(head, tokens);
  while (!reader.skip("PROC")) reader.next();
  const std::vector<Parameter> parameters = read_parameters(flow, reader);
  if (given.size() > parameters.size()) {
    refuse(
        from, given.back().offset, "wrong-arguments",
        fmt::format("{} takes {} argument(s), {} are given", called.path(), parameters.size(), given.size()),
        "leave the others out");
  }
  flow.variables.enter(*level.scope);
  for (size_t n = 0; n < parameters.size(); ++n) {
    const Parameter& parameter = parameters[n];
    Variable variable;
    variable.type = parameter.type;
    variable.text_max = 200;
    Variable& made = flow.variables.declare(parameter.name, std::move(variable), head, 0);
    const bool has = n < given.size() && given[n].value;
    if (has) made.values[0] = converted(*given[n].value, parameter.type, from, given[n].offset);
    if (!parameter.returned) continue;
    if (!has || given[n].variable.empty()) {
      flow.variables.enter(*top(flow).scope);
      refuse(from, n < given.size() ? given[n].offset : 0, "wrong-arguments",
             fmt::format("{} is handed back (VAR) and needs a variable", parameter.name),
             "write the name of a declared variable");
    }
    level.returned.push_back({parameter.name, given[n].variable});
  }
}

}  // namespace

/// PROC was read when the program was called; the main program may have one without parameters.
void on_proc(Flow& flow, TokenReader& reader) {
  if (flow.line.current == top(flow).entry) return;
  if (!flow.levels.called() && reader.peek().kind == TokenKind::kName && !reader.peek(1).symbol("(")) return;
  refuse(reader.line(), 0, "bad-block", "PROC stands in the first block of a program that is called",
         "the program that is run has no parameters");
}

void on_extern(Flow& flow, TokenReader& reader) {
  flow.target.note("EXTERN", std::string(reader.line().text), source(flow).path(), flow.line.current + 1);
}

/// Calls the program whose name stands here: NAME, NAME(1,2), L100 P3. False: it is another word.
bool subprogram_here(Flow& flow, TokenReader& reader) {
  const Token& token = reader.peek();
  std::string name;
  if (token.kind == TokenKind::kName && !reader.peek(1).symbol("=") && !reader.peek(1).symbol("[") &&
      !flow.target.knows(token.name) && flow.variables.find(token.name) == nullptr) {
    name = token.name;
  }
  if (token.kind == TokenKind::kAddress && token.letter == 'L' && token.whole) name = capitals(token.text);
  if (name.empty()) return false;
  if (flow.target.takes_builders(name, reader.line())) return true;  // with its arguments
  reader.next();
  call_here(flow, reader, name, token.offset);
  return true;
}

/// CALL "NAME", CALL NAME, EXTCALL("FOLDER/NAME.SPF").
void on_call(Flow& flow, TokenReader& reader) {
  const size_t offset = reader.offset();
  const Token& token = reader.peek();
  const bool variable = token.kind == TokenKind::kName && flow.variables.find(token.name) != nullptr;
  std::string name;
  if (token.kind == TokenKind::kString || token.symbol("(") || variable) {
    name = capitals(converted(evaluate(reader, flow.variables), Type::kString, reader.line(), offset).text);
  } else if (token.kind == TokenKind::kName || token.kind == TokenKind::kAddress) {
    name = capitals(reader.next().text);
  }
  // Folders belong to the control: files are looked for beside the program.
  if (const size_t folder = name.find_last_of("/\\"); folder != std::string::npos) name.erase(0, folder + 1);
  if (name.starts_with("_N_")) name.erase(0, 3);
  for (const char* end : {".SPF", ".MPF", "_SPF", "_MPF"}) {
    if (name.ends_with(end)) name.resize(name.size() - 4);
  }
  const int file = name.empty() ? -1 : loaded(flow.programs, flow.counts, name);
  if (file < 0) {
    refuse(reader.line(), offset, "unknown-subprogram", fmt::format("there is no program '{}'", name),
           "put NAME.spf into the program's folder or one of subprogram_folders");
  }
  call(flow, file, &reader, {}, 1);
}

/// MCALL NAME(...) calls after each block with a move; MCALL alone ends that. MCALL CYCLE81(...) belongs to
/// the target.
void on_mcall(Flow& flow, TokenReader& reader) {
  const Token& token = reader.peek();
  if (reader.done() || flow.target.knows(token.name)) {
    flow.modal = {};
    flow.target.block(reader, flow.variables);
    return;
  }
  const std::string name = capitals(token.text);
  const size_t offset = reader.offset();
  reader.next();
  const int file = loaded(flow.programs, flow.counts, name);
  if (file < 0) {
    refuse(reader.line(), offset, "unknown-subprogram", fmt::format("there is no program '{}'", name),
           "put NAME.spf into the program's folder or one of subprogram_folders");
  }
  flow.modal = {file, {}, flow.levels.size()};
  if (reader.skip("(") && !reader.skip(")")) {
    do {
      flow.modal.arguments.push_back(evaluate(reader, flow.variables));
    } while (reader.skip(","));
    reader.expect(")", "the arguments");
  }
  finish_block(reader, "MCALL");
}

void call(Flow& flow, int file, TokenReader* arguments, const std::vector<Value>& values, int times) {
  const LineRef& from = flow.line.running;
  const size_t programs = flow.levels.count([](const Level& level) { return !level.part; });
  if (static_cast<int>(programs) >= flow.limits.levels_max) {
    refuse(from, from.text.find_first_not_of(" \t"), kRecursionLimit,
           fmt::format("the control has {} program levels", flow.limits.levels_max),
           "check for a program that calls itself");
  }
  Level level;
  level.file = file;
  level.stop = flow.programs.sources[static_cast<size_t>(file)]->lines();
  level.again = times - 1;
  level.scope = std::make_shared<Scope>();
  bind(flow, level, arguments, values);
  if (arguments != nullptr) {
    if (arguments->peek().kind == TokenKind::kAddress && arguments->peek().letter == 'P') {
      const Token& count = arguments->next();
      if (!count.whole || count.number < 1 || count.number > 9999) {
        refuse(from, count.offset, "out-of-range", "a program is called 1 to 9999 times", "write P3");
      }
      level.again = static_cast<int>(count.number) - 1;
    }
    finish_block(*arguments, "the call");
  }
  flow.levels.enter(std::move(level));
  flow.variables.enter(*top(flow).scope);
}

void enter_contour(Flow& flow) {
  const ContourName asked = flow.target.contour_asked();
  const LineRef& from = flow.line.running;
  std::vector<std::string> names{""};
  for (const char c : capitals(asked.text)) {
    if (c == ':')
      names.emplace_back();
    else if (c != ' ')
      names.back() += c;
  }
  const auto missing = [&](const char* code, const std::string& what) {
    refuse(from, asked.offset, code, fmt::format("the contour '{}': there is no {}", asked.text, what),
           "name a program, or the labels of its first and last block: \"PART\", \"FIRST:LAST\", "
           "\"PROGRAM:FIRST:LAST\"");
  };
  if (names.size() > 3 || std::find(names.begin(), names.end(), "") != names.end())
    missing("bad-contour", "such form of names");
  int file = top(flow).file;
  if (names.size() != 2) file = loaded(flow.programs, flow.counts, names[0]);
  if (file < 0) missing("unknown-subprogram", fmt::format("program {}.spf", names[0]));
  if (names.size() != 2) {
    call(flow, file, nullptr, {}, 1);
  } else {
    Level part;
    part.part = true;
    part.file = file;
    part.scope = top(flow).scope;
    flow.levels.enter(std::move(part));
  }
  Level& level = top(flow);
  level.contour = true;
  if (names.size() == 1) return;
  Source& text = *flow.programs.sources[static_cast<size_t>(file)];
  const std::string &first = names[names.size() - 2], &last = names.back();
  const std::optional<int> begin = text.find_label(first, 0, 1);
  const std::optional<int> end = begin ? text.find_label(last, *begin, 1) : std::nullopt;
  if (!begin) missing("unknown-label", "label " + first);
  if (!end) missing("unknown-label", fmt::format("label {} at or behind {}", last, first));
  level.first = level.next = *begin;
  level.stop = *end + 1;
}

/// REPEAT LABEL P=3, REPEAT FIRST LAST P=3, REPEATB LABEL P=3; REPEAT alone opens REPEAT ... UNTIL.
void on_repeat(Flow& flow, TokenReader& reader) {
  const bool block = flow.line.tokens[reader.position() - 1].name == "REPEATB";
  if (reader.done()) {
    if (block)
      refuse(reader.line(), reader.offset(), "bad-block", "REPEATB needs a label", "write REPEATB LABEL P=2");
    source(flow).partner(flow.line.current);
    return;
  }
  const auto find = [&] {
    const Token& label = reader.peek();
    const size_t offset = reader.offset();
    std::optional<int> index;
    if (label.kind == TokenKind::kName) index = source(flow).find_label(label.name, flow.line.current, -1);
    if (!index) {
      refuse(reader.line(), offset, "unknown-label",
             fmt::format("there is no label {} before this block", label.text),
             "a part that is repeated stands before REPEAT");
    }
    reader.next();
    return *index;
  };
  Level part;
  part.part = true;
  part.file = top(flow).file;
  part.scope = top(flow).scope;
  part.first = find();
  part.stop = block ? part.first + 1 : flow.line.current;
  if (!block && reader.peek().kind == TokenKind::kName && reader.peek().name != "P") {
    part.stop = find() + 1;
  } else if (const auto end = source(flow).find_label("ENDLABEL", part.first, 1);
             !block && end && *end < flow.line.current) {
    part.stop = *end;
  }
  int times = 1;
  if (reader.skip("P")) {
    reader.expect("=", "P");
    const size_t offset = reader.offset();
    const double count = evaluate_number(reader, flow.variables);
    if (count != std::floor(count) || count < 0 || count > 9999) {
      refuse(reader.line(), offset, "out-of-range", "a part is repeated 0 to 9999 times", "write P=3");
    }
    times = static_cast<int>(count);
  }
  finish_block(reader, "REPEAT");
  if (times == 0) return;
  if (flow.levels.size() >= kNestedMax) {
    refuse(reader.line(), 0, kRecursionLimit, "repeated parts are nested too deeply",
           "a part that repeats itself never ends");
  }
  part.next = part.first;
  part.again = times - 1;
  flow.levels.enter(std::move(part));
}

}  // namespace swarf::program::nc::siemens

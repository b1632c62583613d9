#include "program/control/report.h"

#include <fmt/format.h>

#include <algorithm>

namespace swarf::program::nc {

int Report::enter_file(const std::string& path) {
  auto& files = summary.files;
  const auto found = std::find(files.begin(), files.end(), path);
  if (found != files.end()) return static_cast<int>(found - files.begin());
  files.push_back(path);
  return static_cast<int>(files.size()) - 1;
}

std::string Report::file_name(const Place& where) const {
  const auto file = static_cast<size_t>(where.file);
  return file < summary.files.size() ? summary.files[file] : std::string();
}

void Report::fail_at(const SourceLocation& where, std::string code, std::string text, std::string fix) {
  throw InputError(std::move(code), where, std::move(text), std::move(fix));
}

void Report::fail(const char* code, int column, std::string text, std::string fix) const {
  fail_at({file_name(place), place.line, column > 0 ? column : place.column}, code, std::move(text),
          std::move(fix));
}

void Report::warn_once(const char* code, int column, std::string text, std::string fix) {
  if (std::find(warned_.begin(), warned_.end(), code) != warned_.end()) return;
  warned_.emplace_back(code);
  diagnostics.warning(code, {file_name(place), place.line, column > 0 ? column : place.column},
                      std::move(text), std::move(fix));
}

bool Report::take_builder_word(const std::string& word) {
  const auto found = builder_words_.find(word);
  if (found == builder_words_.end()) return false;
  without_effect(fmt::format("{} ({})", word, found->second));
  note(word, found->second);
  return true;
}

void Report::without_effect(std::string_view word) {
  auto& functions = summary.functions;
  if (std::find(functions.begin(), functions.end(), word) == functions.end()) functions.emplace_back(word);
}

void Report::note(std::string_view word, std::string_view text) {
  sink.note({std::string(word), std::string(text), place.file, place.line});
}

}  // namespace swarf::program::nc

#include "base/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace swarf {
namespace {

std::string_view word_for(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      return "error";
  }
  return "error";
}

std::string summary(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics.list()) {
    if (!text.empty()) text += '\n';
    text += format(diagnostic);
  }
  return text;
}

Diagnostics one_error(std::string code, SourceLocation where, std::string text, std::string fix) {
  Diagnostics diagnostics;
  diagnostics.error(std::move(code), std::move(where), std::move(text), std::move(fix));
  return diagnostics;
}

/// Levenshtein distance, one row at a time.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substitute = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substitute, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string format(const Diagnostic& diagnostic) {
  std::string place = diagnostic.where.file;
  if (diagnostic.where.line > 0) place += fmt::format(":{}", diagnostic.where.line);
  if (diagnostic.where.line > 0 && diagnostic.where.column > 0)
    place += fmt::format(":{}", diagnostic.where.column);
  if (!place.empty()) place += ": ";
  std::string text =
      fmt::format("{}{}: {} [{}]", place, word_for(diagnostic.severity), diagnostic.text, diagnostic.code);
  if (!diagnostic.fix.empty()) text += fmt::format("\n    fix: {}", diagnostic.fix);
  return text;
}

void Diagnostics::error(std::string code, SourceLocation where, std::string text, std::string fix) {
  list_.push_back({std::move(code), Severity::kError, std::move(where), std::move(text), std::move(fix)});
  ++errors_;
}

void Diagnostics::warning(std::string code, SourceLocation where, std::string text, std::string fix) {
  list_.push_back({std::move(code), Severity::kWarning, std::move(where), std::move(text), std::move(fix)});
}

void Diagnostics::note(std::string code, SourceLocation where, std::string text) {
  list_.push_back({std::move(code), Severity::kNote, std::move(where), std::move(text), ""});
}

void Diagnostics::append(const Diagnostics& others) {
  list_.insert(list_.end(), others.list_.begin(), others.list_.end());
  errors_ += others.errors_;
}

void Diagnostics::throw_if_errors() const {
  if (has_errors()) throw InputError(*this);
}

InputError::InputError(Diagnostics found)
    : std::runtime_error(summary(found)), diagnostics(std::move(found)) {}

InputError::InputError(std::string code, SourceLocation where, std::string text, std::string fix)
    : InputError(one_error(std::move(code), std::move(where), std::move(text), std::move(fix))) {}

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  // A third of the letters may differ, at least two; but at most half, or short words would resemble
  // anything.
  const size_t limit = std::min(std::max<size_t>(2, word.size() / 3), std::max<size_t>(1, word.size() / 2));
  size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace swarf

// The one way in which the readers of NC programs speak: faults, warnings, notes, each at the current place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "program/control/dialect_words.h"
#include "program/control/target.h"
#include "program/nc_program.h"

namespace swarf::program::nc {

/// Thrown where the sink wants no more moves; run_nc catches it.
struct ProgramStopped {};

class Report {
 public:
  /// All references must outlive the report.
  Report(const BuilderWords& builder_words, NcSink& moves, Diagnostics& told, NcSummary& read)
      : sink(moves), diagnostics(told), summary(read), builder_words_(builder_words) {}

  /// Which block is being executed; every fault and move carries it. `file`: index into NcSummary::files.
  void at(int file, int line, int column) { place = {file, line, column}; }
  /// The index of this file in NcSummary::files, added when it is new.
  int enter_file(const std::string& path);
  /// The file of a place; "" before the first one is entered.
  std::string file_name(const Place& where) const;
  /// A fault in the current block, thrown as InputError: run_nc reports it and stops the program there, as a
  /// control does. `column` 0: the column of at().
  [[noreturn]] void fail(const char* code, int column, std::string text, std::string fix) const;
  /// The same at a place that a reader of texts knows: every fault of the readers is thrown here.
  [[noreturn]] static void fail_at(const SourceLocation& where, std::string code, std::string text,
                                   std::string fix);
  /// A warning that is given once per `code` and program.
  void warn_once(const char* code, int column, std::string text, std::string fix);
  /// True for a word of ControlSetup::builder_words, as builder_word() gives it: it is listed.
  bool take_builder_word(const std::string& word);
  /// A word that was read and has no effect on the geometry: listed once in NcSummary::functions.
  void without_effect(std::string_view word);
  void note(std::string_view word, std::string_view text);

  NcSink& sink;
  Diagnostics& diagnostics;
  NcSummary& summary;
  /// What remedies call things; the words of letter dialects unless the dialect says otherwise.
  DialectWords words;
  Place place;

 private:
  const BuilderWords& builder_words_;
  std::vector<std::string> warned_;
};

}  // namespace swarf::program::nc

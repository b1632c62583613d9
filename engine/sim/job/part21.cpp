#include "sim/job/part21.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "program/source_text.h"

namespace swarf::sim {
namespace {

constexpr std::string_view kP21Head = "ISO-10303-21";

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

class P21Reader {
 public:
  P21Reader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  P21Records run() {
    skip_blanks();
    if (!text_.substr(at_).starts_with(kP21Head))
      fail("the file does not begin with ISO-10303-21", "export the tools again as ISO 13399, .p21");
    while (skip_blanks()) {
      if (text_[at_] == '#') {
        read_record();
      } else {
        skip_statement();
      }
    }
    return std::move(records_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& fix) const {
    throw InputError("bad-tool-library", {path_, line_, 0}, what, fix);
  }

  bool ends() const { return at_ >= text_.size(); }

  void step() {
    if (text_[at_] == '\n') ++line_;
    ++at_;
  }

  /// Blanks and comments; false at the end of the file.
  bool skip_blanks() {
    while (!ends()) {
      if (text_.substr(at_).starts_with("/*")) {
        skip_comment();
      } else if (static_cast<unsigned char>(text_[at_]) <= ' ') {
        step();
      } else {
        return true;
      }
    }
    return false;
  }

  void skip_comment() {
    const size_t end = text_.find("*/", at_ + 2);
    if (end == text_.npos) fail("a comment does not end", "the file is cut off: export it again");
    while (at_ < end + 2) step();
  }

  /// Between apostrophes; two of them are one.
  std::string read_text() {
    const int begun = line_;
    std::string text;
    for (++at_; !ends(); step()) {
      if (text_[at_] == '\'') {
        if (!text_.substr(at_ + 1).starts_with('\'')) {
          ++at_;
          return text;
        }
        ++at_;
      }
      if (text_[at_] != '\n' && text_[at_] != '\r') text += text_[at_];
    }
    line_ = begun;
    fail("a text does not end", "the file is cut off: export it again");
  }

  int64_t read_reference() {
    int64_t id = 0;
    ++at_;
    const auto [next, failure] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), id);
    if (failure != std::errc()) fail("# stands without the number of a record", "export the file again");
    at_ = static_cast<size_t>(next - text_.data());
    return id;
  }

  std::string read_word() {
    std::string word;
    for (; !ends() && is_word(text_[at_]); ++at_)
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_])));
    return word;
  }

  /// A number, a word or a sign.
  void read_other(P21Record& record) {
    const size_t sign = text_[at_] == '+' ? at_ + 1 : at_;
    double value = 0.0;
    const char* const end = text_.data() + text_.size();
    const auto [next, failure] = std::from_chars(text_.data() + sign, end, value);
    if (failure == std::errc() && !std::isalpha(static_cast<unsigned char>(text_[at_]))) {
      record.numbers.push_back(value);
      at_ = static_cast<size_t>(next - text_.data());
    } else if (read_word().empty()) {
      step();
    }
  }

  void read_record() {
    P21Record record;
    record.line = line_;
    const int64_t id = read_reference();
    if (!skip_blanks() || text_[at_] != '=')
      fail(fmt::format("'=' is missing behind #{}", id), "export the file again");
    ++at_;
    skip_blanks();
    record.name = read_word();
    while (skip_blanks() && text_[at_] != ';') {
      if (text_[at_] == '\'') {
        record.texts.push_back(read_text());
      } else if (text_[at_] == '#') {
        record.refs.push_back(read_reference());
      } else {
        read_other(record);
      }
    }
    if (ends()) fail(fmt::format("record #{} does not end", id), "the file is cut off: export it again");
    ++at_;
    if (!records_.emplace(id, std::move(record)).second)
      fail(fmt::format("#{} is used twice", id), "export the file again");
  }

  /// Of the header and between the sections.
  void skip_statement() {
    while (skip_blanks() && text_[at_] != ';') {
      if (text_[at_] == '\'') {
        read_text();
      } else {
        step();
      }
    }
    if (!ends()) ++at_;
  }

  std::string_view text_;
  const std::string& path_;
  size_t at_ = 0;
  int line_ = 1;
  P21Records records_;
};

}  // namespace

P21Records read_part21(const std::string& path) {
  const std::string text = program::read_file(path);
  return P21Reader(text, path).run();
}

}  // namespace swarf::sim

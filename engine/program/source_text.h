// The text of a program before any word is read: is it text at all, and where do its lines end?
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "program/reporter.h"

namespace swarf::program {

/// Reports "empty-file" (no character but white space) or "not-text" (a NUL, or bytes that are not
/// UTF-8, with line, column and byte offset) and returns false; true when the text can be read.
/// `what_to_give`: the advice for an empty file.
bool check_text(std::string_view text, Reporter& reporter, const char* what_to_give);

/// Lines without their ends; CR LF, LF and CR all end a line. A byte order mark is left out.
std::vector<std::string_view> split_lines(std::string_view text);

/// Length of the UTF-8 sequence that starts at `at`, 1 to 4; 0 when the bytes there are not UTF-8
/// (Unicode 15, table 3-7: no overlong forms, no surrogates, nothing above U+10FFFF).
int utf8_length(std::string_view text, size_t at);

/// The lines of these 1-based numbers as split_lines() has them, of those that the file has. Reads no farther
/// than it must, in little memory. Throws InputError as read_file().
std::map<int, std::string> read_lines(const std::string& path, const std::set<int>& wanted);

/// The bytes of a regular file. Throws InputError: "file-not-found", "file-unreadable".
std::string read_file(const std::string& path);

}  // namespace swarf::program

// CHECK: a broken promise of our own code (never of the user's input, which gets a Diagnostic).
#pragma once

#include <stdexcept>
#include <string>

namespace swarf {

/// Thrown by CHECK; the program reports it and exits with 3.
struct InternalError : std::logic_error {
  using std::logic_error::logic_error;
};

[[noreturn]] void check_failed(const char* condition, const char* file, int line, const std::string& message);

}  // namespace swarf

#define SWARF_CHECK(condition, message)                                                 \
  do {                                                                                  \
    if (!(condition)) ::swarf::check_failed(#condition, __FILE__, __LINE__, (message)); \
  } while (false)

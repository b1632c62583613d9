// Ranges of numbers that flags take. CLI11's own name their open end by the 309 digits of the largest double.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace swarf::cli {

/// Refuses what is no number, and what `holds` refuses: "0 is not `words`".
template <typename Holds>
CLI::Validator number_that(const char* name, const char* words, Holds holds) {
  return CLI::Validator(
      [words, holds](std::string& text) {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && std::isfinite(value) && holds(value)
                   ? std::string()
                   : text + " is not " + words;
      },
      name);
}

inline CLI::Validator positive() {
  return number_that("POSITIVE", "a number above 0", [](double value) { return value > 0.0; });
}
inline CLI::Validator nonnegative() {
  return number_that("NONNEGATIVE", "a number of 0 or more", [](double value) { return value >= 0.0; });
}

}  // namespace swarf::cli

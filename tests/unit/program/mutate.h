// One random change of a program's text, for the tests that feed readers with broken programs.
#pragma once

#include <string>

#include "base/rng.h"

namespace swarf::program {

/// Replaces, inserts, repeats, copies or erases a few characters of `text` (not empty) with those of `pool`.
inline void mutate(std::string& text, const std::string& pool, Rng& rng) {
  const size_t at = rng.next() % text.size();
  const char c = pool[rng.next() % pool.size()];
  switch (rng.next() % 5) {
    case 0:
      text[at] = c;
      break;
    case 1:
      text.insert(at, 1, c);
      break;
    case 2:
      text.erase(at, 1 + rng.next() % 4);
      break;
    case 3:
      text.insert(at, 1 + rng.next() % 30, c);
      break;
    default:
      text.insert(at, text.substr(rng.next() % text.size(), 1 + rng.next() % 20));
  }
}

}  // namespace swarf::program

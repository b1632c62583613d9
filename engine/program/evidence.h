// How the dialect of a program is recognised from its text.
#pragma once

#include <string>

namespace swarf::program {

/// What speaks for a dialect in a program's first lines.
struct Evidence {
  int score = 0;       ///< number of words that only this dialect has; 0: nothing speaks for it
  std::string reason;  ///< the first such word, as written with its line: "G43.4 in line 12"
};

}  // namespace swarf::program

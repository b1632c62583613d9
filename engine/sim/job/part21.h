// Records of a file as ISO 10303-21 writes it, without its schema: what stands in each, in its order.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace swarf::sim {

/// "#12 = NUMERICAL_VALUE('DC', $, #3, 10.);": its arguments by their kind, those of lists among them.
struct P21Record {
  std::string name;  ///< in capitals; "" of a record of several parts, "#1 = (A() B());"
  std::vector<int64_t> refs;
  std::vector<std::string> texts;
  std::vector<double> numbers;
  int line = 0;
};

using P21Records = std::map<int64_t, P21Record>;

/// Every record of the data sections. Throws InputError "file-not-found", "bad-tool-library" with its place:
/// no such file, a text, comment or record without end, a number of a record that is used twice.
P21Records read_part21(const std::string& path);

}  // namespace swarf::sim

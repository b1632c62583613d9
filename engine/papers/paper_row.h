// One figure of a paper beside this program's.
#pragma once

#include <string>

namespace swarf::papers {

struct PaperRow {
  std::string quantity;   ///< "Chord error, 52 segments"
  std::string place;      ///< "Eq. (8), Fig. 6"
  std::string paper;      ///< "1"
  std::string ours;       ///< "1.0947"
  std::string unit{};     ///< "µm"
  std::string erratum{};  ///< "E6"; empty: they agree
  std::string why{};      ///< what explains the difference
};

}  // namespace swarf::papers

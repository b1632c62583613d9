// The cutter: APT's seven parameters will grow here; today the flat end mill with flutes, shank and holder.
#pragma once

#include <string>
#include <vector>

namespace swarf::cutter {

/// Lengths in mm, measured from the tip along the axis.
struct Cutter {
  int number = 0;                 ///< T word
  double diameter_mm = 10.0;      ///< of the cutting part
  double corner_radius_mm = 0.0;  ///< 0: flat end; other shapes belong to the stock engine and are refused
  double flute_length_mm = 25.0;  ///< cutting edges reach this far up
  double shank_diameter_mm = 10.0;
  double length_mm = 60.0;  ///< tip to the holder's face (gauge line at the holder's top)
  double holder_diameter_mm = 40.0;
  double holder_length_mm = 50.0;

  double radius() const { return 0.5 * diameter_mm; }
};

/// Every contradiction in the parameters, in words with numbers; empty when the cutter can be used.
std::vector<std::string> validate(const Cutter& cutter);

}  // namespace swarf::cutter

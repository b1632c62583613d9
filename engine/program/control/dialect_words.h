// What a dialect calls the things that the remedies of the common core name.
#pragma once

namespace swarf::program::nc {

/// Each as a user would write it. The defaults are those of letter dialects.
struct DialectWords {
  const char* compensation_off = "G40";
  const char* rapid = "G0";      ///< how axes are positioned
  const char* feed_move = "G1";  ///< how a straight cut is written
  const char* centre = "I J K";  ///< how the centre of an arc is given
  const char* per_revolution = "G95";
  const char* spindle_on = "S1000 M3";
  const char* length_on = "G43 H";  ///< how the length of the tool is compensated
};

}  // namespace swarf::program::nc

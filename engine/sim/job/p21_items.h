// Tools as ISO 13399 writes them (.p21): items and their properties, in the records of its cutting tool
// schema.
//
//   ITEM <- ITEM_VERSION <- ITEM_DEFINITION <- PROPERTY_VALUE_ASSOCIATION -> PROPERTY_VALUE_REPRESENTATION
//   PROPERTY_VALUE_REPRESENTATION -> PROPERTY, NUMERICAL_VALUE('DC', digits, #unit, 10.) -> UNIT('mm')
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace swarf::sim {

/// A number with the word of its unit; given with two values it is not used.
struct P21Value {
  double value = 0.0;
  std::string unit;
  bool contradicts = false;
};

struct P21Item {
  std::string id;
  int line = 0;
  std::map<std::string, P21Value> values;  ///< by the property's symbol in capitals: DC, RE, APMX ..
};

struct P21Items {
  std::vector<P21Item> items;   ///< those with a property, in the file's order
  std::set<std::string> codes;  ///< dictionary codes of properties that no symbol names: these are not known
};

/// The symbol is the name of the value, or the id of its property. Throws what read_part21() throws.
P21Items read_p21_items(const std::string& path);

}  // namespace swarf::sim

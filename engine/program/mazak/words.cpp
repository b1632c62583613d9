#include "program/mazak/words.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace swarf::program::nc::mazak {

using fanuc::Fanuc;

namespace {

struct Pattern {
  Vec2 place;
  double length_mm, angle_deg;
  int count;  ///< below zero: clockwise
};

Pattern pattern_of(Fanuc& mazak, std::string_view letters) {
  for (const char letter : letters) mazak.need(letter, mazak.g_name(fanuc::kFanucOneShot).c_str());
  Pattern pattern{fanuc::pattern_place(mazak), mazak.control.modal.mm(mazak.block.get('I')),
                  mazak.block.get('J', 0.0),
                  whole(mazak.block, 'K', -9999, 9999, mazak.reader, mazak.control)};
  if (pattern.count == 0 || !(pattern.length_mm > 0.0))
    mazak.control.report.fail("out-of-range", mazak.column(pattern.count == 0 ? 'K' : 'I'),
                              "the pattern has no holes or no size",
                              "write I above zero, and K other than zero");
  return pattern;
}

}  // namespace

void bolt_circle(Fanuc& mazak) {
  const Pattern all = pattern_of(mazak, "IJK");
  fanuc::drill_holes(mazak, fanuc::holes_on_circle(all.place, all.length_mm, all.angle_deg, 360.0 / all.count,
                                                   std::abs(all.count)));
}

void bolt_line(Fanuc& mazak) {
  const Pattern all = pattern_of(mazak, "IJK");
  if (all.count < 0)
    mazak.control.report.fail("out-of-range", mazak.column('K'), "a line of holes goes one way",
                              "write K above zero and the angle J");
  fanuc::drill_holes(mazak, fanuc::holes_on_line(all.place, all.length_mm, all.angle_deg, all.count));
}

void bolt_arc(Fanuc& mazak) {
  const Pattern all = pattern_of(mazak, "IJKP");
  const double step_deg = all.count < 0 ? -mazak.block.get('P') : mazak.block.get('P');
  fanuc::drill_holes(
      mazak, fanuc::holes_on_circle(all.place, all.length_mm, all.angle_deg, step_deg, std::abs(all.count)));
}

/// Work offsets are group 12. What #10001 on hold differs between the types of tool offset memory.
std::optional<double> variable(Fanuc& mazak, long number, size_t place) {
  if (number == 4012) return fanuc::modal_code(mazak, 14);
  const bool group = number >= 4001 && number <= 4022;
  const bool same = (number >= 4001 && number <= 4011 && number != 4004) || number == 4016;
  const bool tool = number >= 10000 && number < 14000;
  if (!tool && (!group || same)) return std::nullopt;
  mazak.control.report.fail(
      "undefined-parameter", mazak.reader.column_of(place),
      tool ? fmt::format("#{} is a tool offset, and which one depends on the machine", number)
           : fmt::format("#{} is no variable that can be read here", number),
      "read #4001 to #4016 (modal codes), #5001 to #5046 or #5221 to #5326");
}

}  // namespace swarf::program::nc::mazak

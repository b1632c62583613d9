#include "program/haas/words.h"

#include <fmt/format.h>

#include <cmath>

namespace swarf::program::nc::haas {

using fanuc::Fanuc;

namespace {

void drill_on_circle(Fanuc& haas, bool arc) {
  for (const char letter : {'I', 'L'}) haas.need(letter, haas.g_name(fanuc::kFanucOneShot).c_str());
  if (arc) haas.need('K', "G71");
  const int count = whole(haas.block, 'L', 1, 9999, haas.reader, haas.control);
  const double radius = haas.control.modal.mm(haas.block.get('I'));
  if (!(radius > 0.0))
    haas.control.report.fail("out-of-range", haas.column('I'), fmt::format("I {:g} is no radius", radius),
                             "write a radius above zero");
  haas.control.report.place.column = haas.g_column(fanuc::kFanucOneShot);
  fanuc::drill_holes(haas,
                     fanuc::holes_on_circle(fanuc::pattern_place(haas), radius, haas.block.get('J', 0.0),
                                            arc ? haas.block.get('K') : 360.0 / count, count));
}

/// Groups of #4001 on, which are numbered otherwise: work offsets are group 12, TCPC and FCS have codes of
/// their own.
std::optional<double> modal_group(const Fanuc& haas, long group) {
  if (group == 12) {
    const int active = haas.control.offsets.active;
    return active > 100 ? 154.0 : 53.0 + active;
  }
  if (group == 8 && haas.modes.length_code == fanuc::G::kTcpRotaries) return 234.0;
  const bool same = (group >= 1 && group <= 11 && group != 4) || group == 16;
  return same ? fanuc::modal_code(haas, group) : std::nullopt;
}

/// Banks of 200 from #2001 on: lengths, their wear, diameters, their wear.
double tool_variable(Fanuc& haas, long number, int column) {
  const auto slot = static_cast<size_t>((number - 2001) / 200);
  const int tool = static_cast<int>((number - 2001) % 200 + 1);
  const double value = fanuc::tool_offset(haas.zero, haas, tool, slot, column) / haas.control.modal.mm(1.0);
  if (slot < 2) return value;
  haas.control.report.warn_once("offset-as-diameter", column,
                                "#2401 to #2800 are read as diameters, setting 40 as delivered",
                                "halve them where the machine keeps radii");
  return 2.0 * value;
}

}  // namespace

void bolt_circle(Fanuc& haas) {
  drill_on_circle(haas, false);
}

void bolt_arc(Fanuc& haas) {
  drill_on_circle(haas, true);
}

void dynamic_offset_on(Fanuc& haas) {
  Control& control = haas.control;
  if (haas.planes.turned.on || haas.modes.tcp != Tcp::kOff)
    control.report.fail("modal-conflict", haas.g_column(fanuc::kFanucOneShot),
                        "G254 stands while TCPC, a rotation or a feature coordinate system is on",
                        "end it first: G49, G69, G269");
  if (!control.path.started)
    control.report.fail("start-unknown", haas.g_column(fanuc::kFanucOneShot),
                        "G254 needs to know where the rotary axes stand", "position all axes before it");
  nc::flush(control);
  const Mat3 at_zero = control.space.compensated({0.0, 0.0, 0.0}).columns_W;
  const Mat3 now = control.space.compensated(control.space.rotary_of(control.path.q)).columns_W;
  haas.planes.turned.frame = Pose::Identity();
  haas.planes.turned.frame.linear() = at_zero.inverse() * now;
  haas.planes.turned.on = haas.planes.turned.in_work = haas.modes.rotaries_stand = true;
  fanuc::update_space(haas);
}

void dynamic_offset_off(Fanuc& haas) {
  if (!haas.modes.rotaries_stand) return;
  haas.modes.rotaries_stand = false;
  haas.planes.turned = {};
  fanuc::update_space(haas);
}

std::optional<double> variable(Fanuc& haas, long number, size_t place) {
  const int column = haas.reader.column_of(place);
  if (number >= 2001 && number <= 2800) return tool_variable(haas, number, column);
  if (number == 3026) return haas.control.tools.active_number;
  if (number >= 4001 && number <= 4022) {
    if (const std::optional<double> code = modal_group(haas, number - 4000)) return code;
  }
  const bool position = number >= 5001 && number <= 5046;
  const bool offset = (number >= 5221 && number < 5341) || (number >= 7001 && number < 7401) ||
                      (number >= 14001 && number < 14001 + 20 * haas.rules.further_offsets);
  const bool address = number == 4109 || number == 4111 || number == 4107 || number == 4119 || number == 4120;
  if (position || offset || address) return std::nullopt;
  haas.control.report.fail(
      "undefined-parameter", column,
      number >= 20000 ? fmt::format("#{} is setting {} of the machine, which the program does "
                                    "not say",
                                    number, number - 20000)
                      : fmt::format("#{} is no variable that can be read here", number),
      "read #2001 to #2800 (tool offsets), #4001 to #4021, #5001 to #5046 or #5221 to #5326");
}

}  // namespace swarf::program::nc::haas

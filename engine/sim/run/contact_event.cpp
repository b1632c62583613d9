#include "sim/run/contact_event.h"

#include <fmt/format.h>

#include <istream>
#include <sstream>

namespace swarf::sim {
namespace {

std::string event_text(const ContactEvent& e) {
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {}", e.part, e.tool, e.first.element, e.first.t_s,
                     e.last_element, e.depth_mm, e.deepest.element, e.deepest.t_s, e.deepest_W.x(),
                     e.deepest_W.y(), e.deepest_W.z());
}

bool read_event(std::istream& in, ContactEvent& e) {
  in >> e.part >> e.tool >> e.first.element >> e.first.t_s >> e.last_element >> e.depth_mm >>
      e.deepest.element >> e.deepest.t_s >> e.deepest_W.x() >> e.deepest_W.y() >> e.deepest_W.z();
  return !in.fail();
}

}  // namespace

std::string clearance_text(const ToolClearance& c) {
  std::string text =
      fmt::format("{} {} {} {} {};", c.checked_sweeps, c.nearest_mm, c.band_mm, c.sees_mm, c.events.size());
  for (const ContactEvent& event : c.events) text += event_text(event) + ";";
  return text;
}

bool parse_clearance(const std::string& text, ToolClearance& c) {
  std::istringstream in(text);
  size_t events = 0;
  char end = 0;
  in >> c.checked_sweeps >> c.nearest_mm >> c.band_mm >> c.sees_mm >> events >> end;
  for (size_t i = 0; i < events && in && end == ';'; ++i) {
    ContactEvent event;
    if (!read_event(in, event)) return false;
    in >> end;
    c.events.push_back(event);
  }
  return !in.fail() && end == ';';
}

std::string bad_cuts_text(const std::vector<BadCut>& cuts) {
  std::string text;
  for (const BadCut& cut : cuts) {
    text += fmt::format("{} {};", static_cast<int>(cut.kind), event_text(cut.event));
  }
  return text;
}

bool parse_bad_cuts(const std::string& text, std::vector<BadCut>& cuts) {
  std::istringstream in(text);
  int kind = 0;
  char end = ';';
  while (in >> kind) {
    BadCut cut;
    if (kind < 0 || kind > static_cast<int>(BadCutKind::kSpindleReversed)) return false;
    if (!read_event(in, cut.event) || !(in >> end) || end != ';') return false;
    cut.kind = static_cast<BadCutKind>(kind);
    cuts.push_back(cut);
  }
  return in.eof() && end == ';';
}

}  // namespace swarf::sim

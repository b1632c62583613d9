#include "avoidance/remedies.h"

#include <algorithm>

namespace swarf::avoidance {
namespace {

/// `link` or one of its ancestors; -1, the floor, is none's.
bool carries(const machine::MachineScene& machine, int link, int carried) {
  for (int at = carried; at >= 0; at = machine.links[static_cast<size_t>(at)].parent)
    if (at == link) return true;
  return false;
}

/// An axis moves it.
bool is_moved(const machine::MachineScene& machine, int link) {
  for (int at = link; at >= 0; at = machine.links[static_cast<size_t>(at)].parent)
    if (machine.links[static_cast<size_t>(at)].axis >= 0) return true;
  return false;
}

Part part_of_link(const machine::MachineScene& machine, int link) {
  if (link == machine.work_link) return Part::kTable;
  if (!is_moved(machine, link)) return Part::kStructure;
  const auto rides_with = [&](int end) { return carries(machine, link, end) || carries(machine, end, link); };
  return rides_with(machine.tool_link) ? Part::kHead : Part::kArm;
}

bool is(Part part, std::initializer_list<Part> parts) {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

}  // namespace

const char* part_name(Part part) {
  switch (part) {
    case Part::kHead:
      return "milling head";
    case Part::kHolder:
      return "tool holder";
    case Part::kCutter:
      return "cutter";
    case Part::kWork:
      return "workpiece";
    case Part::kFixture:
      return "clamping tools";
    case Part::kTable:
      return "table";
    case Part::kArm:
      return "rotating arm";
    case Part::kStructure:
      break;
  }
  return "machine structure";
}

Part part_of(const machine::MachineScene& machine, const collision::Body& body) {
  switch (body.kind) {
    case collision::BodyKind::kFixture:
      return Part::kFixture;
    case collision::BodyKind::kStock:
    case collision::BodyKind::kPart:
      return Part::kWork;
    case collision::BodyKind::kToolPart:
      return body.name.starts_with("flutes") ? Part::kCutter : Part::kHolder;
    case collision::BodyKind::kLink:
      break;
  }
  return part_of_link(machine, body.link);
}

const char* remedy_name(Remedy remedy) {
  switch (remedy) {
    case Remedy::kMoveClamping:
      return "A: move the clamping position";
    case Remedy::kExtendTool:
      return "B: extend the tool";
    case Remedy::kShortenTool:
      break;
  }
  return "B-: shorten the tool";
}

std::vector<Remedy> remedies_of(Part a, Part b) {
  if (a > b) std::swap(a, b);  // Part's order: tool side first
  const bool head = is(a, {Part::kHead, Part::kHolder});
  if (head && is(b, {Part::kWork, Part::kFixture})) return {Remedy::kExtendTool};
  if (head && is(b, {Part::kTable, Part::kArm, Part::kStructure}))
    return {Remedy::kMoveClamping, Remedy::kExtendTool};
  if (a == Part::kCutter && is(b, {Part::kWork, Part::kFixture})) return {};
  return {Remedy::kMoveClamping};
}

std::vector<Remedy> remedies_of_limit(bool linear) {
  if (!linear) return {};
  return {Remedy::kMoveClamping, Remedy::kShortenTool};
}

}  // namespace swarf::avoidance

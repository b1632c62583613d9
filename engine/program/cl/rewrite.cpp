#include "program/cl/rewrite.h"

#include <fmt/format.h>

#include <utility>

namespace swarf::program {
namespace {

constexpr double kSame = 1e-6;  // mm, and of unit vectors

class Positions final : public ClSink {
 public:
  void move(const Move& move) override { moves.push_back(move); }
  void position(const ClPosition& position) override { positions.push_back(position); }
  void note(ClNote /*note*/) override {}
  std::vector<Move> moves;
  std::vector<ClPosition> positions;
};

Positions read(const std::string& text, const std::string& file, const ClOptions& options, ToolPose& start) {
  Positions found;
  Diagnostics diagnostics;
  start = stream_cl_text(text, file, found, diagnostics, options).start;
  diagnostics.throw_if_errors();
  return found;
}

/// The lines with their ends.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (size_t at = 0; at < text.size();) {
    size_t end = text.find_first_of("\r\n", at);
    if (end == std::string::npos)
      end = text.size();
    else
      end += text.compare(end, 2, "\r\n") == 0 ? 2 : 1;
    lines.push_back(text.substr(at, end - at));
    at = end;
  }
  return lines;
}

/// Where the line's words end: at a comment, a $ that goes on, or its end.
size_t words_end(const std::string& line) {
  return std::min(line.find_first_of("$\r\n"), line.size());
}

bool goes_on(const std::string& line) {
  const size_t dollar = line.find('$');
  return dollar != std::string::npos && line.compare(dollar, 2, "$$") != 0;
}

std::string line_end(const std::string& line) {
  return line.substr(std::min(line.find_first_of("\r\n"), line.size()));
}

std::string statement(const ClPosition& position, const ToolPose& pose) {
  const Vec3 p = position.X_WC.inverse() * pose.tip_W / position.unit_mm;
  const Vec3 a = position.X_WC.linear().transpose() * pose.axis_W;
  // Without the sign of a zero.
  const auto number = [](double value) { return fmt::format("{:.9f}", value + 0.0); };
  return fmt::format("GOTO/{},{},{},{},{},{}", number(p.x()), number(p.y()), number(p.z()), number(a.x()),
                     number(a.y()), number(a.z()));
}

/// One statement, in the place of the one that begins on this line.
void put(std::vector<std::string>& lines, const ClPosition& position, const ToolPose& pose) {
  auto at = static_cast<size_t>(position.line - 1);
  std::string& first = lines.at(at);
  const bool more = goes_on(first);
  const size_t indent = std::min(first.find_first_not_of(" \t\xEF\xBB\xBF"), first.size());
  std::string rest = more ? line_end(first) : first.substr(words_end(first));
  if (rest.starts_with("$$")) rest = " " + rest;
  first = first.substr(0, indent) + statement(position, pose) + rest;
  for (bool next = more; next && ++at < lines.size();) {
    next = goes_on(lines[at]);
    lines[at] = line_end(lines[at]);
  }
}

bool same(const ToolPose& a, const ToolPose& b) {
  return (a.tip_W - b.tip_W).norm() <= kSame && (a.axis_W - b.axis_W).norm() <= kSame;
}

void require(bool met, const std::string& file, int line) {
  if (met) return;
  throw InputError(
      "block-fixed", {file, line, 0},
      "the position of this block cannot be given anew: an arc, a hole, a compensated contour or "
      "GODLTA holds it",
      "change it in the CAM system");
}

}  // namespace

std::vector<ClPosition> positions_of(const std::string& text, const std::string& file,
                                     const ClOptions& options) {
  ToolPose start;
  return read(text, file, options, start).positions;
}

std::string rewrite_cl(const std::string& text, const std::string& file,
                       const std::map<int, ToolPose>& changed, const ClOptions& options) {
  ToolPose start, start_now;
  const Positions before = read(text, file, options, start);
  std::vector<std::string> lines = lines_of(text);
  std::map<int, ToolPose> left = changed;
  bool axis_changed = false;  // what the next statement would take over
  for (const ClPosition& position : before.positions) {
    const auto found = left.find(position.line);
    const bool here = found != left.end();
    if (here || (axis_changed && !position.with_axis))
      put(lines, position, here ? found->second : position.pose);
    axis_changed = here;
    if (here) left.erase(found);
  }
  require(left.empty(), file, left.empty() ? 0 : left.begin()->first);
  std::string written;
  for (const std::string& line : lines) written += line;
  const Positions after = read(written, file, options, start_now);
  require(after.moves.size() == before.moves.size(), file, 0);
  const auto wanted = [&](int line, const ToolPose& pose) {
    const auto found = changed.find(line);
    return found != changed.end() ? found->second : pose;
  };
  for (size_t i = 0; i < after.moves.size(); ++i) {
    const Move& move = before.moves[i];
    require(same(after.moves[i].to, wanted(move.line, move.to)), file, move.line);
  }
  return written;
}

}  // namespace swarf::program

#include "reports/page_program.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "base/units.h"
#include "program/source_text.h"

namespace swarf::reports {
namespace {

using PageJson = nlohmann::ordered_json;

struct LineSpan {
  double end_s = 0.0;
  int line = 0;
};

/// Ends of the stretches that run one line.
std::vector<LineSpan> line_stretches(const Way& way) {
  std::vector<LineSpan> stretches;
  for (const WayPoint& point : way.points) {
    if (stretches.empty() || stretches.back().line != point.line)
      stretches.push_back({point.t_s, point.line});
    stretches.back().end_s = point.t_s;
  }
  return stretches;
}

PageJson texts_of(const std::string& file, const std::vector<LineSpan>& stretches) {
  std::set<int> wanted;
  for (const LineSpan& stretch : stretches)
    if (stretch.line > 0) wanted.insert(stretch.line);
  PageJson texts = PageJson::object();
  if (wanted.empty() || wanted.size() > kPageLines || !std::filesystem::is_regular_file(file)) return texts;
  for (const auto& [line, text] : program::read_lines(file, wanted)) texts[std::to_string(line)] = text;
  return texts;
}

}  // namespace

std::string page_program(const sim::Job& job, const sim::Result& result, const RunFiles& files) {
  const std::vector<LineSpan> stretches = line_stretches(files.way);
  const size_t stride = 1 + stretches.size() / kPagePoints;
  PageJson t_ms = PageJson::array(), line = PageJson::array(), tools = PageJson::array();
  for (size_t i = 0; i < stretches.size(); i += stride) {
    t_ms.push_back(std::lround(1e3 * stretches[i].end_s));
    line.push_back(stretches[i].line);
  }
  for (size_t i = 0; i < job.scene.tools.size(); ++i) {
    const auto colour = tool_colour(i);
    tools.push_back({{"name", cutter::call_name(job.scene.tools[i])},
                     {"colour", fmt::format("rgb({},{},{})", colour[0], colour[1], colour[2])}});
  }
  const PageJson page{{"file", std::filesystem::path(job.scene.program_file).filename().string()},
                      {"from_s", files.shown_from_s},
                      {"to_s", result.main.motion.statistics.time_s},
                      {"t_ms", std::move(t_ms)},
                      {"line", std::move(line)},
                      {"text", texts_of(job.scene.program_file, stretches)},
                      {"tools", std::move(tools)},
                      {"error_um", um_from_mm(files.part_error_mm)}};
  // Inside a <script> nothing may look like its end.
  std::string text;
  for (const char c : page.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    c == '<' ? text += "\\u003c" : text += c;
  return text;
}

}  // namespace swarf::reports

#include "cli/check_cl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>

#include "base/units.h"
#include "cli/nc_totals.h"
#include "cli/terminal.h"
#include "program/move_way.h"

namespace swarf::cli {
namespace {

/// Adds up what passes.
class Totals final : public program::ClSink {
 public:
  void move(const program::Move& move) override {
    const bool feeds = !move.rapid;
    arcs_ += move.arc ? 1 : 0;
    (feeds ? feed_mm_ : rapid_mm_) += program::way_mm(move);
    (feeds ? feeds_ : rapids_) += 1;
    const double feed_s = feeds && move.feed_mm_s > 0.0 ? program::way_mm(move) / move.feed_mm_s : 0.0;
    hours_.add(feed_s + move.dwell_s, move);
    extent_W_.extend(program::extent_W(move));
    turned_ |= move.to.axis_W.z() < 1.0 - 1e-9;
  }
  const ProgramHours& hours() const { return hours_; }
  void note(program::ClNote note) override { ++notes_[note.word]; }

  std::string text() const {
    std::string text = fmt::format(
        "\n  {} feed moves, {} of them arcs; {} rapids; {:.0f} mm and {:.0f} mm of way\n"
        "  tips from ({:.3f}, {:.3f}, {:.3f}) to ({:.3f}, {:.3f}, {:.3f}) mm, tool axis {}",
        feeds_, arcs_, rapids_, feed_mm_, rapid_mm_, extent_W_.min().x(), extent_W_.min().y(),
        extent_W_.min().z(), extent_W_.max().x(), extent_W_.max().y(), extent_W_.max().z(),
        turned_ ? "turns" : "stays (0, 0, 1)");
    std::string kept;
    for (const auto& [word, count] : notes_)
      kept += fmt::format("{}{} ({})", kept.empty() ? "" : ", ", word, count);
    if (!kept.empty()) text += "\n  without effect on the geometry: " + kept;
    return text;
  }

  /// The same, appended to `numbers`.
  void add_to(nlohmann::ordered_json& numbers) const {
    const auto side = [&](int i) { return std::array{extent_W_.min()[i], extent_W_.max()[i]}; };
    numbers["feed_moves"] = feeds_;
    numbers["arcs"] = arcs_;
    numbers["rapids"] = rapids_;
    numbers["feed_mm"] = feed_mm_;
    numbers["rapid_mm"] = rapid_mm_;
    numbers["tips_mm"] = {{"x", side(0)}, {"y", side(1)}, {"z", side(2)}};
    numbers["axis_turns"] = turned_;
    numbers["no_effect"] = notes_;
  }

 private:
  long feeds_ = 0, rapids_ = 0, arcs_ = 0;
  double feed_mm_ = 0.0, rapid_mm_ = 0.0;
  Eigen::AlignedBox3d extent_W_;  ///< of the tip, arcs with their bulge
  bool turned_ = false;
  ProgramHours hours_;
  std::map<std::string, long> notes_;
};

}  // namespace

bool is_cl_file(const std::string& file) {
  std::string name = std::filesystem::path(file).filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const size_t last = name.find_last_not_of("0123456789");
  if (last != std::string::npos && name[last] == '.' && last + 1 < name.size() &&
      name.substr(0, last).ends_with(".ncl"))
    name.resize(last);
  constexpr std::array kEndings{".cl", ".cls", ".clt", ".ncl", ".apt", ".aptsource", ".cldata"};
  return std::any_of(kEndings.begin(), kEndings.end(),
                     [&](const char* ending) { return name.ends_with(ending); });
}

Checked check_cl(const std::string& file, const program::ClOptions& options) {
  Diagnostics diagnostics;
  Totals totals;
  const program::ClProgram program = program::stream_cl(file, totals, diagnostics, options);
  diagnostics.throw_if_errors();
  totals.hours().refuse_too_long({file});
  std::string text =
      fmt::format("CL data is right: {} statements, {} moves", program.statements, program.motions);
  text += fmt::format("\n  written by: {}", program.writer_reason.empty()
                                                ? "unknown, the file bears no mark"
                                                : fmt::format("{} ({})", program::writer_name(program.writer),
                                                              program.writer_reason));
  text += totals.text();
  const Vec3& start = program.start.tip_W;
  text += fmt::format("\n  starts at ({:.3f}, {:.3f}, {:.3f}) mm, its first position, line {}", start.x(),
                      start.y(), start.z(), program.start_line);
  std::string tools;
  for (const program::ClTool& tool : program.tools)
    tools += fmt::format("{}{}", tools.empty() ? "" : ", ",
                         tool.number != 0 ? fmt::format("T{}", tool.number) : tool.name);
  if (!tools.empty()) text += "\n  tools: " + tools;
  if (program.unit_assumed)
    text += "\n  unit: mm is taken, the file has no UNITS; --units inch says otherwise";
  for (const std::string& remark : program.remarks) text += "\n  " + remark;
  nlohmann::ordered_json numbers{{"writer", program::writer_name(program.writer)},
                                 {"writer_reason", program.writer_reason},
                                 {"statements", program.statements},
                                 {"moves", program.motions}};
  totals.add_to(numbers);
  numbers["unit_assumed"] = program.unit_assumed;
  numbers["start_mm"] = {start.x(), start.y(), start.z()};
  numbers["start_line"] = program.start_line;
  numbers["tools"] = nlohmann::ordered_json::array();
  for (const program::ClTool& tool : program.tools)
    numbers["tools"].push_back({{"number", tool.number}, {"name", tool.name}});
  numbers["remarks"] = program.remarks;
  return {"cl", text, numbers, diagnostics.list()};
}

}  // namespace swarf::cli

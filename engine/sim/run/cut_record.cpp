#include "sim/run/cut_record.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <sstream>

#include "base/diagnostics.h"
#include "base/file.h"

namespace swarf::sim {
namespace {

constexpr std::string_view kFirstLine = "swarf-record 1\n";
constexpr std::string_view kLastLine = "\nend ";

constexpr const char* kRecordAgain = "record the run again with swarf run --record";

[[noreturn]] void refuse(const std::string& code, const SourceLocation& where, const std::string& text) {
  throw InputError(code, where, text, kRecordAgain);
}

void append_recorded_pose(fmt::memory_buffer& out, const ToolPose& pose) {
  const Vec3 &p = pose.tip_W, &a = pose.axis_W;
  fmt::format_to(std::back_inserter(out), " {} {} {} {} {} {}\n", p.x(), p.y(), p.z(), a.x(), a.y(), a.z());
}

bool same(const ToolPose& a, const ToolPose& b) {
  return a.tip_W == b.tip_W && a.axis_W == b.axis_W;
}

/// The words of one line after its first.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  template <typename Number>
  bool number(Number& value, int base = 10) {
    while (!text_.empty() && text_.front() == ' ') text_.remove_prefix(1);
    std::from_chars_result result{};
    if constexpr (std::is_floating_point_v<Number>) {
      result = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    } else {
      result = std::from_chars(text_.data(), text_.data() + text_.size(), value, base);
    }
    if (result.ec != std::errc()) return false;
    text_.remove_prefix(static_cast<size_t>(result.ptr - text_.data()));
    return true;
  }
  bool pose(ToolPose& pose) {
    bool good = true;
    for (Vec3* v : {&pose.tip_W, &pose.axis_W}) {
      for (int a = 0; a < 3; ++a) good = good && number((*v)[a]);
    }
    return good;
  }
  bool at_end() const { return text_.empty(); }

 private:
  std::string_view text_;
};

/// The tool that is in the spindle, and where it stands.
struct Stand {
  int tool = 0;
  ToolPose pose;
};

/// Reads one line into the record and moves the tool. False: the line is not understood.
bool read_line(std::string_view line, CutRecord& record, Stand& last) {
  const size_t space = std::min(line.find(' '), line.size());
  const std::string_view key = line.substr(0, space);
  const std::string_view rest = line.substr(std::min(space + 1, line.size()));
  Words words(rest);
  if (key == "scene") {
    record.scene = rest;
    return true;
  }
  if (key == "set") {
    record.overrides.emplace_back(rest);
    return true;
  }
  if (key == "part") {
    const size_t equals = rest.find(" = ");
    if (equals == std::string_view::npos) return false;
    record.identity.push_back({std::string(rest.substr(0, equals)), std::string(rest.substr(equals + 3))});
    return true;
  }
  if (key == "every") return words.number(record.every) && record.every > 0 && words.at_end();
  if (key == "program") return words.number(record.program_sweeps) && words.at_end();
  if (key == "tool") return words.number(last.tool) && last.tool >= 0 && words.at_end();
  if (key == "jump") return words.pose(last.pose) && words.at_end();
  if (key == "state") return words.number(record.states.emplace_back(), 16) && words.at_end();
  if (key != "sweep") return false;
  CutPlace place;
  ToolPose end;
  const bool good =
      words.number(place.block) && words.number(place.line) && words.number(place.t_s) && words.pose(end);
  record.sweeps.push_back({last.pose, end, place.block});
  record.places.push_back(place);
  record.tools.push_back(last.tool);
  last.pose = end;
  return good && words.at_end();
}

/// The lines before the last one, whose checksum agrees with them.
std::string verified_text(const std::string& path) {
  std::string text = read_all(path, {"record-unreadable", "the record cannot be read", kRecordAgain});
  if (text.compare(0, kFirstLine.size(), kFirstLine) != 0) {
    refuse("record-foreign", {path, 1, 1}, "this is not the record of a run (swarf-record 1)");
  }
  const size_t end = text.rfind(kLastLine);
  if (end == std::string::npos || text.back() != '\n') {
    refuse("record-incomplete", {path}, fmt::format("the record is cut off at {} bytes", text.size()));
  }
  const std::string last = text.substr(end + kLastLine.size());
  text.resize(end + 1);
  if (last.substr(last.find(' ') + 1) != fmt::format("{:016x}\n", checksum(text))) {
    refuse("record-damaged", {path}, "the checksum of the record does not match its content");
  }
  return text;
}

}  // namespace

void write_record(const std::string& path, const CutRecord& record) {
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "{}scene {}\n", kFirstLine, record.scene);
  for (const std::string& set : record.overrides) fmt::format_to(to, "set {}\n", set);
  for (const IdentityPart& part : record.identity)
    fmt::format_to(to, "part {} = {}\n", part.name, part.value);
  fmt::format_to(to, "every {}\nprogram {}\n", record.every, record.program_sweeps);
  Stand last;
  size_t states = 0;
  for (size_t n = 0; n < record.sweeps.size(); ++n) {
    const stock::Sweep& sweep = record.sweeps[n];
    const CutPlace& place = record.places[n];
    if (record.tools[n] != last.tool) fmt::format_to(to, "tool {}\n", last.tool = record.tools[n]);
    if (!same(sweep.start, last.pose)) {
      fmt::format_to(to, "jump");
      append_recorded_pose(out, sweep.start);
    }
    fmt::format_to(to, "sweep {} {} {}", place.block, place.line, place.t_s);
    append_recorded_pose(out, sweep.end);
    last.pose = sweep.end;
    if ((n + 1) % record.every == 0 || n + 1 == record.sweeps.size()) {
      fmt::format_to(to, "state {:016x}\n", record.states.at(states++));
    }
  }
  const uint64_t sum = checksum({out.data(), out.size()});
  fmt::format_to(to, "end {} {:016x}\n", record.sweeps.size(), sum);
  replace_file(path, {out.data(), out.size()}, {"record-unwritable", "the record cannot be written"});
}

CutRecord read_record(const std::string& path) {
  const std::string text = verified_text(path);
  CutRecord record;
  Stand last;
  std::string_view rest(text);
  rest.remove_prefix(kFirstLine.size());
  for (int number = 2; !rest.empty(); ++number) {
    const size_t end = rest.find('\n');
    if (!read_line(rest.substr(0, end), record, last)) {
      refuse("record-damaged", {path, number, 1}, "this line of the record is not understood");
    }
    rest.remove_prefix(end + 1);
  }
  const size_t states = (record.sweeps.size() + record.every - 1) / record.every;
  if (record.states.size() != states) {
    refuse("record-damaged", {path},
           fmt::format("{} states for {} sweeps", record.states.size(), record.sweeps.size()));
  }
  return record;
}

}  // namespace swarf::sim

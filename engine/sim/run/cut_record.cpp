#include "sim/run/cut_record.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/diagnostics.h"
#include "base/hash.h"
#include "base/input_file.h"

namespace swarf::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstLine = "swarf-record 1\n";
constexpr std::string_view kLastLine = "\nend ";

[[noreturn]] void refuse(const std::string& code, const SourceLocation& where, const std::string& text) {
  throw InputError(code, where, text, "record the run again with swarf run --record");
}

std::string checksum(std::string_view text) {
  Hash hash;
  hash.add(static_cast<uint64_t>(text.size()));
  for (size_t at = 0; at < text.size(); at += sizeof(uint64_t)) {
    uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min(sizeof(word), text.size() - at));
    hash.add(word);
  }
  return hash.text();
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

std::string read_file(const std::string& path) {
  refuse_special_file(path);
  std::ifstream in(path, std::ios::binary);
  if (!in || fs::is_directory(path)) refuse("record-unreadable", {path}, "the record cannot be read");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The lines before the last one, whose checksum agrees with them.
std::string verified_text(const std::string& path) {
  std::string text = read_file(path);
  if (text.compare(0, kFirstLine.size(), kFirstLine) != 0) {
    refuse("record-foreign", {path, 1, 1}, "this is not the record of a run (swarf-record 1)");
  }
  const size_t end = text.rfind(kLastLine);
  if (end == std::string::npos || text.back() != '\n') {
    refuse("record-incomplete", {path}, fmt::format("the record is cut off at {} bytes", text.size()));
  }
  const std::string last = text.substr(end + kLastLine.size());
  text.resize(end + 1);
  if (last.substr(last.find(' ') + 1) != checksum(text) + "\n") {
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
  const std::string sum = checksum({out.data(), out.size()});
  fmt::format_to(to, "end {} {}\n", record.sweeps.size(), sum);
  const std::string temporary = path + ".part";
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(out.data(), static_cast<std::streamsize>(out.size()));
  file.close();
  std::error_code error;
  if (file) fs::rename(temporary, path, error);
  if (!file || error) {
    throw InputError("record-unwritable", {path}, "the record cannot be written",
                     "check that the folder exists, may be written and has space");
  }
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

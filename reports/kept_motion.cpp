#include "reports/kept_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/file.h"
#include "base/hash.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;
using MotionJson = nlohmann::json;
using motion::CyclePlace;

/// By words of eight bytes; the last one is filled up with zeros.
void add_words(Hash& hash, std::string_view bytes) {
  for (size_t i = 0; i < bytes.size(); i += sizeof(uint64_t)) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
    hash.add(word);
  }
}

void add_bytes(Hash& hash, const std::string& bytes) {
  add_words(hash, bytes);
  hash.add(uint64_t{bytes.size()});
}

/// As add_bytes() of all that stands in the file, which may be long.
void add_file(Hash& hash, const fs::path& path) {
  static_assert(kFilePiece % sizeof(uint64_t) == 0, "words lie in one piece");
  uint64_t size = 0;
  read_in_pieces(path.string(), {"file-unreadable", "a kept input cannot be read"},
                 [&](std::string_view piece) {
                   add_words(hash, piece);
                   size += piece.size();
                 });
  hash.add(size);
}

std::string bytes_of(const fs::path& path) {
  refuse_special_file(path.string());
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

template <typename Vector>
MotionJson list_of(const Vector& vector) {
  return MotionJson(std::vector<double>(vector.begin(), vector.end()));
}

template <typename Vector>
Vector vector_of(const MotionJson& list) {
  Vector vector;
  const auto numbers = list.get<std::vector<double>>();
  if (numbers.size() != static_cast<size_t>(vector.size())) throw std::out_of_range("numbers of a vector");
  std::copy(numbers.begin(), numbers.end(), vector.data());
  return vector;
}

MotionJson json_of(const motion::Cycle& cycle) {
  const motion::ToolSample& s = cycle.sample;
  return {{"number", cycle.number},
          {"t_s", s.t_s},
          {"tip", list_of(s.pose.tip_W)},
          {"axis", list_of(s.pose.axis_W)},
          {"contact", list_of(s.contact_W)},
          {"u", s.u},
          {"v", s.v},
          {"feed", s.feed_mm_s},
          {"element", s.element},
          {"kind", static_cast<int>(s.kind)},
          {"tool", s.tool},
          {"rounded", s.rounded},
          {"q", list_of(cycle.q)},
          {"reached", cycle.reached}};
}

motion::Cycle cycle_of(const MotionJson& json) {
  motion::Cycle cycle;
  motion::ToolSample& s = cycle.sample;
  cycle.number = json.at("number");
  s.t_s = json.at("t_s");
  s.pose.tip_W = vector_of<Vec3>(json.at("tip"));
  s.pose.axis_W = vector_of<Vec3>(json.at("axis"));
  s.contact_W = vector_of<Vec3>(json.at("contact"));
  s.u = json.at("u");
  s.v = json.at("v");
  s.feed_mm_s = json.at("feed");
  s.element = json.at("element");
  s.kind = static_cast<motion::SampleKind>(json.at("kind").get<int>());
  s.tool = json.at("tool");
  s.rounded = json.at("rounded");
  cycle.q = vector_of<kinematics::AxisValues>(json.at("q"));
  cycle.reached = json.at("reached");
  return cycle;
}

MotionJson json_of(const motion::RunPlace& run, const motion::RunClock& clock) {
  MotionJson json{{"first", run.first},
                  {"end", run.end},
                  {"next", run.path.next},
                  {"from", run.path.from},
                  {"skip", run.path.skip},
                  {"speed", run.plan.speed},
                  {"top_before", run.plan.top_before},
                  {"tick", clock.tick},
                  {"time", clock.time},
                  {"planned_s", clock.planned_s},
                  {"block", clock.before.block},
                  {"share", clock.before.share},
                  {"rounded", clock.before.rounded},
                  {"q", list_of(clock.before.q)},
                  {"tip", list_of(clock.tip_before)}};
  if (run.path.before) json["before"] = *run.path.before;
  return json;
}

void read_run_place(const MotionJson& json, CyclePlace& place) {
  motion::RunPlace& run = place.run.emplace();
  run.first = json.at("first");
  run.end = json.at("end");
  if (json.contains("before")) run.path.before = json.at("before").get<size_t>();
  run.path.next = json.at("next");
  run.path.from = json.at("from");
  run.path.skip = json.at("skip");
  run.plan.speed = json.at("speed");
  run.plan.top_before = json.at("top_before");
  motion::RunClock& clock = place.clock;
  clock.tick = json.at("tick");
  clock.time = json.at("time");
  clock.planned_s = json.at("planned_s");
  clock.before.block = json.at("block");
  clock.before.share = json.at("share");
  clock.before.rounded = json.at("rounded");
  clock.before.q = vector_of<kinematics::AxisValues>(json.at("q"));
  clock.tip_before = vector_of<Vec3>(json.at("tip"));
}

MotionJson json_of(const CyclePlace& place, uint64_t check) {
  MotionJson json{{"cycle", place.cycle},
                  {"element", place.element},
                  {"tool", place.tool},
                  {"cycle_before", json_of(place.before)},
                  {"check", check}};
  if (place.run) json["run"] = json_of(*place.run, place.clock);
  return json;
}

CyclePlace kept_place_of(const MotionJson& json) {
  CyclePlace place;
  place.cycle = json.at("cycle");
  place.element = json.at("element");
  place.tool = json.at("tool");
  place.before = cycle_of(json.at("cycle_before"));
  if (json.contains("run")) read_run_place(json.at("run"), place);
  return place;
}

KeptMotion motion_from(const MotionJson& json) {
  KeptMotion motion;
  motion.swarf = json.at("swarf");
  motion.inputs = json.at("inputs");
  motion.recall.cycles = json.at("cycles");
  motion.recall.hash = json.at("hash");
  for (const MotionJson& place : json.at("places")) {
    motion.recall.places.push_back(kept_place_of(place));
    motion.recall.checks.push_back(place.at("check"));
  }
  return motion;
}

/// Whether a path of so many elements and tools has what the place names.
bool fits(const CyclePlace& place, size_t elements, size_t tools) {
  const bool here = place.element <= elements && place.tool >= 0 && static_cast<size_t>(place.tool) < tools;
  if (!here || !place.run) return here;
  const motion::RunPlace& run = *place.run;
  const size_t blocks = run.end - run.first;
  return run.first < run.end && run.end <= elements && run.path.next <= blocks &&
         run.path.before.value_or(0) < blocks && place.clock.before.block < blocks;
}

[[noreturn]] void refuse_motion(const std::string& folder, const std::string& why) {
  throw InputError("run-differs", {folder}, why, "run the scene again");
}

}  // namespace

uint64_t inputs_hash(const std::string& folder) {
  Hash hash;
  std::vector<fs::path> files;
  const fs::path input = fs::path(folder) / "input";
  for (const auto& entry : fs::recursive_directory_iterator(input)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    add_bytes(hash, file.lexically_relative(input).generic_string());
    add_file(hash, file);
  }
  const MotionJson manifest = MotionJson::parse(bytes_of(fs::path(folder) / "run.json"), nullptr, false);
  add_bytes(hash,
            manifest.is_object() && manifest.contains("overrides") ? manifest.at("overrides").dump() : "");
  return hash.value();
}

void keep_motion(const PendingFolder& folder, const motion::Cycles& cycles) {
  const motion::CycleRecall recall = cycles.recalled();
  MotionJson json{{"swarf", SWARF_VERSION},
                  {"inputs", inputs_hash(folder.path())},
                  {"cycles", recall.cycles},
                  {"hash", recall.hash},
                  {"places", MotionJson::array()}};
  for (size_t i = 0; i < recall.places.size(); ++i) {
    const CyclePlace& place = recall.places[i];
    if (!place.run || !place.run->kept) json["places"].push_back(json_of(place, recall.checks[i]));
  }
  const std::vector<uint8_t> bytes = MotionJson::to_cbor(json);
  std::string text(bytes.begin(), bytes.end());
  Hash hash;
  add_bytes(hash, text);
  write_text(folder.file(kMotionFile), hash.text() + text);
}

std::optional<KeptMotion> read_motion(const std::string& folder) {
  const fs::path path = fs::path(folder) / kMotionFile;
  if (!fs::exists(path)) return std::nullopt;
  const std::string bytes = bytes_of(path);
  const std::string sum = bytes.substr(0, std::min<size_t>(16, bytes.size()));
  const std::string rest = bytes.substr(sum.size());
  Hash hash;
  add_bytes(hash, rest);
  try {
    if (hash.text() == sum) return motion_from(MotionJson::from_cbor(rest));
  } catch (const std::exception&) {
    // told below
  }
  throw InputError("not-a-run", {path.string()}, "this file is broken", "run the scene again");
}

void require_inputs(const KeptMotion& motion, const std::string& folder) {
  if (inputs_hash(folder) != motion.inputs)
    refuse_motion(folder, "the inputs kept here were changed since the run");
}

void recall_motion(motion::Cycles& cycles, KeptMotion motion, const std::string& folder) {
  require_inputs(motion, folder);
  if (motion.swarf != SWARF_VERSION)
    refuse_motion(folder, fmt::format("swarf {} has run it, this is swarf {}", motion.swarf, SWARF_VERSION));
  const size_t elements = cycles.elements().size();
  const bool all_fit =
      !motion.recall.places.empty() && motion.recall.places.front().cycle == 0 &&
      std::all_of(motion.recall.places.begin(), motion.recall.places.end(),
                  [&](const CyclePlace& place) { return fits(place, elements, cycles.machines().size()); });
  if (!all_fit) refuse_motion(folder, "the inputs kept here give another path");
  cycles.recall(std::move(motion.recall));
}

}  // namespace swarf::reports

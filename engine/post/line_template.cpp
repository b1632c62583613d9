#include "post/line_template.h"

#include <algorithm>

namespace swarf::post {
namespace {

constexpr std::array<const char*, kPlaces> kNames{
    "axes",    "rotaries",     "across",  "along",     "home_along",
    "centre",  "centre_point", "F",       "S",         "T",
    "name",    "text",         "seconds", "number",    "machine",
    "source",  "program",      "bottom",  "clear",     "surface",
    "retract", "return",       "depth",   "clearance", "second_clearance",
    "step",    "step_first",   "dwell",   "feed",      "pitch",
    "turn_1",  "turn_2",       "turn_3",  "side",      "unit"};

/// Where the piece that starts at `from` ends: at the next space outside of quotes.
size_t piece_end(std::string_view line, size_t from) {
  bool quoted = false;
  size_t at = from;
  for (; at < line.size() && (quoted || line[at] != ' '); ++at) {
    if (line[at] == '"') quoted = !quoted;
  }
  return at;
}

}  // namespace

std::span<const char* const> place_names() {
  return kNames;
}

bool LineTemplate::read_piece(std::string_view text, std::span<const Place> allowed, Piece& piece,
                              std::string& bad) {
  for (size_t at = 0; at < text.size();) {
    const size_t open = std::min(text.find('{', at), text.size());
    if (open > at) piece.push_back({std::string(text.substr(at, open - at))});
    if (open == text.size()) return true;
    const size_t close = text.find('}', open);
    const std::string name(text.substr(open + 1, close == text.npos ? close : close - open - 1));
    const auto found = std::find_if(allowed.begin(), allowed.end(),
                                    [&](Place one) { return name == kNames.at(size_t(one)); });
    if (close == text.npos || found == allowed.end()) {
      bad = close == text.npos ? "{" + name : name;
      return false;
    }
    piece.push_back({"", *found});
    at = close + 1;
  }
  return true;
}

LineTemplate::LineTemplate(std::string_view text, std::span<const Place> allowed, std::string& bad) {
  bad.clear();
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    Line pieces;
    for (size_t from = 0; from < line.size();) {
      const size_t stop = piece_end(line, from);
      if (stop > from) {
        pieces.emplace_back();
        if (!read_piece(line.substr(from, stop - from), allowed, pieces.back(), bad)) return;
      }
      from = stop + 1;
    }
    if (!pieces.empty()) lines_.push_back(std::move(pieces));
  }
  if (lines_.empty()) return;
  const Piece& first = lines_.back().front();
  if (first.size() == 1 && first.front().place == Place::kCount) first_word_ = first.front().text;
}

bool LineTemplate::uses(Place place) const {
  for (const Line& line : lines_) {
    for (const Piece& piece : line) {
      for (const Part& part : piece) {
        if (part.place == place) return true;
      }
    }
  }
  return false;
}

std::string LineTemplate::filled(const Line& line, size_t first, const PlaceValues& values) {
  std::string text;
  bool places = false, filled_any = false;
  for (size_t i = first; i < line.size(); ++i) {
    const size_t before = text.size();
    bool any = false, has_place = false;
    if (before > 0) text += ' ';
    for (const Part& part : line[i]) {
      const bool fixed = part.place == Place::kCount;
      const std::string& piece = fixed ? part.text : values.of(part.place);
      has_place |= !fixed;
      any |= !fixed && !piece.empty();
      text += piece;
    }
    if (has_place && !any) text.resize(before);
    places |= has_place;
    filled_any |= any;
  }
  return places && !filled_any ? std::string() : text;
}

void LineTemplate::fill(const PlaceValues& values, std::vector<std::string>& out) const {
  for (const Line& line : lines_) {
    std::string text = filled(line, 0, values);
    if (!text.empty()) out.emplace_back(std::move(text));
  }
}

void LineTemplate::fill_without_first(const PlaceValues& values, std::vector<std::string>& out) const {
  for (size_t i = 0; i < lines_.size(); ++i) {
    std::string text = filled(lines_[i], i + 1 == lines_.size() ? 1 : 0, values);
    if (!text.empty()) out.push_back(std::move(text));
  }
}

}  // namespace swarf::post

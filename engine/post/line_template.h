// Lines of a program with places for what the plan says: "G1 {axes} {F}".
//
//  - A line is cut at its spaces. A piece whose places are all empty is left out, and with it the space: what
//    is modal and has not changed leaves no trace. A line with places of which none is filled is not written.
//  - Within quotes a space does not cut.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace swarf::post {

/// What can stand between { and }. README.md says what each is and where it may stand.
enum class Place {
  kAxes,
  kRotaries,
  kAcross,
  kAlong,
  kHomeAlong,  // axis words
  kCentre,
  kCentrePoint,
  kF,
  kS,
  kT,
  kName,
  kText,
  kSeconds,
  kNumber,
  kMachine,
  kSource,
  kProgram,
  kBottom,
  kClear,
  kSurface,
  kRetract,
  kReturn,  // heights of a cycle
  kDepth,
  kClearance,
  kSecondClearance,
  kStep,
  kStepFirst,
  kDwell,
  kFeed,
  kPitch,
  kTurn1,
  kTurn2,
  kTurn3,
  kSide,  // of a tilted plane
  kUnit,
  kCount
};
inline constexpr size_t kPlaces = static_cast<size_t>(Place::kCount);
/// "axes" and so on, in the order of Place.
std::span<const char* const> place_names();

/// What is put in, by Place; what is not set is empty.
class PlaceValues {
 public:
  void set(Place place, std::string text) { text_[static_cast<size_t>(place)] = std::move(text); }
  const std::string& of(Place place) const { return text_[static_cast<size_t>(place)]; }
  void clear() {
    for (std::string& one : text_) one.clear();
  }

 private:
  std::array<std::string, kPlaces> text_;
};

class LineTemplate {
 public:
  /// No line.
  LineTemplate() = default;
  /// `bad` receives the first { } that is none of `allowed`, or the text of a { without }; empty: it is
  /// right.
  LineTemplate(std::string_view text, std::span<const Place> allowed, std::string& bad);

  bool empty() const { return lines_.empty(); }
  /// True when the place stands somewhere in it.
  bool uses(Place place) const;
  /// Appends each line that has something to `out`, without line break.
  void fill(const PlaceValues& values, std::vector<std::string>& out) const;
  /// The first piece of the last line where that is a fixed word: "G1".
  const std::string& first_word() const { return first_word_; }
  /// The same without the first piece of the last line (a modal word that still holds).
  void fill_without_first(const PlaceValues& values, std::vector<std::string>& out) const;

 private:
  struct Part {
    std::string text;
    Place place = Place::kCount;  ///< kCount: fixed text
  };
  using Piece = std::vector<Part>;
  using Line = std::vector<Piece>;
  static bool read_piece(std::string_view text, std::span<const Place> allowed, Piece& piece,
                         std::string& bad);
  static std::string filled(const Line& line, size_t first, const PlaceValues& values);

  std::vector<Line> lines_;
  std::string first_word_;
};

}  // namespace swarf::post

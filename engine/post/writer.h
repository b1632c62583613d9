// The plan as text, in the words of a PostFormat.
//
//  Order of the blocks, the same for all: head; for each approach end of cycle, TCP off, retract, tool
//  change, spindle, rotary axes, across, length and down, TCP on; then the moves; tail. Axis words are
//  written where their text changes, F where it changes (in inverse time always), and all anew where their
//  meaning does.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "post/plan.h"
#include "post/planner.h"
#include "post/post_format.h"

namespace swarf::post {

/// What the head and the tail may name.
struct ProgramNames {
  std::string program, machine, source;
};

struct WriterSummary {
  long blocks = 0;                       ///< lines written
  std::vector<std::string> not_written;  ///< words of the CL data that came to nothing, each once
  long comments_changed = 0;             ///< comments that lost characters, or their end
};

class Writer {
 public:
  using Out = std::function<void(std::string_view)>;
  /// References must outlive it.
  Writer(const PostFormat& format, const PlannerSetup& setup, const ProgramNames& names, Out out,
         Diagnostics& diagnostics);

  /// To be called once before and after the stretches.
  void head();
  void stretch(const PlannedStretch& planned);
  /// Retracts, stops spindle and coolant.
  void tail();
  const WriterSummary& summary() const { return summary_; }

 private:
  using Words = std::array<std::string, 6>;
  void put(const LineTemplate& lines);
  void put_line(std::string_view text);
  void comment(std::string_view text);
  /// A word of the CL data that the format has nothing for.
  void not_written(const std::string& word);
  void note(const program::ClNote& note);
  void coolant(const std::string& text);
  void set_coolant(const std::string& word);
  void approach(const PlanStep& step);
  void change_tool(const PlanStep& step);
  void spindle(double rpm);
  void dwell(double seconds);
  void set_tcp(bool on);
  void set_plane(int plane);
  void set_tilt(const std::shared_ptr<const TiltedPlane>& tilt);
  void set_timed(bool timed);
  void move(const PlanStep& step);
  void arc_words(const PlanStep& step);
  void feed_word(const PlanStep& step);
  void motion(const LineTemplate& lines);
  void hole(const PlanStep& step, const program::ClHole& hole);
  bool merges_with(const PlanStep& arrival, const PlanStep& step, const program::ClHole& hole);
  std::string definition(const PlanStep& step, const program::ClHole& hole);
  void end_cycle();
  Words words_of(const PlanStep& step) const;
  /// Those that differ from what stands, or all; `keep`: they stand from now on.
  std::string changed(const Words& words, bool all);
  void forget_words();

  const PostFormat& format_;
  const PlannerSetup& setup_;
  const ProgramNames& names_;
  Out out_;
  Diagnostics& diagnostics_;
  WriterSummary summary_;
  PlaceValues values_;
  std::vector<std::string> lines_;
  std::string line_;

  std::array<bool, 6> has_{};  ///< X Y Z A B C: the machine has it
  int along_ = 2;              ///< of them, the one along the tool
  Words words_;                ///< as they stand; "": unknown
  Vec3 p_ = Vec3::Zero();      ///< as written: the start of the next arc
  std::string feed_, motion_word_, cycle_;
  int plane_ = 0, tool_ = -2, block_ = 0;
  bool tcp_ = false, timed_ = false;
  std::shared_ptr<const TiltedPlane> tilt_;
  double spindle_ = 0.0;
  std::string coolant_, coolant_wanted_;  ///< as it stands, and as the CL data has it
  bool change_comes_ = false;             ///< the next step changes the tool
};

}  // namespace swarf::post

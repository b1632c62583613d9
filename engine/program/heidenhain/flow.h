// Which block of a Heidenhain program comes next: labels, repeats, jumps, called programs.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "program/control/call_stack.h"
#include "program/heidenhain/parameters.h"
#include "program/heidenhain/text.h"

namespace swarf::program::nc::heidenhain {

/// The levels that a control has for CALL LBL and for CALL PGM.
inline constexpr size_t kLevelsMax = 19;

class Flow {
 public:
  Flow(nc::Control& control, Parameters& parameters) : control_(control), parameters_(parameters) {}

  void open(const std::string& path);
  /// The next block to execute, valid until the call after the next; null at the end of the program.
  /// "missing-end": the file ends without END PGM.
  const BlockText* next();
  /// The block that stands behind the present one in the text, null when it is the last.
  const BlockText* following();

  /// Labels, each behind its word. False when the block is not about the flow.
  bool statement(BlockReader& reader);
  /// FN 9 to FN 12, behind the colon.
  void conditional(BlockReader& reader, int number);
  /// END PGM: back to the caller, or the end.
  void end_of_program(BlockReader& reader);
  /// M2, M30.
  void stop(BlockReader& reader, size_t offset);

 private:
  /// A running program.
  struct Level {
    std::unique_ptr<nc::LineSource> source;
    BlockText ahead;
    bool ahead_valid = false;
    std::map<std::string, nc::LineSource::Mark> labels;
    bool labels_read = false;
    nc::CallStack<nc::LineSource::Mark> returns;  ///< where LBL 0 goes back to
    std::map<int, long> repeats;                  ///< line of CALL LBL REP -> how often it still repeats
    std::map<int, double> outer_local;
  };
  bool fetch(Level& level);
  std::string label(BlockReader& reader);
  void read_labels(Level& level);
  void go(BlockReader& reader, const std::string& name, size_t offset);
  void go(Level& level, const nc::LineSource::Mark& mark);
  void call_label(BlockReader& reader);
  static std::string program_name(BlockReader& reader);
  void call_program(BlockReader& reader, std::string name, size_t offset);
  void set_label(BlockReader& reader);

  nc::Control& control_;
  Parameters& parameters_;
  nc::CallStack<std::unique_ptr<Level>> levels_;
  BlockText now_;
  std::vector<std::pair<int, std::string>> comments_;
  std::string selected_;  ///< by SEL PGM
  bool ended_ = false;
};

}  // namespace swarf::program::nc::heidenhain

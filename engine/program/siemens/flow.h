// Which block of a Siemens 840D program comes next: loops, jumps, subprograms, declarations.
//
// Blocks that are not about the flow go to a BlockTarget, which knows the words of the machine.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/control/call_stack.h"
#include "program/siemens/expression.h"
#include "program/siemens/source.h"

namespace swarf::program::nc::siemens {

enum class Outcome {
  kNext,
  kPattern,  ///< as kNext; the block was a position pattern, at each place of which MCALL works
  kContour,  ///< as kNext; the blocks of contour_asked() come next, then contour_read()
  kReturn,
  kEnd,
};

/// The blocks of a contour: "PROGRAM", "FIRST:LAST" (labels of the running program), "PROGRAM:FIRST:LAST".
struct ContourName {
  std::string text;
  size_t offset = 0;  ///< in the block that asks for it
};

/// Executes the blocks of words.
class BlockTarget : public SystemVariables {
 public:
  /// The rest of a block, from the reader's place on.
  virtual Outcome block(TokenReader& reader, Variables& variables) = 0;
  /// Whether a name belongs to the language: no variable and no program can have it.
  virtual bool knows(const std::string& name) const = 0;
  /// Every name it knows, to propose the nearest one.
  virtual const std::vector<std::string>& names() const = 0;
  /// Words without effect: declarations that are read over, a block skip that is off.
  virtual void note(const std::string& word, const std::string& text, const std::string& file, int line) = 0;
  /// True for a program of the machine's builder that moves nothing, and is listed.
  virtual bool takes_builders(const std::string& name, const LineRef& line) = 0;
  virtual ContourName contour_asked() const = 0;
  /// All blocks of the contour have run.
  virtual void contour_read() = 0;
  /// Moves so far: loops that move nothing are endless.
  virtual long moves() const = 0;
};

struct FlowLimits {
  int levels_max = 16;       ///< program levels of the control
  long jumps_max = 200'000;  ///< jumps back without a move in between
};

/// A parameter that goes back to the caller's variable.
struct Returned {
  std::string parameter, variable;
};
/// A running program, or a repeated part of one.
struct Level {
  int file = 0;
  int next = 0, first = 0, stop = 0;  ///< lines from 0; stop is not run
  int again = 0;                      ///< how often it is still repeated
  bool part = false;                  ///< a repeated part of the level below
  bool contour = false;               ///< the blocks of a contour
  int entry = -1;                     ///< the line of PROC
  std::shared_ptr<Scope> scope;
  std::vector<Returned> returned;
};
/// MCALL: the program and its arguments, called after each block with a move.
struct ModalCall {
  int file = -1;
  std::vector<Value> arguments;
  size_t depth = 0;  ///< levels where it was written: what it calls does not call it again
};
/// One value of a call.
struct Argument {
  std::optional<Value> value;  ///< none: left out
  std::string variable;        ///< when it is nothing but the name of one
  size_t offset = 0;
};
/// What PROC says of one parameter.
struct Parameter {
  std::string name;
  Type type = Type::kReal;
  bool returned = false;  ///< VAR
};

/// The files that were read, and where subprograms are.
struct Programs {
  std::vector<std::string> folders;
  std::vector<std::unique_ptr<Source>> sources;
  std::map<std::string, std::string> found;  ///< name of a subprogram -> path, "" when there is none
};

struct RunningLine {
  std::string text;
  LineRef running;  ///< the block that is running, in text
  std::vector<Token> tokens;
  int current = 0;  ///< line that is running, from 0
};

struct Counts {
  long lines = 0, blocks = 0, jumps = 0, moves_seen = 0;
  bool stopped = false;  ///< after the block that is running (the user pressed Ctrl-C)
  bool ended = false;    ///< a word ended the program (M2, M30, M17, RET), not the end of its file
};

/// Which block comes next.
struct Flow {
  Flow(BlockTarget& blocks, std::vector<std::string> subprogram_folders, FlowLimits most = {});

  BlockTarget& target;
  FlowLimits limits;
  Variables variables;
  Programs programs;
  CallStack<Level> levels;
  ModalCall modal;
  RunningLine line;
  Counts counts;
};

/// The level that runs, and its file.
inline Level& top(Flow& flow) {
  return flow.levels.top();
}
inline Source& source(Flow& flow) {
  return *flow.programs.sources[static_cast<size_t>(top(flow).file)];
}

/// Runs a program and what it calls. Throws InputError for the first thing that is wrong:
///   "unknown-word", "unknown-subprogram", "unknown-label", "endless-loop", "recursion-limit",
///   "reserved-name", "wrong-arguments", "bad-block", and what Source, Variables and the formulas refuse.
void run(Flow& flow, const std::string& path);

/// Reads REAL, INT, BOOL or STRING; CHAR, AXIS, FRAME, CHAN and NCK are known and refused.
Type read_type(TokenReader& reader);
/// Assigns when a variable and '=' stand here: NAME=, NAME[i]=, R5=, R[i]=. False when they do not.
bool assign(TokenReader& reader, Variables& variables);

}  // namespace swarf::program::nc::siemens

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

#include "program/siemens/expression.h"
#include "program/siemens/source.h"

namespace swarf::program::nc::siemens {

enum class Outcome {
  kNext,
  kPattern,  ///< as kNext; the block was a position pattern, at each place of which MCALL works
  kReturn,
  kEnd,
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
  /// Moves so far: loops that move nothing are endless.
  virtual long moves() const = 0;
};

struct FlowLimits {
  int levels_max = 16;       ///< program levels of the control
  long jumps_max = 200'000;  ///< jumps back without a move in between
};

/// Runs a program and what it calls. Throws InputError for the first thing that is wrong:
///   "unknown-word", "unknown-subprogram", "unknown-label", "endless-loop", "too-deep", "reserved-name",
///   "wrong-arguments", "bad-block", and what Source, Variables and the formulas refuse.
class Flow {
 public:
  Flow(BlockTarget& target, std::vector<std::string> subprogram_folders, FlowLimits limits = {});
  ~Flow();

  void run(const std::string& path);
  /// Stops after the block that is running (the user pressed Ctrl-C).
  void stop() { stopped_ = true; }

  /// The program, then each file it called.
  std::vector<std::string> files() const;
  /// A word ended the program (M2, M30, M17, RET), not the end of its file.
  bool ended() const { return ended_; }
  long lines() const { return lines_; }
  long blocks() const { return blocks_; }

 private:
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
  using Handler = void (Flow::*)(TokenReader&);

  void statement();
  void skip_head(TokenReader& reader);
  void words(TokenReader& reader);
  bool leave_level(bool to_caller);
  void jump(int index, const LineRef& from);
  void finish_block(TokenReader& reader, std::string_view after);

  static Handler handler_of(const std::string& word);
  void on_if(TokenReader& reader);
  void on_else(TokenReader& reader);
  void on_nothing(TokenReader& reader);
  void on_while(TokenReader& reader);
  void on_back(TokenReader& reader);
  void on_for(TokenReader& reader);
  void on_endfor(TokenReader& reader);
  void on_until(TokenReader& reader);
  void on_repeat(TokenReader& reader);
  void on_goto(TokenReader& reader);
  void on_case(TokenReader& reader);
  void on_def(TokenReader& reader);
  void on_proc(TokenReader& reader);
  void on_extern(TokenReader& reader);
  void on_call(TokenReader& reader);
  void on_mcall(TokenReader& reader);

  bool condition(TokenReader& reader);
  void go(TokenReader& reader);
  void declare(TokenReader& reader, Type type, size_t text_max);
  bool for_goes_on(TokenReader& reader, const LineRef& head, bool first);
  int loaded(const std::string& name);
  bool subprogram_here(TokenReader& reader);
  void call_here(TokenReader& reader, const std::string& name, size_t offset);
  void call(int file, TokenReader* arguments, const std::vector<Value>& values, int times);
  std::vector<Argument> read_arguments(TokenReader& reader);
  std::vector<Parameter> read_parameters(TokenReader& reader);
  void bind(Level& level, TokenReader* arguments, const std::vector<Value>& values);

  Level& top() { return levels_.back(); }
  Source& source() { return *sources_[static_cast<size_t>(top().file)]; }

  BlockTarget& target_;
  std::vector<std::string> folders_;
  FlowLimits limits_;
  Variables variables_;
  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<Level> levels_;
  std::map<std::string, std::string> found_;  ///< name of a subprogram -> path, "" when there is none
  ModalCall modal_;
  std::string text_;
  LineRef running_;  ///< the block that is running, in text_
  std::vector<Token> tokens_;
  int current_ = 0;  ///< line that is running, from 0
  long lines_ = 0, blocks_ = 0, jumps_ = 0, moves_seen_ = 0;
  bool stopped_ = false, ended_ = false;
};

/// Reads REAL, INT, BOOL or STRING; CHAR, AXIS, FRAME, CHAN and NCK are known and refused.
Type read_type(TokenReader& reader);
/// Assigns when a variable and '=' stand here: NAME=, NAME[i]=, R5=, R[i]=. False when they do not.
bool assign(TokenReader& reader, Variables& variables);

}  // namespace swarf::program::nc::siemens

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "base/units.h"
#include "program/cl_program.h"
#include "program/cl_statement.h"
#include "program/source_text.h"

namespace swarf::program {
namespace {

/// CL words that other versions of APT have and this reader does not follow yet.
constexpr std::array kUnsupported{"CYCLE",  "CUTCOM", "MSYS",   "CSYS",   "TLDATA", "MOVNRB", "INTOL",
                                  "OUTTOL", "MACHIN", "ROTABL", "ROTATE", "ORIGIN", "GOHOME", "DELAY",
                                  "ARCSLP", "CLAMP",  "MODE",   "TOOLNO", "TRANS",  "LOAD",   "SELECT"};

class Reader {
 public:
  Reader(const std::string& file, Diagnostics& diagnostics) : reporter_(diagnostics, file) {
    program_.file = file;
  }

  ClProgram read(const std::string& text) {
    if (!check_text(text, reporter_, "give CL data, for example GOTO/10,20,30 on a line")) return {};
    ClScanner scanner(text);
    ClStatement statement;
    while (scanner.next(statement, reporter_)) {
      ++program_.statements;
      if (ended_) {
        reporter_.error("word-after-end", statement.line, statement.column,
                        fmt::format("{} stands after FINI", statement.word),
                        "FINI ends the program: remove what follows, or the FINI");
        break;
      }
      take(statement);
    }
    finish();
    return std::move(program_);
  }

 private:
  struct Entry {
    const char* word;
    void (Reader::*handler)(const ClStatement&);
  };
  /// The most frequent words first.
  static std::span<const Entry> words() {
    static constexpr Entry kWords[] = {
        {"GOTO", &Reader::go_to},        {"FEDRAT", &Reader::feed_rate}, {"RAPID", &Reader::rapid},
        {"GODLTA", &Reader::go_delta},   {"CIRCLE", &Reader::circle},    {"FROM", &Reader::from},
        {"PPRINT", &Reader::note},       {"INSERT", &Reader::note},      {"REMARK", &Reader::note},
        {"PARTNO", &Reader::note},       {"COOLNT", &Reader::note},      {"SPINDL", &Reader::spindle},
        {"MULTAX", &Reader::multi_axis}, {"LOADTL", &Reader::load_tool}, {"CUTTER", &Reader::cutter},
        {"UNITS", &Reader::units},       {"FINI", &Reader::end}};
    return kWords;
  }

  void take(const ClStatement& statement) {
    for (const Entry& entry : words()) {
      if (statement.word == entry.word) return (this->*entry.handler)(statement);
    }
    if (std::find(kUnsupported.begin(), kUnsupported.end(), statement.word) != kUnsupported.end()) {
      fault("unsupported-word", statement,
            fmt::format("{} is a known CL word, but this version does not follow it", statement.word),
            "post the file without it, or write its motion as GOTO");
      return;
    }
    std::vector<std::string> known;
    for (const Entry& entry : words()) known.emplace_back(entry.word);
    const std::string nearest = nearest_name(statement.word, known);
    fault("unknown-word", statement, fmt::format("{} is not a word of CL data", statement.word),
          nearest.empty() ? fmt::format("known are {}", fmt::join(known, ", "))
                          : fmt::format("did you mean {}?", nearest));
  }

  void fault(const char* code, const ClStatement& at, std::string text, std::string fix) {
    reporter_.error(code, at.line, at.column, std::move(text), std::move(fix));
  }
  void fault(const char* code, const ClArgument& at, std::string text, std::string fix) {
    reporter_.error(code, at.line, at.column, std::move(text), std::move(fix));
  }

  /// True when all arguments are numbers and their count is one of the two.
  bool numbers(const ClStatement& s, size_t few, size_t many, const char* form) {
    for (const ClArgument& argument : s.arguments) {
      if (argument.number) continue;
      fault("wrong-arguments", argument, fmt::format("{} takes numbers, '{}' is none", s.word, argument.text),
            fmt::format("write {}", form));
      return false;
    }
    const size_t count = s.arguments.size();
    if (count == few || count == many) return true;
    fault("wrong-arguments", s, fmt::format("{} has {} numbers", s.word, count),
          fmt::format("write {}", form));
    return false;
  }

  static Vec3 vector_at(const ClStatement& s, size_t first) {
    return {s.arguments[first].value, s.arguments[first + 1].value, s.arguments[first + 2].value};
  }

  /// The unit vector of three numbers.
  bool unit_vector(const ClStatement& s, size_t first, const char* what, Vec3& unit) {
    const Vec3 given = vector_at(s, first);
    const double length = given.norm();
    if (std::abs(length - 1.0) > kAxisLengthTolerance) {
      fault("axis-not-unit", s.arguments[first],
            fmt::format("the {} ({:g}, {:g}, {:g}) has length {:.6g}", what, given.x(), given.y(), given.z(),
                        length),
            fmt::format("write a vector of length 1 (within {:g})", kAxisLengthTolerance));
      return false;
    }
    unit = given / length;
    return true;
  }

  /// Tip and axis of GOTO and FROM.
  bool pose_of(const ClStatement& s, ToolPose& pose) {
    const char* form = "x,y,z or x,y,z,i,j,k (mm, unit vector), for example GOTO/10,20,30,0,0,1";
    if (!numbers(s, 3, 6, form)) return false;
    pose.tip_W = vector_at(s, 0);
    if (s.arguments.size() == 6) {
      if (!multi_axis_) {
        fault("missing-multax", s.arguments[3],
              fmt::format("{} gives a tool axis while MULTAX is off", s.word), "write MULTAX/ON before it");
        return false;
      }
      return unit_vector(s, 3, "tool axis", pose.axis_W);
    }
    if (!axis_known_) {
      fault("missing-axis", s, fmt::format("{} gives no tool axis, and none stands before it", s.word),
            "give x,y,z,i,j,k in the first position after MULTAX/ON");
      return false;
    }
    pose.axis_W = axis_W_;
    return true;
  }

  void go_to(const ClStatement& s) {
    ToolPose to;
    if (pose_of(s, to)) move_to(s, to);
    rapid_ = false;
    arc_.reset();
  }

  void go_delta(const ClStatement& s) {
    if (!positioned_) {
      fault("no-position", s, "GODLTA moves from a position, and none has been given",
            "give FROM or GOTO first");
    } else if (numbers(s, 3, 3, "GODLTA/dx,dy,dz (mm)")) {
      move_to(s, {pose_.tip_W + vector_at(s, 0), axis_W_});
    }
    rapid_ = false;
    arc_.reset();
  }

  void from(const ClStatement& s) {
    if (positioned_) {
      fault("from-not-first", s, "FROM stands after a position has been given",
            "FROM gives the start: put it first, or write GOTO");
      return;
    }
    ToolPose pose;
    if (pose_of(s, pose)) start_at(s, pose);
  }

  void start_at(const ClStatement& s, const ToolPose& pose) {
    program_.start = pose_ = pose;
    axis_W_ = pose.axis_W;
    program_.start_line = s.line;
    positioned_ = axis_known_ = true;
  }

  void move_to(const ClStatement& s, const ToolPose& to) {
    if (!positioned_) {
      if (arc_) fault("no-position", s, "an arc needs a position to start from", "give FROM or GOTO first");
      start_at(s, to);
      return;
    }
    if (!rapid_ && feed_mm_s_ == 0.0) {
      // Once is enough: every move that follows has the same fault.
      if (!feed_missed_) {
        fault("missing-feed", s, fmt::format("{} moves without a feed", s.word),
              "write FEDRAT/500,MMPM or RAPID before it");
      }
      feed_missed_ = true;
    }
    ClMove move{pose_, to, arc_, rapid_ ? 0.0 : feed_mm_s_, spindle_rpm_, tool_, s.line, s.column};
    if (!arc_ || arc_fits(s, move)) program_.moves.push_back(std::move(move));
    pose_ = to;
    axis_W_ = to.axis_W;
  }

  bool arc_fits(const ClStatement& s, const ClMove& move) {
    if (rapid_) {
      fault("bad-arc", s, "an arc stands in a rapid move", "take the RAPID away: an arc needs a feed");
      return false;
    }
    for (const Vec3& tip : {move.from.tip_W, move.to.tip_W}) {
      const Vec3 arm = tip - move.arc->centre_W;
      const double height = arm.dot(move.arc->normal_W);
      const double radius = (arm - height * move.arc->normal_W).norm();
      if (std::abs(radius - arc_radius_) <= kArcTolerance && std::abs(height) <= kArcTolerance) continue;
      fault("bad-arc", s,
            fmt::format("({:.4f}, {:.4f}, {:.4f}) does not lie on the circle of radius {:.4f} mm: its "
                        "distance from the axis is {:.4f} mm, from the plane {:.4f} mm",
                        tip.x(), tip.y(), tip.z(), arc_radius_, radius, std::abs(height)),
            fmt::format("both ends must lie on the circle within {:g} mm", kArcTolerance));
      return false;
    }
    return true;
  }

  void circle(const ClStatement& s) {
    const char* form = "CIRCLE/cx,cy,cz,i,j,k,r (mm, unit vector)";
    // CAM systems append tolerances and the tool's diameter; they are checked to be numbers, not used.
    if (s.arguments.size() < 7 || !numbers(s, s.arguments.size(), 7, form)) {
      if (s.arguments.size() < 7) {
        fault("wrong-arguments", s, fmt::format("CIRCLE has {} arguments", s.arguments.size()),
              fmt::format("write {}", form));
      }
      return;
    }
    ClArc arc;
    arc.centre_W = vector_at(s, 0);
    arc_radius_ = s.arguments[6].value;
    if (!unit_vector(s, 3, "circle's axis", arc.normal_W)) return;
    if (arc_radius_ <= kArcTolerance) {
      fault("out-of-range", s.arguments[6], fmt::format("the circle's radius is {:g} mm", arc_radius_),
            fmt::format("it must be above {:g} mm", kArcTolerance));
      return;
    }
    arc_ = arc;
  }

  void rapid(const ClStatement& s) {
    if (!s.arguments.empty()) {
      fault("wrong-arguments", s.arguments[0], "RAPID has an argument", "write RAPID alone");
    }
    rapid_ = true;
  }

  void feed_rate(const ClStatement& s) {
    const char* form = "write FEDRAT/500,MMPM (mm/min)";
    const ClArgument* value = nullptr;
    for (const ClArgument& argument : s.arguments) {
      if (argument.number && value == nullptr) {
        value = &argument;
      } else if (argument.text != "MMPM" && argument.text != "PERMIN") {
        fault("unsupported-word", argument, fmt::format("FEDRAT with '{}' is not followed", argument.text),
              form);
        return;
      }
    }
    if (value == nullptr) {
      fault("wrong-arguments", s, "FEDRAT has no number", form);
    } else if (!(value->value > 0.0)) {
      fault("out-of-range", *value, fmt::format("the feed is {:g} mm/min", value->value),
            "it must be above 0");
    } else {
      feed_mm_s_ = mm_s_from_mm_min(value->value);
    }
  }

  void spindle(const ClStatement& s) {
    double rpm = spindle_rpm_;
    for (const ClArgument& argument : s.arguments) {
      if (argument.number) {
        rpm = argument.value;
      } else if (argument.text == "OFF") {
        rpm = 0.0;
      } else if (argument.text != "CLW" && argument.text != "CCLW" && argument.text != "RPM" &&
                 argument.text != "ON") {
        fault("unsupported-word", argument, fmt::format("SPINDL with '{}' is not followed", argument.text),
              "write SPINDL/8000,CLW (rev/min) or SPINDL/OFF");
        return;
      }
      if (rpm < 0.0) {
        fault("out-of-range", argument, fmt::format("the spindle speed is {:g} rev/min", rpm),
              "it must not be below 0; CCLW turns the other way");
        return;
      }
    }
    spindle_rpm_ = rpm;
  }

  void multi_axis(const ClStatement& s) {
    const bool on = s.arguments.empty() || s.arguments[0].text == "ON";
    if (s.arguments.size() > 1 || (!on && s.arguments[0].text != "OFF")) {
      fault("wrong-arguments", s, "MULTAX is followed by neither ON nor OFF",
            "write MULTAX/ON or MULTAX/OFF");
      return;
    }
    // Without MULTAX the axis is (0,0,1); with it, it has to be given once.
    if (!on) axis_W_ = Vec3::UnitZ();
    axis_known_ = !on || positioned_;
    multi_axis_ = on;
  }

  void load_tool(const ClStatement& s) {
    const double number = s.arguments.empty() || !s.arguments[0].number ? 0.0 : s.arguments[0].value;
    if (number < 1.0 || number > 99999999.0 || number != std::floor(number)) {
      fault("wrong-arguments", s, "LOADTL gives no tool number", "write LOADTL/1");
      return;
    }
    tool_ = static_cast<int>(number);
  }

  void cutter(const ClStatement& s) {
    if (s.arguments.empty() || s.arguments.size() > 7 || !numbers(s, s.arguments.size(), 7, "CUTTER/d,r")) {
      if (s.arguments.empty() || s.arguments.size() > 7) {
        fault("wrong-arguments", s, fmt::format("CUTTER has {} numbers", s.arguments.size()),
              "write CUTTER/d,r or all seven: CUTTER/d,r,e,f,alpha,beta,h (mm, degrees)");
      }
      return;
    }
    ClCutter cutter{{}, reporter_.at(s.line, s.column)};
    for (const ClArgument& argument : s.arguments) cutter.parameters.push_back(argument.value);
    program_.cutters.push_back(std::move(cutter));
  }

  void units(const ClStatement& s) {
    if (s.arguments.size() == 1 && s.arguments[0].text == "MM") return;
    fault("unsupported-word", s, "UNITS is not followed by MM", "write UNITS/MM and all lengths in mm");
  }

  void note(const ClStatement& s) {
    std::string text = s.text;
    for (const ClArgument& argument : s.arguments) {
      if (!text.empty()) text += ',';
      text += argument.text;
    }
    program_.notes.push_back({s.word, std::move(text), s.line});
  }

  void end(const ClStatement&) { ended_ = true; }

  void finish() {
    if (reporter_.errors() > 0 || !program_.moves.empty()) return;
    reporter_.error("no-motion", 0, 0,
                    positioned_ ? "the program has one position and no move" : "the program has no position",
                    "give at least two positions with GOTO");
  }

  Reporter reporter_;
  ClProgram program_;
  ToolPose pose_;
  Vec3 axis_W_ = Vec3::UnitZ();  ///< of a position that gives none
  bool positioned_ = false;
  bool axis_known_ = true;  ///< (0,0,1) while MULTAX is off
  bool multi_axis_ = false;
  bool rapid_ = false, ended_ = false, feed_missed_ = false;
  double feed_mm_s_ = 0.0, spindle_rpm_ = 0.0, arc_radius_ = 0.0;
  int tool_ = 0;
  std::optional<ClArc> arc_;
};

}  // namespace

ClProgram parse_cl(const std::string& text, const std::string& file, Diagnostics& diagnostics) {
  return Reader(file, diagnostics).read(text);
}

ClProgram load_cl(const std::string& path, Diagnostics* warnings) {
  Diagnostics diagnostics;
  ClProgram program = parse_cl(read_file(path), path, diagnostics);
  diagnostics.throw_if_errors();
  if (warnings != nullptr) warnings->append(diagnostics);
  return program;
}

}  // namespace swarf::program

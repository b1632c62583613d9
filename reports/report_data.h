// Everything that report.html shows, as plain data: filled by the run, laid out by report_writer.
//
// Numbers arrive as the text that is to be read, with their unit beside them, because only the one who
// measured knows how many digits mean something. An empty list or path leaves its section out of the page.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "papers/paper_row.h"

namespace swarf::reports {

/// How a value is to be read; always shown in words or by a sign too, never by colour alone.
enum class Tone { kNeutral, kOk, kWarning, kBad };

/// How a check came out. The page shows it and decides nothing.
enum class State { kHolds, kFails, kNotProven, kNotChecked };

/// One check with a limit.
struct Criterion {
  std::string name{};      ///< "Highest scallop"
  std::string measured{};  ///< "10.02 µm"
  std::string limit{};     ///< "at most 10.5 µm"
  State state = State::kNotChecked;
};

struct Verdict {
  bool pass = false;
  std::string headline;  ///< one sentence that says what was not judged too
  std::vector<Criterion> criteria;
};

/// One of the six to eight figures that a reader looks for first.
struct KeyNumber {
  std::string label{};  ///< "Highest scallop"
  std::string value{};  ///< "10.02"
  std::string unit{};   ///< "µm"; empty for a count
  std::string hint{};   ///< "theory 10.00 µm"; may be empty
  Tone tone = Tone::kNeutral;
};

/// A line of the program with its number.
struct ProgramLine {
  int line = 0;
  std::string text{};
};

/// What has one cause at one place, as the worst of it says.
struct ReportFinding {
  std::string code;  ///< stable, kebab-case: "gouge"
  Severity severity = Severity::kError;
  std::string text{};      ///< what was found, with units
  std::string fix{};       ///< the smallest change that would help; may be empty
  SourceLocation where{};  ///< the worst one's block; file empty: not tied to one
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< program time; NaN: not tied to one
  std::string block{};                 ///< the program's text there; empty: not tied to a line
  size_t count = 1;                    ///< findings that are one fault with it, itself too
  int first_line = 0, last_line = 0;   ///< of them all; 0: not tied to lines
  std::vector<ProgramLine> excerpt{};  ///< the block and its neighbours
  std::string picture_png{};           ///< path; empty: none
  std::array<double, 3> place_mm{};    ///< of the worst one, if one of the next two says so
  bool has_place = false;              ///< on the part, W
  bool in_machine = false;             ///< in the machine at time_s, M
};

struct Column {
  std::string title{};
  std::string unit{};    ///< shown under the title; empty: none
  bool numeric = false;  ///< right-aligned, figures of equal width
};

struct Table {
  std::string title{};
  std::string intro{};  ///< a sentence above the table; may be empty
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`
  std::vector<std::string> notes{};            ///< below the table
  int highlighted_row = -1;                    ///< the one that this run used; -1: none
  std::vector<std::string> pictures{};         ///< SVG before each row; empty: no such column
};

/// What was checked, and what was not, with the reason.
struct Check {
  std::string what;      ///< "Forward of inverse, all ticks"
  std::string result{};  ///< "largest 3.1e-13 mm, limit 1e-9 mm"
  std::string reason{};  ///< needed for kNotChecked and kNotProven
  State state = State::kNotChecked;
};

struct Series {
  std::string name{};
  std::vector<std::array<double, 2>> points;  ///< (x, y); a NaN breaks the line
};

struct Bar {
  double low = 0.0, high = 0.0;  ///< on the x axis
  double value = 0.0;
};

/// A limit or a theoretical value, drawn across the plot.
struct LimitLine {
  double value = 0.0;
  std::string label{};
  bool vertical = false;  ///< true: at x = value
};

/// Lines, or a histogram when `bars` is filled.
struct Plot {
  std::string title{};
  std::string caption{};  ///< may be empty
  std::string x_label{}, x_unit{}, y_label{}, y_unit{};
  std::vector<Series> series{};
  std::vector<Bar> bars{};
  std::vector<LimitLine> limits{};
  bool y_from_zero = false;  ///< the y axis includes 0; always so for bars
};

/// A drawing that is no plot over one axis: finished SVG in the classes of the style sheet.
struct Figure {
  std::string title{};
  std::string svg{};
  std::string caption{};  ///< may be empty
  struct Entry {
    std::string css_class{};  ///< of its line in the drawing: "series s0"
    std::string name{};
  };
  std::vector<Entry> legend{};
  bool wide = false;  ///< takes the whole width of the page
};

struct Still {
  std::string png_path;
  std::string caption{};
};

/// The colours of deviation on the part: stops at equal distances from low to high.
struct ColourBar {
  std::string title{};  ///< "Deviation from the design"
  std::string unit{};
  double low = 0.0, high = 0.0;                         ///< places at its ends
  std::vector<std::array<uint8_t, 3>> stops;            ///< sRGB; empty: no legend
  std::vector<std::pair<double, std::string>> ticks{};  ///< value and label; empty: round values
  std::string apart{};                                  ///< a colour beside the bar: "not measured"
  std::array<uint8_t, 3> apart_colour{};                ///< sRGB
  double low_value = 0.0, high_value = 0.0;             ///< what the places at its ends stand for, in `unit`
};

/// The 3D view: glTF in metres with Y up; line objects can be switched on and off by their node's name.
struct Viewer3d {
  std::string part_glb;     ///< bytes; empty: no such tab
  std::string machine_glb;  ///< bytes; empty: no such tab
  ColourBar colour_bar;
  double program_seconds_per_animation_second = 1.0;
  std::string program{};  ///< JSON of page_program.h; empty: none
  std::string hanging{};  ///< of material above gaps; empty: there is none
};

/// A section of its own on one subject: figures above tables.
struct Topic {
  std::string id{};    ///< of the section in the page
  std::string name{};  ///< in the navigation
  std::string title{};
  std::string intro{};
  std::vector<Figure> figures{};
  std::vector<Table> tables{};
};

struct Fact {
  std::string name{};
  std::string value{};
};

/// "Program", "Machine", "Tool", "Build": what a run was made of. No dates, no host names: equal runs must
/// give equal files.
struct FactGroup {
  std::string title{};
  std::vector<Fact> facts{};
};

/// Whose job it is, beside the title.
struct JobHead {
  std::string logo_png{};  ///< path; empty: none
  std::vector<Fact> facts{};
};

struct ReportData {
  std::string title{};
  std::string subtitle;
  JobHead head{};
  Verdict verdict;
  std::vector<KeyNumber> key_numbers;
  std::vector<ReportFinding> findings;
  std::string findings_note{};  ///< below them; empty: none
  std::string hero_png;         ///< path of the still beside the key numbers; empty: none
  std::string hero_caption;
  Viewer3d viewer;
  std::string movie_mp4;  ///< path; empty: none
  /// It runs evenly over what is shown of the program, so that a time of the program has its second in it.
  bool movie_even = true;
  std::string movie_caption;
  std::vector<Still> stills;
  std::vector<Plot> plots;
  std::vector<Table> assumptions{};  ///< none or one: what was taken for what the scene leaves open
  std::vector<Table> tables;         ///< planner comparison, axes, Fig. 6, ...
  std::vector<Topic> topics{};
  std::vector<papers::PaperRow> paper;
  std::string paper_title;  ///< "Lin & Koren (1996)"
  std::vector<Check> checks;
  std::vector<std::string> reproduce;  ///< shell commands
  std::vector<FactGroup> facts{};
};

}  // namespace swarf::reports

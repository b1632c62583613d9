// Third and fourth step: the rules of a block's words, then what they do, in the control's order.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {
namespace {

bool is_cycle(int tenths) {
  return tenths == 730 || tenths == 740 || (tenths >= 810 && tenths <= 890);
}
bool is_arc(int tenths) {
  return tenths == 20 || tenths == 30;
}
constexpr int kCubic = 50, kQuadratic = 51, kNurbs = 52;

}  // namespace

bool LinuxCnc::uses_axis_words() const {
  if (!block_.has_g(kNonModal)) {
    const int length = block_.has_g(kLengthGroup) ? block_.g[kLengthGroup] : 0;
    return length == 431 || (length == 432 && !block_.has('H'));
  }
  const int code = block_.g[kNonModal];
  return code == 100 || code == 280 || code == 300 || code == 520 || code == 920;
}

void LinuxCnc::check_words() {
  for (const char letter : {'U', 'V', 'W'}) {
    if (block_.has(letter))
      control_.report.fail("axis-missing", column(letter),
                           fmt::format("the machine {} has no axis {}", control_.setup.machine.name, letter),
                           "take the word out, or choose the machine that the program was posted for");
  }
  if (nurbs_) return check_nurbs_words();
  check_letters();
  check_axes_and_motion();
  if (block_.has_g(kNonModal) && block_.g[kNonModal] == 40) need('P', "G4");
  check_feed_and_speed();
}

/// Words that only some codes take.
void LinuxCnc::check_letters() {
  const auto bit = [](char letter) { return 1u << (letter - 'A'); };
  const uint32_t rare =
      bit('D') | bit('E') | bit('H') | 7u << ('I' - 'A') | bit('L') | bit('P') | bit('Q') | bit('R');
  if ((block_.given & rare) == 0) return;
  const int non_modal = block_.has_g(kNonModal) ? block_.g[kNonModal] : -1;
  // A modal motion acts in blocks with axis words only.
  const bool acts = is_axis_given() && !uses_axis_words();
  const int motion = block_.has_g(kMotionGroup) ? block_.g[kMotionGroup] : acts ? motion_ : -1;
  const auto moves = [&](std::initializer_list<int> codes) {
    return std::find(codes.begin(), codes.end(), motion) != codes.end();
  };
  const auto has_m = [&](std::initializer_list<int> codes) {
    return std::any_of(codes.begin(), codes.end(), [&](int code) { return block_.has_m(code); });
  };
  const bool cycle = is_cycle(motion), arc = is_arc(motion), data = non_modal == 100;
  const bool radius = block_.has_g(kRadiusGroup) && block_.g[kRadiusGroup] != 400;
  const bool path = block_.has_g(kPathGroup) && block_.g[kPathGroup] == 640;
  const int length = block_.has_g(kLengthGroup) ? block_.g[kLengthGroup] : 0;
  check_letter('D', radius, "G41 and G42");
  check_letter('E', has_m({660, 670, 680}), "M66, M67 and M68");
  check_letter('H', length == 430 || length == 432, "G43 and G43.2");
  for (const char letter : {'I', 'J'})
    check_letter(letter, arc || moves({kCubic, kQuadratic, 870}) || data, "G2, G3, G5, G5.1, G87 and G10 L1");
  check_letter('K', arc || motion == 870, "G2, G3 and G87");
  check_letter('R', cycle || arc || data || block_.has_m(190), "arcs, cycles, G10 L1 and L2");
  check_letter('P',
               arc || data || non_modal == 40 || path ||
                   moves({kCubic, kNurbs, 730, 740, 820, 830, 840, 860, 880, 890}) ||
                   has_m({190, 500, 510, 520, 530, 620, 630, 640, 650, 660, 980}),
               "G4, G5, G10, G64, arcs, cycles that dwell and M98");
  check_letter('Q', path || data || moves({kCubic, 730, 830}) || has_m({190, 610, 660, 670, 680}),
               "G5, G64, G73, G83, M61 and M66");
  check_letter('L', cycle || data || motion == kNurbs || has_m({660, 980}), "G5.2, G10, cycles, M66 and M98");
}

void LinuxCnc::check_axes_and_motion() {
  const bool uses = uses_axis_words();
  if (uses && block_.has_g(kMotionGroup) && block_.g[kMotionGroup] != 800)
    control_.report.fail("modal-conflict", g_column(kMotionGroup),
                         "two G codes of this block both want its axis words", "write them in two blocks");
  if (block_.has_g(kMachineGroup)) {
    const int motion = block_.has_g(kMotionGroup) ? block_.g[kMotionGroup] : motion_;
    if (motion != 0 && motion != 10)
      control_.report.fail("modal-conflict", g_column(kMachineGroup), "G53 goes with G0 and G1 only",
                           "write G53 G0");
    const bool incremental = block_.has_g(kDistanceGroup) ? block_.g[kDistanceGroup] == 910 : incremental_;
    if (incremental)
      control_.report.fail("modal-conflict", g_column(kMachineGroup),
                           "G53 wants a position, and G91 is active", "write G90 before it");
    if (!is_axis_given())
      control_.report.fail("missing-word", g_column(kMachineGroup), "G53 has no axis words",
                           "add the axes that move");
  }
  if (!is_axis_given() || uses) return;
  const int motion = block_.has_g(kMotionGroup) ? block_.g[kMotionGroup] : motion_;
  if (motion < 0 || motion == 800)
    control_.report.fail("no-motion-mode", reader_.column_of(block_.first),
                         "axis words stand here, and no motion (G0 to G3) is active", "write G0 or G1");
}

void LinuxCnc::apply() {
  apply_feed_and_speed();
  if ((block_.given & (1u << ('T' - 'A'))) != 0 || block_.m_count > 0) {
    if (block_.has_m(660)) read_input();
    if (block_.has_m(680)) warn_of_output();
    apply_tool();
    apply_machine_functions();
  }
  constexpr uint32_t kModal = 1u << kPlaneGroup | 1u << kUnitsGroup | 1u << kRadiusGroup |
                              1u << kLengthGroup | 1u << kOffsetGroup | 1u << kPathGroup |
                              1u << kDistanceGroup | 1u << kArcDistanceGroup | 1u << kRetractGroup;
  if (block_.has_g(kNonModal) && block_.g[kNonModal] == 40)
    nc::dwell(control_.report, control_.modal, block_.get('P'));
  if ((block_.g_given & kModal) != 0) {
    if (block_.has_g(kPlaneGroup))
      nc::set_plane(control_, block_.g[kPlaneGroup] == 170   ? Plane::kXY
                              : block_.g[kPlaneGroup] == 180 ? Plane::kZX
                                                             : Plane::kYZ);
    if (block_.has_g(kUnitsGroup)) nc::set_inches(control_.modal, block_.g[kUnitsGroup] == 200);
    apply_compensation();
    apply_length();
    apply_offsets();
    apply_path_mode();
    if (block_.has_g(kDistanceGroup)) incremental_ = block_.g[kDistanceGroup] == 910;
    if (block_.has_g(kArcDistanceGroup)) arc_absolute_ = block_.g[kArcDistanceGroup] == 901;
    if (block_.has_g(kRetractGroup)) {
      retract_to_r_ = block_.g[kRetractGroup] == 990;
      retract_known_ = true;
    }
  }
  if (block_.has_g(kNonModal)) non_modal();
  if (block_.has_g(kMotionGroup) || (is_axis_given() && !uses_axis_words())) motion();
}

void LinuxCnc::apply_feed_and_speed() {
  if (block_.has_g(kFeedGroup)) {
    const int code = block_.g[kFeedGroup];
    const FeedMode mode = code == 930   ? FeedMode::kInverseTime
                          : code == 940 ? FeedMode::kPerMinute
                                        : FeedMode::kPerRevolution;
    nc::restore_feed(control_.modal, mode, 0.0);  // F is forgotten, also by the word that holds already
  }
  if (block_.has('F')) {
    nc::set_feed(control_.report, control_.modal, block_.get('F'), column('F'));
    warn_of_feed_units();
  }
  if (block_.has('S')) control_.modal.speed_rpm = block_.get('S');
}

/// LinuxCNC takes F before G20 and G21 of its block (order of execution).
void LinuxCnc::warn_of_feed_units() {
  if (!block_.has_g(kUnitsGroup) || control_.modal.inches() == (block_.g[kUnitsGroup] == 200)) return;
  if (control_.modal.feed_mode == FeedMode::kInverseTime) return;
  control_.report.warn_once("feed-before-units", column('F'),
                            fmt::format("F{:g} counts in {}: LinuxCNC takes it before the {} of its block",
                                        block_.get('F'), control_.modal.inches() ? "inches" : "millimetres",
                                        control_.modal.inches() ? "G21" : "G20"),
                            "write F in a block after it");
}

void LinuxCnc::apply_machine_functions() {
  constexpr std::pair<int, int> kSpindle[] = {{30, 1}, {40, -1}, {50, 0}};
  for (const auto& [code, sense] : kSpindle) {
    if (block_.has_m(code)) control_.modal.spindle = sense;
  }
  for (int i = 0; i < block_.m_count; ++i) {
    const int code = block_.m[static_cast<size_t>(i)];
    const int at = reader_.column_of(block_.m_places[static_cast<size_t>(i)]);
    if (code >= 700 && code <= 730) apply_saved_state(code, at);
    if (code >= 4280) switch_kinematics(code, at);
  }
  if (block_.has_m(70)) mist_ = true;
  if (block_.has_m(80)) flood_ = true;
  if (block_.has_m(90)) mist_ = flood_ = false;
}

void LinuxCnc::apply_offsets() {
  if (!block_.has_g(kOffsetGroup)) return;
  const int code = block_.g[kOffsetGroup];
  nc::set_work_offset(control_, code <= 590 ? (code - 530) / 10 : code - 584);
  update_shift();
}

void LinuxCnc::apply_path_mode() {
  if (!block_.has_g(kPathGroup)) return;
  const int code = block_.g[kPathGroup];
  control_.modal.exact_stop = code != 640;
  if (code == 640 && block_.has('Q')) control_.report.without_effect("G64 Q (merging of short blocks)");
  control_.modal.corner_tolerance_mm =
      code == 640 && block_.has('P') ? control_.modal.mm(block_.get('P')) : 0.0;
}

bool LinuxCnc::apply_end() {
  for (int i = 0; i < block_.m_count; ++i) {
    const int code = block_.m[static_cast<size_t>(i)];
    const int at = reader_.column_of(block_.m_places[static_cast<size_t>(i)]);
    if (code == 20 || code == 300) return false;
    if (code == 980) {
      need('P', "M98");
      const long times = block_.has('L') ? whole(block_, 'L', 0, 1'000'000, reader_, control_) : 1;
      call_number(whole(block_, 'P', 0, 99999999, reader_, control_), times, at);
    }
    if (code == 990 && calls_.size() > 1 && frame().numbered) {
      leave();
    } else if (code == 990 && calls_.size() > 1) {
      control_.report.fail("bad-o-word", at, "M99 ends a subprogram that was called with O... call",
                           "end it with endsub");
    } else if (code == 990) {
      control_.report.warn_once("main-program-repeats", at,
                                "M99 repeats the main program for ever; it was run once",
                                "end it with M2 where that is meant");
      return false;
    }
  }
  return true;
}

}  // namespace swarf::program::nc::linuxcnc

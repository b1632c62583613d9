// The control as every dialect sees it: the state of the machine tool, and the motions its words come down
// to. A dialect reads text and calls these functions; no function here knows any dialect.
//
//   words -> [dialect] -> Target, ArcWords, DrillCycle, Curve -> Control -> cutter compensation -> NcMove ->
//   sink
//
// Coordinates (mm and rad everywhere; dialects convert with ModalState::mm and rad_from_deg):
//   p        program coordinates: what X Y Z mean at this moment
//   F        the programmable frame (TRANS, ROT, G68.2, PLANE): any rigid Pose
//   origin   axis values at which the gauge line (a tool of length 0) stands on the program's zero, rotary
//            axes at zero; ControlSetup::work_offsets are differences from the one of W's origin
//   c        compensated tool length (G43 H, D1, TOOL CALL), along the tool axis
//   kAxes:   q_linear = origin + shift + c + F p            XYZ are axis values, rotaries are independent
//   kWork:   tip_W    = L (origin + shift - zero) + F_W p   XYZ are the tip in W; the linear axes follow the
//            rotaries that stand or are given (L: axis values to W with the rotary axes at zero; F_W: F
//            turned likewise)
//   TCP is kWork with the law of the tip: kTcpAxes for rotary values, kTcp for vectors; without TCP every law
//   is kJoint, and an arc is the tip's arc in W, which needs standing rotaries.
//
// Everything that a block says is checked before the first call that changes state: it is the dialect's part
// to call the functions only after its own checks (words, groups, rules). Faults: Report::fail.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "kinematics/machine_model.h"
#include "program/control/contour.h"
#include "program/control/modal_state.h"
#include "program/control/report.h"
#include "program/control/target.h"
#include "program/control/work_space.h"
#include "program/nc_program.h"

namespace swarf::program::nc {

/// What stands in the spindle and what stands ready.
struct ToolState {
  int selected = -1;  ///< index into ControlSetup::tools (T); -1: none
  int selected_number = 0;
  int active = -1;  ///< in the spindle
  int active_number = 0;
  bool length_on = false;      ///< the compensated length holds (G43, D1)
  bool length_called = false;  ///< it has held once
};

/// Where programs count from. Number 0: none (G53, G500), the work zero itself; 1: G54.
struct Offsets {
  int active = 1;
  std::map<int, kinematics::AxisValues> origins;
  Tcp tcp = Tcp::kOff;
  bool axes_rigid = true;  ///< linear axis values and W differ by a rigid motion or its mirror image
};

/// Where the machine was sent, and how the program came there.
struct PathState {
  kinematics::AxisValues q = kinematics::AxisValues::Zero();  ///< where the machine was sent
  std::array<double, kAxisWords> position{};                  ///< program coordinates of the programmed point
  bool position_valid = false;
  uint8_t known = 0;  ///< axes whose value is known, by AxisWord, before the start
  bool started = false;
  ToolPose pose;  ///< of the true tool at q
  long jumps = 0;
  double seconds = 0.0;  ///< of all feeds and dwells so far, as programmed
  long unwound[3] = {0, 0, 0};
  Place first_motion;
};

/// A piece of contour that waits for the one behind its corner (corner.h).
struct CornerState {
  struct Held {
    Segment piece;
    CornerWords words;
  };
  std::optional<CornerWords> asked;  ///< by the block whose move comes
  std::optional<Held> held;
  /// Pieces, their corners made, go here instead of to the machine: a contour that a cycle reads.
  std::vector<Segment>* kept = nullptr;
};

struct Control;

/// Gives the control's words to its cutter compensation, and takes what comes out of it.
class ContourOfControl final : public ContourHost {
 public:
  explicit ContourOfControl(Control& control) : control_(control) {}
  Plane plane() const override;
  const DialectWords& words() const override;
  void at(int file, int line, int column) override;
  [[noreturn]] void fail(const char* code, int column, std::string text, std::string fix) const override;
  void emit(const Segment& segment) override;

 private:
  Control& control_;
};

struct Control {
  /// All references must outlive the control. Throws InputError when the machine has no unique inverse, lacks
  /// one of X Y Z, or names an axis other than X Y Z A B C ("axis-names").
  Control(const ControlSetup& given, NcSink& sink, Diagnostics& diagnostics, NcSummary& summary);
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  const ControlSetup& setup;
  Report report;
  ModalState modal;
  ToolState tools;
  WorkSpace space;
  Offsets offsets;
  PathState path;
  CornerState corners;
  ContourOfControl host{*this};
  Contour contour{host};
};

/// A further plane is a fault while the cutter is compensated ("compensation-plane").
void set_plane(Control& control, Plane plane);

/// G41 (left), G42 (right) or off. The next straight move in the plane leads in. "compensation-plane" outside
/// one plane, "compensation-no-tool" without a radius. Off: the next move leads out.
void set_compensation(Control& control, Compensation side, double radius_mm, int column);
/// Compensation begins where the tool stands, a cutter radius beside `contour_point` (program coordinates),
/// from which the next move counts: approaches that a dialect has moved itself. No lead-in follows.
void enter_compensation(Control& control, Compensation side, double radius_mm, const Vec3& contour_point);
/// Ends what is still in look-ahead; at the end of the program, before positions are read, before M6.
void flush(Control& control);
/// Ends the program: flush, the last dwell, "no-start" when no complete position came.
void finish(Control& control);
/// To be called at each jump back and each call: "endless-loop" after a million of them without a move.
void jump(Control& control);

/// Makes PathState::position hold again after the program's zero or the axes moved.
void refresh_position(WorkSpace& space, PathState& path);
/// Program coordinates of the last programmed point, mm and rad, in the order X Y Z A B C. Entries that are
/// not known yet are NaN.
const std::array<double, kAxisWords>& position(Control& control);
Vec3 position_xyz(Control& control);
/// Present orientation of the tool in the program frame.
Vec3 tool_axis_P(Control& control);
/// The tool axis with all rotary axes at zero, in the program frame.
Vec3 tool_axis_at_zero_P(const WorkSpace& space);
/// "axis-missing" unless the machine has the axis; else its index into MachineModel::axes.
int require_axis(const Control& control, AxisWord word, int column);

}  // namespace swarf::program::nc

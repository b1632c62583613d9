// Datum shift, mirror image, rotation and scaling: cycles 7, 8, 10, 11, 26 and TRANS.
#include "program/heidenhain/frame.h"

#include <fmt/format.h>

#include "base/angles.h"
#include "program/heidenhain/steps.h"
#include "program/letters/arithmetic.h"

namespace swarf::program::nc::heidenhain {
namespace {

/// Large against rounding: directions are differences of points this far apart.
constexpr double kProbe = 1024.0;

/// The order in which the control combines transformations is the one in which it lists them; where a program
/// defines them in another order, the result depends on the control, and is not guessed.
void need_order(BlockReader& reader, size_t start, bool later_active, const char* what) {
  if (!later_active) return;
  reader.fail("unsupported-word", start, fmt::format("{} while a later transformation is active", what),
              "define them in this order: shift, mirror image, rotation, scaling");
}

double scale_factor(BlockReader& reader) {
  reader.done();
  const size_t at = reader.offset();
  const double factor = reader.value();
  if (!(factor >= 1e-6 && factor <= 99.999999))
    reader.fail("out-of-range", at, fmt::format("{:g} is no scaling factor", factor),
                "0.000001 to 99.999999");
  return factor;
}

}  // namespace

Mat3 spatial_rotation(double a_deg, double b_deg, double c_deg) {
  return rotation_deg(2, c_deg) * rotation_deg(1, b_deg) * rotation_deg(0, a_deg);
}

Mat3 linear_columns_W(const kinematics::MachineModel& machine, const kinematics::AxisValues& q) {
  const Vec3 tip_W = kinematics::forward(machine, q).tip_W;
  Mat3 columns = Mat3::Identity();
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const size_t word = std::string_view("XYZ").find(machine.axes[i].name);
    if (word == std::string_view::npos) continue;
    kinematics::AxisValues moved = q;
    moved[static_cast<long>(i)] += kProbe;
    columns.col(static_cast<long>(word)) = (kinematics::forward(machine, moved).tip_W - tip_W) / kProbe;
  }
  return columns;
}

Mat3 tool_frame_W(const kinematics::MachineModel& machine, const kinematics::AxisValues& q) {
  const Vec3 tip_W = kinematics::forward(machine, q).tip_W;
  Mat3 frame;
  for (int i = 0; i < 3; ++i) {
    kinematics::MachineModel beside = machine;
    beside.tip_M += kProbe * Vec3::Unit(i);
    frame.col(i) = (kinematics::forward(beside, q).tip_W - tip_W) / kProbe;
  }
  return frame;
}

Pose Level::rigid() const {
  Pose X = Pose::Identity();
  X.linear() = rotation_deg(2, mirror.x() * mirror.y() < 0.0 ? -turn_deg : turn_deg);
  X.translation() = shift;
  return X;
}

Stretch Level::stretch() const {
  const Vec3 scales = scale * axis_scale;
  return {mirror.cwiseProduct(scales), mirror.cwiseProduct((Vec3::Ones() - scales).cwiseProduct(centre))};
}

void update_frame(Executor& executor) {
  Pose tilted = Pose::Identity();
  tilted.linear() = executor.orientation.tilt;
  nc::set_frame(executor.control, executor.frames.outer.rigid() * tilted * executor.frames.inner.rigid());
  executor.frames.stretch = level(executor.orientation, executor.frames).stretch();
  executor.path.tangent.reset();
  executor.path.centre.reset();
}

/// 7.1 X+10, 7.2 IY-5 ...: in the tilted plane when one is tilted.
void datum_shift(Executor& executor, BlockReader& reader) {
  reader.done();
  if (reader.peek() == '#' || reader.letters() == "D")
    reader.fail("unsupported-word", reader.offset(), "datum tables are not supported",
                "write the shift as X Y Z");
  const size_t start = reader.offset();
  const MotionWords words = read_motion_words(reader, kAxesAllowed);
  Vec3 shift = level(executor.orientation, executor.frames).shift;
  for (int i = 0; i < nc::kAxisWords; ++i) {
    const Amount& word = words.axes[static_cast<size_t>(i)];
    if (!word) continue;
    if (i >= 3) {
      if (word.value == 0.0 && !word.incremental) continue;
      reader.fail("unsupported-word", word.offset, "datum shifts of rotary axes are not supported",
                  "put the angle into the preset");
    }
    shift[i] = executor.control.modal.mm(word.value) + (word.incremental ? shift[i] : 0.0);
  }
  need_order(reader, start,
             (level(executor.orientation, executor.frames).turn_deg != 0.0 ||
              level(executor.orientation, executor.frames).stretches()) &&
                 shift != level(executor.orientation, executor.frames).shift && !shift.isZero(0.0),
             "a datum shift");
  level(executor.orientation, executor.frames).shift = shift;
  update_frame(executor);
}

/// TRANS DATUM AXIS X+10, TRANS MIRROR AXIS X, TRANS ROTATION ROT+30, TRANS SCALE SCL1.5; each with RESET.
void transform(Executor& executor, BlockReader& reader, size_t start) {
  const std::string kind(reader.take_letters());
  const bool reset = reader.take("RESET");
  if (reset) reader.expect_end();
  const bool datum = kind == "DATUM", mirror = kind == "MIRROR";
  if ((datum || mirror) && !reset && !reader.take("AXIS"))
    reader.fail("unsupported-word", start,
                fmt::format("of TRANS {}, only AXIS and RESET are supported", kind),
                fmt::format("TRANS {} AXIS X{}", kind, datum ? "+10" : ""));
  if (datum && !reset) return datum_shift(executor, reader);
  if (mirror && !reset) return mirror_image(executor, reader);
  if (kind == "ROTATION" && !reset) return rotation(executor, reader);
  if (kind == "SCALE" && !reset) return scaling(executor, reader);
  if (datum) {
    level(executor.orientation, executor.frames).shift = Vec3::Zero();
  } else if (mirror) {
    level(executor.orientation, executor.frames).mirror = Vec3::Ones();
  } else if (kind == "ROTATION") {
    level(executor.orientation, executor.frames).turn_deg = 0.0;
  } else if (kind == "SCALE") {
    level(executor.orientation, executor.frames).scale = 1.0;
  } else {
    reader.fail("unsupported-word", start, "of TRANS, only DATUM, MIRROR, ROTATION and SCALE are supported",
                "TRANS DATUM AXIS X+10");
  }
  update_frame(executor);
}

/// 8.1 X Y: the axes that are mirrored at the datum; none: as programmed again.
void mirror_image(Executor& executor, BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  Vec3 mirror = Vec3::Ones();
  while (!reader.done()) {
    const size_t at = reader.offset();
    const std::string word(reader.take_letters());
    const size_t axis =
        word.size() == 1 ? std::string_view(nc::kAxisLetters).find(word[0]) : std::string::npos;
    if (axis == std::string::npos)
      refuse_word(reader, at, word.empty() ? std::string(1, reader.peek()) : word);
    const auto index = static_cast<int>(axis);
    if (index >= 3 || index == nc::axes_of(executor.control.modal.plane).normal)
      reader.fail("unsupported-word", at, fmt::format("a mirror image of {} is not supported", word),
                  "the axes of the working plane are");
    if (mirror[index] < 0.0)
      reader.fail("word-twice", at, fmt::format("{} stands twice in this block", word), "keep one of them");
    mirror[index] = -1.0;
  }
  need_order(reader, start,
             mirror != level(executor.orientation, executor.frames).mirror && mirror != Vec3::Ones() &&
                 (level(executor.orientation, executor.frames).turn_deg != 0.0 ||
                  level(executor.orientation, executor.frames).scales_axes()),
             "a mirror image");
  level(executor.orientation, executor.frames).mirror = mirror;
  update_frame(executor);
}

/// 10.1 ROT+30, 10.1 IROT+15: about the datum, in the working plane XY.
void rotation(Executor& executor, BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  const bool added = reader.take("IROT");
  if (!added && !reader.take("ROT")) refuse_word(reader, start, reader.take_letters());
  const double angle = reader.value() + (added ? level(executor.orientation, executor.frames).turn_deg : 0.0);
  reader.expect_end();
  if (executor.control.modal.plane != nc::Plane::kXY)
    reader.fail("unsupported-word", start, "rotations are supported with the tool axis Z alone",
                "TOOL CALL 5 Z");
  need_order(reader, start,
             angle != level(executor.orientation, executor.frames).turn_deg && angle != 0.0 &&
                 level(executor.orientation, executor.frames).scales_axes(),
             "a rotation");
  level(executor.orientation, executor.frames).turn_deg = angle;
  update_frame(executor);
}

/// 11.1 SCL0.995: all three axes, about the datum, and the lengths of cycles.
void scaling(Executor& executor, BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  if (!reader.take("SCL")) refuse_word(reader, start, reader.take_letters());
  const double factor = scale_factor(reader);
  reader.expect_end();
  if (factor != 1.0 && level(executor.orientation, executor.frames).scales_axes())
    reader.fail("unsupported-word", start, "cycles 11 and 26 are active together", "use one of them");
  level(executor.orientation, executor.frames).scale = factor;
  update_frame(executor);
}

/// 26.1 X1.4 Y0.6 CCX+15 CCY+20: each axis by a factor of its own, about a centre.
void axis_scaling(Executor& executor, BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  Level changed = level(executor.orientation, executor.frames);
  Vec3 centre = Vec3::Zero();
  uint8_t given = 0, centred = 0;
  while (!reader.done()) {
    const size_t at = reader.offset();
    std::string word(reader.take_letters());
    const bool middle = word.size() == 3 && word.starts_with("CC");
    const std::string axis_word = middle ? word.substr(2) : word;
    const size_t axis =
        axis_word.size() == 1 ? std::string_view("XYZ").find(axis_word[0]) : std::string::npos;
    if (axis == std::string::npos)
      refuse_word(reader, at, word.empty() ? std::string(1, reader.peek()) : word);
    const auto index = static_cast<int>(axis);
    uint8_t& seen = middle ? centred : given;
    if ((seen >> index & 1u) != 0)
      reader.fail("word-twice", at, fmt::format("{} stands twice in this block", word), "keep one of them");
    seen = static_cast<uint8_t>(seen | (1u << index));
    if (middle) {
      centre[index] = executor.control.modal.mm(reader.value());
    } else {
      changed.axis_scale[index] = scale_factor(reader);
    }
  }
  if (given == 0) reader.fail("missing-word", start, "cycle 26 scales no axis", "CYCL DEF 26.1 X1.4 Y0.6");
  changed.centre = centre;
  if (changed.scales_axes() && level(executor.orientation, executor.frames).scales_axes() &&
      centre != level(executor.orientation, executor.frames).centre)
    reader.fail("unsupported-word", start, "cycle 26 moves its centre while it is active",
                "reset it first: CYCL DEF 26.1 X1 Y1");
  if (changed.scales_axes() && level(executor.orientation, executor.frames).scales())
    reader.fail("unsupported-word", start, "cycles 11 and 26 are active together", "use one of them");
  if (!changed.scales_axes()) changed.centre = Vec3::Zero();
  level(executor.orientation, executor.frames) = changed;
  update_frame(executor);
}

/// By how much lengths in the working plane grow: arcs, corners and cutter radii need one factor for both
/// axes.
double plane_scale(nc::Control& control, Frames& frames, BlockReader& reader, size_t offset) {
  const nc::PlaneAxes axes = nc::axes_of(control.modal.plane);
  const std::optional<double> grown = frames.stretch.in_plane(axes);
  if (!grown)
    reader.fail("bad-arc", offset,
                fmt::format("cycle 26 scales {} by {:g} and {} by {:g}: arcs and corners would be none",
                            nc::kAxisLetters[axes.first], std::abs(frames.stretch.factor[axes.first]),
                            nc::kAxisLetters[axes.second], std::abs(frames.stretch.factor[axes.second])),
                "give both axes of the working plane the same factor");
  return *grown;
}

/// Words that are not scaled or mirrored here.
void need_true_size(Frames& frames, BlockReader& reader, size_t offset, const char* what) {
  if (frames.stretch.none()) return;
  reader.fail("unsupported-word", offset,
              fmt::format("{} while a mirror image or a scaling is active is not supported", what),
              "end cycles 8, 11 and 26 before it");
}

}  // namespace swarf::program::nc::heidenhain

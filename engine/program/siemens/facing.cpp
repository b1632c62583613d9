// Face milling of Siemens 840D.
//
//   CYCLE71(_RTP,_RFP,_SDIS,_DP,_PA,_PO,_LENG,_WID,_STA,_MID,_MIDA,_FDP,_FALD,_FFP1,_VARI,_FDP1)
//   CYCLE61(_RTP,_Z0,_SDIS,_Z1,_X0,_Y0,_X1,_Y1,_DZ,_DXY,_UZ,_F,_VARI,_LIM,_DMODE,_AMODE)
//
// Passes of equal width, at most _MIDA: the first one takes the whole of it, so that the tool stands out by
// its diameter less _MIDA, the last one ends with the tool's edge _FDP1 beyond the face. Infeeds happen clear
// of the face. _VARI: units 1 roughing, 2 finishing (once, at _DP); tens 1, 3 along the abscissa, 2, 4 along
// the ordinate; 1, 2 in one direction, 3, 4 to and fro.
#include <fmt/format.h>

#include <cmath>

#include "program/siemens/milling.h"

namespace swarf::program::nc::siemens {
namespace {

struct Face {
  MillHeights heights;
  Vec2 corner = Vec2::Zero();
  double length = 0.0, width = 0.0, angle_deg = 0.0;  ///< signed, from the corner
  double most_down = 0.0, step = 0.0, floor = 0.0, feed = 0.0;
  double beyond = 0.0, beyond_side = 0.0;  ///< _FDP, _FDP1
  size_t mid_at = 0, step_at = 0;
  bool finish = false, along_second = false, to_and_fro = false;
};

void read_kind(const MillCall& call, size_t at, Face& face) {
  const int kind = call.whole(at, std::nullopt), how = kind % 10, strategy = kind / 10;
  if ((how != 1 && how != 2) || strategy < 1 || strategy > 4)
    call.fail("out-of-range", at, fmt::format("_VARI {} is no machining (alarm 61002)", kind),
              "units: 1 roughing, 2 finishing; tens: 1 to 4");
  face.finish = how == 2;
  face.along_second = strategy % 2 == 0;
  face.to_and_fro = strategy > 2;
}

void check_step(const MillCall& call, double step, Face& face) {
  const double tool = 2.0 * call.tool_radius();
  if (!(step >= 0.0) || step > tool + 1e-9)
    call.fail("out-of-range", face.step_at,
              fmt::format("the tool of {:g} mm leaves material between passes {:g} mm apart (alarm 61111)",
                          tool, step),
              "the step is at most the tool's diameter; 0 takes .8 of it");
  face.step = step > 0.0 ? step : kStepOfTool * tool;
}

Face cycle71(const MillCall& call) {
  Face face;
  face.heights = mill_heights(call, false, 99);
  face.corner = Vec2(call.length(4, std::nullopt), call.length(5, std::nullopt));
  face.length = call.length(6, std::nullopt);
  face.width = call.length(7, std::nullopt);
  face.angle_deg = call.number(8, 0.0);
  face.mid_at = 9;
  face.step_at = 10;
  face.most_down = call.size(9, 0.0);
  check_step(call, call.size(10, 0.0), face);
  face.beyond = call.size(11, 0.0);
  face.floor = call.size(12, 0.0);
  face.feed = call.feed(13);
  read_kind(call, 14, face);
  face.beyond_side = call.size(15, 0.0);
  call.only_zero_from(16);
  return face;
}

Face cycle61(const MillCall& call) {
  Face face;
  const int amode = call.whole(15, 0.0);
  if (amode < 0 || amode / 100 % 10 != 0 || amode > 11'019 || amode % 10 > 1 || amode / 10 % 10 > 1 ||
      amode / 1000 % 10 > 1)
    call.fail(
        "unsupported-word", 15, fmt::format("_AMODE {} is not read", amode),
        "units 1: Z1 from Z0; tens 1: DXY in percent; thousands 1: X1 from X0; ten thousands: Y1 from Y0");
  if (call.whole(13, 0.0) != 0)
    call.fail("unsupported-word", 13, "limits of the face (_LIM) are not read",
              "0, and no wall beside the face");
  call.plain_modes(13);
  face.heights = mill_heights(call, false, 15);
  face.corner = Vec2(call.length(4, std::nullopt), call.length(5, std::nullopt));
  face.length = call.length(6, std::nullopt) - (amode / 1000 % 10 == 1 ? 0.0 : face.corner.x());
  face.width = call.length(7, std::nullopt) - (amode / 10000 % 10 == 1 ? 0.0 : face.corner.y());
  face.mid_at = 8;
  face.step_at = 9;
  face.most_down = call.size(8, 0.0);
  const bool percent = amode / 10 % 10 == 1;
  check_step(call, percent ? 0.02 * call.number(9, 0.0) * call.tool_radius() : call.size(9, 0.0), face);
  face.floor = call.size(10, 0.0);
  face.feed = call.feed(11);
  read_kind(call, 12, face);
  call.only_zero_from(16);
  return face;
}

/// Where passes run: `along` the pass and `across` it, both from 0; on x and y as the face lies.
class FacePlane {
 public:
  FacePlane(const Face& face, double radius) : face_(face) {
    along_ = std::abs(face.along_second ? face.width : face.length);
    across_ = std::abs(face.along_second ? face.length : face.width);
    clear_ = radius + std::max(face.beyond, 1e-3);
    first_ = face.step - radius;
    last_ = across_ + face.beyond_side - radius;
  }
  /// Between the middles of the first and the last pass; none where one pass covers the face.
  double width() const { return last_ - first_; }
  Vec2 at(double along, double across) const {
    const double x = face_.along_second ? across : along, y = face_.along_second ? along : across;
    return {std::copysign(1.0, face_.length) * x, std::copysign(1.0, face_.width) * y};
  }
  Vec2 before(int pass, int passes) const { return at(-clear_, middle(pass, passes)); }
  Vec2 behind(int pass, int passes) const { return at(along_ + clear_, middle(pass, passes)); }

 private:
  double middle(int pass, int passes) const {
    return passes == 0 ? first_ : pass == passes ? last_ : first_ + width() * pass / passes;
  }
  const Face& face_;
  double along_ = 0.0, across_ = 0.0, clear_ = 0.0, first_ = 0.0, last_ = 0.0;
};

void mill_face(const MillCall& call, const Face& face) {
  const FacePlane plane(face, call.tool_radius());
  const int passes = call.steps(plane.width(), face.step, face.step_at);
  const double from = face.heights.safe, to = face.heights.bottom + (face.finish ? 0.0 : face.floor);
  const double safety = from - call.length(1, std::nullopt);
  const int levels = face.finish ? 1 : call.steps(from - to, face.most_down, face.mid_at);
  MillMotion motion(call, face.corner, face.angle_deg);
  motion.rapid_height(face.heights.retract);
  for (const double height : infeeds(from, to, levels)) {
    motion.rapid(plane.before(0, passes));
    motion.rapid_height(height);
    for (int pass = 0; pass <= passes; ++pass) {
      const bool back = face.to_and_fro && pass % 2 == 1;
      const Vec2 start = back ? plane.behind(pass, passes) : plane.before(pass, passes);
      if (pass > 0 && face.to_and_fro) motion.feed(start, face.feed);
      if (pass > 0 && !face.to_and_fro) {
        motion.rapid_height(std::min(height + safety, from));
        motion.rapid(start);
        motion.rapid_height(height);
      }
      motion.feed(back ? plane.before(pass, passes) : plane.behind(pass, passes), face.feed);
    }
    motion.rapid_height(from);
  }
  motion.rapid_height(face.heights.retract);
}

}  // namespace

void face(Executor& executor, const CycleCall& words) {
  const MillCall call(executor, words, 16);
  const Face face = words.name == "CYCLE71" ? cycle71(call) : cycle61(call);
  if (face.length == 0.0 || face.width == 0.0)
    call.fail("bad-cycle", 6, "a face without length or width (alarm 61118)", "give both, with their signs");
  call.warn(
      "face-passes",
      words.name == "CYCLE71"
          ? "where the tool turns beside the face the manual shows by a figure: taken with its edge _FDP "
            "clear of the face"
          : "the passes of CYCLE61 are taken as those of CYCLE71, the tool clear of the face at both ends");
  mill_face(call, face);
}

}  // namespace swarf::program::nc::siemens

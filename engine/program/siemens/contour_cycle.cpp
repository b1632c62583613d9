// Milling along a contour of the 840D, which another program or part of the program says.
//
//   CYCLE72(_KNAME,_RTP,_RFP,_SDIS,_DP,_MID,_FAL,_FALD,_FFP1,_FFD,_VARI,_RL,_AS1,_LP1,_FF3,_AS2,_LP2,
//           _UMODE,_FS,_ZFS,_GMODE,_DMODE,_AMODE)
//
// 1. The blocks of the contour run once; their pieces are kept, and nothing moves (ContourReading).
// 2. At each infeed: beside the start, down, onto the contour, along it, off it, up and back. _RL 41, 42: a
//    cutter radius (and _FAL in roughing) beside it by the cutter compensation of the control; 40: on it.
//
//          straight              quarter circle         half circle        n: to the cutter's side
//    P --L--> S'---> contour     P .                    P .                S' = S + (radius + _FAL) n
//                                   '--> S'---> ..        )--> S'---> ..   arcs touch the path at S'
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "program/control/corner.h"
#include "program/siemens/milling.h"

namespace swarf::program::nc::siemens {
namespace {

enum ContourArgument : size_t {
  kAtRtp = 1,
  kAtRfp,
  kAtMid = 5,
  kAtFal,
  kAtFald,
  kAtFfp1,
  kAtFfd,
  kAtVari,
  kAtRl,
  kAtAs1,
  kAtLp1,
  kAtFf3,
  kAtAs2
};
constexpr size_t kAtUmode = 17, kAtGmode = 20, kAtAmode = 22, kContourArguments = 23;

enum class Lead { kStraight = 1, kQuarter, kHalf };

/// Onto the contour, or off it.
struct LeadWay {
  Lead kind = Lead::kStraight;
  double size = 0.0;  ///< way of the cutter's edge, or radius of its centre's arc, mm
};

struct ContourCut {
  MillHeights heights;
  double reference = 0.0, safety = 0.0;
  double wall = 0.0, floor = 0.0, most_down = 0.0;
  double feed = 0.0, feed_down = 0.0, feed_between = 0.0;  ///< the last: 0 rapid
  bool finish = false;
  int lift = 0;  ///< between infeeds, 0: to RTP, 1: to RFP + SDIS, 2: by SDIS, 3: not
  Compensation side = Compensation::kOff;
  LeadWay on, off;
};

LeadWay read_lead(const MillCall& call, size_t at, Compensation side) {
  const int kind = call.whole(at, std::nullopt);
  if (kind >= 11 && kind <= 13)
    call.fail("unsupported-word", at,
              fmt::format("a way onto the contour in space ({}): where it begins to go down is not published",
                          kind),
              "lead in the plane: 1 straight, 2 quarter, 3 half circle");
  if (kind < 1 || kind > 3)
    call.fail("out-of-range", at, fmt::format("{} is no way onto a contour", kind),
              "1 straight, 2 quarter circle, 3 half circle");
  if (kind != 1 && side == Compensation::kOff)
    call.fail("words-conflict", at, "with _RL 40 the contour has no side for a circle to it",
              "lead straight (1), or compensate with 41 or 42");
  const double size = call.size(at + 1, std::nullopt);
  if (!(size > 0.0))
    call.fail("bad-cycle", at + 1, "the way onto the contour, or off it, is zero (alarm 61116)",
              "give its length or radius, above zero");
  return {static_cast<Lead>(kind), size};
}

void read_contour_kind(const MillCall& call, ContourCut& cut) {
  const int kind = call.whole(kAtVari, std::nullopt), how = kind % 10, between = kind / 10 % 10;
  if (how == 5 || kind / 1000 > 0)
    call.fail("unsupported-word", kAtVari,
              fmt::format("_VARI {}: chamfers, and contours in the other direction, are not read", kind),
              "units 1 or 2, no more than three digits");
  if ((how != 1 && how != 2) || between > 1 || kind < 0 || kind / 100 > 3)
    call.fail("out-of-range", kAtVari, fmt::format("_VARI {} is no machining (alarm 61002)", kind),
              "units: 1 roughing, 2 finishing; tens: 0 rapid, 1 feed between; hundreds: 0 to RTP, 1 to RFP + "
              "SDIS, 2 by SDIS, 3 no way up");
  cut.finish = how == 2;
  cut.lift = kind / 100;
  cut.feed_between = between == 1 ? call.feed(kAtFf3) : 0.0;
}

ContourCut read_contour_cut(const MillCall& call) {
  ContourCut cut;
  cut.heights = mill_heights(call, false, kAtAmode, kAtRtp);
  cut.reference = call.length(kAtRfp, std::nullopt);
  cut.safety = cut.heights.safe - cut.reference;
  cut.most_down = call.size(kAtMid, 0.0);
  cut.wall = call.size(kAtFal, 0.0);
  cut.floor = call.size(kAtFald, 0.0);
  cut.feed = call.feed(kAtFfp1);
  cut.feed_down = call.feed(kAtFfd);
  read_contour_kind(call, cut);
  const int side = call.whole(kAtRl, std::nullopt);
  if (side < 40 || side > 42)
    call.fail("out-of-range", kAtRl, fmt::format("_RL {} is no compensation", side),
              "40, 41 left or 42 right");
  if (side != 40) cut.side = side == 41 ? Compensation::kLeft : Compensation::kRight;
  if (side == 40 && cut.wall > 0.0)
    call.fail("words-conflict", kAtFal,
              "_RL 40 leads the cutter's centre along the contour: it leaves no allowance",
              "leave _FAL out, or compensate with 41 or 42");
  cut.on = read_lead(call, kAtAs1, cut.side);
  cut.off = call.given(kAtAs2) ? read_lead(call, kAtAs2, cut.side) : cut.on;
  call.only_zero_between(kAtUmode, kAtGmode);
  call.plain_modes(kAtGmode);
  return cut;
}

/// A point of the path, flat.
struct Mark {
  Vec2 point, along;
};

class ContourMill {
 public:
  ContourMill(const MillCall& call, const ContourCut& cut, std::vector<nc::Segment>& pieces)
      : call_(call),
        cut_(cut),
        pieces_(pieces),
        control_(call.executor().control),
        axes_(nc::axes_of(control_.modal.plane)),
        motion_(call, Vec2::Zero(), 0.0),
        side_(cut.side == Compensation::kOff    ? 0.0
              : cut.side == Compensation::kLeft ? 1.0
                                                : -1.0),
        radius_(cut.side == Compensation::kOff ? 0.0 : call.tool_radius() + (cut.finish ? 0.0 : cut.wall)) {}

  void run() {
    const Mark start = mark(pieces_.front(), true), end = mark(pieces_.back(), false);
    const Vec2 from = beside(start, cut_.on, -1.0);
    const double bottom = cut_.heights.bottom + (cut_.finish ? 0.0 : cut_.floor);
    double here = cut_.heights.retract;
    between(here);
    travel(from);
    for (const double height :
         infeeds(cut_.reference, bottom, call_.steps(cut_.reference - bottom, cut_.most_down, kAtMid))) {
      if (here > height + cut_.safety) between(height + cut_.safety);
      motion_.feed_height(height, cut_.feed_down);
      lead(cut_.on, start, start.point + radius_ * aside(start));
      follow(height, start);
      lead(cut_.off, end, beside(end, cut_.off, 1.0));
      here = height;
      if (height == bottom) break;
      here = cut_.lift == 0   ? cut_.heights.retract
             : cut_.lift == 1 ? cut_.heights.safe
             : cut_.lift == 2 ? height + cut_.safety
                              : height;
      if (cut_.lift == 3) {
        motion_.feed(from, cut_.feed);
        continue;
      }
      between(here);
      travel(from);
    }
    between(cut_.heights.retract);
  }

 private:
  Vec2 flat(const Vec3& v) const { return {v[axes_.first], v[axes_.second]}; }

  Mark mark(const nc::Segment& piece, bool begin) const {
    const Vec2 at = flat(begin ? piece.from : piece.to);
    if (!piece.is_arc()) return {at, flat(piece.to - piece.from).normalized()};
    const Vec2 out = at - flat(piece.centre);
    const double turn = piece.normal[axes_.normal] > 0.0 ? 1.0 : -1.0;
    return {at, turn * Vec2(-out.y(), out.x()).normalized()};
  }

  /// Unit, across the path to the cutter's side.
  Vec2 aside(const Mark& mark) const { return side_ * Vec2(-mark.along.y(), mark.along.x()); }

  /// The far end of the way onto the contour (`way` -1) or off it (+1).
  Vec2 beside(const Mark& mark, const LeadWay& lead, double way) const {
    const Vec2 n = aside(mark), path = mark.point + radius_ * n;
    if (lead.kind == Lead::kHalf) return path + 2.0 * lead.size * n;
    if (lead.kind == Lead::kQuarter) return path + lead.size * n + way * lead.size * mark.along;
    const double edge = cut_.side == Compensation::kOff ? 0.0 : call_.tool_radius();
    return path + way * (lead.size + edge) * mark.along;
  }

  void lead(const LeadWay& lead, const Mark& mark, const Vec2& to) {
    if (lead.kind == Lead::kStraight) return motion_.feed(to, cut_.feed);
    const Vec2 centre = mark.point + (radius_ + lead.size) * aside(mark);
    motion_.arc(to, centre, side_ > 0.0 ? 1 : -1, cut_.feed);
  }

  void follow(double height, const Mark& start) {
    if (cut_.side != Compensation::kOff) {
      Vec3 first = nc::position_xyz(control_);
      first[axes_.first] = start.point.x();
      first[axes_.second] = start.point.y();
      nc::enter_compensation(control_, cut_.side, radius_, first);
    }
    for (nc::Segment piece : pieces_) {
      piece.from[axes_.normal] = piece.to[axes_.normal] = piece.centre[axes_.normal] = height;
      nc::send_kept(control_, piece);
    }
    if (cut_.side != Compensation::kOff) nc::set_compensation(control_, Compensation::kOff, 0.0, 0);
    nc::flush(control_);
    control_.path.position_valid = false;
    const BlockPlace& place = call_.executor().place;
    control_.report.at(place.file, place.line->line, call_.column());
  }

  void between(double height) {
    if (cut_.feed_between > 0.0)
      motion_.feed_height(height, cut_.feed_between);
    else
      motion_.rapid_height(height);
  }

  void travel(const Vec2& to) {
    if (cut_.feed_between > 0.0)
      motion_.feed(to, cut_.feed_between);
    else
      motion_.rapid(to);
  }

  const MillCall& call_;
  const ContourCut& cut_;
  std::vector<nc::Segment>& pieces_;
  nc::Control& control_;
  nc::PlaneAxes axes_;
  MillMotion motion_;
  double side_, radius_;
};

[[noreturn]] void refuse_in_contour(const Executor& executor, size_t offset, std::string what) {
  fail(executor.place, "bad-contour", offset, std::move(what),
       "a contour has G0 or G1 to its start with both coordinates of the plane, then G1, G2 and G3 in the "
       "plane; tools, planes, offsets, depths and G41 belong to the cycle");
}

/// Takes the pieces, and puts back what held before the contour was read.
std::unique_ptr<ContourReading> finish_reading(Executor& executor) {
  nc::Control& control = executor.control;
  refuse_open_line(executor);
  nc::release_corner(control);
  std::unique_ptr<ContourReading> read = std::move(executor.contour);
  control.corners.kept = nullptr;
  control.corners.asked.reset();
  control.path = read->path;
  control.modal = read->modal;
  executor.modes = read->modes;
  executor.path = read->words;
  executor.calls.modal_cycle = read->modal_cycle;
  executor.place = read->place;
  executor.place.line = &read->line;
  control.report.at(read->place.file, read->line.line, read->column);
  return read;
}

void check_contour_pieces(const MillCall& call, const nc::Control& control,
                          std::vector<nc::Segment>& pieces) {
  constexpr double kNoWay = 1e-9;
  const int normal = nc::axes_of(control.modal.plane).normal;
  if (!pieces.empty()) pieces.erase(pieces.begin());  // to the start
  std::erase_if(pieces,
                [](const nc::Segment& one) { return !one.is_arc() && (one.to - one.from).norm() < kNoWay; });
  if (pieces.empty())
    call.fail("bad-contour", 0, "the contour has no piece behind its start",
              "a contour has a block to its start and at least one along it");
  for (const nc::Segment& piece : pieces) {
    const bool leaves = std::abs((piece.to - piece.from)[normal]) > kNoWay;
    const bool tilted = piece.is_arc() && std::abs(std::abs(piece.normal[normal]) - 1.0) > kNoWay;
    if (piece.motion != nc::Motion::kRapid && !leaves && !tilted && piece.further_turns == 0) continue;
    Report::fail_at({control.report.file_name(piece.place), piece.place.line, piece.place.column},
                    "bad-contour",
                    "a piece of the contour is a rapid move, leaves the plane, or goes round more than once",
                    "write it with G1, G2 or G3 in the plane");
  }
}

}  // namespace

void begin_contour(Executor& executor, const CycleCall& words) {
  nc::Control& control = executor.control;
  const MillCall call(executor, words, kContourArguments);
  if (!call.given(0) || words.arguments[0]->type != Type::kString)
    call.fail("wrong-type", 0, "CYCLE72 takes the contour's name as a text",
              "CYCLE72(\"PART\",..), or labels: CYCLE72(\"FIRST:LAST\",..)");
  if (executor.words.moves())
    call.fail("words-conflict", 0, "an axis stands in the block of CYCLE72",
              "write it in a block of its own");
  const ContourCut cut = read_contour_cut(call);
  nc::flush(control);
  auto reading = std::make_unique<ContourReading>();
  reading->call = words;
  reading->text = std::string(executor.place.line->text);
  reading->line = *executor.place.line;
  reading->line.text = reading->text;
  reading->place = executor.place;
  reading->column = call.column();
  nc::position(control);
  reading->path = control.path;
  reading->modal = control.modal;
  reading->modes = executor.modes;
  reading->words = executor.path;
  reading->modal_cycle = std::exchange(executor.calls.modal_cycle, std::nullopt);
  executor.path.last.valid = false;
  control.corners.kept = &reading->pieces;
  control.modal.feed = cut.feed;
  control.modal.feed_unit_mm = executor.modes.units == kG70 ? 1.0 : control.modal.mm(1.0);
  if (control.modal.feed_mode == nc::FeedMode::kInverseTime)
    control.modal.feed_mode = nc::FeedMode::kPerMinute;
  executor.contour = std::move(reading);
}

void check_contour_block(Executor& executor, const BlockWords& words, bool modal_call) {
  const auto refuse_word = [&](size_t offset, const char* what) {
    refuse_in_contour(executor, offset, what);
  };
  for (const CycleCall& call : words.calls)
    if (modal_call || find_word(call.name)->meaning != Meaning::kCall)
      refuse_word(call.offset, "a cycle stands in the contour of a cycle");
  if (modal_call) refuse_word(0, "MCALL stands in the contour of a cycle");
  if (words.frame || words.transform) refuse_word(0, "a frame or transformation stands in a contour");
  if (words.tool.given) refuse_word(words.tool.offset, "a tool is called in a contour");
  for (const Amount* one : {&words.cutting_edge, &words.speed, &words.allowance})
    if (*one) refuse_word(one->offset, "D, S and OFFN hold for the whole contour");
  for (const Amount& function : words.functions)
    if (function.value >= 3 && function.value <= 6)
      refuse_word(function.offset, "spindle and tool hold for the whole contour");
  for (const auto& [group, code] : words.codes) {
    const bool pole = group == Group::kNoMotion && (code == kG110 || code == kG111 || code == kG112);
    const bool path = group == Group::kMotion && code != kPoly;
    if (!pole && !path && group != Group::kCorner && group != Group::kExact && group != Group::kMeasure)
      refuse_word(words.motion_offset, "a G word that no contour of a cycle has stands here");
  }
  const size_t normal = static_cast<size_t>(nc::axes_of(executor.control.modal.plane).normal);
  for (size_t n = 0; n < words.axes.size(); ++n)
    if (words.axes[n] && (n >= 3 || n == normal))
      refuse_word(words.axes[n].offset, "an axis that does not lie in the plane moves in a contour");
  for (const auto* three : {&words.vector, &words.angles})
    for (const Amount& one : *three)
      if (one) refuse_word(one.offset, "the tool turns in a contour");
  if (words.feed)
    executor.control.report.warn_once(
        "contour-feed", column(executor.place, words.feed.offset),
        "F stands in a contour of a cycle: it holds from there to the contour's end, instead of _FFP1",
        "leave it out where _FFP1 is meant");
  ContourReading& reading = *executor.contour;
  if (reading.started) executor.modes.round_all_mm += std::exchange(reading.round_all_mm, 0.0);
  if (!reading.started && words.angle)
    refuse_word(words.angle.offset, "a contour begins with a line by its angle");
  if (reading.started || !words.moves() || words.code(Group::kNoMotion)) return;
  reading.started = true;
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  const bool incremental =
      words.code(Group::kMeasure).value_or(executor.modes.incremental ? kG91 : kG90) == kG91;
  const auto absolute = [&](int axis) {
    const Coordinate& word = words.axes[static_cast<size_t>(axis)];
    return word && (word.way == Way::kAbsolute || (word.way == Way::kModal && !incremental));
  };
  const bool polar = words.polar_angle && words.polar_radius;
  const int motion = words.motion.value_or(executor.modes.motion);
  if (!polar && !(absolute(axes.first) && absolute(axes.second)))
    refuse_word(words.motion_offset,
                "the first block of a contour gives its start: both coordinates, absolute");
  if ((motion != kG0 && motion != kG1) || words.round || words.chamfer || words.chamfer_leg || words.angle ||
      words.round_all)
    refuse_word(words.motion_offset,
                "the first block of a contour is G0 or G1 to its start, without a corner");
  reading.round_all_mm = std::exchange(executor.modes.round_all_mm, 0.0);
}

void mill_contour(Executor& executor) {
  const std::unique_ptr<ContourReading> read = finish_reading(executor);
  const MillCall call(executor, read->call, kContourArguments);
  const ContourCut cut = read_contour_cut(call);
  check_contour_pieces(call, executor.control, read->pieces);
  call.warn(
      "contour-lead",
      "onto a contour and off it: straight ways are taken as _LP1, _LP2 and the tool's radius long, arcs "
      "as the tool centre's, of radius _LP1, _LP2; depths as equal infeeds from RFP of at most _MID");
  ContourMill(call, cut, read->pieces).run();
  executor.path.last.valid = false;
}

}  // namespace swarf::program::nc::siemens

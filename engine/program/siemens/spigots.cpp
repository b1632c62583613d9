// Spigots of Siemens 840D.
//
//   CYCLE76(_RTP,_RFP,_SDIS,_DP,_DPR,_LENG,_WID,_CRAD,_PA,_PO,_STA,_MID,_FAL,_FALD,_FFP1,_FFD,_CDIR,_VARI,
//           _AP1,_AP2,_FS,_ZFS,_GMODE,_DMODE,_AMODE)
//   CYCLE77(_RTP,_RFP,_SDIS,_DP,_DPR,_PRAD,_PA,_PO,_MID,_FAL,_FALD,_FFP1,_FFD,_CDIR,_VARI,_AP1,
//           _FS,_ZFS,_GMODE,_DMODE,_AMODE)
//
// From a start on the positive abscissa beside the raw spigot (_AP1), at each depth: down, onto the contour
// on a half circle, once around, off on a half circle back to the start.
#include <fmt/format.h>

#include <algorithm>

#include "program/siemens/milling.h"

namespace swarf::program::nc::siemens {
namespace {

struct Spigot : MillShape {
  MillHeights heights;
  double raw = 0.0;
  double wall = 0.0, floor = 0.0, feed = 0.0, feed_down = 0.0;
  int sense = 1, steps = 0;
  bool finish = false;
};

/// Where both cycles have the same arguments: from _MID on.
void read_spigot_cut(const MillCall& call, size_t at, size_t gmode, Spigot& spigot) {
  spigot.wall = call.size(at + 1, 0.0);
  spigot.floor = call.size(at + 2, 0.0);
  spigot.feed = call.feed(at + 3);
  spigot.feed_down = call.feed(at + 4);
  spigot.sense = call.sense(at + 5, true);
  const int kind = call.whole(at + 6, std::nullopt);
  if (kind != 1 && kind != 2)
    call.fail(kind == 5 ? "unsupported-word" : "out-of-range", at + 6,
              fmt::format("_VARI {} is no machining that is read (alarm 61002)", kind),
              "1 roughing, 2 finishing");
  spigot.finish = kind == 2;
  call.plain_modes(gmode);
  call.only_zero_from(gmode + 3);
  const double from = spigot.heights.safe, to = spigot.heights.bottom + (spigot.finish ? 0.0 : spigot.floor);
  spigot.steps = call.steps(from - to, call.size(at, 0.0), at);
  // The floor alone is one turn at its depth.
  if (spigot.finish && spigot.wall == 0.0) spigot.steps = 1;
}

void mill_spigot(const MillCall& call, const Spigot& spigot) {
  const double r = call.tool_radius(), rest = spigot.finish ? 0.0 : spigot.wall;
  const double aside = rest + r;
  Outline way =
      rounded_rectangle(spigot.half_length + aside, spigot.half_width + aside, spigot.corner + aside);
  if (spigot.sense < 0) way = reversed(way);
  const double safety = spigot.heights.safe - call.length(1, std::nullopt);
  // The tool starts clear of the raw spigot, and of what the allowance leaves.
  const double raw = std::max(spigot.raw, spigot.half_length + spigot.wall);
  const Vec2 start(raw + r + std::max(safety, 1e-3), 0.0), middle = 0.5 * (start + way.start);
  const double from = spigot.heights.safe, to = spigot.heights.bottom + (spigot.finish ? 0.0 : spigot.floor);
  MillMotion motion(call, spigot.centre, spigot.angle_deg);
  motion.rapid_height(spigot.heights.retract);
  motion.rapid(start);
  motion.rapid_height(spigot.heights.safe);
  for (const double height : infeeds(from, to, spigot.steps)) {
    motion.feed_height(height, spigot.feed_down);
    motion.arc(way.start, middle, -spigot.sense, spigot.feed);
    motion.follow(way, spigot.feed);
    motion.arc(start, middle, -spigot.sense, spigot.feed);
  }
  motion.rapid_height(spigot.heights.retract);
}

}  // namespace

void spigot(Executor& executor, const CycleCall& words) {
  const bool round = words.name == "CYCLE77";
  const MillCall call(executor, words, round ? 21 : 25);
  const size_t mid = round ? 8 : 11, gmode = round ? 18 : 22;
  Spigot spigot;
  spigot.heights = mill_heights(call, true, gmode + 2);
  // _PRAD of CYCLE77 is the diameter.
  static_cast<MillShape&>(spigot) = round ? circle_at(call, 5, true) : rectangle_at(call, 5, "spigot");
  spigot.raw = 0.5 * call.size(mid + 7, 0.0);
  if (spigot.raw > 0.0 && spigot.raw < spigot.half_length - 1e-9)
    call.fail("bad-cycle", mid + 7,
              fmt::format("the raw spigot, {:g} mm, is smaller than the finished one, {:g} mm",
                          2.0 * spigot.raw, 2.0 * spigot.half_length),
              "_AP1 is its size along the abscissa before milling");
  read_spigot_cut(call, mid, gmode, spigot);
  call.warn(
      "spigot-start",
      "how far from the raw spigot the tool starts the manual does not say: taken SDIS beside it on the "
      "positive abscissa, which makes the half circle onto the contour that wide");
  mill_spigot(call, spigot);
}

}  // namespace swarf::program::nc::siemens

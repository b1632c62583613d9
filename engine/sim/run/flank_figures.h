// What flank milling has come to: the error of each placement, the envelope that the motion was to leave
// beside what the rays have met, and the time of each rule of feed.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/progress.h"
#include "flank/feed.h"
#include "flank/rotary_feed.h"
#include "sim/job/scene.h"
#include "sim/run/flank_machines.h"

namespace swarf::sim {

struct MeasuredPath;

/// Least and greatest height of an envelope over the rays, mm; below 0: too deep.
struct FlankHeights {
  double least_mm = 0.0, greatest_mm = 0.0;
  Vec3 least_W = Vec3::Zero(), greatest_W = Vec3::Zero();  ///< where they are
  double most_mm() const { return greatest_mm > -least_mm ? greatest_mm : -least_mm; }
  const Vec3& most_W() const { return greatest_mm > -least_mm ? greatest_W : least_W; }
};

struct FlankPlacementRow {
  std::string name;
  flank::WorstError worst;
  bool used = false;
};

/// One rule of feed on the same blocks.
struct FlankFeedRow {
  std::string name;
  double time_s = 0.0, feed_mean_mm_s = 0.0;
  double least_mm = 0.0, greatest_mm = 0.0;  ///< e of the chords of all its cycles
  bool used = false;
};

/// Heights at one u over all v: a line of the plot.
struct FlankProfileRow {
  double u = 0.0, predicted_least_mm = 0.0, predicted_greatest_mm = 0.0;
  double measured_least_mm = 0.0, measured_greatest_mm = 0.0;
};

/// Heights over the rays of one surface, by rows of u: cut_mm[iv * u.size() + iu]. NaN: none.
struct FlankMap {
  std::vector<double> u, v;
  std::vector<double> predicted_mm, cut_mm;
};

struct FlankFigures {
  size_t surfaces = 0, passes = 0, blocks = 0;
  double plan_seconds = 0.0;
  double twist_max_rad = 0.0;   ///< of the rulings, all surfaces
  double twist_bound_mm = 0.0;  ///< the published placement cuts so deep at least, whatever the feed (E18)
  std::array<flank::GuideFigures, 2> guides;        ///< of the first surface
  std::vector<FlankPlacementRow> placements;        ///< the worst of all surfaces, lowest pass
  double feed_1um_mm_s = 0.0, feed_5um_mm_s = 0.0;  ///< tightest corner of guide 0, curve alone, 1 ms
  /// Of an A/C machine as in Ma et al. (C .8 rad/s, .5 rad/s2) along the first surface: at u = .6, and the
  /// least.
  flank::RotaryFeed c_feed;
  flank::FeedLow c_feed_least;
  /// Predicted: of the axis surface itself, of the motion as blocks ask and as cycles make it.
  FlankHeights placed, blocks_left, cycles_left;
  double blocks_add_mm = 0.0;  ///< greatest that the blocks change over a ray of what the axis surface leaves
  double cycles_add_mm = 0.0;  ///< and the cycles of what the blocks leave
  int worst_element = -1;      ///< of the path, where cycles_left errs most
  size_t rays_compared = 0;
  size_t rays_elsewhere = 0;  ///< that no flank is near, or only an end of one, or no stock: not compared
  FlankHeights cut;           ///< of the compared rays themselves
  double difference_max_mm = 0.0;  ///< of prediction (of what cut the rays) and ray
  Vec3 difference_W = Vec3::Zero();
  std::vector<FlankFeedRow> feeds;
  std::vector<FlankMachineRow> machines;  ///< where flank.machines = "all"
  std::vector<FlankProfileRow> profile;   ///< of the first surface
  std::vector<FlankMap> maps;             ///< of each surface
};

/// Of a [flank] job whose rays have been cut.
FlankFigures flank_figures(const Job& job, const MeasuredPath& measured, Progress& progress);

}  // namespace swarf::sim

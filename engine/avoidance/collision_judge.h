// Looks at the stretches that the post plans: does anything of the machine, the tool, the fixtures and the
// work touch on the way? Between the steps too, and against the material that is still there.
//
//   links, fixtures, tool     all pairs that axes part, over every step                     (collision/)
//   links, fixtures - stock   clear of the raw stock, else of what the stretches before have left of it
//   tool - stock              on approaches alone: elsewhere the way of the tool in the work is that of the
//   CL
//                             data, whichever solution the axes take (control.h looks at that once)
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "avoidance/remedies.h"
#include "collision/closest_approach.h"
#include "collision/stock_body.h"
#include "post/planner.h"
#include "sim/job/scene.h"

namespace swarf::avoidance {

/// The first one of a stretch.
struct Collision {
  std::string a, b;  ///< names of the bodies
  Part part_a = Part::kHead, part_b = Part::kTable;
  size_t step = 0;  ///< of the stretch
  int line = 0;     ///< of the CL data
  int tool = -1;    ///< in the spindle, index into Scene::tools
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  Vec3 point_M = Vec3::Zero();
  bool loading = false;  ///< on the way to or from the tool changer
  bool proven = true;    ///< false: not proven to be free (within a voxel of the material)
  std::string text;
};

class CollisionJudge {
 public:
  /// `job` must outlive it; its tools are those of the post, by index. Gaps of `clearance_mm` or less count
  /// as collisions; 0: contacts alone.
  CollisionJudge(const sim::Job& job, double clearance_mm);
  ~CollisionJudge();

  /// The first collision of a stretch whose steps are straight in the axes. `from`: where they stand before
  /// it; null: nobody knows.
  std::optional<Collision> look_at(const post::PlannedStretch& planned, const kinematics::AxisValues* from);
  /// The moves of a stretch that is done with: what comes after them finds their material gone.
  void cut(std::span<const program::Move> moves);
  /// "": the work stands on the table or above it.
  std::string inside_table() const;
  /// The first collision of the work and its fixtures with anything while this axis makes a full turn from
  /// home, the tool out of the way. The paper drops such clamping positions.
  std::optional<Collision> full_turn(int axis) const;
  /// Whether the axes may stand so with this tool in the spindle: nothing is too near, the material left out.
  bool may_stand(const kinematics::AxisValues& q, int tool) const;
  /// Another program begins, before the raw stock.
  void begin_again();

 private:
  struct Pair;
  struct Way;
  std::optional<Collision> first_among(const std::vector<Way>& ways);
  std::optional<Collision> first_of(const Pair& pair, const std::vector<Way>& ways) const;
  std::optional<size_t> first_near(const Pair& pair, const std::vector<Way>& ways, size_t begin,
                                   size_t end) const;
  bool against_stock(const Pair& pair, const Way& way, bool& proven) const;
  void refresh_stock();
  Collision told(const Pair& pair, const Way& way, double share, bool proven) const;

  const sim::Job& job_;
  double limit_mm_;
  std::vector<collision::Body> bodies_;
  std::vector<Pair> pairs_;
  std::unique_ptr<collision::StockBody> stock_body_;
  std::unique_ptr<stock::Stock> stock_;
  /// Stretches that have been looked at from their start on, by their axis values; until the next cut().
  std::map<std::vector<double>, std::optional<Collision>> known_;
  std::vector<program::Move> uncut_;  ///< moves that the stock has not seen
  int tool_ = -2;                     ///< in the spindle at the end of what is done with; -2: nobody knows
  std::vector<int> tools_;            ///< Scene::tools by ClProgram::tools
};

}  // namespace swarf::avoidance

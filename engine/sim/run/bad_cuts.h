// Material taken by moves that must not take any: rapids, and cuts with a spindle that stands or turns the
// wrong way. Whole flutes, whole moves, against the stock as it stands before each sweep.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/job/scene.h"
#include "sim/run/earlier_cuts.h"
#include "sim/run/sweep_places.h"
#include "stock/contact/contact_finder.h"

namespace swarf::sim {

/// Material that the grid does not show well is looked at by the sweeps before (EarlierCuts). Rapids of
/// surface jobs (their retracts and links) lie in sweeps that may hold a feed too; only the rapid's share of
/// them is judged.
class BadCutCheck {
 public:
  /// All must outlive it.
  BadCutCheck(const Job& job, const motion::Cycles& cycles, const CutSweeps& sweeps,
              const SweepPlaces& places, const EarlierCuts& earlier);

  /// Those of sweeps [begin, end) whose bad moves are not clear of the stock as it stands now.
  std::vector<size_t> look_ahead(const stock::ContactFinder& finder, size_t begin, size_t end) const;
  /// One of them, before it is cut.
  void judge(const stock::ContactFinder& finder, size_t sweep);

  const std::vector<BadCut>& result() const { return found_; }
  /// Goes on from what was found before.
  void resume(const std::vector<BadCut>& earlier) { found_ = earlier; }

 private:
  /// Elements of one kind that follow each other; every rapid is a row of its own.
  struct Row {
    int first = 0;  ///< element
    std::optional<BadCutKind> kind;
  };
  /// A share of a sweep that must not cut.
  struct Move {
    double from_t = 0.0, to_t = 1.0;
    BadCutKind kind = BadCutKind::kRapid;
    size_t row = 0;
  };
  std::vector<Move> moves(size_t sweep, const SweepPlaces& places) const;
  bool wanted(const Move& move) const;
  std::optional<stock::Contact> contact(const stock::ContactFinder& finder, size_t sweep,
                                        const Move& move) const;
  void add(BadCut cut, size_t row);
  size_t row_of(int element) const;
  int last_of_row(size_t row) const;
  SweepSource source(size_t sweep) const { return sweeps_.source(sweep); }

  const CutSweeps& sweeps_;
  const SweepPlaces& places_;
  SweepPlaces ahead_;  ///< reads the cycles of the batch that comes
  const EarlierCuts& earlier_;
  bool by_element_;                         ///< a sweep belongs to one element: the elements are blocks
  std::vector<Row> rows_;                   ///< of ToolPath::elements
  int elements_ = 0;                        ///< how many they are
  std::vector<stock::CutterSolid> flutes_;  ///< by tool
  std::vector<std::vector<stock::RevolvedPart>> parts_;  ///< the same, by tool
  std::vector<BadCut> found_;
};

}  // namespace swarf::sim

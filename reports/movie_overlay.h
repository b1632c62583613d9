// What is written on a movie's frames: the line of the program, where tool and axes are, findings, progress.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "render/draw_list.h"
#include "reports/machine_view.h"
#include "reports/storyboard.h"

namespace swarf::reports {

class MovieOverlay {
 public:
  /// Reads the lines that the frames show from the program's files.
  MovieOverlay(const FinishedRun& run, const std::vector<PlannedFrame>& frames);

  /// Text plate, findings of the last second and a half, and the progress of the program along the lower
  /// edge.
  void draw(size_t frame, render::Image& image) const;
  /// Where each tool first is in the spindle, for chapters: frame and name.
  std::vector<std::pair<size_t, std::string>> tools() const;

 private:
  std::vector<std::string> lines_of(const motion::Cycle& cycle) const;
  std::string program_line(const motion::Cycle& cycle) const;
  void find_flashes();

  const FinishedRun& run_;
  const std::vector<PlannedFrame>& frames_;
  std::map<std::string, std::map<int, std::string>> texts_;  ///< by file and line
  std::vector<std::vector<std::string>> flashes_;            ///< by frame: findings to be shown on it
};

}  // namespace swarf::reports

// A picture of each finding, from the side that shows it best: the machine as it stands then, or the place on
// the part.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reports/kept_findings.h"
#include "reports/machine_view.h"
#include "sim/run/result.h"

namespace swarf::reports {

/// Of so many faults, the first in the page's order; `swarf render --finding N` draws any of the others.
inline constexpr size_t kFindingPicturesMost = 12;

/// Draws the first faults of the page (kFindingPicturesMost) that have a place or a moment: what is measured
/// on the part as the part coloured by its deviation, everything else as the machine at that moment, with a
/// ring about the place. Of the directions tried, from all round and above, the one from which most of what
/// lies about the place is seen. `file_of`: the path for fault N. Returns them by fault, number 1 first;
/// empty: no picture.
std::vector<std::string> make_finding_pictures(const FinishedRun& run, const TriMesh& part,
                                               const sim::Result& result,
                                               const std::function<std::string(size_t)>& file_of,
                                               Progress& progress);

/// The machine at a finding's moment about its place, or where it has none about the tool's tip, with its
/// text: of those of this number in the page and in findings.json the worst. Throws InputError
/// "unknown-finding".
void make_finding_picture(const FinishedRun& run, const KeptFindings& kept, int number,
                          const std::string& path);

/// A place on a coloured mesh, `width_mm` across, with a ring about it, from the side that shows most of it.
void make_place_picture(const TriMesh& coloured, const Vec3& place, double width_mm, const std::string& path);

}  // namespace swarf::reports

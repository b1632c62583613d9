// A picture of each kind of contact, from the side that shows it best: the machine as it stands when two
// parts first touch, or where a part of the tool stands deepest in the stock.
#pragma once

#include <string>
#include <vector>

#include "reports/kept_findings.h"
#include "reports/machine_view.h"
#include "sim/run/result.h"

namespace swarf::reports {

/// What one picture is to show.
struct ContactPicture {
  std::string caption;  ///< parts, line of the program, instant, depth
  size_t cycle = 0;
  Vec3 place_M = Vec3::Zero();
};

/// The first contact of every pair of parts, by time, kContactPicturesMost of them: of links, fixtures and
/// tools, of what comes to the stock, and of the tool's parts in the stock.
std::vector<ContactPicture> contact_pictures(const sim::Job& job, const sim::Result& result);
inline constexpr size_t kContactPicturesMost = 6;

/// Draws one, with a ring about the place. Of the directions tried, from all round and above, the one from
/// which most of what lies about the place is seen.
void make_contact_picture(const FinishedRun& run, const ContactPicture& picture, const std::string& path);

/// The machine at a finding's moment about the tool's tip, from the side that hides least of it, with its
/// text: of those of this number in the page and in findings.json the worst. Throws InputError
/// "unknown-finding".
void make_finding_picture(const FinishedRun& run, const KeptFindings& kept, int number,
                          const std::string& path);

/// A place on a coloured mesh, `width_mm` across, with a ring about it, from the side that shows most of it.
void make_place_picture(const TriMesh& coloured, const Vec3& place, double width_mm, const std::string& path);

}  // namespace swarf::reports

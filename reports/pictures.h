// Movie, stills and glTF of a finished run.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "render/draw_list.h"
#include "render/figures/colour.h"
#include "render/ray/ray_scene.h"
#include "render/ray/still.h"
#include "reports/machine_view.h"
#include "reports/metrics_json.h"
#include "reports/report_data.h"
#include "reports/review_models.h"
#include "sim/job/section_keys.h"

namespace swarf::reports {

/// Where a picture is taken from: "machine", "iso", "low", "front", "left", "right", "back", "top", or
/// "x,y,z": the direction from the subject to the eye. Throws InputError for anything else.
Vec3 camera_direction(const std::string& name);

/// A camera that keeps the stock at all its positions in the picture, in the machine frame.
render::Camera machine_camera(const FinishedRun& run, const std::string& name,
                              const std::array<int, 2>& size);

/// The machine at work, by the storyboard of the scene, replaced whole; `path` ends as MovieWriter says. When
/// the user stops it, the frames that are done stay a playable movie. `camera`: of shots that name none.
/// Frames are drawn by two renderers at once; the bytes do not depend on it.
RenderStatistics make_movie(const FinishedRun& run, const std::string& path, const std::string& camera,
                            Progress& progress);

/// The stock as it stands in a cycle of the run, at the movie's voxel size, for the eye.
TriMesh stock_at(const FinishedRun& run, const motion::Cycle& cycle);

/// The part as stills show it.
struct StillPart {
  TriMesh mesh;         ///< shown_part, with the worst places (add_worst_places)
  size_t measured = 0;  ///< vertices from here on are those places: the others lie within a part of a voxel
};
/// `worst`: beside the extremes of the measuring rays.
StillPart still_part(const FinishedRun& run, TriMesh closed, const std::vector<WorstPlace>& worst);

/// One picture of the part by ray tracing.
enum class StillKind { kMachine, kPart, kDeviation, kFan };
const std::string& still_name(StillKind kind);
StillKind still_kind(const std::string& name);  ///< "machine", "part", "deviation", "fan"; throws InputError
struct StillLook {
  bool transparent = false;                    ///< no backdrop and no floor
  bool labels = false;                         ///< scale bar; of deviations and sections, values and a legend
  std::optional<sim::SectionPlane> section{};  ///< section_still.h; the machine's tool stays whole
  SourceLocation section_where{};
  render::RayTreePtr* kept_tree = nullptr;  ///< for pictures of one part (StillOptions)
};
/// `camera` "": the usual one of the kind. Throws InputError as section_view().
void make_still(const FinishedRun& run, const StillPart& part, StillKind kind, const std::string& camera,
                const std::string& path, const StillLook& look = {});

/// The colour bar of the 3D view; its ends are those of the scale.
ColourBar deviation_colour_bar(const render::DeviationScale& scale);

/// A mesh whose colours show deviation, with its colour bar; labels as in StillLook, of the vertices from
/// `labelled` on. The scale bar is right at the middle of what is shown.
render::Image deviation_picture(const TriMesh& coloured, const render::DeviationScale& scale,
                                const std::string& camera, render::StillOptions options,
                                std::optional<size_t> labelled = {});

}  // namespace swarf::reports

// What a person turns and measures: the part and the machine as glTF, for files and for the page.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "measure/metrics.h"
#include "render/gltf/gltf_writer.h"
#include "reports/machine_view.h"
#include "reports/path_view.h"
#include "reports/stock_stages.h"

namespace swarf::reports {

/// The part for the eye, made light enough to be sent around.
struct DisplayMesh {
  TriMesh mesh;              ///< shown_part of the decimated mesh
  double error_mm = 0.0;     ///< that the decimation reached, measured
  double colours_off = 0.0;  ///< share of the area whose colour is off; NaN: not measured (shown_part)
};
/// Where metrics.json has a maximum.
struct WorstPlace {
  Vec3 place_W = Vec3::Zero();  ///< of the design
  double deviation_mm = 0.0;    ///< above the design; below it < 0
  std::optional<Vec3>
      end_W{};  ///< where the material ends there: of the deepest and the highest place of all
};

/// A finding at its place.
struct ReviewPin {
  size_t number = 0;  ///< in the page and in findings.json, from 1
  std::string code{}, text{};
  Severity severity = Severity::kError;
  std::optional<Vec3> place_W{};  ///< on the part
  std::optional<Vec3> place_M{};  ///< in the machine at t_s, where parts of it meet
  int line = 0;
  double t_s = 0.0, amount_mm = 0.0;  ///< amount: 0 where it is not known
};
/// No more are set: of a program without end of faults the page shows as many.
inline constexpr size_t kPinsMost = 200;

/// Made once, written in several encodings.
struct ReviewModels {
  DisplayMesh part;
  std::vector<StockStage> stages;
  Way way;
  std::vector<ReviewPin> pins;
  TriMesh machine_part{};  ///< the part for the machine's file
  DisplayMesh design{};    ///< for the page; may be empty
};
ReviewModels review_models(const FinishedRun& run, const TriMesh& closed, double max_error_mm,
                           std::vector<ReviewPin> pins);
/// Gives the part the worst places as vertices (add_worst_places): before the files.
void show_worst(const FinishedRun& run, std::span<const WorstPlace> worst, ReviewModels& models);

struct GltfOptions {
  render::GltfEncoding encoding = render::GltfEncoding::kFloat;
  bool colours = true;  ///< false: the reader colours deviations itself
  bool design = false;  ///< beside the part, ReviewModels::design: for a reader that hides it at first
};

/// The finished part with deviation as colour and attribute, findings on it as pins, the program's way and
/// the tool-axis fan as lines, cameras. Of the numbers in asset.extras, decimation_error_um is how far the
/// level set's mesh is from the part's, path_error_mm how far the program's way from its line,
/// colours_off_share (mesh and STEP designs) the share of the area whose colour shows another deviation.
std::string part_glb(const FinishedRun& run, const ReviewModels& models, const GltfOptions& options);

/// Links, tools and the stock in its stages with the axes animated over what is shown of the program, and a
/// pin in the machine frame where parts of the machine meet at a pin's time. Between
/// its keys an axis moves in a straight line, which no cycle is farther from than asset.extras says for that
/// axis (key_error_max_X_mm, ...), whether a viewer turns evenly from key to key or mixes quaternions. Every
/// node that an axis moves is named after it, and its extras say about what and how far it turns; the extras
/// "role" of the others are machine, fixture, tool or stock.
std::string machine_glb(const FinishedRun& run, const ReviewModels& models, const GltfOptions& options);

/// Program seconds that one second of the glTF animation stands for.
double animation_scale(const FinishedRun& run);

/// Gives the mesh a vertex over each of these places with what is known there: what is read from the picture
/// is what metrics.json says. Where no place is the deepest, or the highest, of all, the lowest or the
/// highest ray is. A place farther from every measured triangle than two voxels has none in the mesh. What
/// is higher than the highest place, which is known to the mesh's error only or was searched for and missed,
/// is lowered to it: results do not depend on what pictures are made. None that lies deeper is raised.
void add_worst_places(const FinishedRun& run, std::span<const WorstPlace> places, TriMesh& mesh);

}  // namespace swarf::reports

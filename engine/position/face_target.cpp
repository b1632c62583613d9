#include "position/face_target.h"

#include <algorithm>
#include <utility>

namespace swarf::position {
namespace {

/// The same contact on the surface itself, whose edge the straight one stands for: chords and the coordinates
/// of meshes (floats) would leave steps of .01 um where faces go on smoothly.
void stand_on_surface(const Setting& setting, const EdgeSpan& span, Rest& rest) {
  const surface::Surface& surface = *setting.patches[static_cast<size_t>(span.patch)].surface;
  const Vec3 from = surface.point(span.from.x(), span.from.y()), to = surface.point(span.to.x(), span.to.y());
  const Vec3 way = to - from;
  const double length2 = way.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((rest.contact_W - from).dot(way) / length2, 0.0, 1.0) : 0.0;
  const Footing at = footing_at(setting, span.patch, {}, span.from + share * (span.to - span.from));
  if (!at.under()) return;
  rest.height = at.height;
  rest.contact_W = setting.line.world(at.d.S);
}

}  // namespace

std::vector<Patch> patches_of(const std::vector<surface::Face>& faces) {
  std::vector<Patch> patches;
  for (const surface::Face& face : faces) {
    Patch patch{face.surface};
    if (!face.loops.empty()) patch.domain = std::make_shared<surface::FaceDomain>(face);
    patches.push_back(std::move(patch));
  }
  return patches;
}

FaceTarget::FaceTarget(const std::vector<surface::Face>& faces, const CellOptions& options)
    : FaceTarget(faces, face_edges(faces), options) {}

FaceTarget::FaceTarget(const std::vector<surface::Face>& faces, FaceEdges edges, const CellOptions& options)
    : patches_(patches_of(faces), options), edges_(edges.mesh), spans_(std::move(edges.spans)) {}

void FaceTarget::raise(const ToolProfile& profile, const GuideLine& line, Rest& best, Near& near,
                       PatchWork& work) const {
  Rest on_edge = best;
  PatchHint loop;
  edges_.raise(profile, line, on_edge, near.triangle);
  if (on_edge.height > best.height) {
    // Of the edges without area side 0 is the edge itself, 1 and 2 its second corner and the way back.
    const int edge = on_edge.number / 3, side = on_edge.number % 3;
    const EdgeSpan& span = spans_[static_cast<size_t>(edge)];
    stand_on_surface({patches_.patches(), profile, line}, span, on_edge);
    on_edge.number = span.patch;
    if (on_edge.height > best.height) best = on_edge;
    loop = {span.patch, side == 0 ? span.from : span.to};
  }
  patches_.raise(profile, line, best, near.patch, work, loop);
}

}  // namespace swarf::position

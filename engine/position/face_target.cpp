#include "position/face_target.h"

#include <utility>

namespace swarf::position {

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
    best = on_edge;
    best.number = span.patch;
    loop = {span.patch, side == 0 ? span.from : span.to};
  }
  patches_.raise(profile, line, best, near.patch, work, loop);
}

}  // namespace swarf::position

#include "stock/mesher/mesher_cell.h"

namespace swarf::stock {
namespace {

constexpr int kFaces = 6;
constexpr int kPatterns = 256;

/// The corners of a face in cyclic order and the edges between one and the next.
struct Face {
  std::array<int, 4> corners, edges;
};

int edge_between(int a, int b) {
  const int step = a ^ b;
  const int axis = step == 4 ? 0 : step == 2 ? 1 : 2;
  const int low = a & b;
  const int bits[3] = {low >> 2 & 1, low >> 1 & 1, low & 1};
  const int p = axis == 0 ? bits[1] : bits[0];
  const int q = axis == 2 ? bits[1] : bits[2];
  return 4 * axis + 2 * p + q;
}

std::array<Face, kFaces> make_faces() {
  std::array<Face, kFaces> faces;
  for (int f = 0; f < kFaces; ++f) {
    const int axis = f / 2;
    const int base = f % 2 * corner_step(axis);
    const int u = corner_step((axis + 1) % 3), v = corner_step((axis + 2) % 3);
    faces[f].corners = {base, base + u, base + u + v, base + v};
    for (int q = 0; q < 4; ++q) {
      faces[f].edges[q] = edge_between(faces[f].corners[q], faces[f].corners[(q + 1) % 4]);
    }
  }
  return faces;
}

const std::array<Face, kFaces>& faces() {
  static const std::array<Face, kFaces> table = make_faces();
  return table;
}

bool inside(CellSigns signs, int corner) {
  return (signs >> corner & 1) != 0;
}

bool ambiguous(CellSigns signs, const Face& face) {
  for (int q = 0; q < 4; ++q) {
    if (inside(signs, face.corners[q]) == inside(signs, face.corners[(q + 1) % 4])) return false;
  }
  return true;
}

/// Sets of edges, merged arc by arc.
class EdgeSets {
 public:
  EdgeSets() {
    for (int e = 0; e < kCellEdges; ++e) set_[e] = e;
  }
  void join(int a, int b) {
    const int from = set_[b], to = set_[a];
    for (int& s : set_) s = s == from ? to : s;
  }
  int of(int edge) const { return set_[edge]; }

 private:
  std::array<int, kCellEdges> set_;
};

EdgeSets join_arcs(CellSigns signs, uint8_t flipped) {
  EdgeSets sets;
  for (int f = 0; f < kFaces; ++f) {
    const Face& face = faces()[f];
    if (ambiguous(signs, face)) {
      // Edge q runs from corner q to the next, so an arc around corner q joins edges q - 1 and q.
      const bool around = (flipped >> f & 1) == 0;
      const int first = inside(signs, face.corners[0]) == around ? 0 : 1;
      sets.join(face.edges[(first + 3) % 4], face.edges[first]);
      sets.join(face.edges[first + 1], face.edges[first + 2]);
      continue;
    }
    int last = -1;
    for (int q = 0; q < 4; ++q) {
      if (inside(signs, face.corners[q]) == inside(signs, face.corners[(q + 1) % 4])) continue;
      if (last >= 0) sets.join(last, face.edges[q]);
      last = face.edges[q];
    }
  }
  return sets;
}

bool crossed(CellSigns signs, int edge) {
  const int low = edge_corner(edge);
  return inside(signs, low) != inside(signs, low + corner_step(edge / 4));
}

uint8_t find_twice_met(CellSigns signs) {
  const EdgeSets sets = join_arcs(signs, 0);
  uint8_t met = 0;
  for (int f = 0; f < kFaces; ++f) {
    const Face& face = faces()[f];
    if (!ambiguous(signs, face)) continue;
    const bool one = sets.of(face.edges[0]) == sets.of(face.edges[1]) &&
                     sets.of(face.edges[1]) == sets.of(face.edges[2]) &&
                     sets.of(face.edges[2]) == sets.of(face.edges[3]);
    met = static_cast<uint8_t>(met | (one ? 1 << f : 0));
  }
  return met;
}

template <class T, class Make>
std::array<T, kPatterns> table_of(const Make& make) {
  std::array<T, kPatterns> table;
  for (int n = 0; n < kPatterns; ++n) table[n] = make(static_cast<CellSigns>(n));
  return table;
}

}  // namespace

int edge_corner(int edge) {
  const int p = edge >> 1 & 1, q = edge & 1;
  switch (edge / 4) {
    case 0:
      return 2 * p + q;
    case 1:
      return 4 * p + q;
    default:
      return 4 * p + 2 * q;
  }
}

CellPatches cell_patches(CellSigns signs, uint8_t flipped) {
  const EdgeSets sets = join_arcs(signs, flipped);
  CellPatches patches;
  std::array<int, kCellEdges> patch_of_set;
  patch_of_set.fill(-1);
  for (int e = 0; e < kCellEdges; ++e) {
    if (!crossed(signs, e)) continue;
    int& patch = patch_of_set[sets.of(e)];
    if (patch < 0) patch = patches.count++;
    patches.edges[patch] = static_cast<uint16_t>(patches.edges[patch] | 1 << e);
  }
  return patches;
}

const CellPatches& cell_patches(CellSigns signs) {
  static const auto table = table_of<CellPatches>([](CellSigns n) { return cell_patches(n, 0); });
  return table[signs];
}

uint8_t twice_met_faces(CellSigns signs) {
  static const auto table = table_of<uint8_t>(find_twice_met);
  return table[signs];
}

}  // namespace swarf::stock

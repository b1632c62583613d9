#include "collision/convex_distance.h"

#include <cmath>

namespace swarf::collision {
namespace {

constexpr int kIterations = 96;

/// A point of the difference of both, and what it is made of.
struct Vertex {
  Vec3 w, home_a, home_b;
  bool late;
};

struct Simplex {
  std::array<Vertex, 4> at;
  std::array<double, 4> weight{1.0, 0.0, 0.0, 0.0};
  int size = 0;
};

/// Weights of the point of a simplex that lies nearest to the origin; those not named are zero.
struct Nearest {
  std::array<double, 4> weight{};
  Vec3 v = Vec3::Zero();
  double square = INFINITY;
};

void take_point(const Simplex& simplex, int i, Nearest& best) {
  const double square = simplex.at[i].w.squaredNorm();
  if (square >= best.square) return;
  best = {{}, simplex.at[i].w, square};
  best.weight[i] = 1.0;
}

void take_edge(const Simplex& simplex, int i, int j, Nearest& best) {
  const Vec3 &p = simplex.at[i].w, along = simplex.at[j].w - p;
  const double length = along.squaredNorm(), share = -p.dot(along);
  if (!(share > 0.0 && share < length)) return;
  const double s = share / length;
  const Vec3 v = p + s * along;
  const double square = v.squaredNorm();
  if (square >= best.square) return;
  best = {{}, v, square};
  best.weight[i] = 1.0 - s;
  best.weight[j] = s;
}

void take_face(const Simplex& simplex, int i, int j, int k, Nearest& best) {
  const Vec3 &a = simplex.at[i].w, &b = simplex.at[j].w, &c = simplex.at[k].w;
  const Vec3 normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (!(area > 0.0)) return;
  const double wa = normal.dot(b.cross(c)), wb = normal.dot(c.cross(a)), wc = normal.dot(a.cross(b));
  if (!(wa > 0.0 && wb > 0.0 && wc > 0.0)) return;
  const double sum = wa + wb + wc;
  const Vec3 v = (wa * a + wb * b + wc * c) / sum;
  const double square = v.squaredNorm();
  if (square >= best.square) return;
  best = {{}, v, square};
  best.weight[i] = wa / sum;
  best.weight[j] = wb / sum;
  best.weight[k] = wc / sum;
}

/// The origin strictly inside a tetrahedron with volume: distance zero, weights as its volumes.
bool take_inside(const Simplex& simplex, Nearest& best) {
  const Vec3 &a = simplex.at[0].w, &b = simplex.at[1].w, &c = simplex.at[2].w, &d = simplex.at[3].w;
  const double wa = b.dot(c.cross(d)), wb = -a.dot(c.cross(d)), wc = a.dot(b.cross(d)),
               wd = -a.dot(b.cross(c));
  const bool positive = wa > 0.0 && wb > 0.0 && wc > 0.0 && wd > 0.0;
  const bool negative = wa < 0.0 && wb < 0.0 && wc < 0.0 && wd < 0.0;
  if (!positive && !negative) return false;
  const double sum = wa + wb + wc + wd;
  best = {{wa / sum, wb / sum, wc / sum, wd / sum}, Vec3::Zero(), 0.0};
  return true;
}

/// All features are tried, so that no rounding sends the search into the wrong one.
Nearest nearest_of(const Simplex& simplex) {
  Nearest best;
  if (simplex.size == 4 && take_inside(simplex, best)) return best;
  for (int i = 0; i < simplex.size; ++i) take_point(simplex, i, best);
  for (int i = 0; i < simplex.size; ++i)
    for (int j = i + 1; j < simplex.size; ++j) take_edge(simplex, i, j, best);
  for (int i = 0; i < simplex.size; ++i)
    for (int j = i + 1; j < simplex.size; ++j)
      for (int k = j + 1; k < simplex.size; ++k) take_face(simplex, i, j, k, best);
  return best;
}

void keep_weighted(Simplex& simplex, const Nearest& nearest) {
  int kept = 0;
  for (int i = 0; i < simplex.size; ++i) {
    if (nearest.weight[i] == 0.0) continue;
    if (kept != i) simplex.at[kept] = simplex.at[i];
    simplex.weight[kept++] = nearest.weight[i];
  }
  simplex.size = kept;
}

struct Extreme {
  Vec3 point, home;
  bool late = false;
};

Extreme farthest_corner(const ConvexView& view, const Vec3& direction) {
  int best = 0;
  double most = direction.dot(view.corners[0]);
  for (int i = 1; i < 3 * view.poses; ++i) {
    const double reach = direction.dot(view.corners[i]);
    if (reach > most) {
      most = reach;
      best = i;
    }
  }
  return {view.corners[best], view.home[best % 3], best >= 3};
}

Extreme farthest_of_solid(const ConvexView& view, const Vec3& direction) {
  if (view.pose[0] == nullptr) {
    const Vec3 point = support(*view.solid, direction);
    return {point, point, false};
  }
  Extreme best;
  for (int i = 0; i < view.poses; ++i) {
    const Vec3 home = support(*view.solid, view.pose[i]->linear().transpose() * direction);
    const Vec3 point = *view.pose[i] * home;
    if (i == 0 || direction.dot(point) > direction.dot(best.point)) best = {point, home, i == 1};
  }
  return best;
}

Extreme farthest(const ConvexView& view, const Vec3& direction) {
  return view.solid == nullptr ? farthest_corner(view, direction) : farthest_of_solid(view, direction);
}

Vertex difference(const ConvexView& a, const ConvexView& b, const Vec3& direction) {
  const Extreme one = farthest(a, direction), other = farthest(b, -direction);
  return {one.point - other.point, one.home, other.home, other.late};
}

bool repeats(const Simplex& simplex, const Vertex& vertex) {
  for (int i = 0; i < simplex.size; ++i) {
    if (simplex.at[i].w == vertex.w) return true;
  }
  return false;
}

ConvexDistance answer_of(const Simplex& simplex, double upper) {
  ConvexDistance answer;
  answer.upper = upper;
  for (int i = 0; i < simplex.size; ++i) {
    const Vertex& vertex = simplex.at[i];
    answer.home_a += simplex.weight[i] * vertex.home_a;
    answer.home_b += simplex.weight[i] * vertex.home_b;
    if (vertex.late) answer.t += simplex.weight[i];
  }
  return answer;
}

/// The best of the support planes so far.
struct LowerBound {
  double plain = 0.0, less_slack = 0.0;
  Vec3 normal = Vec3::Zero();
  void see(const Vec3& v, double length, const Vertex& support, const MotionSlack& motion) {
    const double bound = v.dot(support.w) / length;
    if (bound <= plain) return;
    plain = bound;
    const Vec3 n = v / length;
    const double less = bound - motion.along(n);
    if (less <= less_slack) return;
    less_slack = less;
    normal = n;
  }
};

}  // namespace

ConvexView view_of(const Body& body, uint32_t primitive) {
  ConvexView view;
  if (primitive >= body.triangles.size()) {
    view.solid = &body.solids[primitive - body.triangles.size()];
    return view;
  }
  view.home = body.triangles[primitive];
  for (int i = 0; i < 3; ++i) view.corners[i] = view.home[i];
  return view;
}

ConvexView view_of(const Body& body, uint32_t primitive, const Pose& first, const Pose* second) {
  ConvexView view = view_of(body, primitive);
  view.poses = second == nullptr ? 1 : 2;
  view.pose[0] = &first;
  view.pose[1] = second;
  if (view.solid != nullptr) return view;
  for (int i = 0; i < 3; ++i) {
    view.corners[i] = first * view.home[i];
    if (second != nullptr) view.corners[i + 3] = *second * view.home[i];
  }
  return view;
}

ConvexDistance convex_distance(const ConvexView& a, const ConvexView& b, double enough,
                               const MotionSlack& slack) {
  Simplex simplex;
  simplex.at[0] = difference(a, b, Vec3(0.5, 0.6, 0.7));
  simplex.size = 1;
  Vec3 v = simplex.at[0].w;
  LowerBound lower;
  double length = v.norm();
  for (int step = 0; step < kIterations && length > 0.0; ++step) {
    const Vertex next = difference(a, b, -v);
    lower.see(v, length, next, slack);
    if (lower.less_slack > enough || length - lower.plain <= kConvexGap || repeats(simplex, next)) break;
    Simplex larger = simplex;
    larger.at[larger.size++] = next;
    const Nearest nearest = nearest_of(larger);
    const double shorter = std::sqrt(nearest.square);
    if (shorter >= length) break;
    keep_weighted(larger, nearest);
    simplex = larger;
    v = nearest.v;
    length = shorter;
  }
  ConvexDistance answer = answer_of(simplex, length);
  answer.lower = std::min(lower.less_slack, length);
  answer.normal = lower.normal;
  return answer;
}

}  // namespace swarf::collision

// Trimmed faces under a tool: closed forms on loops, and random faces against dense search.
#include "position/face_target.h"

#include <gtest/gtest.h>

#include <random>

#include "patch_scene.h"

namespace swarf::position {
namespace {

/// What a position on faces may be off by: the proof of the patches, chords of loops and floats; mm.
constexpr double kWithin_mm = 5e-5;

surface::TrimLoop circle(const Vec2& centre, double radius, int places) {
  surface::TrimLoop loop;
  for (int i = 0; i < places; ++i) {
    const double turn = 2.0 * kPi * i / places;
    loop.push_back(centre + radius * Vec2(std::cos(turn), std::sin(turn)));
  }
  return loop;
}

surface::Face face_of(const Patch& patch, std::vector<surface::TrimLoop> loops) {
  surface::Face face;
  face.surface = patch.surface;
  face.loops = std::move(loops);
  surface::orient_loops(face.loops);
  return face;
}

/// Level, 40 x 40 mm about the origin, z = 0.
Patch level_plane() {
  return plane_patch({-20, -20, 0}, {40, 0, 0}, {0, 40, 0});
}
const surface::TrimLoop kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

Rest rest_on(const FaceTarget& target, const ToolProfile& tool, double x, double y,
             PatchWork* took = nullptr) {
  Rest best;
  Near near;
  PatchWork work;
  target.raise(tool, upright(x, y), best, near, work);
  if (took != nullptr) *took = work;
  return best;
}

TEST(FaceTarget, BallInARoundHoleOfAPlane) {
  constexpr double kHole = 5.0, kBall = 8.0;
  const FaceTarget target({face_of(level_plane(), {kSquare, circle({0.5, 0.5}, kHole / 40.0, 4000)})});
  for (const double off : {0.0, 0.4, 2.0, 4.5, 4.99}) {
    const Rest rest = rest_on(target, ball_end(kBall), off, 0.0);
    const double rho = kHole - off;
    EXPECT_NEAR(rest.height, std::sqrt(kBall * kBall - rho * rho) - kBall, kWithin_mm) << "off " << off;
    EXPECT_NE(rest.what, Touched::kFace);
  }
  const Rest beside = rest_on(target, ball_end(kBall), 5.5, 0.0);
  EXPECT_NEAR(beside.height, 0.0, kPatchProof_mm);
  EXPECT_EQ(beside.what, Touched::kFace);
}

TEST(FaceTarget, ToolThatFitsThroughTheHoleFallsThrough) {
  const FaceTarget target({face_of(level_plane(), {kSquare, circle({0.5, 0.5}, 5.0 / 40.0, 4000)})});
  for (const ToolProfile& tool : {ball_end(4.9), flat_end(4.9), nose_end(2.9, 2.0)}) {
    EXPECT_FALSE(rest_on(target, tool, 0.0, 0.0).touches());
    EXPECT_NEAR(rest_on(target, flat_end(4.9), 0.2, 0.0).height, 0.0, kWithin_mm);
  }
}

/// Theory 3, edge: t = s d / sqrt(k^2 - s^2) for a cone, for a ball t = s sqrt((R^2 - d^2) / (1 + s^2)).
TEST(FaceTarget, InclinedEdgeOfATrimmedPlane) {
  constexpr double kSlope = 0.3, kBall = 6.0, kBeside = 2.5;
  // z = slope y - 3 x, trimmed at x < 0: beside the edge x = 0 the plane falls away.
  const Patch plane = plane_patch({-20, -20, 60.0 - 20.0 * kSlope}, {40, 0, -120}, {0, 40, 40 * kSlope});
  const FaceTarget target({face_of(plane, {{{0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}}})});
  for (const double y : {-7.0, 0.0, 3.3}) {
    const Rest rest = rest_on(target, ball_end(kBall), -kBeside, y);
    const double t = kSlope * std::sqrt((kBall * kBall - kBeside * kBeside) / (1.0 + kSlope * kSlope));
    const double below = std::sqrt(kBall * kBall - kBeside * kBeside - t * t);
    EXPECT_NEAR(rest.height, kSlope * (y + t) - (kBall - below), kWithin_mm) << "y " << y;
    EXPECT_EQ(rest.what, Touched::kEdge);
  }
}

TEST(FaceTarget, CornerOfATrimmedPlane) {
  constexpr double kBall = 5.0;
  const FaceTarget target({face_of(level_plane(), {{{0.5, 0.5}, {1, 0.5}, {1, 1}, {0.5, 1}}})});
  const Rest rest = rest_on(target, ball_end(kBall), -2.0, -1.0);
  EXPECT_NEAR(rest.height, std::sqrt(kBall * kBall - 5.0) - kBall, kWithin_mm);
  EXPECT_EQ(rest.what, Touched::kVertex);
}

TEST(FaceTarget, FacesThatShareAnEdgeLeaveNoGap) {
  const Patch whole = dome_patch();
  const PatchTarget dome({whole});
  const surface::TrimLoop left{{0, 0}, {0.4, 0}, {0.6, 1}, {0, 1}}, right{{0.4, 0}, {1, 0}, {1, 1}, {0.6, 1}};
  const FaceTarget halves({face_of(whole, {left}), face_of(whole, {right})});
  const ToolProfile tool = nose_end(3.0, 2.0);
  for (double x = -30.0; x <= 30.0; x += 0.37) {
    Rest one;
    PatchHint hint;
    dome.raise(tool, upright(x, 0.2 * x), one, hint);
    EXPECT_NEAR(rest_on(halves, tool, x, 0.2 * x).height, one.height, kWithin_mm) << "x " << x;
  }
}

/// A place under the tool asks for this height; on the rim itself, give or take rounding, as well.
double asked(const ToolProfile& tool, const Vec3& p, double x, double y) {
  const double rho = std::hypot(p.x() - x, p.y() - y);
  if (rho > tool.radius() + 2.0 * kRim_mm) return -std::numeric_limits<double>::infinity();
  return p.z() - tool.height(std::min(rho, tool.radius()));
}

struct Wild {
  surface::Face face;
  unsigned seed;
};
/// A bicubic patch of some 20 x 20 mm with a jagged outline and a round hole.
Wild wild_face(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<Vec3> poles;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k)
      poles.emplace_back(20.0 / 3.0 * i - 10.0, 20.0 / 3.0 * k - 10.0, 4.0 * any(random));
  }
  surface::TrimLoop outline;
  constexpr int kCorners = 9;
  for (int i = 0; i < kCorners; ++i) {
    const double turn = 2.0 * kPi * i / kCorners, radius = 0.36 + 0.11 * any(random);
    outline.emplace_back(0.5 + radius * std::cos(turn), 0.5 + radius * std::sin(turn));
  }
  const Vec2 hole(0.5 + 0.06 * any(random), 0.5 + 0.06 * any(random));
  return {face_of(bezier(3, 3, poles), {outline, circle(hole, 0.12, 60)}), seed};
}

/// The greatest height that places of the face ask for: a grid inside the loops, refined, and the loops.
double searched(const surface::Face& face, const ToolProfile& tool, double x, double y) {
  const surface::FaceDomain domain(face);
  const auto at = [&](const Vec2& uv) { return asked(tool, face.surface->point(uv.x(), uv.y()), x, y); };
  double best = -std::numeric_limits<double>::infinity();
  Vec2 centre(0.5, 0.5), place = centre;
  for (double half = 0.5; half > 1e-6; half *= 0.15) {
    constexpr int kGrid = 60;
    for (int i = -kGrid; i <= kGrid; ++i) {
      for (int k = -kGrid; k <= kGrid; ++k) {
        const Vec2 uv = centre + half / kGrid * Vec2(i, k);
        if (!domain.inside(uv) || !(at(uv) > best)) continue;
        best = at(uv);
        place = uv;
      }
    }
    centre = place;
  }
  for (const surface::TrimLoop& loop : face.loops) {
    for (size_t i = 0; i < loop.size(); ++i) {
      constexpr int kParts = 400;
      for (int k = 0; k < kParts; ++k)
        best = std::max(best, at(loop[i] + (loop[(i + 1) % loop.size()] - loop[i]) * (double(k) / kParts)));
    }
  }
  return best;
}

/// From the contact to the nearest place of the loops, mm.
double from_loops(const surface::Face& face, const Vec3& contact) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const surface::TrimLoop& loop : face.loops) {
    for (size_t i = 0; i < loop.size(); ++i) {
      constexpr int kParts = 2000;
      Vec3 before = face.surface->point(loop[i].x(), loop[i].y());
      for (int k = 1; k <= kParts; ++k) {
        const Vec2 uv = loop[i] + (loop[(i + 1) % loop.size()] - loop[i]) * (double(k) / kParts);
        const Vec3 here = face.surface->point(uv.x(), uv.y()), way = here - before;
        const double part = std::clamp((contact - before).dot(way) / way.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (before + part * way - contact).norm());
        before = here;
      }
    }
  }
  return nearest;
}

TEST(FaceTarget, RandomFacesAgainstASearch) {
  const ToolProfile tools[] = {ball_end(3.0), flat_end(2.5), nose_end(2.0, 1.5), ball_end(7.0)};
  int on_loops = 0, inside = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Wild wild = wild_face(seed);
    const FaceTarget target({wild.face});
    const surface::FaceDomain domain(wild.face);
    std::mt19937 random(seed + 1000);
    std::uniform_real_distribution<double> any(-11.0, 11.0);
    for (int i = 0; i < 8; ++i) {
      const double x = any(random), y = any(random);
      const ToolProfile& tool = tools[i % 4];
      PatchWork work;
      const Rest rest = rest_on(target, tool, x, y, &work);
      const auto where = testing::Message()
                         << "seed " << seed << " x " << x << " y " << y << " tool " << i % 4;
      const double truth = searched(wild.face, tool, x, y);
      EXPECT_LE(work.gap, kPatchProof_mm) << where;
      if (!rest.touches()) {
        EXPECT_EQ(truth, -std::numeric_limits<double>::infinity()) << where;
        continue;
      }
      // Nothing is higher, and what holds the tool is a place of the face.
      EXPECT_GE(rest.height, truth - kWithin_mm) << where;
      EXPECT_NEAR(asked(tool, rest.contact_W, x, y), rest.height, 1e-7) << where;
      if (rest.what == Touched::kFace) {
        ++inside;
        EXPECT_TRUE(domain.inside({rest.u, rest.v})) << where;
      } else {
        ++on_loops;
        EXPECT_LT(from_loops(wild.face, rest.contact_W), 2e-5) << where;
      }
    }
  }
  EXPECT_GT(on_loops, 10);
  EXPECT_GT(inside, 10);
}

}  // namespace
}  // namespace swarf::position

// Which faces are ruled is decided by their control nets, and the bound holds.
#include "surface/ruled_face.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/rng.h"

namespace swarf::surface {
namespace {

NurbsData cubic_by(int degree_v) {
  NurbsData data;
  data.degree_u = 3;
  data.degree_v = degree_v;
  data.knots_u = {0, 0, 0, 0, 0.4, 1, 1, 1, 1};
  data.knots_v.assign(static_cast<size_t>(degree_v) + 1, 0.0);
  data.knots_v.insert(data.knots_v.end(), static_cast<size_t>(degree_v) + 1, 1.0);
  return data;
}

/// Straight along v, the columns at shares that are no even steps; `bulge` lifts one pole of the middle.
NurbsData straight(Rng& rng, int degree_v, bool weighted, double bulge) {
  NurbsData data = cubic_by(degree_v);
  std::vector<double> shares, column_weights;
  for (int j = 0; j <= degree_v; ++j) {
    shares.push_back(j == 0 ? 0.0 : j == degree_v ? 1.0 : (j + rng.uniform(-0.3, 0.3)) / degree_v);
    column_weights.push_back(weighted ? rng.uniform(0.5, 2.0) : 1.0);
  }
  for (int i = 0; i < 5; ++i) {
    const Vec3 low(10.0 * i, rng.uniform(-3, 3), rng.uniform(-1, 1));
    const Vec3 high(10.0 * i + rng.uniform(-2, 2), rng.uniform(-3, 3), 20.0 + rng.uniform(-1, 1));
    const double row_weight = weighted ? rng.uniform(0.5, 2.0) : 1.0;
    for (size_t j = 0; j < shares.size(); ++j) {
      data.poles.push_back(low + shares[j] * (high - low));
      if (i == 2 && j == 1) data.poles.back().y() += bulge;
      if (weighted) data.weights.push_back(row_weight * column_weights[j]);
    }
  }
  return data;
}

NurbsData turned_over(const NurbsData& data) {
  NurbsData turned = data;
  std::swap(turned.degree_u, turned.degree_v);
  std::swap(turned.knots_u, turned.knots_v);
  const int nu = data.count_u(), nv = data.count_v();
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const auto from = static_cast<size_t>(i * nv + j), to = static_cast<size_t>(j * nu + i);
      turned.poles[to] = data.poles[from];
      if (!data.weights.empty()) turned.weights[to] = data.weights[from];
    }
  return turned;
}

TEST(RuledFace, StraightRowsAreProvenWhateverTheirDegreeAndWeights) {
  for (uint64_t seed = 1; seed <= 24; ++seed) {
    Rng rng(seed);
    const NurbsData data = straight(rng, 1 + static_cast<int>(seed % 4), seed % 2 == 0, 0.0);
    const NurbsSurface along_v(data), along_u(turned_over(data));
    EXPECT_LT(ruled_departure_bound(along_v, RulingDirection::kV), 1e-12) << seed;
    EXPECT_LT(ruled_departure_bound(along_u, RulingDirection::kU), 1e-12) << seed;
    EXPECT_GT(ruled_departure_bound(along_v, RulingDirection::kU), 1e-3) << seed;
  }
}

TEST(RuledFace, TheBoundIsAboveWhatIsSeen) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    const double bulge = std::pow(10.0, rng.uniform(-6, 0));
    const NurbsSurface surface(straight(rng, 3, seed % 2 == 0, bulge));
    const double bound = ruled_departure_bound(surface, RulingDirection::kV),
                 seen = ruled_departure_seen(surface, RulingDirection::kV);
    EXPECT_GE(bound, seen) << seed;
    EXPECT_GT(seen, 0.01 * bulge) << seed;
    EXPECT_LT(bound, 3.0 * bulge) << seed;
  }
}

TEST(RuledFace, WeightsThatDoNotGoTogetherAreNotDecided) {
  Rng rng(3);
  NurbsData data = straight(rng, 2, true, 0.0);
  data.weights[4] *= 1.01;
  EXPECT_TRUE(std::isinf(ruled_departure_bound(NurbsSurface(data), RulingDirection::kV)));
}

/// Places, normals and bounds of the surface between two edges.
void expect_same_places(const SurfacePtr& face, const RuledPart& part) {
  const SurfacePtr ruled = ruled_between(part);
  for (const double u : {0.0, 0.3, 0.8, 1.0}) {
    const Derivatives a = ruled->derivatives(u, 0.0), b = ruled->derivatives(u, 1.0);
    const double g = part.direction == RulingDirection::kV ? part.low.x() + u * (part.high - part.low).x()
                                                           : part.low.y() + u * (part.high - part.low).y();
    const double first = part.direction == RulingDirection::kV ? part.low.y() : part.low.x();
    const double last = part.direction == RulingDirection::kV ? part.high.y() : part.high.x();
    const auto at = [&](double r) { return part.direction == RulingDirection::kV ? Vec2(g, r) : Vec2(r, g); };
    const Vec2 low = at(part.exchanged ? last : first), high = at(part.exchanged ? first : last);
    EXPECT_LT((a.S - face->point(low.x(), low.y())).norm(), 1e-12);
    EXPECT_LT((b.S - face->point(high.x(), high.y())).norm(), 1e-12);
    EXPECT_EQ(a.Svv, Vec3::Zero());
    // The side of the material is that of the face.
    EXPECT_GT(outward_normal(*ruled, a).dot(outward_normal(*face, face->derivatives(low.x(), low.y()))),
              0.99);
    const double h = 1e-5, x = std::min(std::max(u, 2 * h), 1.0 - 2 * h);
    const Derivatives d = ruled->derivatives(x, 0.4), p = ruled->derivatives(x + h, 0.4),
                      m = ruled->derivatives(x - h, 0.4);
    EXPECT_LT((d.Su - (p.S - m.S) / (2 * h)).norm(), 1e-5);
    EXPECT_LT((d.Suv - (p.Sv - m.Sv) / (2 * h)).norm(), 1e-5);
    EXPECT_LT((d.Suu - (p.Su - m.Su) / (2 * h)).norm(), 1e-2);
  }
  for (int i = 0; i < 8; ++i) {
    const Vec2 low(i / 8.0, 0.1 * (i % 3)), high((i + 1) / 8.0, 0.4 + 0.1 * (i % 3));
    const BendBounds bounds = ruled->bend_bounds(low, high);
    for (int k = 0; k <= 20; ++k) {
      const Derivatives d = ruled->derivatives(low.x() + (high - low).x() * k / 20.0,
                                               low.y() + (high - low).y() * (k * 7 % 21) / 20.0);
      EXPECT_LE((d.Suu - bounds.uu.mean).norm(), bounds.uu.stray + 1e-9);
      EXPECT_LE((d.Suv - bounds.uv.mean).norm(), bounds.uv.stray + 1e-9);
    }
  }
}

TEST(RuledFace, BetweenTheEdgesLieTheSamePlaces) {
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    Rng rng(seed);
    NurbsData data = straight(rng, 2, false, 0.0);
    data.outward_sign = seed % 2 == 0 ? 1 : -1;
    const auto along_v = std::make_shared<NurbsSurface>(data),
               along_u = std::make_shared<NurbsSurface>(turned_over(data));
    for (const bool exchanged : {false, true}) {
      expect_same_places(along_v, {along_v, RulingDirection::kV, {0.1, 0.2}, {0.9, 0.7}, exchanged});
      expect_same_places(along_u, {along_u, RulingDirection::kU, {0.2, 0.1}, {0.7, 0.9}, exchanged});
    }
  }
}

TEST(RuledFace, OnlyRectanglesOfTheParametersAreTaken) {
  Face face;
  ASSERT_TRUE(rectangle_of(face));
  face.loops = {{{0.2, 0.1}, {0.8, 0.1}, {0.8, 0.5}, {0.8, 0.9}, {0.2, 0.9}}};
  const auto rectangle = rectangle_of(face);
  ASSERT_TRUE(rectangle);
  EXPECT_EQ((*rectangle)[0], Vec2(0.2, 0.1));
  EXPECT_EQ((*rectangle)[1], Vec2(0.8, 0.9));
  Face slanted = face;
  slanted.loops[0][0] = {0.3, 0.1};  // a corner that is cut off
  EXPECT_FALSE(rectangle_of(slanted));
  Face holed = face;
  holed.loops.push_back({{0.4, 0.4}, {0.4, 0.5}, {0.5, 0.5}});
  EXPECT_FALSE(rectangle_of(holed));
}

}  // namespace
}  // namespace swarf::surface

// Ruled surfaces that several tests mill.
#pragma once

#include <memory>
#include <vector>

#include "base/rng.h"
#include "surface/nurbs.h"
#include "surface/polynomial.h"

namespace swarf::flank::test {

/// C0 = (60u, 0, 0), C1 = (60u, 20(u-1/2), 30): F1 of theory 5.
inline surface::SurfacePtr f1() {
  return std::make_shared<surface::PolynomialSurface>(
      1, 1, std::vector<Vec3>{{0, 0, 0}, {0, -10, 30}, {60, 0, 0}, {0, 20, 0}}, 1);
}

/// Guides of degree 2 that twist, bend and sweep.
inline surface::SurfacePtr random_ruled(Rng& rng) {
  const auto some = [&](double most) { return rng.uniform(-most, most); };
  std::vector<Vec3> rows;
  rows.push_back(Vec3{some(5), some(5), some(2)});
  rows.push_back(Vec3{some(6), some(4), 25 + some(5)});
  rows.push_back(Vec3{50 + some(10), some(8), some(3)});
  rows.push_back(Vec3{some(6), some(8), some(3)});
  rows.push_back(Vec3{some(4), some(8), some(2)});
  rows.push_back(Vec3{some(3), some(3), some(2)});
  return std::make_shared<surface::PolynomialSurface>(2, 1, rows, 1);
}

/// A dual cubic B-spline, Ma et al., JCDE 2022, App. 1.
inline surface::SurfacePtr jcde() {
  surface::NurbsData data;
  data.degree_u = 3;
  data.degree_v = 1;
  data.knots_u = {0, 0, 0, 0, .2, .4, .6, .8, 1, 1, 1, 1};
  data.knots_v = {0, 0, 1, 1};
  const std::vector<Vec3> p{{5, 0, 0},   {-10, 20, 0}, {10, 20, 0}, {20, 30, 0},
                            {30, 30, 0}, {40, 30, 0},  {50, 20, 0}, {55, 0, 0}};
  const std::vector<Vec3> h{{0, 0, 15},   {-15, 20, 15}, {5, 25, 15},  {15, 35, 15},
                            {30, 35, 15}, {45, 35, 15},  {55, 25, 15}, {60, 0, 15}};
  for (size_t i = 0; i < p.size(); ++i) {
    data.poles.push_back(p[i]);
    data.poles.push_back(h[i]);
  }
  return std::make_shared<surface::NurbsSurface>(data);
}

}  // namespace swarf::flank::test

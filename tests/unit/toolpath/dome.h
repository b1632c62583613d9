// The reference surface of theory 1.6 and programs on it, built by hand.
#pragma once

#include <memory>
#include <vector>

#include "program/surface_blocks/program.h"
#include "surface/polynomial.h"
#include "toolpath/tool_path.h"

namespace swarf::toolpath::test {

/// z = a u + b u^2 + c v + d v^2 over a flat rectangle.
inline surface::SurfacePtr quadric(double width, double depth, double a, double b, double c, double d) {
  const std::vector<Vec3> coefficients{{-0.5 * width, -0.5 * depth, 0},
                                       {0, depth, c},
                                       {0, 0, d},
                                       {width, 0, a},
                                       {0, 0, 0},
                                       {0, 0, 0},
                                       {0, 0, b},
                                       {0, 0, 0},
                                       {0, 0, 0}};
  return std::make_shared<surface::PolynomialSurface>(2, 2, coefficients, 1);
}

/// DOME: x = 100u-50, y = 80v-40, z = 80u-80u^2+60v-60v^2.
inline surface::SurfacePtr dome() {
  return quadric(100, 80, 80, -80, 60, -60);
}

/// G06.3 over one surface, start boundary and scallop given, 50 mm/s.
inline program::Program area_program(surface::SurfacePtr surface, program::StartBoundary start,
                                     double scallop_mm) {
  program::Program program;
  program.file = "test.nc";
  program.surfaces.push_back({1, std::move(surface), {"test.nc", 4, 1}});
  program::Operation operation;
  operation.start = start;
  operation.zigzag = true;
  operation.scallop_mm = scallop_mm;
  operation.feed_mm_s = 50.0;
  operation.tool = 1;
  operation.where = {"test.nc", 11, 6};
  program.operations.push_back(operation);
  return program;
}

inline PlanOptions options_for(Planner planner, double stock_top_mm = 45.0) {
  PlanOptions options;
  options.planner = planner;
  options.stock_top_mm = stock_top_mm;
  return options;
}

inline std::vector<SurfacePass> passes_of(const ToolPath& path) {
  std::vector<SurfacePass> passes;
  for (const Element& element : path.elements)
    if (const auto* pass = std::get_if<SurfacePass>(&element.what)) passes.push_back(*pass);
  return passes;
}

}  // namespace swarf::toolpath::test

// What the tests of CL data share.
#pragma once

#include "program/cl/program.h"
#include "unit/program/support.h"

namespace swarf::program {

/// What the programs of these tests leave open: CIRCLE as NX means it.
inline ClOptions as_nx() {
  ClOptions options;
  options.circle_clockwise = true;
  return options;
}

inline ClProgram read_cl_clean(const std::string& text, const ClOptions& options = as_nx()) {
  Diagnostics diagnostics;
  ClProgram program = parse_cl(text, "test.cl", diagnostics, options);
  EXPECT_TRUE(diagnostics.list().empty()) << all_text(diagnostics) << "--- of\n" << text;
  return program;
}

inline std::string first_place(const std::string& text, const ClOptions& options = as_nx()) {
  Diagnostics diagnostics;
  parse_cl(text, "test.cl", diagnostics, options);
  return diagnostics.list().empty() ? "" : places(diagnostics).front();
}

inline void expect_tip(const Vec3& tip, double x, double y, double z) {
  EXPECT_LT((tip - Vec3(x, y, z)).norm(), 1e-9) << "(" << tip.x() << ", " << tip.y() << ", " << tip.z()
                                                << ") instead of (" << x << ", " << y << ", " << z << ")";
}

}  // namespace swarf::program

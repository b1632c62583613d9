// The surfaces of a program while G10 L70, L71, L72 and L79 build them. Each check_... reports what is wrong
// with a block and changes nothing; the function of the same name without check_ then does what the block
// says.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "program/surface_blocks/rules.h"
#include "surface/polynomial.h"

namespace swarf::program {

struct Coefficient {
  Vec3 value = Vec3::Zero();  ///< mm
  int line = 0;
};

struct SurfaceEntry {
  int degree_u = 3, degree_v = 3;
  SourceLocation where;          ///< its L70 block
  Action basis = Action::kNone;  ///< kPowerCoefficient or kBezierPoint once one is given
  std::map<std::pair<int, int>, Coefficient> coefficients;  ///< by (I, J)
  int index = -1;                                           ///< into Program::surfaces once closed by L79
  int closed_line = 0;

  bool closed() const { return index >= 0; }
};

using SurfaceTable = std::map<int, SurfaceEntry>;

/// L70: "surface-number-used".
void check_open_surface(const SurfaceTable& table, const CheckedBlock& block, Reporter& reporter);
void open_surface(SurfaceTable& table, const CheckedBlock& block, const Reporter& reporter);

/// L71, L72: "surface-closed", "coefficient-outside-degree", "coefficient-twice", "mixed-coefficients".
void check_coefficient(const SurfaceEntry& entry, const CheckedBlock& block, Reporter& reporter);
void add_coefficient(SurfaceEntry& entry, const CheckedBlock& block);

/// L79: "surface-closed", "no-coefficients", "control-point-missing", "surface-not-finite",
/// "surface-inaccurate", "surface-degenerate". The finished surface when nothing is wrong.
std::shared_ptr<const surface::PolynomialSurface> check_close_surface(const SurfaceEntry& entry,
                                                                      const CheckedBlock& block,
                                                                      Reporter& reporter);

}  // namespace swarf::program

// What a program of surface blocks says (theory 1.6), after all four parsing steps: no text is left to
// interpret.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "surface/surface.h"

namespace swarf::program {

/// A surface closed by G10 L79.
struct SurfaceDefinition {
  int number = 0;  ///< P
  surface::SurfacePtr surface;
  SourceLocation where;  ///< its L70 block
};

enum class OperationKind {
  kArea,     ///< G06.3: machine the whole surface
  kIsoPass,  ///< G06.4: one pass v = const
  kFlank,    ///< G06.5: along the rulings of a ruled surface, with the side of the tool (flank/)
};

/// Where the first pass of G06.3 lies (word B).
enum class StartBoundary { kV0 = 0, kV1 = 1, kU0 = 2, kU1 = 3 };

struct Operation {
  OperationKind kind = OperationKind::kArea;
  int surface = 0;  ///< index into Program::surfaces
  StartBoundary start = StartBoundary::kV0;
  bool zigzag = false;               ///< L1
  double scallop_mm = 0.01;          ///< E
  double chord_tolerance_mm = 1e-3;  ///< K
  double feed_mm_s = 0.0;            ///< F, mm/min in the text
  double lead_rad = 0.0;             ///< I, degrees in the text; axis leans forward along the feed
  double tilt_rad = 0.0;             ///< J, degrees in the text; axis leans to the left of the feed
  double iso_v = 0.0;                ///< V of G06.4
  int tool = 0;                      ///< T loaded by M6
  double spindle_rpm = 0.0;          ///< S, 0 while the spindle stands
  SourceLocation where;
};

struct Program {
  std::string file;
  std::vector<SurfaceDefinition> surfaces;
  std::vector<Operation> operations;
  int blocks = 0;  ///< lines with at least one word
};

/// What a text is read for: a program must machine something, a design must describe a surface.
enum class Purpose { kMachining, kDesign };

/// Parses a program text. Problems go to `diagnostics`; the result is meaningful only without errors.
/// Geometric alarms of theory 1.6 that need no cutter (|Su x Sv| = 0) are raised here.
Program parse_surface_blocks(const std::string& text, const std::string& file, Diagnostics& diagnostics,
                             Purpose purpose = Purpose::kMachining);

/// Reads the file (refusing what is empty or not text) and parses it. Throws InputError.
/// `warnings`, when given, receives what was found without being an error.
Program load_program(const std::string& path, Diagnostics* warnings = nullptr);

/// A file that has G06.5 and is sound; of any other its reader says what is wrong with it.
bool mills_by_flank(const std::string& path);

/// The surfaces of a file that need not machine them: a design. Throws InputError.
std::vector<SurfaceDefinition> load_surfaces(const std::string& path);

}  // namespace swarf::program

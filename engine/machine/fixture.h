// What holds the work on the table: vice, clamps, chuck, tombstone, or a mesh. As a link of the machine it is
// drawn, exported and looked at by every check like the machine's own parts.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostics.h"
#include "machine/machine_scene.h"

namespace swarf::machine {

/// Two jaws that close along X or Y of the work, on a bed between the table and the stock's lower face.
struct Vice {
  bool along_y = false;          ///< the jaws close along Y, else along X
  double grip_mm = 5.0;          ///< how far they reach up the stock
  double jaw_width_mm = 0.0;     ///< across; 0: as wide as the stock there
  double jaw_thickness_mm = 20;  ///< along
};

/// A plate under the stock, and straps that press on its upper face.
struct Clamps {
  std::vector<std::string> sides{"x-", "x+"};  ///< of the stock, in the middle of which a strap stands
  double reach_mm = 10.0;                      ///< over the stock's upper face
  double margin_mm = 45.0;                     ///< of the plate around the stock
};

/// Three jaws around an upright round stock, on a body between the table and the stock's lower face.
struct Chuck {
  double diameter_mm = 160.0;  ///< of the body
  double grip_mm = 10.0;       ///< how far the jaws reach up the stock
  double grip_diameter_mm =
      0.0;  ///< what they close on; 0: the stock's sides in X and Y, which must be equal
};

/// An upright block on a foot, whose faces hold work; placed by its foot.
struct Tombstone {
  Vec3 size_mm{120.0, 120.0, 300.0};
  double foot_mm = 30.0;  ///< height of its foot, which is 40 mm wider on each side
};

/// Any solid, in a frame of its own.
struct FixtureSolid {
  TriMesh mesh;           ///< as read, or a box; mm
  std::string mesh_file;  ///< "": a box
  double unit_mm = 1.0;   ///< one unit of the file
};

/// Tombstone and solids stand at position and rotation; the others follow the stock.
struct Fixture {
  std::string name;
  std::variant<FixtureSolid, Vice, Clamps, Chuck, Tombstone> shape;
  /// Of the frame that position and rotation are in: true the work frame W, false the table's, with the axes
  /// of M and its origin at the machine's own [work] origin.
  bool on_part = false;
  Vec3 position_mm = Vec3::Zero();
  Vec3 rotation_rad = Vec3::Zero();  ///< about X, then Y, then Z of that frame
  std::array<float, 3> colour{0.35F, 0.37F, 0.40F};
  SourceLocation where;
};

/// The work as it is clamped.
struct HeldWork {
  Box stock_W;
  Pose X_MW = Pose::Identity();  ///< all axes at zero; turned about Z of M alone
  Vec3 table_M =
      Vec3::Zero();  ///< on the table's face, which Z of M is normal to: the machine's own [work] origin
};

/// The fixture in M with all axes at zero. Closed bodies; those of a vice, of clamps and of a chuck touch
/// each other and the stock's box. Diagnostics: "no-room-for-fixture" where the stock stands too low for what
/// is to be under it, "bad-fixture" where it does not suit the stock.
TriMesh fixture_mesh(const Fixture& fixture, const HeldWork& work, Diagnostics& diagnostics);

/// Hangs it on the link that carries the work.
void add_fixture(MachineScene& machine, const Fixture& fixture, TriMesh mesh_M);

}  // namespace swarf::machine

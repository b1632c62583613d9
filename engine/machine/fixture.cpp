#include "machine/fixture.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/plain_solids.h"

namespace swarf::machine {
namespace {

constexpr double kLeastBedMm = 5.0;        // of bed, plate or body under the stock
constexpr double kBedBeyondMm = 30.0;      // of a vice, beyond its jaws
constexpr double kStrapWidthMm = 20.0;     // of a clamp
constexpr double kStrapHeightMm = 12.0;    // of a clamp
constexpr double kStrapBehindMm = 35.0;    // of a clamp, behind the stock's face
constexpr double kChuckJawMm = 20.0;       // width
constexpr double kTombstoneFootMm = 40.0;  // beyond the block
constexpr double kRound = 1e-6;            // of the sides of a round stock, mm

/// Work and table in W, whose Z is the table's normal.
struct Place {
  Box stock;
  double table = 0.0;  ///< Z of its face
  double bed() const { return stock.lower.z() - table; }
  Vec3 foot(double x, double y) const { return {x, y, table}; }
};

Place place_of(const HeldWork& work) {
  return {work.stock_W, (work.X_MW.inverse() * work.table_M).z()};
}

bool has_room(const Place& place, const Fixture& fixture, Diagnostics& diagnostics) {
  if (place.bed() >= kLeastBedMm) return true;
  diagnostics.error(
      "no-room-for-fixture", fixture.where,
      fmt::format("the stock's lower face stands {:.3f} mm above the table, '{}' needs {:g} mm there",
                  place.bed(), fixture.name, kLeastBedMm),
      "raise the work: setup.work_origin_mm, or \"on_table\" for 100 mm");
  return false;
}

/// A box from intervals along the jaws' way, across and up.
void add_jaw(TriMesh& mesh, bool along_y, const Vec3& lower, const Vec3& upper) {
  const auto turned = [&](const Vec3& p) { return along_y ? Vec3(p.y(), p.x(), p.z()) : p; };
  mesh::add_box(mesh, {turned(lower), turned(upper)});
}

TriMesh vice(const Vice& shape, const Place& place) {
  const int along = shape.along_y ? 1 : 0, across = 1 - along;
  const Box& stock = place.stock;
  const double width = shape.jaw_width_mm > 0.0 ? shape.jaw_width_mm : stock.size()[across];
  const double left = stock.centre()[across] - 0.5 * width, right = left + width;
  const double front = stock.lower[along], back = stock.upper[along], thick = shape.jaw_thickness_mm;
  const double face = stock.lower.z(), top = face + shape.grip_mm;
  TriMesh mesh;
  add_jaw(mesh, shape.along_y, {front - thick - kBedBeyondMm, left, place.table},
          {back + thick + kBedBeyondMm, right, face});
  add_jaw(mesh, shape.along_y, {front - thick, left, face}, {front, right, top});
  add_jaw(mesh, shape.along_y, {back, left, face}, {back + thick, right, top});
  return mesh;
}

/// One strap with the post that it rests on, seen from the stock's face: `out` away from it.
void add_strap(TriMesh& mesh, const Place& place, const std::string& side, double reach) {
  const int along = side[0] == 'x' ? 0 : 1, across = 1 - along;
  const double out = side[1] == '-' ? -1.0 : 1.0;
  const Box& stock = place.stock;
  const double face = out < 0.0 ? stock.lower[along] : stock.upper[along];
  const double low = stock.lower.z(), top = stock.upper.z(), middle = stock.centre()[across];
  const auto piece = [&](double from, double to, double half, double bottom, double height) {
    Box box;
    box.lower[along] = face + std::min(out * from, out * to);
    box.upper[along] = face + std::max(out * from, out * to);
    box.lower[across] = middle - half;
    box.upper[across] = middle + half;
    box.lower.z() = bottom;
    box.upper.z() = height;
    mesh::add_box(mesh, box);
  };
  piece(-reach, kStrapBehindMm, 0.5 * kStrapWidthMm, top, top + kStrapHeightMm);
  piece(0.6 * kStrapBehindMm, kStrapBehindMm, 0.4 * kStrapWidthMm, low, top);
}

TriMesh clamps(const Clamps& shape, const Place& place) {
  const Vec3 margin(shape.margin_mm, shape.margin_mm, 0.0);
  Box plate{place.stock.lower - margin, place.stock.upper + margin};
  plate.lower.z() = place.table;
  plate.upper.z() = place.stock.lower.z();
  TriMesh mesh;
  mesh::add_box(mesh, plate);
  for (const std::string& side : shape.sides) add_strap(mesh, place, side, shape.reach_mm);
  return mesh;
}

/// 0 where it does not fit, with the reason.
double gripped_diameter(const Chuck& shape, const Place& place, const Fixture& fixture,
                        Diagnostics& diagnostics) {
  const Vec3 size = place.stock.size();
  double diameter = shape.grip_diameter_mm;
  if (diameter == 0.0 && std::abs(size.x() - size.y()) <= kRound) diameter = size.x();
  if (diameter == 0.0) {
    diagnostics.error("bad-fixture", fixture.where,
                      fmt::format("'{}' closes on a round stock, this one is {:g} x {:g} mm", fixture.name,
                                  size.x(), size.y()),
                      "say what the jaws close on: grip_diameter_mm; or take kind = \"vice\"");
  } else if (diameter >= shape.diameter_mm) {
    diagnostics.error("bad-fixture", fixture.where,
                      fmt::format("'{}' has a body of D {:g} mm and is to grip D {:g} mm", fixture.name,
                                  shape.diameter_mm, diameter),
                      "its body must be wider: diameter_mm");
    diameter = 0.0;
  }
  return diameter;
}

TriMesh chuck(const Chuck& shape, const Place& place, double grip) {
  const Vec3 centre = place.stock.centre();
  const double face = place.stock.lower.z();
  TriMesh mesh;
  mesh::add_tube(mesh, place.foot(centre.x(), centre.y()), Vec3::UnitZ(), 0.5 * shape.diameter_mm, 0.0,
                 place.bed());
  for (int jaw = 0; jaw < 3; ++jaw) {
    TriMesh box;
    mesh::add_box(box, {{0.5 * grip, -0.5 * kChuckJawMm, face},
                        {0.5 * shape.diameter_mm, 0.5 * kChuckJawMm, face + shape.grip_mm}});
    Pose turned(Eigen::AngleAxisd(2.0 * std::numbers::pi / 3.0 * jaw, Vec3::UnitZ()));
    turned.translation() = Vec3(centre.x(), centre.y(), 0.0);
    mesh::append(mesh, mesh::moved(std::move(box), turned));
  }
  return mesh;
}

TriMesh tombstone(const Tombstone& shape) {
  const Vec3 half(0.5 * shape.size_mm.x(), 0.5 * shape.size_mm.y(), 0.0),
      wide(kTombstoneFootMm, kTombstoneFootMm, 0.0);
  const Vec3 up(0.0, 0.0, shape.foot_mm);
  TriMesh mesh;
  mesh::add_box(mesh, {-half - wide, half + wide + up});
  mesh::add_box(mesh, {up - half, half + Vec3(0.0, 0.0, shape.size_mm.z())});
  return mesh;
}

/// Position and rotation, in M.
Pose standing(const Fixture& fixture, const HeldWork& work) {
  Pose frame = fixture.on_part ? work.X_MW : Pose::Identity();
  if (!fixture.on_part) frame.translation() = work.table_M;
  Pose own(Eigen::AngleAxisd(fixture.rotation_rad.z(), Vec3::UnitZ()) *
           Eigen::AngleAxisd(fixture.rotation_rad.y(), Vec3::UnitY()) *
           Eigen::AngleAxisd(fixture.rotation_rad.x(), Vec3::UnitX()));
  own.translation() = fixture.position_mm;
  return frame * own;
}

template <typename... Calls>
struct Overloaded : Calls... {
  using Calls::operator()...;
};
template <typename... Calls>
Overloaded(Calls...) -> Overloaded<Calls...>;

}  // namespace

TriMesh fixture_mesh(const Fixture& fixture, const HeldWork& work, Diagnostics& diagnostics) {
  const Place place = place_of(work);
  const auto follows_stock = [&](auto make) {
    return has_room(place, fixture, diagnostics) ? mesh::moved(make(), work.X_MW) : TriMesh{};
  };
  return std::visit(
      Overloaded{
          [&](const FixtureSolid& shape) { return mesh::moved(shape.mesh, standing(fixture, work)); },
          [&](const Tombstone& shape) { return mesh::moved(tombstone(shape), standing(fixture, work)); },
          [&](const Vice& shape) { return follows_stock([&] { return vice(shape, place); }); },
          [&](const Clamps& shape) { return follows_stock([&] { return clamps(shape, place); }); },
          [&](const Chuck& shape) {
            const double grip = gripped_diameter(shape, place, fixture, diagnostics);
            return grip == 0.0 ? TriMesh{} : follows_stock([&] { return chuck(shape, place, grip); });
          }},
      fixture.shape);
}

void add_fixture(MachineScene& machine, const Fixture& fixture, TriMesh mesh_M) {
  Link link;
  link.name = fixture.name;
  link.parent = machine.work_link;
  link.mesh = std::move(mesh_M);
  link.colour = fixture.colour;
  link.metalness = 0.5F;
  link.roughness = 0.5F;
  link.fixture = true;
  machine.links.push_back(std::move(link));
}

}  // namespace swarf::machine

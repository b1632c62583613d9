#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/units.h"
#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

/// Elements of rotation matrices are written with five digits or more.
constexpr double kRotationTolerance = 1e-4;

/// A rigid motion from three rows of four numbers; none when the left part is no rotation. The nearest
/// rotation to rounded numbers is taken.
std::optional<Pose> pose_from_rows(const std::array<double, 12>& rows, double unit_mm) {
  Mat3 R;
  Vec3 t;
  for (int row = 0; row < 3; ++row) {
    const auto first = static_cast<size_t>(4 * row);
    for (int column = 0; column < 3; ++column) R(row, column) = rows[first + static_cast<size_t>(column)];
    t[row] = unit_mm * rows[first + 3];
  }
  if (!((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() <= kRotationTolerance) ||
      R.determinant() < 0.0)
    return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear().col(0) = R.col(0).normalized();
  pose.linear().col(2) = R.col(0).cross(R.col(1)).normalized();
  pose.linear().col(1) = pose.linear().col(2).cross(pose.linear().col(0));
  pose.translation() = t;
  return pose;
}

/// Four numbers with blanks or commas between.
bool read_row(std::string_view text, double* row) {
  int count = 0;
  while (true) {
    const size_t first = text.find_first_not_of(" \t,\r");
    if (first == std::string_view::npos) return count == 4;
    if (count == 4) return false;
    text.remove_prefix(first + (text[first] == '+' ? 1 : 0));
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), row[count++]);
    if (failure != std::errc() || !std::isfinite(row[count - 1])) return false;
    text.remove_prefix(static_cast<size_t>(end - text.data()));
  }
}

bool may_change_system(Reporter& reporter, ClDrilling& drilling, ClCutcom& compensation,
                       const ClStatement& s) {
  if (!drilling.cycle) return not_compensated(reporter, compensation, s);
  fault(reporter, "bad-cycle", s, "the coordinate system changes inside of a cycle",
        "write CYCLE/OFF before it");
  return false;
}

void set_system(ClSystems& systems, const Pose& X_SC) {
  systems.X_SC = X_SC;
  systems.X_WC = X_SC * systems.tracut.value_or(Pose::Identity());
  systems.X_WC.translation() += systems.translation.value_or(Vec3::Zero()) - systems.origin;
}

/// A system of twelve numbers: the first is the one that positions are given in, another one is refused.
void keep_one_system(ClState& cl, const ClStatement& s, const char* word, const char* writer) {
  if (!may_change_system(cl.reporter, cl.drilling, cl.compensation, s)) return;
  if (!numbers(cl.reporter, s, 12, 12, "CSYS/ three rows of a rotation, each with its part of the origin"))
    return;
  std::array<double, 12> rows{};
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = s.arguments[i].value;
  if (!pose_from_rows(rows, cl.systems.unit_mm)) {
    fault(cl.reporter, "bad-system", s, "CSYS holds no rotation",
          "its columns must be unit vectors at right angles");
    return;
  }
  constexpr double kSame = 1e-9;
  const bool same =
      !cl.systems.creo_system || std::equal(rows.begin(), rows.end(), cl.systems.creo_system->begin(),
                                            [](double a, double b) { return std::abs(a - b) <= kSame; });
  if (!same) {
    fault(
        cl.reporter, "unsupported-word", s,
        fmt::format("the coordinate system of {} changes inside of the file, and nothing documents which way "
                    "its {} maps",
                    writer, word),
        "write one file for each set-up or coordinate system, or output the path of all operations in one");
    return;
  }
  if (!cl.systems.creo_system && pose_from_rows(rows, 1.0)->matrix() != Pose::Identity().matrix())
    remark(cl.program,
           fmt::format("{}: positions are taken as written, in the coordinate system of {}", word, writer));
  cl.systems.creo_system = rows;
}

// --- TRACUT

constexpr const char* kTracutForm =
    "write TRACUT/ three rows of a rotation, each with its part of the shift, or TRACUT/NOMORE";

/// X' = a11 X + a12 Y + a13 Z + a14 and so on, as APT writes a matrix.
using TracutRows = std::array<double, 12>;

bool read_rows(Reporter& reporter, const ClStatement& s, TracutRows& rows) {
  const auto word =
      std::find_if(s.arguments.begin(), s.arguments.end(), [](const ClArgument& one) { return !one.number; });
  if (word != s.arguments.end()) {
    fault(reporter, "wrong-arguments", *word, fmt::format("TRACUT with '{}' is not followed", word->text),
          kTracutForm);
    return false;
  }
  const size_t count = s.arguments.size();
  if (count != rows.size()) {
    fault(reporter, "wrong-arguments", s, fmt::format("TRACUT has {} numbers, and not 12", count),
          kTracutForm);
    return false;
  }
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = s.arguments[i].value;
  return true;
}

double determinant(const TracutRows& rows) {
  Mat3 linear;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      linear(row, column) = rows[static_cast<size_t>(4 * row + column)];
  }
  return linear.determinant();
}

/// A tool cuts the mirrored part with the other sense of cutting, and a scaled path is no path of its cutter.
void refuse_deformed(Reporter& reporter, const ClStatement& s, const TracutRows& rows) {
  const double d = determinant(rows);
  fault(reporter, "bad-tracut", s,
        fmt::format("the matrix of TRACUT is no rotation (determinant {:.6g}): it {} what it is applied to",
                    d, d < 0.0 ? "mirrors" : "scales or skews"),
        d < 0.0
            ? "write the file with the mirrored positions as they are cut: the cutter's side changes too"
            : "write the file with the positions as they are cut, or a matrix whose left three columns are "
              "unit vectors at right angles");
}

bool may_turn(ClState& cl, const ClStatement& s) {
  if (!may_change_system(cl.reporter, cl.drilling, cl.compensation, s)) return false;
  if (!cl.arcs.circle) return true;
  fault(cl.reporter, "bad-arc", s, "TRACUT stands between CIRCLE and the end of its arc",
        "write it before CIRCLE, or behind the GOTO that ends the arc");
  return false;
}

/// What was given in the coordinates before does not hold behind it.
void turn(ClState& cl, const std::optional<Pose>& X_CP) {
  const Mat3 before = cl.systems.X_WC.linear();
  cl.systems.tracut = X_CP;
  set_system(cl.systems, cl.systems.X_SC);
  cl.path.turned = cl.path.positioned;
  cl.arcs.direction_W.reset();
  cl.arcs.part_surface.reset();
  const Vec3 file_axis = before.transpose() * cl.path.axis_W;
  if ((cl.systems.X_WC.linear() * file_axis - cl.path.axis_W).norm() > kAxisStands)
    cl.path.axis_known = false;
}

void apply(ClState& cl, const ClStatement& s, const TracutRows& rows) {
  if (!may_turn(cl, s)) return;
  if (cl.systems.tracut) {
    fault(cl.reporter, "bad-tracut", s,
          "TRACUT stands within another one: some processors multiply the two, some put it in the other's "
          "place",
          "write TRACUT/NOMORE before it, and the product of both where both are meant");
    return;
  }
  const std::optional<Pose> X_CP = pose_from_rows(rows, cl.systems.unit_mm);
  if (!X_CP) return refuse_deformed(cl.reporter, s, rows);
  turn(cl, X_CP);
  remark(cl.program,
         "TRACUT: the positions behind it are turned and shifted by its matrix, until TRACUT/NOMORE");
}

}  // namespace

void system(ClState& cl, const ClStatement& s) {
  if (!may_change_system(cl.reporter, cl.drilling, cl.compensation, s)) return;
  if (!numbers(cl.reporter, s, 9, 9, "MSYS/ox,oy,oz, xi,xj,xk, yi,yj,yk (origin, unit X axis, unit Y axis)"))
    return;
  Vec3 x, y;
  if (!unit_vector(cl.reporter, s, 3, "X axis of the system", x) ||
      !unit_vector(cl.reporter, s, 6, "Y axis of the system", y))
    return;
  if (std::abs(x.dot(y)) > kAxisLengthTolerance) {
    fault(cl.reporter, "out-of-range", s.arguments[6],
          fmt::format("the axes of the system stand at {:.6g} deg to each other",
                      deg_from_rad(std::acos(std::clamp(x.dot(y), -1.0, 1.0)))),
          "give two axes at right angles");
    return;
  }
  Pose X_SC = Pose::Identity();
  X_SC.linear().col(0) = x;
  X_SC.linear().col(2) = x.cross(y).normalized();
  X_SC.linear().col(1) = X_SC.linear().col(2).cross(x);
  X_SC.translation() = point_at(cl.systems, s, 0);
  set_system(cl.systems, X_SC);
}

/// Three axes of the system and its origin, as the CAMplete output of Autodesk's systems has them.
void matrix_system(ClState& cl, const ClStatement& s) {
  if (!may_change_system(cl.reporter, cl.drilling, cl.compensation, s)) return;
  if (!numbers(cl.reporter, s, 12, 12, "MCS/xi,xj,xk, yi,yj,yk, zi,zj,zk, ox,oy,oz (unit axes, origin)"))
    return;
  std::array<double, 12> rows{};
  for (size_t column = 0; column < 4; ++column) {
    for (size_t row = 0; row < 3; ++row) rows[4 * row + column] = s.arguments[3 * column + row].value;
  }
  const std::optional<Pose> X_SC = pose_from_rows(rows, cl.systems.unit_mm);
  if (!X_SC) {
    fault(cl.reporter, "bad-system", s, "MCS holds no rotation",
          "its axes must be unit vectors at right angles");
    return;
  }
  set_system(cl.systems, *X_SC);
}

void work_system(ClState& cl, const ClStatement& s) {
  if (s.arguments.size() != 12) return system(cl, s);
  keep_one_system(cl, s, "CSYS", "SolidWorks CAM");
}

/// It names the kind of the system that follows; positions are those of that system in any case.
void transformation(ClState& cl, const ClStatement& s) {
  mark(cl.reporter, cl.program, ClWriter::kCamWorks, "TRNTYP", s);
  note(cl, s);
}

void creo_system(ClState& cl, const ClStatement& s) {
  mark(cl.reporter, cl.program, ClWriter::kCreo, s.word, s);
  keep_one_system(cl, s, "$$-> CSYS", "Creo");
}

void catia_system(ClState& cl, const ClStatement& s) {
  // $$*CATIA0, the name of the system, then three rows of the matrix.
  if (cl.systems.catia_lines == 4) {
    --cl.systems.catia_lines;
    return;
  }
  const auto row = static_cast<size_t>(3 - cl.systems.catia_lines);
  --cl.systems.catia_lines;
  if (!read_row(s.text, cl.systems.catia.data() + 4 * row)) {
    fault(cl.reporter, "bad-system", s, fmt::format("row {} of $$*CATIA0 has no four numbers", row + 1),
          "give the name of the system, then three rows of four numbers, each behind $$");
    cl.systems.catia_lines = 0;
    return;
  }
  if (cl.systems.catia_lines > 0 || !may_change_system(cl.reporter, cl.drilling, cl.compensation, s)) return;
  const std::optional<Pose> X_part = pose_from_rows(cl.systems.catia, cl.systems.unit_mm);
  if (!X_part) {
    fault(cl.reporter, "bad-system", s, "$$*CATIA0 holds no rotation",
          "its columns must be unit vectors at right angles");
    return;
  }
  if (!cl.systems.first_catia) {
    cl.systems.first_catia = X_part;
    if (X_part->matrix() != Pose::Identity().matrix())
      remark(cl.program, "$$*CATIA0: positions are in its machining axis system, which is the work frame");
    return;
  }
  set_system(cl.systems, cl.systems.first_catia->inverse() * *X_part);
  if (!cl.path.multi_axis) cl.path.axis_W = cl.systems.X_WC.linear().col(2);
}

void origin(ClState& cl, const ClStatement& s) {
  if (!may_change_system(cl.reporter, cl.drilling, cl.compensation, s) ||
      !numbers(cl.reporter, s, 3, 3, "ORIGIN/x,y,z: the machine's zero in the part"))
    return;
  const Vec3 given = point_at(cl.systems, s, 0);
  if (cl.program.writer == ClWriter::kCatia && given != Vec3::Zero()) {
    fault(cl.reporter, "unsupported-word", s,
          "CATIA writes with ORIGIN where the axes of its program lie in the part, ISO 4343 where the "
          "machine's zero lies in the program",
          "take it out: $$*CATIA0 says where the axes lie, and setup.work_origin_mm of the scene where the "
          "part "
          "is clamped");
    return;
  }
  cl.systems.origin = given;
  set_system(cl.systems, cl.systems.X_SC);
  remark(cl.program, fmt::format("ORIGIN: ({:g}, {:g}, {:g}) mm are subtracted from the positions behind it",
                                 given.x(), given.y(), given.z()));
}

void translation(ClState& cl, const ClStatement& s) {
  if (!may_change_system(cl.reporter, cl.drilling, cl.compensation, s) ||
      !numbers(cl.reporter, s, 3, 3, "TRANS/x,y,z"))
    return;
  const Vec3 given = point_at(cl.systems, s, 0);
  if (cl.systems.translation && *cl.systems.translation != given) {
    fault(cl.reporter, "unsupported-word", s,
          "TRANS stands for the second time: some post-processors add it to the first, some put it in its "
          "place",
          "write one TRANS in a file, or the positions with it");
    return;
  }
  cl.systems.translation = given;
  set_system(cl.systems, cl.systems.X_SC);
  remark(cl.program, fmt::format("TRANS: ({:g}, {:g}, {:g}) mm are added to the positions behind it",
                                 given.x(), given.y(), given.z()));
}

void transformed_cut(ClState& cl, const ClStatement& s) {
  if (fits(s, "NOMORE") || fits(s, "LAST NOMORE")) {
    if (!cl.systems.tracut) return note(cl, s);
    if (may_turn(cl, s)) turn(cl, std::nullopt);
    return;
  }
  ClStatement matrix = s;
  const bool last = !s.arguments.empty() && s.arguments[0].text == "LAST";
  if (last) matrix.arguments.erase(matrix.arguments.begin());
  TracutRows rows{};
  if (!read_rows(cl.reporter, matrix, rows)) return;
  constexpr TracutRows kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  if (rows == kIdentity && !cl.systems.tracut) return note(cl, s);
  if (!cl.options.tracut) {
    fault(
        cl.reporter, "tracut-meaning", s,
        "TRACUT gives a matrix, and whether the positions behind it have been turned by it already depends "
        "on the system that wrote the file",
        "write [setup] tracut = \"apply\" (the matrix still has to turn them) or tracut = \"applied\" (they "
        "are as they are cut) in the scene, or give --tracut");
    return;
  }
  if (*cl.options.tracut == ClTracut::kApplied) {
    remark(cl.program, "TRACUT: the positions behind it are taken as written, turned by its matrix already");
    return;
  }
  if (last) {
    fault(cl.reporter, "bad-tracut", s.arguments[0],
          "TRACUT/LAST orders the matrix among those of COPY, which is not followed",
          "write TRACUT with the matrix alone");
    return;
  }
  apply(cl, s, rows);
}

}  // namespace swarf::program::cldata

#include "program/cl/nurbs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

/// The curve starts where the tool stands, and ends at the last point of its list, within this, mm: what six
/// significant digits of a position leave.
constexpr double kJoinMm = 5e-3;

void nurbs_sizes(Reporter& reporter, std::optional<ClNurbs>& nurbs, const ClStatement& s) {
  bool whole = s.arguments.size() >= 5;
  for (size_t i = 1; whole && i < 5; ++i) {
    const ClArgument& a = s.arguments[i];
    whole = a.number && a.value >= 0.0 && a.value <= 1e6 && a.value == std::floor(a.value);
  }
  if (!whole) {
    fault(reporter, "wrong-arguments", s, "MOVNRB/ON needs four whole numbers",
          "write MOVNRB/ON,order,knots,0,points,length");
    return;
  }
  if (s.arguments[3].value != 0.0) {
    fault(reporter, "unsupported-word", s.arguments[3],
          "this curve has weights, whose statements Creo does not document",
          "write it without: the third number of MOVNRB/ON is always 0 (OUTPUT_3DNURBS)");
    return;
  }
  nurbs->order = static_cast<int>(s.arguments[1].value);
  nurbs->knots_wanted = static_cast<size_t>(s.arguments[2].value);
  nurbs->points_wanted = static_cast<size_t>(s.arguments[4].value);
}

void nurbs_values(Reporter& reporter, ClSystems& systems, std::optional<ClNurbs>& nurbs,
                  const ClStatement& s) {
  for (const ClArgument& a : s.arguments) {
    if (a.number && std::isfinite(a.value)) continue;
    fault(reporter, "wrong-arguments", a, fmt::format("'{}' is no number", a.text),
          "write MOVNRB/1, /2 or /3 and numbers");
    return;
  }
  const double kind = s.arguments.empty() ? 0.0 : s.arguments[0].value;
  if (kind == 1.0) {
    for (size_t i = 1; i < s.arguments.size(); ++i) nurbs->knots.push_back(s.arguments[i].value);
  } else if ((kind == 2.0 || (kind == 3.0 && nurbs->five_axis)) && s.arguments.size() % 3 == 1) {
    std::vector<Vec3>& points = kind == 2.0 ? nurbs->low_W : nurbs->high_W;
    for (size_t i = 1; i < s.arguments.size(); i += 3)
      points.push_back(systems.X_WC * point_at(systems, s, i));
  } else {
    fault(reporter, "wrong-arguments", s, "MOVNRB has no such values",
          "1: knots, 2: control points x,y,z of the tip, 3: those of the upper curve (five axes)");
  }
}

/// MOVNRB/NEXT: the curve is whole; its moves.
void follow_nurbs(ClState& cl, const ClStatement& s) {
  ClNurbs& n = *cl.nurbs;
  const auto bad = [&](const std::string& text, const std::string& fix) {
    fault(cl.reporter, "bad-nurbs", s, text, fix);
    n.listing = true;
  };
  const size_t upper = n.five_axis ? n.points_wanted : 0;
  if (n.order == 0 || n.knots.size() != n.knots_wanted || n.low_W.size() != n.points_wanted ||
      n.high_W.size() != upper) {
    return bad(
        fmt::format("{} knots, {} points and {} upper points stand here, MOVNRB/ON announced {}, {} and {}",
                    n.knots.size(), n.low_W.size(), n.high_W.size(), n.knots_wanted, n.points_wanted, upper),
        "give as many as MOVNRB/ON says");
  }
  if (n.five_axis && std::abs((n.high_W.front() - n.low_W.front()).norm() - n.length_mm) > kJoinMm)
    return bad(fmt::format("the upper curve begins {:.4f} mm from the lower one, LENGTH says {:g} mm",
                           (n.high_W.front() - n.low_W.front()).norm(), n.length_mm),
               "both must agree");
  if (!n.five_axis && !axis_stands(cl.reporter, cl.path, s)) {
    n.listing = true;
    return;
  }
  std::vector<ToolPose> poses;
  try {
    poses = nurbs_poses(n, cl.path.axis_W);
  } catch (const std::invalid_argument& error) {
    return bad(error.what(), "mend the curve");
  }
  if (!cl.path.positioned) start_at(cl.program, cl.path, s, poses.front());
  if ((poses.front().tip_W - cl.path.pose.tip_W).norm() > kJoinMm)
    return bad(fmt::format("the curve begins {:.4f} mm from where the tool stands",
                           (poses.front().tip_W - cl.path.pose.tip_W).norm()),
               "move to its first control point before it");
  for (size_t i = 1; i < poses.size(); ++i) move_to(cl, s, poses[i]);
  n.listing = true;
  n.end = poses.back();
}

}  // namespace

void nurbs(ClState& cl, const ClStatement& s) {
  const auto word = [&](size_t i) { return i < s.arguments.size() ? s.arguments[i].text : std::string(); };
  const bool three = word(0) == "M3AXIS" || word(0) == "3AXIS",
             five = word(0) == "M5AXIS" || word(0) == "5AXIS";
  if (three || five) {
    cl.nurbs = ClNurbs{};
    cl.nurbs->five_axis = five;
    cl.nurbs->line = s.line;
    cl.nurbs->column = s.column;
    if (five && (s.arguments.size() != 3 || word(1) != "LENGTH" || !s.arguments[2].number))
      fault(cl.reporter, "wrong-arguments", s, "five axes need the length to the upper curve",
            "write MOVNRB/5AXIS,LENGTH,50");
    else if (five)
      cl.nurbs->length_mm = cl.systems.mm(s.arguments[2].value);
  } else if (!cl.nurbs) {
    fault(cl.reporter, "no-nurbs", s, "MOVNRB stands outside of a curve",
          "begin it with MOVNRB/3AXIS or MOVNRB/5AXIS,LENGTH,50");
  } else if (word(0) == "ON") {
    nurbs_sizes(cl.reporter, cl.nurbs, s);
  } else if (word(0) == "NEXT") {
    follow_nurbs(cl, s);
  } else if (word(0) == "OFF") {
    if (!cl.nurbs->listing)
      fault(cl.reporter, "bad-nurbs", s, "the curve ends without MOVNRB/NEXT",
            "write MOVNRB/NEXT before its points");
    else if (!cl.nurbs->ends_there)
      fault(cl.reporter, "bad-nurbs", s, "the last point of the list is not where the curve ends",
            fmt::format("both must agree within {:g} mm", kJoinMm));
    cl.nurbs.reset();
  } else {
    nurbs_values(cl.reporter, cl.systems, cl.nurbs, s);
  }
}

bool inside_nurbs(ClState& cl, const ClStatement& s) {
  if (s.word == "MOVNRB" || s.word == "PPRINT" || s.word == "INSERT" || s.word == "PAINT") return false;
  if (cl.nurbs->listing && s.word == "GOTO") {
    ToolPose at;
    if (pose_of(cl.reporter, cl.systems, cl.path, s, at))
      cl.nurbs->ends_there = (at.tip_W - cl.nurbs->end.tip_W).norm() <= kJoinMm;
    return true;
  }
  fault(cl.reporter, "bad-nurbs", s, fmt::format("{} stands inside of a MOVNRB curve", s.word),
        "end the curve with MOVNRB/OFF before it; a feed that changes within one is not followed");
  return true;
}

}  // namespace swarf::program::cldata

#include "program/cl/nurbs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "program/cl/interpreter.h"
#include "program/control/curve.h"

namespace swarf::program {
namespace {

/// The curve starts where the tool stands, and ends at the last point of its list, within this, mm: what six
/// significant digits of a position leave.
constexpr double kJoinMm = 5e-3;

nc::NurbsCurve curve_of(const ClNurbs& nurbs, const std::vector<Vec3>& points) {
  std::vector<nc::CurvePoint> control(points.size());
  std::transform(points.begin(), points.end(), control.begin(), [](const Vec3& point) {
    return nc::CurvePoint{point, std::nullopt, {}};
  });
  return {nurbs.order, std::move(control), std::vector<double>(points.size(), 1.0), nurbs.knots};
}

}  // namespace

std::vector<ToolPose> nurbs_poses(const ClNurbs& nurbs, const Vec3& axis_W) {
  const nc::NurbsCurve low = curve_of(nurbs, nurbs.low_W);
  std::vector<double> at = nc::chord_ends(low, kNurbsChordMm);
  at.insert(at.begin(), 0.0);
  if (!nurbs.five_axis) {
    std::vector<ToolPose> poses;
    for (const double u : at) poses.push_back({low.at(u).tip, axis_W});
    return poses;
  }
  const nc::NurbsCurve high = curve_of(nurbs, nurbs.high_W);
  const std::vector<double> of_high = nc::chord_ends(high, kNurbsChordMm);
  at.insert(at.end(), of_high.begin(), of_high.end());
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  std::vector<ToolPose> poses;
  for (const double u : at) {
    const Vec3 tip = low.at(u).tip, axis = high.at(u).tip - tip;
    if (!(axis.norm() > 1e-6)) throw std::invalid_argument("the upper curve meets the lower one");
    poses.push_back({tip, axis.normalized()});
  }
  return poses;
}

void ClInterpreter::nurbs(const ClStatement& s) {
  const auto word = [&](size_t i) { return i < s.arguments.size() ? s.arguments[i].text : std::string(); };
  const bool three = word(0) == "M3AXIS" || word(0) == "3AXIS",
             five = word(0) == "M5AXIS" || word(0) == "5AXIS";
  if (three || five) {
    nurbs_ = ClNurbs{};
    nurbs_->five_axis = five;
    nurbs_->line = s.line;
    nurbs_->column = s.column;
    if (five && (s.arguments.size() != 3 || word(1) != "LENGTH" || !s.arguments[2].number))
      fault("wrong-arguments", s, "five axes need the length to the upper curve",
            "write MOVNRB/5AXIS,LENGTH,50");
    else if (five)
      nurbs_->length_mm = mm(s.arguments[2].value);
  } else if (!nurbs_) {
    fault("no-nurbs", s, "MOVNRB stands outside of a curve",
          "begin it with MOVNRB/3AXIS or MOVNRB/5AXIS,LENGTH,50");
  } else if (word(0) == "ON") {
    nurbs_sizes(s);
  } else if (word(0) == "NEXT") {
    follow_nurbs(s);
  } else if (word(0) == "OFF") {
    if (!nurbs_->listing)
      fault("bad-nurbs", s, "the curve ends without MOVNRB/NEXT", "write MOVNRB/NEXT before its points");
    else if (!nurbs_->ends_there)
      fault("bad-nurbs", s, "the last point of the list is not where the curve ends",
            fmt::format("both must agree within {:g} mm", kJoinMm));
    nurbs_.reset();
  } else {
    nurbs_values(s);
  }
}

void ClInterpreter::nurbs_sizes(const ClStatement& s) {
  bool whole = s.arguments.size() >= 5;
  for (size_t i = 1; whole && i < 5; ++i) {
    const ClArgument& a = s.arguments[i];
    whole = a.number && a.value >= 0.0 && a.value <= 1e6 && a.value == std::floor(a.value);
  }
  if (!whole) {
    fault("wrong-arguments", s, "MOVNRB/ON needs four whole numbers",
          "write MOVNRB/ON,order,knots,0,points,length");
    return;
  }
  if (s.arguments[3].value != 0.0) {
    fault("unsupported-word", s.arguments[3],
          "this curve has weights, whose statements Creo does not document",
          "write it without: the third number of MOVNRB/ON is always 0 (OUTPUT_3DNURBS)");
    return;
  }
  nurbs_->order = static_cast<int>(s.arguments[1].value);
  nurbs_->knots_wanted = static_cast<size_t>(s.arguments[2].value);
  nurbs_->points_wanted = static_cast<size_t>(s.arguments[4].value);
}

void ClInterpreter::nurbs_values(const ClStatement& s) {
  for (const ClArgument& a : s.arguments) {
    if (a.number && std::isfinite(a.value)) continue;
    fault("wrong-arguments", a, fmt::format("'{}' is no number", a.text),
          "write MOVNRB/1, /2 or /3 and numbers");
    return;
  }
  const double kind = s.arguments.empty() ? 0.0 : s.arguments[0].value;
  if (kind == 1.0) {
    for (size_t i = 1; i < s.arguments.size(); ++i) nurbs_->knots.push_back(s.arguments[i].value);
  } else if ((kind == 2.0 || (kind == 3.0 && nurbs_->five_axis)) && s.arguments.size() % 3 == 1) {
    std::vector<Vec3>& points = kind == 2.0 ? nurbs_->low_W : nurbs_->high_W;
    for (size_t i = 1; i < s.arguments.size(); i += 3) points.push_back(X_WC_ * point_at(s, i));
  } else {
    fault("wrong-arguments", s, "MOVNRB has no such values",
          "1: knots, 2: control points x,y,z of the tip, 3: those of the upper curve (five axes)");
  }
}

void ClInterpreter::follow_nurbs(const ClStatement& s) {
  ClNurbs& n = *nurbs_;
  const auto bad = [&](const std::string& text, const std::string& fix) {
    fault("bad-nurbs", s, text, fix);
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
  std::vector<ToolPose> poses;
  try {
    poses = nurbs_poses(n, axis_W_);
  } catch (const std::invalid_argument& error) {
    return bad(error.what(), "mend the curve");
  }
  if (!positioned_) start_at(s, poses.front());
  if ((poses.front().tip_W - pose_.tip_W).norm() > kJoinMm)
    return bad(fmt::format("the curve begins {:.4f} mm from where the tool stands",
                           (poses.front().tip_W - pose_.tip_W).norm()),
               "move to its first control point before it");
  for (size_t i = 1; i < poses.size(); ++i) move_to(s, poses[i]);
  n.listing = true;
  n.end = poses.back();
}

bool ClInterpreter::inside_nurbs(const ClStatement& s) {
  if (s.word == "MOVNRB" || s.word == "PPRINT" || s.word == "INSERT" || s.word == "PAINT") return false;
  if (nurbs_->listing && s.word == "GOTO") {
    ToolPose at;
    if (pose_of(s, at)) nurbs_->ends_there = (at.tip_W - nurbs_->end.tip_W).norm() <= kJoinMm;
    return true;
  }
  fault("bad-nurbs", s, fmt::format("{} stands inside of a MOVNRB curve", s.word),
        "end the curve with MOVNRB/OFF before it; a feed that changes within one is not followed");
  return true;
}

}  // namespace swarf::program

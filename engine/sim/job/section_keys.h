// A plane that opens what is drawn: of a shot of the movie and of a still.
#pragma once

#include <optional>
#include <string>

#include "base/config.h"
#include "base/frames.h"

namespace swarf::sim {

/// What lies where the normal points to is taken away; work frame.
struct SectionPlane {
  Vec3 point_W = Vec3::Zero();    ///< mm
  Vec3 normal_W = Vec3::UnitX();  ///< unit
};

/// "x=12.5", "y=-3", "z=0", mm: taken away is what stands before the usual view of it (right, front, top). Or
/// "x,y,z,nx,ny,nz": a point of the plane and its normal. None: it is neither.
std::optional<SectionPlane> section_named(const std::string& text);
/// How section_named() takes it, in one line.
std::string section_forms();

/// `section`, as section_named() takes it, or `section_mm`, [[x, y, z], [nx, ny, nz]]; neither: none. Errors
/// "bad-section", "two-sections".
std::optional<SectionPlane> read_section(ConfigTable& table);

/// "x = 12.5 mm", or point and normal.
std::string section_words(const SectionPlane& plane);

/// Throws InputError "section-misses" at `where` unless some of the stock lies on either side.
void require_section(const SectionPlane& plane, const SourceLocation& where, const Box& stock_W);

/// Some of the box lies on either side.
bool divides(const SectionPlane& plane, const Box& box);
/// Where along the plane's normal the box begins and ends, for messages: "x from 0 to 40 mm".
std::string extent_along(const SectionPlane& plane, const Box& box);

}  // namespace swarf::sim

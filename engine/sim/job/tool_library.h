// Tool libraries that CAM systems export, as tools of a job.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "cutter/cutter.h"

namespace swarf::sim {

/// True for the endings that read_tool_library knows: .json (Fusion 360 and HSM), .fctl and .fctb (FreeCAD),
/// .p21 (ISO 13399).
bool is_tool_library(const std::string& path);

/// The tools of a library with their numbers, in its order.
///
///   .json   Fusion's export: {"data": [{"type", "unit", "geometry": {"DC", "RE", "LCF", "LB", "SFDM", "SIG",
///           "TA"}, "holder": {"segments"}, "post-process": {"number"}}]}; LB is what stands out of the
///           holder
///   .fctl   FreeCAD's library: {"tools": [{"nr", "path"}]}; the bits lie beside it or in ../Bit
///   .fctb   one bit: number 1; {"shape": "endmill.fcstd", "parameter": {"Diameter": "5.00 mm", ...}}
///   .p21    ISO 13399 in ISO 10303-21: the items that have a cutting diameter, numbered 1, 2 .. in the
///   file's
///           order (it knows no places in a magazine), their ids as names. Properties by their symbols: DC;
///           SIG (a drill's point) or RE; LPR, LF or OAL; APMX, LCF or LU; DCONMS or DMM, BDX. Properties
///           that have a dictionary code alone are not known
///
/// A library has many tools, and a program calls a few: what a tool lacks (its diameter, a unit, a shape that
/// is known) or has in common with another (its number) goes to `incomplete` by its number, to be told where
/// it is called; what was taken for granted goes to `assumed`; tools without a number, holders and probes are
/// passed over. Throws InputError "file-not-found", "bad-tool-library" (no such JSON, no such records).
std::vector<cutter::Cutter> read_tool_library(const std::string& path, std::map<int, std::string>& incomplete,
                                              std::map<int, std::string>& assumed);

/// Other files that a library is made of, as it names them and as they are found: the bits of a .fctl.
std::vector<std::pair<std::string, std::string>> tool_library_parts(const std::string& path);

}  // namespace swarf::sim

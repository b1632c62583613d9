#include "program/cl/compensation.h"

#include <array>
#include <string_view>

#include "base/diagnostics.h"

namespace swarf::program {
namespace {

/// The remedies of control/contour.cpp in words of CL data.
struct Remedy {
  std::string_view code;
  const char* fix;
};
constexpr std::array kRemedies{
    Remedy{"compensation-active", "write CUTCOM/OFF and a straight GOTO in the plane before it"},
    Remedy{"compensation-plane", "write CUTCOM/OFF before it, or give the arc's plane with CUTCOM"},
    Remedy{"compensation-entry",
           "put CUTCOM before a straight GOTO in the plane that is longer than the radius"},
    Remedy{"compensation-exit", "put CUTCOM/OFF before a straight GOTO in the plane"},
    Remedy{"compensation-rapid", "write CUTCOM/OFF before rapid moves, or take the RAPID away"}};

}  // namespace

void ClCompensation::fail(const char* code, int column, std::string text, std::string fix) const {
  for (const Remedy& remedy : kRemedies) {
    if (remedy.code == code) fix = remedy.fix;
  }
  throw InputError(code, {file_, place_.line, column > 0 ? column : place_.column}, std::move(text),
                   std::move(fix));
}

}  // namespace swarf::program

#include "program/block_law.h"

namespace swarf::program {

const char* law_name(BlockLaw law) {
  switch (law) {
    case BlockLaw::kTcpAxes:
      return "tcp_axes";
    case BlockLaw::kJoint:
      return "joint";
    case BlockLaw::kEnds:
      return "ends";
    case BlockLaw::kCurve:
      return "curve";
    case BlockLaw::kTcp:
      break;
  }
  return "tcp";
}

}  // namespace swarf::program

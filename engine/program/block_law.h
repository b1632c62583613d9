// How the tool moves between the two ends of a block: the law belongs to the program, not to the machine.
#pragma once

namespace swarf::program {

enum class BlockLaw {
  kTcp,      ///< "tcp": the tip straight or on its arc, the axis turning evenly along the great circle
  kTcpAxes,  ///< "tcp_axes": the tip straight or on its arc, the rotary axes linear between their values
  kJoint,    ///< "joint": every machine axis linear between its values at both ends
  kEnds,     ///< "ends": the tip and every other point given on the axis straight (theory 5, flank blocks):
             ///< the axis runs through the linear means of its ends, whatever the guide points' distance
  kCurve,    ///< "curve": tip and axis on one smooth curve that runs on from block to block
};
/// "tcp" and so on, for reports and TOML.
const char* law_name(BlockLaw law);

}  // namespace swarf::program

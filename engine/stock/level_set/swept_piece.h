// One convex piece of the cutter on one sweep. Internal to this folder.
#pragma once

#include "cutter/convex_piece.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

struct SweptPiece {
  SweepMap map;
  const cutter::ConvexPiece* piece = nullptr;
};

}  // namespace swarf::stock

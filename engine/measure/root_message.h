// What the proof of root cells tells to another process. Internal to this folder.
#pragma once

#include "base/bytes.h"
#include "measure/root_proof.h"

namespace swarf::measure {

/// Edge of a root cell at the most, mm.
double root_size(const stock::RayField& field);

struct RootRequest {
  size_t first = 0, end = 0;  ///< of root_cells()
  Budget budget;
};

void add_result(const RootResult& result, BytesWriter& out);
RootResult get_result(BytesReader& in);

}  // namespace swarf::measure

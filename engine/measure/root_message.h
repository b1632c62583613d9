// What the proof of root cells tells to another process. Internal to this folder.
#pragma once

#include <array>

#include "base/bytes.h"
#include "measure/root_proof.h"

namespace swarf::measure {

/// Edge of a root cell at the most, mm.
double root_size(const stock::RayField& field);

inline constexpr size_t kRootsPerRequest = 4;

struct RootRequest {
  std::array<size_t, kRootsPerRequest> roots{};  ///< numbers among root_cells(), the first `count` of them
  size_t count = 0;
  Budget budget;
};

void add_result(const RootResult& result, BytesWriter& out);
RootResult get_result(BytesReader& in);

}  // namespace swarf::measure

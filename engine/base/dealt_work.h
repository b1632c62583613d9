// Work in portions that rank 0 deals out to all ranks, itself among them, as they come free.
#pragma once

#include <cstddef>
#include <functional>

#include "base/ranks.h"

namespace swarf {

struct DealtWork {
  size_t count = 0;                                               ///< portions
  std::function<Bytes(size_t portion, int rank)> request;         ///< what this other rank is asked
  std::function<void(size_t portion, const Bytes& answer)> take;  ///< what it has answered
  std::function<void(size_t portion)> own;                        ///< done on rank 0
  std::function<bool()> is_busy = [] { return false; };  ///< rank 0, with something else: it only deals
};

/// On rank 0: returns when all portions are done. Which rank does one hangs on the machine: no result must.
/// Every request is answered by one message.
void deal(Ranks& ranks, const DealtWork& work);

}  // namespace swarf

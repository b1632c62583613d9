#include "base/hash.h"

#include <fmt/format.h>

namespace swarf {

std::string Hash::text() const {
  return fmt::format("{:016x}", state_);
}

}  // namespace swarf

#include "base/check.h"

#include <fmt/format.h>

namespace swarf {

void check_failed(const char* condition, const char* file, int line, const std::string& message) {
  std::string path = file;
  const auto slash = path.find_last_of('/');
  if (slash != std::string::npos) path = path.substr(slash + 1);
  throw InternalError(fmt::format("{}:{}: {} ({} does not hold)", path, line, message, condition));
}

}  // namespace swarf

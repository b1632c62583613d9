#include "base/progress.h"

namespace swarf {

void Progress::begin(std::string_view, double, std::string_view) {}
void Progress::advance(double) {}
void Progress::start_at(double) {}
void Progress::note(std::string_view) {}
void Progress::end() {}

}  // namespace swarf

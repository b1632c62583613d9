// The proof of the part between the measuring rays (measure/certificate.h), for every surface of the design.
#pragma once

#include "base/progress.h"
#include "sim/job/scene.h"

namespace swarf::sim {

struct Result;

/// After rays and level set have measured the part: fills result.main.surface with the proven bounds of gouge
/// and excess, with every place that breaks a limit, and with what was found deeper or higher than on the
/// rays.
void prove_part(const Job& job, Progress& progress, Result& result);

}  // namespace swarf::sim

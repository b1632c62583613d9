// The proof of the part between the measuring rays (measure/certificate.h), for every surface of the design.
#pragma once

#include <vector>

#include "base/progress.h"
#include "base/ranks.h"
#include "measure/certificate.h"
#include "sim/job/scene.h"
#include "sim/run/ray_cutters.h"
#include "stock/rays/free_ranges.h"

namespace swarf::sim {

struct CutOptions;
struct MeasuredPath;
struct Result;

/// What is known of a part before the proof of one of its surfaces.
struct KnownOfPart {
  size_t surface = 0;
  double stock_bound_mm = 0.0;             ///< CertificateInput::stock_bound_mm
  double gouge_mm = 0.0, excess_mm = 0.0;  ///< what the rays have found
};

/// What all surfaces are proven with. Borrows what it is made from; stays where it is.
class ProofInputs {
 public:
  ProofInputs(const Job& job, const MeasuredPath& path, const stock::Stock& stock);
  ProofInputs(const ProofInputs&) = delete;
  ProofInputs& operator=(const ProofInputs&) = delete;
  measure::CertificateInput of_surface(const KnownOfPart& known, Progress& progress) const;

 private:
  const Job& job_;
  const MeasuredPath& path_;
  const stock::Stock& stock_;
  std::vector<stock::RayFieldPtr> fields_;
  stock::FreeRange ranges_;
  RayCutters rays_;
  measure::SweepCutters cutters_;
};

/// The job has a design and a limit that is to be proven.
bool wants_proof(const Job& job);

/// After rays and level set have measured the part: fills result.main.surface with the proven bounds of gouge
/// and excess, with every place that breaks a limit, and with what was found deeper or higher than on the
/// rays. The ranks of the options, if any, have cut their rays and share the proof. The budget of the options
/// ends it: what is not proven then has no bound.
void prove_part(const Job& job, const CutOptions& options, Progress& progress, Result& result);

}  // namespace swarf::sim

// Root cells of the proof that another process works on (certificate.h).
#pragma once

#include <memory>

#include "base/bytes.h"
#include "measure/certificate.h"

namespace swarf::measure {

/// On the process that does not lead: the same surface, sweeps and stock.
class RootProver {
 public:
  /// All that the input borrows must outlive it; what it tells of progress is not used.
  explicit RootProver(const CertificateInput& input);
  ~RootProver();
  RootProver(const RootProver&) = delete;
  RootProver& operator=(const RootProver&) = delete;

  /// Answers one of the requests that certify() gives to CertificateInput::deal.
  Bytes prove(BytesReader& request) const;

 private:
  struct Roots;
  CertificateInput input_;
  std::unique_ptr<const Roots> roots_;
};

}  // namespace swarf::measure

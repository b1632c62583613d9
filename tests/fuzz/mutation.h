// Damage to files, as disks, mail programs, editors and exporters do it: seeded, so that a case can be
// repeated.
#pragma once

#include <string>

#include "base/rng.h"

namespace swarf::test {

/// One to four faults: bits flipped, bytes overwritten, pieces cut off, left out, doubled or moved, the end
/// missing, byte order swapped, numbers (as text or binary) replaced by NaN, infinities, huge, tiny and odd
/// ones, lines and words left out, doubled or exchanged.
std::string damaged(std::string bytes, Rng& rng);

}  // namespace swarf::test

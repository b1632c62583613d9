#include "stock/level_set/leaf_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/diagnostics.h"
#include "stock/level_set/leaf_kernel.h"

namespace swarf::stock {
namespace {

constexpr size_t kSlotBytes = kLeafVoxels * sizeof(float);
constexpr size_t kPieceSlots = size_t{1} << 14U;  // 32 MB
constexpr size_t kPieceBytes = kPieceSlots * kSlotBytes;
/// Slots that a thread looks at before what it has mapped in is given back: 8 MB.
constexpr uint32_t kLookedAtMost = 4096;

[[noreturn]] void refuse_spill(const char* code, const std::string& folder, int error) {
  throw InputError(code, {folder},
                   fmt::format("leaves of the stock cannot be kept on the disk: {}", std::strerror(error)),
                   "make room there, or name another folder with -o; or raise --max-memory");
}

/// Behind a system without files that have no name, one whose name is taken away at once.
int open_nameless(const std::string& folder) {
  constexpr mode_t kOwn = 0600;
  const int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kOwn);
  if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT)) return descriptor;
  std::string name = folder + "/leaves.XXXXXX";
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) unlink(name.c_str());
  return named;
}

}  // namespace

LeafFile::LeafFile(std::string folder) : folder_(std::move(folder)), descriptor_(open_nameless(folder_)) {
  if (descriptor_ < 0) refuse_spill("spill-unwritable", folder_, errno);
}

LeafFile::~LeafFile() {
  for (const float* piece : pieces_) munmap(const_cast<float*>(piece), kPieceBytes);
  close(descriptor_);
}

void LeafFile::grow() {
  const auto begin = static_cast<off_t>(pieces_.size() * kPieceBytes);
  if (const int error = posix_fallocate(descriptor_, begin, kPieceBytes); error != 0)
    refuse_spill("spill-disk-full", folder_, error);
  void* const mapped = mmap(nullptr, kPieceBytes, PROT_READ, MAP_SHARED, descriptor_, begin);
  if (mapped == MAP_FAILED) refuse_spill("spill-unwritable", folder_, errno);
  pieces_.push_back(static_cast<const float*>(mapped));
}

uint32_t LeafFile::put(const float* values) {
  if (free_.empty() && used_ == pieces_.size() * kPieceSlots) grow();
  const auto slot = free_.empty() ? static_cast<uint32_t>(used_) : free_.back();
  size_t done = 0;
  while (done < kSlotBytes) {
    const ssize_t written = pwrite(descriptor_, reinterpret_cast<const char*>(values) + done,
                                   kSlotBytes - done, static_cast<off_t>(slot * kSlotBytes + done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse_spill(errno == ENOSPC ? "spill-disk-full" : "spill-unwritable", folder_, errno);
    done += static_cast<size_t>(written);
  }
  if (free_.empty()) {
    ++used_;
  } else {
    free_.pop_back();
  }
  return slot;
}

/// What is mapped in counts as memory of the process until it is given back; who looks at it again, in
/// whatever thread, gets the same bytes from the file.
const float* LeafFile::at(uint32_t slot) const {
  thread_local uint32_t last = kNone, looked_at = 0;
  if (slot != last && ++looked_at == kLookedAtMost) {
    looked_at = 0;
    for (const float* piece : pieces_) madvise(const_cast<float*>(piece), kPieceBytes, MADV_DONTNEED);
  }
  last = slot;
  return pieces_[slot / kPieceSlots] + slot % kPieceSlots * kLeafVoxels;
}

}  // namespace swarf::stock

// Values of leaves that are not in memory: slots of one file without a name, mapped for reading. Whatever way
// the process ends, the system takes the file away. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace swarf::stock {

class LeafFile {
 public:
  static constexpr uint32_t kNone = UINT32_MAX;

  /// Throws InputError "spill-unwritable" when no file can be made in the folder.
  explicit LeafFile(std::string folder);
  ~LeafFile();
  LeafFile(const LeafFile&) = delete;
  LeafFile& operator=(const LeafFile&) = delete;

  /// Keeps the kLeafVoxels values; their slot. The room is taken on the disk before it is written to: throws
  /// InputError "spill-disk-full" when there is none. For one thread at a time.
  uint32_t put(const float* values);
  /// The slot may be used again. For one thread at a time.
  void free(uint32_t slot) { free_.push_back(slot); }
  /// What was put; stays where it is until the slot is freed. For any number of threads.
  const float* at(uint32_t slot) const;
  size_t slots() const { return used_ - free_.size(); }  ///< in use

 private:
  void grow();

  std::string folder_;
  int descriptor_ = -1;
  std::vector<const float*> pieces_;  ///< of kPieceSlots slots each
  std::vector<uint32_t> free_;
  size_t used_ = 0;
};

}  // namespace swarf::stock

// Which pass a block belongs to. Internal to this folder.
#pragma once

#include "toolpath/tool_path.h"

namespace swarf::toolpath {

/// Numbers the passes of a program as its blocks come: a pass ends at a rapid, at another tool and at a
/// corner of more than kPassCorner_rad.
class PassCounter {
 public:
  /// The block's pass; -1 for rapids.
  int next(const BlockMove& block);
  int count() const { return pass_ + 1; }

 private:
  int pass_ = -1, tool_ = -1;
  bool open_ = false;
  Vec3 arriving_ = Vec3::Zero();
};

}  // namespace swarf::toolpath

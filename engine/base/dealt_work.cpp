#include "base/dealt_work.h"

#include <chrono>
#include <deque>
#include <thread>
#include <vector>

namespace swarf {
namespace {

/// One is worked on, the next is there when it is done.
constexpr size_t kAtARank = 2;
/// Of rank 0 that only deals; short beside a portion.
constexpr std::chrono::microseconds kNap{300};

class Dealer {
 public:
  Dealer(Ranks& ranks, const DealtWork& work)
      : ranks_(ranks), work_(work), at_(static_cast<size_t>(ranks.size())) {}

  void run() {
    while (next_ < work_.count) {
      for (int rank = 1; rank < ranks_.size(); ++rank) serve(rank);
      if (next_ == work_.count) break;
      if (work_.is_busy())
        std::this_thread::sleep_for(kNap);
      else
        work_.own(next_++);
    }
    for (int rank = 1; rank < ranks_.size(); ++rank)
      while (!at_[static_cast<size_t>(rank)].empty()) take(rank);
  }

 private:
  void serve(int rank) {
    std::deque<size_t>& portions = at_[static_cast<size_t>(rank)];
    while (!portions.empty() && ranks_.has_message(rank)) take(rank);
    while (portions.size() < kAtARank && next_ < work_.count) {
      ranks_.send(rank, work_.request(next_, rank));
      portions.push_back(next_++);
    }
  }
  void take(int rank) {
    std::deque<size_t>& portions = at_[static_cast<size_t>(rank)];
    const Bytes answer = ranks_.receive(rank);
    work_.take(portions.front(), answer);
    portions.pop_front();
  }

  Ranks& ranks_;
  const DealtWork& work_;
  std::vector<std::deque<size_t>> at_;  ///< by rank: what it has not answered
  size_t next_ = 0;
};

}  // namespace

void deal(Ranks& ranks, const DealtWork& work) {
  Dealer(ranks, work).run();
}

}  // namespace swarf

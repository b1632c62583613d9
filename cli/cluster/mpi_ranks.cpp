// Ranks over MPI: a module of its own, so that the program itself needs no MPI to run (cli/open_ranks.h).
#define OMPI_SKIP_MPICXX 1  // C alone
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <list>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "base/ranks.h"

namespace swarf {
namespace {

constexpr int kSizeTag = 1, kPartTag = 2;
/// MPI counts in int.
constexpr size_t kMostAtOnce = size_t{1} << 28;
/// One that waits must not keep a core busy: so often it looks at once, then it sleeps between two looks, an
/// eighth of the time that it has waited.
constexpr int kLooksAtOnce = 200;
constexpr std::chrono::microseconds kShortestSleep{50}, kLongestSleep{1000};

int number_in_environment(const char* name) {
  const char* const text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : -1;
}

/// MPI takes a quarter of a second to begin and a twentieth to end, most of it waiting: a thread of its own
/// does both, while the process reads its job and writes its results. mpirun tells it which rank it is
/// before.
class MpiRanks final : public Ranks {
 public:
  MpiRanks()
      : rank_(number_in_environment("OMPI_COMM_WORLD_RANK")),
        size_(number_in_environment("OMPI_COMM_WORLD_SIZE")),
        begun_(is_begun_.get_future()),
        mpi_([this] { hold_mpi(); }) {
    if (rank_ >= 0 && size_ > rank_) return;
    begun_.wait();
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiRanks() override {
    leave();
    mpi_.join();
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(int to, Bytes message) override {
    begun_.wait();
    forget_gone();
    Outgoing& one = outgoing_.emplace_back();
    one.size = message.size();
    one.message = std::move(message);
    one.requests.emplace_back();
    MPI_Isend(&one.size, 1, MPI_UINT64_T, to, kSizeTag, MPI_COMM_WORLD, &one.requests.back());
    for (size_t at = 0; at < one.message.size(); at += kMostAtOnce) {
      one.requests.emplace_back();
      MPI_Isend(one.message.data() + at, count(one.message.size() - at), MPI_BYTE, to, kPartTag,
                MPI_COMM_WORLD, &one.requests.back());
    }
  }

  bool has_message(int from) override {
    if (begun_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    forget_gone();
    int is_there = 0;
    MPI_Iprobe(from, kSizeTag, MPI_COMM_WORLD, &is_there, MPI_STATUS_IGNORE);
    return is_there != 0;
  }

  Bytes receive(int from) override {
    begun_.wait();
    wait_for_message(from);
    uint64_t size = 0;
    MPI_Recv(&size, 1, MPI_UINT64_T, from, kSizeTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    Bytes message(size);
    for (size_t at = 0; at < size; at += kMostAtOnce)
      MPI_Recv(message.data() + at, count(size - at), MPI_BYTE, from, kPartTag, MPI_COMM_WORLD,
               MPI_STATUS_IGNORE);
    return message;
  }

  void leave() override {
    if (std::exchange(has_left_, true)) return;
    begun_.wait();
    for (Outgoing& one : outgoing_)
      MPI_Waitall(static_cast<int>(one.requests.size()), one.requests.data(), MPI_STATUSES_IGNORE);
    outgoing_.clear();
    is_over_.set_value();
  }
  bool has_left() const override { return has_left_; }

  [[noreturn]] void abort(int exit_code) override {
    if (has_left_) std::_Exit(exit_code);
    begun_.wait();
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }

 private:
  /// MPI wants one thread to begin and to end it; between the two the calls come from the owner's.
  void hold_mpi() {
    int given = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &given);
    if (given < MPI_THREAD_SERIALIZED) {
      std::fprintf(stderr, "error: this MPI can be called by one thread of a process alone\n");
      MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
    }
    is_begun_.set_value();
    is_over_.get_future().wait();
    MPI_Finalize();
  }

  static int count(size_t left) { return static_cast<int>(std::min(left, kMostAtOnce)); }

  void wait_for_message(int from) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begun = Clock::now();
    for (int looks = 0; !has_message(from); ++looks)
      if (looks > kLooksAtOnce)
        std::this_thread::sleep_for(
            std::clamp<Clock::duration>((Clock::now() - begun) / 8, kShortestSleep, kLongestSleep));
  }

  /// On its way to another rank.
  struct Outgoing {
    uint64_t size = 0;
    Bytes message;
    std::vector<MPI_Request> requests;
  };
  void forget_gone() {
    outgoing_.remove_if([](Outgoing& one) {
      int all = 0;
      MPI_Testall(static_cast<int>(one.requests.size()), one.requests.data(), &all, MPI_STATUSES_IGNORE);
      return all != 0;
    });
  }

  int rank_, size_;
  bool has_left_ = false;
  std::list<Outgoing> outgoing_;  ///< MPI reads them where they are
  std::promise<void> is_begun_, is_over_;
  std::future<void> begun_;
  std::thread mpi_;  ///< the last of all: it uses the others
};

}  // namespace
}  // namespace swarf

/// Seen by open_ranks() alone.
extern "C" swarf::Ranks* swarf_make_ranks() {
  return std::make_unique<swarf::MpiRanks>().release();
}

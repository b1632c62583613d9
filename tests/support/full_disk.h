// A disk that is full after so many bytes of a file: the limit of the process, which write() tells like one.
#pragma once

#include <sys/resource.h>

#include <csignal>

namespace swarf::test {

/// From here to the end of the scope.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes_of_a_file) : before_signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes_of_a_file, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, before_signal_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*before_signal_)(int);
};

}  // namespace swarf::test

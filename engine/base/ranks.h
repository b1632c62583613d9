// Processes of one run, on one machine or several, that send each other messages. Rank 0 leads.
#pragma once

#include "base/bytes.h"

namespace swarf {

class Ranks {
 public:
  virtual ~Ranks() = default;    ///< every rank waits here for the others to leave
  virtual int rank() const = 0;  ///< of this process
  virtual int size() const = 0;  ///< how many there are
  /// Messages from one rank to another arrive whole and in order. Does not wait for the other one: the
  /// message is kept until it has gone. For one thread of the process, as all that follows.
  virtual void send(int to, Bytes message) = 0;
  /// One is there, so that receive() would not wait.
  virtual bool has_message(int from) = 0;
  /// Waits for the next one. A rank that is gone sends nothing: who started them all tells and ends the rest.
  virtual Bytes receive(int from) = 0;
  /// This rank sends and receives nothing more. Waits until what it has sent is gone, for nothing else: it
  /// may go on with work of its own, while the ranks part.
  virtual void leave() = 0;
  virtual bool has_left() const = 0;
  /// Ends all of them at once, as they stand.
  [[noreturn]] virtual void abort(int exit_code) = 0;
};

/// Part `index` of `count` of something that is shared out.
struct Share {
  int index = 0, count = 1;                ///< from 0
  bool all() const { return count == 1; }  ///< nobody else has a part
};

inline Share share_of(const Ranks& ranks) {
  return {ranks.rank(), ranks.size()};
}

}  // namespace swarf

// Runs of this very program as processes of their own: one that crashes or runs out of memory takes no other
// with it.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace swarf::cli {

/// Starts this program with `words`; what it prints goes to `log`, replacing the file. It stands in a process
/// group of its own, so that Ctrl-C of a terminal reaches it through stop_child() alone, once, and it is told
/// to stop when this process dies. Throws InputError "cannot-write" (the log) and "cannot-start".
pid_t start_child(const std::vector<std::string>& words, const std::string& log);

/// As Ctrl-C: the run stops and keeps what is finished.
void stop_child(pid_t child);

/// Exit code of a child that has ended: 128 + signal for one that was killed.
int exit_code_of(int wait_status);

}  // namespace swarf::cli

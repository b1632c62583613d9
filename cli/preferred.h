// --prefer of swarf post: the best of all ways through a program, and what it is better than.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "post/post.h"
#include "post/preference.h"

namespace swarf::cli {

class Preferred {
 public:
  /// Sets the hooks; all must outlive it.
  Preferred(post::Preference preferred, const kinematics::MachineModel& machine, post::PostOptions& options);

  /// With the first way through each stretch that can be driven.
  void compare(const std::string& file, const post::PostFormat& format, const post::PostResult& result);
  /// Rows of a table: what was taken, then stretch by stretch why.
  std::vector<std::pair<std::string, std::string>> lines() const;
  nlohmann::ordered_json json() const;

 private:
  post::Preference preferred_;
  const kinematics::MachineModel& machine_;
  post::PostOptions first_;
  post::RouteLog log_;
  std::vector<post::RouteChoice> choices_;
  long dropped_ = 0;
  std::string taken_, first_value_;
};

}  // namespace swarf::cli

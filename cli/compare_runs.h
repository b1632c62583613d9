// swarf compare of two finished runs: the same measuring rays, met by two programs or machines.
#pragma once

#include <string>

namespace swarf::cli {

/// Compares the material on the measuring rays of two run folders, ray by ray, and prints how far they
/// differ. Exit code: kPass when no ray differs by more than `limit_um`, else kFindings. Throws InputError
/// for folders that hold no run, runs without a design ("no-rays") and runs of different designs
/// ("other-rays").
int compare_runs(const std::string& a, const std::string& b, double limit_um, bool json);

}  // namespace swarf::cli

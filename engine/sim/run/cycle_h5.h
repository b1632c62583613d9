// The table of cycles as HDF5: one dataset for each column, named as in trajectory.csv.
//
//   /t_s            float64 [n]   units "s"
//   /block          int32   [n]
//   /tip_x_mm ...   float64 [n]   units "mm", "deg", "mm/min" or "1"
//   /axis_X_mm ...  float64 [n]   the same
//   /kind           enum    [n]   cut, approach, retract, rapid
//   /tool           enum    [n]   numbers or names of the tools
//
// Numbers are the simulation's own doubles, nothing is rounded. Datasets are chunked (kChunk rows), shuffled
// and deflated, and keep the order of their columns; the root tells period_s, scene and swarf. Equal runs
// give equal files. h5py, MATLAB and h5dump read it as it is; pandas by
//   pandas.DataFrame({name: file[name][:] for name in file})
#pragma once

#include <memory>
#include <string>

#include "sim/run/recorder.h"

namespace swarf::sim {

/// Throws InputError "cannot-write". References must outlive it.
std::unique_ptr<CycleTable> open_cycle_h5(const std::string& path, const Job& job,
                                          const motion::Cycles& cycles);

}  // namespace swarf::sim

// Tables of the motion that a run leaves on disk, written while its cycles come.
#pragma once

#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "motion/cycles/cycles.h"
#include "sim/job/scene.h"
#include "sim/run/block_rows.h"
#include "sim/run/cycle_window.h"

namespace swarf::sim {

/// blocks.csv: one row for each element of the path, in its order:
///   line,t_s,tip_x_mm,tip_y_mm,tip_z_mm,i,j,k,axis_<name>_mm|_deg...,feed_mm_min,kind,tool
/// `line` is that of the program; t_s when the tool comes to the element's end, to a cycle, so that it never
/// falls and several short blocks may share it; pose and axes are
/// those of its programmed end; `feed_mm_min` is the greatest commanded feed that it reaches, empty where it
/// is over within a cycle.
class BlockTable {
 public:
  /// Opens the file; throws InputError "cannot-write". References must outlive it.
  BlockTable(const std::string& path, const Job& job, const motion::Cycles& cycles);
  void add(std::span<const motion::Cycle> window) { rows_.add(window); }
  /// Throws InputError "cannot-write".
  void finish();

 private:
  void write(const BlockRow& row);

  std::string path_;
  const Job& job_;
  std::ofstream file_;
  BlockRows rows_;
};

/// One row for each control cycle; its columns in every format:
///   t_s,block,tip_x_mm,tip_y_mm,tip_z_mm,i,j,k,feed_mm_min,axis_<name>_mm|_deg...,contact_x_mm,contact_y_mm,contact_z_mm,u,v,element,kind,tool
/// `block` is the line of the program, `tool` the number of the tool in the spindle, or its name.
class CycleTable {
 public:
  CycleTable() = default;
  CycleTable(const CycleTable&) = delete;
  CycleTable& operator=(const CycleTable&) = delete;
  virtual ~CycleTable() = default;
  virtual void add(std::span<const motion::Cycle> window) = 0;
  /// Throws InputError "cannot-write".
  virtual void finish() = 0;
};

/// By the ending of the file: .csv or .h5 (cycle_h5.h). Throws InputError "cannot-write", and
/// "unknown-ending" for another one. References must outlive it.
///
/// A csv has positions in ten decimals. A third difference of rounded values is off by up to 8 halves of the
/// last decimal over the cube of the period: jerk by differences at 1 ms is good to 0.4 mm/s^3 or deg/s^3 so
/// (with the seven decimals of blocks.csv it would be 400), at 0.1 ms to 400. The numbers of an h5 are not
/// rounded.
std::unique_ptr<CycleTable> open_cycle_table(const std::string& path, const Job& job,
                                             const motion::Cycles& cycles);
/// Throws InputError "unknown-ending" for a file that open_cycle_table() does not know.
void check_cycle_table_name(const std::string& path);

/// The rows of a window, in a new file at this place, replaced whole. Throws InputError as the above.
void write_cycle_window(const std::string& path, const Job& job, const motion::Cycles& cycles,
                        const CycleWindow& window);

/// What the tables call the tool: its number, or its name when it has none.
std::string tool_field(const cutter::Cutter& tool);
/// Names in the order of SampleKind.
std::vector<std::string> kind_names();
InputError unwritable_table(const std::string& path);

inline constexpr const char* kBlockTable = "blocks.csv";
/// The file of the format; not of kNone.
std::string cycle_table_name(TrajectoryFormat format);

}  // namespace swarf::sim

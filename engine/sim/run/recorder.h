// Tables of the motion that a run leaves on disk, written while its cycles come.
#pragma once

#include <fstream>
#include <memory>
#include <span>
#include <string>

#include "motion/cycles/cycles.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// blocks.csv: one row for each element of the path, in its order:
///   line,t_s,x_mm,y_mm,z_mm,i,j,k,<axis>_mm|_deg...,feed_mm_min,kind,tool
/// `line` is that of the program; t_s when the tool comes to the element's end, to a cycle, so that it never
/// falls and several short blocks may share it; pose and axes are
/// those of its programmed end; `feed_mm_min` is the greatest commanded feed that it reaches, empty where it
/// is over within a cycle.
class BlockTable {
 public:
  /// Opens the file; throws InputError "cannot-write". References must outlive it.
  BlockTable(const std::string& path, const Job& job, const motion::Cycles& cycles);
  void add(std::span<const motion::Cycle> window);
  /// Throws InputError "cannot-write".
  void finish();

 private:
  void flush_to(int element, double t_s);
  void write_row(int element, double t_s);

  std::string path_;
  const Job& job_;
  const motion::Cycles& cycles_;
  std::ofstream file_;
  motion::Cycle last_;
  int element_ = 0;          ///< the next row
  double feed_mm_s_ = -1.0;  ///< greatest of the element under way; below 0: it has no cycle yet
};

/// trajectory.csv: one row for each control cycle:
///   t_s,block,x_mm,y_mm,z_mm,i,j,k,feed_mm_min,<axis>_mm|_deg...,contact_x_mm,contact_y_mm,contact_z_mm,u,v,element,kind,tool
/// `block` is the line of the program, `tool` the number of the tool in the spindle, or its name.
class CycleTable {
 public:
  /// As BlockTable.
  CycleTable(const std::string& path, const Job& job, const motion::Cycles& cycles);
  void add(std::span<const motion::Cycle> window);
  void finish();

 private:
  std::string path_;
  const Job& job_;
  const motion::Cycles& cycles_;
  std::ofstream file_;
};

inline constexpr const char* kBlockTable = "blocks.csv";
inline constexpr const char* kCycleTable = "trajectory.csv";

}  // namespace swarf::sim

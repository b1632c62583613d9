#include "sim/job/report_keys.h"

namespace swarf::sim {

ReportSettings read_report(ConfigTable table) {
  ReportSettings report;
  report.logo_file = table.text("logo", "");
  report.logo_where = table.where("logo");
  report.job = table.text("job", "");
  report.part_number = table.text("part_number", "");
  report.customer = table.text("customer", "");
  report.date = table.text("date", "");
  report.approval = table.text("approval", "");
  return report;
}

}  // namespace swarf::sim

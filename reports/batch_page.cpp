// batch.html: one table of all jobs.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "reports/batch_output.h"
#include "reports/embedded.h"
#include "reports/html.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStyle = R"(
main { padding: 1.5rem 0 3rem; overflow-x: auto; }
table { width: 100%; border-collapse: collapse; background: var(--card); font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--muted); padding-bottom: .5rem; }
th, td { text-align: left; vertical-align: top; padding: .55rem .8rem; border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; white-space: nowrap; }
td.what { min-width: 20rem; overflow-wrap: anywhere; }
.word { font-weight: 650; white-space: nowrap; }
.word.ok { color: var(--ok); } .word.bad { color: var(--bad); } .word.none { color: var(--muted); }
)";

/// The job's page where there is one, else what it printed.
std::string link_of(const BatchRow& row, const std::string& folder) {
  for (const char* page : {"report.html", "metrics.json", "setups.json"})
    if (fs::exists(fs::path(folder) / row.name / page) && row.exit_code.value_or(2) <= 1)
      return row.name + "/" + page;
  const std::string log = row.name + ".log";
  return fs::exists(fs::path(folder) / log) ? log : "";
}

std::string row_of(const BatchRow& row, const std::string& folder) {
  const bool passes = row.exit_code == 0;
  const std::string link = link_of(row, folder);
  const std::string name =
      link.empty() ? escape(row.name) : fmt::format("<a href=\"{}\">{}</a>", escape(link), escape(row.name));
  const bool judged = row.exit_code.value_or(2) <= 1;
  return fmt::format(
      "<tr><th scope=\"row\">{}<br><small>{}</small></th><td class=\"word {}\">{}</td><td "
      "class=\"what\">{}</td>"
      "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
      name, escape(row.file), passes ? "ok" : (row.exit_code ? "bad" : "none"), batch_word(row),
      escape(row.verdict), judged ? fmt::format("{}", row.findings) : "&ndash;",
      judged && row.machine_time_s > 0.0 ? fmt::format("{:.1f} s", row.machine_time_s) : "&ndash;",
      row.exit_code ? fmt::format("{:.1f} s", row.seconds) : "&ndash;");
}

}  // namespace

std::string batch_page(const std::string& title, const std::vector<BatchRow>& rows,
                       const std::string& folder) {
  std::vector<BatchRow> sorted = rows;
  std::stable_sort(sorted.begin(), sorted.end(), [](const BatchRow& a, const BatchRow& b) {
    return batch_exit_code({a}) != batch_exit_code({b}) && batch_exit_code({a, b}) == batch_exit_code({a});
  });
  const auto passed =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.exit_code == 0; });
  const bool all = static_cast<size_t>(passed) == rows.size();
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>{0}: {1} of {2} jobs pass</title>\n"
      "<style>{3}{4}</style></head>\n<body><header{5}><div class=\"wrap\"><p class=\"brand\">Swarf "
      "batch</p><h1>{0}</h1>"
      "<div class=\"verdict\"><p><b>{6}</b><span>{1} of {2} jobs pass</span></p></div></div></header>\n"
      "<div class=\"wrap\"><main><table><caption>Every job, the worst first</caption><thead><tr><th "
      "scope=\"col\">Job</th><th scope=\"col\">Outcome</th><th scope=\"col\">Verdict</th><th scope=\"col\" "
      "class=\"number\">Findings</th><th scope=\"col\" class=\"number\">Machine time</th><th scope=\"col\" "
      "class=\"number\">Took</th></tr></thead><tbody>\n",
      escape(title), passed, rows.size(), style_sheet(), kStyle, all ? "" : " class=\"bad\"",
      all ? "PASS" : "NOT ALL PASS");
  for (const BatchRow& row : sorted) page += row_of(row, folder);
  return page + "</tbody></table></main></div></body></html>\n";
}

}  // namespace swarf::reports

#include "reports/report_writer.h"

#include <fmt/format.h>

#include <string_view>

#include "base/file.h"
#include "reports/embedded.h"
#include "reports/html.h"
#include "reports/page_sections.h"

namespace swarf::reports {
namespace {

// The page may load nothing, from anywhere: what it shows is inside it. Its reader of compressed meshes is
// WebAssembly that it carries.
constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; img-src "
    "data: blob:; "
    "media-src data: blob:; connect-src data: blob:";

std::string head(const ReportData& data) {
  return fmt::format(R"(<!doctype html><html lang="en"><head><meta charset="utf-8">)"
                     R"(<meta http-equiv="Content-Security-Policy" content="{}"><meta name="viewport")"
                     R"( content="width=device-width,initial-scale=1"><meta name="color-scheme")"
                     R"( content="light dark"><title>{} – {}</title><link rel="icon" href="data:,"><style>)"
                     R"({}</style></head><body>)",
                     kPolicy, escape(data.title), data.verdict.pass ? "pass" : "fail", style_sheet());
}

struct NamedSection {
  std::string_view id, name;
  std::string html;
};

std::string navigation(const std::vector<NamedSection>& sections) {
  std::string out = R"(<nav aria-label="Sections"><div class="wrap">)";
  for (const NamedSection& section : sections) {
    if (!section.html.empty()) out += fmt::format(R"(<a href="#{}">{}</a>)", section.id, section.name);
  }
  return out + "</div></nav>";
}

}  // namespace

std::string render_report(const ReportData& data) {
  std::vector<NamedSection> sections = {
      {"assumed", "Assumed", assumptions_section(data.assumptions)},
      {"overview", "Key numbers", overview_section(data)},
      {"findings", "Findings", findings_section(data)},
      {"view", "3D view", viewer_section(data.viewer)},
      {"movie", "Movie", movie_section(data)},
      {"stills", "Stills", stills_section(data.stills)},
      {"plots", "Plots", plots_section(data.plots)},
      {"tables", "Tables", tables_section(data.tables)},
  };
  for (const Topic& topic : data.topics) sections.push_back({topic.id, topic.name, topic_section(topic)});
  const std::vector<NamedSection> closing = {
      {"paper", "Paper", paper_section(data)},
      {"checks", "Checks", checks_section(data.checks)},
      {"reproduce", "Reproduce", reproduce_section(data)},
  };
  sections.insert(sections.end(), closing.begin(), closing.end());
  std::string out = head(data) + symbol_sprite() + verdict_header(data) + navigation(sections);
  out += "<main class=\"wrap\">";
  bool has_view = false;
  for (const NamedSection& section : sections) {
    out += section.html;
    has_view = has_view || (section.id == "view" && !section.html.empty());
  }
  out += "</main><script>" + script_safe(page_script()) + "</script>";
  if (has_view) {
    out += "<!-- three.js, in the script below:\n\n" + std::string(viewer_licence()) + "-->";
    out += "<script>" + script_safe(viewer_script()) + "</script>";
  }
  return out + "</body></html>\n";
}

void write_report(const std::string& path, const ReportData& data) {
  replace_file(path, render_report(data), {"output-unwritable", "the report cannot be written"});
}

}  // namespace swarf::reports

#include "reports/report_writer.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "reports/embedded.h"
#include "reports/html.h"
#include "reports/page_sections.h"

namespace swarf::reports {
namespace {

// The page may load nothing, from anywhere: what it shows is inside it.
constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:; "
    "media-src data: blob:; connect-src data: blob:";

std::string head(const ReportData& data) {
  return fmt::format(R"(<!doctype html><html lang="en"><head><meta charset="utf-8">)"
                     R"(<meta http-equiv="Content-Security-Policy" content="{}"><meta name="viewport")"
                     R"( content="width=device-width,initial-scale=1"><meta name="color-scheme")"
                     R"( content="light dark"><title>{} – {}</title><link rel="icon" href="data:,"><style>)"
                     R"({}</style></head><body>)",
                     kPolicy, escape(data.title), data.verdict.pass ? "pass" : "findings", style_sheet());
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

InputError unwritable(const std::string& path, const std::string& reason) {
  return {"output-unwritable",
          {path},
          "the report cannot be written: " + reason,
          "choose a folder that exists, is writable and has room"};
}

}  // namespace

std::string render_report(const ReportData& data) {
  std::vector<NamedSection> sections = {
      {"overview", "Key numbers", overview_section(data)},
      {"findings", "Findings", findings_section(data.findings)},
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
  const std::string page = render_report(data);
  const std::string temporary = path + ".partial";
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file << page;
  file.close();
  std::error_code error;
  if (!file) {
    std::filesystem::remove(temporary, error);
    throw unwritable(path, "writing " + temporary + " failed");
  }
  std::filesystem::rename(temporary, path, error);
  if (error) {
    std::filesystem::remove(temporary, error);
    throw unwritable(path, "renaming " + temporary + " failed");
  }
}

}  // namespace swarf::reports

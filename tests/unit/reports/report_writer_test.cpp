#include "reports/report_writer.h"

#include <gtest/gtest.h>

#include <regex>

#include "base/diagnostics.h"
#include "reports/html.h"
#include "temporary_folder.h"

namespace swarf::reports {
namespace {

/// The smallest PNG there is: one grey pixel.
std::string tiny_png() {
  return std::string(
      "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\x0aIDAT\x78\x9c"
      "\x63\x68\0\0"
      "\0\x82\0\x81\x77\xcd\x72\xb6\0\0\0\0IEND\xae\x42\x60\x82",
      67);
}

/// Something in every section, with markup in every kind of text.
ReportData sample(const TemporaryFolder& folder) {
  ReportData data;
  data.title = "Dome <script>alert(1)</script>";
  data.subtitle = "D10 & \"flat\"";
  data.verdict = {false,
                  "scallop fails; 1 check holds; not judged: <holder>",
                  {{"Scallop <max>", "11 µm", "at most 10.5 µm", State::kFails},
                   {"Gouge", "0 µm", "1 µm", State::kHolds}}};
  data.key_numbers = {{"Scallop", "11", "µm", "<hint>", Tone::kBad}};
  data.findings = {{"scallop", Severity::kError, "too high <b>", "step over less", {"dome.nc", 11, 0}, 12.5}};
  data.hero_png = folder.write("hero.png", tiny_png());
  data.hero_caption = "The part";
  ReportFinding& finding = data.findings.front();
  finding.first_line = 11;
  finding.last_line = 14;
  finding.count = 3;
  finding.block = "G1 X<5>";
  finding.excerpt = {{10, "G0 Z5"}, {11, "G1 X<5>"}, {12, "M2"}};
  finding.place_mm = {1.0, -2.5, 3.0};
  finding.has_place = true;
  data.viewer.part_glb = "glTF-part";
  data.viewer.machine_glb = "glTF-machine";
  data.viewer.colour_bar = {"Deviation", "µm", -10, 10, {{{0, 0, 255}}, {{255, 255, 255}}, {{255, 0, 0}}}};
  data.movie_mp4 = folder.write("movie.mp4", "movie bytes");
  data.stills = {{data.hero_png, "From above"}};
  data.plots = {{"Feed", "", "Time", "s", "Feed", "mm/min", {{"feed", {{0, 0}, {1, 3000}}}}, {}, {}}};
  data.tables = {
      {"Planners", "", {{"Planner"}, {"Passes", "", true}}, {{"constant <scallop>", "29"}}, {"note"}, 0}};
  data.paper = {{"Segments", "Eq. (8)", "52", "55", "", "E6", "1 µm needs 55"}};
  data.checks = {{"Gouge", "0.01 µm", "", State::kHolds},
                 {"Excess", "9.9 µm", "proven 10.2 µm", State::kNotProven},
                 {"Holder", "", "the scene has no holder", State::kNotChecked}};
  data.reproduce = {"swarf run scene.toml --set 'a=<b>'"};
  data.facts = {{"Program", {{"File", "dome.nc"}}}};
  return data;
}

/// The page without the code in its scripts, where words such as "src=" mean something else.
std::string without_scripts(const std::string& page) {
  std::string out;
  for (size_t at = 0; at < page.size();) {
    const size_t script = page.find("<script", at);
    out += page.substr(at, script - at);
    if (script == std::string::npos) break;
    at = page.find("</script>", script) + 9;
  }
  return out;
}

TEST(ReportWriter, LoadsNothingFromAnywhere) {
  const TemporaryFolder folder("swarf_report_self");
  const std::string page = without_scripts(render_report(sample(folder)));
  const std::regex load(R"re((src|href|poster|srcset|data)\s*=\s*["']?([^"'\s>]{0,12}))re");
  int found = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), load), end; it != end; ++it, ++found) {
    const std::string target = (*it)[2];
    EXPECT_TRUE(target.starts_with("data:") || target.starts_with("#")) << it->str();
  }
  EXPECT_GT(found, 10);
  for (const char* word : {"http:", "https:", "url(", "@import", "<link rel=\"stylesheet", "<iframe"}) {
    EXPECT_EQ(page.find(word), std::string::npos) << word;
  }
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST(ReportWriter, TextNeverBecomesMarkup) {
  const TemporaryFolder folder("swarf_report_escape");
  const std::string page = render_report(sample(folder));
  for (const char* text : {"<script>alert", "<max>", "<hint>", "high <b>", "<scallop>", "a=<b>", "X<5>"}) {
    EXPECT_EQ(page.find(text), std::string::npos) << text;
  }
  EXPECT_NE(page.find("Dome &lt;script&gt;alert(1)&lt;/script&gt;"), std::string::npos);
}

TEST(ReportWriter, CarriesItsFilesInside) {
  const TemporaryFolder folder("swarf_report_files");
  const std::string page = render_report(sample(folder));
  EXPECT_NE(page.find("id=\"part-glb\">" + base64("glTF-part") + "</script>"), std::string::npos);
  EXPECT_NE(page.find("id=\"machine-glb\">" + base64("glTF-machine") + "</script>"), std::string::npos);
  EXPECT_NE(page.find("data:video/mp4;base64," + base64("movie bytes")), std::string::npos);
  EXPECT_NE(page.find("<img src=\"data:image/webp;base64,"), std::string::npos);
  EXPECT_NE(page.find("width=\"1\" height=\"1\" alt=\"From above\""), std::string::npos);
  EXPECT_GT(page.size(), 500000U) << "the viewer is missing";
}

TEST(ReportWriter, SaysWhatHoldsAndWhatWasNotChecked) {
  const TemporaryFolder folder("swarf_report_words");
  const std::string page = render_report(sample(folder));
  for (const char* text :
       {"<b>Fail</b>", "1 check holds; not judged: &lt;holder&gt;", "symbol-warning\"/></svg>Not proven",
        "symbol-none\"/></svg>Not checked", "the scene has no holder", "12.500 s", ">E6<"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
}

TEST(ReportWriter, FindingsLeadToTheirPlaceLineAndTime) {
  const TemporaryFolder folder("swarf_report_findings");
  const std::string page = render_report(sample(folder));
  for (const char* text :
       {"id=\"finding-1\"", "href=\"#finding-1\"", "dome.nc, lines 11 to 14", "3 places alike",
        "X 1.000 Y -2.500 Z 3.000 mm", "<span class=\"at\"><i>11</i>G1 X&lt;5&gt;</span>", "<i>12</i>M2",
        "data-show=\"view\" data-finding=\"1\"", "data-show=\"movie\" data-finding=\"1\"",
        "[{\"t_s\":12.500000,\"place\":[1.000000,-2.500000,3.000000],\"in_machine\":false,\"line\":11}]"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
  ReportData still = sample(folder);
  still.movie_mp4.clear();
  EXPECT_EQ(render_report(still).find("data-show=\"movie\" data"), std::string::npos)
      << "no way to a movie that is not there";
}

TEST(ReportWriter, EmptySectionsAreLeftOut) {
  ReportData data;
  data.title = "Bare";
  data.verdict.pass = true;
  const std::string page = render_report(data);
  for (const char* id : {"id=\"movie\"", "id=\"plots\"", "id=\"view\"", "id=\"stills\"", "href=\"#paper\""}) {
    EXPECT_EQ(page.find(id), std::string::npos) << id;
  }
  EXPECT_LT(page.size(), 60000U) << "a page without a 3D view needs no viewer";
}

TEST(ReportWriter, EqualDataGiveEqualFilesAndNoLeftovers) {
  const TemporaryFolder folder("swarf_report_equal");
  const ReportData data = sample(folder);
  const std::string a = folder.file("a.html"), b = folder.file("b.html");
  write_report(a, data);
  write_report(b, data);
  write_report(b, data);  // over the one that is there
  EXPECT_EQ(read_file(a), read_file(b));
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
  }
}

TEST(ReportWriter, MissingPictureIsAnErrorAndLeavesTheLastReport) {
  const TemporaryFolder folder("swarf_report_missing");
  ReportData data = sample(folder);
  const std::string path = folder.write("report.html", "the last good one");
  data.stills.push_back({folder.file("none.png"), "not there"});
  EXPECT_THROW(write_report(path, data), InputError);
  EXPECT_EQ(read_file(path), "the last good one");
}

TEST(ReportWriter, FolderThatDoesNotExistIsNamed) {
  ReportData data;
  data.title = "Nowhere";
  try {
    write_report("/no-such-folder/report.html", data);
    FAIL() << "was written";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list()[0].code, "output-unwritable");
    EXPECT_EQ(error.diagnostics.list()[0].where.file, "/no-such-folder/report.html");
  }
}

}  // namespace
}  // namespace swarf::reports

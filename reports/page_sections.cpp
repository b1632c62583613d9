#include "reports/page_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "reports/html.h"
#include "reports/svg_plot.h"

namespace swarf::reports {
namespace {

/// More would bury the page; findings.json has them all, and the page says so.
constexpr size_t kFindingsShown = 200;

std::string symbol(const char* name) {
  return fmt::format(R"(<svg class="symbol {}" aria-hidden="true"><use href="#symbol-{}"/></svg>)", name,
                     name);
}

/// An element around escaped text; nothing for empty text.
std::string element(const char* tag, const char* css_class, const std::string& text) {
  if (text.empty()) return "";
  const std::string attribute = *css_class == '\0' ? "" : fmt::format(R"( class="{}")", css_class);
  return fmt::format("<{}{}>{}</{}>", tag, attribute, escape(text), tag);
}

/// Long paths may wrap after a slash. `text` is escaped already.
std::string breakable(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c;
    if (c == '/') out += "<wbr>";
  }
  return out;
}

std::string section(const char* id, const std::string& title, const std::string& body) {
  return fmt::format(R"(<section id="{}" aria-labelledby="{}-title"><h2 id="{}-title">{}</h2>{}</section>)",
                     id, id, id, escape(title), body);
}

const char* tone_class(Tone tone) {
  switch (tone) {
    case Tone::kOk:
      return "ok";
    case Tone::kWarning:
      return "warning";
    case Tone::kBad:
      return "bad";
    case Tone::kNeutral:
      break;
  }
  return "neutral";
}

struct StateLook {
  const char *symbol, *word;
};

StateLook look_of(State state) {
  switch (state) {
    case State::kHolds:
      return {"ok", "Holds"};
    case State::kFails:
      return {"bad", "Fails"};
    case State::kNotProven:
      return {"warning", "Not proven"};
    case State::kNotChecked:
      break;
  }
  return {"none", "Not checked"};
}

std::string criteria_list(const std::vector<Criterion>& criteria) {
  if (criteria.empty()) return "";
  std::string out = "<ul class=\"criteria\">";
  for (const Criterion& criterion : criteria) {
    const StateLook look = look_of(criterion.state);
    out += fmt::format(R"(<li>{}<span class="criterion">{}<span class="unseen">: {}</span></span>)",
                       symbol(look.symbol), escape(criterion.name), look.word);
    out += element("b", "", criterion.measured) + element("span", "limit", criterion.limit) + "</li>";
  }
  return out + "</ul>";
}

std::string key_number(const KeyNumber& number) {
  return fmt::format(R"(<div class="key {}"><dt>{}</dt><dd><b>{}</b>{}{}</dd></div>)",
                     tone_class(number.tone), escape(number.label), escape(number.value),
                     element("span", "unit", number.unit), element("small", "", number.hint));
}

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

/// "dome.nc, line 14" or "dome.nc, lines 14 to 20".
std::string lines_of(const ReportFinding& finding) {
  if (finding.where.file.empty()) return "";
  const std::string file = file_name(finding.where.file);
  if (finding.first_line == 0) return file;
  return finding.first_line == finding.last_line
             ? fmt::format("{}, line {}", file, finding.first_line)
             : fmt::format("{}, lines {} to {}", file, finding.first_line, finding.last_line);
}

/// Where and when the worst of it is, and what of it the page can show.
std::string finding_places(const ReportFinding& finding, size_t number, bool view, bool movie) {
  std::string out = element("span", "", lines_of(finding));
  const bool timed = std::isfinite(finding.time_s);
  if (timed) out += fmt::format("<span>{:.3f} s</span>", finding.time_s);
  const auto& [x, y, z] = finding.place_mm;
  if (finding.has_place) out += fmt::format("<span>X {:.3f} Y {:.3f} Z {:.3f} mm</span>", x, y, z);
  if (finding.count > 1) out += fmt::format("<span>{} places alike, the worst shown</span>", finding.count);
  std::string buttons;
  const auto button = [&](const char* what, const char* text) {
    buttons += fmt::format(R"(<button type="button" data-show="{}" data-finding="{}">{}</button>)", what,
                           number, text);
  };
  if (view && (finding.has_place || timed)) button("view", "Show in 3D");
  if (movie && timed) button("movie", "Show in the movie");
  buttons +=
      fmt::format(R"(<a href="#finding-{}" aria-label="Link to finding {}">#{}</a>)", number, number, number);
  return R"(<p class="places">)" + out + R"(</p><p class="actions">)" + buttons + "</p>";
}

std::string excerpt(const ReportFinding& finding) {
  if (finding.excerpt.empty()) return "";
  std::string out = fmt::format(
      R"(<pre class="excerpt" tabindex="0" aria-label="{}"><code>)",
      escape(fmt::format("{}, around line {}", file_name(finding.where.file), finding.where.line)));
  for (const ProgramLine& one : finding.excerpt) {
    const bool at = one.line == finding.where.line;
    out += fmt::format("<span{}><i>{}</i>{}</span>", at ? R"( class="at")" : "", one.line, escape(one.text));
  }
  return out + "</code></pre>";
}

std::string finding_card(const ReportFinding& finding, size_t number, bool view, bool movie) {
  struct Look {
    const char *symbol, *word, *css_class;
  };
  static constexpr Look kLooks[] = {
      {"none", "Note", "note"}, {"warning", "Warning", "warning"}, {"bad", "Error", "error"}};
  const Look& look = kLooks[static_cast<int>(finding.severity)];
  std::string out =
      fmt::format(R"(<li class="finding {}" id="finding-{}"><div><h3>{}{} {}: <code>{}</code></h3>)",
                  look.css_class, number, symbol(look.symbol), look.word, number, escape(finding.code));
  out += element("p", "", finding.text) + element("p", "do", finding.fix) +
         finding_places(finding, number, view, movie) + "</div>";
  if (!finding.picture_png.empty())
    out +=
        R"(<div class="finding-picture">)" + embedded_picture(finding.picture_png, finding.text) + "</div>";
  return out + excerpt(finding) + "</li>";
}

/// For the 3D view and the movie: where each finding is.
std::string findings_island(const std::vector<ReportFinding>& findings, size_t shown) {
  std::string out = R"(<script type="application/json" id="findings-data">[)";
  for (size_t i = 0; i < shown; ++i) {
    const ReportFinding& one = findings[i];
    const std::string time = std::isfinite(one.time_s) ? fmt::format("{:.6f}", one.time_s) : "null";
    const auto& [x, y, z] = one.place_mm;
    const bool placed = one.has_place || one.in_machine;
    const std::string place = placed ? fmt::format("[{:.6f},{:.6f},{:.6f}]", x, y, z) : "null";
    out += fmt::format(R"({}{{"t_s":{},"place":{},"in_machine":{},"line":{}}})", i > 0 ? "," : "", time,
                       place, one.in_machine, one.where.line);
  }
  return out + "]</script>";
}

/// On a narrow page the cells of a row stand below each other: words of several columns would have a finger's
/// width each.
bool stacks(const Table& table) {
  constexpr std::ptrdiff_t kTextColumns = 2;
  return !table.pictures.empty() || std::count_if(table.columns.begin(), table.columns.end(),
                                                  [](const auto& c) { return !c.numeric; }) > kTextColumns;
}

std::string table_open(const std::vector<Column>& columns, const std::string& caption,
                       const Table* table = nullptr) {
  const bool pictures = table != nullptr && !table->pictures.empty();
  std::string out =
      fmt::format(R"(<div class="scroll{}{}" tabindex="0" role="region" aria-label=")",
                  table != nullptr && stacks(*table) ? " stacks" : "", pictures ? " pictured" : "") +
      escape(caption) + R"("><table><caption class="unseen">)" + escape(caption) + "</caption><thead><tr>";
  if (pictures) out += R"(<td></td>)";
  for (const Column& column : columns) {
    out += fmt::format(R"(<th scope="col"{}>{}{}</th>)", column.numeric ? R"( class="number")" : "",
                       escape(column.title), element("span", "unit", column.unit));
  }
  return out + "</tr></thead><tbody>";
}

/// `stacked`: with what stands in the table's head, and its unit.
std::string cell_attributes(const Column& column, bool stacked) {
  std::string out = column.numeric ? R"( class="number")" : "";
  if (stacked)
    out += R"( data-label=")" + escape(column.title) +
           (column.unit.empty() ? "" : ", " + escape(column.unit)) + "\"";
  return out;
}

constexpr const char* kTableClose = "</tbody></table></div>";

std::string table_html(const Table& table) {
  std::string out = "<article class=\"table\"><h3>" + escape(table.title) + "</h3>";
  out += element("p", "intro", table.intro) + table_open(table.columns, table.title, &table);
  const bool stacked = stacks(table);
  for (size_t r = 0; r < table.rows.size(); ++r) {
    SWARF_CHECK(table.rows[r].size() == table.columns.size(),
                "a row of \"" + table.title + "\" is not whole");
    out += static_cast<int>(r) == table.highlighted_row ? "<tr class=\"used\">" : "<tr>";
    if (!table.pictures.empty()) out += R"(<td class="picture">)" + table.pictures.at(r) + "</td>";
    for (size_t c = 0; c < table.columns.size(); ++c) {
      const char* tag = c == 0 ? "th scope=\"row\"" : "td";
      out += fmt::format("<{}{}>{}</{}>", tag, cell_attributes(table.columns[c], c > 0 && stacked),
                         escape(table.rows[r][c]), c == 0 ? "th" : "td");
    }
    out += "</tr>";
  }
  out += kTableClose;
  for (const std::string& note : table.notes) out += element("p", "note", note);
  return out + "</article>";
}

std::string colour_bar(const ColourBar& bar) {
  if (bar.stops.empty()) return "";
  std::string gradient;
  for (const auto& [r, g, b] : bar.stops) gradient += fmt::format(",rgb({} {} {})", r, g, b);
  std::vector<std::pair<double, std::string>> ticks = bar.ticks;
  if (ticks.empty()) {
    const Ticks round = round_ticks(bar.low, bar.high, 4);
    for (const double tick : round.values) ticks.emplace_back(tick, tick_text(tick, round.step));
  }
  std::string out = fmt::format(
      R"(<figure class="colour-bar" data-tab="part"><figcaption>{} <span class="unit">{}</span></figcaption>)"
      R"html(<div class="ramp" style="background:linear-gradient(90deg{})"></div>)html"
      R"html(<div class="ramp-ticks">)html",
      escape(bar.title), escape(bar.unit), gradient);
  for (const auto& [tick, label] : ticks) {
    const double percent = 100.0 * (tick - bar.low) / (bar.high - bar.low);
    constexpr double kSlackPercent = 1e-6;  // rounding of k * step only
    if (percent < -kSlackPercent || percent > 100.0 + kSlackPercent) continue;
    out += fmt::format(R"(<span style="left:{:.2f}%">{}</span>)", percent, escape(label));
  }
  out += "</div>";
  if (!bar.apart.empty()) {
    const auto& [r, g, b] = bar.apart_colour;
    out += fmt::format(
        R"html(<p class="apart"><span class="patch" style="background:rgb({} {} {})"></span>{}</p>)html", r,
        g, b, escape(bar.apart));
  }
  return out + "</figure>";
}

std::string embedded_glb(const char* id, const std::string& bytes) {
  if (bytes.empty()) return "";
  return fmt::format(R"(<script type="application/octet-stream" id="{}">{}</script>)", id, base64(bytes));
}

/// The colours of deviation and the limits that they end at, for a view that colours the part itself.
std::string colour_data(const ColourBar& bar) {
  if (bar.stops.empty() || bar.ticks.empty()) return "";
  std::string stops;
  for (const auto& [r, g, b] : bar.stops)
    stops += fmt::format("{}{},{},{}", stops.empty() ? "" : " ", r, g, b);
  return fmt::format(R"( data-stops="{}" data-low="{}" data-high="{}")", stops, bar.low_value,
                     bar.high_value);
}

std::string legend(const Plot& plot) {
  if (plot.series.size() < 2) return "";
  std::string out = "<ul class=\"legend\">";
  for (size_t i = 0; i < plot.series.size(); ++i) {
    out +=
        fmt::format(R"(<li><svg viewBox="0 0 24 8" aria-hidden="true"><path class="series s{}" d="M1 4H23"/>)"
                    R"(</svg>{}</li>)",
                    i % 6, escape(plot.series[i].name));
  }
  return out + "</ul>";
}

}  // namespace

std::string symbol_sprite() {
  return R"(<svg class="sprite" aria-hidden="true"><symbol id="symbol-ok" viewBox="0 0 20 20">)"
         R"(<circle cx="10" cy="10" r="9"/><path d="M5.8 10.4l2.9 2.9 5.6-6.2"/></symbol>)"
         R"(<symbol id="symbol-bad" viewBox="0 0 20 20"><circle cx="10" cy="10" r="9"/>)"
         R"(<path d="M6.7 6.7l6.6 6.6m0-6.6l-6.6 6.6"/></symbol><symbol id="symbol-warning")"
         R"( viewBox="0 0 20 20"><path class="body" d="M10 1.5L19 18H1z"/>)"
         R"(<path d="M10 7.5v5m0 2.3v.4"/></symbol><symbol id="symbol-none" viewBox="0 0 20 20">)"
         R"(<circle cx="10" cy="10" r="9"/><path d="M6 10h8"/></symbol></svg>)";
}

namespace {

/// Logo and facts of the job; nothing where the scene says none.
std::string job_head(const JobHead& head) {
  std::string out;
  if (!head.logo_png.empty())
    out += R"(<div class="logo">)" + embedded_picture(head.logo_png, "Logo") + "</div>";
  if (!head.facts.empty()) out += R"(<dl class="job">)";
  for (const Fact& fact : head.facts)
    out += "<div><dt>" + escape(fact.name) + "</dt><dd>" + escape(fact.value) + "</dd></div>";
  if (!head.facts.empty()) out += "</dl>";
  return out.empty() ? "" : R"(<div class="job-head">)" + out + "</div>";
}

}  // namespace

std::string verdict_header(const ReportData& data) {
  const char* kind = data.verdict.pass ? "ok" : "bad";
  std::string out = fmt::format(
      R"(<header class="{}"><div class="wrap"><p class="brand">Swarf simulation report</p>)", kind);
  out += element("h1", "", data.title) + element("p", "subtitle", data.subtitle) + job_head(data.head);
  out += fmt::format(R"(<div class="verdict" role="status">{}<p><b>{}</b><span>{}</span></p></div>)",
                     symbol(kind), data.verdict.pass ? "Pass" : "Fail", escape(data.verdict.headline));
  return out + criteria_list(data.verdict.criteria) + "</div></header>";
}

std::string overview_section(const ReportData& data) {
  if (data.hero_png.empty() && data.key_numbers.empty()) return "";
  std::string out = fmt::format(R"(<div class="overview{}">)", data.hero_png.empty() ? " no-hero" : "");
  if (!data.hero_png.empty()) {
    out += "<figure class=\"hero\">" + embedded_picture(data.hero_png, data.hero_caption) +
           element("figcaption", "", data.hero_caption) + "</figure>";
  }
  out += "<dl class=\"keys\">";
  for (const KeyNumber& number : data.key_numbers) out += key_number(number);
  return section("overview", "Key numbers", out + "</dl></div>");
}

std::string findings_section(const ReportData& data) {
  const std::vector<ReportFinding>& findings = data.findings;
  if (findings.empty()) {
    return section("findings", "Findings",
                   R"(<p class="nothing">)" + symbol("ok") +
                       R"(<span>None, in what was checked. <a href="#checks">)"
                       R"(What was checked, and what was not</a></span></p>)");
  }
  const bool view = !data.viewer.part_glb.empty() || !data.viewer.machine_glb.empty();
  std::string out = R"(<ol class="findings">)";
  const size_t shown = std::min(findings.size(), kFindingsShown);
  const bool movie = !data.movie_mp4.empty() && data.movie_even;
  for (size_t i = 0; i < shown; ++i) out += finding_card(findings[i], i + 1, view, movie);
  out += "</ol>" + findings_island(findings, shown);
  if (shown < findings.size()) {
    out += fmt::format(R"(<p class="note">The first {} of {}; findings.json has them all.</p>)", shown,
                       findings.size());
  }
  if (!data.findings_note.empty()) out += element("p", "note", data.findings_note);
  return section("findings", fmt::format("Findings ({})", findings.size()), out);
}

std::string viewer_section(const Viewer3d& viewer) {
  if (viewer.part_glb.empty() && viewer.machine_glb.empty()) return "";
  std::string out =
      fmt::format(R"(<div id="viewer" data-time-scale="{:.9g}" data-unit="{}"{}><p class="fallback">)"
                  R"(The 3D view needs JavaScript and WebGL. The stills below show the same part.</p></div>)",
                  viewer.program_seconds_per_animation_second, escape(viewer.colour_bar.unit),
                  colour_data(viewer.colour_bar));
  if (!viewer.program.empty())
    out += R"(<script type="application/json" id="program-data">)" + viewer.program + "</script>";
  out += viewer.part_glb.empty() ? "" : colour_bar(viewer.colour_bar);
  if (!viewer.hanging.empty()) out += element("p", "note hanging", viewer.hanging);
  out += embedded_glb("part-glb", viewer.part_glb) + embedded_glb("machine-glb", viewer.machine_glb);
  return section("view", "3D view", out);
}

std::string movie_section(const ReportData& data) {
  if (data.movie_mp4.empty()) return "";
  return section(
      "movie", "Movie",
      fmt::format(R"(<figure class="movie"><video controls playsinline preload="metadata"{} aria-label="{}")"
                  R"( src="data:video/mp4;base64,{}"></video>{}</figure>)",
                  data.movie_even ? " data-even" : "", escape(data.movie_caption),
                  base64(read_file(data.movie_mp4)), element("figcaption", "", data.movie_caption)));
}

std::string stills_section(const std::vector<Still>& stills) {
  if (stills.empty()) return "";
  std::vector<std::string> pictures(stills.size());
  parallel_chunks(stills.size(), 1, [&](size_t i, size_t) {
    pictures[i] = embedded_picture(stills[i].png_path, stills[i].caption);
  });
  std::string out = "<div class=\"stills\">";
  for (size_t i = 0; i < stills.size(); ++i)
    out += "<figure>" + pictures[i] + element("figcaption", "", stills[i].caption) + "</figure>";
  return section("stills", "Stills", out + "</div>");
}

std::string plots_section(const std::vector<Plot>& plots) {
  if (plots.empty()) return "";
  std::string out = "<div class=\"plots\">";
  for (const Plot& plot : plots) {
    out += "<figure class=\"plot-card\"><h3>" + escape(plot.title) + "</h3>" + legend(plot) + plot_svg(plot) +
           element("figcaption", "", plot.caption) + "</figure>";
  }
  return section("plots", "Plots", out + "</div>");
}

std::string assumptions_section(const std::vector<Table>& tables) {
  return tables.empty() ? "" : section("assumed", "Assumed", table_html(tables.front()));
}

std::string tables_section(const std::vector<Table>& tables) {
  if (tables.empty()) return "";
  std::string out;
  for (const Table& table : tables) out += table_html(table);
  return section("tables", "Tables", out);
}

std::string topic_section(const Topic& topic) {
  std::string out = element("p", "intro", topic.intro);
  if (!topic.figures.empty()) out += "<div class=\"plots\">";
  for (const Figure& figure : topic.figures) {
    out += fmt::format(R"(<figure class="figure-card{}"><h3>)", figure.wide ? " wide" : "") +
           escape(figure.title) + "</h3><ul class=\"legend\">";
    for (const Figure::Entry& entry : figure.legend) {
      out += fmt::format(
          R"(<li><svg viewBox="0 0 24 8" aria-hidden="true"><path class="{}" d="M1 4H23"/></svg>{}</li>)",
          entry.css_class, escape(entry.name));
    }
    out += "</ul>" + figure.svg + element("figcaption", "", figure.caption) + "</figure>";
  }
  if (!topic.figures.empty()) out += "</div>";
  for (const Table& table : topic.tables) out += table_html(table);
  return section(topic.id.c_str(), topic.title, out);
}

std::string paper_section(const ReportData& data) {
  if (data.paper.empty()) return "";
  std::string out = table_open({{"Quantity"},
                                {"Where"},
                                {"Paper", "", true},
                                {"Ours", "", true},
                                {"Unit"},
                                {"Erratum"},
                                {"Why they differ"}},
                               "Paper against ours");
  for (const papers::PaperRow& row : data.paper) {
    const bool agrees = row.erratum.empty() && row.why.empty();
    const std::string erratum = row.erratum.empty() ? "–" : element("span", "erratum", row.erratum);
    out += fmt::format(
        R"(<tr><th scope="row">{}</th><td>{}</td><td class="number wraps">{}</td><td class="number wraps">)"
        R"({}</td><td>{}</td><td>{}</td><td class="prose">{}</td></tr>)",
        escape(row.quantity), escape(row.place), escape(row.paper), escape(row.ours), escape(row.unit),
        erratum, agrees ? element("span", "unit", "they agree") : escape(row.why));
  }
  const std::string title = data.paper_title.empty() ? "" : ": " + data.paper_title;
  return section("paper", "Paper against ours" + title, out + kTableClose);
}

std::string checks_section(const std::vector<Check>& checks) {
  if (checks.empty()) return "";
  std::string out = table_open({{"State"}, {"Check"}, {"Result or reason"}}, "What was checked");
  for (const Check& check : checks) {
    const StateLook look = look_of(check.state);
    out += fmt::format(
        R"(<tr><td class="nowrap">{}{}</td><th scope="row">{}</th><td class="prose">{}{}</td></tr>)",
        symbol(look.symbol), look.word, escape(check.what), escape(check.result),
        element("span", "fix", check.reason));
  }
  return section("checks", "What was checked, and what was not", out + kTableClose);
}

std::string reproduce_section(const ReportData& data) {
  std::string out;
  if (!data.reproduce.empty()) {
    out += R"(<pre tabindex="0"><code>)";
    for (const std::string& command : data.reproduce) out += escape(command) + "\n";
    out += "</code></pre>";
  }
  if (!data.facts.empty()) out += "<div class=\"facts\">";
  for (const FactGroup& group : data.facts) {
    out += "<div><h3>" + escape(group.title) + "</h3><dl>";
    for (const Fact& fact : group.facts) {
      out += "<dt>" + escape(fact.name) + "</dt><dd>" + breakable(escape(fact.value)) + "</dd>";
    }
    out += "</dl></div>";
  }
  if (!data.facts.empty()) out += "</div>";
  return out.empty() ? "" : section("reproduce", "How to reproduce this", out);
}

}  // namespace swarf::reports

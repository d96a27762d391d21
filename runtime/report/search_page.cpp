#include "runtime/report/search_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/digit_groups.h"
#include "runtime/base/paths.h"
#include "runtime/base/percent.h"
#include "runtime/report/case_pictures.h"
#include "runtime/report/html_parts.h"
#include "runtime/report/interaction_map.h"
#include "runtime/report/page_template.h"
#include "runtime/report/tolerance_chart.h"
#include "runtime/search/search.h"
#include "runtime/search/shown_value.h"
#include "runtime/wire/base64.h"

namespace probe::report {
namespace {

constexpr const char* kContentPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; font-src data:; img-src data:; base-uri "
    "'none'; form-action 'none'";

std::string count_text(int count, const char* one, const char* many) {
  return digit_groups(static_cast<std::size_t>(count)) + " " + (count == 1 ? one : many);
}

// "88 %": rounded down.
std::string bound_text(double share) {
  return fmt::format("{} %", static_cast<int>(100 * std::clamp(share, 0.0, 1.0)));
}

// What the method looks for, as a heading.
std::string_view question_of(const std::string& method) {
  if (method == "boundary") return "How much of each change it stands";
  if (method == "worst") return "The smallest changes that break it";
  if (method == "minimal") return "Which changes of a case are needed";
  return "Which changes matter, and which two together";
}

std::string section_html(const std::string& id, std::string_view title, const std::string& body) {
  return "<section id=\"" + id + "\"><h2>" + html_text(title) + "</h2>\n" + body + "</section>\n";
}

// "policy, `around` of carrot_on_plate".
std::string subject_html(std::span<const SearchFindings> all, const SearchFindings& one) {
  return "<h3>" + html_name(policy_label(all, one)) + " <small class=\"sub\">space " +
         html_name(one.space) + " of " + html_name(one.task) + "</small></h3>\n";
}

std::string under_way(const SearchFindings& one) {
  return one.done ? ""
                  : "<p class=\"nothing\">This search is not done: the same command again, or with "
                    "more --budget, goes on.</p>\n";
}

// ---- worst cases
// ---------------------------------------------------------------------------------

std::string picture_html(const CasePicture& drawn, const std::string& alt) {
  if (drawn.png.empty()) return "";
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(drawn.png.data());
  return "<img alt=\"" + html_text(alt) + "\" src=\"data:image/png;base64," +
         wire::to_base64({bytes, drawn.png.size()}) + "\">";
}

std::string case_card(const std::string& title, const std::string& words, const CasePicture& drawn,
                      const std::string& figures) {
  std::string out = "<figure class=\"found\">" + picture_html(drawn, title + ": " + words);
  out += "<figcaption>" + html_text(title) + "</figcaption><p class=\"changes\">" +
         html_name(words) + "</p>";
  if (!drawn.instruction.empty())
    out += "<p class=\"prompt\">\xE2\x80\x9C" + html_text(drawn.instruction) + "\xE2\x80\x9D</p>";
  out += "<p class=\"figures\">" + figures + "</p>";
  if (!drawn.is_first)
    out += "<p class=\"sub\">pictured in the first start in which it is fair</p>";
  return out + "</figure>\n";
}

std::string worst_part(std::span<const SearchFindings> all, const SearchFindings& one,
                       const SearchPageOptions& options, std::vector<std::string>& notes) {
  std::string out = subject_html(all, one) + under_way(one);
  const auto confirmed = std::ranges::count_if(one.cases, &WorstCase::confirmed);
  if (confirmed == 0) {
    for (const std::string& line : one.lines) out += "<p>" + html_text(line) + "</p>\n";
    return out;
  }
  const CasePictures drawn = pictures_of(one, options.assets);
  if (!drawn.note.empty()) {
    notes.push_back(one.folder + ": " + drawn.note);
    out += "<p class=\"sub\">" + html_text(drawn.note) + "</p>\n";
  }
  out += "<div class=\"founds\">";
  out += case_card("the task itself", "nothing is changed", drawn.base,
                   "fails in <b>" + search::k_of_n(one.own_failures) + "</b> trials");
  for (std::size_t i = 0; i < one.cases.size(); ++i) {
    const WorstCase& found = one.cases[i];
    if (!found.confirmed) continue;
    out += case_card(fmt::format("case {}", i + 1), found.text, drawn.cases[i],
                     "fails in <b>" + search::k_of_n(found.failures) + "</b> fresh trials, in <b>" +
                         bound_text(found.at_least) + "</b> or more of all");
  }
  out += "</div>\n";
  std::string others;
  for (const WorstCase& found : one.cases) {
    if (!found.confirmed) others += "<li>" + html_text(found.sentence) + "</li>";
  }
  if (!others.empty())
    out += "<p>Found, but not confirmed by fresh trials:</p><ul class=\"findings\">" + others +
           "</ul>\n";
  return out;
}

// ---- minimal sets
// --------------------------------------------------------------------------------

std::string minimal_part(std::span<const SearchFindings> all, const SearchFindings& one) {
  std::string out = subject_html(all, one) + under_way(one);
  if (one.tried.empty()) return out;
  out += "<p class=\"verdict\">" + html_text(one.sentence) + "</p>\n";
  std::vector<std::vector<HtmlCell>> rows;
  for (const TriedSet& set : one.tried) {
    const bool fails = set.verdict == "fails";
    rows.push_back({{html_name(set.text)},
                    {search::k_of_n(set.failures), true},
                    {"<span class=\"" + std::string(fails ? "fails" : "none") + "\">" +
                     html_text(set.verdict) + "</span>"}});
  }
  return out + html_table("sets that were tried", {"changed", "trials that fail", ""}, rows) +
         "<p class=\"key\">In the order in which they were tried. Minimal: with any one change put "
         "back it does not fail. Of several such sets one is found.</p>\n";
}

// ---- what was searched
// ---------------------------------------------------------------------------

std::string left_out_part(const SearchFindings& one) {
  std::string out;
  for (const LeftOutReason& reason : one.reasons) {
    out += "<li>";
    if (reason.points > 0) out += count_text(reason.points, "point", "points");
    if (reason.in_part > 0)
      out += (reason.points > 0 ? ", and " : "") +
             count_text(reason.in_part, "point in some starts", "points in some starts");
    out += ", as: " + html_text(reason.example) + "</li>";
  }
  if (one.expert_unsolved && *one.expert_unsolved > 0)
    out += "<li>" + count_text(*one.expert_unsolved, "start", "starts") +
           " that the expert does not solve as things lie there</li>";
  if (one.expert_not_attempted && *one.expert_not_attempted > 0)
    out += "<li>" + count_text(*one.expert_not_attempted, "start", "starts") +
           " for which the expert has no skill</li>";
  return out.empty() ? "nothing" : "<ul>" + out + "</ul>";
}

std::string searched_part(std::span<const SearchFindings> all) {
  std::string out;
  for (const SearchFindings& one : all) {
    out += "<h3>" + html_name(policy_label(all, one)) + " <small class=\"sub\">" +
           html_text(one.method) + "</small></h3><dl class=\"facts\">";
    const auto fact = [&](const char* what, const std::string& html) {
      out += std::string("<dt>") + what + "</dt><dd>" + html + "</dd>";
    };
    fact("space", html_name(one.space) + " of " + html_name(one.task));
    fact("policy", html_name(one.policy) +
                       (one.policy_content.empty()
                            ? ""
                            : " <code>" + html_text(one.policy_content.substr(0, 16)) + "</code>"));
    fact("trials", count_text(one.trials, "trial", "trials") + ", " +
                       count_text(one.episodes, "episode", "episodes") + ", " +
                       count_text(one.left_out, "trial left out", "trials left out"));
    fact("left out", left_out_part(one));
    fact("fair", !one.proved ? "as the compiler sees it; the expert was not asked (--unproved)"
                 : one.expert_starts ? "the expert was asked in " + count_text(*one.expert_starts, "start", "starts") +
                           "; what it does not solve is left out"
                     : "the expert is asked");
    fact("seed", fmt::format("{}", one.seed));
    if (one.method == "boundary")
      fact("stated error", decimal_text(100 * one.error, 1) + " % of a side, half an interval");
    fact("text", "<code>" + html_text(one.file) + "</code> <code>" +
                     html_text(one.text_sha256.substr(0, 16)) + "</code>");
    fact("folder", "<code>" + html_text(one.folder) + "</code>");
    out += "</dl>\n";
    for (const std::string& note : one.notes) out += "<p class=\"sub\">" + html_text(note) + "</p>";
  }
  return out;
}

// ---- the page
// ------------------------------------------------------------------------------------

struct SearchPanel {
  std::string id, title, body;
};

std::vector<SearchPanel> search_panels(std::span<const SearchFindings> all,
                                       const SearchPageOptions& options,
                                       std::vector<std::string>& notes) {
  std::vector<SearchPanel> panels;
  std::string boundary, worst, minimal, axes;
  for (const ToleranceGroup& group : tolerance_groups(all)) {
    const SearchFindings& first = *group.searches.front();
    boundary += group.searches.size() == 1 ? subject_html(all, first)
                                           : "<h3>space " + html_name(first.space) + " of " +
                                                 html_name(first.task) + "</h3>\n";
    for (const SearchFindings* one : group.searches) boundary += under_way(*one);
    boundary += tolerance_chart(group, all);
  }
  for (const SearchFindings& one : all) {
    if (one.method == "worst") worst += worst_part(all, one, options, notes);
    if (one.method == "minimal") minimal += minimal_part(all, one);
    if (one.method == "axes")
      axes +=
          subject_html(all, one) + under_way(one) + (one.axes.empty() ? "" : interaction_map(one));
  }
  const auto add = [&](const char* id, const std::string& body, const char* lead) {
    if (!body.empty())
      panels.push_back({id, std::string(question_of(id)),
                        "<p class=\"lead\">" + std::string(lead) + "</p>\n" + body});
  };
  add("boundary", boundary,
      "Each change alone, from the task's own value on the left to the end of the space on the "
      "right: where success has fallen to half of what it is with nothing changed.");
  add("worst", worst,
      "Found by a search over all changes together, and confirmed by fresh trials that took no "
      "part in finding them.");
  add("minimal", minimal, "Changes of a case that fails, put back until none is left to spare.");
  add("axes", axes, "Points drawn over the whole space, each tried once.");
  panels.push_back({"searched", "What was searched", searched_part(all)});
  return panels;
}

// What was found, in a sentence each; shares of axes have a panel that says what they mean.
std::string findings_part(std::span<const SearchFindings> all) {
  std::string out;
  for (const SearchFindings& one : all) {
    std::vector<std::string> lines;
    for (const Tolerance& side : one.sides) {
      if (side.is_found())
        lines.push_back(side.side + ": success " + side.in_words() + " (" + side.interval() + ")");
    }
    for (const WorstCase& found : one.cases) {
      if (found.confirmed)
        lines.push_back(found.text + ": fails in " + search::k_of_n(found.failures) +
                        " fresh trials, in " + bound_text(found.at_least) + " or more of all");
    }
    if (!one.sentence.empty()) lines.push_back(one.sentence);
    for (const AxisShare& axis : one.axes) {
      if (axis.matters)
        lines.push_back(axis.axis + " matters: " + axis.side + " " + search::k_of_n(axis.there) +
                        " fail, elsewhere " + search::k_of_n(axis.elsewhere));
    }
    for (const PairShare& pair : one.pairs) {
      if (pair.named)
        lines.push_back(
            pair.a + " and " + pair.b + (pair.synergy ? " work together" : " undo one another") +
            ": " + pair.side_a + " and " + pair.side_b + " " + search::k_of_n(pair.both) + " fail");
    }
    if (lines.empty()) lines.emplace_back("nothing that breaks it was found");
    out += "<li><b>" + html_name(policy_label(all, one)) + "</b> <span class=\"none\">" +
           html_text(one.method) + "</span><ul>";
    constexpr std::size_t kAtOnce = 4;
    for (std::size_t i = 0; i < std::min(kAtOnce, lines.size()); ++i)
      out += "<li>" + html_text(lines[i]) + "</li>";
    if (lines.size() > kAtOnce) out += fmt::format("<li>and {} more</li>", lines.size() - kAtOnce);
    out += "</ul></li>\n";
  }
  return "<h2>What was found</h2><ul class=\"summary-list\">" + out + "</ul>\n";
}

}  // namespace

Result<bool> are_searches(const std::vector<std::string>& dirs) {
  const auto search = std::ranges::find_if(dirs, search::is_search);
  if (search == dirs.end()) return false;
  const auto other = std::ranges::find_if_not(dirs, search::is_search);
  if (other == dirs.end()) return true;
  return Failure{Fault::kUsage,
                 "`" + *search + "` is a search's folder, `" + *other +
                     "` is not: they are reported and compared apart, as rates of what a search "
                     "chose are none of a suite",
                 ""};
}

Result<std::vector<SearchFindings>> load_searches(const std::vector<std::string>& dirs) {
  std::vector<SearchFindings> searches;
  std::vector<std::string> seen;
  for (const std::string& dir : dirs) {
    if (std::ranges::any_of(seen, [&](const std::string& other) { return is_same(other, dir); }))
      continue;
    seen.push_back(dir);
    PROBE_ASSIGN(SearchFindings found, read_findings(dir));
    searches.push_back(std::move(found));
  }
  return searches;
}

SearchPage search_page(std::span<const SearchFindings> searches, const SearchPageOptions& options) {
  SearchPage page;
  for (const SearchFindings& one : searches)
    page.notes.insert(page.notes.end(), one.notes.begin(), one.notes.end());
  const std::string title = options.title.empty() ? "Where does it break?" : options.title;
  const std::vector<SearchPanel> panels = search_panels(searches, options, page.notes);
  std::string& out = page.html;
  out =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
      std::string(kContentPolicy) +
      "\">\n<meta name=\"referrer\" content=\"no-referrer\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
      html_text(title) +
      "</title>\n<!-- Contains the typeface Inter (SIL Open Font License 1.1). -->\n<style>";
  for (const std::string_view piece : page_style()) out += piece;
  for (const std::string_view piece : searches_style()) out += piece;
  out +=
      "</style>\n</head>\n<body><a class=\"skip\" href=\"#main\">To the findings</a>\n"
      "<div id=\"page\"><aside><a class=\"brand\" href=\"#main\">vlaprobe</a><nav><ol>";
  for (const SearchPanel& panel : panels)
    out += "<li><a href=\"#" + panel.id + "\">" + html_text(panel.title) + "</a></li>";
  out +=
      "</ol></nav></aside>\n<main id=\"main\" tabindex=\"-1\"><header class=\"opening\">"
      "<p class=\"brand\">vlaprobe</p><h1>" +
      html_text(title) + "</h1>" + findings_part(searches) + "</header>\n";
  for (const SearchPanel& panel : panels) out += section_html(panel.id, panel.title, panel.body);
  out += "<footer>" + html_text(options.program) + " <code class=\"long\">" +
         html_text(options.command) + "</code></footer></main></div>\n</body>\n</html>\n";
  return page;
}

Json search_page_json(std::span<const SearchFindings> searches, const SearchPageOptions& options) {
  Json list = Json::array();
  for (const SearchFindings& one : searches) {
    Json reasons = Json::array();
    for (const LeftOutReason& reason : one.reasons)
      reasons.push_back({{"code", reason.code},
                         {"example", reason.example},
                         {"points", reason.points},
                         {"points_in_some_starts", reason.in_part}});
    list.push_back({{"folder", one.folder},
                    {"label", policy_label(searches, one)},
                    {"left_out_because", std::move(reasons)},
                    {"search", one.json}});
  }
  return {{"format", "vlaprobe-search-report"},
          {"version", 1},
          {"title", options.title},
          {"command", options.command},
          {"program", options.program},
          {"searches", std::move(list)}};
}

}  // namespace probe::report

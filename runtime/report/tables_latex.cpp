// Tables as a LaTeX document, in the layout of the paper's.
#include <fmt/format.h>

#include "runtime/base/percent.h"
#include "runtime/report/categories.h"
#include "runtime/report/page_data.h"
#include "runtime/report/published_match.h"
#include "runtime/report/table_parts.h"

namespace probe::report {
namespace {

std::string tex(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\textbackslash{}";
        break;
      case '~':
        out += "\\textasciitilde{}";
        break;
      case '^':
        out += "\\textasciicircum{}";
        break;
      case '<':
        out += "\\textless{}";
        break;
      case '>':
        out += "\\textgreater{}";
        break;
      case '|':
        out += "\\textbar{}";
        break;
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        out += '\\';
        out += c;
        break;
      default:
        // Control characters have no glyph; everything else is UTF-8, which LaTeX reads.
        if (static_cast<unsigned char>(c) >= 0x20) out += c;
    }
  }
  return out;
}

// The rate above, count and interval below, small.
std::string tex_cell(const std::optional<Estimate>& e) {
  if (!e) return "--";
  return fmt::format("\\cell{{{}}}{{{}/{}}}{{{}}}", rate_text(*e),
                     e->count.k, e->count.n,
                     percent_range(e->interval.low, e->interval.high, "--"));
}

std::string tex_main(const Benchmark& benchmark, const Tables& tables,
                     const std::vector<PublishedTable>& published) {
  const std::size_t columns = benchmark.categories.size() + 1;
  std::string text = "\\begin{table}\n\\centering\\footnotesize\n\\begin{tabular}{ll" +
                     std::string(columns, 'r') + "}\n\\toprule\npolicy & metric & avg";
  for (const Category& c : benchmark.categories) text += " & \\head{" + tex(c.label) + "}";
  text += " \\\\\n";
  int last = kAbsent;
  for (const MainRow& row : tables.main) {
    if (row.policy != last) text += "\\midrule\n";
    text += (row.policy == last ? std::string() : tex(policy_label(benchmark, row.policy))) +
            " & " + tex(metric_name(benchmark, row.metric));
    last = row.policy;
    for (const auto& cell : cells_of(row)) text += " & " + tex_cell(cell);
    text += " \\\\\n";
  }
  const std::vector<std::string> names = column_names(benchmark);
  const auto [tasks, per_task] = published_sizes(benchmark);
  bool flagged = false;
  for (const PublishedTable& table : published) {
    const auto columns_of = matched_columns(benchmark, table);
    text += fmt::format(
        "\\midrule\n\\multicolumn{{{}}}{{l}}{{\\emph{{published, without counts: {}}}}} "
        "\\\\\n",
        columns + 2, tex(table.source));
    std::string policy;
    for (const PublishedRow& row : table.rows) {
      text += (row.policy == policy ? std::string() : tex(row.policy)) + " & " + tex(row.metric);
      policy = row.policy;
      for (std::size_t c = 0; c < names.size(); ++c) {
        const auto cell = published_cell(row, columns_of[c]);
        text += " & " + (cell ? tex(cell->text) : "--");
        if (cell && impossible(*cell, tasks[c], per_task)) {
          text += "\\rlap{\\textsuperscript{?}}";
          flagged = true;
        }
      }
      text += " \\\\\n";
    }
  }
  return text + "\\bottomrule\n\\end{tabular}\n\\caption{Percent of " +
         std::string(benchmark.things) +
         "; below, the count and "
         "the 95\\,\\% interval." +
         (benchmark.has_adaptive()
              ? " " + tex(adaptive_interval_text()) +
                    " Differences of these policies are left out, since tests of a fixed number of "
                    "episodes do not allow for it."
              : std::string()) +
         (flagged ? std::string(" ?: no count of so many episodes gives this percentage.") : "") +
         "}\n\\end{table}\n";
}

std::string tex_count(const stats::Count& count) {
  return fmt::format("{} {{\\tiny {}/{}}}", percent_text(count.k, count.n), count.k, count.n);
}

// "$-1.3$ to $+4.0$"
std::string tex_range(const stats::Interval& interval) {
  return fmt::format("${}$ to ${}$", decimal_text(100 * interval.low, 1),
                     decimal_text(100 * interval.high, 1));
}

// Policies in pairs, over all tasks.
std::string tex_policies(const Benchmark& benchmark, const Tables& tables) {
  std::string rows;
  for (const PolicyRow& row : tables.policies) {
    if (row.category != kAbsent) continue;
    const Contrast& c = row.contrast;
    rows +=
        fmt::format("{} & {} & {} & {} & {} & ${}$ & {} & {:.2g} & {} & {:.2g} \\\\\n",
                    tex(metric_name(benchmark, row.metric)), tex(policy_label(benchmark, row.a)),
                    tex(policy_label(benchmark, row.b)), tex_count(c.first), tex_count(c.second),
                    signed_text(100 * c.difference, 1), tex_range(c.here.interval), c.here.adjusted,
                    tex_range(c.anew.interval), c.anew.adjusted);
  }
  if (rows.empty()) return "";
  return "\\begin{longtable}{lllrrrrrrr}\n\\toprule\n"
         "& & & & & & \\multicolumn{2}{c}{on these starts} & \\multicolumn{2}{c}{for starts never "
         "tried} \\\\\n"
         "metric & policy & against & & & points & 95\\,\\% & $p$ & 95\\,\\% & $p$ \\\\\n"
         "\\midrule\n\\endhead\n" +
         rows +
         "\\bottomrule\n\\caption{Policies in pairs on the same starts, exact tests after Holm. On "
         "these starts: the policies exchanged start by start; for starts never tried: places of "
         "start drawn anew.}\n\\end{longtable}\n";
}

std::string tex_differences(const Benchmark& benchmark, const Tables& tables, bool language) {
  const std::string head =
      "policy & metric & category & baseline & variant & points (95\\,\\%) & $p$, these & $p$, new "
      "\\\\\n";
  std::string text = "\\begin{longtable}{lllrrrrr}\n\\toprule\n" + head +
                     "\\endfirsthead\n\\toprule\n" + head + "\\midrule\n\\endhead\n";
  int policy = kAbsent, metric = kAbsent;
  for (const CategoryDeltaRow& row : tables.category_deltas) {
    if (is_worded(benchmark, row.category) != language) continue;
    if (row.policy != policy) {
      text += "\\midrule\n";
      metric = kAbsent;
    }
    const Contrast& c = row.contrast;
    text +=
        fmt::format("{} & {} & {} & {} & {} & ${}$ ({}) & {:.2g} & {:.2g} \\\\\n",
                    row.policy == policy ? std::string() : tex(policy_label(benchmark, row.policy)),
                    row.metric == metric ? std::string() : tex(metric_name(benchmark, row.metric)),
                    tex(benchmark.categories[static_cast<std::size_t>(row.category)].label),
                    tex_count(c.second), tex_count(c.first), signed_text(100 * c.difference, 1),
                    tex_range(c.anew.interval), c.here.adjusted, c.anew.adjusted);
    policy = row.policy;
    metric = row.metric;
  }
  if (policy == kAbsent) return "";
  return text + "\\bottomrule\n\\caption{" +
         (language ? "Language variation" : "Variation of objects and scene") +
         ": variants beside their own baselines on the same starts. Exact tests, after Holm: on "
         "these starts ($p$, these) and, as the interval, for starts never tried ($p$, new).}\n"
         "\\end{longtable}\n";
}

// What models know of the starts of policies.
std::string tex_knows(const Benchmark& benchmark, const Knowledge& knowledge) {
  std::string rows;
  for (const KnowsRow& row : knowledge.knows) {
    if (row.category != kAbsent) continue;
    const Contrast& c = row.contrast;
    rows += fmt::format(
        "{} & {} & {} & {} & {} & {} & {} & {} & ${}$ & {} & {:.2g} & {} & {:.2g} \\\\\n",
        tex(benchmark.models[static_cast<std::size_t>(row.model)].label),
        tex(policy_label(benchmark, row.policy)), tex(question_name(benchmark, row)), row.counts[7],
        row.counts[6], row.with(true, false), row.with(false, true), row.with(false, false),
        signed_text(100 * c.difference, 1), tex_range(c.here.interval), c.here.adjusted,
        tex_range(c.anew.interval), c.anew.adjusted);
  }
  if (rows.empty()) return "";
  return "\\begin{longtable}{lllrrrrrrrrrr}\n\\toprule\n"
         "& & & \\multicolumn{3}{c}{knows} & \\multicolumn{2}{c}{does not know} & & "
         "\\multicolumn{2}{c}{on these starts} & \\multicolumn{2}{c}{for starts never tried} "
         "\\\\\n"
         "model & policy & question & does & fails & elsewhere & goes & elsewhere & points & "
         "95\\,\\% & $p$ & 95\\,\\% & $p$ \\\\\n\\midrule\n\\endhead\n" +
         rows +
         "\\bottomrule\n\\caption{Episodes by whether the model names the right object and the "
         "policy goes for it; points: knows less goes, on the same starts. Exact tests after "
         "Holm.}\n\\end{longtable}\n";
}

std::string tex_tables(const Benchmark& benchmark, const Tables& tables,
                       const std::vector<PublishedTable>& published) {
  return tex_main(benchmark, tables, published) + tex_policies(benchmark, tables) +
         tex_differences(benchmark, tables, true) + tex_differences(benchmark, tables, false);
}

// What stands beside the answers that are right in every order, over all tasks: a line a model and
// family, a column a rate.
std::string tex_rates(const Benchmark& benchmark, const AskedTables& asked) {
  std::string rows;
  const RateRow* last = nullptr;
  std::size_t column = 0;
  const auto fill = [&](std::size_t to) {
    for (; column < to; ++column) rows += " & --";
  };
  for (const RateRow& row : asked.rates) {
    if (last == nullptr || row.model != last->model || row.question != last->question) {
      if (last != nullptr) {
        fill(kRateKinds.size());
        rows += " \\\\\n";
      }
      rows += tex(benchmark.models[static_cast<std::size_t>(row.model)].label) + " & " +
              tex(row.question);
      column = 0;
    }
    last = &row;
    fill(static_cast<std::size_t>(row.kind - kRateKinds.data()));
    const auto& cell = row.cells.front();
    rows += " & " + (!cell           ? "--"
                     : cell->counted ? tex_cell(cell->counted)
                                     : decimal_text(100 * cell->share, 1));
    ++column;
  }
  if (last == nullptr) return "";
  fill(kRateKinds.size());
  std::string heads;
  for (const RateKind& kind : kRateKinds) heads += fmt::format(" & {}", kind.head);
  return "\\begin{longtable}{ll" + std::string(kRateKinds.size(), 'r') +
         "}\n\\toprule\nmodel & question" + heads + " \\\\\n\\midrule\n\\endhead\n" + rows +
         " \\\\\n\\bottomrule\n\\caption{Beside the answers that are right in every order of the "
         "options: those to one order, by which right letters are balanced; in every order the "
         "letters to which the server gives the largest probability; those in every order without "
         "the picture and with that of another start; and what any answer, each as likely, "
         "gets in every order. Percent, the count and the 95\\,\\% interval; what is computed has "
         "no count.}\n\\end{longtable}\n";
}

}  // namespace

std::string tables_latex(const TablesToPrint& print) {
  const Benchmark& benchmark = print.benchmark;
  std::string body =
      benchmark.policies.empty() ? "" : tex_tables(benchmark, print.tables, print.published);
  if (print.asked != nullptr) {
    const AskedTables& asked = *print.asked;
    body += tex_tables(asked.benchmark, asked.tables, {}) + tex_rates(benchmark, asked) +
            tex_knows(benchmark, asked.knowledge);
  }
  return "\\documentclass{article}\n\\usepackage[T1]{fontenc}\n\\usepackage[utf8]{inputenc}\n"
         "\\usepackage{booktabs,longtable}\n\\usepackage[margin=15mm,papersize={420mm,594mm}]{"
         "geometry}"
         "\n"
         "% rate, count, interval\n"
         "\\newcommand{\\cell}[3]{\\begin{tabular}[t]{@{}r@{}}#1\\\\[-3pt]{\\tiny #2}\\\\[-4pt]"
         "{\\tiny #3}\\end{tabular}}\n"
         "\\newcommand{\\head}[1]{\\begin{tabular}[b]{@{}r@{}}#1\\end{tabular}}\n"
         "\\begin{document}\n" +
         body + "\\end{document}\n";
}

}  // namespace probe::report

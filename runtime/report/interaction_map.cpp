#include "runtime/report/interaction_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/base/percent.h"
#include "runtime/report/html_parts.h"
#include "runtime/search/shown_value.h"

namespace probe::report {
namespace {

std::string percent_of_share(double share) { return decimal_text(100 * share, 0) + " %"; }

// "below 0.35" of "light.ambient below 0.35": in a matrix the axis stands at the side.
std::string without_axis(const std::string& side, const std::string& axis) {
  return side.starts_with(axis + " ") ? side.substr(axis.size() + 1) : side;
}

std::string diagonal_cell(const AxisShare& axis) {
  const int shade = std::clamp(static_cast<int>(axis.first * 5 + 0.5), 0, 5);
  std::string out = fmt::format("<td class=\"own shade{}{}\">", axis.matters ? shade : 0,
                                axis.matters ? " matters" : "");
  out += "<b>" + percent_of_share(axis.first) + "</b><small>" +
         percent_range(axis.first_interval.low, axis.first_interval.high, " to ") + "</small>";
  if (axis.matters) out += "<span>" + html_text(without_axis(axis.side, axis.axis)) + "</span>";
  return out + "</td>";
}

std::string pair_cell(const PairShare& pair) {
  if (!pair.named)
    return pair.tested ? "<td class=\"pair\"><small>\xC2\xB7</small></td>"
                       : "<td class=\"pair\"><small>not tested</small></td>";
  return fmt::format("<td class=\"pair named {}\"><b>{}</b><span>{}</span><span>{}</span></td>",
                     pair.synergy ? "together" : "undo",
                     pair.synergy ? "together" : "undo one another", html_name(pair.side_a),
                     html_name(pair.side_b));
}

const PairShare* pair_of(const SearchFindings& found, const std::string& a, const std::string& b) {
  const auto at = std::ranges::find_if(found.pairs, [&](const PairShare& pair) {
    return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
  });
  return at == found.pairs.end() ? nullptr : &*at;
}

std::string interaction_matrix(const SearchFindings& found) {
  std::string out =
      "<div class=\"scroller\" tabindex=\"0\" role=\"region\" aria-label=\"interaction map\">"
      "<table class=\"interactions\"><thead><tr><td></td>";
  for (const AxisShare& axis : found.axes)
    out += "<th scope=\"col\">" + html_name(axis.axis) + "</th>";
  out += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < found.axes.size(); ++i) {
    out += "<tr><th scope=\"row\">" + html_name(found.axes[i].axis) + "</th>";
    for (std::size_t j = 0; j < i; ++j) {
      const PairShare* const pair = pair_of(found, found.axes[i].axis, found.axes[j].axis);
      out += pair == nullptr ? "<td class=\"pair\"></td>" : pair_cell(*pair);
    }
    out += diagonal_cell(found.axes[i]);
    for (std::size_t j = i + 1; j < found.axes.size(); ++j) out += "<td></td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string pairs_in_words(const SearchFindings& found) {
  std::string out;
  for (const PairShare& pair : found.pairs) {
    if (!pair.named) continue;
    out += "<li><b>" + html_text(pair.a) + "</b> and <b>" + html_text(pair.b) + "</b> " +
           (pair.synergy ? "work together" : "undo one another") + ": " + html_text(pair.side_a) +
           " and " + html_text(pair.side_b) + " fail " + search::k_of_n(pair.both) +
           ", one of the two alone " + search::k_of_n(pair.only_a) + " and " +
           search::k_of_n(pair.only_b) + ", neither " + search::k_of_n(pair.neither) +
           fmt::format(" (p = {:.2g}).</li>", pair.p);
  }
  if (out.empty())
    return "<p>No two axes are found to matter together, which does not say that none do.</p>\n";
  return "<ul class=\"findings\">" + out + "</ul>\n";
}

std::string axes_table(const SearchFindings& found) {
  std::vector<std::vector<HtmlCell>> rows;
  for (const AxisShare& axis : found.axes) {
    const std::string total = total_text(axis);
    rows.push_back(
        {{html_name(axis.axis)},
         {axis.matters ? "<b>matters</b>" : "<span class=\"none\">no effect shown</span>"},
         {axis.matters ? html_text(axis.side) : ""},
         {axis.matters ? search::k_of_n(axis.there) : "", true},
         {axis.matters ? search::k_of_n(axis.elsewhere) : "", true},
         {fmt::format("{:.2g}", axis.p), true},
         {percent_of_share(axis.first) + " <small>" +
              percent_range(axis.first_interval.low, axis.first_interval.high, " to ") + "</small>",
          true},
         {total.empty() ? "<span class=\"none\">not told</span>" : total, true}});
  }
  return html_table("what each axis explains",
                    {"axis", "", "where it fails", "fails there", "elsewhere", "p",
                     "explains, in parts", "with its pairs"},
                    rows);
}

}  // namespace

std::string total_text(const AxisShare& axis) {
  // Rounded down: it is a bound.
  const int low = static_cast<int>(100 * std::clamp(axis.total_interval.low, 0.0, 1.0));
  return axis.matters && low > 0 ? fmt::format("at least {} %", low) : "";
}

std::string interaction_map(const SearchFindings& found) {
  std::string out = "<p class=\"lead\">" + search::k_of_n(found.failures) +
                    " trials, drawn over the whole space, fail. On the diagonal: what of that an "
                    "axis explains by itself, and where it fails if it matters. Below it: pairs "
                    "that are named, with the sides at which they are told best; a dot is a pair "
                    "without a finding, and of some the points that were left out let nothing be "
                    "said.</p>\n";
  out += interaction_matrix(found) + pairs_in_words(found) + axes_table(found);
  out +=
      "<p class=\"key\">Shares are of an axis that is cut into eight parts at most, with intervals "
      "of 95 %; of the axis itself they are no upper bound, so what it explains with its pairs is "
      "said as \xE2\x80\x9C"
      "at least\xE2\x80\x9D. All of the trials that count: where points "
      "were left out, of what remains of the space. p values are Holm's, over the axes, and over "
      "the "
      "pairs.</p>\n";
  return out;
}

}  // namespace probe::report

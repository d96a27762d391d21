#include "runtime/report/tolerance_chart.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/report/html_parts.h"
#include "runtime/search/shown_value.h"

namespace probe::report {
namespace {

double percent_along(const Tolerance& side, double value) {
  return 100 * search::share_of_side(side.axis, side.own, side.end, value);
}

std::string bar_of(const char* name, double from, double to, double y, double height) {
  return fmt::format("<rect class=\"{}\" x=\"{:.2f}%\" y=\"{}\" width=\"{:.2f}%\" height=\"{}\"/>",
                     name, from, y, std::max(0.0, to - from), height);
}

// Lengths in per cent, so that the track is as wide as there is room and round marks stay round.
// The half of the track in which success is above half is filled.
std::string track_svg(const Tolerance& side) {
  std::string out =
      "<svg class=\"stands\" width=\"100%\" height=\"20\" role=\"img\" aria-label=\"" +
      html_text(side.side + ": " + side.in_words()) + "\">";
  out += bar_of("ground", 0, 100, 6, 8);
  const double fair = percent_along(side, side.last_fair);
  if (side.is_found()) {
    out += bar_of("whole", 0, percent_along(side, *side.near), 6, 8);
    out += bar_of("doubt", percent_along(side, *side.near), percent_along(side, *side.far), 6, 8);
  } else if (side.status == "no fall") {
    out += bar_of("whole", 0, fair, 6, 8);
  } else if (side.status == "undecided" && side.near) {
    out += bar_of("doubt", percent_along(side, *side.near), percent_along(side, *side.far), 6, 8);
  }
  if (fair < 99.5) out += bar_of("unfair", fair, 100, 6, 8);
  if (side.is_found()) {
    // Ends of the interval, and the tolerance itself.
    for (const double end : {*side.near, *side.far})
      out += fmt::format("<line x1=\"{0:.2f}%\" x2=\"{0:.2f}%\" y1=\"2\" y2=\"18\"/>",
                         percent_along(side, end));
    out += fmt::format("<circle cx=\"{:.2f}%\" cy=\"10\" r=\"5\"/>", percent_along(side, *side.at));
  }
  return out + "</svg>";
}

const Tolerance* side_like(const SearchFindings& search, const Tolerance& like) {
  const auto found = std::ranges::find_if(search.sides, [&](const Tolerance& side) {
    return side.axis == like.axis && side.up == like.up;
  });
  return found == search.sides.end() ? nullptr : &*found;
}

// Every side that one of the searches has.
std::vector<const Tolerance*> sides_of(const ToleranceGroup& group) {
  std::vector<const Tolerance*> sides;
  for (const SearchFindings* search : group.searches) {
    for (const Tolerance& side : search->sides) {
      const bool is_known = std::ranges::any_of(sides, [&](const Tolerance* known) {
        return known->axis == side.axis && known->up == side.up;
      });
      if (!is_known) sides.push_back(&side);
    }
  }
  return sides;
}

std::string side_row(const Tolerance& like, const ToleranceGroup& group,
                     std::span<const SearchFindings> all) {
  std::string out = "<div class=\"side\"><h4>" + html_name(like.side) + "</h4>";
  const auto scale = [&](const Tolerance& side) {
    return "<div class=\"scale\"><span>" + html_text(side.text_of(side.own)) + "</span><span>" +
           html_text(side.text_of(side.end)) + "</span></div>";
  };
  for (const SearchFindings* search : group.searches) {
    const Tolerance* const side = side_like(*search, like);
    out += "<div class=\"who\">" +
           (group.searches.size() > 1 ? html_name(policy_label(all, *search)) : "") + "</div>";
    if (side == nullptr) {
      out += "<div class=\"none\">not searched</div><div></div>";
      continue;
    }
    out += track_svg(*side) + "<div class=\"words" + (side->is_found() ? " told" : "") + "\">" +
           html_text(side->in_words());
    if (side->is_found()) out += " <small>" + html_text(side->interval()) + "</small>";
    if (percent_along(*side, side->last_fair) < 99.5 && side->status != "left out") {
      out += " <small>nothing beyond " + html_text(side->text_of(side->last_fair)) +
             " is fair</small>";
    }
    out += "</div>";
  }
  return out + scale(like) + "</div>\n";
}

std::string tolerance_table(const ToleranceGroup& group, std::span<const SearchFindings> all) {
  std::vector<std::vector<HtmlCell>> rows;
  for (const Tolerance* like : sides_of(group)) {
    for (const SearchFindings* search : group.searches) {
      const Tolerance* const side = side_like(*search, *like);
      if (side == nullptr) continue;
      rows.push_back({{html_name(side->side)},
                      {html_name(policy_label(all, *search))},
                      {html_text(side->text_of(side->own)), true},
                      {html_text(side->text_of(side->end)), true},
                      {html_text(side->text_of(side->last_fair)), true},
                      {fmt::format("{} of {}", side->own_success.k, side->own_success.n), true},
                      {fmt::format("{}", side->trials), true},
                      {fmt::format("{}", side->left_out), true},
                      {html_text(side->sentence)}});
    }
  }
  return html_details("as a table", html_table("tolerances",
                                               {"change", "policy", "own value", "end of the space",
                                                "last that is fair", "succeed unchanged", "trials",
                                                "left out", "in words"},
                                               rows));
}

}  // namespace

std::vector<ToleranceGroup> tolerance_groups(std::span<const SearchFindings> searches) {
  std::vector<ToleranceGroup> groups;
  for (const SearchFindings& one : searches) {
    if (one.method != "boundary") continue;
    const auto at = std::ranges::find_if(groups, [&](const ToleranceGroup& group) {
      const SearchFindings& first = *group.searches.front();
      return first.text_sha256 == one.text_sha256 && first.space == one.space &&
             first.task == one.task;
    });
    if (at == groups.end()) {
      groups.push_back({{&one}});
    } else {
      at->searches.push_back(&one);
    }
  }
  return groups;
}

std::string policy_label(std::span<const SearchFindings> searches, const SearchFindings& one) {
  const auto alike = std::ranges::count_if(searches, [&](const SearchFindings& other) {
    return other.policy == one.policy && other.method == one.method && &other != &one;
  });
  return alike == 0 ? one.policy : one.policy + " (" + one.folder + ")";
}

std::string tolerance_chart(const ToleranceGroup& group, std::span<const SearchFindings> all) {
  std::string out = "<figure class=\"tolerances\">";
  for (const Tolerance* side : sides_of(group)) out += side_row(*side, group, all);
  out += "</figure>\n";
  out +=
      "<ul class=\"stands-key\"><li><i class=\"whole\"></i>success above half of what it is "
      "unchanged</li><li><i class=\"doubt\"></i>where it falls to half: interval of 95 %, the dot "
      "its middle</li><li><i class=\"unfair\"></i>nothing fair to try</li></ul>";
  return out + tolerance_table(group, all);
}

}  // namespace probe::report

#include "runtime/report/html_parts.h"

#include "runtime/base/printable.h"
#include "runtime/base/xml_text.h"

namespace probe::report {

std::string html_text(std::string_view text) { return xml_text(shown(text)); }

std::string html_name(std::string_view name) {
  std::string out;
  const std::string text = html_text(name);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    out += c;
    // Not within 0.12.
    const bool is_point = i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
    if ((c == '.' && !is_point) || c == '_' || c == '/') out += "<wbr>";
  }
  return out;
}

std::string html_table(std::string_view label, const std::vector<std::string>& heads,
                       const std::vector<std::vector<HtmlCell>>& rows) {
  std::string out = "<div class=\"scroller\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                    html_text(label) + "\"><table class=\"plain\"><thead><tr>";
  for (const std::string& head : heads) out += "<th scope=\"col\">" + html_text(head) + "</th>";
  out += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const char* const number = row[i].is_number ? " class=\"number\"" : "";
      out += i == 0 ? "<th scope=\"row\">" + row[i].html + "</th>"
                    : "<td" + std::string(number) + ">" + row[i].html + "</td>";
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string html_details(std::string_view summary, std::string_view html) {
  return "<details><summary>" + html_text(summary) + "</summary>" + std::string(html) +
         "</details>\n";
}

}  // namespace probe::report

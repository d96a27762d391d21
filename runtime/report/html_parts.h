// Pieces of a page that is written here, not by a script: every text goes through html_text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace probe::report {

// Between tags and in double quotes, whatever the text holds: markup is text, and nothing orders
// text anew or hides.
std::string html_text(std::string_view text);

// html_text, with leave to break a line behind dots, underscores and slashes.
std::string html_name(std::string_view name);

struct HtmlCell {
  std::string html;  // escaped already
  bool is_number = false;
};
// A table in a frame that scrolls sideways; `label` is for screen readers. The first cell of a row
// is its head.
std::string html_table(std::string_view label, const std::vector<std::string>& heads,
                       const std::vector<std::vector<HtmlCell>>& rows);

// A closed part that opens on a click.
std::string html_details(std::string_view summary, std::string_view html);

}  // namespace probe::report

// The report as one file: the bundled page with the results inside. Knows nothing of what the
// results say; PAGE_DATA.md does.
#pragma once

#include <string>
#include <string_view>

namespace probe::report {

// Three JSON texts, see PAGE_DATA.md.
struct PageDocuments {
  std::string data;
  std::string timelines = "{}";
  std::string whys = "{}";
};

// JSON that stays JSON and cannot end the script element it stands in: <, >, & and the two line
// separators of Unicode, which in JSON occur only inside texts, become \u escapes. Bytes that are
// no UTF-8 become U+FFFD.
std::string embeddable(std::string_view json);

// The whole page.
std::string write_page(const PageDocuments& documents);

}  // namespace probe::report

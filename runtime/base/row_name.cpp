#include "runtime/base/row_name.h"

#include "runtime/base/printable.h"
#include "runtime/base/utf8.h"

namespace probe {

Status check_row_name(const std::string& name) {
  constexpr std::size_t kMost = 255;
  std::string defect;
  if (is_blank(name)) {
    defect = "is blank";
  } else if (name.size() > kMost) {
    defect = "has " + std::to_string(name.size()) + " bytes, the most are " + std::to_string(kMost);
  } else if (!is_printable(name)) {
    defect = "holds what is no UTF-8, a line break or a character that nobody sees";
  } else if (name.front() == ' ' || name.back() == ' ') {
    defect = "begins or ends with a blank";
  }
  if (defect.empty()) return {};
  return Failure{Fault::kUsage,
                 "the name `" + printable(name, kMost) + "` " + defect +
                     ": rows need one that is told from others by reading it",
                 "--name"};
}

bool reads_alike(std::string_view a, std::string_view b) {
  return fold_case(compatible_form(a)) == fold_case(compatible_form(b));
}

}  // namespace probe

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

Failure name_taken(const std::string& name, const std::string& kind, const std::string& asked) {
  const std::string of = asked.empty() ? "the caller's " + kind : "`" + asked + "`";
  return {Fault::kUsage,
          "`" + name + "` reads as a " + kind +
              " of the program's own, whose rows could not be told from those of " + of +
              ": give it another name",
          "--name"};
}

bool reads_alike(std::string_view a, std::string_view b) {
  return fold_case(compatible_form(a)) == fold_case(compatible_form(b));
}

}  // namespace probe

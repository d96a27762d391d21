#include "compiler/names/texts.h"

#include <fmt/format.h>

#include "runtime/base/utf8.h"
#include "runtime/plan/limits.h"
#include "runtime/plan/text_rule.h"

namespace probe::sema {

std::string defect_of(std::string_view text) {
  if (const char* defect = plan::find_text_defect(text)) return defect;
  // A plan may hold it, but whoever wrote it does not know.
  if (const auto code = find_invisible(text))
    return fmt::format("holds the invisible character U+{:04X}", static_cast<std::uint32_t>(*code));
  return {};
}

void check_text(Diagnostics& diagnostics, const Spelled& text, std::string_view what) {
  if (text.text.size() > plan::kMaxStringBytes) {
    diagnostics.report(Situation::kTextTooLong, text.span,
                       std::string(what) + " has " + std::to_string(text.text.size()) +
                           " bytes, at most " + std::to_string(plan::kMaxStringBytes) +
                           " are kept");
  } else if (const std::string defect = defect_of(text.text); !defect.empty()) {
    diagnostics.report(Situation::kTextForm, text.span, std::string(what) + " " + defect);
  }
}

void check_name(Diagnostics& diagnostics, const syntax::Name& name) {
  if (name.text.size() <= plan::kMaxNameBytes) return;
  diagnostics.report(Situation::kTextTooLong, name.span,
                     "a name has at most " + std::to_string(plan::kMaxNameBytes) +
                         " bytes, found " + std::to_string(name.text.size()));
}

}  // namespace probe::sema

#include "compiler/names/texts.h"

#include "runtime/plan/limits.h"
#include "runtime/plan/text_rule.h"

namespace probe::sema {

void check_text(Diagnostics& diagnostics, const Spelled& text, std::string_view what) {
  if (text.text.size() > plan::kMaxStringBytes) {
    diagnostics.report(Situation::kTextTooLong, text.span,
                       std::string(what) + " has " + std::to_string(text.text.size()) +
                           " bytes, at most " + std::to_string(plan::kMaxStringBytes) +
                           " are kept");
  } else if (const char* defect = plan::find_text_defect(text.text)) {
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

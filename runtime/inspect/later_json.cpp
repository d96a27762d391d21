#include "runtime/inspect/later_json.h"

#include <vector>

#include "runtime/plan/ids.h"
#include "runtime/plan/later.h"

namespace probe::inspect {
namespace {

// A condition's only metric is written where the condition is.
Json condition_of(const plan::Plan& plan, const plan::LaterRecord& later) {
  const plan::SpanRecord* span = plan.span_of(plan::SpanKind::kMetrics,
                                              plan.programs()[later.program].metrics.first);
  if (span == nullptr) return nullptr;
  const std::string_view source = plan.tables().source(plan.texts()[span->text]);
  std::string text;
  for (const char c : source.substr(span->begin, span->end - span->begin)) {
    const bool is_blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (is_blank && text.ends_with(' ')) continue;
    text += is_blank ? ' ' : c;
  }
  return text;
}

}  // namespace

void add_later(const plan::Plan& plan, std::uint32_t task, Json& json) {
  for (const plan::LaterRecord& later : plan::later_of(plan.tables(), task))
    json["then"].push_back(
        {{"say", plan.text(later.text)}, {"when", condition_of(plan, later)}});
}

Json later_text(const Json& later) {
  Json lines = Json::array();
  for (const Json& sentence : later) {
    std::string line = "\"" + sentence["say"].get<std::string>() + "\"";
    if (!sentence["when"].is_null()) line += " when " + sentence["when"].get<std::string>();
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string whole_prompt(const Json& task) {
  std::vector<std::string> later;
  if (task.contains("then")) {
    for (const Json& sentence : task["then"]) later.push_back(sentence["say"].get<std::string>());
  }
  return plan::whole_instruction(task["prompt"].get<std::string>(), later);
}

bool same_prompt(const plan::Plan& a, std::uint32_t ours, const plan::Plan& b,
                 std::uint32_t theirs) {
  return plan::prompt_id(a.tables(), ours) == plan::prompt_id(b.tables(), theirs);
}

}  // namespace probe::inspect

// vlaprobe explain
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "compiler/diag/essays.h"
#include "runtime/base/json.h"
#include "runtime/base/say.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {
namespace {

Json row(Code code) {
  const CodeInfo& row = info(code);
  return {{"code", row.text},
          {"severity", to_text(row.severity)},
          {"allow", row.slug.empty() ? Json() : Json(row.slug)},
          {"title", row.title}};
}

int list_codes(bool json) {
  Json all = Json::array();
  for (const Code code : all_codes()) all.push_back(row(code));
  if (json) {
    put("{}\n", all.dump(2));
    return kFine;
  }
  for (const Code code : all_codes()) {
    const CodeInfo& entry = info(code);
    const std::string allow =
        entry.slug.empty() ? "" : fmt::format("  @allow({}, \"...\")", entry.slug);
    put("{}  {:<8} {}{}\n", entry.text, to_text(entry.severity), entry.title, allow);
  }
  return kFine;
}

// By code in any case, or by the word of an @allow.
std::optional<Code> find_code(const std::string& word) {
  std::string upper = word;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (const auto code = code_from_text(upper)) return code;
  return word.empty() ? std::nullopt : code_from_slug(word);
}

int explain(const std::string& word, bool json) {
  const auto code = find_code(word);
  if (!code) {
    std::vector<std::string_view> known;
    for (const Code each : all_codes()) known.push_back(info(each).text);
    for (const Code each : all_codes()) known.push_back(info(each).slug);
    const auto close = nearest(word, known);
    return report({Fault::kUsage,
                   fmt::format("no code `{}`{}; `vlaprobe explain` lists them", word,
                               close ? fmt::format(", did you mean `{}`?", *close) : ""),
                   ""});
  }
  if (json) {
    Json entry = row(*code);
    entry["essay"] = essay(*code);
    put("{}\n", entry.dump(2));
  } else {
    put("{}", essay(*code));
  }
  return kFine;
}

}  // namespace

void add_explain(Verb app, int& exit) {
  struct ExplainArguments {
    std::string code;
    bool json = false;
  };
  auto arguments = std::make_shared<ExplainArguments>();
  Verb verb = app.add_subcommand("explain", "the essay behind a diagnostic's code");
  verb.footer("without a code: all codes with their titles\nexample: vlaprobe explain P0402");
  verb.add_option("CODE", arguments->code, "P0402, or the word of an @allow");
  verb.add_flag("--json", arguments->json, "as JSON");
  verb.callback([arguments, &exit] {
    exit = arguments->code.empty() ? list_codes(arguments->json)
                                   : explain(arguments->code, arguments->json);
  });
}

}  // namespace probe::cli

// vlaprobe draw --phrases
#include <fmt/format.h>

#include <map>

#include "runtime/base/glob.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/show/phrase_sheet.h"

namespace probe::cli {
namespace {

// Each pair of words and object once, where it is first said, with the number of tasks that say it.
Result<std::vector<show::PhraseRow>> phrase_rows(const LoadedPlan& loaded,
                                                 const std::string& glob) {
  std::vector<show::PhraseRow> rows;
  std::map<std::pair<std::string, std::string>, std::pair<std::size_t, int>> known;
  for (const ReferringWords& said : loaded.referring) {
    const auto task = loaded.plan->find_task(said.task);
    if (!task || !(matches_glob(glob, said.task) || loaded.plan->find_task(glob) == task)) {
      continue;
    }
    const auto [at, is_new] = known.try_emplace({said.words, said.object}, rows.size(), 0);
    ++at->second.second;
    if (is_new) rows.push_back({*task, said.words, said.object, said.task});
  }
  if (rows.empty())
    return Failure{Fault::kUsage, "no task `" + glob + "` that names an object", ""};
  for (const auto& [said, place] : known) {
    show::PhraseRow& row = rows[place.first];
    row.note = fmt::format("`{}` in {}{}", row.object, row.note,
                           place.second == 1 ? "" : fmt::format(" and {} more", place.second - 1));
  }
  return rows;
}

}  // namespace

int draw_phrases(const LoadedPlan& loaded, const DrawArguments& arguments) {
  if (!loaded.is_text) {
    return report({Fault::kUsage,
                   "a plan does not keep which words mean which object; give the text",
                   arguments.file});
  }
  if (arguments.out.empty()) return report({Fault::kUsage, "--phrases needs -o X.png", ""});
  auto rows = phrase_rows(loaded, arguments.task);
  if (!rows) return report(rows.failure());
  const auto written =
      show::write_phrases(*loaded.plan, *rows, arguments.out, loaded.assets);
  if (!written) return report(written.failure());
  put("{}\n", arguments.out);
  return kFine;
}

}  // namespace probe::cli

#include "runtime/ask/callers_proof.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "runtime/ask/asked_query.h"
#include "runtime/base/printable.h"
#include "runtime/run/changed_folder.h"

namespace probe::ask {
namespace {

struct StoredAnswer {
  const Look* look = nullptr;
  Query query;
  AnswerRow row;
};

// The first that is stored of what is asked.
Result<std::optional<StoredAnswer>> first_stored(const plan::Plan& plan, const Queries& queries,
                                                 Answers& answers) {
  for (const Look& look : queries.looks()) {
    PROBE_ASSIGN(auto rows, answers.rows(start_id_of(plan, look.episode)));
    if (rows.empty()) continue;
    for (const Query& query : queries.of(look)) {
      const AnswerKey key = key_of(plan, query);
      for (AnswerRow& row : rows) {
        if (key_of(row) == key) return std::optional(StoredAnswer{&look, query, std::move(row)});
      }
    }
  }
  return std::optional<StoredAnswer>();
}

// What a text of any length is told by.
std::string quoted(const std::string& text) {
  constexpr std::size_t kTold = 60;
  return "`" + printable(text, kTold) + "`";
}

}  // namespace

Status check_callers_model(const plan::Plan& plan, const AskOptions& options,
                           const Queries& queries, const RecordedRows& recorded,
                           std::shared_ptr<const stage::SharedAssets> assets, Answers& answers,
                           std::vector<std::string>& notes) {
  PROBE_ASSIGN(const auto before, first_stored(plan, queries, answers));
  if (!before) return {};
  const PictureRule& rule = options.own_model->traits.picture;
  Viewer viewer(plan, std::move(assets), rule);
  const PreparedLook look = prepare(plan, *before->look, {before->query}, recorded, rule,
                                    options.own_model->traits.is_shown, viewer);
  const AnswerRow& row = before->row;
  std::string said = "was begun with a model of the same name that answered " + row.set + "." +
                     row.family + " of " + row.task + " " + std::to_string(row.episode) +
                     " otherwise than the caller's does now: ";
  if (!look.failure.empty() || !look.truths.contains(before->query.question)) {
    said += "it cannot be asked again" + (look.failure.empty() ? "" : ", " + look.failure);
  } else {
    PROBE_ASSIGN(const auto model, options.own_model->make());
    const Wording wording = wording_of(plan, look, before->query);
    const auto now = model->answer(asked_query(plan, look, before->query, wording));
    if (now && now->raw == row.raw) return {};
    said += quoted(row.raw) + " then, " +
            (now ? quoted(now->raw) : "no answer (" + to_text(now.failure()) + ")") + " now";
  }
  return run::goes_on_mixed(options.out, said + "; it is another one, or one that draws its words",
                            options.if_changed, notes,
                            "; `content`, given from the first call on, says which model it is");
}

}  // namespace probe::ask

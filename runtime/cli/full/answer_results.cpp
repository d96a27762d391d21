#include "runtime/cli/full/answer_results.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "runtime/ask/answer_fields.h"
#include "runtime/ask/answers.h"
#include "runtime/ask/score.h"
#include "runtime/ask/vouch.h"
#include "runtime/base/percent.h"
#include "runtime/base/printable.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/plan/family_name.h"

namespace probe::cli {
namespace {

constexpr std::size_t kLongestName = 400;

std::string rate_text(const ask::Rate& rate) {
  if (rate.count.n == 0) return "-";
  return fmt::format("{}/{} {} % [{}]", rate.count.k, rate.count.n,
                     decimal_text(100 * rate.count.rate(), 0),
                     percent_range(rate.interval.low, rate.interval.high, "-"));
}

// What was not read, apart.
std::string rest_text(const ask::ArmScore& score) {
  std::string text;
  const auto add = [&](std::int64_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(score.unclear, "unclear");
  add(score.cut, "of them cut off");
  add(score.refused, "refused");
  add(score.empty, "empty");
  add(score.invalid, "invalid");
  add(score.incomplete, "incomplete");
  return text;
}

// How many answers cannot be vouched for.
Result<std::int64_t> print_table(const std::string& dir) {
  PROBE_ASSIGN(const ask::AskRecord record, ask::read_ask_record(dir));
  PROBE_ASSIGN(const plan::Plan plan, ask::open_asked_plan(dir));
  ask::Tally tally(plan);
  ask::RowFindings rows;
  PROBE_TRY(ask::for_each_answer(dir, [&](const ask::AnswerRow& row, std::uint32_t) {
    rows.add(row);
    return tally.add(row);
  }));
  put_words("model {}\n", printable(record.identity.model, kLongestName));
  if (!record.identity.frames.empty())
    put_words("ends of {}\n", printable(record.identity.frames, kLongestName));
  put_words("{:<28} {:<8} {:<28} {:<28} {}\n", "question", "arm", "right in every order",
            "right in one order", "");
  for (const ask::ScoreRow& row : ask::score(plan, tally.asked())) {
    const plan::FamilyRecord& family = plan.families()[row.family];
    const std::string name = plan::family_name(plan, family);
    for (const ask::Arm arm : {ask::Arm::kPicture, ask::Arm::kBlind, ask::Arm::kPrior}) {
      const auto& score = row.of(arm);
      if (!score) continue;
      put_words("{:<28} {:<8} {:<28} {:<28} {}\n", name, ask::word_of(arm),
                rate_text(score->circular), rate_text(score->plain), rest_text(*score));
      if (score->likely_circular && score->likely_plain) {
        put_words("{:<28} {:<8} {:<28} {:<28} by the likeliest letters\n", "", "",
                  rate_text(*score->likely_circular), rate_text(*score->likely_plain));
      }
    }
    if (row.floors.random_circular && row.floors.random_plain) {
      put_words("{:<28} {:<8} {:<28} {:<28}\n", "", "luck",
                decimal_text(100 * *row.floors.random_circular, 1) + " %",
                decimal_text(100 * *row.floors.random_plain, 1) + " %");
    }
  }
  std::map<std::string, std::int64_t> left_out;
  PROBE_TRY(ask::for_each_left_out(dir, [&](const ask::LeftOut& out, std::uint32_t) -> Status {
    ++left_out[plan::family_name(out.set, out.family) + ": " + out.why];
    return {};
  }));
  for (const std::string& sentence : rows.sentences()) put_words("{}\n", sentence);
  for (const auto& [why, count] : left_out) put_words("not asked, {} times: {}\n", count, why);
  PROBE_ASSIGN(const auto calls, ask::read_ask_calls(dir));
  if (const std::string missing = ask::missing_shards(calls); !missing.empty())
    put_words("{} {}\n", dir, missing);
  std::set<std::string> told;
  for (const ask::AskCall& call : calls) {
    for (const std::string& finding : ask::findings_of(call.proof)) {
      if (told.insert(finding).second) put_words("{}\n", finding);
    }
  }
  return rows.refused();
}

Result<std::int64_t> print_rows(const std::string& dir, AnswerForm form) {
  bool is_first = true;
  ask::RowFindings rows;
  put("{}", form == AnswerForm::kJson ? "[" : ask::csv_header() + "\n");
  PROBE_TRY(ask::for_each_answer(dir, [&](const ask::AnswerRow& row, std::uint32_t) -> Status {
    rows.add(row);
    if (form == AnswerForm::kJson) {
      put("{}\n{}", is_first ? "" : ",", ask::to_json(row).dump());
    } else {
      put("{}\n", ask::to_csv(row));
    }
    is_first = false;
    return {};
  }));
  if (form == AnswerForm::kJson) put("\n]\n");
  PROBE_ASSIGN(const auto calls, ask::read_ask_calls(dir));
  if (const std::string missing = ask::missing_shards(calls); !missing.empty())
    say("{} {}\n", dir, missing);
  for (const std::string& sentence : rows.sentences()) say("{}\n", sentence);
  return rows.refused();
}

}  // namespace

int print_answers(const std::string& dir, AnswerForm form) {
  const auto refused = form == AnswerForm::kTable ? print_table(dir) : print_rows(dir, form);
  if (!refused) return report(refused.failure());
  return *refused > 0 ? kOutside : kFine;
}

}  // namespace probe::cli

#include "runtime/ask/vouch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/ask/plan_reading.h"
#include "runtime/ask/prepared.h"
#include "runtime/ask/queries.h"
#include "runtime/ask/reading/likely_letters.h"
#include "runtime/ask/wording.h"
#include "runtime/base/printable.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/family_name.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/questions.h"

namespace probe::ask {
namespace {

// Begins the reason of a row that cannot be vouched for.
constexpr std::string_view kUnvouched = "store: ";
constexpr std::size_t kLongestReason = 400;

std::string does_not_follow(std::string_view cell, std::string_view from) {
  return "its `" + std::string(cell) + "` does not follow from " + std::string(from);
}

// The cell that holds another reading than today's, by its name; empty: none does.
std::string_view differing_cell(const Reading& stored, const Reading& today) {
  if (stored.verdict != today.verdict) return "verdict";
  if (stored.option != today.option) return "option";
  if (stored.yes != today.yes) return "yes";
  if (stored.number != today.number) return "number";
  if (stored.point != today.point) return "point";
  if (stored.mentioned != today.mentioned) return "mentioned";
  return stored.rule == today.rule ? "" : "rule";
}

// Its set, family and task are those of the question.
bool is_named_so(const plan::Plan& plan, const AnswerRow& row, std::uint32_t index) {
  const plan::QuestionRecord& question = plan.questions()[index];
  const plan::FamilyRecord& family = plan.families()[question.family];
  return row.set == plan.text(family.set) && row.family == plan.text(family.name) &&
         row.task == plan.text(plan.tasks()[question.task].name);
}

bool is_about(const plan::Plan& plan, const AnswerRow& row, std::uint32_t index) {
  const plan::TaskRecord& task = plan.tasks()[plan.questions()[index].task];
  if (row.episode < 0 || static_cast<std::uint32_t>(row.episode) >= task.episodes.count)
    return false;
  const plan::EpisodeRecord& episode =
      plan.episodes()[task.episodes.first + static_cast<std::uint32_t>(row.episode)];
  return to_hex(plan::to_sha256(episode.start_id)) == row.start_id;
}

// A figure that no answer has; empty: all are possible.
std::string impossible_figure(const AnswerRow& row, std::size_t letters) {
  const Usage& usage = row.usage;
  const auto below = [](std::string_view cell, int least) {
    return "its `" + std::string(cell) + "` is below " + std::to_string(least);
  };
  if (usage.prompt_tokens.value_or(0) < 0) return below("prompt_tokens", 0);
  if (usage.completion_tokens.value_or(0) < 0) return below("completion_tokens", 0);
  if (!(row.latency_s >= 0)) return below("latency_s", 0);
  if (row.attempts < 1) return below("attempts", 1);
  const auto& logprobs = usage.letter_logprobs;
  if (!logprobs.empty() && logprobs.size() != letters) {
    return "its `letter_logprobs` are " + std::to_string(logprobs.size()) + ", its letters " +
           std::to_string(letters);
  }
  const bool is_junk = std::ranges::any_of(logprobs, [](const std::optional<double>& logprob) {
    return logprob && !is_logprob(*logprob);
  });
  return is_junk ? "its `letter_logprobs` are no logarithms of probabilities" : "";
}

}  // namespace

Voucher::Voucher(const plan::Plan& plan, std::string model)
    : plan_(plan), model_(std::move(model)) {
  for (std::uint32_t q = 0; q < plan.questions().size(); ++q)
    questions_[to_hex(plan::to_sha256(plan.questions()[q].question_id))].push_back(q);
  for (std::uint32_t e = 0; e < plan.episodes().size(); ++e)
    episodes_[start_id_of(plan, e)].push_back(e);
}

void Voucher::vouch(AnswerRow& row) {
  std::string why = reason(row);
  if (why.empty()) return;
  row.invalid = std::string(kUnvouched) + printable(why, kLongestReason);
  row.right.reset();
}

bool is_unvouched(const AnswerRow& row) {
  return row.invalid && row.invalid->starts_with(kUnvouched);
}

// Why the row cannot be what asking stored; empty where it can.
std::string Voucher::reason(AnswerRow& row) {
  if (row.model != model_) return "it is of `" + row.model + "`, the folder is of `" + model_ + "`";
  const auto alike = questions_.find(row.question_id);
  if (alike == questions_.end()) return "the plan has no question " + row.question_id;
  std::uint32_t question = plan::kNone;
  for (const std::uint32_t q : alike->second) {
    if (is_named_so(plan_, row, q)) question = q;
  }
  if (question == plan::kNone) {
    return "the plan asks " + row.question_id + " not as " +
           plan::family_name(row.set, row.family) + " of " + row.task;
  }
  if (!is_about(plan_, row, question)) {
    return row.task + " has no start " + row.start_id + " at " + std::to_string(row.episode);
  }
  const std::uint32_t rotations = rotations_of(plan_, plan_.questions()[question]);
  if (row.rotation >= rotations)
    return "rotation " + std::to_string(row.rotation) + " is none of its options";
  const plan::FamilyRecord& family = plan_.families()[plan_.questions()[question].family];
  const bool is_end = plan::moment_of(family) == plan::QuestionMoment::kEnd;
  if (is_end != (row.seed >= 0))
    return is_end ? "it is asked at an episode's end and names none"
                  : "it is asked of starts alone";
  if (row.invalid) {
    // What asking gave up on has nothing that came; what a merge wrote keeps its reason.
    const bool has_come =
        row.right || !row.raw.empty() || !row.reasoning.empty() || !row.request_sha256.empty();
    return has_come && !is_unvouched(row) ? "it is said to be invalid and holds an answer" : "";
  }
  if (!row.right) return "it is neither right nor wrong";
  if (std::string why = impossible_figure(row, rotations == 1 ? 0 : rotations); !why.empty())
    return why;
  if (std::string why = check_shown(row, question); !why.empty()) return why;
  return read_again(row, question);
}

// What was shown with the words is what its arm shows. Of models in this process no picture is
// sent.
std::string Voucher::check_shown(const AnswerRow& row, std::uint32_t question) const {
  const bool was_sent = !row.request_sha256.empty(), has_picture = !row.image_sha256.empty();
  const bool wants_picture = row.arm != Arm::kBlind && was_sent;
  if (has_picture && row.arm == Arm::kBlind) return does_not_follow("image_sha256", "its `arm`");
  if (wants_picture && !has_picture) return does_not_follow("image_sha256", "its `arm`");
  if (row.arm != Arm::kPrior) {
    const bool has_other = !row.shown_start_id.empty() || row.shown_has_answer;
    return has_other ? does_not_follow("shown_start_id", "its `arm`") : "";
  }
  const auto shown = episodes_.find(row.shown_start_id);
  if (shown == episodes_.end() || row.shown_start_id == row.start_id)
    return "its `shown_start_id` is no other start of the plan";
  const bool fits = std::ranges::any_of(shown->second, [&](std::uint32_t episode) {
    return has_answer(plan_, plan_.questions()[question], episode) == row.shown_has_answer;
  });
  return fits ? "" : does_not_follow("shown_has_answer", "the plan");
}

// Nothing where the words of a question for a point tell no size.
const Voucher::Order* Voucher::order_of(const AnswerRow& row, std::uint32_t question) {
  const auto [at, is_new] = orders_.try_emplace({question, row.rotation});
  Order& order = at->second;
  const plan::QuestionRecord& record = plan_.questions()[question];
  const bool is_point =
      plan::form_of(plan_.families()[record.family]) == plan::QuestionForm::kPoint;
  // Pictures of one folder have one size; of another, the words differ.
  if (!is_new && (!is_point || order.text == row.text)) return &order;
  ToldSize size;
  if (is_point) {
    const auto told = told_size(row.text);
    if (!told) return nullptr;
    size = *told;
  }
  Wording wording = word(plan_, record, row.rotation, size.width, size.height);
  order.prompt_sha256 = to_hex(sha256(wording.text));
  order.reader = std::make_unique<AnswerReader>(
      read_context(plan_, record, wording.shown, size.width, size.height));
  order.text = std::move(wording.text);
  return &order;
}

std::string Voucher::read_again(AnswerRow& row, std::uint32_t question) {
  const plan::QuestionRecord& record = plan_.questions()[question];
  const Order* order = order_of(row, question);
  if (order == nullptr || row.text != order->text)
    return does_not_follow("text", "the plan's question");
  if (row.prompt_sha256 != order->prompt_sha256)
    return does_not_follow("prompt_sha256", "its `text`");
  const bool is_older = row.reader != kReaderVersion;
  if (plan::truth_of(record) == plan::QuestionTruth::kMentions) {
    if (row.expected != known_truth(plan_, record)->expected)
      return does_not_follow("expected", "the plan");
    Restatement today = restate(plan_, record, row.raw, row.usage.finish);
    const std::string_view cell = differing_cell(row.reading, today.reading);
    if (!is_older && !cell.empty()) return does_not_follow(cell, "its `raw`");
    if (!is_older && today.copied != row.copied) return does_not_follow("copied", "its `raw`");
    if (!is_older && today.right != *row.right) return does_not_follow("right", "its `raw`");
    row.reading = std::move(today.reading);
    row.right = today.right;
    row.copied = today.copied;
    return {};
  }
  const Reading today = order->reader->read(row.raw, row.usage.finish);
  // Readers before version 4 kept those of the first token, whatever stood there.
  constexpr int kFirstOfTheLetter = 4;
  const bool begins_so = !row.raw.empty() && row.raw[0] >= 'A' && row.raw[0] <= 'Z' &&
                         (row.raw.size() == 1 || row.raw[1] == '.' || row.raw[1] == ')');
  if (row.reader < kFirstOfTheLetter && !begins_so) row.usage.letter_logprobs.clear();
  const std::string_view cell = differing_cell(row.reading, today);
  if (!is_older && !cell.empty()) return does_not_follow(cell, "its `raw`");
  return judge_again(row, question, today);
}

std::string Voucher::judge_again(AnswerRow& row, std::uint32_t question, const Reading& today) {
  const plan::QuestionRecord& record = plan_.questions()[question];
  std::optional<Truth> truth = known_truth(plan_, record);
  if (truth && row.expected != truth->expected) return does_not_follow("expected", "the plan");
  if (!truth && plan::truth_of(record) != plan::QuestionTruth::kPixelsOf) {
    const auto yes = told_yes(row.expected);
    if (!yes) return "its `expected` is neither yes nor no";
    truth = Truth{.yes = yes, .expected = row.expected};
  }
  if (!truth) {
    // Which pixels are right is not stored: a point is believed, or asked for again.
    const bool same = today.verdict == row.reading.verdict && today.point == row.reading.point;
    if (!same && today.verdict == Verdict::kRead)
      return "today's reader takes another point from it; ask again";
    const bool can_be_right = today.verdict == Verdict::kRead;
    if (*row.right && !can_be_right && row.reader == kReaderVersion)
      return does_not_follow("right", "its `raw`");
    row.right = *row.right && can_be_right;
    row.reading = today;
    return {};
  }
  const bool right = is_right(*truth, today);
  if (row.reader == kReaderVersion && right != *row.right)
    return does_not_follow("right", "its `raw`");
  row.reading = today;
  row.right = right;
  return {};
}

void RowFindings::add(const AnswerRow& row) {
  if (row.reader != kReaderVersion) ++read_anew_;
  constexpr std::size_t kMostKept = 100;  // reasons that name ids may be as many as rows
  if (!is_unvouched(row)) return;
  ++refused_;
  if (reasons_.size() < kMostKept || reasons_.contains(*row.invalid)) ++reasons_[*row.invalid];
}

std::vector<std::string> RowFindings::sentences() const {
  std::vector<std::string> out;
  if (read_anew_ > 0) {
    out.push_back(std::to_string(read_anew_) +
                  (read_anew_ == 1
                       ? " answer was read by another version of the reader and is"
                       : " answers were read by another version of the reader and are") +
                  " read anew by today's rules");
  }
  constexpr std::size_t kTold = 5;
  std::int64_t told = 0;
  for (const auto& [reason, count] : reasons_) {
    if (out.size() == kTold) break;
    out.push_back(std::to_string(count) + (count == 1 ? " answer counts" : " answers count") +
                  " neither way: " + reason.substr(kUnvouched.size()));
    told += count;
  }
  if (told < refused_)
    out.push_back(std::to_string(refused_ - told) +
                  " more answers cannot be vouched for, for other reasons");
  return out;
}

}  // namespace probe::ask

#include "runtime/servers/identity.h"

#include <algorithm>
#include <limits>

namespace probe::servers {

using policy::AtEnd;

Status Identity::check(Transport& transport, const Profile& adapted) {
  const Shown shown = asks_ ? asks_() : Shown();
  PROBE_TRY(check_hello(transport));
  if (first_.is_steady) {
    PROBE_ASSIGN(const AtEnd at_end, ask_again(transport, adapted, 1));
    note(at_end);
    if (policy::is_exchanged(at_end)) return lost();
  } else if (first_.hello.empty()) {
    return {};
  }
  if (shown) shown();
  return {};
}

Status Identity::check_hello(const Transport& transport) {
  if (policy::is_exchanged(found())) return lost();
  // One that draws nothing is known by its answers; a hello may hold the time of day.
  if (first_.is_steady || first_.hello.empty() || transport.remarks() == first_.hello) return {};
  note(AtEnd::kOther);
  return lost();
}

bool Identity::is_due() {
  int answers = answers_;
  while (first_.is_steady && answers >= kAnswersBetween) {
    if (answers_.compare_exchange_weak(answers, 0)) return true;
  }
  return false;
}

AtEnd Identity::ask_all(Transport& transport, const Profile& adapted) {
  if (policy::is_exchanged(found())) return found();
  if (!first_.is_steady) return check_hello(transport) ? AtEnd::kNotAsked : found();
  const auto at_end = ask_again(transport, adapted, first_.answers.size());
  if (!at_end) return AtEnd::kUnclear;
  note(*at_end);
  return *at_end;
}

Result<AtEnd> Identity::ask_again(Transport& transport, const Profile& adapted, std::size_t count) {
  KnownObservations questions(adapted, transport, first_.arm);
  for (std::size_t i = 0; i < count; ++i) {
    PROBE_ASSIGN(const Chunk answer, questions.ask(first_.observations[i]));
    if (answer == first_.answers[i]) continue;
    if (first_.is_gathered && i == 0 && is_first_answer(answer)) continue;
    // Otherwise, whatever comes of asking once more: that only says in which way.
    const auto again = questions.ask(first_.observations[i]);
    return again && *again == answer ? AtEnd::kOther : AtEnd::kDrawn;
  }
  if (!first_.is_batched) return AtEnd::kSame;
  PROBE_ASSIGN(const auto together, questions.ask_together(first_.observations));
  return compare_together(first_.answers, together).mixed.empty() ? AtEnd::kSame : AtEnd::kMixed;
}

bool Identity::is_first_answer(const Chunk& answer) const {
  constexpr double kFarther = 10;  // than what rounds otherwise beside other questions
  double nearest = std::numeric_limits<double>::infinity();
  for (const Chunk& other : first_.answers) {
    if (const double far = apart(other, first_.answers.front()); far > 0)
      nearest = std::min(nearest, far);
  }
  return apart(answer, first_.answers.front()) <= nearest / kFarther;
}

void Identity::note_mixed() { note(AtEnd::kMixed); }

AtEnd Identity::found() const {
  const std::lock_guard lock(mutex_);
  return found_;
}

void Identity::note(AtEnd at_end) {
  const std::lock_guard lock(mutex_);
  if (policy::is_exchanged(at_end) && !policy::is_exchanged(found_)) found_ = at_end;
}

Status Identity::lost() const {
  if (found() == AtEnd::kMixed)
    return bad("it takes the questions of a batch for one another; ask without `batch`");
  return bad("another policy answers than when the run began");
}

}  // namespace probe::servers

#include "runtime/run/server_proof.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "runtime/run/changed_folder.h"
#include "runtime/servers/reading.h"

namespace probe::run {

ServerProof::ServerProof(servers::ServerChoice choice, int worlds, const servers::KnownArm& arm)
    : choice_(std::move(choice)), arm_(arm), model_(std::make_shared<servers::SharedModel>()) {
  // No batch of the run will hold more; of one question, a batch shows nothing.
  constexpr int kLeastShown = 2;
  choice_.batch.most = std::min(choice_.batch.most, std::max(worlds, kLeastShown));
}

Result<policy::Reading> ServerProof::ask() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kFirstPause{100}, kLongestPause{2000};
  const auto limit = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(choice_.profile.wait_s));
  for (auto pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    servers::FirstAnswers first;
    PROBE_ASSIGN(policy::Reading reading, servers::prove_reading(choice_, model_, arm_, &first));
    if (reading.failure.empty()) {
      identity_ = std::make_shared<servers::Identity>(std::move(first));
      return reading;
    }
    if (Clock::now() + pause > limit)
      return Failure{Fault::kPolicy, policy::findings_of(reading).front(), "--policy"};
    std::this_thread::sleep_for(pause);
  }
}

Status ServerProof::check_as_before(const policy::Reading& reading, const RunOptions& options,
                                    store::Store& store, std::vector<std::string>& notes) const {
  PROBE_ASSIGN(const auto calls, store::read_run_calls(options.out));
  const store::ReadingChanges changes = store::changes_between(calls, reading);
  if (changes.measured) {
    return Failure{Fault::kStore,
                   "was begun with a server whose answers showed other units, forms or rotations; "
                   "say them in the profile, and take another folder",
                   options.out};
  }
  if (!changes.policy) return store.forget_unproven();
  PROBE_ASSIGN(const auto unproven, store.unproven());
  PROBE_TRY(store.invalidate(
      unproven, "policy: " + reading.server + ": " + std::string(store::Store::kNeverShown)));
  PROBE_TRY(store.forget_unproven());
  if (!unproven.empty()) {
    notes.push_back(std::to_string(unproven.size()) +
                    " episodes of calls whose policy was not shown to be one to the end are "
                    "invalid; the same command does them again");
  }
  const std::string said =
      "was begun with a policy that answered the first questions otherwise than the one at " +
      reading.server + " does now: it is another one, or on a machine that rounds otherwise";
  return goes_on_mixed(options.out, said, options.if_changed, notes);
}

Status ServerProof::watch(store::Store& store) {
  // Of one that draws and says nothing of itself nothing is ever shown.
  if (!identity_->first().is_steady && identity_->first().hello.empty()) return {};
  PROBE_TRY(store.note_unproven());
  identity_->tell([this, &store]() -> servers::Identity::Shown {
    auto before = store.unproven();
    if (!before) return {};  // the rows are asked about once more
    return [this, &store, rows = std::move(*before)] {
      if (!rows.empty()) is_shown_again_ = true;
      (void)store.forget_unproven(rows);  // as above, should it fail
    };
  });
  return {};
}

Status ServerProof::check_to_the_end(policy::Reading& reading, store::Store& store,
                                     std::vector<std::string>& notes) const {
  reading.at_end = servers::prove_again(choice_, model_, *identity_);
  // Of one that draws there is no more to ask.
  if (reading.at_end == policy::AtEnd::kSame || reading.at_end == policy::AtEnd::kNotAsked)
    return store.forget_unproven();
  if (!policy::is_exchanged(reading.at_end)) {
    notes.push_back(policy::findings_of(reading).back());
    return {};
  }
  PROBE_ASSIGN(const auto unproven, store.unproven());
  const bool is_mixed = reading.at_end == policy::AtEnd::kMixed;
  const auto reason = is_mixed ? store::Store::kMixedUp : store::Store::kExchanged;
  PROBE_TRY(store.invalidate(unproven, "policy: " + reading.server + ": " + std::string(reason)));
  PROBE_TRY(store.forget_unproven());
  std::string what = is_mixed ? "it took the questions of a batch for one another"
                              : "another policy answers than at the beginning: it was exchanged "
                                "meanwhile";
  if (unproven.empty()) {
    what += "; no episode that it may have answered was stored";
  } else {
    what += ", and the " + std::to_string(unproven.size()) + " episodes of this call " +
            (is_shown_again_ ? "since it was last shown to be the same " : "") + "are invalid";
  }
  what += is_mixed ? "; ask without `batch`" : "; the same command does them again";
  return Failure{Fault::kPolicy, std::move(what), reading.server};
}

}  // namespace probe::run

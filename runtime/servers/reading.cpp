#include "runtime/servers/reading.h"

#include <optional>

#include "runtime/base/sha256.h"
#include "runtime/servers/conformance.h"
#include "runtime/servers/connecting.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/meaning.h"
#include "runtime/servers/profile_words.h"

namespace probe::servers {
namespace {

std::string hash_of(const std::vector<Chunk>& answers) {
  Hasher hasher;
  for (const Chunk& answer : answers) {
    hasher.u64(answer.size());
    for (const RawAction& action : answer) hasher.bytes(std::as_bytes(std::span(action)));
  }
  return to_hex(hasher.finish());
}

// Observations and what each was answered alone, up to the one that was not.
struct AskedAlone {
  std::vector<KnownObservation> observations;
  std::vector<Chunk> answers;
  std::optional<Failure> failure;
};

// One picture with two instructions, one instruction with two pictures.
AskedAlone ask_first(KnownObservations& observations) {
  AskedAlone asked{
      {KnownObservation{}, KnownObservation{.words = 1}, KnownObservation{.picture = 1}}, {}, {}};
  for (const KnownObservation& observation : asked.observations) {
    auto answer = observations.ask(observation);
    if (!answer) {
      asked.failure = answer.failure();
      break;
    }
    asked.answers.push_back(std::move(*answer));
  }
  return asked;
}

// As many observations as a batch can have, each with a picture of its own, asked alone and once
// more in one message. Whatever does not answer it as it answers them alone, but for rounding and
// draws, cannot be asked in batches.
Status prove_batch(KnownObservations& observations, AskedAlone asked, const ServerChoice& choice,
                   policy::Reading* reading, FirstAnswers* first) {
  const auto refused = [&](const std::string& why) {
    return Failure{Fault::kUsage, "it cannot be asked in batches: " + why + "; ask without `batch`",
                   choice.server.name()};
  };
  const auto not_shown = [&](const Failure& why) {
    const Failure failure = named(why, choice.server.name());
    return Failure{failure.code,
                   "it was not shown to answer batches: " + failure.message +
                       "; without `batch` it is asked one at a time",
                   failure.where};
  };
  const auto most = static_cast<std::size_t>(choice.batch.most);
  // Of less room those go that differ in their pictures.
  while (asked.observations.size() > most && asked.observations.size() > 2) {
    asked.observations.erase(asked.observations.begin() + 1);
    asked.answers.erase(asked.answers.begin() + 1);
  }
  for (int picture = 2; asked.observations.size() < most; ++picture) {
    const KnownObservation more{.picture = picture};
    auto answer = observations.ask(more);
    if (!answer) return not_shown(answer.failure());
    asked.observations.push_back(more);
    asked.answers.push_back(std::move(*answer));
  }
  const auto together = observations.ask_together(asked.observations);
  if (!together) return not_shown(together.failure());
  const TogetherFinding finding = compare_together(asked.answers, *together);
  if (!finding.mixed.empty()) return refused(finding.mixed);
  reading->batch = static_cast<int>(asked.observations.size());
  reading->batch_difference = finding.difference;
  if (first != nullptr) {
    first->observations = std::move(asked.observations);
    first->answers = std::move(asked.answers);
    first->is_batched = true;
  }
  return {};
}

// Of a policy that draws: whether words and pictures move its answers more than its draws do. The
// chance that draws alone look so is one in 35: four answers to one question, one to another.
Status prove_spread(KnownObservations& observations, const AskedAlone& asked, const Chunk& again,
                    policy::Reading* reading) {
  constexpr std::size_t kSame = 4;
  std::vector<Chunk> same = {asked.answers.front(), again};
  while (same.size() < kSame) {
    PROBE_ASSIGN(Chunk more, observations.ask(asked.observations.front()));
    same.push_back(std::move(more));
  }
  double within = 0;
  for (std::size_t i = 0; i < same.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) within = std::max(within, apart(same[i], same[k]));
  }
  const auto is_shown = [&](const Chunk& other) {
    for (const Chunk& answer : same) {
      if (apart(answer, other) <= within) return false;
    }
    return true;
  };
  reading->words_not_shown = !is_shown(asked.answers[1]);
  reading->picture_not_shown = !is_shown(asked.answers[2]);
  return {};
}

// What a server says of itself on a second connection, too.
std::vector<std::string> steady_hello(const ServerChoice& choice,
                                      const std::shared_ptr<SharedModel>& model,
                                      const std::vector<std::string>& said) {
  if (said.empty()) return {};
  const auto transport = make_transport(choice, model);
  Profile adapted;
  if (!transport || !open_patiently(**transport, choice.profile, choice.server.name(), &adapted))
    return {};
  const bool is_same = (*transport)->remarks() == said;
  (*transport)->close();
  return is_same ? said : std::vector<std::string>();
}

// As the profile or the server says it, or as it was measured.
ActionForm form_of(const Profile& adapted, const policy::Reading& reading) {
  ActionForm form = adapted.action_form;
  for (const auto& [field, value] : reading.measured) {
    if (field != "action.form") continue;
    for (const auto& word : kActionForms) {
      if (word.text == value) form = word.value;
    }
  }
  return form;
}

// What `policy test` calls wrong of how far a step moves would make every episode one of another
// policy.
Status check_steps(Profile profile, const std::vector<Chunk>& answers, const KnownArm& arm,
                   const policy::Reading& reading) {
  for (const auto& [field, value] : reading.measured) PROBE_TRY(set_field(profile, field, value));
  for (const Check& check : judge_answers(profile, answers, arm)) {
    if (check.name != "translation" || check.verdict != Verdict::kWrong) continue;
    std::string lines;
    for (const std::string& line : check.fix) lines += (lines.empty() ? "; try `" : "`, `") + line;
    return Failure{Fault::kUsage,
                   "its first answers are no moves of the arm: " + check.found + lines +
                       (lines.empty() ? "" : "`") + " (`vlaprobe policy test` shows more)",
                   reading.server};
  }
  return {};
}

}  // namespace

Result<policy::Reading> prove_reading(const ServerChoice& choice) {
  return prove_reading(choice, nullptr, known_arm(choice.profile));
}

Result<policy::Reading> prove_reading(const ServerChoice& choice,
                                      const std::shared_ptr<SharedModel>& model,
                                      const KnownArm& arm, FirstAnswers* first) {
  PROBE_ASSIGN(const auto transport, make_transport(choice, model));
  policy::Reading reading;
  reading.server = choice.server.name();
  reading.is_unchecked = choice.server.tls.accepts_any;
  Profile adapted;
  PROBE_TRY(open_patiently(*transport, choice.profile, reading.server, &adapted));
  KnownObservations observations(adapted, *transport, arm);
  const auto note_failure = [&](const Failure& failure) {
    reading.failure = to_text(named(failure, reading.server));
  };
  AskedAlone asked = ask_first(observations);
  if (asked.failure) note_failure(*asked.failure);
  reading.answers = static_cast<int>(asked.answers.size());
  if (first != nullptr)
    *first = {.observations = asked.observations,
              .answers = asked.answers,
              .is_gathered = choice.batch.most > 1 && !asks_together(choice),
              .arm = arm};
  if (asks_together(choice)) {
    if (asked.failure) {
      return Failure{Fault::kPolicy,
                     "it was not shown to answer batches, as it did not answer alone: " +
                         reading.failure + "; without `batch` it is asked one at a time",
                     reading.server};
    }
    PROBE_TRY(prove_batch(observations, asked, choice, &reading, first));
  }
  KnownAnswers known{asked.answers, {}, arm};
  if (wants_mirrored(adapted) && reading.failure.empty()) {
    auto mirrored = observations.ask({.is_mirrored = true});
    if (mirrored) {
      known.mirrored.push_back(std::move(*mirrored));
    } else {
      note_failure(mirrored.failure());
    }
  }
  if (reading.failure.empty()) {
    const auto again = observations.ask(asked.observations.front());
    if (again) {
      reading.is_steady = *again == asked.answers.front();
      reading.draws = !reading.is_steady;
      if (reading.draws) {
        if (const auto spread = prove_spread(observations, asked, *again, &reading); !spread)
          note_failure(spread.failure());
      }
    } else {
      note_failure(again.failure());
    }
  }
  const std::vector<std::string> hello = transport->remarks();
  transport->close();
  if (first != nullptr) {
    first->is_steady = reading.is_steady;
    if (reading.draws) first->hello = steady_hello(choice, model, hello);
  }
  if (asked.failure) return reading;  // nothing is measured on what did not come
  const std::vector<OpenField> left = left_open(adapted, known);
  reading.measured = measured_of(left);
  PROBE_TRY(check_said(adapted, left, reading.server));
  PROBE_TRY(check_form(adapted, form_of(adapted, reading), arm.control, reading.server));
  PROBE_TRY(check_steps(adapted, asked.answers, arm, reading));
  reading.is_deaf = asked.answers[0] == asked.answers[1];
  reading.is_blind = asked.answers[0] == asked.answers[2];
  reading.answers_sha256 = hash_of(asked.answers);
  PROBE_ASSIGN(const Sha256 observations_hash, observations.hash_of(asked.observations));
  reading.questions_sha256 = to_hex(observations_hash);
  return reading;
}

policy::AtEnd prove_again(const ServerChoice& choice, const std::shared_ptr<SharedModel>& model,
                          Identity& identity) {
  if (policy::is_exchanged(identity.found())) return identity.found();
  const bool draws = !identity.first().is_steady;
  if (draws && identity.first().hello.empty()) return policy::AtEnd::kNotAsked;
  const auto transport = make_transport(choice, model);
  Profile adapted;
  if (!transport || !open_patiently(**transport, choice.profile, choice.server.name(), &adapted))
    return draws ? policy::AtEnd::kNotAsked : policy::AtEnd::kUnclear;
  return identity.ask_all(**transport, adapted);
}

}  // namespace probe::servers

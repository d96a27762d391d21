#include "runtime/servers/reading.h"

#include "runtime/base/sha256.h"
#include "runtime/servers/connecting.h"
#include "runtime/servers/meaning.h"
#include "runtime/servers/questions.h"

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

}  // namespace

Result<policy::Reading> prove_reading(const ServerChoice& choice,
                                      std::shared_ptr<SharedModel> model) {
  PROBE_ASSIGN(const auto transport, make_transport(choice, std::move(model)));
  policy::Reading reading;
  reading.server = choice.server.name();
  Profile adapted;
  PROBE_TRY(open_patiently(*transport, choice.profile, reading.server, &adapted));
  Questions questions(adapted, *transport);
  std::vector<Chunk> answers;
  for (const Question& question : {Question{}, Question{.words = 1}, Question{.picture = 1}}) {
    auto answer = questions.ask(question);
    if (!answer) {
      reading.failure = to_text(named(answer.failure(), reading.server));
      break;
    }
    answers.push_back(std::move(*answer));
  }
  transport->close();
  reading.answers = static_cast<int>(answers.size());
  for (const OpenField& open : open_fields(adapted)) {
    if (auto value = measured_value(open, adapted, answers))
      reading.measured.emplace_back(open.field, std::move(*value));
  }
  PROBE_TRY(check_said(adapted, reading.measured, reading.server));
  if (answers.size() < 3) return reading;
  reading.is_deaf = answers[0] == answers[1];
  reading.is_blind = answers[0] == answers[2];
  reading.answers_sha256 = hash_of(answers);
  return reading;
}

}  // namespace probe::servers

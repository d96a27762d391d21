// What a folder of answers says of itself as a whole: of which plan and model it is, by which
// build, and what each call of `ask` did. Texts in, texts out; knows no files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/query_meter.h"
#include "runtime/store/fingerprint.h"

namespace probe::ask {

// What must not change between two calls that write into one folder.
struct AskIdentity {
  std::string plan_root;  // hex
  std::string model;      // as rows call it
  // What the name alone does not say: how it is asked (size of pictures, max_tokens, ...), without
  // its address.
  std::string content;
  // Of the run whose ends were asked about: its plan, policy and profile; empty: of none.
  std::string frames = {};
  bool operator==(const AskIdentity&) const = default;
};

struct AskRecord {
  AskIdentity identity;
  std::string suite;
  store::Fingerprint fingerprint;  // of the call that made the folder
};

std::string to_text(const AskRecord& record);
// Fails (kStore, at `where`) naming the key that is missing or of another type.
Result<AskRecord> record_from_text(const std::string& text, const std::string& where);

// As store::RunChanges: sentences without the folder's name, empty where equal.
struct AskChanges {
  std::string identity, content, build;
  bool any() const { return !identity.empty() || !content.empty() || !build.empty(); }
};
AskChanges changes_between(const AskRecord& stored, const AskRecord& asked);

// What the first questions of a call showed of a server.
struct ModelProof {
  std::string server = {};       // HOST:PORT; empty: the model is no server
  std::string answered_as = {};  // what it calls itself
  int answers = 0;               // that came
  // Equal bit for bit: answers to one question about two pictures, to two questions about one.
  bool is_blind = false, is_deaf = false;
  bool has_logprobs = false;  // of an answer's tokens
  bool is_unchecked = false;  // TLS without a look at the certificate
  bool operator==(const ModelProof&) const = default;
};
// Sentences on what is not as it should be.
std::vector<std::string> findings_of(const ModelProof& proof);

// One call of `ask`, as far as it got: what it did is known when it `ended` by itself.
struct AskCall {
  store::Fingerprint fingerprint;
  ModelProof proof;
  int jobs = 1;
  int shard = 1, shards = 1;  // which share it asked
  bool ended = false;
  std::int64_t answers = 0;  // stored
  std::int64_t retried = 0;  // attempts that were repeated
  double elapsed_s = 0;
  policy::QueryFigures queries = {};
};

// "158.2 answers/s; server busy 99.6 % of the time, 31.8 questions at it on average".
std::string to_text(const AskCall& call);
// Which shards nobody asked to their end, as "is partial: shards 2, 4 of 5 were not asked to their
// end"; empty where none is missing.
std::string missing_shards(std::span<const AskCall> calls);
std::string call_to_json(const AskCall& call);
Result<AskCall> call_from_json(const std::string& text, const std::string& where);

}  // namespace probe::ask

// Records as JSON.
#include "runtime/ask/ask_record.h"

#include <map>
#include <optional>
#include <set>

#include "runtime/base/json.h"
#include "runtime/base/percent.h"

namespace probe::ask {
namespace {

constexpr const char* kSchema = "1";
constexpr std::size_t kShownRoot = 12;

Failure damaged(const std::string& key, const char* wanted, const std::string& where) {
  return {Fault::kStore,
          "`" + key + "` of its record is not " + wanted + "; move this file away and ask again",
          where};
}

Result<std::string> text_of(const Json& json, const char* key, const std::string& where) {
  const Json* found = json.find(key);
  if (found == nullptr || !found->is_string()) return damaged(key, "a text", where);
  return found->text();
}

std::string said(const std::string& text) { return text.empty() ? "nothing" : text; }

}  // namespace

std::string to_text(const AskRecord& record) {
  const Json json = {{"schema", kSchema},
                     {"plan_root", record.identity.plan_root},
                     {"model", record.identity.model},
                     {"content", record.identity.content},
                     {"frames", record.identity.frames},
                     {"suite", record.suite},
                     {"fingerprint", store::to_json(record.fingerprint)}};
  return json.sorted().dump();
}

Result<AskRecord> record_from_text(const std::string& text, const std::string& where) {
  const auto json = Json::parse(text);
  PROBE_ASSIGN(const std::string schema, text_of(json, "schema", where));
  if (schema != kSchema) {
    return Failure{Fault::kStore,
                   "was written by a program with another layout of answers (" + schema + ")",
                   where};
  }
  AskRecord record;
  PROBE_ASSIGN(record.identity.plan_root, text_of(json, "plan_root", where));
  PROBE_ASSIGN(record.identity.model, text_of(json, "model", where));
  PROBE_ASSIGN(record.identity.content, text_of(json, "content", where));
  PROBE_ASSIGN(record.identity.frames, text_of(json, "frames", where));
  PROBE_ASSIGN(record.suite, text_of(json, "suite", where));
  PROBE_ASSIGN(const std::string fingerprint, text_of(json, "fingerprint", where));
  auto read = store::fingerprint_from_json(fingerprint);
  if (!read) return damaged("fingerprint", "an object of texts", where);
  record.fingerprint = std::move(*read);
  return record;
}

AskChanges changes_between(const AskRecord& stored, const AskRecord& asked) {
  AskChanges changes;
  const AskIdentity &there = stored.identity, &here = asked.identity;
  if (there.model != here.model) {
    changes.identity = "holds answers of model `" + there.model + "`, not `" + here.model + "`";
  } else if (there.plan_root != here.plan_root) {
    changes.identity = "holds answers to another plan's questions (root " +
                       there.plan_root.substr(0, kShownRoot) + ", this one is " +
                       here.plan_root.substr(0, kShownRoot) + ")";
  } else if (there.frames != here.frames) {
    changes.identity = "holds answers about the ends of " +
                       (there.frames.empty() ? "no run" : "the run `" + there.frames + "`") +
                       ", not of " + (here.frames.empty() ? "none" : "`" + here.frames + "`");
  }
  if (there.content != here.content) {
    changes.content = "was begun by asking in another way (recorded " + said(there.content) +
                      ", now " + said(here.content) + ")";
  }
  for (const std::string& line : store::differences(stored.fingerprint, asked.fingerprint)) {
    // Another plan names other assets: that is no news.
    if (line.starts_with("assets: ") && there.plan_root != here.plan_root) continue;
    changes.build +=
        (changes.build.empty() ? "was begun by another build or machine (" : "; ") + line;
  }
  if (!changes.build.empty()) changes.build += ")";
  return changes;
}

std::vector<std::string> findings_of(const ModelProof& proof) {
  std::vector<std::string> findings;
  if (proof.is_blind) {
    findings.push_back(
        "the model gave one answer, bit for bit, to one question about two different pictures: it "
        "may not see them");
  }
  if (proof.is_deaf) {
    findings.push_back(
        "the model gave one answer, bit for bit, to two different questions about one picture: it "
        "may not read them");
  }
  if (proof.is_unchecked) {
    findings.push_back("the certificate of " + proof.server +
                       " was not checked (--insecure): anybody may have answered");
  }
  return findings;
}

std::string to_text(const AskCall& call) {
  const double elapsed = call.elapsed_s > 0 ? call.elapsed_s : 1;
  std::string text = decimal_text(static_cast<double>(call.answers) / elapsed, 1) + " answers/s";
  if (call.queries.queries == 0) return text;
  return text + "; server busy " + decimal_text(100 * call.queries.busy_s / elapsed, 1) +
         " % of the time, " + decimal_text(call.queries.waiting_s / elapsed, 1) + " of " +
         std::to_string(call.jobs) + " questions at it on average";
}

std::string missing_shards(std::span<const AskCall> calls) {
  std::map<int, std::set<int>> ended;  // shards by their number
  for (const AskCall& call : calls) {
    constexpr int kMostShards = 100'000;  // as jobs of an array may be
    if (call.shards < 1 || call.shards > kMostShards) continue;
    std::set<int>& shards = ended[call.shards];
    if (call.ended) shards.insert(call.shard);
  }
  std::string text;
  for (const auto& [count, there] : ended) {
    constexpr int kNamed = 20;
    std::string names;
    int missing = 0;
    for (int shard = 1; shard <= count; ++shard) {
      if (there.contains(shard) || ++missing > kNamed) continue;
      names += (names.empty() ? "" : ", ") + std::to_string(shard);
    }
    if (missing == 0) return {};  // one whole division is enough
    if (count == 1) continue;     // a call that was killed; nobody spoke of shards
    const bool many = missing > 1;
    text = std::string("is partial: shard") + (many ? "s " : " ") + names +
           (missing > kNamed ? " .." : "") + " of " + std::to_string(count) +
           (many ? " were not asked to their end" : " was not asked to its end");
  }
  return text;
}

std::string call_to_json(const AskCall& call) {
  const ModelProof& proof = call.proof;
  const Json json = {{"fingerprint", store::to_json(call.fingerprint)},
                     {"server", proof.server},
                     {"answered_as", proof.answered_as},
                     {"proof_answers", proof.answers},
                     {"is_blind", proof.is_blind},
                     {"is_deaf", proof.is_deaf},
                     {"has_logprobs", proof.has_logprobs},
                     {"is_unchecked", proof.is_unchecked},
                     {"jobs", call.jobs},
                     {"shard", call.shard},
                     {"shards", call.shards},
                     {"ended", call.ended},
                     {"answers", call.answers},
                     {"retried", call.retried},
                     {"elapsed_s", call.elapsed_s},
                     {"queries", call.queries.queries},
                     {"server_busy_s", call.queries.busy_s},
                     {"waiting_s", call.queries.waiting_s},
                     {"queries_at_once", call.queries.most_at_once}};
  return json.sorted().dump();
}

Result<AskCall> call_from_json(const std::string& text, const std::string& where) {
  const Json json = Json::parse(text);
  AskCall call;
  PROBE_ASSIGN(const std::string fingerprint, text_of(json, "fingerprint", where));
  auto read = store::fingerprint_from_json(fingerprint);
  if (!read) return damaged("fingerprint", "an object of texts", where);
  call.fingerprint = std::move(*read);
  PROBE_ASSIGN(call.proof.server, text_of(json, "server", where));
  PROBE_ASSIGN(call.proof.answered_as, text_of(json, "answered_as", where));
  std::optional<std::string> wrong;
  const auto number = [&](const char* key) {
    const Json* found = json.find(key);
    if (found != nullptr && found->is_number()) return *found;
    wrong = key;
    return Json(0);
  };
  const auto flag = [&](const char* key) {
    const Json* found = json.find(key);
    if (found != nullptr && found->is_boolean()) return found->get<bool>();
    wrong = key;
    return false;
  };
  call.proof.answers = number("proof_answers").get<int>();
  call.proof.is_blind = flag("is_blind");
  call.proof.is_deaf = flag("is_deaf");
  call.proof.has_logprobs = flag("has_logprobs");
  call.proof.is_unchecked = flag("is_unchecked");
  call.jobs = number("jobs").get<int>();
  // Older calls do not say.
  if (json.find("shards") != nullptr) {
    call.shard = number("shard").get<int>();
    call.shards = number("shards").get<int>();
  }
  call.ended = flag("ended");
  call.answers = number("answers").get<std::int64_t>();
  call.retried = number("retried").get<std::int64_t>();
  call.elapsed_s = number("elapsed_s").get<double>();
  call.queries.queries = number("queries").get<std::int64_t>();
  call.queries.elapsed_s = call.elapsed_s;
  call.queries.busy_s = number("server_busy_s").get<double>();
  call.queries.waiting_s = number("waiting_s").get<double>();
  call.queries.most_at_once = number("queries_at_once").get<int>();
  if (wrong) return damaged(*wrong, "of its type", where);
  return call;
}

}  // namespace probe::ask

// Records as JSON.
#include "runtime/store/run_record.h"

#include <algorithm>

#include "runtime/base/json.h"
#include "runtime/base/percent.h"
#include "runtime/base/printable.h"
#include "runtime/store/callers_policy.h"

namespace probe::store {
namespace {

constexpr std::size_t kLongestShown = 200;

Failure record_failure(const std::string& message, const std::string& where) {
  return {Fault::kStore, message, where};
}

Failure bad_record(const std::string& key, const char* wanted, const std::string& where) {
  return record_failure(
      "`" + key + "` of its run record is not " + wanted + "; move this file away and run again",
      where);
}

Result<std::string> record_text(const Json& json, const char* key, const std::string& where) {
  const Json* found = json.find(key);
  if (found == nullptr || !found->is_string()) return bad_record(key, "a text", where);
  return found->text();
}

std::string short_form(const std::string& text, std::size_t length) {
  return text.substr(0, length);
}

std::string percent(double part, double whole) {
  return decimal_text(whole > 0 ? 100 * part / whole : 0, 1) + " %";
}

}  // namespace

std::string record_to_text(const RunRecord& record) {
  const bool is_live = !record.identity.live.empty();
  const bool is_adaptive = !record.identity.until.empty();
  const int schema = is_adaptive                    ? kAdaptiveSchemaVersion
                     : record.identity.only_success ? kSelectedSchemaVersion
                     : is_live                      ? kLiveSchemaVersion
                                                    : record.schema;
  Json json = {{"schema", std::to_string(schema)},
               {"plan_root", record.identity.plan_root},
               {"policy", record.identity.policy},
               {"policy_content", record.identity.policy_content},
               {"suite", record.suite},
               {"seeds", record.seeds},
               {"fingerprint", to_json(record.fingerprint)}};
  if (is_live) json["live"] = record.identity.live;
  if (record.identity.only_success) json["only_success"] = true;
  if (is_adaptive) json["until"] = record.identity.until;
  if (!record.asset_folders.empty()) json["asset_folders"] = record.asset_folders;
  return json.sorted().dump();
}

Result<RunRecord> record_from_text(const std::string& text, const std::string& where) {
  const auto json = Json::parse(text);
  if (!json.is_object()) {
    return record_failure("its run record is no JSON object; move this file away and run again",
                          where);
  }
  RunRecord record;
  PROBE_ASSIGN(const std::string schema, record_text(json, "schema", where));
  const bool is_selected = schema == std::to_string(kSelectedSchemaVersion);
  const bool is_adaptive = schema == std::to_string(kAdaptiveSchemaVersion);
  const bool is_live = schema == std::to_string(kLiveSchemaVersion) ||
                       ((is_selected || is_adaptive) && json.find("live") != nullptr);
  if (schema != "1" && schema != std::to_string(kSchemaVersion) && !is_live && !is_selected &&
      !is_adaptive) {
    return record_failure(
        "was written by a program with another layout of results (" + schema + ")", where);
  }
  record.schema = schema == "1" ? 1 : kSchemaVersion;
  PROBE_ASSIGN(record.identity.plan_root, record_text(json, "plan_root", where));
  PROBE_ASSIGN(record.identity.policy, record_text(json, "policy", where));
  if (record.schema > 1) {
    PROBE_ASSIGN(record.identity.policy_content, record_text(json, "policy_content", where));
  }
  if (is_live) {
    PROBE_ASSIGN(record.identity.live, record_text(json, "live", where));
    if (record.identity.live.empty()) return bad_record("live", "a text that says how", where);
  }
  if (is_selected) {
    const Json* kept = json.find("only_success");
    if (kept == nullptr || !kept->is_boolean() || !kept->get<bool>())
      return bad_record("only_success", "true", where);
    record.identity.only_success = true;
  }
  if (is_adaptive) {
    PROBE_ASSIGN(record.identity.until, record_text(json, "until", where));
    if (record.identity.until.empty()) return bad_record("until", "a text that says when", where);
  }
  PROBE_ASSIGN(record.suite, record_text(json, "suite", where));
  const Json* seeds = json.find("seeds");
  if (seeds == nullptr || !seeds->is_array()) {
    return bad_record("seeds", "a list of whole numbers", where);
  }
  for (const auto& seed : *seeds) {
    if (!seed.is_number_integer()) return bad_record("seeds", "a list of whole numbers", where);
    record.seeds.push_back(seed.get<int>());
  }
  if (const Json* folders = json.find("asset_folders")) {
    if (!folders->is_array()) return bad_record("asset_folders", "a list of texts", where);
    for (const auto& folder : *folders) {
      if (!folder.is_string()) return bad_record("asset_folders", "a list of texts", where);
      record.asset_folders.push_back(folder.get<std::string>());
    }
  }
  PROBE_ASSIGN(const std::string fingerprint, record_text(json, "fingerprint", where));
  auto read = fingerprint_from_json(fingerprint);
  if (!read) return bad_record("fingerprint", "an object of texts", where);
  record.fingerprint = std::move(*read);
  return record;
}

RunChanges changes_between(const RunRecord& stored, const RunRecord& asked) {
  RunChanges changes;
  const RunIdentity& there = stored.identity;
  const RunIdentity& here = asked.identity;
  const auto kind = [](const std::string& live) {
    return live.empty() ? std::string("a run whose world waits for its policy")
                        : "a run that is " + live;
  };
  const auto kept = [](bool only_success) {
    return only_success ? "successes alone (`vlaprobe demos`)" : "every episode that was run";
  };
  if (there.only_success != here.only_success) {
    changes.identity =
        std::string("holds ") + kept(there.only_success) + ", not " + kept(here.only_success);
  } else if (there.until != here.until) {
    const auto ends = [](const std::string& until) {
      if (until == kBySearch) return std::string("a search chooses the episodes of");
      return until.empty() ? std::string("runs all its episodes")
                           : "stops by `--until` (" + printable(until, kLongestShown) + ")";
    };
    changes.identity = "holds a run that " + ends(there.until) + ", not one that " + ends(here.until);
    if (here.until.empty() && there.until != kBySearch)
      changes.identity += "; `--until none` runs the others and makes it an ordinary one";
  } else if (there.live != here.live) {
    changes.identity = "holds " + kind(there.live) + ", not " + kind(here.live);
  } else if (there.policy != here.policy) {
    changes.identity = "holds a run of policy `" + there.policy + "`, not `" + here.policy + "`";
  } else if (there.plan_root != here.plan_root) {
    changes.identity = "holds a run of another plan (root " + short_form(there.plan_root, 12) +
                       ", this one is " + short_form(here.plan_root, 12) + ")";
  }
  if (there.policy_content != here.policy_content) {
    const auto said = [](const std::string& text) { return text.empty() ? "nothing" : text; };
    const auto is_of_server = [](const std::string& content) {
      return !content.starts_with(kOwnPolicy) && !content.starts_with(kCallersPolicy);
    };
    const bool is_server = is_of_server(there.policy_content) && is_of_server(here.policy_content);
    changes.policy_content =
        std::string("was begun with another ") + (is_server ? "profile" : "policy") +
        " (recorded " + said(there.policy_content) + ", now " + said(here.policy_content) + ")";
  }
  std::vector<std::string> lines = differences(stored.fingerprint, asked.fingerprint);
  const bool is_of_assets = lines.size() == 1 && lines.front().starts_with("assets: ");
  // Another plan names other assets: that is no news.
  if (is_of_assets && there.plan_root != here.plan_root) lines.clear();
  for (const std::string& line : lines) {
    const char* lead =
        is_of_assets ? "was begun with other assets (" : "was begun by another build or machine (";
    changes.build += (changes.build.empty() ? lead : "; ") + line;
  }
  if (!changes.build.empty()) changes.build += ")";
  return changes;
}

std::string to_text(const RunCall& call) {
  const auto rate = [&](double count) {
    return decimal_text(call.elapsed_s > 0 ? count / call.elapsed_s : 0, 1);
  };
  std::string text = rate(static_cast<double>(call.observations)) + " observations/s";
  if (call.queries.queries == 0) return text;
  text += ", " + rate(static_cast<double>(call.queries.queries)) + " queries/s; server busy " +
          percent(call.queries.busy_s, call.elapsed_s) +
          " of the time, simulators waiting for it " +
          percent(call.queries.waiting_s, call.elapsed_s * call.worlds) + " of theirs";
  if (call.queries.batches == 0) return text;
  const auto queries = static_cast<double>(call.queries.queries);
  return text + "; " + std::to_string(call.queries.batches) + " batches of " +
         decimal_text(queries / static_cast<double>(call.queries.batches), 1) +
         " questions on average, at most " + std::to_string(call.queries.most_in_batch) +
         "; simulators waiting for one another " +
         percent(call.queries.gathering_s, call.elapsed_s * call.worlds) + " of theirs";
}

namespace {

// Against the first that counts: answers alike are alike among one another, too.
bool has_others(const std::vector<RunCall>& calls) {
  const policy::Reading* first = nullptr;
  for (const RunCall& call : calls) {
    // Of a call that ended with another policy no episode counts.
    if (!call.reading || policy::is_exchanged(call.reading->at_end)) continue;
    if (!call.reading->is_steady && !call.reading->draws) continue;
    if (first != nullptr && are_others(*first, *call.reading)) return true;
    if (first == nullptr) first = &*call.reading;
  }
  return false;
}

// Whether a later call met the policy that the call `index` began with.
bool is_shown_later(const std::vector<RunCall>& calls, std::size_t index) {
  const policy::Reading& reading = *calls[index].reading;
  return std::any_of(calls.begin() + static_cast<std::ptrdiff_t>(index) + 1, calls.end(),
                     [&](const RunCall& later) {
                       return later.reading && later.reading->is_steady &&
                              later.reading->questions_sha256 == reading.questions_sha256 &&
                              !are_others(reading, *later.reading);
                     });
}

}  // namespace

ReadingSummary summarize_readings(const std::vector<RunCall>& calls, std::size_t unproven) {
  ReadingSummary summary;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    const RunCall& call = calls[i];
    if (!call.reading) continue;
    const bool is_mixed = call.reading->at_end == policy::AtEnd::kMixed;
    const std::string batch = is_mixed ? "" : policy::batch_remark(*call.reading);
    if (!batch.empty() && std::ranges::find(summary.batches, batch) == summary.batches.end())
      summary.batches.push_back(batch);
    summary.is_unchecked = summary.is_unchecked || call.reading->is_unchecked;
    policy::Reading reading = *call.reading;
    if (reading.at_end == policy::AtEnd::kUnclear && is_shown_later(calls, i))
      reading.at_end = policy::AtEnd::kSame;
    const auto findings = policy::findings_of(reading);
    if (findings.empty()) ++summary.proven;
    for (const std::string& finding : findings) {
      if (std::ranges::find(summary.findings, finding) == summary.findings.end())
        summary.findings.push_back(finding);
    }
  }
  if (has_others(calls)) {
    summary.findings.push_back(
        "calls of this folder had servers that answered the same first questions otherwise: more "
        "than one policy, or machines that round otherwise");
  }
  if (unproven > 0) {
    summary.findings.push_back(std::to_string(unproven) +
                               " episodes were answered in a call that was not shown to have had "
                               "one policy to its end: the next call of `run` into this folder "
                               "asks who answers");
  }
  if (summary.findings.empty() && summary.proven > 0) {
    summary.good = "other words and other pictures had other answers when the run began";
  }
  return summary;
}

ReadingChanges changes_between(const std::vector<RunCall>& before, const policy::Reading& now) {
  ReadingChanges changes;
  for (const RunCall& call : before) {
    if (!call.reading) continue;
    // Of a call that ended with another policy no episode counts.
    if (policy::is_exchanged(call.reading->at_end)) continue;
    if (call.reading->measured != now.measured) changes.measured = true;
    if (are_others(*call.reading, now)) changes.policy = true;
  }
  return changes;
}

namespace {

Json reading_to_json(const policy::Reading& reading) {
  auto measured = Json::object();
  for (const auto& [field, value] : reading.measured) measured[field] = value;
  Json json = {{"server", reading.server},     {"answers", reading.answers},
               {"failure", reading.failure},   {"is_deaf", reading.is_deaf},
               {"is_blind", reading.is_blind}, {"answers_sha256", reading.answers_sha256},
               {"measured", measured}};
  if (reading.batch > 0) {
    json["batch"] = reading.batch;
    json["batch_difference"] = reading.batch_difference;
  }
  if (reading.is_unchecked) json["is_unchecked"] = true;
  if (!reading.questions_sha256.empty()) json["questions_sha256"] = reading.questions_sha256;
  if (reading.is_steady) json["is_steady"] = true;
  if (reading.draws) json["draws"] = true;
  if (reading.words_not_shown) json["words_not_shown"] = true;
  if (reading.picture_not_shown) json["picture_not_shown"] = true;
  if (reading.at_end != policy::AtEnd::kNotAsked) json["at_end"] = to_word(reading.at_end);
  return json;
}

// Nothing where a part is missing or of another type.
std::optional<policy::Reading> reading_from_json(const Json& json) {
  const auto text = [&](const char* key) -> std::optional<std::string> {
    const Json* found = json.find(key);
    if (found == nullptr || !found->is_string()) return std::nullopt;
    return found->text();
  };
  const auto flag = [&](const char* key) {
    const Json* found = json.find(key);
    return found != nullptr && found->is_boolean() && found->get<bool>();
  };
  const auto server = text("server"), failure = text("failure"), hash = text("answers_sha256");
  const Json *answers = json.find("answers"), *measured = json.find("measured");
  if (!server || !failure || !hash || answers == nullptr || !answers->is_number_integer() ||
      measured == nullptr || !measured->is_object()) {
    return std::nullopt;
  }
  policy::Reading reading;
  reading.server = *server;
  reading.answers = answers->get<int>();
  reading.failure = *failure;
  reading.is_deaf = flag("is_deaf");
  reading.is_blind = flag("is_blind");
  reading.answers_sha256 = *hash;
  reading.is_unchecked = flag("is_unchecked");
  reading.is_steady = flag("is_steady");
  reading.draws = flag("draws");
  reading.words_not_shown = flag("words_not_shown");
  reading.picture_not_shown = flag("picture_not_shown");
  reading.questions_sha256 = text("questions_sha256").value_or("");
  for (const policy::AtEnd at_end :
       {policy::AtEnd::kSame, policy::AtEnd::kOther, policy::AtEnd::kUnclear, policy::AtEnd::kDrawn,
        policy::AtEnd::kMixed}) {
    if (text("at_end") == to_word(at_end)) reading.at_end = at_end;
  }
  const Json *batch = json.find("batch"), *difference = json.find("batch_difference");
  if (batch != nullptr && difference != nullptr) {
    if (!batch->is_number_integer() || !difference->is_number()) return std::nullopt;
    reading.batch = batch->get<int>();
    reading.batch_difference = difference->get<double>();
  }
  for (const auto& [field, value] : measured->items()) {
    if (!value.is_string()) return std::nullopt;
    reading.measured.emplace_back(field, value.text());
  }
  return reading;
}

}  // namespace

std::string call_to_json(const RunCall& call) {
  Json json = {{"fingerprint", to_json(call.fingerprint)},
               {"worlds", call.worlds},
               {"ended", call.ended},
               {"episodes", call.episodes},
               {"retried", call.retried},
               {"observations", call.observations},
               {"elapsed_s", call.elapsed_s},
               {"queries", call.queries.queries},
               {"server_busy_s", call.queries.busy_s},
               {"worlds_waiting_s", call.queries.waiting_s},
               {"queries_at_once", call.queries.most_at_once}};
  if (call.queries.batches > 0) {
    json["batches"] = call.queries.batches;
    json["queries_of_a_batch"] = call.queries.most_in_batch;
    json["worlds_gathering_s"] = call.queries.gathering_s;
  }
  if (call.reading) json["reading"] = reading_to_json(*call.reading);
  return json.sorted().dump();
}

Result<RunCall> call_from_json(const std::string& text, const std::string& where) {
  const Json json = Json::parse(text);
  std::string missing;
  const auto number = [&](const char* key) {
    const Json* found = json.find(key);
    if (found != nullptr && found->is_number()) return *found;
    missing = key;
    return Json(0);
  };
  RunCall call;
  const Json* fingerprint = json.find("fingerprint");
  const Json* ended = json.find("ended");
  if (fingerprint == nullptr || !fingerprint->is_string()) missing = "fingerprint";
  if (ended == nullptr || !ended->is_boolean()) missing = "ended";
  call.worlds = number("worlds").get<int>();
  call.episodes = number("episodes").get<int>();
  call.retried = number("retried").get<int>();
  call.observations = number("observations").get<std::int64_t>();
  call.elapsed_s = number("elapsed_s").get<double>();
  call.queries.elapsed_s = call.elapsed_s;
  call.queries.queries = number("queries").get<std::int64_t>();
  call.queries.busy_s = number("server_busy_s").get<double>();
  call.queries.waiting_s = number("worlds_waiting_s").get<double>();
  call.queries.most_at_once = number("queries_at_once").get<int>();
  if (json.find("batches") != nullptr) {
    call.queries.batches = number("batches").get<std::int64_t>();
    call.queries.most_in_batch = number("queries_of_a_batch").get<int>();
    call.queries.gathering_s = number("worlds_gathering_s").get<double>();
  }
  if (const Json* reading = json.find("reading")) {
    call.reading = reading_from_json(*reading);
    if (!call.reading) missing = "reading";
  }
  if (!missing.empty()) {
    return record_failure("the figures of a call cannot be read: `" + missing + "`", where);
  }
  call.ended = ended->get<bool>();
  PROBE_ASSIGN(call.fingerprint, fingerprint_from_json(fingerprint->text()));
  return call;
}

}  // namespace probe::store

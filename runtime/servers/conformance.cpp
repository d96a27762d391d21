// The observations of a policy test, and its report.
#include "runtime/servers/conformance.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "runtime/base/clock.h"
#include "runtime/base/json.h"
#include "runtime/policy/reading.h"
#include "runtime/servers/api_key.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/meaning.h"

namespace probe::servers {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kObservations = 6;
constexpr int kRepeats = 3;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// A failure's words, with what would mend the commonest: a key that the server does not find.
Check failed_check(const std::string& name, const Failure& failure) {
  Check check{name, Verdict::kWrong, to_text(failure), {}};
  const std::size_t error = failure.message.find("KeyError: ");
  if (error == std::string::npos) return check;
  const std::size_t begin = failure.message.find_first_of("'\"", error);
  if (begin == std::string::npos) return check;
  const std::size_t end = failure.message.find(failure.message[begin], begin + 1);
  if (end == std::string::npos) return check;
  const std::string key = failure.message.substr(begin + 1, end - begin - 1);
  check.found += "; the server looks for `" + key + "`";
  check.fix = {"image = first -> " + key + "    # if it is a picture",
               "state.key = " + key + "    # if it is the state",
               "prompt.key = " + key + "    # if it is the instruction"};
  return check;
}

double difference(const Chunk& a, const Chunk& b) {
  double most = a.size() == b.size() ? 0 : 1e9;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    for (std::size_t k = 0; k < a[i].size(); ++k)
      most = std::max(most, std::abs(a[i][k] - b[i][k]));
  }
  return most;
}

class Session {
 public:
  Session(const ServerChoice& choice, Transport& transport, Conformance& result)
      : observations_(choice.profile, transport, known_arm(choice.profile)),
        transport_(transport),
        result_(result),
        most_in_batch_(asks_together(choice) ? choice.batch.most : 1) {}

  void run() {
    if (!connect()) return;
    std::vector<Chunk> chunks;
    for (int i = 0; i < kObservations; ++i) {
      auto chunk = ask("answer", {.picture = i});
      if (!chunk) return;
      chunks.push_back(std::move(*chunk));
    }
    result_.checks.push_back({"answer",
                              Verdict::kFine,
                              std::to_string(kObservations) + " observations answered with actions",
                              {}});
    for (Check& check : judge_answers(profile(), chunks, observations_.arm()))
      result_.checks.push_back(std::move(check));
    double changes = 0;
    for (const Chunk& chunk : chunks) changes = std::max(changes, difference(chunk, chunks[0]));
    check_sameness(chunks[0], changes);
    check_together(chunks);
    judge_meaning(chunks);
    judge_times();
  }

 private:
  bool connect() {
    const auto begun = Clock::now();
    const auto opened = observations_.open();
    result_.connect_s = seconds_since(begun);
    if (!opened) {
      result_.checks.push_back(failed_check("connection", opened.failure()));
      return false;
    }
    result_.remarks = transport_.remarks();
    for (const std::string& note : transport_.notes()) result_.remarks.push_back(note);
    result_.checks.push_back(
        {"connection", Verdict::kFine, "connected in " + number(result_.connect_s) + " s", {}});
    return true;
  }

  const Profile& profile() const { return observations_.profile(); }

  // On a failure the check is written and the session is over.
  std::optional<Chunk> ask(const char* name, const KnownObservation& observation) {
    auto answer = observations_.ask(observation);
    result_.queries = observations_.asked();
    if (!answer) {
      result_.checks.push_back(failed_check(name, answer.failure()));
      judge_times();
      return std::nullopt;
    }
    return std::move(*answer);
  }

  // The same again, the same with another instruction.
  void check_sameness(const Chunk& first, double changes) {
    double noise = 0;
    for (int i = 0; i < kRepeats; ++i) {
      const auto again = ask("repetition", {});
      if (!again) return;
      noise = std::max(noise, difference(first, *again));
    }
    if (noise == 0) {
      result_.checks.push_back({"sameness",
                                Verdict::kFine,
                                "the same observation has the same answer, bit for bit",
                                {}});
    } else {
      result_.checks.push_back({"sameness",
                                Verdict::kWarning,
                                "the same observation has other answers (by up to " +
                                    number(noise) +
                                    "): runs repeat only in distribution, so use several --seeds",
                                {}});
    }
    if (changes <= noise) {
      result_.checks.push_back(
          {"picture",
           Verdict::kWarning,
           "the answers do not depend on the picture: does it reach the policy?",
           {}});
    } else {
      result_.checks.push_back(
          {"picture", Verdict::kFine, "other pictures have other answers", {}});
    }
    const auto other = ask("instruction", {.words = 1});
    if (!other) return;
    mirrored_ = ask("state", {.is_mirrored = true});
    if (!mirrored_) return;
    judge_state(difference(first, *mirrored_) > noise);
    if (difference(first, *other) <= noise) {
      result_.checks.push_back(
          {"instruction",
           Verdict::kWarning,
           "another instruction has the same answer: does it reach the policy?",
           {}});
    } else {
      result_.checks.push_back(
          {"instruction", Verdict::kFine, "another instruction has another answer", {}});
    }
  }

  // The same pictures once more, in one message.
  void check_together(const std::vector<Chunk>& alone) {
    if (most_in_batch_ <= 1) return;
    std::vector<KnownObservation> observations;
    for (int i = 0; i < std::min(kObservations, most_in_batch_); ++i)
      observations.push_back({.picture = i});
    const auto together = observations_.ask_together(observations);
    ++result_.queries;
    if (!together) {
      result_.checks.push_back(failed_check("batch", together.failure()));
      return;
    }
    const TogetherFinding finding = compare_together(alone, *together);
    if (!finding.mixed.empty()) {
      result_.checks.push_back({"batch", Verdict::kWrong, finding.mixed, {}});
      return;
    }
    policy::Reading reading;
    reading.batch = static_cast<int>(observations.size());
    reading.batch_difference = finding.difference;
    result_.checks.push_back({"batch", Verdict::kFine, policy::batch_remark(reading), {}});
  }

  // What no shape shows: changes or poses, in which units, which rotations.
  void judge_meaning(const std::vector<Chunk>& answers) {
    KnownAnswers known{answers, {}, observations_.arm()};
    if (mirrored_) known.mirrored.push_back(*mirrored_);
    for (const OpenField& open : left_open(profile(), known)) {
      Check check{open.field, Verdict::kWarning, "the profile does not say it; ", {}};
      if (open.values.size() == 1) {
        check.found += "the answers show it";
      } else {
        check.verdict = Verdict::kWrong;
        check.found += "no answer shows it, so `run` would refuse";
      }
      for (const std::string& word : open.values) check.fix.push_back(open.field + " = " + word);
      result_.checks.push_back(std::move(check));
    }
  }

  // Many policies do not look at the arm's state, so this decides nothing.
  void judge_state(bool changes) {
    const bool is_sent = profile().state_layout != StateLayout::kNone;
    result_.checks.push_back(
        {"state",
         changes || !is_sent ? Verdict::kFine : Verdict::kUnclear,
         changes ? "an arm on the robot's other side has another answer"
                 : std::string("the answers do not depend on the arm's state") +
                       (is_sent ? ", which is sent: does it reach the policy?" : ""),
         {}});
  }

  void judge_times() {
    const std::vector<double>& times = observations_.times();
    if (times.empty()) return;
    result_.first_s = times.front();
    std::vector<double> later(times.begin() + (times.size() > 1 ? 1 : 0), times.end());
    std::sort(later.begin(), later.end());
    result_.median_s = later[later.size() / 2];
    result_.slowest_s = later.back();
    Check check{"latency",
                Verdict::kFine,
                "first answer " + number(result_.first_s) + " s, then " + number(result_.median_s) +
                    " s, slowest " + number(result_.slowest_s) + " s",
                {}};
    if (result_.slowest_s > profile().answer_s / 2) {
      check.verdict = Verdict::kWarning;
      check.found += ", near the profile's limit of " + number(profile().answer_s) + " s";
      check.fix = {"timeout.answer_s = " + number(4 * result_.slowest_s)};
    }
    result_.checks.push_back(std::move(check));
  }

  KnownObservations observations_;
  Transport& transport_;
  Conformance& result_;
  int most_in_batch_;
  std::optional<Chunk> mirrored_;  // the answer to the arm on the robot's other side
};

}  // namespace

bool Conformance::is_wrong() const {
  return std::any_of(checks.begin(), checks.end(),
                     [](const Check& check) { return check.verdict == Verdict::kWrong; });
}

Result<Conformance> test_server(const ServerChoice& choice) {
  PROBE_ASSIGN(const auto transport, make_transport(choice));
  Conformance result;
  result.server = choice.server.name();
  result.profile = choice.profile.name;
  Session(choice, *transport, result).run();
  transport->close();
  // What a server says of itself may repeat the key that it was sent.
  for (std::string& remark : result.remarks) remark = without_key(remark);
  for (Check& check : result.checks) {
    check.found = without_key(check.found);
    for (std::string& fix : check.fix) fix = without_key(fix);
  }
  return result;
}

std::string_view to_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kUnclear:
      return "unclear";
    case Verdict::kWarning:
      return "warning";
    case Verdict::kWrong:
      return "wrong";
    case Verdict::kFine:
      break;
  }
  return "fine";
}

std::string to_text(const Conformance& conformance) {
  std::string text = conformance.server + ", profile " + conformance.profile + "\n";
  for (const std::string& remark : conformance.remarks) text += "  " + remark + "\n";
  for (const Check& check : conformance.checks) {
    std::string line = "  " + std::string(to_word(check.verdict));
    line.resize(std::max<std::size_t>(line.size() + 1, 11), ' ');
    line += check.name;
    line.resize(std::max<std::size_t>(line.size() + 1, 24), ' ');
    text += line + check.found + "\n";
    for (const std::string& fix : check.fix) text += std::string(24, ' ') + "try `" + fix + "`\n";
  }
  return text;
}

std::string to_json(const Conformance& conformance) {
  Json json = {{"server", conformance.server},
               {"profile", conformance.profile},
               {"queries", conformance.queries},
               {"connect_s", conformance.connect_s},
               {"first_s", conformance.first_s},
               {"median_s", conformance.median_s},
               {"slowest_s", conformance.slowest_s},
               {"remarks", conformance.remarks},
               {"checks", Json::array()}};
  for (const Check& check : conformance.checks) {
    json["checks"].push_back({{"name", check.name},
                              {"verdict", to_word(check.verdict)},
                              {"found", check.found},
                              {"fix", check.fix}});
  }
  return json.dump(1);
}

}  // namespace probe::servers

// The questions of a policy test, and its report.
#include "runtime/servers/conformance.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "runtime/base/json.h"
#include "runtime/robot/rotation.h"
#include "runtime/servers/api_key.h"
#include "runtime/servers/server_policy.h"

namespace probe::servers {
namespace {

using Clock = std::chrono::steady_clock;
using Chunk = std::vector<RawAction>;

constexpr int kWidth = 640, kHeight = 480;
constexpr int kObservations = 6;
constexpr int kRepeats = 3;
constexpr int kHorizon = 60;
constexpr const char* kPrompts[] = {"put carrot on plate", "put the spoon on the towel"};

double seconds_since(Clock::time_point from) {
  return std::chrono::duration<double>(Clock::now() - from).count();
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// A brown table under a grey wall with an orange and a blue thing on it; `index` moves them. No
// policy knows it, but every policy takes it for a picture.
wire::Bytes picture(int index) {
  wire::Bytes rgb;
  rgb.reserve(static_cast<std::size_t>(kWidth) * kHeight * 3);
  const int left = 150 + 40 * index, right = 420 - 30 * index;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      int color[3] = {165, 165, 170};
      if (y > 140) color[0] = 150 + (x * 7 + y * 3) % 17, color[1] = 115, color[2] = 80;
      if (std::abs(x - left) < 28 && std::abs(y - 300) < 14) {
        color[0] = 230, color[1] = 120, color[2] = 30;
      }
      const int dx = x - right, dy = y - 330;
      if (dx * dx + 3 * dy * dy < 60 * 60) color[0] = 60, color[1] = 90, color[2] = 190;
      for (const int channel : color) rgb.push_back(static_cast<std::uint8_t>(channel));
    }
  }
  return rgb;
}

// The WidowX at the start of its table tasks, gripper open.
policy::Proprioception at_start() {
  Mat3 down;
  down << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  policy::Proprioception measured;
  measured.tcp_in_base = {{0.3, 0.0, 0.14}, Quat(down)};
  measured.openness = 1;
  measured.joints = {-0.018, 0.040, 0.222, -0.005, 1.365, 0.002, 0.037, 0.037};
  return measured;
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
      : profile_(choice.profile), transport_(transport), result_(result) {}

  void run() {
    if (!connect()) return;
    std::vector<Chunk> chunks;
    for (int i = 0; i < kObservations; ++i) {
      auto chunk = ask("answer", i, kPrompts[0]);
      if (!chunk) return;
      chunks.push_back(std::move(*chunk));
    }
    result_.checks.push_back({"answer",
                              Verdict::kFine,
                              std::to_string(kObservations) + " observations answered with actions",
                              {}});
    for (Check& check : judge_answers(profile_, chunks)) result_.checks.push_back(std::move(check));
    double changes = 0;
    for (const Chunk& chunk : chunks) changes = std::max(changes, difference(chunk, chunks[0]));
    check_sameness(chunks[0], changes);
    judge_times();
  }

 private:
  bool connect() {
    const auto begun = Clock::now();
    auto opened = transport_.open(deadlines());
    if (opened) opened = transport_.adapt(profile_);
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

  // The first answer of an episode. On a failure the check is written and the session is over.
  std::optional<Chunk> ask(const char* name, int index, const char* prompt) {
    policy::EpisodeStart start;
    start.task = "policy_test";
    start.prompt = prompt;
    start.index = index;
    start.horizon = kHorizon;
    const wire::Bytes rgb = picture(index);
    const policy::Image image{kWidth, kHeight, rgb};
    // One picture stands for every camera that the profile names.
    std::vector<policy::CameraImage> cameras;
    for (const ImageRule& rule : profile_.images) cameras.push_back({rule.camera, image});
    policy::Observation seen;
    seen.image = image;
    seen.cameras = cameras;
    seen.prompt = prompt;
    seen.proprioception = at_start();
    seen.horizon = kHorizon;
    auto answer = [&]() -> Result<Chunk> {
      if (profile_.connection == ConnectionUse::kPerEpisode && result_.queries > 0) {
        transport_.close();
        PROBE_TRY(transport_.open(deadlines()));
      }
      PROBE_TRY(transport_.begin_episode(start, deadlines()));
      PROBE_ASSIGN(const Request request, to_request(profile_, seen));
      const auto begun = Clock::now();
      ++result_.queries;
      PROBE_ASSIGN(Chunk chunk, transport_.ask(request, deadlines()));
      times_.push_back(seconds_since(begun));
      PROBE_TRY(transport_.end_episode({true, false, 1}, deadlines()));
      return chunk;
    }();
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
      const auto again = ask("repetition", 0, kPrompts[0]);
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
    const auto other = ask("instruction", 0, kPrompts[1]);
    if (!other) return;
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

  void judge_times() {
    if (times_.empty()) return;
    result_.first_s = times_.front();
    std::vector<double> later(times_.begin() + (times_.size() > 1 ? 1 : 0), times_.end());
    std::sort(later.begin(), later.end());
    result_.median_s = later[later.size() / 2];
    result_.slowest_s = later.back();
    Check check{"latency",
                Verdict::kFine,
                "first answer " + number(result_.first_s) + " s, then " + number(result_.median_s) +
                    " s, slowest " + number(result_.slowest_s) + " s",
                {}};
    if (result_.slowest_s > profile_.answer_s / 2) {
      check.verdict = Verdict::kWarning;
      check.found += ", near the profile's limit of " + number(profile_.answer_s) + " s";
      check.fix = {"timeout.answer_s = " + number(4 * result_.slowest_s)};
    }
    result_.checks.push_back(std::move(check));
  }

  Deadlines deadlines() const {
    const double answer =
        times_.empty() ? std::max(profile_.first_s, profile_.answer_s) : profile_.answer_s;
    return {wire::Duration(static_cast<std::int64_t>(profile_.connect_s * 1000)),
            wire::Duration(static_cast<std::int64_t>(answer * 1000))};
  }

  Profile profile_;
  Transport& transport_;
  Conformance& result_;
  std::vector<double> times_;
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

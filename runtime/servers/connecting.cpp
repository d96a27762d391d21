#include "runtime/servers/connecting.h"

#include <algorithm>
#include <thread>

#include "runtime/servers/api_key.h"

namespace probe::servers {
namespace {

using Clock = std::chrono::steady_clock;

constexpr wire::Duration kFirstPause{100};
constexpr wire::Duration kLongestPause{5000};

}  // namespace

wire::Duration to_duration(double seconds) {
  return wire::Duration(static_cast<std::int64_t>(seconds * 1000));
}

Failure named(Failure failure, const std::string& server) {
  if (failure.where.empty()) failure.where = server;
  if (failure.code == Fault::kAnswered) failure.code = Fault::kPolicy;
  // A server may repeat the key that it refuses.
  failure.message = without_key(failure.message);
  return failure;
}

Result<int> open_patiently(Transport& transport, const Profile& given, const std::string& server,
                           Profile* adapted) {
  const Deadlines deadlines{to_duration(given.connect_s),
                            to_duration(std::max(given.first_s, given.answer_s))};
  const auto limit = Clock::now() + to_duration(given.wait_s);
  wire::Duration pause = kFirstPause;
  for (int attempt = 1;; ++attempt) {
    *adapted = given;
    auto opened = transport.open(deadlines);
    bool is_answer = opened.ok();
    if (opened) opened = transport.adapt(*adapted);
    // What the server says and what the profile says must go together, too.
    if (opened) opened = check_profile(*adapted);
    if (opened) return attempt;
    transport.close();
    is_answer = is_answer || opened.failure().code == Fault::kAnswered;
    Failure failure = named(opened.failure(), server);
    if (is_answer || failure.code == Fault::kUsage) return failure;
    if (Clock::now() + pause > limit) {
      if (attempt > 1) failure.message += " (tried " + std::to_string(attempt) + " times)";
      return failure;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, kLongestPause);
  }
}

}  // namespace probe::servers

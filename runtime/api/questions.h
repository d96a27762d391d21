// Worlds of a run that ask one callback: questions that wait go together, so that one forward pass
// answers all of them. The world that finds the callback free makes the call for the others.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "runtime/api/vlaprobe.h"
#include "runtime/base/result.h"
#include "runtime/policy/policy.h"

struct vlaprobe_refusals {
  std::vector<std::optional<std::string>> why;  // by question
};

namespace probe::api {

struct AskOptions {
  vlaprobe_act_callback act = nullptr;
  void* user = nullptr;
  std::size_t most = 1;  // questions in a call
  double gather_s = 0.1;
  std::function<bool()> stopped;
};

class Questions {
 public:
  explicit Questions(AskOptions options) : options_(std::move(options)) {}

  // A world will ask, and asks no more: others do not wait for it. Gives the world its number.
  int come();
  void go(int world);

  // Waits for the answer. Fails (kPolicy) with what the callback said in refusal, and when the run
  // is stopped.
  Result<policy::Action> ask(const vlaprobe_question& question);

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    const vlaprobe_question* question;
    Clock::time_point since;
    std::optional<Result<policy::Action>> answer = {};
  };
  bool is_due(Clock::time_point now) const;  // under mutex_
  std::vector<Waiting*> take();              // under mutex_
  void answer(const std::vector<Waiting*>& batch) const;

  AskOptions options_;
  std::mutex mutex_;  // what follows
  std::condition_variable changed_;
  std::vector<Waiting*> waiting_;
  std::vector<bool> here_;  // by number of the world
  bool is_busy_ = false;
};

// One world's policy; `questions` is the run's.
std::unique_ptr<policy::Policy> make_asking(std::shared_ptr<Questions> questions);

}  // namespace probe::api

// An episode of the text that is shown, as it happens and afterwards: played by a policy, looked at
// step by step, explained.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/stage/stage.h"
#include "runtime/store/trace.h"
#include "runtime/studio/shown.h"
#include "runtime/wire/listener.h"

namespace probe::studio {

struct PlayWish {
  std::string task, policy;
  std::uint32_t start = 0;
  int seed = 0;
};

// Answers:
//   {kind: "playing", task, start, policy, prompt, horizon, hz, metrics[name]}
//   picture {kind: "step", step, values[]}         as it happens; some have no picture when the
//   page
//                                                  is slow: {kind: "step", ...} as text
//   {kind: "played", steps, invalid, remark, seconds, values[]}   the values as the metrics of
//   "playing" {kind: "stopped", message}                     when it was ended or could not be
//   begun picture {kind: "moment", step}                 of look() {kind: "why", metrics[...]} or
//   {kind: "why", message}
class Player {
 public:
  using Tell = std::function<void(wire::Frame)>;
  // Bytes that the page has not taken yet.
  using Unread = std::function<std::size_t()>;

  Player(Tell tell, Unread unread) : tell_(std::move(tell)), unread_(std::move(unread)) {}
  ~Player();

  // Ends what plays.
  void play(std::shared_ptr<const Shown> shown, PlayWish wish);
  void stop();
  // The episode after `step` steps, drawn again from its state. Nothing where it has none.
  void look(int step);
  void why(const std::string& metric);
  // A table of one start (dsl/reference.md) that begins as the episode is after `step` steps, and
  // the task that it was of. Nothing where there is none.
  struct Start {
    std::string task, table;
  };
  std::optional<Start> start_at(int step);

 private:
  struct Run;
  class Watcher;
  struct Episode {
    std::shared_ptr<const Shown> shown;  // outlives the stage
    std::uint32_t task = 0;
    PlayWish wish;
    std::unique_ptr<stage::Stage> stage;
    std::vector<stage::StageState> states;  // by step
    store::Trace trace;
    std::string remark;
  };
  // Who waits for a policy that does not answer is let go, and ends when its server's time is up.
  void let_go(bool is_told);
  void say(Json json) const;

  const Tell tell_;
  const Unread unread_;
  std::shared_ptr<Run> run_;  // the last that was begun
  std::thread thread_;        // its
};

}  // namespace probe::studio

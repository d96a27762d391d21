// vla-eval's protocol 1 from the server's side, see vlaeval.cpp. Pictures are read raw: whoever
// sends them as PNG is told so. With batches, the questions of all connections are gathered as its
// own server gathers them (model_servers/base.py), and GET /config says how many and how long.
#include <charconv>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "runtime/base/clock.h"
#include "runtime/base/json.h"
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/servers/protocols/vlaeval_messages.h"

namespace probe::servers {
namespace {

wire::Value part_of_spec(const char* name, int dims, const char* format) {
  return wire::Map{{"name", name}, {"dims", dims}, {"format", format}};
}

// Answers questions of several connections together, of a policy that keeps nothing between them.
class Gathering {
 public:
  using Answer = Result<std::vector<policy::Action>>;

  explicit Gathering(const ServeOptions& options)
      : limit_(options.batch), policy_(options.policy()), thread_([this] { work(); }) {}
  // When no connection is left.
  ~Gathering() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    came_.notify_all();
    thread_.join();
  }
  Gathering(const Gathering&) = delete;
  Gathering& operator=(const Gathering&) = delete;

  Answer answer(const Asked& asked) {
    Waiting mine{&asked, Clock::now(), std::nullopt};
    std::unique_lock lock(mutex_);
    waiting_.push_back(&mine);
    came_.notify_all();
    done_.wait(lock, [&] { return mine.answer.has_value(); });
    return std::move(*mine.answer);
  }

  // "/config?max_batch_size=8&max_wait_time=0.05" changes what it names and says what holds.
  std::optional<wire::Page> page(const std::string& target) {
    constexpr const char* kJson = "application/json";
    if (target == "/health") return wire::Page{200, kJson, "{\"status\":\"ok\"}"};
    const std::size_t mark = std::min(target.find('?'), target.size());
    if (target.substr(0, mark) != "/config") return std::nullopt;
    const std::lock_guard lock(mutex_);
    Json applied = Json::object();
    for (std::size_t begin = mark + 1; begin < target.size();) {
      const std::size_t end = std::min(target.find('&', begin), target.size());
      if (!apply(std::string_view(target).substr(begin, end - begin), applied)) {
        Json refused;
        refused["error"] = "no such value: " + target;
        return wire::Page{400, kJson, refused.dump()};
      }
      begin = end + 1;
    }
    const Json config{{"max_batch_size", most_}, {"max_wait_time", wait_s_}};
    return wire::Page{200, kJson, Json{{"applied", applied}, {"config", config}}.dump()};
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    const Asked* asked;
    Clock::time_point came;
    std::optional<Answer> answer;
  };
  static constexpr double kLongestWait = 60;  // s

  // "max_batch_size=8"; of other names nothing. More than the server takes is cut to that.
  bool apply(std::string_view setting, Json& applied) {
    const std::size_t mark = std::min(setting.find('='), setting.size());
    const std::string_view name = setting.substr(0, mark);
    const std::string_view text = setting.substr(std::min(mark + 1, setting.size()));
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = error == std::errc() && end == text.data() + text.size();
    if (name == "max_batch_size") {
      if (!is_number || !(value >= 1)) return false;
      most_ = value < limit_ ? static_cast<int>(value) : limit_;
      applied["max_batch_size"] = most_;
    } else if (name == "max_wait_time") {
      if (!is_number || !(value >= 0 && value <= kLongestWait)) return false;
      wait_s_ = value;
      applied["max_wait_time"] = wait_s_;
    }
    return true;
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      came_.wait(lock, [this] { return is_over_ || !waiting_.empty(); });
      if (is_over_) return;
      const auto wait =
          std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wait_s_));
      const auto most = [this] { return static_cast<std::size_t>(most_); };
      came_.wait_until(lock, waiting_.front()->came + wait,
                       [&] { return is_over_ || waiting_.size() >= most(); });
      std::vector<Waiting*> batch;
      while (batch.size() < most() && !waiting_.empty()) {
        batch.push_back(waiting_.front());
        waiting_.pop_front();
      }
      lock.unlock();
      std::vector<Answer> answers = answer_all(batch);
      lock.lock();
      for (std::size_t i = 0; i < batch.size(); ++i) batch[i]->answer = std::move(answers[i]);
      done_.notify_all();
    }
  }

  // One pass for all; where that fails each alone, as a question spoils no other connection's.
  std::vector<Answer> answer_all(const std::vector<Waiting*>& batch) {
    std::vector<Asked> asked;
    for (const Waiting* one : batch) asked.push_back(*one->asked);
    std::vector<Answer> answers;
    if (auto all = policy_->answer_all(asked, 1); all && all->size() == batch.size()) {
      for (auto& actions : *all) answers.emplace_back(std::move(actions));
    } else {
      for (const Asked& one : asked) answers.push_back(policy_->answer(one, 1));
    }
    return answers;
  }

  const int limit_;
  std::unique_ptr<ServedPolicy> policy_;
  std::mutex mutex_;  // all that follows
  std::condition_variable came_, done_;
  std::deque<Waiting*> waiting_;
  int most_ = 1;          // as its own server begins
  double wait_s_ = 0.01;  // from the first question of a batch
  bool is_over_ = false;
  std::thread thread_;
};

class VlaEvalSpeaker final : public wire::Speaker {
 public:
  // `gathering` may be null: then a connection has a policy of its own.
  VlaEvalSpeaker(const ServeOptions& options, std::shared_ptr<Gathering> gathering)
      : policy_(options.policy()), gathering_(std::move(gathering)) {}

  Reply answer(const wire::Frame& asked) override {
    const auto message = vlaeval::from_bytes(asked.bytes);
    if (!message) return {{}, message.failure().message};
    if (message->type == "hello") return said("hello", hello(), message->seq);
    if (message->type == "episode_start") policy_->reset();
    if (message->type != "observation") return {};
    auto action = [&]() -> Result<wire::Value> {
      const wire::Value* images = message->payload.find("images");
      PROBE_ASSIGN(wire::Array picture, first_picture(images == nullptr ? wire::Value() : *images));
      PROBE_ASSIGN(std::string words, text_at(message->payload, "task_description"));
      const Asked seen{std::move(picture), std::move(words)};
      PROBE_ASSIGN(const auto actions,
                   gathering_ ? gathering_->answer(seen) : policy_->answer(seen, 1));
      const std::vector<double> numbers(actions.front().begin(), actions.front().end());
      return wire::Value(wire::Map{{"actions", wire::array_f64({7}, numbers)}});
    }();
    if (action) return said("action", std::move(*action), message->seq);
    return said("error", wire::Map{{"error", "observation_failed: " + action.failure().message}},
                message->seq);
  }

 private:
  static wire::Value hello() {
    return wire::Map{
        {"harness_version", "vlaprobe"},
        {"protocol_version", 1},
        {"model_server", "vlaprobe serve"},
        {"capabilities", wire::Map{}},
        {"observation_params", wire::Map{{"send_state", false}}},
        {"action_spec", wire::Map{{"position", part_of_spec("position", 3, "delta_xyz")},
                                  {"rotation", part_of_spec("rotation", 3, "axis_angle")},
                                  {"gripper", part_of_spec("gripper", 1, "raw")}}}};
  }
  static Reply said(std::string type, wire::Value payload, std::int64_t seq) {
    return {{wire::Frame{
        false, vlaeval::to_bytes({std::move(type), std::move(payload), seq}, unix_seconds())}}};
  }

  std::unique_ptr<ServedPolicy> policy_;
  std::shared_ptr<Gathering> gathering_;
};

}  // namespace

Result<std::unique_ptr<wire::Listener>> serve_vlaeval(const ServeOptions& options) {
  std::shared_ptr<Gathering> gathering;
  wire::AnswerPage page;
  if (options.batch > 1) {
    gathering = std::make_shared<Gathering>(options);
    page = [gathering](const std::string& target) { return gathering->page(target); };
  }
  return wire::listen_websocket(
      options.address, options.port,
      [options, gathering] { return std::make_unique<VlaEvalSpeaker>(options, gathering); },
      options.tls, std::move(page));
}

}  // namespace probe::servers

#include "runtime/servers/batch.h"

#include <algorithm>
#include <system_error>

namespace probe::servers {
namespace {

class Batched final : public Transport {
 public:
  explicit Batched(std::shared_ptr<BatchLine> line) : line_(std::move(line)) {}
  ~Batched() override { leave(); }

  Status open(const Deadlines& deadlines) override { return line_->open(deadlines); }
  Status adapt(Profile& profile) const override { return line_->adapt(profile); }
  // The others' connection stands.
  void close() override { leave(); }

  Status begin_episode(const policy::EpisodeStart&, const Deadlines&) override {
    if (!is_here_) line_->come();
    is_here_ = true;
    return {};
  }
  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    return line_->ask(request, deadlines);
  }
  Status end_episode(const policy::EpisodeEnd&, const Deadlines&) override {
    leave();
    return {};
  }

  std::vector<std::string> notes() const override { return line_->notes(); }
  std::vector<std::string> remarks() const override { return line_->remarks(); }

 private:
  void leave() {
    if (is_here_) line_->go();
    is_here_ = false;
  }

  std::shared_ptr<BatchLine> line_;
  bool is_here_ = false;  // in an episode, so that others wait for its questions
};

}  // namespace

BatchLine::BatchLine(std::unique_ptr<Transport> transport, BatchLimits limits,
                     policy::QueryMeter* queries, std::shared_ptr<Identity> identity,
                     Profile profile)
    : limits_(limits),
      queries_(queries),
      identity_(std::move(identity)),
      given_(std::move(profile)),
      transport_(std::move(transport)) {
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    is_over_ = true;  // ask() says so
  }
}

BatchLine::~BatchLine() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  asked_.notify_all();
  if (thread_.joinable()) thread_.join();
}

Status BatchLine::open(const Deadlines& deadlines) {
  const std::uint64_t before = attempts_;
  const std::lock_guard lock(line_);
  if (is_open_) return {};
  if (attempts_ != before) return last_attempt_;  // made while this one waited
  last_attempt_ = connect(deadlines);
  ++attempts_;
  return last_attempt_;
}

Status BatchLine::connect(const Deadlines& deadlines) {
  const auto attempt = [&]() -> Status {
    PROBE_TRY(transport_->open(deadlines));
    if (!identity_) return {};
    Profile adapted = given_;
    PROBE_TRY(transport_->adapt(adapted));
    PROBE_TRY(identity_->check(*transport_, adapted));
    known_.reset();
    if (!identity_->first().is_steady) return {};
    const KnownObservations questions(adapted, *transport_, identity_->first().arm);
    PROBE_ASSIGN(known_, questions.request_of(identity_->first().observations.front()));
    return {};
  };
  Status opened = attempt();
  is_open_ = opened.ok();
  if (!is_open_) transport_->close();
  return opened;
}

Result<std::vector<BatchLine::Answer>> BatchLine::ask_all(std::vector<const Request*> requests,
                                                          const Deadlines& deadlines) {
  // Beside questions of which nobody knows the answer, one that is known: it costs a place that is
  // free, and an answer that is not its own says that the others are not theirs.
  const bool has_known =
      known_ && requests.size() > 1 && requests.size() < static_cast<std::size_t>(limits_.most);
  if (has_known) requests.push_back(&*known_);
  PROBE_ASSIGN(auto answers, transport_->ask_all(requests, deadlines));
  if (!has_known || answers.empty()) return answers;
  const Answer known = std::move(answers.back());
  answers.pop_back();
  if (known && !identity_->is_first_answer(*known)) {
    identity_->note_mixed();
    return bad("a question beside others has another answer than alone; ask without `batch`");
  }
  return answers;
}

Status BatchLine::adapt(Profile& profile) const {
  const std::lock_guard lock(line_);
  return transport_->adapt(profile);
}

std::vector<std::string> BatchLine::notes() const {
  const std::lock_guard lock(line_);
  return transport_->notes();
}

std::vector<std::string> BatchLine::remarks() const {
  const std::lock_guard lock(line_);
  return transport_->remarks();
}

void BatchLine::come() {
  const std::lock_guard lock(mutex_);
  ++worlds_;
}

void BatchLine::go() {
  {
    const std::lock_guard lock(mutex_);
    --worlds_;
  }
  asked_.notify_all();  // nobody waits for it any more
}

BatchLine::Answer BatchLine::ask(const Request& request, const Deadlines& deadlines) {
  const auto question = std::make_shared<Question>(request, deadlines);
  std::unique_lock lock(mutex_);
  if (is_over_) return bad("the system gives no thread to send batches on");
  waiting_.push_back(question);
  asked_.notify_all();
  answered_.wait_until(lock, question->until, [&] { return question->answer.has_value(); });
  if (question->answer) return std::move(*question->answer);
  std::erase(waiting_, question);
  return bad("no answer in " + wire::seconds_text(deadlines.answer));
}

std::size_t BatchLine::enough() const {
  return static_cast<std::size_t>(std::clamp(worlds_, 1, limits_.most));
}

BatchLine::Questions BatchLine::take() {
  Questions batch;
  while (!waiting_.empty() && batch.size() < static_cast<std::size_t>(limits_.most)) {
    batch.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  return batch;
}

void BatchLine::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    asked_.wait(lock, [&] { return is_over_ || !waiting_.empty(); });
    if (is_over_) return;
    // The first may give up while others come, so its time is looked at anew.
    while (!is_over_ && !waiting_.empty() && waiting_.size() < enough()) {
      const auto sent = waiting_.front()->since + limits_.wait;
      if (asked_.wait_until(lock, sent) == std::cv_status::timeout && Clock::now() >= sent) break;
    }
    const Questions batch = take();
    if (batch.empty()) continue;
    lock.unlock();
    auto answers = send(batch);
    lock.lock();
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (answers) {
        batch[i]->answer = std::move((*answers)[i]);
      } else {
        batch[i]->answer = answers.failure();
      }
    }
    answered_.notify_all();
  }
}

// On the line's own thread, which nothing may leave by. What was under way then is unknown.
Result<std::vector<BatchLine::Answer>> BatchLine::send(const Questions& batch) {
  const auto dropped = [&](const char* what) {
    const std::lock_guard lock(line_);
    transport_->close();
    is_open_ = false;
    return bad(std::string("a batch: ") + what);
  };
  try {
    return exchange(batch);
  } catch (const std::exception& error) {
    return dropped(error.what());
  } catch (...) {
    return dropped("something that says nothing of itself");
  }
}

Result<std::vector<BatchLine::Answer>> BatchLine::exchange(const Questions& batch) {
  const auto now = Clock::now();
  Deadlines deadlines = batch.front()->deadlines;
  auto until = batch.front()->until;
  double gathered_s = 0;
  std::vector<const Request*> requests;
  for (const auto& question : batch) {
    until = std::max(until, question->until);
    gathered_s += std::chrono::duration<double>(now - question->since).count();
    requests.push_back(&question->request);
  }
  deadlines.answer = std::chrono::ceil<wire::Duration>(until - now);
  const std::lock_guard lock(line_);
  if (!is_open_) {
    if (auto opened = connect(deadlines); !opened) return opened.failure();
  }
  const int count = static_cast<int>(batch.size());
  if (queries_ != nullptr) queries_->add_batch(count, gathered_s);
  const policy::QueryMeter::InFlight flight(queries_, count);
  auto answers = ask_all(std::move(requests), deadlines);
  if (!answers) {
    transport_->close();
    is_open_ = false;
  }
  return answers;
}

Result<std::shared_ptr<BatchLine>> SharedLine::get(const Make& make) {
  const std::lock_guard lock(mutex_);
  if (!line_) {
    PROBE_ASSIGN(line_, make());
  }
  return line_;
}

std::unique_ptr<Transport> make_batched(std::shared_ptr<BatchLine> line) {
  return std::make_unique<Batched>(std::move(line));
}

}  // namespace probe::servers

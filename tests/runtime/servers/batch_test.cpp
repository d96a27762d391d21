// Questions of many worlds in one message: who waits for whom, whose answer is whose, and what is
// refused.
#include "runtime/servers/batch.h"

#include <doctest/doctest.h>

#include <atomic>
#include <set>
#include <thread>

#include "runtime/base/clock.h"
#include "runtime/base/sha256.h"
#include "runtime/policy/reading.h"
#include "runtime/servers/conformance.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/reading.h"
#include "runtime/servers/served.h"
#include "runtime/servers/servers.h"
#include "runtime/servers/transcript.h"
#include "runtime/wire/http.h"
#include "runtime/wire/msgpack.h"
#include "tests/servers/python_server.h"

namespace probe::servers {
namespace {

using Clock = std::chrono::steady_clock;

// A server's side without a wire: answers `step` of each request, after a time.
struct Told {
  std::mutex mutex;
  std::vector<std::size_t> sizes;  // of batches, in order
  std::atomic<int> opened = 0;
};
class Counting final : public Transport {
 public:
  Counting(std::shared_ptr<Told> told, std::chrono::milliseconds time, std::string fails)
      : told_(std::move(told)), time_(time), fails_(std::move(fails)) {}

  Status open(const Deadlines&) override {
    ++told_->opened;
    return {};
  }
  void close() override {}
  Result<std::vector<RawAction>> ask(const Request&, const Deadlines&) override {
    return bad("asked alone");
  }
  Result<BatchAnswers> ask_all(std::span<const Request* const> requests,
                               const Deadlines& deadlines) override {
    {
      const std::lock_guard lock(told_->mutex);
      told_->sizes.push_back(requests.size());
    }
    if (time_ > deadlines.answer) {
      std::this_thread::sleep_for(deadlines.answer);
      return bad("no answer in time");
    }
    std::this_thread::sleep_for(time_);
    if (!fails_.empty()) return bad(fails_);
    BatchAnswers all;
    for (const Request* request : requests)
      all.push_back(
          std::vector<RawAction>{RawAction{static_cast<double>(request->step), 0, 0, 0, 0, 0, 1}});
    return all;
  }

 private:
  std::shared_ptr<Told> told_;
  std::chrono::milliseconds time_;
  std::string fails_;
};

struct TestLine {
  std::shared_ptr<Told> told = std::make_shared<Told>();
  policy::QueryMeter meter;
  std::shared_ptr<BatchLine> line;

  TestLine(BatchLimits limits, std::chrono::milliseconds time, const std::string& fails = "") {
    line =
        std::make_shared<BatchLine>(std::make_unique<Counting>(told, time, fails), limits, &meter);
  }
  // A world in an episode.
  std::unique_ptr<Transport> world() const {
    auto transport = make_batched(line);
    REQUIRE(transport->open({}).ok());
    REQUIRE(transport->begin_episode({}, {}).ok());
    return transport;
  }
};

Request numbered(int step) {
  Request request;
  request.step = step;
  return request;
}

constexpr wire::Duration kLong{20'000};

// An openpi server that answers batches as it likes.
class Answering final : public wire::Speaker {
 public:
  using Form = std::function<wire::Value(const wire::List&)>;
  explicit Answering(Form form) : form_(std::move(form)) {}
  std::vector<wire::Frame> greet() override { return {packed(wire::Map{})}; }
  Reply answer(const wire::Frame& asked) override {
    const auto request = wire::from_msgpack(asked.bytes);
    const wire::Value* batch = request.ok() ? request->find("batch") : nullptr;
    const auto* items = batch == nullptr ? nullptr : batch->as<wire::List>();
    return {
        {packed(items == nullptr ? wire::Value(wire::Map{{"actions", still()}}) : form_(*items))}};
  }
  static wire::Array still() { return wire::array_f64({1, 7}, {0, 0, 0, 0, 0, 0, 1}); }

 private:
  static wire::Frame packed(const wire::Value& value) {
    return {false, wire::to_msgpack(value, wire::ArrayStyle::kBinKeys)};
  }
  Form form_;
};

Request pictured(int number) {
  Request request = numbered(number);
  request.prompt = "put carrot on plate";
  request.images.push_back(
      {"observation/image",
       wire::array_u8({2, 2, 3}, wire::Bytes(12, static_cast<std::uint8_t>(number)))});
  return request;
}

// What three questions in one message fail with, or "".
std::string failure_of(const Answering::Form& form) {
  const auto listener = wire::listen_websocket(
      "127.0.0.1", "0", [form] { return std::make_unique<Answering>(form); });
  REQUIRE(listener.ok());
  const auto choice =
      choose_server(Protocol::kOpenpi, "//127.0.0.1:" + (*listener)->port() + "?batch=8");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  const auto transport = make_transport(*choice);
  REQUIRE(transport.ok());
  REQUIRE((*transport)->open({}).ok());
  const Request requests[] = {pictured(1), pictured(2), pictured(3)};
  const Request* all[] = {&requests[0], &requests[1], &requests[2]};
  const auto answers = (*transport)->ask_all(all, {});
  if (!answers) return answers.failure().message;
  for (const auto& answer : *answers) {
    if (!answer) return answer.failure().message;
  }
  return "";
}

std::string refusal(Protocol protocol, const std::string& options) {
  const auto choice = choose_server(protocol, "//localhost:1?" + options);
  return choice.ok() ? "" : choice.failure().message;
}

}  // namespace

TEST_CASE("eight worlds that wait are asked in one message, and each has its own answer") {
  TestLine made({.most = 8, .wait = kLong}, std::chrono::milliseconds(20));
  std::vector<std::unique_ptr<Transport>> worlds;
  for (int i = 0; i < 8; ++i) worlds.push_back(made.world());
  std::vector<std::thread> threads;
  std::vector<double> answers(8, -1);
  for (std::size_t i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      const auto answer = worlds[i]->ask(numbered(static_cast<int>(i)), {.answer = kLong});
      if (answer.ok()) answers[i] = answer->front()[0];
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < 8; ++i) CHECK(answers[i] == static_cast<double>(i));
  CHECK(made.told->sizes == std::vector<std::size_t>{8});
  CHECK(made.told->opened == 1);
  const auto figures = made.meter.figures();
  CHECK(figures.queries == 8);
  CHECK(figures.batches == 1);
  CHECK(figures.most_in_batch == 8);
  CHECK(figures.busy_s < 0.5 * 8 * 0.1);
}

TEST_CASE("a batch waits for a world that simulates, as long as it is told and no longer") {
  TestLine made({.most = 8, .wait = wire::Duration(150)}, std::chrono::milliseconds(0));
  const auto asks = made.world(), simulates = made.world();
  const auto begun = Clock::now();
  REQUIRE(asks->ask(numbered(1), {.answer = kLong}).ok());
  CHECK(seconds_since(begun) >= 0.149);
  CHECK(made.told->sizes == std::vector<std::size_t>{1});
  CHECK(made.meter.figures().gathering_s >= 0.149);
}

TEST_CASE("a batch does not wait for worlds that will not come") {
  TestLine made({.most = 8, .wait = kLong}, std::chrono::milliseconds(0));
  const auto asks = made.world();
  auto ends = made.world(), fails = made.world();
  std::thread leaving([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK(ends->end_episode({}, {}).ok());
    fails->close();  // as after a failure of its own
  });
  const auto begun = Clock::now();
  CHECK(asks->ask(numbered(1), {.answer = kLong}).ok());
  CHECK(seconds_since(begun) < 10);
  leaving.join();
  // The last one runs alone, at once.
  CHECK(asks->ask(numbered(2), {.answer = kLong}).ok());
  CHECK(seconds_since(begun) < 10);
}

TEST_CASE("a question's time is its own, whatever else is in its batch") {
  TestLine made({.most = 2, .wait = kLong}, std::chrono::milliseconds(400));
  const auto patient = made.world(), hasty = made.world();
  std::string failure;
  std::thread waits([&] {
    const auto answer = hasty->ask(numbered(1), {.answer = wire::Duration(100)});
    if (!answer.ok()) failure = answer.failure().message;
  });
  const auto answer = patient->ask(numbered(2), {.answer = kLong});
  waits.join();
  CHECK(failure == "no answer in 0.1 s");
  REQUIRE_MESSAGE(answer.ok(), to_text(answer.failure()));
  CHECK(answer->front()[0] == 2);
}

TEST_CASE("what fails a batch fails each of its questions, and the next one connects again") {
  TestLine made({.most = 2, .wait = kLong}, std::chrono::milliseconds(0), "no GPU");
  const auto a = made.world(), b = made.world();
  std::string of_b;
  std::thread other([&] {
    const auto answer = b->ask(numbered(1), {.answer = kLong});
    if (!answer.ok()) of_b = answer.failure().message;
  });
  const auto of_a = a->ask(numbered(2), {.answer = kLong});
  other.join();
  REQUIRE_FALSE(of_a.ok());
  CHECK(of_a.failure().message == "no GPU");
  CHECK(of_b == "no GPU");
  a->close();
  b->close();
  CHECK_FALSE(made.world()->ask(numbered(3), {.answer = kLong}).ok());
  CHECK(made.told->opened == 2);
}

TEST_CASE("a batch's answer of another length, or with a failed item, is refused by name") {
  const auto answered = [](std::size_t count) {
    return [count](const wire::List&) -> wire::Value {
      wire::List items(count, wire::Map{{"actions", Answering::still()}});
      return wire::Map{{"batch", std::move(items)}};
    };
  };
  CHECK(failure_of(answered(3)) == "");
  CHECK(failure_of(answered(2)) ==
        "a batch of 3 observations was answered with 2 items: which is whose cannot be said");
  CHECK(failure_of(answered(4)) ==
        "a batch of 3 observations was answered with 4 items: which is whose cannot be said");
  // The list alone.
  CHECK(failure_of([](const wire::List& asked) -> wire::Value {
          return wire::List(asked.size(), wire::Map{{"actions", Answering::still()}});
        }) == "");
  const auto second = [](wire::Value item) {
    return [item](const wire::List& asked) -> wire::Value {
      wire::List items(asked.size(), wire::Map{{"actions", Answering::still()}});
      items[1] = item;
      return wire::Map{{"batch", std::move(items)}};
    };
  };
  CHECK(failure_of(second(wire::Map{{"error", "CUDA out of memory"}})) ==
        "item 2 of 3 of a batch: the server failed: CUDA out of memory");
  CHECK(failure_of(second(wire::Map{{"actions", wire::array_f64({6}, {0, 0, 0, 0, 0, 0})}})) ==
        "item 2 of 3 of a batch: expected actions of 7 numbers, an array 7 or N x 7; got an array "
        "6 of <f8");
  CHECK(failure_of([](const wire::List& asked) -> wire::Value {
          wire::List items(asked.size(), wire::Map{{"actions", Answering::still()}});
          return wire::Map{{"batch", std::move(items)}, {"error", "partial failure"}};
        }) == "the server failed: partial failure");
  // A server that does not know batches answers as if it were one observation.
  CHECK(failure_of([](const wire::List&) -> wire::Value {
          return wire::Map{{"actions", Answering::still()}};
        }) == "expected a map with `batch`, a list of 3 answers; got a map with keys actions");
}

TEST_CASE("questions of vla-eval's connections are gathered, and one at fault spoils no other") {
  // Adds up what it saw; refuses words that it does not know, and with them the whole batch.
  class Summing final : public ServedPolicy {
   public:
    explicit Summing(std::vector<std::size_t>& sizes) : sizes_(sizes) {}
    void reset() override {}
    Result<std::vector<policy::Action>> answer(const Asked& asked, int) override {
      if (asked.words != "put carrot on plate") return bad("cannot read `" + asked.words + "`");
      return std::vector<policy::Action>{
          policy::Action{static_cast<double>(asked.picture.bytes.front()), 0, 0, 0, 0, 0, 1}};
    }
    Result<std::vector<std::vector<policy::Action>>> answer_all(std::span<const Asked> asked,
                                                                int count) override {
      sizes_.push_back(asked.size());  // of the gathering thread alone
      return ServedPolicy::answer_all(asked, count);
    }

   private:
    std::vector<std::size_t>& sizes_;
  };
  std::vector<std::size_t> sizes;
  ServeOptions options;
  options.batch = 4;
  options.policy = [&] { return std::make_unique<Summing>(sizes); };
  auto listener = serve(Protocol::kVlaEval, options);
  REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
  const auto choice =
      choose_server(Protocol::kVlaEval, "//127.0.0.1:" + (*listener)->port() + "?" +
                                            options_for_served(Protocol::kVlaEval, options) +
                                            "&image=first -> primary&batch_wait_ms=20000");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  std::vector<std::unique_ptr<Transport>> worlds;
  for (int i = 0; i < 4; ++i) {
    auto transport = make_transport(*choice);
    REQUIRE(transport.ok());
    const auto open = (*transport)->open({});
    REQUIRE_MESSAGE(open.ok(), to_text(open.failure()));
    policy::EpisodeStart start;
    start.task = "t";
    REQUIRE((*transport)->begin_episode(start, {}).ok());
    worlds.push_back(std::move(*transport));
  }
  std::vector<std::string> said(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      Request request = pictured(static_cast<int>(i));
      request.images.front().key = "primary";
      if (i == 3) request.prompt = "sing";
      const auto answer = worlds[i]->ask(request, {.answer = kLong});
      said[i] =
          answer ? std::to_string(static_cast<int>(answer->front()[0])) : answer.failure().message;
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(said[0] == "0");
  CHECK(said[1] == "1");
  CHECK(said[2] == "2");
  CHECK(said[3].find("cannot read `sing`") != std::string::npos);
  worlds.clear();
  const auto page = [&](const std::string& path) {
    wire::Endpoint server;
    server.host = "127.0.0.1";
    server.port = (*listener)->port();
    wire::HttpRequest asked;
    asked.path = path;
    const auto answer = wire::http_exchange(server, asked);
    REQUIRE_MESSAGE(answer.ok(), to_text(answer.failure()));
    return std::to_string(answer->status) + " " + answer->body;
  };
  CHECK(page("/health") == "200 {\"status\":\"ok\"}");
  CHECK(page("/config") ==
        "200 {\"applied\":{},\"config\":{\"max_batch_size\":4,\"max_wait_time\":20.0}}");
  CHECK(page("/config?max_batch_size=99&max_wait_time=0.5&other=1") ==
        "200 {\"applied\":{\"max_batch_size\":4,\"max_wait_time\":0.5},"
        "\"config\":{\"max_batch_size\":4,\"max_wait_time\":0.5}}");
  CHECK(page("/config?max_batch_size=none").find("400 ") == 0);
  CHECK(page("/elsewhere").find("404 ") == 0);
  listener->reset();
  CHECK(sizes == std::vector<std::size_t>{4});

  // Its own server without batches says so; so does ours.
  options.batch = 1;
  listener = serve(Protocol::kVlaEval, options);
  REQUIRE(listener.ok());
  const auto alone = choose_server(
      Protocol::kVlaEval, "//127.0.0.1:" + (*listener)->port() + "?" +
                              options_for_served(Protocol::kVlaEval, options) + "&batch=4");
  REQUIRE(alone.ok());
  const auto transport = make_transport(*alone);
  REQUIRE(transport.ok());
  const auto refused = (*transport)->open({});
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message.find("the server does not gather batches of 4") == 0);
}

TEST_CASE("batches are refused where a protocol or a profile has none") {
  CHECK(refusal(Protocol::kOpenpi, "batch=8") == "");
  CHECK(refusal(Protocol::kStarVla, "batch=8&batch_wait_ms=5") == "");
  CHECK(refusal(Protocol::kGr00t, "batch=8") ==
        "servers that speak gr00t take no batches; those do that speak openpi, vlaeval, starvla");
  CHECK(refusal(Protocol::kOpenpi, "batch=0") ==
        "`batch` is a whole number from 1 to 256, not `0`");
  CHECK(refusal(Protocol::kOpenpi, "batch=8&profile=simpler_shim")
            .find("`connection = per_episode`") != std::string::npos);
  CHECK(refusal(Protocol::kOpenpi, "batch=8&worlds=one").find("`worlds = one`") !=
        std::string::npos);
  ServeOptions options;
  options.policy = serve_digest().value();
  options.batch = 8;
  const auto listener = serve(Protocol::kIntact, options);
  REQUIRE_FALSE(listener.ok());
  CHECK(listener.failure().message == "protocol intact has no batches");
}

TEST_CASE("a run with batches is the run without") {
  const auto with = choose_server(Protocol::kOpenpi, "//localhost:1?batch=8");
  const auto without = choose_server(Protocol::kOpenpi, "//localhost:1");
  REQUIRE((with.ok() && without.ok()));
  CHECK(describe(*with) == describe(*without));
}

TEST_CASE("a served digest answers batches as it answers alone; one that mixes them is refused") {
  for (const Protocol protocol : {Protocol::kOpenpi, Protocol::kStarVla}) {
    CAPTURE(std::string(to_word(protocol)));
    ServeOptions options;
    options.policy = serve_digest().value();
    options.batch = 8;
    options.chunk = 4;
    const auto listener = serve(protocol, options);
    REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
    const auto choice = choose_server(protocol, "//127.0.0.1:" + (*listener)->port() + "?" +
                                                    options_for_served(protocol, options));
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    CHECK(choice->batch.most == 8);
    const auto reading = prove_reading(*choice);
    REQUIRE_MESSAGE(reading.ok(), to_text(reading.failure()));
    CHECK(policy::batch_remark(*reading) ==
          "in a batch of 8, questions had the answers that they have alone, bit for bit");
    const auto tested = test_server(*choice);
    REQUIRE(tested.ok());
    CHECK(tested->queries <= 20);
    CHECK(
        to_text(*tested).find("in a batch of 6, questions had the answers that they have alone") !=
        std::string::npos);
    // Recorded, such a conversation plays like any other.
    const auto transcript = record(*choice);
    REQUIRE(transcript.ok());
    const auto player = play(*transcript, "127.0.0.1", "0", nullptr);
    REQUIRE(player.ok());
    auto played = *choice;
    played.server.port = (*player)->port();
    const auto again = test_server(played);
    REQUIRE(again.ok());
    CHECK(to_text(*again).find("in a batch of 6, questions had the answers that they have alone") !=
          std::string::npos);
  }
  // Stock openpi: a server that takes no batches is told before the first episode.
  ServeOptions alone;
  alone.policy = serve_digest().value();
  const auto stock = serve(Protocol::kOpenpi, alone);
  REQUIRE(stock.ok());
  const auto choice =
      choose_server(Protocol::kOpenpi, "//127.0.0.1:" + (*stock)->port() + "?batch=8&" +
                                           options_for_served(Protocol::kOpenpi, alone));
  REQUIRE(choice.ok());
  const auto reading = prove_reading(*choice);
  REQUIRE_FALSE(reading.ok());
  CHECK(reading.failure().code == Fault::kPolicy);
  CHECK(reading.failure().message.find("it was not shown to answer batches: the server failed: "
                                       "vlaprobe: a batch of 8 questions, and this server takes no "
                                       "batches") == 0);
}

TEST_CASE(
    "a batch is proved in the size that is used, each of its questions with its own picture") {
  // Right up to four questions, and then the last is the first one's: no smaller batch shows it.
  class Confusing final : public wire::Speaker {
   public:
    std::vector<wire::Frame> greet() override { return {packed(wire::Map{})}; }
    Reply answer(const wire::Frame& asked) override {
      const auto request = wire::from_msgpack(asked.bytes);
      if (!request.ok()) return {{wire::text_frame(request.failure().message)}};
      const wire::Value* batch = request->find("batch");
      const auto* items = batch == nullptr ? nullptr : batch->as<wire::List>();
      if (items == nullptr) return {{packed(answer_to(*request))}};
      wire::List answers;
      for (const wire::Value& item : *items) answers.push_back(answer_to(item));
      if (answers.size() > 4) answers.back() = answers.front();
      return {{packed(wire::Map{{"batch", std::move(answers)}})}};
    }

   private:
    static wire::Frame packed(const wire::Value& value) {
      return {false, wire::to_msgpack(value, wire::ArrayStyle::kBinKeys)};
    }
    static wire::Value answer_to(const wire::Value& question) {
      const auto* words = question.find("prompt")->as<std::string>();
      const auto& pixels = question.find("observation/image")->as<wire::Array>()->bytes;
      const Sha256 seen =
          Hasher().bytes(std::as_bytes(std::span(pixels))).hash(sha256(*words)).finish();
      const double x = seen.bytes[0] / 10'000.0, y = seen.bytes[1] / 10'000.0;
      return wire::Map{{"actions", wire::array_f64({1, 7}, {x, y, 0, 0, 0, 0, 1})}};
    }
  };
  const auto listener =
      wire::listen_websocket("127.0.0.1", "0", [] { return std::make_unique<Confusing>(); });
  REQUIRE(listener.ok());
  const auto reading_of = [&](int size) {
    const auto choice = choose_server(
        Protocol::kOpenpi, "//127.0.0.1:" + (*listener)->port() + "?batch=" + std::to_string(size));
    REQUIRE(choice.ok());
    return prove_reading(*choice);
  };
  for (const int size : {2, 3, 4}) {
    const auto reading = reading_of(size);
    REQUIRE_MESSAGE(reading.ok(), to_text(reading.failure()));
    CHECK(reading->batch == size);
    CHECK(reading->answers == 3);
  }
  for (const int size : {5, 16}) {
    const auto refused = reading_of(size);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.failure().message.find("in a batch, question " + std::to_string(size) +
                                         " has the answer that question 1 has alone") !=
          std::string::npos);
  }
  // What is shown of a server does not depend on how many questions go together.
  CHECK(reading_of(2)->answers_sha256 == reading_of(4)->answers_sha256);
}

TEST_CASE("no two of the known pictures are alike") {
  std::set<Sha256> seen;
  for (int i = 0; i <= kMostInBatch; ++i) {
    const wire::Bytes picture = known_picture(i);
    seen.insert(sha256(std::as_bytes(std::span(picture))));
    if (i % 50 == 0) CHECK(is_known_observation(picture, "put carrot on plate"));
  }
  CHECK(seen.size() == kMostInBatch + 1);
  wire::Bytes other = known_picture(3);
  other.back() ^= 1;
  CHECK_FALSE(is_known_observation(other, "put carrot on plate"));
  CHECK_FALSE(is_known_observation(known_picture(3), "put carrot on plates"));
}

TEST_CASE("answers that stand in another order in a batch, or are one for all, are found") {
  const auto chunk = [](double x) { return Chunk{RawAction{x, 0, 0, 0, 0, 0, 1}}; };
  const std::vector<Chunk> alone = {chunk(1), chunk(2), chunk(3)};
  CHECK(compare_together(alone, alone).mixed.empty());
  CHECK(compare_together(alone, alone).difference == 0);
  CHECK(compare_together(alone, {chunk(1.25), chunk(2), chunk(3)}).difference == 0.25);
  CHECK(compare_together(alone, {chunk(2), chunk(1), chunk(3)}).mixed ==
        "in a batch, question 2 has the answer that question 1 has alone");
  CHECK(compare_together(alone, {chunk(1), chunk(1), chunk(1)}).mixed ==
        "in a batch, question 3 has the answer that question 1 has alone");
  // A pass over several rounds otherwise than over one.
  const auto noisy = [&](double x) { return chunk(x + 1e-6); };
  CHECK(compare_together(alone, {noisy(1), noisy(2), noisy(3)}).mixed.empty());
  CHECK(compare_together(alone, {noisy(2), noisy(1), noisy(3)}).mixed ==
        "in a batch, question 2 has the answer that question 1 has alone");
  CHECK(compare_together({chunk(1), chunk(1 + 1e-9)}, {noisy(1), noisy(1)}).mixed.empty());
  // A policy that answers everything alike is told of elsewhere.
  CHECK(compare_together({chunk(1), chunk(1)}, {chunk(1), chunk(1)}).mixed.empty());
}

TEST_CASE("the shim answers batches with a policy that takes several pictures") {
  const test::PythonServer server("shim_server.py", {"batches"});
  REQUIRE_FALSE(server.port().empty());
  const auto choice =
      choose_server(Protocol::kOpenpi, "//127.0.0.1:" + server.port() +
                                           "?profile=simpler_shim&connection=kept&batch=8");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  const auto transport = make_transport(*choice);
  REQUIRE(transport.ok());
  REQUIRE((*transport)->open({}).ok());
  Request requests[] = {pictured(5), pictured(6), pictured(7)};
  requests[1].prompt = "put spoon on towel";
  const Request* all[] = {&requests[0], &requests[1], &requests[2]};
  const auto answers = (*transport)->ask_all(all, {});
  REQUIRE_MESSAGE(answers.ok(), to_text(answers.failure()));
  REQUIRE(answers->size() == 3);
  CHECK((*answers)[0].value()[0][0] == (5 + 19) / 1000.0);
  CHECK((*answers)[1].value()[0][0] == (6 + 18) / 1000.0);
  CHECK((*answers)[2].value()[0][0] == (7 + 19) / 1000.0);
}

}  // namespace probe::servers

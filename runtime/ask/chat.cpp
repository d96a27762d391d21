// Models behind the chat interface: attempts, waits, the proof that begins a call.
#include "runtime/ask/chat.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ctime>
#include <thread>

#include "runtime/ask/picture.h"
#include "runtime/base/clock.h"
#include "runtime/base/sha256.h"
#include "runtime/scene/image.h"
#include "runtime/servers/api_key.h"
#include "runtime/servers/connecting.h"
#include "runtime/wire/http.h"

namespace probe::ask {
namespace {

using Clock = std::chrono::steady_clock;

// An answer with every token's likeliest twenty is large; one of 10 MB is none.
constexpr std::size_t kLargestBody = std::size_t{4} << 20;
constexpr int kTopLogprobs = 20;  // as many as OpenAI's interface and vLLM allow
constexpr double kFirstPause = 0.1, kLongestPause = 5;  // s, doubled from attempt to attempt
constexpr double kLongestRetryAfter = 60;               // s

// Seconds that a server asks to be left alone: a number, or a date of HTTP.
std::optional<double> retry_after_s(const std::string& text) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error == std::errc() && end == text.data() + text.size())
    return std::isfinite(seconds) && seconds >= 0 ? std::optional(seconds) : std::nullopt;
  std::tm date{};
  if (::strptime(text.c_str(), "%a, %d %b %Y %H:%M:%S GMT", &date) == nullptr) return std::nullopt;
  return std::max(0.0, static_cast<double>(::timegm(&date)) - unix_seconds());
}

// What one attempt came to, where it brought no answer.
struct Trouble {
  enum class Kind {
    kFinal,   // asking again is of no use
    kBroken,  // something went wrong; `retries` times
    kBusy,    // the server is not there, or asks for time; as long as `wait_s` lasts
  };
  Kind kind = Kind::kFinal;
  Failure failure = {};
  double pause_s = 0;  // that the server asked for
};

class ChatModel final : public Model {
 public:
  ChatModel(const ChatChoice& choice, const ChatContext& context)
      : choice_(choice),
        context_(context),
        connection_(choice.server, {servers::to_duration(choice.connect_s),
                                    servers::to_duration(choice.answer_s), kLargestBody}) {
    if (const std::string key = servers::api_key(); !key.empty())
      headers_.emplace_back("Authorization", "Bearer " + key);
  }

  Result<Said> answer(const AskedQuery& asked) override {
    const bool is_choice = asked.truth.option.has_value();
    const std::size_t letters = is_choice && context_.has_logprobs ? asked.wording.shown.size() : 0;
    return ask(asked.wording.text, asked.picture == nullptr ? "" : asked.picture->data_uri,
               letters);
  }

  Result<Said> ask(std::string_view text, std::string_view data_uri, std::size_t letters) {
    const std::string body =
        chat_request(choice_.terms, text, data_uri, letters > 0 ? kTopLogprobs : 0);
    const std::string hash = to_hex(sha256(std::string_view(body)));
    double pause = kFirstPause;
    const auto limit = Clock::now() + servers::to_duration(choice_.wait_s);
    int broken = 0;
    for (failed_attempts = 1;; ++failed_attempts) {
      Trouble trouble;
      const auto begun = Clock::now();
      if (auto said = attempt(body, letters, trouble)) {
        said->latency_s = seconds_since(begun);
        said->request_sha256 = hash;
        said->attempts = failed_attempts;
        return std::move(*said);
      }
      if (trouble.kind == Trouble::Kind::kFinal) return told(trouble);
      if (trouble.kind == Trouble::Kind::kBroken && ++broken > context_.retries)
        return told(trouble);
      const double wait = std::max(pause, std::min(trouble.pause_s, kLongestRetryAfter));
      if (trouble.kind == Trouble::Kind::kBusy && Clock::now() + servers::to_duration(wait) > limit)
        return told(trouble);
      if (!sleep(wait)) return told(trouble);
      pause = std::min(2 * pause, kLongestPause);
    }
  }

 private:
  std::optional<Said> attempt(const std::string& body, std::size_t letters, Trouble& trouble) {
    wire::HttpRequest request;
    request.method = "POST";
    request.path = choice_.server.path;
    request.body = body;
    request.headers = headers_;
    const policy::QueryMeter::InFlight under_way(context_.queries);
    auto response = connection_.exchange(request);
    if (!response) {
      trouble.failure = response.failure();
      const bool is_final = trouble.failure.code == Fault::kAnswered ||
                            trouble.failure.code == Fault::kUsage ||
                            trouble.failure.message.starts_with("an answer of more than");
      // Somebody is there who does not go on with TLS: waiting does not teach it.
      const bool is_no_tls = trouble.failure.message.starts_with("opening TLS: the server closed");
      trouble.kind = is_final                               ? Trouble::Kind::kFinal
                     : !connection_.reached() && !is_no_tls ? Trouble::Kind::kBusy
                                                            : Trouble::Kind::kBroken;
      return std::nullopt;
    }
    if (response->status != 200) {
      refuse(*response, trouble);
      return std::nullopt;
    }
    auto said = read_chat_answer(choice_.terms, response->body, response->content_type, letters);
    if (said) return std::move(*said);
    trouble.failure = said.failure();
    trouble.kind =
        trouble.failure.code == Fault::kPolicy ? Trouble::Kind::kBroken : Trouble::Kind::kFinal;
    return std::nullopt;
  }

  static void refuse(const wire::HttpResponse& response, Trouble& trouble) {
    const std::string words = error_words(response.body);
    trouble.failure = {
        Fault::kPolicy,
        "answered with HTTP status " + std::to_string(response.status) +
            wire::sent_elsewhere(static_cast<unsigned>(response.status), response.location) +
            (words.empty() ? "" : ": " + words),
        ""};
    switch (response.status) {
      case 429:
      case 503:
        trouble.kind = Trouble::Kind::kBusy;
        break;
      case 408:
      case 500:
      case 502:
      case 504:
        trouble.kind = Trouble::Kind::kBroken;
        break;
      default:
        trouble.kind = Trouble::Kind::kFinal;
        trouble.failure.code = Fault::kAnswered;
    }
    if (response.retry_after) trouble.pause_s = retry_after_s(*response.retry_after).value_or(0);
  }

  Failure told(const Trouble& trouble) const {
    Failure failure = trouble.failure;
    const Fault code = failure.code;
    failure = servers::named(std::move(failure), choice_.server.name());
    failure.code = code;
    if (failed_attempts > 1)
      failure.message += " (tried " + std::to_string(failed_attempts) + " times)";
    return failure;
  }

  // False when nobody waits any more.
  bool sleep(double seconds) const {
    const auto until = Clock::now() + servers::to_duration(seconds);
    constexpr std::chrono::milliseconds kLook{50};
    while (Clock::now() < until) {
      if (context_.stopped != nullptr && *context_.stopped) return false;
      std::this_thread::sleep_for(
          std::min<Clock::duration>(kLook, std::max(until - Clock::now(), Clock::duration(0))));
    }
    return true;
  }

  const ChatChoice choice_;
  const ChatContext context_;
  wire::HttpConnection connection_;
  std::vector<std::pair<std::string, std::string>> headers_;
};

constexpr int kProofSide = 224;

// A square of one colour on white.
Result<std::string> proof_picture(std::array<std::uint8_t, 3> color) {
  std::vector<std::uint8_t> rgb(std::size_t{kProofSide} * kProofSide * 3, 255);
  constexpr int kFrom = kProofSide / 4, kTo = 3 * kProofSide / 4;
  for (int y = kFrom; y < kTo; ++y) {
    for (int x = kFrom; x < kTo; ++x)
      std::ranges::copy(color, rgb.begin() + (std::ptrdiff_t{y} * kProofSide + x) * 3);
  }
  PROBE_ASSIGN(const std::string png, scene::png_bytes(kProofSide, kProofSide, rgb));
  return data_uri_of(png);
}

constexpr const char* kProofColor =
    "Which colour has the square in the picture? Answer with one word.";
constexpr const char* kProofCount =
    "How many squares are in the picture? Answer with one whole number.";

}  // namespace

std::unique_ptr<Model> make_chat(const ChatChoice& choice, const ChatContext& context) {
  return std::make_unique<ChatModel>(choice, context);
}

Result<ModelProof> prove_chat(const ChatChoice& choice, const ChatContext& context, bool pictures) {
  PROBE_TRY(servers::check_api_key());
  ModelProof proof;
  proof.server = choice.server.name();
  proof.is_unchecked = choice.server.tls.is_on && choice.server.tls.accepts_any;
  std::string red, blue;
  if (pictures) {
    PROBE_ASSIGN(red, proof_picture({220, 20, 20}));
    PROBE_ASSIGN(blue, proof_picture({20, 40, 220}));
  }
  ChatModel model(choice, context);
  const auto color = model.ask(kProofColor, red, 0);
  if (!color) {
    if (!pictures || color.failure().code != Fault::kAnswered) return color.failure();
    // Is it the picture?
    const auto without = model.ask(kProofColor, "", 0);
    if (!without) return color.failure();
    return Failure{Fault::kUsage,
                   "the server answers to words and refuses a picture, so `" + choice.terms.model +
                       "` is no model that sees: " + color.failure().message,
                   choice.server.name()};
  }
  proof.answered_as = color->usage.model;
  PROBE_ASSIGN(const Said count, model.ask(kProofCount, red, 0));
  proof.answers = 2;
  proof.is_deaf = color->raw == count.raw;
  if (pictures) {
    PROBE_ASSIGN(const Said other, model.ask(kProofColor, blue, 0));
    ++proof.answers;
    proof.is_blind = color->raw == other.raw;
  }
  if (!choice.wants_logprobs) return proof;
  const auto likely = model.ask(kProofColor, red, 1);
  // Not offered is one thing, a failure that another call would not meet is another.
  if (!likely && likely.failure().code != Fault::kAnswered) return likely.failure();
  proof.has_logprobs = likely && likely->has_logprobs;
  return proof;
}

}  // namespace probe::ask

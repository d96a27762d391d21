// Addresses of models behind the chat interface, and their options.
#include <algorithm>
#include <charconv>
#include <utility>

#include "runtime/ask/chat.h"
#include "runtime/base/spelling.h"
#include "runtime/servers/profile_words.h"

namespace probe::ask {
namespace {

struct ChatScheme {
  std::string_view word, port;
  bool is_tls;
};
constexpr ChatScheme kChatSchemes[] = {
    {"openai:", "8000", false}, {"http:", "80", false}, {"https:", "443", true}};

const ChatScheme* scheme_of(std::string_view text) {
  for (const ChatScheme& scheme : kChatSchemes) {
    if (text.starts_with(scheme.word)) return &scheme;
  }
  return nullptr;
}

Failure usage(const std::string& message) { return {Fault::kUsage, message, "--model"}; }

// The path of POST, from a base as it is copied: with or without /v1, or whole.
std::string post_path(std::string path) {
  while (path.ends_with('/')) path.pop_back();
  constexpr std::string_view kEnd = "/chat/completions";
  if (path.ends_with(kEnd)) return path;
  if (!path.ends_with("/v1")) path += "/v1";
  return path + std::string(kEnd);
}

template <typename Number>
Result<Number> number_in(const std::string& name, const std::string& text, Number low,
                         Number high) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= low && value <= high)
    return value;
  return usage("`" + name + "` is a number from " + std::to_string(low) + " to " +
               std::to_string(high) + ", found `" + text + "`");
}

// "WxH".
Status read_size(const std::string& text, PictureRule& rule) {
  constexpr int kLargest = 4096;
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos)
    return usage("`size` is written WxH, as in 224x224, found `" + text + "`");
  PROBE_ASSIGN(rule.width, number_in("size", text.substr(0, cross), 1, kLargest));
  PROBE_ASSIGN(rule.height, number_in("size", text.substr(cross + 1), 1, kLargest));
  return {};
}

Status read_resize(const std::string& text, PictureRule& rule) {
  std::string known;
  for (const auto& word : servers::kResizes) {
    if (word.value == servers::Resize::kNone) continue;
    if (word.text == text) {
      rule.resize = word.value;
      return {};
    }
    known += (known.empty() ? "" : ", ") + std::string(word.text);
  }
  return usage("`resize` is one of " + known + ", found `" + text + "`");
}

// The options of an address: each sets its part of a choice.
struct ChatOption {
  std::string_view name;
  Status (*set)(ChatChoice& choice, const std::string& text);
};
constexpr ChatOption kChatOptions[] = {
    {"model",
     [](ChatChoice& c, const std::string& t) -> Status {
       c.terms.model = t;
       return {};
     }},
    {"answers_as",
     [](ChatChoice& c, const std::string& t) -> Status {
       c.terms.answers_as = t;
       return {};
     }},
    {"system",
     [](ChatChoice& c, const std::string& t) -> Status {
       c.terms.system = t;
       return {};
     }},
    {"max_tokens",
     [](ChatChoice& c, const std::string& t) -> Status {
       PROBE_ASSIGN(c.terms.max_tokens, number_in("max_tokens", t, 1, 1'000'000));
       return {};
     }},
    {"temperature",
     [](ChatChoice& c, const std::string& t) -> Status {
       PROBE_TRY(number_in("temperature", t, 0.0, 2.0));
       c.terms.temperature = t;
       return {};
     }},
    {"top_p",
     [](ChatChoice& c, const std::string& t) -> Status {
       PROBE_TRY(number_in("top_p", t, 0.0, 1.0));
       c.terms.top_p = t;
       return {};
     }},
    {"seed",
     [](ChatChoice& c, const std::string& t) -> Status {
       PROBE_ASSIGN(c.terms.seed, number_in("seed", t, 0, 2'000'000'000));
       return {};
     }},
    {"size", [](ChatChoice& c, const std::string& t) { return read_size(t, c.picture); }},
    {"resize", [](ChatChoice& c, const std::string& t) { return read_resize(t, c.picture); }},
    {"camera",
     [](ChatChoice& c, const std::string& t) -> Status {
       c.picture.camera = t;
       return {};
     }},
    {"logprobs",
     [](ChatChoice& c, const std::string& t) -> Status {
       if (t != "auto" && t != "off") return usage("`logprobs` is auto or off, found `" + t + "`");
       c.wants_logprobs = t == "auto";
       return {};
     }},
    {"timeout.connect_s",
     [](ChatChoice& c, const std::string& t) -> Status {
       PROBE_ASSIGN(c.connect_s, number_in("timeout.connect_s", t, 0.001, 3600.0));
       return {};
     }},
    {"timeout.answer_s",
     [](ChatChoice& c, const std::string& t) -> Status {
       PROBE_ASSIGN(c.answer_s, number_in("timeout.answer_s", t, 0.001, 3600.0));
       return {};
     }},
    {"timeout.wait_s",
     [](ChatChoice& c, const std::string& t) -> Status {
       PROBE_ASSIGN(c.wait_s, number_in("timeout.wait_s", t, 0.0, 86400.0));
       return {};
     }},
};

}  // namespace

bool is_chat(std::string_view text) { return scheme_of(text) != nullptr; }

Result<ChatChoice> choose_chat(std::string_view text) {
  const ChatScheme* scheme = scheme_of(text);
  if (scheme == nullptr) return usage("`" + std::string(text) + "` is no server's address");
  auto server = wire::parse_endpoint(text.substr(scheme->word.size()), scheme->port);
  if (!server) {
    Failure failure = server.failure();
    failure.where = "--model";
    return failure;
  }
  ChatChoice choice;
  choice.server = std::move(*server);
  choice.server.path = post_path(choice.server.path);
  choice.server.tls.is_on = scheme->is_tls;
  for (const auto& [name, value] : std::exchange(choice.server.options, {})) {
    if (name == "ca" && scheme->is_tls) {
      choice.server.tls.authorities = value;
      continue;
    }
    const auto known = std::ranges::find(kChatOptions, name, &ChatOption::name);
    if (known == std::end(kChatOptions)) {
      std::vector<std::string> names;
      for (const ChatOption& option : kChatOptions) names.emplace_back(option.name);
      if (scheme->is_tls) names.emplace_back("ca");
      std::string all;
      for (const std::string& each : names) all += (all.empty() ? "" : ", ") + each;
      const std::string near = did_you_mean(name, names);
      return usage("the address of a model has no option `" + name + "`" +
                   (near.empty() ? "; it has " + all : near));
    }
    PROBE_TRY(known->set(choice, value));
  }
  if (choice.terms.model.empty())
    return usage("which of the server's models: `?model=NAME` is missing from the address");
  return choice;
}

ModelTraits traits_of(const ChatChoice& choice) {
  const ChatTerms& terms = choice.terms;
  const PictureRule& rule = choice.picture;
  ModelTraits traits;
  traits.name = terms.model;
  traits.content = "chat model=" + terms.model + " max_tokens=" + std::to_string(terms.max_tokens) +
                   " temperature=" + terms.temperature + " top_p=" + terms.top_p +
                   " seed=" + std::to_string(terms.seed);
  if (rule.width > 0) {
    traits.content += " size=" + std::to_string(rule.width) + "x" + std::to_string(rule.height);
    for (const auto& word : servers::kResizes) {
      if (word.value == rule.resize) traits.content += " resize=" + std::string(word.text);
    }
  }
  if (!rule.camera.empty()) traits.content += " camera=" + rule.camera;
  if (!terms.system.empty()) traits.content += " system=" + terms.system;
  if (!choice.wants_logprobs) traits.content += " logprobs=off";
  traits.arms = {Arm::kPicture, Arm::kBlind, Arm::kPrior};
  traits.picture = rule;
  traits.is_shown = true;
  return traits;
}

}  // namespace probe::ask

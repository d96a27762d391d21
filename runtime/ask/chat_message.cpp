#include "runtime/ask/chat_message.h"

#include <algorithm>

#include "runtime/ask/reading/likely_letters.h"
#include "runtime/base/json.h"
#include "runtime/base/printable.h"
#include "runtime/servers/api_key.h"
#include "runtime/servers/transport.h"

namespace probe::ask {
namespace {

constexpr std::size_t kShownName = 100;

std::string json_string(std::string_view text) { return Json(text).dump(); }

Failure broken(std::string message) { return {Fault::kPolicy, std::move(message), ""}; }
Failure final_answer(std::string message) { return {Fault::kAnswered, std::move(message), ""}; }

std::string text_or_empty(const Json* json) {
  return json != nullptr && json->is_string() ? json->text() : std::string();
}

struct Content {
  std::string words, thoughts;
};

// A text, or a list of parts of which some are texts and some thoughts; null and nothing at all are
// no words. None of anything else, which says nothing of what the model answered.
std::optional<Content> content_of(const Json& message) {
  const Json* content = message.find("content");
  if (content == nullptr || content->is_null()) return Content();
  if (content->is_string()) return Content{content->text(), {}};
  if (!content->is_array()) return std::nullopt;
  Content all;
  for (const Json& part : *content) {
    if (!part.is_object()) return std::nullopt;
    const std::string type = text_or_empty(part.find("type"));
    const bool is_thought = type == "thinking" || type == "reasoning" || type == "thought";
    const std::string words = text_or_empty(part.find("text"));
    if (!is_thought)
      all.words += words;
    else
      all.thoughts += words.empty() ? text_or_empty(part.find(type)) : words;
  }
  return all;
}

std::optional<std::int64_t> count_of(const Json* json) {
  if (json == nullptr || !json->is_number_integer()) return std::nullopt;
  const auto count = json->get<std::int64_t>();
  return count >= 0 ? std::optional(count) : std::nullopt;
}

}  // namespace

std::string chat_request(const ChatTerms& terms, std::string_view text, std::string_view data_uri,
                         int top_logprobs) {
  std::string body;
  body.reserve(data_uri.size() + text.size() + 1024);
  body += "{\"model\": " + json_string(terms.model) + ", \"messages\": [";
  if (!terms.system.empty())
    body += "{\"role\": \"system\", \"content\": " + json_string(terms.system) + "}, ";
  body += "{\"role\": \"user\", \"content\": [";
  if (!data_uri.empty()) {
    body += "{\"type\": \"image_url\", \"image_url\": {\"url\": \"";
    body += data_uri;  // base64 has nothing that needs an escape
    body += "\"}}, ";
  }
  body += "{\"type\": \"text\", \"text\": " + json_string(text) + "}]}]";
  body += ", \"max_tokens\": " + std::to_string(terms.max_tokens);
  body += ", \"temperature\": " + terms.temperature + ", \"top_p\": " + terms.top_p;
  body += ", \"seed\": " + std::to_string(terms.seed) + ", \"stream\": false";
  if (top_logprobs > 0)
    body += ", \"logprobs\": true, \"top_logprobs\": " + std::to_string(top_logprobs);
  return body + "}";
}

Result<Said> read_chat_answer(const ChatTerms& terms, std::string_view body,
                              std::string_view content_type, std::size_t letters) {
  if (content_type.starts_with("text/event-stream") || body.starts_with("data:")) {
    return final_answer(
        "the server streams its answer (text/event-stream), though the request says that it must "
        "not");
  }
  const Json json = Json::parse(body);
  if (!json.is_object()) {
    return broken(body.empty() ? "the answer is empty"
                               : "the answer is no JSON object: " + servers::last_lines(body));
  }
  const Json* choices = json.find("choices");
  const bool has_choice = choices != nullptr && choices->is_array() && !choices->empty();
  if (!has_choice) {
    return broken(json.contains("error")
                      ? "the server failed: " + error_words(body)
                      : "the answer has no `choices`: " + servers::last_lines(body));
  }
  const Json& choice = choices->front();
  const Json* message = choice.find("message");
  if (message == nullptr || !message->is_object())
    return broken("the answer's choice has no `message`: " + servers::last_lines(body));
  Said said;
  said.usage.model = text_or_empty(json.find("model"));
  const std::string& wanted = terms.answers_as.empty() ? terms.model : terms.answers_as;
  if (!said.usage.model.empty() && said.usage.model != wanted) {
    return final_answer("the answer is of model `" + printable(said.usage.model, kShownName) +
                        "`, not of `" + wanted +
                        "`; if that is the same, say answers_as= in the address");
  }
  auto content = content_of(*message);
  if (!content)
    return broken("the answer's `content` is neither text nor null: " + servers::last_lines(body));
  said.raw = std::move(content->words);
  said.reasoning = text_or_empty(message->find("reasoning"));
  if (said.reasoning.empty()) said.reasoning = text_or_empty(message->find("reasoning_content"));
  if (said.reasoning.empty()) said.reasoning = std::move(content->thoughts);
  if (said.raw.size() + said.reasoning.size() > kMostWords) {
    return final_answer("an answer of " +
                        std::to_string((said.raw.size() + said.reasoning.size()) >> 10) +
                        " KiB, more than " + std::to_string(kMostWords >> 10));
  }
  said.usage.fingerprint = text_or_empty(json.find("system_fingerprint"));
  said.usage.finish = text_or_empty(choice.find("finish_reason"));
  // A shorter key, as is given to servers that want none, may be a word of an answer.
  constexpr std::size_t kLeastSecret = 8;
  const std::string key = servers::api_key();
  for (const std::string* words :
       {&said.raw, &said.reasoning, &said.usage.fingerprint, &said.usage.finish}) {
    if (key.size() >= kLeastSecret && words->find(key) != words->npos)
      return final_answer("the answer holds the API key that was sent; it is kept nowhere");
  }
  if (const Json* usage = json.find("usage"); usage != nullptr) {
    said.usage.prompt_tokens = count_of(usage->find("prompt_tokens"));
    said.usage.completion_tokens = count_of(usage->find("completion_tokens"));
  }
  said.has_logprobs = tells_logprobs(choice.find("logprobs"));
  said.letters = written_letters(choice.find("logprobs"), said.raw, letters);
  return said;
}

std::string error_words(std::string_view body) {
  const Json json = Json::parse(body);
  const Json* error = json.find("error");
  for (const Json* place : {error, &json}) {
    if (place == nullptr) continue;
    if (place->is_string()) return servers::last_lines(place->text());
    for (const char* key : {"message", "detail"}) {
      const std::string words = text_or_empty(place->find(key));
      if (!words.empty()) return servers::last_lines(words);
    }
  }
  return servers::last_lines(body);
}

}  // namespace probe::ask

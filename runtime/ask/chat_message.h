// The chat interface's messages, POST /v1/chat/completions as vLLM, SGLang, llama.cpp and ollama
// share it: a request's body, and what an answer's says. Pure; knows no connection.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/ask/models.h"
#include "runtime/base/result.h"

namespace probe::ask {

// How a model is asked; what every request has. Numbers are JSON texts.
struct ChatTerms {
  std::string model;       // as the server knows it
  std::string answers_as;  // what answers may call it; empty: as `model`
  std::string system;      // of a message of that role; empty: none is sent
  int max_tokens = 256;
  std::string temperature = "0", top_p = "1";
  int seed = 0;
};

// `data_uri`: of the picture, empty for none; it stands before the text. `top_logprobs`: how many
// of an answer's likeliest tokens are wanted at each place, 0: none.
std::string chat_request(const ChatTerms& terms, std::string_view text, std::string_view data_uri,
                         int top_logprobs);

// Answers, thoughts included, with more bytes are refused.
inline constexpr std::size_t kMostWords = std::size_t{256} << 10;

// Of an answer with status 200. `letters`: how many options have one whose log-probabilities are looked for.
// Fails (kPolicy) on what is no such answer, (kAnswered) on one that asking again would not change:
// streamed, too long, by another model.
Result<Said> read_chat_answer(const ChatTerms& terms, std::string_view body,
                              std::string_view content_type, std::size_t letters);

// What a server says of an error, in its own words: `error.message` and its kin, or the text.
std::string error_words(std::string_view body);

}  // namespace probe::ask
